//! Motions that break their model in one way each, with the frame and the amount.

use condyle_check::motion::{MotionCheck, check};
use condyle_diagnostics::{Diagnostic, Severity};
use condyle_math::function::{Function, FunctionOfSeveral};
use condyle_math::{Quat, Vec3};
use condyle_model::component::{
    AngleNames, Angles, Correlate, Law, Region, RelativeOrientation, Signal,
};
use condyle_model::model::{Closure, Condition};
use condyle_model::{CoordinateKind, Model, ModelBuilder, Range};
use condyle_motion::{AngleUnit, Table};
use std::f64::consts::PI;

/// A thigh on a slide, and a knee whose patella follows it by 10 mm per radian.
fn leg() -> ModelBuilder {
    let mut b = ModelBuilder::new("leg");
    let thigh = b.segment("thigh", None);
    let shank = b.segment("shank", Some(thigh));
    let patella = b.segment("patella", Some(thigh));
    b.place_joint(shank, Vec3::new(0.0, -0.4, 0.0));
    let slide = b.joint_set("slide");
    let height = b.coordinate(slide, "height", CoordinateKind::Translation);
    b.coordinate_mut(height).range = Range { enforced: false, ..Range::new(0.0, 1.0) };
    let up = b.translate(slide, "up", height, Vec3::Y);
    b.output(slide, thigh, up);
    let (set, knee) = b.hinge("knee", shank, "flexion", Vec3::Z);
    b.coordinate_mut(knee).range = Range::new(0.0, 120f64.to_radians());
    let glide_set = b.joint_set("patella");
    let glide = b.coordinate(glide_set, "glide", CoordinateKind::Translation);
    let law = b.map(set, "law", knee, Function::linear(0.01, 0.0));
    b.follow(glide, law);
    let along = b.translate(glide_set, "along", glide, Vec3::X);
    b.output(glide_set, patella, along);
    b
}

fn model(b: ModelBuilder) -> Model {
    b.build().expect("a model")
}

/// A motion at 100 Hz in degrees and metres.
fn motion(columns: &[&str], rows: &[&[f64]]) -> Table {
    Table {
        columns: columns.iter().map(|c| (*c).to_owned()).collect(),
        times: (0..rows.len()).map(|i| i as f64 / 100.0).collect(),
        values: rows.concat(),
        angle_unit: AngleUnit::Degrees,
        ..Table::default()
    }
}

fn codes(check: &MotionCheck) -> Vec<(Severity, &str)> {
    check.findings.iter().map(|f: &Diagnostic| (f.severity, f.code)).collect()
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "found {found}, expected {expected}");
}

/// A knee that people bend by 110 degrees on average, of the 120 that it can.
#[test]
fn what_few_people_reach_is_a_note() {
    let mut b = leg();
    let knee = b.clone().build().expect("a model").find_coordinate("flexion").expect("a knee");
    b.coordinate_mut(knee).typical = Some([0.0, 110f64.to_radians()]);
    let rows: [&[f64]; 4] = [&[0.9, 105.0], &[0.9, 112.0], &[0.9, 118.0], &[0.9, 110.0]];
    let check = check(&model(b), &motion(&["height", "flexion"], &rows));
    assert_eq!(codes(&check), [(Severity::Note, "motion/uncommon")]);
    let found = check.uncommon[0];
    assert_eq!((found.frames, found.frame), (2, 2));
    near(found.by, 8f64.to_radians());
    assert!(check.findings[0].message.contains("in 2 frames; most in frame 2 (0.02 s): 118°"));
}

#[test]
fn a_motion_that_holds() {
    let rows: [&[f64]; 3] = [&[0.9, 0.0], &[1.0, 60.0], &[0.95, 120.0]];
    let check = check(&model(leg()), &motion(&["height", "flexion"], &rows));
    assert_eq!(check, MotionCheck { frames: 3, ..MotionCheck::default() });
    assert!(check.holds());
}

#[test]
fn frames_outside_ranges() {
    let rows: [&[f64]; 6] =
        [&[0.9, 10.0], &[0.9, -4.0], &[0.9, -9.0], &[1.0025, 20.0], &[0.9, 70.0], &[0.9, 120.5]];
    let check = check(&model(leg()), &motion(&["height", "flexion"], &rows));
    assert_eq!(
        codes(&check),
        [(Severity::Error, "motion/outside-range"), (Severity::Warning, "motion/outside-range")]
    );
    let frames: Vec<usize> = check.violations.iter().map(|v| v.frame).collect();
    assert_eq!(frames, [1, 2, 3, 5]);
    let knee = &check.outside[0];
    assert_eq!((knee.frames, &knee.runs[..], knee.enforced), (3, &[[1, 2], [5, 5]][..], true));
    assert_eq!(knee.worst.frame, 2);
    near(knee.worst.time, 0.02);
    near(knee.worst.value, -9f64.to_radians());
    near(knee.worst.by, 9f64.to_radians());
    near(knee.worst.limit, 0.0);
    near(knee.worst.nearest, 0.0);
    near(check.violations[3].nearest, 120f64.to_radians());
    let height = &check.outside[1];
    assert!(!height.enforced);
    near(height.worst.by, 0.0025);
    assert_eq!(height.source, "the model's range (declared, not enforced)");
    assert!(check.findings[0].message.contains("most in frame 2 (0.02 s): -9°, 9° beyond 0°"));
}

