//! A reach cone: the directions in which a bone may point, as a part of a sphere about its joint. Its shade
//! tells how far the bone may twist there: yellow the least of this cone, green-blue the most.

use super::super::figure::Figure;
use super::ellipse::bounded;
use super::reach::Reach;
use super::twist::Twist;
use super::{OPACITY, fan, field, value};
use condyle_math::{Mat3, Quat, Vec3};
use condyle_mesh::Patch;
use condyle_model::component::{JointCone, Swinging};
use condyle_model::evaluate::Bound;
use condyle_model::{Cone, Law, Mode, Pose, SegmentId};
use condyle_render::{Scene, Surface, palette, shape};
use std::f64::consts::{PI, TAU};

/// Parts of the way from rest to the boundary.
const RINGS: usize = 12;
/// Corners are 2 degrees apart where ranges cut the cone.
const LEVEL: u32 = 5;
/// Pieces of the boundary are at most so long, in radians.
const PIECE: f64 = 0.07;

/// Draws a cone.
pub(super) fn draw(figure: &Figure, bound: &Bound, law: &JointCone, scene: &mut Scene) {
    let Some(rotation) = rotation(law, &figure.pose.bounded(bound).collect::<Vec<f64>>()) else {
        return;
    };
    let said =
        Said { rotation: &|numbers| self::rotation(law, numbers), off: &|a, b| off(law, a, b) };
    let Some((segment, frame)) = frame(figure, bound, &said, rotation) else { return };
    if !figure.is_signed(segment) {
        return;
    }
    let centre = figure.joint(segment).translation;
    let bone = (figure.far_end(segment) - centre).norm();
    let radius = (0.45 * bone).clamp(1.5 * figure.unit, 4.0 * figure.unit);
    let place = |direction: Vec3| centre + frame * direction * radius;
    let cone = &law.cone;
    let reach = Ranged::of(figure, bound, law).map_or_else(|| Reach::of_cone(cone), |r| r.reach());
    // Where a learned limit says more, its lines are enough.
    let more = |other: &Bound| {
        let component = &figure.model.components()[other.component.index()];
        let numbers: Vec<f64> = figure.pose.bounded(other).collect();
        let learned = matches!(component.law, Law::Field(_));
        let turned = || field::turned(figure, other, field::rotation(&numbers)?);
        learned && turned().is_some_and(|(of, _)| of == segment)
    };
    reach.draw(&place, !figure.program.bounds().iter().any(more), scene);
    for edge in reach.edges() {
        let edge: Vec<Vec3> = edge.into_iter().map(place).collect();
        scene.surfaces.push(fan(centre, &edge, palette::LIMIT).with_opacity(0.4 * OPACITY));
    }
    let rest = cone.rest().normalized();
    let direction = rotation * rest;
    let now = place(direction);
    scene.lines.push(value(centre, now));
    let mut mark = Surface::empty(palette::VALUE);
    shape::add_ball(&mut mark, now, 0.08 * figure.unit, (14, 10));
    scene.surfaces.push(mark);
    let twisting = !matches!(law.of, Swinging::Directions(_));
    if let (true, Some((span, _))) = (twisting, cone.twist_bounds(direction)) {
        let turn = Twist::of(rest, rotation);
        turn.draw(&|v| frame * v, now, 0.3 * radius, &[span], scene);
    }
}

/// Ranges of the two angles that say where a bone points, where they end earlier than the cone.
struct Ranged<'a> {
    cone: &'a Cone,
    axes: [Vec3; 3],
    ranges: [[f64; 2]; 2],
}

