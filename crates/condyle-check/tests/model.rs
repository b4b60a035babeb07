//! Each rule with a model that breaks it and nothing else, and one beside it that is sound.

use condyle_check as lint;
use condyle_diagnostics::{Diagnostic, Severity};
use condyle_math::function::{Function, PiecewiseLinear, SimmSpline};
use condyle_math::{Affine, Vec3};
use condyle_model::component::{
    Contact, ContactPair, Ellipse, Gliding, JointCone, Law, Signal, Swinging,
};
use condyle_model::model::{Closure, Condition};
use condyle_model::{Cone, ConePoint, Projection};
use condyle_model::{CoordinateKind, Model, ModelBuilder, Range};

/// What is found in a model that its builder accepts.
fn found(builder: ModelBuilder) -> Vec<Diagnostic> {
    let model: Model = builder.build().expect("a model");
    lint::check(&model, &[])
}

/// The one thing that is found.
#[track_caller]
fn only(builder: ModelBuilder, severity: Severity, code: &str) -> Diagnostic {
    let findings = found(builder);
    assert_eq!(findings.len(), 1, "{findings:#?}");
    assert_eq!((findings[0].severity, findings[0].code), (severity, code), "{findings:#?}");
    findings.into_iter().next().expect("one finding")
}

#[track_caller]
fn sound(builder: ModelBuilder) {
    assert_eq!(found(builder), []);
}

fn degrees(lower: f64, upper: f64) -> Range {
    Range::new(lower.to_radians(), upper.to_radians())
}

/// A hinge whose range and default (radians) are the only things of interest.
fn hinge(range: Range, default: f64) -> ModelBuilder {
    let mut b = ModelBuilder::new("hinge");
    let shank = b.segment("shank", None);
    let (_, knee) = b.hinge("knee", shank, "flexion", Vec3::Z);
    b.coordinate_mut(knee).range = range;
    b.coordinate_mut(knee).default[0] = default;
    b
}

/// The names of a finding's subjects.
fn names(finding: &Diagnostic) -> Vec<&str> {
    finding.subjects.iter().map(|subject| subject.name()).collect()
}

#[test]
fn limits_that_cross() {
    // The builder refuses enforced ones, so only a declared range can get here.
    let declared = Range { enforced: false, ..Range::new(-0.1, -0.4) };
    let finding = only(hinge(declared, -0.2), Severity::Error, "lint/crossing-range");
    // 0.1 and 0.4 radians: 180/π times as many degrees.
    assert!(finding.message.contains("lower limit -5.73° above its upper limit -22.92°"));
    assert_eq!(names(&finding), ["flexion"]);
    sound(hinge(Range { enforced: false, ..Range::new(-0.4, -0.1) }, -0.2));
}

#[test]
fn people_reach_what_the_range_allows() {
    let hinge = |typical: [f64; 2]| {
        let mut b = ModelBuilder::new("hinge");
        let segment = b.segment("arm", None);
        let (_, flexion) = b.hinge("elbow", segment, "flexion", Vec3::Z);
        b.coordinate_mut(flexion).range = degrees(0.0, 140.0);
        b.coordinate_mut(flexion).typical = Some(typical.map(f64::to_radians));
        b
    };
    let finding = only(hinge([0.0, 145.0]), Severity::Warning, "lint/typical-beyond-range");
    assert!(finding.message.contains("0° to 145° in `flexion`"), "{}", finding.message);
    sound(hinge([0.0, 140.0]));
}

#[test]
fn limits_in_degrees() {
    let finding = only(hinge(Range::new(-10.0, 140.0), 0.0), Severity::Warning, "lint/degrees");
    assert!(finding.message.contains("-10 to 140 radians"), "{}", finding.message);
    sound(hinge(degrees(-10.0, 140.0), 0.0));
    // A full turn either way is a range of a pelvis, in radians.
    sound(hinge(degrees(-360.0, 360.0), 0.0));
}

#[test]
fn limits_that_limit_nothing() {
    let dummy = Range::new(-99999.9, 99999.9);
    only(hinge(dummy, 0.0), Severity::Warning, "lint/dummy-range");
    let declared = Range { enforced: false, ..dummy };
    only(hinge(declared, 0.0), Severity::Note, "lint/dummy-range");
    // Two turns and a bit either way, in no whole number of degrees.
    only(hinge(Range::new(-13.5, 13.5), 0.0), Severity::Warning, "lint/dummy-range");
    sound(hinge(Range::FREE, 0.0));
}