#[test]
fn a_circle_has_no_end_unless_something_reads_the_angle() {
    let rows: [&[f64]; 2] = [&[0.9, 170.0], &[0.9, 190.0]];
    let beyond = |follower: bool| {
        let mut b = ModelBuilder::new("arm");
        let arm = b.segment("arm", None);
        let (set, turn) = b.hinge("shoulder", arm, "flexion", Vec3::Z);
        b.coordinate_mut(turn).range = Range::new(-PI, PI);
        if follower {
            let hand = b.segment("hand", Some(arm));
            let slide = b.joint_set("slide");
            let glide = b.coordinate(slide, "glide", CoordinateKind::Translation);
            let law = b.map(set, "law", turn, Function::linear(0.01, 0.0));
            b.follow(glide, law);
            let along = b.translate(slide, "along", glide, Vec3::X);
            b.output(slide, hand, along);
        }
        let model = model(b);
        let check = check(&model, &motion(&["height", "flexion"], &rows));
        let circles = condyle_check::circles(&model).len();
        (circles, check.violations.iter().map(|v| v.frame).collect::<Vec<_>>())
    };
    assert_eq!(beyond(false), (1, vec![]));
    // The glide is 10 mm a radian: a whole turn moves the hand by 63 mm.
    assert_eq!(beyond(true), (0, vec![1]));
}

#[test]
fn a_source_is_cited() {
    let mut b = leg();
    let knee = b.coordinate_at(1).expect("the knee");
    b.coordinate_mut(knee).source = Some("Norkin & White 2016".into());
    let check = check(&model(b), &motion(&["height", "flexion"], &[&[0.9, 130.0]]));
    assert_eq!(check.outside[0].source, "Norkin & White 2016 (enforced)");
    // 10° above the limit, and the nearest value is the limit.
    near(check.outside[0].worst.by, 10f64.to_radians());
}

#[test]
fn columns_that_contradict_their_leaders() {
    // 0.01 m per radian at 90° is 15.708 mm.
    let law = 0.01 * 90f64.to_radians();
    let rows: [&[f64]; 3] =
        [&[0.9, 90.0, law], &[0.9, 90.0, law + 0.003], &[0.9, 90.0, law - 5e-5]];
    let check = check(&model(leg()), &motion(&["height", "flexion", "glide"], &rows));
    assert_eq!(codes(&check), [(Severity::Warning, "motion/coupled")]);
    let said = &check.disagreements[0];
    assert_eq!((said.frames, said.frame), (1, 1));
    near(said.value, law + 0.003);
    near(said.expected, law);
}

#[test]
fn loops_that_open() {
    let mut b = leg();
    // A foot on a rail: the ankle stays where the straight leg put it.
    let at = [(b.segment_at(1), Vec3::new(0.0, -0.4, 0.0)), (None, Vec3::new(0.0, -0.8, 0.0))];
    b.closure(Closure { name: "rail".into(), condition: Condition::Points { at } });
    let rows: [&[f64]; 3] = [&[0.0, 0.0], &[0.0, 0.1], &[0.0, 60.0]];
    let check = check(&model(b), &motion(&["height", "flexion"], &rows));
    assert_eq!(codes(&check), [(Severity::Warning, "motion/open-loop")]);
    let open = &check.open_loops[0];
    // A chord of 60° is the radius; that of 0.1° is 0.7 mm and does not count.
    assert_eq!((open.frames, open.frame, open.shown().as_str()), (1, 2, "400 mm"));
    near(open.metres, 0.4);
}