impl<'a> Ranged<'a> {
    /// `None` where they take nothing of the cone, or the bone's direction is not that of two angles about axes across each
    /// other.
    fn of(figure: &Figure, bound: &Bound, law: &'a JointCone) -> Option<Self> {
        let rest = law.cone.rest().normalized();
        let axes = match law.of {
            Swinging::Angles(axes) => axes.map(Vec3::normalized),
            Swinging::Directions([a, b]) => [a.normalized(), b.normalized(), rest],
            Swinging::Orientation => return None,
        };
        let [a, b, c] = axes;
        if a.dot(b).abs() > 1e-6 || c.dot(b).abs() > 1e-6 || c.cross(rest).norm() > 1e-6 {
            return None;
        }
        let inputs = &figure.model.components()[bound.component.index()].inputs;
        let range = |i: usize| Some(bounded(figure, *inputs.get(i)?)?.1);
        let free = [f64::NEG_INFINITY, f64::INFINITY];
        let ranges = [0, 1].map(|i| range(i).unwrap_or(free));
        let ranged = Self { cone: &law.cone, axes, ranges };
        let rings = Reach::of_cone(&law.cone).patch.corners;
        rings.iter().any(|v| ranged.room(*v) < -1e-6).then_some(ranged)
    }

    /// How far a direction is inside the ranges, in radians; negative outside.
    fn room(&self, direction: Vec3) -> f64 {
        let [a, b, c] = self.axes;
        let w = if c.dot(self.cone.rest()) < 0.0 { -direction } else { direction };
        let lead = b.dot(a.cross(c)).atan2(a.dot(c));
        let (along, up, side) = (w.dot(a), w.dot(b), w.dot(a.cross(b)));
        let sine = up.hypot(side);
        let inside = |angle: f64, [low, high]: [f64; 2]| {
            if high - low >= TAU {
                return f64::INFINITY;
            }
            let middle = 0.5 * (low + high);
            let off = angle - middle;
            0.5 * (high - low) - (off - (off / TAU).round() * TAU).abs()
        };
        // Two pairs of angles point there.
        let room = |sign: f64| {
            let turn = inside((sign * up).atan2(-sign * side), self.ranges[0]);
            let first = match turn.abs() {
                turn if turn.is_infinite() => f64::INFINITY,
                // To the plane through the axis where the angle ends, or to the axis.
                small if small < 0.5 * PI => (sine * turn.sin()).clamp(-1.0, 1.0).asin(),
                _ => sine.min(1.0).asin().copysign(turn),
            };
            first.min(inside((sign * sine).atan2(along) - lead, self.ranges[1]))
        };
        room(1.0).max(room(-1.0))
    }

    fn reach(&self) -> Reach {
        // What ranges of the first angle take ends in a point at its axis: a corner has to be there, and one in its midst, so
        // that it is found.
        let [a, b, c] = self.axes;
        let side = if c.dot(self.cone.rest()) < 0.0 { -1.0 } else { 1.0 };
        let middle = 0.5 * (self.ranges[0][0] + self.ranges[0][1]);
        let middle = if middle.is_finite() { middle } else { 0.0 };
        let gap = Mat3::rotation_about(a, (middle + PI).sin_cos()) * b.cross(a);
        let frame = |at: Vec3, toward: Vec3| {
            let at = at.normalized();
            let along = (toward - at * toward.dot(at)).normalized();
            Mat3::from_columns(at, along, at.cross(along))
        };
        let [from, next] = Patch::CORNERS;
        let turned = frame(a * side, gap * side) * frame(from, next).transpose();
        let value = |v: Vec3| {
            let v = turned * v;
            self.cone.distance(v).0.min(self.room(v))
        };
        let mut patch = Patch::of_distance(&value, LEVEL);
        patch.corners.iter_mut().for_each(|v| *v = turned * *v);
        Reach::of_patch(self.cone, patch)
    }
}

