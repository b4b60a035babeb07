//! What a tracking says where the recording or the model is not what it should be, on generated data:
//! a body whose limbs swing, of which every variant is known to be wrong.

use condyle::formats::Recording;
use condyle::math::Vec3;
use condyle::model::{Mode, Range};
use condyle::tracking::{Request, Tracking, Variant, track};
use condyle::{Model, ModelBuilder, Pose, Program, SegmentId};

/// How the body stands in the world, and what of it can move.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Free,
    /// Its trunk turns forwards and sideways by less than 60°.
    Upright,
    Locked,
    /// Its markers are fixed in the world, where they are at rest.
    OnGround,
}

/// A trunk with two arms and two legs, each of two segments, and markers that are the same on both sides.
fn body(kind: Kind) -> Model {
    let mut b = ModelBuilder::new("body");
    let trunk = b.segment("trunk", None);
    let root = b.joint_set("root");
    use condyle::model::CoordinateKind::{Rotation, Translation};
    let axes = [Vec3::Y, Vec3::X, Vec3::Z];
    let mut factors = vec![];
    let places = ["x", "y", "z"].map(|n| b.coordinate(root, n, Translation));
    for (name, (place, axis)) in
        ["x", "y", "z"].iter().zip(places.into_iter().zip([Vec3::X, Vec3::Y, Vec3::Z]))
    {
        factors.push(b.translate(root, &format!("move_{name}"), place, axis));
    }
    let turns = ["heading", "list", "tilt"].map(|n| b.coordinate(root, n, Rotation));
    for (name, (turn, axis)) in ["h", "l", "t"].iter().zip(turns.into_iter().zip(axes)) {
        factors.push(b.rotate(root, &format!("turn_{name}"), turn, axis));
    }
    let whole = b.product(root, "whole", factors);
    b.output(root, trunk, whole);
    if kind == Kind::Upright {
        for turn in &turns[1..] {
            b.coordinate_mut(*turn).range = Range::new(-1.0, 1.0);
        }
    }
    let marker =
        |b: &mut ModelBuilder, name: &str, segment: SegmentId, at: Vec3, world: Vec3| match kind {
            Kind::OnGround => b.marker(name, None, world),
            _ => b.marker(name, Some(segment), at),
        };
    for (name, x, y, z) in
        [("NECK", -0.05, 0.5, 0.0), ("STERNUM", 0.12, 0.35, 0.0), ("SACRUM", -0.14, 0.02, 0.0)]
    {
        let at = Vec3::new(x, y, z);
        marker(&mut b, name, trunk, at, at);
    }
    for (side, sign) in [("L", -1.0), ("R", 1.0)] {
        let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, sign * z);
        let front = at(0.1, 0.03, 0.13);
        marker(&mut b, &format!("{side}ASI"), trunk, front, front);
        for (limb, top, length) in
            [("LEG", at(0.0, -0.05, 0.09), 0.43), ("ARM", at(0.0, 0.42, 0.19), 0.28)]
        {
            let upper = b.segment(&format!("{side}{limb}_upper"), Some(trunk));
            b.place_joint(upper, top);
            let lower = b.segment(&format!("{side}{limb}_lower"), Some(upper));
            let down = Vec3::new(0.0, -length, 0.0);
            b.place_joint(lower, down);
            let bend = if limb == "LEG" { -Vec3::Z } else { Vec3::Z };
            let hinge = |b: &mut ModelBuilder, name: String, segment, axis, lower, upper| {
                let (_, id) = b.hinge(&name, segment, "angle", axis);
                b.coordinate_mut(id).range = Range::new(lower, upper);
            };
            hinge(&mut b, format!("{side}{limb}_top"), upper, Vec3::Z, -1.2, 1.5);
            hinge(&mut b, format!("{side}{limb}_bend"), lower, bend, 0.0, 2.2);
            for (name, segment, p) in [
                ("UP", upper, at(0.05, -0.3 * length, 0.03)),
                ("OUT", upper, at(0.0, -length, 0.05)),
                ("IN", upper, at(0.0, -length, -0.04)),
                ("LOW", lower, at(0.04, -0.4 * length, 0.02)),
                ("END", lower, at(0.0, -length, 0.04)),
            ] {
                let world = top + p + if segment == lower { down } else { Vec3::ZERO };
                marker(&mut b, &format!("{side}{limb}{name}"), segment, p, world);
            }
        }
    }
    if kind == Kind::Locked {
        for coordinate in 0..14 {
            let id = b.coordinate_at(coordinate).unwrap();
            b.coordinate_mut(id).locked = true;
        }
    }
    b.build().unwrap()
}

