//! A full body for gait: 22 segments, 35 coordinates, two knees that glide and turn by splines of
//! their flexion, patellae that follow them, oblique ankles. The numbers are invented.

use condyle_math::function::{Curve, Function, SimmSpline};
use condyle_math::{Quat, Vec3};
use condyle_model::{
    CoordinateId, CoordinateKind, JointSetId, Law, Model, ModelBuilder, Range, SegmentId, Signal,
    component,
};

const RIGHT: f64 = 1.0;
const LEFT: f64 = -1.0;

/// The model, with three markers on most segments.
pub fn model() -> Model {
    let mut body = Body { b: ModelBuilder::new("full body") };
    let pelvis = body.pelvis();
    let torso = body.three_axes("back", "torso", pelvis, Vec3::new(-0.1, 0.08, 0.0), LUMBAR);
    body.markers(torso, [[0.03, 0.30, 0.0], [-0.09, 0.36, 0.0], [0.0, 0.42, 0.12]]);
    for (side, sign) in [("r", RIGHT), ("l", LEFT)] {
        body.leg(side, sign, pelvis);
        body.arm(side, sign, torso);
    }
    body.b.build().unwrap_or_else(|findings| panic!("the body is well formed: {findings:?}"))
}

/// A knee's spline of its flexion.
pub fn spline() -> SimmSpline {
    let x = (0..9).map(|i| -0.2 + 0.3 * f64::from(i)).collect();
    let y = (0..9).map(|i| 0.004 * f64::sin(0.4 * f64::from(i)) - 0.002).collect();
    SimmSpline::new(x, y).unwrap_or_else(|error| panic!("knots increase: {error}"))
}

