//! One side made into the other: the pose is D·T·D of the written side's.

use super::{errors, pose, pose_in, read};
use condyle_model::{CoordinateKind, Mode, Model};

/// Every component that a side can be made of; `P` is the plane.
const ARM: &str = r#"
condyle = 1
kind = "model"
mirror = { plane = "P", from = "_r", to = "_l" }

[segment.trunk]
[joint.trunk]
segment = "trunk"
type = "weld"

[segment.upper_r]
parent = "trunk"
at = [0.03, 0.2, 0.15]
turn = [0.3, -0.2, 0.7]
joint_at = [0.01, 0.02, 0.03]
joint_turn = [0.1, 0.2, 0.3]
joint_order = "zyx"

[segment.fore_r]
parent = "upper_r"
at = [0.01, -0.3, 0.02]

[joint_set.arm_r.coordinate.lift_r]
default = 0.4
[joint_set.arm_r.coordinate.turn]
[joint_set.arm_r.coordinate.slide]
kind = "translation"
[joint_set.arm_r.coordinate.hand_r]
kind = "orientation"
[joint_set.arm_r.coordinate.late]
follows = "mixed"

[joint_set.arm_r.component.glide.ellipsoid]
about_x = "lift_r"
about_y = "turn"
about_z = "late"
radii = [0.07, 0.15, 0.09]

[joint_set.arm_r.component.hinge.rotate]
angle = "half.2"
axis = [0.6, 0, 0.8]

[joint_set.arm_r.component.half.map]
input = "turn"
functions = [0.3, { linear = [0.5, 0.1], factor = -1 }]

[joint_set.arm_r.component.mixed.combine]
inputs = ["lift_r", "arm_r.half.1"]
function = { slopes = [0.3, 0.2], intercept = 0.05 }

[joint_set.arm_r.component.out.translate]
distance = "slide"
axis = [0.36, 0.48, 0.8]

[joint_set.arm_r.component.shift.place]
at = [0.01, 0.02, 0.03]
turn = [0.5, 0.1, -0.2]

[joint_set.arm_r.component.roll.pivot]
angle = "held"
axis = [0, 0.6, 0.8]
centres = [{ to = 0.2, at = [0.01, 0.02, 0.03] }, { to = 0.5, at = [0.02, 0, 0.1] }, { at = [0, 0.1, 0] }]

[joint_set.arm_r.component.glide_on.pivot]
angle = "turn"
axis = [1, 0, 0]
path = [[[0, 0], [1, 0.1]], [[-1, 0.02], [0, 0], [1, 0.03]], [[0, 0.01], [1, 0.04]]]

[joint_set.arm_r.component.held.depend]
passive = "turn"
driver = "lift_r"
lower = { linear = [0.5, -1] }
upper = { lines = [[0, 0.2], [1, 0.4]] }

[joint_set.arm_r.component.level.compensate]
segment = "fore_r"
ancestors = ["upper_r"]
weight = 0.5

[joint_set.arm_r.component.wrist.ball]
orientation = "hand_r"
COLUMN
[joint_set.arm_r.output]
upper_r = ["shift", "glide", "hinge"]
fore_r = ["level", "out", "wrist", "roll", "glide_on", "LAST"]

[marker.elbow_r]
segment = "fore_r"
at = [0.01, 0.02, 0.03]

[closure.loop_r]
points = [{ segment = "fore_r", at = [0.1, 0.2, 0.3] }, { segment = "trunk" }]
"#;

const COLUMN: &str = r#"
[joint_set.arm_r.component.bend.constant_curvature]
about_x = "lift_r"
about_z = "turn"
about_y = "late"
neutral = [0.2, -0.1, 0.05]
length = 0.2
"#;

fn check(axis: usize, model: &Model, values: [f64; 4], hand: [f64; 4]) {
    let sign = |i: usize| if i == axis { -1.0 } else { 1.0 };
    let mut stored = model.defaults();
    for id in model.coordinate_ids() {
        let coordinate = model.coordinate(id);
        let place = model.stored_range(id);
        let left = model.joint_sets()[coordinate.joint_set.index()].name.ends_with("_l");
        if coordinate.kind == CoordinateKind::Orientation {
            for i in 0..3 {
                // -D·v: a rotation's axis is a pseudovector.
                stored[place.start + i] = if left { -sign(i) * hand[i] } else { hand[i] };
            }
            stored[place.start + 3] = hand[3];
        } else {
            let name = coordinate.name.trim_end_matches("_r").trim_end_matches("_l");
            let index = ["lift", "turn", "slide", "late"].iter().position(|n| *n == name).unwrap();
            stored[place.start] = values[index];
        }
    }
    mirrored(axis, model, &pose(model, &stored), &["upper", "fore"]);
}