/// A walk of the free body, with every marker moved by a few millimetres of its own.
fn walk(frames: usize) -> Recording {
    let model = body(Kind::Free);
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let mut recording = Recording {
        labels: model.markers().iter().map(|m| m.name.clone()).collect(),
        rate: 50.0,
        ..Recording::default()
    };
    for frame in 0..frames {
        let t = frame as f64 / 50.0;
        let s = (6.0 * t).sin();
        let swing = |sign: f64| 0.4 * sign * s;
        let bend = |phase: f64| 0.5 + 0.4 * (6.0 * t + phase).sin();
        let limbs = [
            [swing(1.0), bend(0.0)],
            [swing(-1.0), bend(0.5)],
            [swing(-1.0), bend(3.1)],
            [swing(1.0), bend(3.6)],
        ];
        let mut stored = vec![1.2 * t, 0.95, 0.1, 0.2 + 0.1 * s, 0.05 * s, -0.1];
        stored.extend(limbs.concat());
        program.evaluate(&stored, Mode::Open, &mut pose).unwrap();
        recording.times.push(t);
        for (i, marker) in model.markers().iter().enumerate() {
            let off = |axis: usize| 0.003 * ((7 * i + 3 * axis) as f64 + 4.0 * t).sin();
            let p = pose.frame(marker.segment) * marker.point + Vec3::new(off(0), off(1), off(2));
            recording.positions.push(p.to_array().into());
        }
    }
    recording
}

fn tracked(kind: Kind, recording: &Recording) -> Tracking {
    let request = Request { threads: Some(1), ..Request::default() };
    track(&body(kind), recording, &request, &mut |_, _| {}).unwrap()
}

/// The sentence about a tracking that is not plausible.
#[track_caller]
fn cause(kind: Kind, variant: &Variant) -> (String, Option<Variant>) {
    let tracking = tracked(kind, &variant.of(&walk(40)));
    assert!(!tracking.verdict.plausible, "RMS {}", tracking.summary().rms);
    (tracking.verdict.cause.unwrap().message, tracking.verdict.remedy)
}

/// Positions of the labels of both sides.
fn sides(recording: &Recording) -> Vec<[usize; 2]> {
    let left = recording.labels.iter().enumerate().filter(|(_, label)| label.starts_with('L'));
    let right = |label: &str| recording.marker(&format!("R{}", &label[1..])).unwrap();
    left.map(|(index, label)| [index, right(label)]).collect()
}

#[test]
fn a_clean_trial_is_plausible_and_says_nothing() {
    for kind in [Kind::Free, Kind::Upright] {
        let tracking = tracked(kind, &walk(40));
        // Three parts of 3 mm amplitude: at most 3 √3 mm, of which the fit takes some.
        assert!(tracking.summary().rms < 0.003 * 3f64.sqrt(), "{}", tracking.summary().rms);
        assert!(tracking.verdict.plausible && tracking.verdict.cause.is_none());
        assert!(tracking.warnings.is_empty(), "{:?}", tracking.warnings);
    }
}

#[test]
fn exchanged_sides_and_mirrors_are_told_apart_or_both_named() {
    let pairs = sides(&walk(1));
    let (said, remedy) = cause(Kind::Upright, &Variant::Exchanged(pairs));
    assert!(said.contains("left and right labels are exchanged"), "{said}");
    assert!(remedy.is_some());
    for axis in 0..3 {
        let (said, _) = cause(Kind::Upright, &Variant::Mirrored(axis));
        assert!(said.contains("mirrored"), "{axis}: {said}");
    }
}