/// Name, axis and range of three angles.
type Angles = [(&'static str, Vec3, (f64, f64)); 3];

const LUMBAR: Angles = [
    ("lumbar_extension", Vec3::Z, (-1.57, 1.57)),
    ("lumbar_bending", Vec3::X, (-1.57, 1.57)),
    ("lumbar_rotation", Vec3::Y, (-1.57, 1.57)),
];
const HIP: Angles = [
    ("hip_flexion", Vec3::Z, (-0.5, 2.1)),
    ("hip_adduction", Vec3::X, (-0.9, 0.5)),
    ("hip_rotation", Vec3::Y, (-0.7, 0.7)),
];
const SHOULDER: Angles = [
    ("arm_flexion", Vec3::Z, (-1.57, 1.57)),
    ("arm_adduction", Vec3::X, (-2.1, 1.57)),
    ("arm_rotation", Vec3::Y, (-1.57, 1.57)),
];

struct Body {
    b: ModelBuilder,
}

impl Body {
    fn angle(&mut self, set: JointSetId, name: &str, (lower, upper): (f64, f64)) -> CoordinateId {
        let id = self.b.coordinate(set, name, CoordinateKind::Rotation);
        self.b.coordinate_mut(id).range = Range::new(lower, upper);
        id
    }

    fn markers(&mut self, segment: SegmentId, points: [[f64; 3]; 3]) {
        for point in points {
            let name = format!(
                "m{}.{}",
                segment.index(),
                points.iter().position(|p| *p == point).unwrap_or(0)
            );
            self.b.marker(&name, Some(segment), point.into());
        }
    }

    fn pelvis(&mut self) -> SegmentId {
        let pelvis = self.b.segment("pelvis", None);
        let set = self.b.joint_set("ground_pelvis");
        let mut factors = vec![];
        for (name, axis) in [("pelvis_tx", Vec3::X), ("pelvis_ty", Vec3::Y), ("pelvis_tz", Vec3::Z)]
        {
            let id = self.b.coordinate(set, name, CoordinateKind::Translation);
            self.b.coordinate_mut(id).range = Range::new(-5.0, 5.0);
            factors.push(self.b.translate(set, name, id, axis));
        }
        for (name, axis) in
            [("pelvis_tilt", Vec3::Z), ("pelvis_list", Vec3::X), ("pelvis_rotation", Vec3::Y)]
        {
            let id = self.angle(set, name, (-3.2, 3.2));
            factors.push(self.b.rotate(set, name, id, axis));
        }
        let motion = self.b.product(set, "motion", factors);
        self.b.output(set, pelvis, motion);
        self.markers(pelvis, [[0.02, 0.03, 0.13], [0.02, 0.03, -0.13], [-0.16, 0.04, 0.0]]);
        pelvis
    }

    fn three_axes(
        &mut self,
        joint: &str,
        segment: &str,
        parent: SegmentId,
        at: Vec3,
        angles: Angles,
    ) -> SegmentId {
        let segment = self.b.segment(segment, Some(parent));
        self.b.place_joint(segment, at);
        let set = self.b.joint_set(joint);
        let suffix = joint.rsplit_once('_').map_or(String::new(), |(_, side)| format!("_{side}"));
        let mut factors = vec![];
        for (name, axis, range) in angles {
            let name = format!("{name}{suffix}");
            let id = self.angle(set, &name, range);
            factors.push(self.b.rotate(set, &name, id, axis));
        }
        let motion = self.b.product(set, "motion", factors);
        self.b.output(set, segment, motion);
        segment
    }

    fn hinge(
        &mut self,
        name: &str,
        segment: &str,
        parent: SegmentId,
        at: Vec3,
        axis: Vec3,
        range: (f64, f64),
    ) -> SegmentId {
        let segment = self.b.segment(segment, Some(parent));
        self.b.place_joint(segment, at);
        let (_, angle) = self.b.hinge(name, segment, &format!("{name}_angle"), axis);
        self.b.coordinate_mut(angle).range = Range::new(range.0, range.1);
        segment
    }

    fn leg(&mut self, side: &str, sign: f64, pelvis: SegmentId) {
        let named = |name: &str| format!("{name}_{side}");
        let across = |v: Vec3| Vec3::new(v.x, v.y, v.z * sign);
        let hip = across(Vec3::new(-0.06, -0.08, 0.08));
        let femur = self.three_axes(&named("hip"), &named("femur"), pelvis, hip, HIP);
        self.markers(
            femur,
            [[0.05, -0.2, 0.06], [0.0, -0.4, 0.05 * sign], [0.0, -0.4, -0.05 * sign]],
        );
        let tibia = self.knee(side, sign, femur);
        self.markers(
            tibia,
            [[0.03, -0.1, 0.0], [0.0, -0.37, 0.05 * sign], [0.0, -0.38, -0.04 * sign]],
        );
        let oblique = across(Vec3::new(-0.105, -0.174, 0.979));
        let at = Vec3::new(-0.01, -0.4, 0.0);
        let talus = self.hinge(&named("ankle"), &named("talus"), tibia, at, oblique, (-0.7, 0.5));
        let oblique = Vec3::new(0.787, 0.605, -0.121 * sign);
        let at = across(Vec3::new(-0.044, -0.042, 0.008));
        let calcn =
            self.hinge(&named("subtalar"), &named("calcn"), talus, at, oblique, (-0.35, 0.35));
        self.markers(
            calcn,
            [[0.0, 0.02, 0.0], [0.13, 0.02, 0.05 * sign], [0.14, 0.03, -0.03 * sign]],
        );
        let oblique = Vec3::new(-0.581, 0.0, 0.814 * sign);
        let at = across(Vec3::new(0.178, -0.002, 0.001));
        self.hinge(&named("mtp"), &named("toes"), calcn, at, oblique, (-0.5, 0.5));
    }

    /// The tibia rotates about three axes and translates in two directions, all as functions of the
    /// flexion; the patella's own angle follows the flexion.
    fn knee(&mut self, side: &str, sign: f64, femur: SegmentId) -> SegmentId {
        let named = |name: &str| format!("{name}_{side}");
        let tibia = self.b.segment(&named("tibia"), Some(femur));
        self.b.place_joint(tibia, Vec3::new(0.0, -0.4, 0.0));
        let set = self.b.joint_set(&named("walker_knee"));
        let flexion = self.angle(set, &named("knee_angle"), (0.0, 2.1));
        let curve = |factor: f64| Function { factor, curve: Curve::SimmSpline(spline()) };
        let map = |body: &mut Self, name: &str, function: Function| {
            body.b.map(set, name, flexion, function)
        };
        let forward = map(self, "forward", curve(1.0));
        let up = map(self, "up", curve(-0.5));
        let adduction = map(self, "adduction", curve(4.0 * sign));
        let internal = map(self, "internal", curve(10.0 * sign));
        let factors = vec![
            self.b.translate(set, "glide_x", forward, Vec3::X),
            self.b.translate(set, "glide_y", up, Vec3::Y),
            self.b.rotate(set, "flex", flexion, -Vec3::Z),
            self.b.rotate(set, "adduct", adduction, Vec3::X),
            self.b.rotate(set, "turn", internal, Vec3::Y),
        ];
        let motion = self.b.product(set, "motion", factors);
        self.b.output(set, tibia, motion);
        self.patella(side, femur, flexion);
        tibia
    }

    fn patella(&mut self, side: &str, femur: SegmentId, flexion: CoordinateId) {
        let patella = self.b.segment(&format!("patella_{side}"), Some(femur));
        self.b.place_joint(patella, Vec3::new(0.05, -0.4, 0.0));
        let set = self.b.joint_set(&format!("patellofemoral_{side}"));
        let beta =
            self.b.coordinate(set, &format!("knee_angle_{side}_beta"), CoordinateKind::Rotation);
        self.b.follow(beta, Signal::Coordinate(flexion));
        let functions =
            [3.0, 6.0].map(|factor| Function { factor, curve: Curve::SimmSpline(spline()) });
        let map = component::Map { functions: functions.to_vec() };
        let forward = self.b.component(set, "glide", Law::Map(map), vec![beta.into()]);
        let up = match forward {
            Signal::Output(id, _) => Signal::Output(id, 1),
            coordinate => coordinate,
        };
        let factors = vec![
            self.b.translate(set, "glide_x", forward, Vec3::X),
            self.b.translate(set, "glide_y", up, Vec3::Y),
            self.b.rotate(set, "turn", beta, -Vec3::Z),
        ];
        let motion = self.b.product(set, "motion", factors);
        self.b.output(set, patella, motion);
    }

    fn arm(&mut self, side: &str, sign: f64, torso: SegmentId) {
        let named = |name: &str| format!("{name}_{side}");
        let at = Vec3::new(0.003, 0.37, 0.17 * sign);
        let humerus = self.three_axes(&named("shoulder"), &named("humerus"), torso, at, SHOULDER);
        self.markers(
            humerus,
            [[0.03, -0.1, 0.03 * sign], [0.0, -0.28, 0.04 * sign], [0.0, -0.28, -0.04 * sign]],
        );
        let oblique = Vec3::new(0.226 * sign, 0.022 * sign, 0.974);
        let at = Vec3::new(0.013, -0.286, -0.01 * sign);
        let ulna = self.hinge(&named("elbow"), &named("ulna"), humerus, at, oblique, (0.0, 2.6));
        let oblique = Vec3::new(0.056 * sign, 0.998 * sign, 0.001);
        let at = Vec3::new(-0.007, -0.013, 0.026 * sign);
        let radius = self.hinge(&named("pro_sup"), &named("radius"), ulna, at, oblique, (0.0, 1.6));
        self.markers(
            radius,
            [[0.0, -0.1, 0.03 * sign], [0.0, -0.23, 0.05 * sign], [0.02, -0.23, -0.03 * sign]],
        );
        // The hand is welded on at an angle.
        let hand = self.b.segment(&named("hand"), Some(radius));
        let turn = Quat::exp(Vec3::new(0.0, 0.1 * sign, 0.05)).to_mat3();
        let frame = condyle_math::Affine::new(turn, Vec3::new(-0.009, -0.236, 0.014 * sign));
        self.b.place_joint_frames(hand, frame, condyle_math::Affine::IDENTITY);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_body_has_the_size_that_the_benches_name() {
        let model = model();
        assert_eq!(model.segments().len(), 22);
        assert_eq!(model.coordinates().len(), 35);
        assert_eq!(model.coordinates().iter().filter(|c| c.follows.is_some()).count(), 2);
        // Pelvis and torso; of each side the femur, tibia, heel, humerus and radius.
        assert_eq!(model.markers().len(), 3 * (2 + 2 * 5));
    }
}
