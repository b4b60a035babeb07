//! The shipped shoulder against bone pins, beside two other rhythms.
//!
//! ```sh
//! cargo run --release -p condyle --example shoulder_rhythm
//! ```
//!
//! Ludewig et al. 2009 followed clavicle and scapula of twelve shoulders with bone pins while the arm
//! was raised in three planes. For each plane and each angle the first table gives the root of the
//! mean square of what a rhythm differs from them at 30, 60, 90 and 120 degrees, in degrees:
//!
//! - `shoulder`: the angles of the shipped model's bones, after the ribs have corrected the scapula;
//! - `Shao`: the clavicle's elevation in Shao & Ng-Thow-Hing 2003, section 5.2, read from the shipped
//!   preset with the clavicle let down as far as the arm allows;
//! - `de Groot`: the regressions of de Groot & Brand 2001 at the rest angles of that study.
//!
//! The numbers in brackets are what is left when a rhythm may be shifted as a whole: the people of
//! another study rest at other angles. The second table is what the ribs correct.

use condyle::formats::document;
use condyle::math::EulerOrder;
use condyle::{Mode, Model, Pose, Program};
use std::error::Error;

const SHOULDER: &str = include_str!("../models/shoulder.toml");
const PRESET: &str = include_str!("../models/shoulder-shao2003.toml");

const ELEVATIONS: [f64; 4] = [30.0, 60.0, 90.0, 120.0];
const ANGLES: [&str; 6] = [
    "clavicle retraction",
    "clavicle elevation",
    "clavicle axial rotation",
    "scapula upward rotation",
    "scapula internal rotation",
    "scapula tilt",
];