#[test]
fn wrong_units_are_named_with_their_factor() {
    for (factor, said) in [
        (1000.0, "1000 times too large"),
        (10.0, "10 times too large"),
        (0.1, "10 times too small"),
        (0.001, "1000 times too small"),
    ] {
        let (found, remedy) = cause(Kind::Free, &Variant::Scaled(factor));
        assert!(found.contains(said), "{found}");
        let Some(Variant::Scaled(back)) = remedy else { panic!("{remedy:?}") };
        assert!((back * factor - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_body_that_cannot_lie_has_turned_axes_and_one_that_can_is_warned_about() {
    // Quarter turns about x bring y to z and z to -y, about z bring x to y.
    for (axis, quarters, points_along) in
        [(0, 1, "z"), (0, 3, "-z"), (2, 3, "x"), (2, 1, "-x"), (0, 2, "-y")]
    {
        let variant = Variant::Turned { axis, quarters };
        let (said, remedy) = cause(Kind::Upright, &variant);
        let named = if quarters == 2 { "upside down" } else { "axes of the recording are turned" };
        assert!(said.contains(named), "{said}");
        assert!(matches!(remedy, Some(Variant::Turned { .. })), "{remedy:?}");
        let tracking = tracked(Kind::Free, &variant.of(&walk(40)));
        assert!(tracking.verdict.plausible, "{:?}", tracking.verdict);
        let said: Vec<_> = tracking.warnings.iter().map(|w| (w.code, w.message.clone())).collect();
        assert_eq!(said.len(), 1, "{said:?}");
        assert_eq!(said[0].0, "track/lying");
        assert!(said[0].1.ends_with(&format!("points along {points_along}")), "{}", said[0].1);
    }
}

#[test]
fn permuted_labels_are_named() {
    let count = walk(1).labels.len();
    // Every label takes the place of the seventh after it.
    let order = (0..count).map(|i| (i + 7) % count).collect();
    let (said, _) = cause(Kind::Upright, &Variant::Permuted(order));
    assert!(said.contains("labels are permuted"), "{said}");
}

#[test]
fn what_cannot_move_is_named() {
    let clean = Variant::Scaled(1.0);
    let (said, _) = cause(Kind::Locked, &clean);
    assert_eq!(said, "nothing can move: every coordinate of the model is locked");
    let (said, _) = cause(Kind::OnGround, &clean);
    assert!(said.ends_with("lie on the ground"), "{said}");
}

#[test]
fn the_bound_can_be_set_and_names_the_worst() {
    let mut recording = walk(40);
    let far = recording.marker("RARMEND").unwrap();
    for row in recording.positions.chunks_exact_mut(recording.labels.len()) {
        row[far].position_mut().unwrap()[1] += 1.5;
    }
    let run = |max_rms| {
        let request = Request { max_rms, ..Request::default() };
        track(&body(Kind::Upright), &recording, &request, &mut |_, _| {}).unwrap().verdict
    };
    let bad = run(0.1);
    let said = bad.cause.unwrap().message;
    assert!(!bad.plausible && said.contains("`RARMEND`") && bad.remedy.is_none(), "{said}");
    assert!(run(1.0).plausible);
}

#[test]
fn two_labels_that_are_exchanged_throughout_are_a_warning() {
    let recording = walk(40);
    let pair = ["LLEGEND", "LARMEND"].map(|label| recording.marker(label).unwrap());
    let tracking = tracked(Kind::Upright, &Variant::Exchanged(vec![pair]).of(&recording));
    let said = tracking.warnings.iter().find(|w| w.code == "track/exchanged");
    let exchanged = said.is_some_and(|w| w.message.contains("`LLEGEND` and `LARMEND`"));
    let named = tracking.verdict.cause.is_some_and(|cause| cause.message.contains("permuted"));
    assert!(exchanged || named, "{:?}", tracking.warnings);
}

#[test]
fn weights_out_of_bounds_and_unknown_names_are_refused() {
    let asked = |pattern: &str, weight| {
        let request = Request { weights: vec![(pattern.into(), weight)], ..Request::default() };
        track(&body(Kind::Free), &walk(3), &request, &mut |_, _| {}).map(|t| t.markers.len())
    };
    for weight in [1e308, f64::INFINITY, f64::NAN, -1.0, 1e-300] {
        let error = asked("*", weight).unwrap_err();
        assert_eq!(error.code(), "track/weight", "{weight}");
    }
    let error = asked("STERNOM", 1.0).unwrap_err();
    assert_eq!(error.code(), "track/unknown-marker");
    assert!(error.to_string().contains("did you mean `STERNUM`?"), "{error}");
    // 25 markers, of which ten are on the legs.
    assert_eq!(asked("*LEG*", 0.0).unwrap(), 15);
    assert_eq!(asked("*", 1e9).unwrap(), 25);
}

#[test]
fn a_table_names_the_first_that_the_model_has() {
    let mut recording = walk(3);
    recording.labels.iter_mut().for_each(|label| *label = format!("Anna:{label}x"));
    let all = recording.labels.clone();
    let bare = |label: &String| label.trim_start_matches("Anna:").to_owned();
    let names =
        all.iter().map(|label| (bare(label), vec!["nobody".into(), bare(label).replace('x', "")]));
    let request = Request { names: names.collect(), ..Request::default() };
    let tracking = track(&body(Kind::Free), &recording, &request, &mut |_, _| {}).unwrap();
    assert_eq!(tracking.markers.len(), 25);
    assert!(tracking.summary().rms < 0.003 * 3f64.sqrt());
    let wrong = vec![
        ("NECKx".to_owned(), vec!["NEK".to_owned()]),
        ("STERNUMx".into(), vec!["STERNUM".into()]),
    ];
    let request = Request { names: wrong, ..Request::default() };
    let tracking = track(&body(Kind::Free), &recording, &request, &mut |_, _| {}).unwrap();
    assert_eq!(tracking.markers, ["STERNUM"]);
    assert!(tracking.warnings.iter().any(|w| w.to_string().contains("did you mean `NECK`?")));
}

/// The shared recording of a walk, its model scaled by hand, and the permuted labels beside it.
#[test]
fn a_real_walk_is_plausible_until_something_is_done_to_it() {
    let shared = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = shared.join("data/knee/opencap4");
    if !folder.is_dir() {
        println!("skipped: the shared data folder is absent");
        return;
    }
    let model = condyle::open::model(&folder.join("manually_scaled.osim")).unwrap().value;
    let open = |path: &std::path::Path| condyle::open::recording(path).unwrap().value;
    let clean = open(&folder.join("walking1.trc"));
    let verdict = |recording: &Recording| {
        let request = Request { threads: Some(1), ..Request::default() };
        let tracking = track(&model, recording, &request, &mut |_, _| {}).unwrap();
        let said = tracking.verdict.cause.map(|cause| cause.message);
        assert_eq!(tracking.verdict.plausible, said.is_none());
        (said, tracking.warnings.iter().any(|w| w.code == "track/lying"))
    };
    assert_eq!(verdict(&clean), (None, false));
    let partner = |label: &str| {
        let (side, rest) = label.split_at(1);
        let names = if side == "L" { ["R", "r"] } else { ["L", "L"] };
        names.iter().find_map(|side| clean.marker(&format!("{side}{rest}")))
    };
    let left = clean.labels.iter().enumerate().filter(|(_, label)| label.starts_with('L'));
    let sides = left.filter_map(|(i, label)| Some([i, partner(label)?])).collect();
    let turned = |axis, quarters| Variant::Turned { axis, quarters };
    for (variant, words) in [
        (Variant::Exchanged(sides), "left and right labels are exchanged"),
        (Variant::Mirrored(2), "mirrored"),
        (turned(0, 2), "upside down"),
        (Variant::Scaled(1000.0), "1000 times too large"),
        (Variant::Scaled(0.001), "1000 times too small"),
    ] {
        let said = verdict(&variant.of(&clean)).0.unwrap_or_default();
        assert!(said.contains(words), "{variant}: {said}");
    }
    // A recording whose z axis points up fits: the body lies.
    assert_eq!(verdict(&turned(0, 1).of(&clean)), (None, true));
    let permuted = open(&shared.join("cases/tracking/labels_permuted.trc"));
    assert!(verdict(&permuted).0.unwrap_or_default().contains("labels are permuted"));
}