impl Reach {
    /// Rings from rest to the boundary, whose edges are cut into short pieces.
    fn of_cone(cone: &Cone) -> Self {
        let rest = cone.rest().normalized();
        let ends: Vec<Vec3> = cone.boundary().collect();
        let mut boundary: Vec<Vec3> = vec![];
        for (i, &from) in ends.iter().enumerate() {
            let to = ends[(i + 1) % ends.len()];
            let angle = from.cross(to).norm().atan2(from.dot(to));
            let pieces = (angle / PIECE).ceil().max(1.0);
            let parts = (0..pieces as usize).map(|part| part as f64 / pieces);
            boundary.extend(parts.map(|share| between(from, to, share)));
        }
        let around = boundary.len();
        let mut patch = Patch { corners: vec![rest], ..Patch::default() };
        for ring in 1..=RINGS {
            let share = ring as f64 / RINGS as f64;
            patch.corners.extend(boundary.iter().map(|&end| between(rest, end, share)));
        }
        let corner = |ring: usize, i: usize| match ring {
            0 => 0,
            _ => (1 + (ring - 1) * around + i % around) as u32,
        };
        for ring in 0..RINGS {
            for i in 0..around {
                let [a, b] = [corner(ring, i), corner(ring + 1, i)];
                let [c, d] = [corner(ring + 1, i + 1), corner(ring, i + 1)];
                patch.triangles.push([a, b, c]);
                if ring > 0 {
                    patch.triangles.push([a, c, d]);
                }
            }
        }
        patch.edges = (0..around).map(|i| [corner(RINGS, i), corner(RINGS, i + 1)]).collect();
        Self::of_patch(cone, patch)
    }

    fn of_patch(cone: &Cone, patch: Patch) -> Self {
        let width = |v: &Vec3| cone.twist_bounds(*v).map_or(TAU, |([low, high], _)| high - low);
        let widths = patch.corners.iter().map(width).collect();
        Self { patch, widths }
    }
}

/// A direction on the great arc between two.
fn between(from: Vec3, to: Vec3, share: f64) -> Vec3 {
    let angle = from.cross(to).norm().atan2(from.dot(to));
    let whole = angle.sin();
    if whole < 1e-9 {
        return from;
    }
    from * (((1.0 - share) * angle).sin() / whole) + to * ((share * angle).sin() / whole)
}

/// The rotation that a cone limits, of the numbers at its ports.
pub(super) fn rotation(law: &JointCone, numbers: &[f64]) -> Option<Mat3> {
    let turn =
        |(axis, angle): (&Vec3, &f64)| Mat3::rotation_about(axis.normalized(), angle.sin_cos());
    let product = |axes: &[Vec3]| {
        let turns = axes.iter().zip(numbers).map(turn);
        turns.fold(Mat3::IDENTITY, |all, turn| all * turn)
    };
    let found = match &law.of {
        Swinging::Angles(axes) => product(axes),
        Swinging::Directions(axes) => product(axes),
        Swinging::Orientation => {
            let &[x, y, z, w] = numbers else { return None };
            Quat { x, y, z, w }.to_mat3()
        }
    };
    found.x.is_finite().then_some(found)
}

/// What a limit says of a rotation.
pub(super) struct Said<'a> {
    /// The rotation of the numbers at its ports.
    pub(super) rotation: &'a dyn Fn(&[f64]) -> Option<Mat3>,
    /// How far a rotation is from one that is said.
    pub(super) off: &'a dyn Fn(Mat3, Mat3) -> f64,
}

/// The segment that the rotation turns, and the frame in the world in which it does: that of an ancestor, with
/// its joint, or of the world.
///
/// Found by comparing: in this pose and in one beside it, the segment has to be turned in the frame as the
/// cone says, or its bone to point there. Where no frame does, the one that this pose alone gives.
pub(super) fn frame(
    figure: &Figure,
    bound: &Bound,
    said: &Said,
    now: Mat3,
) -> Option<(SegmentId, Mat3)> {
    let model = figure.model;
    let mut best: Option<(f64, SegmentId, Mat3)> = None;
    let set = model.components()[bound.component.index()].joint_set;
    let beside = beside(figure)?;
    let turned = (said.rotation)(&beside.bounded(bound).collect::<Vec<f64>>())?;
    for (id, _) in model.outputs_of(set) {
        let frames = frames(figure, figure.pose, id);
        for (frame, then) in frames.into_iter().zip(self::frames(figure, &beside, id)) {
            let own = |pose: &Pose| (pose.segment(id) * model.segment(id).joint_in_segment).linear;
            let off =
                (said.off)(own(figure.pose), frame * now) + (said.off)(own(&beside), then * turned);
            if off.is_finite() && best.as_ref().is_none_or(|(least, ..)| off < *least - 1e-6) {
                best = Some((off, id, frame));
            }
        }
    }
    let (off, id, frame) = best?;
    let forced = figure.joint(id).linear * now.transpose();
    Some((id, if off < 0.02 { frame } else { forced }))
}