#[test]
fn defaults_outside() {
    let finding =
        only(hinge(degrees(0.0, 120.0), -0.1), Severity::Warning, "lint/default-outside-range");
    assert!(finding.message.contains("-5.73°, lies 5.73° below its clamped range"));
    assert!(finding.message.ends_with("ends at 0°"), "{}", finding.message);
    let declared = Range { enforced: false, ..degrees(0.0, 120.0) };
    only(hinge(declared, -0.1), Severity::Note, "lint/default-outside-range");
    sound(hinge(degrees(0.0, 120.0), 0.1));
}

/// A knee whose patella follows it and glides by a spline of its own angle up to 120°.
fn patella(upper: f64) -> ModelBuilder {
    let mut b = ModelBuilder::new("knee");
    let femur = b.segment("femur", None);
    let tibia = b.segment("tibia", Some(femur));
    let kneecap = b.segment("kneecap", Some(femur));
    b.place_joint(tibia, Vec3::new(0.0, -0.4, 0.0));
    b.place_joint(kneecap, Vec3::new(0.04, -0.4, 0.0));
    let (set, knee) = b.hinge("knee", tibia, "flexion", -Vec3::Z);
    b.coordinate_mut(knee).range = degrees(0.0, upper);
    let own = b.joint_set("patella");
    let beta = b.coordinate(own, "beta", CoordinateKind::Other);
    let same = b.map(set, "same", knee, Function::identity());
    b.follow(beta, same);
    let knots: Vec<f64> = [0.0f64, 40.0, 80.0, 120.0].map(f64::to_radians).to_vec();
    // A straight line, so that its slope outside is known: 30 mm per radian.
    let line = knots.iter().map(|x| 0.03 * x).collect();
    let line = SimmSpline::new(knots, line).expect("knots");
    let down = b.map(own, "glide", beta, condyle_math::function::Curve::SimmSpline(line).into());
    let slide = b.translate(own, "slide", down, Vec3::Y);
    b.output(own, kneecap, slide);
    b
}

#[test]
fn ranges_beyond_the_knots_that_a_follower_reads() {
    let finding = only(patella(140.0), Severity::Warning, "lint/beyond-knots");
    assert_eq!(names(&finding), ["flexion", "patella/glide"]);
    // 20° times 30 mm per radian = 10.47 mm.
    for part in ["may reach 140°", "ends at 120°", "last 20° are", "up to 10.47 mm"] {
        assert!(finding.message.contains(part), "{part}: {}", finding.message);
    }
    sound(patella(120.0));
}

#[test]
fn functions_that_are_flat_need_no_knots() {
    let mut b = hinge(degrees(-20.0, 20.0), 0.0);
    let flexion = b.coordinate_at(0).expect("a coordinate");
    let set = b.coordinates()[0].joint_set;
    let flat = PiecewiseLinear::new(vec![-0.1, 0.1], vec![0.02, 0.02]).expect("knots");
    let flat = condyle_math::function::Curve::PiecewiseLinear(flat).into();
    let lifted = b.map(set, "flat", flexion, flat);
    let slide = b.translate(set, "slide", lifted, Vec3::Y);
    let pad = b.segment("pad", None);
    b.output(set, pad, slide);
    sound(b);
}

/// A finger whose last joint follows by two thirds, up to a limit in degrees.
fn finger(limit: f64, enforced: bool) -> ModelBuilder {
    let mut b = ModelBuilder::new("finger");
    let middle = b.segment("middle", None);
    let distal = b.segment("distal", Some(middle));
    b.place_joint(distal, Vec3::new(0.025, 0.0, 0.0));
    let (set, pip) = b.hinge("pip", middle, "pip", Vec3::Z);
    let (_, dip) = b.hinge("dip", distal, "dip", Vec3::Z);
    b.coordinate_mut(pip).range = degrees(0.0, 120.0);
    b.coordinate_mut(dip).range = Range { enforced, ..degrees(0.0, limit) };
    let follow = b.map(set, "two_thirds", pip, Function::linear(2.0 / 3.0, 0.0));
    b.follow(dip, follow);
    b
}

#[test]
fn followers_that_their_leaders_take_outside() {
    let finding = only(finger(70.0, true), Severity::Warning, "lint/follower-range");
    // Two thirds of 120° are 80°; 70° are left at 105°, sampled every half degree.
    assert!(finding.message.contains("is driven to 80° at `pip` = 120°, 10° past its limit 70°"));
    assert!(finding.message.ends_with("it leaves its range at 105.5°"), "{}", finding.message);
    only(finger(70.0, false), Severity::Note, "lint/follower-range");
    sound(finger(80.0, true));
}

