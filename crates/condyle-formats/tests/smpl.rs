//! Poses of SMPL: against NumPy and SciPy, in every layout, damaged, and refused.
#![cfg(all(feature = "smpl", feature = "poses"))]

#[path = "smpl_build/mod.rs"]
mod smpl_build;

use condyle_formats::skeleton::Assumed;
use condyle_formats::smpl::{self, Rest, Tree};
use condyle_formats::{Animation, Content, Format, Id, Read};
use condyle_math::Vec3;
use condyle_model::{Mode, Pose, Program, UpAxis};
use serde_json::Value;
use smpl_build::{Npy, Npz, body, poses};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn answers() -> Value {
    let text = std::fs::read_to_string(root().join("oracles/smpl/answers.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// A file that NumPy wrote: `python oracles/smpl/evaluate.py --files fuzz/seeds/smpl`.
fn numpy(name: &str) -> Vec<u8> {
    std::fs::read(root().join("fuzz/seeds/smpl").join(name)).unwrap()
}

fn rest(tree: Tree) -> Rest {
    smpl::rest(&body(tree).stored()).unwrap().value
}

/// The positions of all joints, frame by frame.
fn positions(found: &Animation) -> Vec<Vec<Vec3>> {
    let program = Program::compile(&found.model);
    let mut pose = Pose::new(&program);
    let frames = found.motion.frames.iter().map(|frame| {
        program.evaluate(frame, Mode::Open, &mut pose).unwrap();
        found.model.segment_ids().map(|id| pose.segment(id).translation).collect()
    });
    frames.collect()
}

/// The largest distance from where the oracle has the joints, in metres.
fn off(found: &Animation, tree: Tree) -> f64 {
    let answers = answers();
    let frames = answers[key(tree)].as_array().unwrap();
    let own = positions(found);
    assert_eq!(own.len(), frames.len());
    let mut worst = 0.0f64;
    for (own, answer) in own.iter().zip(frames) {
        let answer = answer.as_array().unwrap();
        assert_eq!(own.len(), answer.len());
        for (own, answer) in own.iter().zip(answer) {
            let place = [0, 1, 2].map(|axis| answer[axis].as_f64().unwrap());
            worst = worst.max((*own - Vec3::from(place)).norm());
        }
    }
    worst
}

fn key(tree: Tree) -> &'static str {
    match tree {
        Tree::Smpl => "smpl",
        Tree::SmplH => "smplh",
        _ => "smplx",
    }
}

fn read(bytes: &[u8], tree: Tree) -> Read<Animation> {
    smpl::from_bytes(bytes, &rest(tree)).unwrap_or_else(|error| panic!("{error}"))
}

fn codes<T>(read: &Read<T>) -> Vec<&'static str> {
    read.warnings.iter().map(|said| said.code).collect()
}

#[test]
fn joints_are_where_numpy_has_them() {
    for tree in [Tree::Smpl, Tree::SmplH, Tree::SmplX] {
        let found = read(&poses(tree).stored(), tree).value;
        let names: Vec<String> = tree.joints().into_iter().map(|(name, _)| name).collect();
        let segments: Vec<&str> =
            found.model.segments().iter().map(|segment| segment.name.as_str()).collect();
        assert_eq!(segments, names);
        let worst = off(&found, tree);
        println!("{}: {worst:.1e} m", tree.title());
        assert!(worst < 1e-9, "{tree:?}: {worst:e}");
        // Packed, with records of 64 bits, or with something before the archive it is the same.
        for bytes in [poses(tree).deflated(), poses(tree).zip64()] {
            assert_eq!(read(&bytes, tree).value, found);
        }
    }
}

#[test]
fn files_that_numpy_wrote() {
    for (name, tree, tolerance) in [
        ("amass_smplh.npz", Tree::SmplH, 1e-9),
        ("amass_smplx.npz", Tree::SmplX, 1e-9),
        // The orientation of the pelvis is of single precision there, 1e-7 of π at some metres.
        ("parts.npz", Tree::SmplX, 3e-6),
        // As are all rotations, along chains of ten joints.
        ("smpl.npz", Tree::Smpl, 3e-6),
    ] {
        let bytes = numpy(name);
        assert!(smpl::is_npz(&bytes) && !smpl::is_body(&bytes), "{name}");
        assert_eq!(Format::of_bytes(&bytes).map(|f| f.id), Some(Id::Smpl));
        let found = read(&bytes, tree).value;
        let worst = off(&found, tree);
        assert!(worst < tolerance, "{name}: {worst:e}");
    }
    // Matrices, without betas: beside rotation vectors without betas.
    let whole = poses(Tree::Smpl).without("betas").stored();
    let (vectors, matrices) = (read(&whole, Tree::Smpl), read(&numpy("matrices.npz"), Tree::Smpl));
    for (a, b) in positions(&vectors.value).iter().zip(positions(&matrices.value)) {
        assert!(a.iter().zip(b).all(|(a, b)| (*a - b).norm() < 1e-9));
    }
}

#[test]
fn bodies_dense_and_sparse() {
    let own = rest(Tree::Smpl);
    assert!(own.is_body() && own.shapes() == 10);
    for name in ["body.npz", "sparse_body.npz"] {
        let bytes = numpy(name);
        assert!(smpl::is_body(&bytes), "{name}");
        let read = smpl::rest(&bytes).unwrap();
        assert!(read.warnings.is_empty(), "{:?}", read.warnings);
        for (joint, _) in Tree::Smpl.joints() {
            let (a, b) = (own.joint(&joint).unwrap(), read.value.joint(&joint).unwrap());
            assert!((a - b).norm() < 1e-12, "{name} {joint}");
        }
        let format = Format::of_ending("npz").unwrap();
        let content = format.read(&bytes, &mut |_| Err(String::new())).unwrap().value;
        let Content::Model(model) = content else { panic!("a body is a model") };
        assert_eq!(model.segments().len(), 24);
    }
    // Places of J are read where there is no surface.
    let places = Npy::new(&[24, 3], |index| index[0] as f64 + 0.1 * index[1] as f64);
    let read = smpl::rest(&Npz::default().with("J", places).stored()).unwrap().value;
    assert_eq!(read.joint("right_hand"), Some(Vec3::new(23.0, 23.1, 23.2)));
}

#[test]
fn kinds_orders_and_bytes_give_the_same() {
    let tree = Tree::SmplH;
    let found = read(&poses(tree).stored(), tree).value;
    let with = |change: &dyn Fn(Npy) -> Npy| {
        let npz = poses(tree);
        let changed = change(npz.get("poses").clone());
        read(&npz.with("poses", changed).stored(), tree).value
    };
    assert_eq!(with(&|npy| npy.fortran()), found);
    assert_eq!(with(&|npy| npy.big_endian()), found);
    assert_eq!(with(&|npy| npy.reshaped(&[3, 52, 3])), found);
    assert_eq!(with(&|npy| npy.reshaped(&[3, 52, 3]).fortran()), found);
    assert_eq!(with(&|npy| npy.reshaped(&[1, 3, 156])), found);
    let single = with(&|npy| npy.single());
    assert!(off(&single, tree) < 3e-6 && single != found);
    // Under names with prefixes, and in a folder.
    let npz = poses(tree);
    let renamed = npz.clone().without("poses").with("smplh/smplh_Poses", npz.get("poses").clone());
    assert_eq!(read(&renamed.stored(), tree).value, found);
}

#[test]
fn one_frame_in_one_dimension() {
    let npz = Npz::default().with("poses", Npy::new(&[72], |index| 0.01 * index[0] as f64));
    let read = read(&npz.stored(), Tree::Smpl);
    assert_eq!(read.value.motion.frames.len(), 1);
    assert_eq!(codes(&read), ["smpl/layout", "smpl/rate", "smpl/places", "skeleton/up"]);
    // The third joint turns by the vector (0.06, 0.07, 0.08): half of its length is in the cosine.
    let angle = (0.06f64.powi(2) + 0.07f64.powi(2) + 0.08f64.powi(2)).sqrt();
    assert!((read.value.motion.frames[0][3 + 4 * 2 + 3] - (angle / 2.0).cos()).abs() < 1e-15);
}

#[test]
fn rotations_go_on_through_a_whole_turn() {
    // The elbow's vector goes from 0 to 4π about x, in steps of 10°, wrapped to less than π as estimators do.
    let steps = 72;
    let angle = |frame: usize| {
        let angle = (10.0 * frame as f64).to_radians();
        angle - std::f64::consts::TAU * (angle / std::f64::consts::TAU).round()
    };
    let turning = Npy::new(&[steps + 1, 72], |index| match index[1] {
        54 => angle(index[0]),
        _ => 0.0,
    });
    let found = read(&Npz::default().with("poses", turning).stored(), Tree::Smpl).value;
    let frames = &found.motion.frames;
    for (frame, pair) in frames.windows(2).enumerate() {
        let along: f64 = pair[0].iter().zip(&pair[1]).skip(3).map(|(a, b)| a * b).sum();
        // 23 joints that stay, and one that turns by 10°.
        let expected = 23.0 + 5f64.to_radians().cos();
        assert!((along - expected).abs() < 1e-12, "{frame}: {along}");
    }
    let elbow = &frames[36][3 + 4 * 18..3 + 4 * 19];
    assert!((elbow[3] + 1.0).abs() < 1e-12, "after one turn the sign is the other: {elbow:?}");
}

#[test]
fn the_axis_that_points_up() {
    let upright = |lean: f64, rate: bool| {
        let npz = Npz::default()
            .with("poses", Npy::new(&[2, 72], |i| if i[1] == 0 { lean } else { 0.0 }))
            .with("trans", Npy::new(&[2, 3], |i| [1.0, 2.0, 3.0][i[1]]));
        let rates = Npy::new(&[], |_| 100.0);
        if rate { npz.with("mocap_framerate", rates) } else { npz }
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    // The place of the pelvis in the body is not known: where `trans` is.
    let own = Rest::new("`me`", standing());
    let place = |npz: &Npz, assumed: &Assumed| {
        let read = smpl::from_bytes_with(&npz.stored(), &own, assumed).unwrap();
        let said = read.warnings.iter().find(|said| said.code == "skeleton/up");
        let said = said.map(|said| said.severity.name());
        let at: [f64; 3] = read.value.motion.frames[0][..3].try_into().unwrap();
        (at, said, read.value)
    };
    let guess = Assumed::default();
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
    let (at, said, found) = place(&upright(quarter, true), &guess);
    assert!(near(at, [1.0, 3.0, -2.0]) && said == Some("note"), "{at:?} {said:?}");
    assert_eq!(found.model.up(), UpAxis::Y);
    // The head is above the pelvis then.
    let heights = positions(&found).remove(0);
    assert!(heights[15].y > heights[0].y + 0.3);
    let (at, said, _) = place(&upright(quarter, false), &guess);
    assert!(near(at, [1.0, 3.0, -2.0]) && said == Some("warning"));
    let (at, said, _) = place(&upright(0.0, false), &guess);
    assert!(near(at, [1.0, 2.0, 3.0]) && said == Some("note"));
    let (at, said, _) = place(&upright(2.0 * quarter, false), &guess);
    assert!(near(at, [1.0, -2.0, -3.0]) && said == Some("warning"));
    // On the back it cannot be told.
    let lying = upright(-quarter, true);
    assert!(near(place(&lying, &guess).0, [1.0, 3.0, -2.0]));
    for (up, expected) in [(UpAxis::Z, [1.0, 3.0, -2.0]), (UpAxis::Y, [1.0, 2.0, 3.0])] {
        let told = Assumed { up: Some(up), ..guess };
        let (at, said, _) = place(&lying, &told);
        assert!(near(at, expected) && said.is_none());
    }
}

/// A figure of a few joints, in metres.
fn standing() -> Vec<(String, Vec3)> {
    let mut joints = vec![("pelvis".to_owned(), Vec3::new(0.0, 1.0, 0.0))];
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        for (joint, place) in [
            ("hip", [0.1, 0.95, 0.0]),
            ("knee", [0.1, 0.5, 0.0]),
            ("ankle", [0.1, 0.1, 0.0]),
            ("shoulder", [0.2, 1.45, 0.0]),
            ("elbow", [0.5, 1.45, 0.0]),
            ("wrist", [0.75, 1.45, 0.0]),
        ] {
            joints
                .push((format!("{side}_{joint}"), Vec3::new(sign * place[0], place[1], place[2])));
        }
    }
    joints.push(("head".to_owned(), Vec3::new(0.0, 1.6, 0.0)));
    joints
}

#[test]
fn joints_that_a_model_lacks_are_put_between_their_neighbours() {
    let own = Rest::new("`me`", standing());
    let read = smpl::from_bytes(&poses(Tree::SmplX).stored(), &own).unwrap();
    assert!(codes(&read).contains(&"smpl/joints") && codes(&read).contains(&"smpl/rest"));
    let stretched = read.value.model.defaults();
    let program = Program::compile(&read.value.model);
    let mut pose = Pose::new(&program);
    program.evaluate(&stretched, Mode::Open, &mut pose).unwrap();
    let at = |name: &str| {
        let id = read.value.model.find_segment(name).unwrap();
        pose.segment(id).translation
    };
    // Three joints of the spine, the neck, the head: a fifth of the way each, the feet 0.06 m below the ankles.
    let fifth = at("spine1").y - at("pelvis").y;
    assert!((fifth - 0.12).abs() < 1e-12, "{fifth}");
    assert!((at("left_foot").y).abs() < 1e-12);
    assert!(at("right_index1").x < at("right_wrist").x && at("right_index1").z > 0.0);
}

#[test]
fn what_is_missing_keeps_the_frame_before() {
    let npz = Npz::default()
        .with(
            "poses",
            Npy::new(
                &[3, 66],
                |i| if i[0] == 1 && i[1] == 9 { f64::NAN } else { 0.1 * i[0] as f64 },
            ),
        )
        .with("trans", Npy::new(&[3, 3], |i| if i[0] == 2 { f64::INFINITY } else { i[0] as f64 }));
    let read = smpl::from_bytes(&npz.stored(), &Rest::new("`me`", standing())).unwrap();
    let said = read.warnings.iter().find(|said| said.code == "smpl/missing").unwrap();
    assert!(said.message.starts_with("2 rotations"), "{}", said.message);
    let frames = read.value.motion.frames;
    assert_eq!(frames[1][3 + 12..3 + 16], frames[0][3 + 12..3 + 16]);
    assert_eq!(frames[2][..3], [1.0; 3]);
    assert_eq!(frames[0].len(), 3 + 4 * 22);
}

#[test]
fn hands_in_principal_components_stay_at_rest() {
    let npz = Npz::default()
        .with("global_orient", Npy::new(&[2, 3], |_| 0.0))
        .with("body_pose", Npy::new(&[2, 63], |_| 0.1))
        .with("left_hand_pose", Npy::new(&[2, 6], |_| 0.1))
        .with("transl", Npy::new(&[1, 3], |_| 0.5));
    let read = read(&npz.stored(), Tree::SmplH);
    assert!(codes(&read).contains(&"smpl/hands"));
    let frame = &read.value.motion.frames[1];
    assert_eq!(frame[3 + 4 * 22..3 + 4 * 23], [0.0, 0.0, 0.0, 1.0]);
    assert!(frame[0] != 0.0, "one place holds for all frames");
}

#[test]
fn what_is_refused_says_why() {
    let own = Rest::new("`me`", standing());
    let error = |bytes: &[u8]| smpl::from_bytes(bytes, &own).unwrap_err();
    let objects = error(&numpy("pickled.npz"));
    assert_eq!(objects.code(), "smpl/objects");
    assert!(objects.to_string().contains("pickled"), "{objects}");
    let npz = poses(Tree::Smpl);
    let whole = npz.stored();
    // Cut off anywhere it is an error, never a panic.
    for length in 0..whole.len() {
        assert_eq!(error(&whole[..length]).code(), "smpl/archive");
    }
    let mut damaged = whole.clone();
    damaged[200] ^= 1;
    let said = error(&damaged).to_string();
    assert!(said.contains("checksum") || said.contains("array"), "{said}");
    let wrong = Npz::default().with("poses", Npy::new(&[2, 71], |_| 0.0));
    let said = error(&wrong.stored()).to_string();
    assert!(said.contains("[2, 71]") && said.contains("165"), "{said}");
    let other = Npz::default().with("markers", Npy::new(&[2, 71], |_| 0.0));
    let said = error(&other.stored());
    assert_eq!(said.code(), "smpl/no-poses");
    assert!(said.to_string().contains("markers"), "{said}");
    assert_eq!(error(&body(Tree::Smpl).stored()).code(), "smpl/no-poses");
    let few = Rest::new("`me`", vec![("pelvis".to_owned(), Vec3::ZERO)]);
    let said = smpl::from_bytes(&whole, &few).unwrap_err();
    assert!(said.code() == "smpl/rest" && said.to_string().contains("left_hip"), "{said}");
}

#[test]
fn an_archive_that_inflates_to_too_much_is_refused() {
    // 60 MB of zeros in some kilobytes: more than three times the archive and 24 MB.
    let zeros = Npy::new(&[100_000, 72], |_| 0.0);
    let bytes = Npz::default().with("poses", zeros).deflated();
    assert!(bytes.len() < 100_000);
    let error = smpl::from_bytes(&bytes, &Rest::new("`me`", standing())).unwrap_err();
    assert!(error.to_string().contains("inflates to"), "{error}");
    // One that states less than it inflates to.
    let mut bytes = Npz::default().with("poses", Npy::new(&[100, 72], |_| 0.0)).deflated();
    let directory = bytes.windows(4).position(|four| four == b"PK\x01\x02").unwrap();
    bytes[directory + 24..directory + 28].copy_from_slice(&1000u32.to_le_bytes());
    let error = smpl::from_bytes(&bytes, &Rest::new("`me`", standing())).unwrap_err();
    assert_eq!(error.code(), "smpl/archive", "{error}");
}
