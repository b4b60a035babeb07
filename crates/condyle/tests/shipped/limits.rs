//! Limits of the human by published formulas: what they say of postures that people take, and of the span of the arm's own
//! turn, against measurements that have no part in them.

use condyle::limits::{LearnedLimit, State};
use condyle::math::{Quat, Vec3};
use condyle::model::component::FieldLimit;
use condyle::{Law, Mode, Model, Pose, Program, shipped};

fn human() -> Model {
    shipped::read("human").unwrap().value.model
}

fn field<'m>(model: &'m Model, set: &str) -> &'m FieldLimit {
    let name = |c: &condyle::Component| model.joint_sets()[c.joint_set.index()].name.clone();
    model
        .components()
        .iter()
        .filter(|c| name(c) == set)
        .find_map(|c| match &c.law {
            Law::Field(law) => Some(law),
            _ => None,
        })
        .unwrap_or_else(|| panic!("no field in {set}"))
}

/// A right humerus in the thorax by plane, elevation and turn inward, in degrees, as shoulder.toml has them.
fn arm(plane: f64, elevation: f64, turn: f64) -> Quat {
    let [plane, elevation, turn] = [plane, elevation, turn].map(f64::to_radians);
    Quat::from_axis_angle(Vec3::Y, plane)
        * Quat::from_axis_angle(-Vec3::X, elevation)
        * Quat::from_axis_angle(Vec3::Y, turn - plane)
}

/// The same with the turn that brings the wrist toward a place: from the shoulder, in metres, forward, up and to the right. The
/// forearm lies in the plane of the upper arm and that place, whatever the elbow's angle is.
fn reaching(plane: f64, elevation: f64, place: [f64; 3]) -> Quat {
    let swung = arm(plane, elevation, 0.0);
    let up = swung.to_mat3() * Vec3::Y;
    // An upper arm of 281 mm.
    let to = Vec3::from(place) + up * 0.281;
    let forearm = to - up * up.dot(to);
    let (x, z) = (swung.to_mat3() * Vec3::X, swung.to_mat3() * Vec3::Z);
    // The forearm bends to the humerus' x; a turn inward by t takes that from x to x cos t - z sin t.
    let turn = (-forearm.dot(z)).atan2(forearm.dot(x));
    arm(plane, elevation, turn.to_degrees())
}

/// Mouth, crown and others of a man of 1.75 m from the middle of his right shoulder.
const MOUTH: [f64; 3] = [0.15, 0.17, -0.19];
const CROWN: [f64; 3] = [0.03, 0.35, -0.17];
const OCCIPUT: [f64; 3] = [-0.09, 0.25, -0.19];
const TEMPLE: [f64; 3] = [0.11, 0.29, -0.10];
const OTHER_SHOULDER: [f64; 3] = [0.01, 0.01, -0.38];
const MIDDLE_OF_BACK: [f64; 3] = [-0.13, -0.24, -0.19];
const POCKET: [f64; 3] = [-0.12, -0.41, -0.07];

#[test]
fn postures_that_people_take_are_possible() {
    let model = human();
    let reach = field(&model, "published_r");
    // Plane and elevation: means of eight people, Harryman et al. 1992 (as the University of Washington gives them); where no
    // turn is given the hand is where its name says.
    for (name, q) in [
        ("arm hanging", arm(0.0, 0.0, 0.0)),
        ("hand at the other shoulder", reaching(124.0, 90.0, OTHER_SHOULDER)),
        ("eating", reaching(87.0, 52.0, MOUTH)),
        ("combing hair", reaching(54.0, 112.0, CROWN)),
        ("hand behind the head", reaching(54.0, 112.0, OCCIPUT)),
        ("maximal elevation", arm(55.0, 148.0, -20.0)),
        ("reach up the back", reaching(-69.0, 56.0, MIDDLE_OF_BACK)),
        ("hand in the back pocket", reaching(-86.0, 38.0, POCKET)),
        ("maximal extension", arm(-88.0, 55.0, 0.0)),
        // Salute: the upper arm level, a little before the side, the hand at the temple.
        ("salute", reaching(20.0, 85.0, TEMPLE)),
        // Forwards and up, turned as 15 men turn it: outward by 3 (Inui et al. 2009); to the side by 27 at 122.
        ("overhead, forwards", arm(90.0, 165.0, -3.0)),
        ("raised to the side", arm(0.0, 122.0, -27.0)),
        // Boone & Azen 1979, 109 men, at 90 degrees of abduction.
        ("turned inward", arm(0.0, 90.0, 69.0)),
        ("turned outward", arm(0.0, 90.0, -104.0)),
    ] {
        assert_eq!(reach.state(&q.to_array()), State::Valid, "{name}");
    }
}