#[test]
fn defaults_of_followers_and_chains_of_them() {
    let mut b = finger(80.0, true);
    let dip = b.coordinate_at(1).expect("a coordinate");
    b.coordinate_mut(dip).default[0] = 0.5;
    let finding = only(b, Severity::Note, "lint/follower-default");
    assert!(finding.message.contains("28.65°, has no effect: its leaders set it to 0°"));

    let mut b = finger(80.0, true);
    let dip = b.coordinate_at(1).expect("a coordinate");
    let nail = b.segment("nail", b.segment_at(1));
    let (set, third) = b.hinge("nail", nail, "third", Vec3::Z);
    let follow = b.map(set, "half", dip, Function::linear(0.5, 0.0));
    b.follow(third, follow);
    let finding = only(b, Severity::Note, "lint/coupling-chain");
    assert_eq!(finding.message, "`third` follows `dip` follows `pip`");
}

#[test]
fn coordinates_that_move_nothing() {
    let mut b = hinge(degrees(0.0, 90.0), 0.0);
    let set = b.joint_set("spare");
    b.coordinate(set, "slack", CoordinateKind::Translation);
    let finding = only(b, Severity::Warning, "lint/moves-nothing");
    assert_eq!(names(&finding), ["slack"]);
}

#[test]
fn coordinates_that_drive_something_outside_the_model() {
    let mut b = hinge(degrees(0.0, 90.0), 0.0);
    let set = b.joint_set("face");
    let smile = b.coordinate(set, "smile", CoordinateKind::Other);
    b.coordinate_mut(smile).drives = Some("smile".into());
    // One that moves nothing but a follower that drives something is of use as well.
    let mood = b.coordinate(set, "mood", CoordinateKind::Other);
    let brow = b.coordinate(set, "brow", CoordinateKind::Other);
    let half = b.map(set, "half", mood, Function::linear(0.5, 0.0));
    b.follow(brow, half);
    b.coordinate_mut(brow).drives = Some("brow".into());
    let findings = condyle_check::check(&b.build().unwrap(), &[]);
    assert!(findings.is_empty(), "{findings:?}");
}

/// Three hinges in one joint, the middle one with a range in degrees.
fn triple(axes: [Vec3; 3], middle: [f64; 2]) -> ModelBuilder {
    let mut b = ModelBuilder::new("hip");
    let femur = b.segment("femur", None);
    let set = b.joint_set("hip");
    let mut factors = vec![];
    for (name, axis) in ["first", "second", "third"].into_iter().zip(axes) {
        let id = b.coordinate(set, name, CoordinateKind::Rotation);
        b.coordinate_mut(id).range = degrees(-40.0, 40.0);
        if name == "second" {
            b.coordinate_mut(id).range = degrees(middle[0], middle[1]);
            b.coordinate_mut(id).default[0] = middle[0].max(0.0).to_radians();
        }
        factors.push(b.rotate(set, &format!("turn_{name}"), id, axis));
    }
    let motion = b.product(set, "motion", factors);
    b.output(set, femur, motion);
    b
}

#[test]
fn axes_that_are_nearly_one() {
    let tilt = 4f64.to_radians();
    let near = Vec3::new(tilt.sin(), 0.0, tilt.cos());
    let finding = only(
        triple([Vec3::Z, near, Vec3::Y], [-30.0, 30.0]),
        Severity::Warning,
        "lint/parallel-axes",
    );
    assert!(finding.message.contains("are only 4° apart"), "{}", finding.message);
    assert_eq!(names(&finding), ["first", "second"]);
    let tilt = 6f64.to_radians();
    sound(triple([Vec3::Z, Vec3::new(tilt.sin(), 0.0, tilt.cos()), Vec3::Y], [-30.0, 30.0]));
}

#[test]
fn triples_that_lose_a_direction() {
    use Severity::Note;
    let code = "lint/singular-triple";
    // Three axes: at 90° of the middle one. Two axes: at 0° and 180° of it.
    let finding = only(triple([Vec3::Z, Vec3::X, Vec3::Y], [-20.0, 95.0]), Note, code);
    assert!(finding.message.contains("`second` is 90°"), "{}", finding.message);
    let finding = only(triple([Vec3::Z, Vec3::X, Vec3::Y], [-90.0, 90.0]), Note, code);
    assert!(finding.message.contains("`second` is ±90°"), "{}", finding.message);
    sound(triple([Vec3::Z, Vec3::X, Vec3::Y], [-80.0, 80.0]));
    let finding = only(triple([Vec3::Y, Vec3::Z, Vec3::Y], [-10.0, 120.0]), Note, code);
    assert!(finding.message.contains("`second` is 0°"), "{}", finding.message);
    sound(triple([Vec3::Y, Vec3::Z, Vec3::Y], [10.0, 120.0]));
}