/// That the left segments are D·T·D of the right ones.
fn mirrored(axis: usize, model: &Model, poses: &[[f64; 16]], parts: &[&str]) {
    let sign = |i: usize| if i == axis { -1.0 } else { 1.0 };
    for part in parts {
        let find = |side: &str| model.find_segment(&format!("{part}_{side}")).unwrap().index();
        let (right, left) = (poses[find("r")], poses[find("l")]);
        for row in 0..3 {
            for column in 0..4 {
                let d = sign(row) * if column < 3 { sign(column) } else { 1.0 };
                let (r, l) = (right[4 * row + column], left[4 * row + column]);
                assert!((d * r - l).abs() < 1e-12, "{part} at {row}, {column}: {r} and {l}");
            }
        }
    }
}

#[test]
fn the_other_side_has_the_mirrored_pose() {
    for (axis, plane) in ["x", "y", "z"].iter().enumerate() {
        // A column stands along y and cannot be mirrored there; both ellipsoids can.
        let (column, last) = if axis == 1 { ("", "hinge") } else { (COLUMN, "bend") };
        let text = ARM
            .replace("\"P\"", &format!("\"{plane}\""))
            .replace("COLUMN", column)
            .replace("LAST", last);
        let surface = ["\"opensim\"", "\"normal\""][axis % 2];
        let text = text.replace(
            "[joint_set.arm_r.component.hinge",
            &format!("surface_axis = {surface}\n[joint_set.arm_r.component.hinge"),
        );
        let model = read(&text);
        assert_eq!(model.segments().len(), 5);
        let hand = [0.1, -0.5, 0.7, 0.5];
        check(axis, &model, [0.0; 4], [0.0, 0.0, 0.0, 1.0]);
        check(axis, &model, [0.4, -0.8, 0.1, 9.0], hand);
        check(axis, &model, [-0.6, 0.5, -0.2, 9.0], hand);
        let elbow = model.markers().iter().find(|m| m.name == "elbow_l").unwrap();
        let mut expected = [0.01, 0.02, 0.03];
        expected[axis] = -expected[axis];
        assert_eq!(elbow.point.to_array(), expected);
        assert_eq!(model.closures().len(), 2);
        let lift = model.find_coordinate("lift_l").unwrap();
        assert_eq!(model.coordinate(lift).default[0], 0.4);
    }
}

#[test]
fn what_is_written_is_not_made() {
    let text = "condyle = 1\nkind = \"model\"\n\
        mirror = { plane = \"z\", from = \"_r\", to = \"_l\" }\n\
        [segment.a_r]\nat = [0, 0, 1]\n[segment.a_l]\nat = [0, 0, 7]\n[segment.b]\n\
        [marker.m_r]\nsegment = \"a_r\"\nat = [1, 1, 1]\n";
    let model = read(text);
    assert_eq!(model.segments().len(), 3);
    let left = model.find_segment("a_l").unwrap();
    assert_eq!(model.segment(left).joint_in_parent.translation.z, 7.0);
    assert_eq!(model.markers()[1].segment, Some(left));
    assert_eq!(model.markers()[1].point.z, -1.0);
}

/// Shapes and limits of a side, all off the planes; `P` is the plane.
const LEG: &str = r#"
condyle = 1
kind = "model"
mirror = { plane = "P", from = "_r", to = "_l" }

[segment.trunk]
[segment.hip_r]
parent = "trunk"
at = [0.03, 0.2, 0.15]
turn = [0.3, -0.2, 0.7]
[segment.blade_r]
parent = "hip_r"
at = [0.01, -0.1, 0.12]
[segment.foot_r]
parent = "blade_r"

[joint_set.leg_r.coordinate.a]
[joint_set.leg_r.coordinate.b]
[joint_set.leg_r.coordinate.c]
[joint_set.leg_r.coordinate.q]
kind = "orientation"
[joint_set.leg_r.coordinate.s]
kind = "scale"

[joint_set.leg_r.component.legal.cone]
angles = ["a", "b", "c"]
axes = [[0, 0, 1], [0.6, 0.8, 0], [0, 0, 1]]
rest = [0.1, -1, 0.2]
twist = [-0.2, 0.5]
points = [{ direction = [1, -1, 0], twist = [-0.3, 0.1] }, { direction = [0.4, -1, 0.9] }, { direction = [-0.5, -1, -0.4] }, { direction = [0.3, -1, -0.8] }]
[joint_set.leg_r.component.one.rotate]
angle = "legal"
axis = [0, 0, 1]
[joint_set.leg_r.component.two.rotate]
angle = "legal.2"
axis = [0.6, 0.8, 0]
[joint_set.leg_r.component.three.rotate]
angle = "legal.3"
axis = [0, 0, 1]