/// How far a rotation is from what a cone speaks of: in all, or in where the bone points.
pub(super) fn off(law: &JointCone, own: Mat3, said: Mat3) -> f64 {
    match law.of {
        Swinging::Directions(_) => {
            let rest = law.cone.rest().normalized();
            (own * rest - said * rest).norm()
        }
        _ => (said.transpose() * own).log().norm(),
    }
}

/// The frames in which a segment may be turned.
fn frames(figure: &Figure, pose: &Pose, id: SegmentId) -> Vec<Mat3> {
    let segment = figure.model.segment(id);
    let hung = pose.frame(segment.parent).linear;
    let ancestors = figure.model.path_to_root(id).skip(1).map(|id| pose.segment(id).linear);
    let joint = [hung * segment.joint_in_parent.linear, hung];
    joint.into_iter().chain(ancestors).chain([pose.frame(None).linear]).collect()
}

/// A pose in which everything is turned a little, each coordinate by another amount.
fn beside(figure: &Figure) -> Option<Pose> {
    let model = figure.model;
    let step: Vec<f64> = (0..model.tangent_len()).map(|i| 0.1 + 0.03 * (i % 7) as f64).collect();
    let mut stored = figure.stored.to_vec();
    model.retract(figure.stored, &step, &mut stored);
    let mut pose = Pose::new(figure.program);
    figure.program.evaluate(&stored, Mode::Open, &mut pose).ok().map(|()| pose)
}

#[cfg(test)]
mod tests {
    use super::super::super::figure::tests::seen;
    use super::*;

    /// The cone of the shipped shoulder speaks of the humerus in the thorax, that of the hip of the femur in the
    /// pelvis: also where both are turned.
    #[test]
    fn a_cone_stands_in_the_frame_that_its_angles_are_in() {
        let human = crate::shipped::read("human").expect("it is shipped").value.model;
        let mut stored = human.defaults();
        let step: Vec<f64> =
            (0..human.tangent_len()).map(|i| 0.02 + 0.01 * (i % 5) as f64).collect();
        human.retract(&human.defaults(), &step, &mut stored);
        seen(&human, &stored, |figure| {
            let mut found = vec![];
            for bound in figure.program.bounds() {
                let component = &human.components()[bound.component.index()];
                let Law::Cone(law) = &component.law else { continue };
                let numbers: Vec<f64> = figure.pose.bounded(bound).collect();
                let turned = rotation(law, &numbers).expect("a rotation");
                let said = Said {
                    rotation: &|numbers| rotation(law, numbers),
                    off: &|a, b| off(law, a, b),
                };
                let (segment, frame) = frame(figure, bound, &said, turned).expect("a frame");
                let base = match &human.segment(segment).name[..] {
                    "humerus_r" | "humerus_l" => "thorax",
                    "femur_r" | "femur_l" => "pelvis",
                    _ => continue,
                };
                let base = figure.pose.segment(human.find_segment(base).unwrap()).linear;
                assert!((base.transpose() * frame).log().norm() < 1e-9, "{}", component.name);
                // And the bone points there as the cone says.
                let rest = law.cone.rest().normalized();
                let off = figure.joint(segment).linear * rest - frame * (turned * rest);
                assert!(off.norm() < 1e-9, "{}: {}", component.name, off.norm());
                found.push(human.segment(segment).name.clone());
            }
            found.sort();
            assert_eq!(found, ["femur_l", "femur_r", "humerus_l", "humerus_r"]);
        });
    }