#[test]
fn places_in_millimetres() {
    let far = |x: f64| {
        let mut b = hinge(degrees(0.0, 90.0), 0.0);
        let foot = b.segment("foot", b.segment_at(0));
        b.place_joint(foot, Vec3::new(0.0, x, 0.0));
        b
    };
    let finding = only(far(-420.0), Severity::Warning, "lint/millimetres");
    assert!(finding.message.contains("420 m"), "{}", finding.message);
    sound(far(-0.42));
}

#[test]
fn markers_far_away_and_in_one_place() {
    let marked = |places: &[(&str, Vec3)]| {
        let mut b = hinge(degrees(0.0, 90.0), 0.0);
        for (name, place) in places {
            b.marker(name, b.segment_at(0), *place);
        }
        b
    };
    let (near, other) = (Vec3::new(0.1, 0.2, 0.0), Vec3::new(0.1, 0.2, 0.001));
    let finding = only(marked(&[("A", near * 12.0)]), Severity::Warning, "lint/far-marker");
    // 12 · √(0.1² + 0.2²) = 2.683
    assert!(finding.message.contains("2.683 m from the origin of `shank`"), "{}", finding.message);
    let finding = only(marked(&[("A", near), ("B", near)]), Severity::Note, "lint/marker-twins");
    assert_eq!(names(&finding), ["A", "B"]);
    sound(marked(&[("A", near), ("B", other)]));
    let alike = marked(&[("RASI", near), ("Rasi", other)]);
    let finding = only(alike, Severity::Warning, "lint/alike-names");
    assert_eq!(names(&finding), ["RASI", "Rasi"]);
}

#[test]
fn loops_open_at_rest() {
    let looped = |gap: f64| {
        let mut b = hinge(degrees(0.0, 90.0), 0.0);
        let point = Vec3::new(0.0, -0.4, 0.0);
        let at = [(b.segment_at(0), point), (None, point + Vec3::X * gap)];
        b.closure(Closure { name: "rod".into(), condition: Condition::Points { at } });
        b
    };
    let finding = only(looped(0.0123), Severity::Warning, "lint/open-loop");
    assert!(finding.message.contains("`rod` is open by 12.3 mm"), "{}", finding.message);
    sound(looped(0.0009));
}

/// A pelvis with two legs that are mirror images across the third axis, one leg altered.
fn legs(alter: impl Fn(&str, &mut Vec3, &mut Vec3, &mut Range, &mut f64)) -> ModelBuilder {
    let mut b = ModelBuilder::new("legs");
    let pelvis = b.segment("pelvis", None);
    for (side, sign) in [("r", 1.0), ("l", -1.0)] {
        let mut parent = pelvis;
        for (joint, place, axis) in [
            ("hip", Vec3::new(-0.07, -0.06, 0.08), Vec3::new(1.0, 0.0, 0.0)),
            ("knee", Vec3::new(0.0, -0.4, 0.0), Vec3::new(0.0, 0.0, 1.0)),
            ("ankle", Vec3::new(0.01, -0.42, 0.003), Vec3::new(0.6, 0.0, 0.8)),
        ] {
            let name = format!("{joint}_{side}");
            let mut place = Vec3::new(place.x, place.y, sign * place.z);
            // An axis of rotation in the mirror: reflected, then turned over.
            let mut axis = Vec3::new(sign * axis.x, sign * axis.y, axis.z);
            let (mut range, mut default) = (degrees(-20.0, 70.0), 0.1);
            alter(&name, &mut place, &mut axis, &mut range, &mut default);
            let segment = b.segment(&format!("below_{name}"), Some(parent));
            b.place_joint_frames(segment, Affine::from_translation(place), Affine::IDENTITY);
            let (_, angle) = b.hinge(&name, segment, &format!("{joint}_angle_{side}"), axis);
            b.coordinate_mut(angle).range = range;
            b.coordinate_mut(angle).default[0] = default;
            parent = segment;
        }
    }
    b
}

