//! The answers of other programs, kept in `oracles/written/`.

use condyle::formats::skeleton::Place;
use condyle::math::{Affine, Quat, Vec3};
use serde_json::{Map, Value};
use std::path::PathBuf;

/// A program that reads a format that is written.
pub(crate) struct Peer {
    /// The format.
    pub(crate) format: &'static str,
    /// The file of its answers, without ending.
    pub(crate) answers: &'static str,
    /// The script that asks it.
    pub(crate) script: &'static str,
    /// The environment variable that names a Python that has it.
    pub(crate) variable: &'static str,
}

pub(crate) const PEERS: [Peer; 4] = [
    Peer { format: "osim", answers: "opensim", script: "osim.py", variable: "OPENSIM_PYTHON" },
    Peer { format: "urdf", answers: "pinocchio", script: "urdf.py", variable: "PINOCCHIO_PYTHON" },
    Peer { format: "mjcf", answers: "mujoco", script: "mjcf.py", variable: "MUJOCO_PYTHON" },
    Peer { format: "usda", answers: "usd", script: "usd.py", variable: "USD_PYTHON" },
];

pub(crate) fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../oracles/written")
}

/// The answers of a program, by model.
pub(crate) fn answers(peer: &Peer) -> Map<String, Value> {
    let path = folder().join(format!("{}.json", peer.answers));
    let text = std::fs::read_to_string(&path).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Where a program has bodies at one pose.
pub(crate) struct Row {
    /// The numbers of the model's coordinates.
    pub(crate) stored: Vec<f64>,
    /// The joints that were set.
    pub(crate) joints: Vec<(String, f64)>,
    /// Bodies with their places and orientations.
    pub(crate) bodies: Vec<(String, Vec3, Quat)>,
}

pub(crate) fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

pub(crate) fn names(value: &Value) -> Vec<String> {
    value.as_array().unwrap().iter().map(|x| x.as_str().unwrap().to_owned()).collect()
}

pub(crate) fn rows(answer: &Value) -> Vec<Row> {
    let (joints, bodies) = (names(&answer["joints"]), names(&answer["bodies"]));
    let row = |row: &Value| {
        let places = row["bodies"].as_array().unwrap();
        assert_eq!(places.len(), bodies.len());
        let body = |(name, place): (&String, &Value)| {
            let [x, y, z, a, b, c, d] = numbers(place)[..] else { panic!("{name}: {place}") };
            (name.clone(), Vec3::new(x, y, z), Quat::from([a, b, c, d]).normalized())
        };
        Row {
            stored: numbers(&row["stored"]),
            joints: joints.iter().cloned().zip(numbers(&row["joints"])).collect(),
            bodies: bodies.iter().zip(places).map(body).collect(),
        }
    };
    answer["kept"].as_array().unwrap().iter().map(row).collect()
}

/// How far a program may be off, in metres and radians.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowed {
    pub(crate) length: f64,
    pub(crate) angle: f64,
}

impl Allowed {
    /// Where nothing is fitted a micrometre, of which a tenth is the rounding of what is kept and another the splines of
    /// moving centres; else what the program was found to be off over a hundred poses, as the page lists it.
    pub(crate) fn by(answer: &Value) -> Self {
        let [mm, degrees, _] = numbers(&answer["follows"])[..] else { panic!("three numbers") };
        Self { length: 1e-6 + mm * 1e-3, angle: 2e-6 + degrees.to_radians() }
    }
}

/// Asserts that bodies are where a program has them; stretches are left out.
pub(crate) fn compare(
    what: &str,
    row: &Row,
    skipped: &[String],
    allowed: Allowed,
    found: &dyn Fn(&str) -> Affine,
) {
    for (name, place, turn) in &row.bodies {
        if skipped.contains(name) {
            continue;
        }
        let (here, _) = Place::nearest(found(name));
        let off = (here.translation - *place).norm();
        let apart = here.rotation.conjugate() * *turn;
        let angle = 2.0 * apart.vector().norm().atan2(apart.w.abs());
        assert!(
            off <= allowed.length && angle <= allowed.angle,
            "{what}: {name} is {off:.1e} m and {angle:.1e} rad off, more than {allowed:?}"
        );
    }
}