/// A plane of elevation, in degrees forward of the frontal one, and the six angles measured in it.
type Measured = (&'static str, f64, [[f64; 4]; 6]);

/// Ludewig et al. 2009, at [`ELEVATIONS`], in the order of [`ANGLES`].
const BONE_PINS: [Measured; 3] = [
    (
        "frontal",
        0.0,
        [
            [31.3, 37.3, 40.6, 44.0],
            [14.3, 16.8, 18.1, 19.5],
            [3.1, 8.6, 15.8, 24.8],
            [15.6, 26.5, 36.5, 46.4],
            [31.2, 30.5, 30.8, 30.6],
            [-10.2, -6.1, -2.1, 3.8],
        ],
    ),
    (
        "scapular",
        40.0,
        [
            [24.6, 29.0, 32.0, 36.3],
            [11.5, 14.4, 15.5, 16.9],
            [1.9, 8.2, 15.2, 24.3],
            [15.5, 26.0, 34.4, 43.5],
            [38.5, 38.8, 39.0, 37.2],
            [-11.2, -6.8, -2.8, 2.7],
        ],
    ),
    (
        "sagittal",
        90.0,
        [
            [20.4, 22.7, 24.8, 31.7],
            [10.1, 12.0, 13.5, 14.5],
            [0.0, 6.6, 14.1, 25.0],
            [15.1, 24.4, 32.9, 43.3],
            [44.3, 46.7, 47.8, 43.5],
            [-10.4, -5.7, -1.4, 5.4],
        ],
    ),
];

/// De Groot & Brand 2001: the angles at this plane and elevation. They have no axial rotation.
fn de_groot(plane: f64, elevation: f64) -> [Option<f64>; 6] {
    let retraction = 4.983 - 0.120 * plane + 0.242 * elevation + 0.851 * 28.57;
    let raised = 3.917 - 0.046 * plane + 0.123 * elevation + 0.493 * 11.68;
    let internal = -1.203 + 0.140 * plane - 0.049 * elevation + 0.901 * 32.05;
    let upward = 3.095 - 0.079 * plane + 0.396 * elevation + 0.414 * 10.67;
    let tilt = 0.659 - 0.028 * plane + 0.184 * elevation - 0.886 * 10.32;
    [Some(retraction), Some(raised), None, Some(upward), Some(internal), Some(tilt)]
}

struct Shoulder {
    model: Model,
    program: Program,
}

impl Shoulder {
    fn read(text: &str) -> Result<Self, Box<dyn Error>> {
        let read =
            document::read(text, &mut |_| Err("it stands alone".into())).map_err(|errors| {
                errors.iter().map(|e| e.message.clone()).collect::<Vec<_>>().join("\n")
            })?;
        let model = read.value.model;
        let program = Program::compile(&model);
        Ok(Self { model, program })
    }

    /// The legal pose nearest to these coordinates, in degrees.
    fn at(&self, degrees: &[(&str, f64)]) -> Result<Pose, Box<dyn Error>> {
        let mut stored = vec![0.0; self.model.stored_len()];
        for (name, value) in degrees {
            let id = self.model.find_coordinate(name).map_err(|_| format!("no `{name}`"))?;
            *self.model.value_mut(&mut stored, id) = value.to_radians();
        }
        let mut pose = Pose::new(&self.program);
        self.program.evaluate(&stored, Mode::Posed, &mut pose)?;
        Ok(pose)
    }

    /// The six angles of a pose, in degrees: Y-X'-Z'' of each bone in the thorax.
    fn angles(&self, pose: &Pose) -> Result<[f64; 6], Box<dyn Error>> {
        let find = |name: &str| self.model.find_segment(name).map_err(|_| format!("no `{name}`"));
        let thorax = pose.segment(find("thorax")?).linear.transpose();
        let order: EulerOrder = "yxz".parse()?;
        let [protraction, lowering, roll] =
            order.from_mat3(thorax * pose.segment(find("clavicle_r")?).linear);
        let [internal, downward, tilt] =
            order.from_mat3(thorax * pose.segment(find("scapula_r")?).linear);
        Ok([-protraction, -lowering, roll, -downward, internal, tilt].map(f64::to_degrees))
    }

    /// How far a marker is from where another pose of another model has it, in millimetres.
    fn moved(&self, pose: &Pose, other: &Pose, marker: &str) -> f64 {
        let Some(marker) = self.model.markers().iter().find(|m| m.name == marker) else {
            return f64::NAN;
        };
        let place = |pose: &Pose| pose.frame(marker.segment) * marker.point;
        1e3 * (place(pose) - place(other)).norm()
    }
}

/// The root of the mean square, as it is and about the mean.
fn rms(errors: &[f64]) -> (f64, f64) {
    let count = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / count;
    let square = |about: f64| errors.iter().map(|e| (e - about).powi(2)).sum::<f64>() / count;
    (square(0.0).sqrt(), square(mean).sqrt())
}

fn main() -> Result<(), Box<dyn Error>> {
    let shoulder = Shoulder::read(SHOULDER)?;
    let preset = Shoulder::read(PRESET)?;
    // The same without the ribs.
    let free = Shoulder::read(&SHOULDER.replace(r#"["free", "ribs"]"#, r#"["free"]"#))?;

    println!(
        "degrees from bone pins at 30, 60, 90 and 120 of elevation (less the mean difference)\n"
    );
    println!("{:9} {:26} {:>13} {:>13} {:>13}", "plane", "angle", "shoulder", "Shao", "de Groot");
    for (name, plane, measured) in BONE_PINS {
        let (mut ours, mut theirs) = (vec![], vec![]);
        for elevation in ELEVATIONS {
            let pose =
                shoulder.at(&[("shoulder_plane_r", plane), ("shoulder_elevation_r", elevation)])?;
            ours.push(shoulder.angles(&pose)?);
            // Abduction is what the paper's table is of, whatever the plane.
            let pose = preset
                .at(&[("shoulder_abduction_r", elevation), ("clavicle_elevation_r", -90.0)])?;
            theirs.push(preset.angles(&pose)?);
        }
        for (angle, (label, pins)) in ANGLES.iter().zip(measured).enumerate() {
            let cell = |of: &dyn Fn(usize) -> Option<f64>| {
                let errors: Option<Vec<f64>> =
                    (0..4).map(|i| of(i).map(|value| value - pins[i])).collect();
                errors.map_or("-".to_owned(), |errors| {
                    let (whole, shifted) = rms(&errors);
                    format!("{whole:.2} ({shifted:.2})")
                })
            };
            // The preset counts from the bone at rest, 5.9; the paper's own numbers are the table.
            let shao = |i: usize| (angle == 1).then(|| theirs[i][1] - 5.9);
            println!(
                "{name:9} {label:26} {:>13} {:>13} {:>13}",
                cell(&|i| Some(ours[i][angle])),
                cell(&shao),
                cell(&|i| de_groot(plane, ELEVATIONS[i])[angle]),
            );
        }
    }

    println!("\nwhat the ribs correct: turns in degrees, how far points of the scapula go in mm\n");
    println!(
        "{:34} {:>7} {:>7} {:>9} {:>9} {:>8}",
        "largest of", "first", "second", "trigonum", "lower end", "gap"
    );
    let row = |label: &str, poses: &[Vec<(&str, f64)>]| -> Result<(), Box<dyn Error>> {
        let mut most = [0.0_f64; 5];
        for degrees in poses {
            let (touching, loose) = (shoulder.at(degrees)?, free.at(degrees)?);
            let report = touching.contact(0).ok_or("the scapula touches nothing")?;
            let gap = 1e3 * report.gaps[0].abs().max(report.gaps[1].abs());
            let [first, second] = report.angles.map(|angle| angle.abs().to_degrees());
            let trigonum = shoulder.moved(&touching, &loose, "trigonum_r");
            let lower = shoulder.moved(&touching, &loose, "inferior_angle_r");
            for (most, now) in most.iter_mut().zip([first, second, trigonum, lower, gap]) {
                *most = most.max(now);
            }
        }
        let [first, second, trigonum, lower, gap] = most;
        println!("{label:34} {first:7.2} {second:7.2} {trigonum:9.1} {lower:9.1} {gap:8.1e}");
        Ok(())
    };
    let arm = |plane: f64, elevation: i32| {
        vec![("shoulder_plane_r", plane), ("shoulder_elevation_r", f64::from(elevation))]
    };
    for (name, plane, _) in BONE_PINS {
        let poses: Vec<_> = (0..=24).map(|i| arm(plane, 5 * i)).collect();
        row(&format!("{name} plane, 0 to 120"), &poses)?;
        let poses: Vec<_> = (24..=33).map(|i| arm(plane, 5 * i)).collect();
        row(&format!("{name} plane, 120 to 165"), &poses)?;
    }
    row("extension, 0 to 60", &(0..=12).map(|i| arm(-90.0, 5 * i)).collect::<Vec<_>>())?;
    for (label, key, value) in [
        ("shrug 30, arm hanging", "shrug_r", 30.0),
        ("shrug -10, arm hanging", "shrug_r", -10.0),
        ("protraction 20, arm hanging", "protraction_r", 20.0),
        ("protraction -15, arm hanging", "protraction_r", -15.0),
    ] {
        row(label, &[vec![(key, value)]])?;
    }
    Ok(())
}