#[test]
fn legs_that_are_mirror_images() {
    sound(legs(|_, _, _, _, _| {}));
    // Other planes than the third: the same legs lying on another side.
    sound(legs(|_, place, axis, _, _| {
        let turned = |v: Vec3| Vec3::new(v.z, v.x, v.y);
        (*place, *axis) = (turned(*place), turned(*axis));
    }));
    // A coordinate that counts backwards, with its range and default turned over as well.
    sound(legs(|name, _, axis, range, default| {
        if name == "knee_l" {
            (*axis, *range, *default) = (-*axis, degrees(-70.0, 20.0), -0.1);
        }
    }));
}

#[test]
fn legs_with_uneven_ranges() {
    let finding = only(
        legs(|name, _, _, range, _| {
            if name == "ankle_l" {
                *range = degrees(-20.0, 60.0);
            }
        }),
        Severity::Warning,
        "lint/uneven-ranges",
    );
    let expected = "`ankle_angle_r` -20° to 70°, `ankle_angle_l` -20° to 60°";
    assert!(finding.message.starts_with(expected), "{}", finding.message);
    // An axis turned over without its range, and a range turned over without its axis.
    let finding = only(
        legs(|name, _, axis, _, default| {
            if name == "knee_l" {
                (*axis, *default) = (-*axis, -0.1);
            }
        }),
        Severity::Warning,
        "lint/uneven-ranges",
    );
    assert!(finding.message.ends_with("equal, although their signs are opposite"));
    let finding = only(
        legs(|name, _, _, range, _| {
            if name == "knee_l" {
                *range = degrees(-70.0, 20.0);
            }
        }),
        Severity::Warning,
        "lint/uneven-ranges",
    );
    assert!(finding.message.contains("mirrored already"), "{}", finding.message);
}

#[test]
fn legs_with_uneven_places_axes_and_defaults() {
    let finding = only(
        legs(|name, place, _, _, _| {
            if name == "hip_l" {
                place.z = -place.z;
            }
        }),
        Severity::Warning,
        "lint/same-side",
    );
    // Twice 80 mm.
    assert!(finding.message.contains("is 160 mm from the mirror"), "{}", finding.message);
    let finding = only(
        legs(|name, place, _, _, _| {
            if name == "knee_l" {
                place.y -= 0.03;
            }
        }),
        Severity::Note,
        "lint/uneven-places",
    );
    assert!(finding.message.contains("1 of 3 joints"), "{}", finding.message);
    assert!(finding.message.ends_with("`below_knee_l`, by 30 mm"), "{}", finding.message);
    let finding = only(
        legs(|name, _, axis, _, _| {
            if name == "ankle_l" {
                axis.x = -axis.x;
            }
        }),
        Severity::Warning,
        "lint/uneven-axes",
    );
    // (0.6, 0, 0.8) against (-0.6, 0, 0.8): twice atan(0.6/0.8).
    assert!(finding.message.ends_with("73.74° apart"), "{}", finding.message);
    let finding = only(
        legs(|name, _, _, _, default| {
            if name == "hip_l" {
                *default = 0.4;
            }
        }),
        Severity::Note,
        "lint/uneven-defaults",
    );
    assert!(finding.message.contains("`hip_angle_r` 5.73°, `hip_angle_l` 22.92°"));
}

#[test]
fn a_side_that_is_missing() {
    let mut b = legs(|_, _, _, _, _| {});
    b.segment("toes_r", b.segment_at(3));
    let finding = only(b, Severity::Note, "lint/side-missing");
    assert_eq!(names(&finding), ["toes_r"]);
}

#[test]
fn warnings_of_readers_come_along() {
    let model = hinge(degrees(0.0, 90.0), 0.0).build().expect("a model");
    let said = [
        Diagnostic::warning("osim/unknown-constraint", "it is not known"),
        Diagnostic::note("xml/prefix", "a prefix"),
        Diagnostic::warning("model/default-outside-range", "said by a rule instead"),
    ];
    let findings = lint::check(&model, &said);
    let codes: Vec<_> = findings.iter().map(|f| (f.severity, f.code)).collect();
    assert_eq!(
        codes,
        [(Severity::Warning, "osim/unknown-constraint"), (Severity::Note, "xml/prefix")]
    );
}