[joint_set.leg_r.component.held.cone]
orientation = "q"
rest = [1, 0.2, 0.1]
twist = [-0.4, 0.1]
projection = "toward_rest"
points = [{ direction = [1, -1, 0.1] }, { direction = [0.8, 0.3, 1] }, { direction = [0.4, 0.8, -0.4] }, { direction = [0.3, 0, -0.8] }]
[joint_set.leg_r.component.ball.ball]
orientation = "held"

[joint_set.leg_r.component.before.rotate]
angle = "a"
axis = [0.6, 0, 0.8]
[joint_set.leg_r.component.touch.contact]
segment = "blade_r"
surface = "trunk"
at = [0.02, 0.1, 0.05]
turn = [0.1, -0.2, 0.3]
radii = [0.2, 0.3, 0.25]
axis = [0, 0.6, 0.8]
before = "before"
drivers = ["b", "c"]
pairs = [{ first = [0.02, -0.1, 0.1], second = [0.03, 0.1, 0.1], at = [-1, 0] }, { first = [0.02, -0.12, 0.1], second = [0.03, 0.1, 0.05], at = [1, 1] }]

[joint_set.leg_r.component.size.scale]
factor = "s"
axis = [0.6, 0, 0.8]
[joint_set.leg_r.component.thin.scale]
factor = "s"
axis = [0, 0.6, 0.8]
volume = true
[joint_set.leg_r.component.all.scale]
factor = "s"
[joint_set.leg_r.component.slant.shear]
amount = "b"
along = [0.8, 0, -0.6]
across = [0.6, 0, 0.8]
[joint_set.leg_r.component.rail.curve]
parameter = "c"
path = [[[-1, 0.2], [0, 0], [1, 0.1]], [[-1, 0], [0, 0.3], [1, 0.1]], [[-1, 0], [0, 0.1], [1, 0.5]]]
forward = [1, 0.2, 0.3]
up = [0.1, 0.2, 1]

[joint_set.leg_r.output]
hip_r = ["one", "two", "three", "ball"]
blade_r = ["before", "touch"]
foot_r = ["size", "thin", "all", "slant", "rail"]
"#;

#[test]
fn limits_and_shapes_are_mirrored() {
    for (axis, plane) in ["x", "y", "z"].iter().enumerate() {
        let model = read(&LEG.replace("\"P\"", &format!("\"{plane}\"")));
        let sign = |i: usize| if i == axis { -1.0 } else { 1.0 };
        let mut held = 0;
        for step in 0..40 {
            let turn = |k: f64| (k * f64::from(step)).sin();
            let values =
                [1.5 * turn(0.7), 1.5 * turn(1.1), 1.2 * turn(1.9), 0.0, 1.0 + 0.4 * turn(2.3)];
            let q = [0.7 * turn(0.4), 0.5 * turn(1.3), 0.4 * turn(2.9)];
            let w = (1.0 - q.iter().map(|x| x * x).sum::<f64>()).sqrt();
            let mut stored = model.defaults();
            for id in model.coordinate_ids() {
                let coordinate = model.coordinate(id);
                let place = model.stored_range(id);
                let left = model.joint_sets()[coordinate.joint_set.index()].name == "leg_l";
                if coordinate.kind == CoordinateKind::Orientation {
                    for i in 0..3 {
                        stored[place.start + i] = if left { -sign(i) * q[i] } else { q[i] };
                    }
                    stored[place.start + 3] = w;
                } else {
                    let index =
                        ["a", "b", "c", "q", "s"].iter().position(|n| *n == coordinate.name);
                    stored[place.start] = values[index.unwrap()];
                }
            }
            let (open, posed) =
                (pose_in(Mode::Open, &model, &stored), pose_in(Mode::Posed, &model, &stored));
            mirrored(axis, &model, &open, &["hip", "blade", "foot"]);
            mirrored(axis, &model, &posed, &["hip", "blade", "foot"]);
            held += usize::from(open != posed);
        }
        assert!(held > 10, "the cones held in {held} of 40 poses");
    }
}

#[test]
fn a_law_is_not_mirrored_unless_both_sides_are_written() {
    let side = |s: &str| {
        format!(
            "[segment.wheel_{s}]\n[joint_set.wheel_{s}.coordinate.q]\n\
             [joint_set.wheel_{s}.component.ride.custom]\nlaw = \"cam\"\n\
             inputs = [\"q\", \"q\"]\nparameters = {{ lift = 0.1 }}\n\
             [joint_set.wheel_{s}.output]\nwheel_{s} = \"ride\"\n"
        )
    };
    let head = "mirror = { plane = \"z\", from = \"_r\", to = \"_l\" }\n";
    let found = errors(&format!("{head}{}", side("r")));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with(
        "line 6, column 30: the custom component `ride` cannot be \
    mirrored"
    ));
    let both = format!("condyle = 1\nkind = \"model\"\n{head}{}{}", side("r"), side("l"));
    assert_eq!(read(&both).segments().len(), 2);
}