#[test]
fn jumps_and_wraps() {
    let mut b = ModelBuilder::new("top");
    let top = b.segment("top", None);
    b.hinge("spin", top, "spin", Vec3::Y);
    let rows: [&[f64]; 6] = [&[170.0], &[179.0], &[-178.0], &[-100.0], &[f64::NAN], &[100.0]];
    let check = check(&model(b), &motion(&["spin"], &rows));
    let warnings = ["motion/blank", "motion/jump", "motion/wrap"];
    let mut found: Vec<&str> = codes(&check).iter().map(|c| c.1).collect();
    found.sort_unstable();
    assert_eq!(found, warnings);
    assert_eq!(check.blank, 1);
    let jumps: Vec<_> = check.jumps.iter().map(|j| (j.frame, j.wrap)).collect();
    // Nothing is known about the step over the blank cell.
    assert_eq!(jumps, [(2, true), (3, false)]);
    near(check.jumps[0].by, -357f64.to_radians());
    near(check.jumps[1].by, 78f64.to_radians());
}

#[test]
fn an_orientation_jumps_by_its_own_angle() {
    let mut b = ModelBuilder::new("ball");
    let ball = b.segment("ball", None);
    b.ball_joint("hip", ball);
    let quat =
        |degrees: f64| Quat::from_axis_angle(Vec3::Z, degrees.to_radians()).to_array().to_vec();
    // The same rotation with its sign turned is no jump.
    let negated: Vec<f64> = quat(20.0).iter().map(|v| -v).collect();
    let rows = [quat(10.0), negated, quat(95.0)];
    let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
    let names = ["orientation.qx", "orientation.qy", "orientation.qz", "orientation.qw"];
    let check = check(&model(b), &motion(&names, &rows));
    assert_eq!(check.jumps.len(), 1, "{:?}", check.findings);
    assert_eq!(check.jumps[0].frame, 2);
    near(check.jumps[0].by, 75f64.to_radians());
}

#[test]
fn columns_missing_and_unknown() {
    let table = motion(&["flexion", "flexoin", "/forceset/soleus/activation"], &[&[5.0, 5.0, 0.1]]);
    let check = check(&model(leg()), &table);
    assert_eq!(
        codes(&check),
        [(Severity::Warning, "motion/missing"), (Severity::Warning, "motion/unknown")]
    );
    assert_eq!(check.missing.len(), 1, "the follower is not missed");
    assert_eq!(check.unknown, ["flexoin"]);
}

#[test]
fn degrees_taken_for_radians() {
    let mut b = ModelBuilder::new("top");
    let top = b.segment("top", None);
    b.hinge("spin", top, "spin", Vec3::Y);
    let mut table = motion(&["spin"], &[&[30.0], &[30.5]]);
    table.angle_unit = AngleUnit::Unstated;
    let model = model(b);
    assert_eq!(codes(&check(&model, &table)), [(Severity::Warning, "motion/units")]);
    table.angle_unit = AngleUnit::Degrees;
    assert_eq!(codes(&check(&model, &table)), []);
}

#[test]
fn a_follower_without_a_unit_may_be_written_in_degrees() {
    let mut b = ModelBuilder::new("knee");
    let shank = b.segment("shank", None);
    let (set, knee) = b.hinge("knee", shank, "flexion", Vec3::Z);
    let beta = b.coordinate(set, "beta", CoordinateKind::Other);
    let law = b.map(set, "law", knee, Function::linear(1.0, 0.0));
    b.follow(beta, law);
    let model = model(b);
    // Some programs write such a coordinate in radians, others in degrees; 50 is neither.
    for (value, expected) in [(30f64.to_radians(), 0), (30.0, 0), (50.0, 1)] {
        let check = check(&model, &motion(&["flexion", "beta"], &[&[30.0, value]]));
        assert_eq!(check.disagreements.len(), expected, "{value}");
    }
}

#[test]
fn angles_that_are_renamed_are_no_jump() {
    // At the gimbal lock of z, x, y the first and the third angle turn about one axis: 100 degrees of the one
    // and -100 of the other together leave the segment where it was.
    let mut b = ModelBuilder::new("arm");
    let arm = b.segment("arm", None);
    let set = b.joint_set("shoulder");
    let mut turns = vec![];
    for (name, axis) in [("plane", Vec3::Z), ("elevation", Vec3::X), ("turn", Vec3::Z)] {
        let id = b.coordinate(set, name, CoordinateKind::Rotation);
        turns.push(b.rotate(set, &format!("about_{name}"), id, axis));
    }
    let whole = b.product(set, "whole", turns);
    b.output(set, arm, whole);
    let model = model(b);
    let columns = ["plane", "elevation", "turn"];
    let renamed = check(&model, &motion(&columns, &[&[0.0, 5.0, 0.0], &[100.0, 5.0, -100.0]]));
    assert_eq!(
        codes(&renamed),
        [(Severity::Note, "motion/renamed"), (Severity::Note, "motion/renamed")]
    );
    // The chord: with 5 degrees of elevation the segment turns by 2·asin(sin 5° · sin 50°)... less than 9.
    assert!(
        renamed.jumps.iter().all(|jump| jump.turned < 9f64.to_radians()),
        "{:?}",
        renamed.jumps
    );
    assert!(renamed.holds());
    let jumped = check(&model, &motion(&columns, &[&[0.0, 5.0, 0.0], &[100.0, 5.0, 0.0]]));
    assert_eq!(codes(&jumped), [(Severity::Warning, "motion/jump")]);
    near(jumped.jumps[0].turned, 100f64.to_radians());
}