/// A ball joint of three angles in a square cone, each side 0.6 rad from rest, with these ranges.
fn in_a_cone(reach: f64, dent: bool) -> ModelBuilder {
    let mut b = ModelBuilder::new("ball");
    let arm = b.segment("arm", None);
    let set = b.joint_set("shoulder");
    let angles = ["a", "b", "c"].map(|name| {
        let id = b.coordinate(set, name, CoordinateKind::Rotation);
        b.coordinate_mut(id).range = degrees(-reach, reach);
        Signal::from(id)
    });
    let axes = [Vec3::Z, Vec3::X, Vec3::Y];
    let mut corners = vec![(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    if dent {
        // The side towards x is pulled in almost to rest.
        corners.insert(0, (0.1, 0.0));
    }
    let points = corners
        .into_iter()
        .map(|(x, z): (f64, f64)| ConePoint { direction: Vec3::new(x, -1.4, z), twist: None });
    let cone = Cone::new(-Vec3::Y, None, points.collect(), 0, Projection::Nearest).unwrap();
    let cone = Law::Cone(JointCone { of: Swinging::Angles(axes), cone });
    let Signal::Output(cone, _) = b.component(set, "cone", cone, angles.to_vec()) else {
        unreachable!("a component has outputs")
    };
    let turns = (0..3)
        .map(|k| b.rotate(set, &format!("turn_{k}"), Signal::Output(cone, k), axes[k as usize]));
    let turns = turns.collect();
    let motion = b.product(set, "motion", turns);
    b.output(set, arm, motion);
    b
}

#[test]
fn a_cone_whose_projection_jumps() {
    // Convex, and far from a quarter turn beyond it: the nearest point moves smoothly.
    sound(in_a_cone(60.0, false));
    // In a dent two sides can be equally near.
    let finding = only(in_a_cone(60.0, true), Severity::Warning, "lint/cone-jump");
    assert_eq!(names(&finding), ["a", "b", "c"]);
    // Ranges that stay inside the dented cone never project.
    sound(in_a_cone(2.0, true));
}

#[test]
fn a_contact_that_floats() {
    let ribs = |x: f64| {
        let mut b = ModelBuilder::new("ribs");
        let thorax = b.segment("thorax", None);
        let scapula = b.segment("scapula", Some(thorax));
        b.place_joint(scapula, Vec3::new(x, 0.0, 0.0));
        let pair = ContactPair { first: Vec3::Y * 0.1, second: Vec3::Z * 0.1, at: [0.0; 2] };
        let law = Gliding::new(Affine::IDENTITY, Vec3::new(0.1, 0.1, 0.1), Vec3::Z, vec![pair]);
        let set = b.joint_set("glide");
        let contact = Law::Contact(Contact { before: false, most_gap: None, law: law.unwrap() });
        let glide = b.component(set, "glide", contact, vec![scapula.into(), thorax.into()]);
        b.output(set, scapula, glide);
        b
    };
    // Points 0.1 from the joint reach a ball of 0.1 about (0, 0, 0) from 0.1 away; from 0.25 away the
    // second, across the axis, stays at √(0.25² + 0.1²) - 0.1 = 0.16926.
    sound(ribs(0.1));
    let finding = only(ribs(0.25), Severity::Warning, "lint/no-contact");
    assert!(finding.message.contains("169.26 mm outside"), "{}", finding.message);
}

#[test]
fn a_limit_that_nothing_reads() {
    let wrist = |limited: bool| {
        let mut b = ModelBuilder::new("wrist");
        let hand = b.segment("hand", None);
        let set = b.joint_set("wrist");
        let angles = ["flexion", "deviation"].map(|name| {
            let id = b.coordinate(set, name, CoordinateKind::Rotation);
            b.coordinate_mut(id).range = Range::new(-1.0, 1.0);
            Signal::from(id)
        });
        let ellipse = Law::Ellipse(Ellipse::new([0.0, 0.0], [1.0, 0.4], 0.2).unwrap());
        let legal = b.component(set, "legal", ellipse, angles.to_vec());
        let Signal::Output(id, _) = legal else { unreachable!("a component has outputs") };
        let read = |k: usize| if limited { Signal::Output(id, k as u32) } else { angles[k] };
        let flex = b.rotate(set, "flex", read(0), Vec3::Z);
        let deviate = b.rotate(set, "deviate", read(1), Vec3::X);
        let motion = b.product(set, "motion", vec![flex, deviate]);
        b.output(set, hand, motion);
        b
    };
    sound(wrist(true));
    let finding = only(wrist(false), Severity::Warning, "lint/unused-component");
    assert!(finding.message.contains("`legal` limits nothing"), "{}", finding.message);
}
