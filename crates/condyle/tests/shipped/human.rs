//! The human as a whole: its parts are tested each in a file of its own.

use crate::figure::{Draws, Figure, apart};
use condyle::math::{Affine, Quat};
use condyle::{Mode, Model, Pose};
use condyle::{Severity, check};

/// Stored numbers inside all ranges; the pelvis within half a turn and half a metre.
fn inside(model: &Model, draws: &mut Draws) -> Vec<f64> {
    let mut stored = model.defaults();
    for id in model.coordinate_ids() {
        let (lower, upper) = model.coordinate(id).range.bounds();
        let (lower, upper) = (lower.max(-0.5), upper.min(0.5));
        *model.value_mut(&mut stored, id) = lower + (upper - lower) * draws.share();
    }
    stored
}

#[test]
fn nothing_is_wrong_with_it() {
    let model = Figure::shipped("human").model;
    let said: Vec<_> = check::check(&model, &[])
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
    let human = Figure::shipped("human");
    let pose = human.pose(&human.set(&[]), Mode::Posed);
    for id in human.model.segment_ids() {
        let motion = human.motion(&pose, id);
        let name = &human.model.segment(id).name;
        // What goes through the roots of the scapula's contact is as exact as the digits of its points.
        let bound = if name.contains("scapula") { 1e-11 } else { 1e-12 };
        assert!(apart(motion, Affine::IDENTITY) < bound, "{name}: {motion:?}");
    }
    // It stands: the vertex is above the pelvis, the feet below, the hands beside the thighs.
    let place = |segment: &str| pose.segment(human.id(segment)).translation;
    let (pelvis, head, foot, hand) =
        (place("pelvis"), place("skull"), place("calcaneus_r"), place("hand_r"));
    assert!(head.y - pelvis.y > 0.5 && pelvis.y - foot.y > 0.8);
    assert!((hand.y - pelvis.y).abs() < 0.2 && hand.z > 0.15);
}

#[test]
fn left_mirrors_right() {
    let human = Figure::shipped("human");
    // In the middle of the body what goes to the right goes to the left.
    let mirror = human.mirror(|key| {
        let name = key.rsplit('/').next().unwrap_or(key);
        let middle = !(name.ends_with("_r") || name.ends_with("_l"));
        let words = ["bending", "rotation", "pelvis_list", "pelvis_tz"];
        middle && words.iter().any(|word| name.contains(word))
    });
    let mut draws = Draws(0x9e37_79b9_7f4a_7c15);
    for _ in 0..40 {
        let stored = inside(&human.model, &mut draws);
        let other = mirror.numbers(&stored);
        let [pose, mirrored] = [stored, other].map(|numbers| human.pose(&numbers, Mode::Posed));
        mirror.assert_segments(&pose, &mirrored, 1e-12);
    }
}

#[test]
fn it_moves_smoothly_inside_its_ranges() {
    let Figure { model, program } = Figure::shipped("human");
    let (mut pose, mut before) = (Pose::new(&program), Pose::new(&program));
    let mut draws = Draws(0x1234_5678_9abc_def1);
    let count = model.stored_len() as f64;
    for _ in 0..60 {
        let (from, to) = (inside(&model, &mut draws), inside(&model, &mut draws));
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
    let model = Figure::shipped("human").model;
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
    for (right, left) in
        [("RASI", "LASI"), ("r.ASIS", "L.ASIS"), ("GT_r", "GT_l"), ("r_knee", "L_knee")]
    {
        let (right, left) = (point(right), point(left));
        assert_eq!((right.x, right.y, right.z), (left.x, left.y, -left.z));
    }
}

/// A man or woman of a stature: the head's place above the ground where the pelvis stands as the text
/// says, mm.
#[test]
fn a_person_is_as_tall_as_the_stature() {
    // ANSUR II (2012): of 940 men of 1730 to 1770 mm and 508 women of 1600 to 1640 the heights of
    // suprasternale and tenth rib, of which nothing was built, with one SD and the slopes on stature.
    let [men, women] = [
        [(1433.0, 15.0, 0.877), (1115.0, 22.0, 0.724)],
        [(1321.0, 15.0, 0.874), (1048.0, 19.0, 0.731)],
    ];
    for (stature, woman, mean, measured) in [
        (1.75, 0, 1.75, men),
        (1.62, 0, 1.75, men),
        (1.90, 0, 1.75, men),
        (1.62, 1, 1.62, women),
        (1.75, 1, 1.62, women),
    ] {
        let text = format!(
            "condyle = 1\nkind = \"model\"\ninclude = [\"human.toml\"]\n\
             constants = {{ stature = {stature}, woman = {woman} }}"
        );
        let person = Figure::of(&text);
        let stands = person.model.defaults();
        let pose = person.open(&stands);
        let height = |name: &str| person.marker(&pose, name).y * 1e3;
        let vertex = height("vertex");
        assert!((vertex - 1e3 * stature).abs() < 5.0, "{stature} {woman}: {vertex}");
        // The notch is bone, 5 to 10 mm behind and below its skin; the lowest of the tenth rib half a
        // rib's height below its centreline.
        let found = [height("suprasternal_notch"), height("rib_10_end_r") - 6.0];
        for (found, (height, sd, slope)) in found.into_iter().zip(measured) {
            let expected = height + slope * 1e3 * (stature - mean);
            assert!((found - expected).abs() < sd, "{stature} {woman}: {found}, {expected}");
        }
    }
}