/// A law that was learned for flexion from 0 to 90 degrees and rotation near a tenth of it.
#[test]
fn a_law_outside_its_region_is_told_by_frame() {
    let mut b = ModelBuilder::new("knee");
    let shank = b.segment("shank", None);
    let (set, flexion) = b.hinge("knee", shank, "flexion", Vec3::Z);
    let rotation = b.coordinate(set, "rotation", CoordinateKind::Rotation);
    let tx = b.coordinate(set, "tx", CoordinateKind::Translation);
    let high = [90f64.to_radians(), 9f64.to_radians()];
    // Across the line of rotation = flexion/10 the spread is small: 1 degree is 1, along it 30 degrees are.
    let (along, across) = (30f64.to_radians(), 1f64.to_radians());
    let (a, c) = (1.0 / (along * along), 1.0 / (across * across));
    let region = Region {
        low: vec![0.0, 0.0],
        high: high.to_vec(),
        centre: high.map(|h| 0.5 * h).to_vec(),
        inverse: vec![a + 0.01 * c, -0.1 * c, -0.1 * c, c],
        distance: 2.0,
    };
    let function = FunctionOfSeveral::Linear { slopes: vec![0.01, 0.0], intercept: 0.0 };
    let law = Law::Correlate(Correlate { function, region: Some(region) });
    let law = b.component(set, "tx_law", law, vec![flexion.into(), rotation.into()]);
    b.follow(tx, law);
    let model = model(b);
    let columns = ["flexion", "rotation"];
    let frames: [&[f64]; 5] =
        [&[45.0, 4.5], &[100.0, 9.0], &[101.0, 9.0], &[10.0, 8.0], &[30.0, 3.5]];
    let check = check(&model, &motion(&columns, &frames));
    let found = &check.extrapolated[0];
    assert_eq!((found.frames, &found.runs[..]), (3, &[[1, 3]][..]));
    // (7 across, 35/30 along) by the formula of the ellipsoid: √(49 + 1.36)/2.
    assert_eq!(found.frame, 3);
    near(found.distance, (49.0 + (35.0f64 / 30.0).powi(2)).sqrt() / 2.0);
    assert_eq!((found.beyond, check.frames), (None, 5));
    assert_eq!(codes(&check)[0], (Severity::Warning, "motion/beyond-learned"));
}

/// The same for a law of the angles of a segment whose joint is no coordinate of one number.
#[test]
fn a_law_of_angles_outside_its_region_is_told_too() {
    let mut b = ModelBuilder::new("knee");
    let shank = b.segment("shank", None);
    let (set, _) = b.hinge("knee", shank, "flexion", Vec3::Z);
    let relative = Law::RelativeOrientation(RelativeOrientation { reference: false });
    let turned = b.component(set, "turned", relative, vec![shank.into()]);
    let angles = Angles { names: AngleNames::Euler("zxy".parse().unwrap()), mirrored: None };
    let Signal::Output(angles, _) = b.component(set, "angles", Law::Angles(angles), vec![turned])
    else {
        panic!("a component has outputs")
    };
    let region = Region {
        low: vec![0.0],
        high: vec![90f64.to_radians()],
        centre: vec![45f64.to_radians()],
        inverse: vec![1.0],
        distance: 2.0,
    };
    let function = FunctionOfSeveral::Linear { slopes: vec![0.01], intercept: 0.0 };
    let law = Law::Correlate(Correlate { function, region: Some(region) });
    let law = b.component(set, "law", law, vec![Signal::Output(angles, 0)]);
    // What the law says moves another segment.
    let foot = b.segment("foot", Some(shank));
    let slide = b.translate(set, "slide", law, Vec3::X);
    b.output(set, foot, slide);
    let model = model(b);
    let check = check(&model, &motion(&["flexion"], &[&[45.0], &[100.0], &[80.0]]));
    let found = &check.extrapolated[0];
    assert_eq!((found.frames, found.frame), (1, 1));
    assert_eq!(found.controls[0].0.name(&model), "angles");
    near(found.controls[0].1, 100f64.to_radians());
    let (first, by) = found.beyond.unwrap();
    assert_eq!(first, 0);
    near(by, 10f64.to_radians());
}