#[test]
fn postures_that_nobody_takes_are_not() {
    let model = human();
    let reach = field(&model, "published_r");
    for (name, q, least) in [
        // The forearm of a hanging arm turned outward into the back; people end at 60 to 90.
        ("forearm through the back", arm(0.0, 5.0, -150.0), 40.0),
        // Boone & Azen 1979: backwards 62.
        ("upper arm up behind the head", arm(-90.0, 120.0, 0.0), 40.0),
        ("behind the head, turned inward", arm(-40.0, 140.0, 80.0), 40.0),
        // Chang et al. 2005: a span of 117 is left at full abduction, and that is outward (Stokdijk et al. 2003).
        ("raised and turned inward", arm(0.0, 160.0, 80.0), 35.0),
        // The elbow level before the chest, the forearm outward and down; outward people end at 45 there.
        ("arm forwards, turned outward", arm(90.0, 90.0, -110.0), 40.0),
    ] {
        assert_eq!(reach.state(&q.to_array()), State::Invalid, "{name}");
        let nearest = reach.limit.field().nearest(reach.inward(q));
        let off = reach.inward(q).angle_to(nearest).to_degrees();
        assert!(off > least, "{name}: {off}");
    }
}

/// The span of the turn about the arm's own axis at a swing, in degrees, within the formulas: 15 beyond them not counted.
fn span(reach: &FieldLimit, plane: f64, elevation: f64) -> f64 {
    let shape = reach.limit.ground().shape.as_deref().unwrap();
    let inside =
        |turn: &i32| shape.contains(reach.inward(arm(plane, elevation, f64::from(*turn) / 4.0)));
    (-720..720).filter(inside).count() as f64 / 4.0
}

/// Chang et al. 2005, of axial rotation: of the whole limb 376 degrees at 90 of abduction and 257 at full abduction, of which the
/// forearm has 140; of humerus on scapula 143 and 69.
#[test]
fn the_span_of_the_arms_own_turn_falls_by_half_as_the_arm_is_raised() {
    let model = human();
    let reach = field(&model, "published_r");
    // Full elevation is before the side: at 55 degrees from it, and 148 high, in Harryman et al. 1992.
    let (raised, full) = (span(reach, 0.0, 90.0), span(reach, 45.0, 148.0));
    assert!((143.0..376.0 - 140.0).contains(&raised), "{raised}");
    assert!((69.0..257.0 - 140.0).contains(&full), "{full}");
    assert!((full / raised - 117.0 / 236.0).abs() < 0.1, "{full} of {raised}");
}

/// What the formulas say as they were published, without what was opened; Chang's half is not in them.
#[test]
fn the_published_form_is_there_alone() {
    let limit = |name: &str| -> LearnedLimit {
        let text = shipped::part(name).unwrap();
        condyle::formats::document::limit::read(text, &mut |_| Err("alone".into())).unwrap().value
    };
    let limit = limit("parts/limit-shoulder-lenarcic1994.toml");
    let shape = limit.ground().shape.clone().unwrap();
    for ([a, f], [low, high]) in [
        ([0.0, 0.0], [-90.0, 60.0]),
        ([0.0, 90.0], [-100.0, 10.0]),
        ([90.0, 0.0], [-20.0, 100.0]),
        ([160.0, 0.0], [-90.0 + 7.0 * 160.0 / 9.0, 60.0 + 4.0 * 160.0 / 9.0]),
    ] {
        let ends = shape.third().at(f64::to_radians(a), f64::to_radians(f)).map(f64::to_degrees);
        assert!((ends[0] - low).abs() < 1e-9 && (ends[1] - high).abs() < 1e-9, "{ends:?}");
    }
}

#[test]
fn both_sides_are_mirror_images() {
    let model = human();
    for set in ["published"] {
        let (right, left) =
            (field(&model, &format!("{set}_r")), field(&model, &format!("{set}_l")));
        for n in 0..400 {
            let t = f64::from(n);
            let q = Quat { x: t.sin(), y: (1.3 * t).cos(), z: (2.1 * t).sin(), w: (0.7 * t).cos() };
            let q = q.normalized();
            // Seen in a mirror across z.
            let mirrored = Quat { x: -q.x, y: -q.y, ..q };
            let distance = |side: &FieldLimit, q: Quat| side.limit.field().distance(side.inward(q));
            let apart = distance(right, q) - distance(left, mirrored);
            assert!(apart.abs() < 1e-12, "{apart}");
            assert_eq!(right.state(&q.to_array()), left.state(&mirrored.to_array()));
        }
    }
}

/// A field moves nothing where limits are off, and where a posture is within its formulas none is made.
#[test]
fn at_rest_the_human_is_within_and_no_pose_by_coordinates_changes() {
    let model = human();
    let program = Program::compile(&model);
    let (mut open, mut posed) = (Pose::new(&program), Pose::new(&program));
    program.evaluate(&model.defaults(), Mode::Open, &mut open).unwrap();
    program.evaluate(&model.defaults(), Mode::Posed, &mut posed).unwrap();
    for row in program.measured_limit_rows() {
        assert!(open.limit_row(*row) >= 0.0 && posed.limit_row(*row) >= 0.0);
    }
    for (set, side) in [("published_r", "r"), ("published_l", "l")] {
        let law = field(&model, set);
        assert!(!law.limit.is_made(), "{set}");
        let frame = |name: &str| open.segment(model.find_segment(name).unwrap()).linear;
        let q = frame("thorax").transpose() * frame(&format!("humerus_{side}"));
        assert!(Quat::from_mat3(q).angle_to(Quat::IDENTITY) < 1e-9);
    }
}