    #[test]
    fn the_sphere_ends_at_the_boundary_and_its_shade_is_the_twist() {
        let at = |x: f64, y: f64, z: f64, twist: [f64; 2]| condyle_model::ConePoint {
            direction: Vec3::new(x, y, z),
            twist: Some(twist),
        };
        let points = vec![
            at(1.0, -1.0, 0.0, [-0.1, 0.1]),
            at(0.0, -1.0, -1.0, [-1.0, 1.0]),
            at(-1.0, -1.0, 0.0, [-1.0, 1.0]),
            at(0.0, -1.0, 1.0, [-1.0, 1.0]),
        ];
        let rest = -Vec3::Y;
        let made = |points: Vec<_>| {
            let projection = condyle_model::Projection::TowardRest;
            Cone::new(rest, Some([-1.0, 1.0]), points, 0, projection)
        };
        let mut turned = points.clone();
        turned.reverse();
        let cone = made(points).or_else(|_| made(turned)).expect("a cone");
        let surfaces = Reach::of_cone(&cone).shades(&|direction| direction * 2.0);
        let corners = || surfaces.iter().flat_map(|s| &s.positions).map(|&p| Vec3::from(p));
        assert!(corners().all(|p| (p.norm() - 2.0).abs() < 1e-12), "on the sphere");
        // The corners of the cone are 45° from rest.
        let lowest = corners().map(|p| p.dot(rest) / 2.0).fold(1.0, f64::min);
        assert!((lowest - 45f64.to_radians().cos()).abs() < 1e-12);
        // Least twist toward x: yellower there than on the other side.
        let shade = |x: f64| {
            let near = |s: &&Surface| s.positions.iter().any(|p| (p[0] - x).abs() < 0.06);
            surfaces.iter().filter(near).map(|s| s.colour[0]).max().expect("a patch")
        };
        assert!(shade(1.4) > shade(-1.4), "{} {}", shade(1.4), shade(-1.4));
    }

    /// Of places all over a cone with twist, at corners and within triangles, the colour is that of the twist that is
    /// enforced there, to half a shade and what is linear between corners that are a few degrees apart.
    #[test]
    fn the_shade_of_a_place_is_its_twist() {
        let human = crate::shipped::read("human").expect("it is shipped").value.model;
        let mut seen = 0;
        for component in human.components() {
            let Law::Cone(law) = &component.law else { continue };
            let reach = Reach::of_cone(&law.cone);
            let [low, high] = reach.ends();
            if high < low + 1e-9 {
                continue;
            }
            for surface in reach.shades(&|direction| direction) {
                for triangle in &surface.triangles {
                    let corners = triangle.map(|i| Vec3::from(surface.positions[i as usize]));
                    let [a, b, c] = corners;
                    for place in [a, b, c, a + b, a + b + c, a * 3.0 + b + c] {
                        // A little inward: on the boundary itself rounding decides.
                        let direction =
                            (place.normalized() + law.cone.rest().normalized() * 1e-9).normalized();
                        let ([from, to], _) = law.cone.twist_bounds(direction).expect("bounds");
                        let share = (to - from - low) / (high - low);
                        let colour = Reach::colour(share.clamp(0.0, 1.0));
                        for (shown, told) in surface.colour.into_iter().zip(colour) {
                            let most = f64::from(palette::LIMIT_LOW[0].abs_diff(palette::LIMIT[0]));
                            let off = f64::from(shown.abs_diff(told)) / most;
                            assert!(
                                off < 0.5 / 16.0 + 0.03,
                                "{}: {off} of the scale",
                                component.name
                            );
                        }
                        seen += 1;
                    }
                }
            }
        }
        assert!(seen > 10_000, "{seen}");
    }
}
