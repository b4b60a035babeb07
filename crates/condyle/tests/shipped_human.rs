//! The shipped human as a whole: its parts are tested each in a file of its own.

use condyle::lint::{self, Severity};
use condyle::math::{Affine, Mat3, Quat, Vec3};
use condyle::{Mode, Model, Pose, Program, SegmentId, shipped};

fn human() -> Model {
    let read = shipped::read("human").expect("it is shipped");
    assert_eq!(read.warnings, []);
    read.value.model
}

fn numbers(t: Affine) -> [f64; 16] {
    t.to_rows()
}

/// SplitMix64 (Steele, Lea & Flood 2014), as a number in [0, 1).
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Stored numbers inside all ranges; the pelvis within half a turn and half a metre.
fn inside(model: &Model, state: &mut u64) -> Vec<f64> {
    let mut stored = model.defaults();
    for id in model.coordinate_ids() {
        let (lower, upper) = model.coordinate(id).range.bounds();
        let (lower, upper) = (lower.max(-0.5), upper.min(0.5));
        stored[model.stored_range(id).start] = lower + (upper - lower) * random(state);
    }
    stored
}

#[test]
fn nothing_is_wrong_with_it() {
    let model = human();
    let said: Vec<_> = lint::check(&model, &[])
        .into_iter()
        .filter(|finding| finding.severity > Severity::Note)
        .collect();
    assert_eq!(said, []);
    for id in model.coordinate_ids() {
        let coordinate = model.coordinate(id);
        let root = coordinate.name.starts_with("pelvis_");
        assert!(root || coordinate.source.is_some(), "`{}` names no source", coordinate.name);
        let range = coordinate.range;
        assert!(root || (range.lower.is_some() && range.upper.is_some()), "{}", coordinate.name);
    }
}

#[test]
fn all_its_joints_are_the_identity_at_neutral() {
    let model = human();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    program.evaluate(&vec![0.0; model.stored_len()], Mode::Posed, &mut pose).unwrap();
    for id in model.segment_ids() {
        let segment = model.segment(id);
        let joint = pose.frame(segment.parent) * segment.joint_in_parent;
        let motion = joint.rigid_inverse() * pose.segment(id) * segment.joint_in_segment;
        let off = numbers(motion).into_iter().zip(numbers(Affine::IDENTITY)).map(|(a, b)| (a - b).abs());
        // What goes through the roots of the scapula's contact keeps nine digits.
        let bound = if segment.name.contains("scapula") { 1e-9 } else { 1e-12 };
        assert!(off.fold(0.0, f64::max) < bound, "{}: {motion:?}", segment.name);
    }
    // It stands: the vertex is above the pelvis, the feet below, the hands beside the thighs.
    let place = |segment: &str| pose.segment(model.find_segment(segment).unwrap()).translation;
    let (pelvis, head, foot, hand) =
        (place("pelvis"), place("skull"), place("calcaneus_r"), place("hand_r"));
    assert!(head.y - pelvis.y > 0.5 && pelvis.y - foot.y > 0.8);
    assert!((hand.y - pelvis.y).abs() < 0.2 && hand.z > 0.15);
}

#[test]
fn left_mirrors_right() {
    let model = human();
    let program = Program::compile(&model);
    let (mut pose, mut mirrored) = (Pose::new(&program), Pose::new(&program));
    let other = |name: &str| match name {
        n if n.ends_with("_r") => format!("{}_l", &n[..n.len() - 2]),
        n if n.ends_with("_l") => format!("{}_r", &n[..n.len() - 2]),
        n => n.to_owned(),
    };
    // In the middle of the body what goes to the right goes to the left.
    let lateral = |name: &str| {
        let middle = !(name.ends_with("_r") || name.ends_with("_l"));
        let words = ["bending", "rotation", "pelvis_list", "pelvis_tz"];
        middle && words.iter().any(|word| name.contains(word))
    };
    let plane = Mat3::from_columns(Vec3::X, Vec3::Y, -Vec3::Z);
    let flip = |t: Affine| Affine::new(plane * t.linear * plane, plane * t.translation);
    let mut state = 5;
    for _ in 0..40 {
        let stored = inside(&model, &mut state);
        let mut swapped = stored.clone();
        for id in model.coordinate_ids() {
            let name = &model.coordinate(id).name;
            let twin = model.find_coordinate(&other(name)).unwrap();
            let sign = if lateral(name) { -1.0 } else { 1.0 };
            swapped[model.stored_range(twin).start] = sign * stored[model.stored_range(id).start];
        }
        program.evaluate(&stored, Mode::Posed, &mut pose).unwrap();
        program.evaluate(&swapped, Mode::Posed, &mut mirrored).unwrap();
        for id in model.segment_ids() {
            let twin: SegmentId = model.find_segment(&other(&model.segment(id).name)).unwrap();
            let (a, b) = (flip(pose.segment(id)), mirrored.segment(twin));
            let off = numbers(a).into_iter().zip(numbers(b)).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f64::max);
            assert!(off < 1e-9, "{}: {off}", model.segment(id).name);
        }
    }
}

#[test]
fn it_moves_smoothly_inside_its_ranges() {
    let model = human();
    let program = Program::compile(&model);
    let (mut pose, mut before) = (Pose::new(&program), Pose::new(&program));
    let mut state = 11;
    let count = model.stored_len() as f64;
    for _ in 0..60 {
        let (from, to) = (inside(&model, &mut state), inside(&model, &mut state));
        let far = from.iter().zip(&to).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Steps of at most 0.05 degrees in any coordinate, a stretch of 200 of them.
        let step = 0.05f64.to_radians() / far;
        for i in 0..200 {
            let share = 0.3 + step * f64::from(i);
            let mut stored = from.clone();
            model.interpolate(&from, &to, share, &mut stored);
            program.evaluate(&stored, Mode::Posed, &mut pose).unwrap();
            if i > 0 {
                for (a, b) in pose.segments().iter().zip(before.segments()) {
                    let turn = Quat::from_mat3(a.linear).angle_to(Quat::from_mat3(b.linear));
                    let slide = (a.translation - b.translation).norm();
                    // Every coordinate turns a bone by less than twice its own step.
                    let bound = 2.0 * count * 0.05f64.to_radians();
                    assert!(turn < bound && slide < bound, "{turn} {slide}");
                }
            }
            std::mem::swap(&mut pose, &mut before);
        }
    }
}

#[test]
fn marker_sets_are_whole() {
    let model = human();
    let has = |name: &str| model.markers().iter().any(|m| m.name == name);
    // Plug-in Gait, full body without the head's four (names of the Vicon manual).
    for name in [
        "ASI", "PSI", "THI", "KNE", "TIB", "ANK", "HEE", "TOE", "SHO", "UPA", "ELB", "FRM", "WRA",
        "WRB", "FIN", "FHD", "BHD",
    ] {
        assert!(has(&format!("R{name}")) && has(&format!("L{name}")), "{name}");
    }
    for name in ["C7", "T10", "CLAV", "STRN", "RBAK", "SACR"] {
        assert!(has(name), "{name}");
    }
    // Both sides of a landmark lie opposite to each other.
    let point = |name: &str| model.markers().iter().find(|m| m.name == name).unwrap().point;
    for (right, left) in [("RASI", "LASI"), ("r.ASIS", "L.ASIS"), ("GT_r", "GT_l"), ("r_knee", "L_knee")] {
        let (right, left) = (point(right), point(left));
        assert_eq!((right.x, right.y, right.z), (left.x, left.y, -left.z));
    }
}
