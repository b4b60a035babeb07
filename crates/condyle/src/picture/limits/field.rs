//! What a learned field reaches: the directions in which the bone may point with some twist, as a part of a sphere about its joint.

use super::super::figure::Figure;
use super::cone::{Said, frame};
use super::reach::Reach;
use super::twist::Twist;
use super::{Judged, value};
use condyle_math::{Mat3, Quat, Vec3};
use condyle_mesh::{Mesh, Patch};
use condyle_model::component::FieldLimit;
use condyle_model::evaluate::Bound;
use condyle_model::limit::MOST_LIMITED;
use condyle_model::limit::field::fibre;
use condyle_model::model::ComponentId;
use condyle_model::{Law, SegmentId, Signal};
use condyle_render::{Scene, Surface, palette, shape};
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

/// Corners are 2 degrees apart.
const LEVEL: u32 = 5;

impl Reaches {
    /// The boundary of a limit of rotations, made when it is first asked for.
    pub(in super::super) fn boundary_of(
        &self,
        judged: &Judged,
        make: impl FnOnce(&dyn Fn(Quat) -> f64) -> Mesh,
    ) -> Rc<Mesh> {
        let component = judged.bound.component;
        let same = |(of, others, _): &&Boundary| {
            let near = |(a, b): (&f64, &f64)| (a - b).abs() < SAME;
            *of == component && others.iter().zip(judged.others()).all(near)
        };
        if let Some((.., known)) = self.boundaries.borrow().iter().find(same) {
            return known.clone();
        }
        let made = Rc::new(make(&|q| judged.distance(q)));
        let mut kept = self.boundaries.borrow_mut();
        if kept.len() >= MOST_KEPT {
            kept.remove(0);
        }
        kept.push((component, judged.others().to_vec(), made.clone()));
        made
    }
}

/// Draws the reach of a field.
pub(super) fn draw(figure: &Figure, bound: &Bound, law: &FieldLimit, scene: &mut Scene) {
    let numbers: Vec<f64> = figure.pose.bounded(bound).collect();
    let Some(now) = rotation(&numbers) else { return };
    let Some((segment, frame)) = turned(figure, bound, now) else { return };
    if !figure.is_signed(segment) {
        return;
    }
    let centre = figure.joint(segment).translation;
    let off = figure.far_end(segment) - centre;
    let length = off.norm();
    if !(length > 1e-6 && length.is_finite()) {
        return;
    }
    // In the axes of the child that the limit speaks of.
    let bone = (frame * now).transpose() * (off * length.recip());
    let reach = figure.reaches.of(bound.component, law, &numbers, bone);
    let radius = (0.45 * length).clamp(1.5 * figure.unit, 4.0 * figure.unit);
    let place = |direction: Vec3| centre + frame * direction * radius;
    reach.draw(&place, true, scene);
    let tip = place(now * bone);
    scene.lines.push(value(centre, tip));
    let mut mark = Surface::empty(palette::VALUE);
    shape::add_ball(&mut mark, tip, 0.08 * figure.unit, (14, 10));
    scene.surfaces.push(mark);
    let turn = Twist::of(bone, now);
    let spans = turn.spans(&distance(law, &numbers));
    turn.draw(&|v| frame * v, tip, 0.3 * radius, &spans, scene);
}

pub(super) fn rotation(numbers: &[f64]) -> Option<Mat3> {
    let &[x, y, z, w, ..] = numbers else { return None };
    let q = Quat { x, y, z, w };
    let length = q.dot(q);
    (length.is_finite() && length > 1e-18).then(|| q.normalized().to_mat3())
}

/// The segment that is turned and the frame in the world in which it is: said by the segments that are measured, or found as that
/// of a cone.
pub(super) fn turned(figure: &Figure, bound: &Bound, now: Mat3) -> Option<(SegmentId, Mat3)> {
    let components = figure.model.components();
    let component = &components[bound.component.index()];
    if let Some(Signal::Output(id, _)) = component.inputs.first() {
        let before = &components[id.index()];
        if let (Law::RelativeOrientation(_), Some(Signal::Segment(segment))) =
            (&before.law, before.inputs.first())
        {
            let reference = match before.inputs.get(1) {
                Some(Signal::Segment(reference)) => Some(*reference),
                _ => None,
            };
            return Some((*segment, figure.pose.frame(reference).linear));
        }
    }
    let said = Said { rotation: &rotation, off: &|a, b| (b.transpose() * a).log().norm() };
    frame(figure, bound, &said, now)
}

/// What learned limits reach, for who draws them again and again: to work it out takes a moment, and it changes only with what
/// else the limit depends on.
#[derive(Debug, Default)]
pub struct Reaches {
    kept: RefCell<Vec<Kept>>,
    boundaries: RefCell<Vec<Boundary>>,
}

/// A boundary in the space of quaternions: of a component, with the numbers beside the rotation.
type Boundary = (ComponentId, Vec<f64>, Rc<Mesh>);

#[derive(Debug)]
struct Kept {
    component: ComponentId,
    /// The numbers of the limit beside the rotation, and the direction of the bone.
    others: Vec<f64>,
    bone: Vec3,
    reach: Rc<Reach>,
}

/// Numbers that differ by less are the same, and so many are kept.
const SAME: f64 = 1e-6;
const MOST_KEPT: usize = 12;

impl Reaches {
    fn of(&self, component: ComponentId, law: &FieldLimit, all: &[f64], bone: Vec3) -> Rc<Reach> {
        let others = all.get(4..).unwrap_or_default();
        let same = |kept: &&Kept| {
            let near = |(a, b): (&f64, &f64)| (a - b).abs() < SAME;
            kept.component == component
                && (kept.bone - bone).norm() < SAME
                && kept.others.iter().zip(others).all(near)
        };
        if let Some(known) = self.kept.borrow().iter().find(same) {
            return known.reach.clone();
        }
        let reach = Rc::new(Reach::of_field(law, all, bone));
        let mut kept = self.kept.borrow_mut();
        if kept.len() >= MOST_KEPT {
            kept.remove(0);
        }
        kept.push(Kept { component, others: others.to_vec(), bone, reach: reach.clone() });
        reach
    }
}

impl Reach {
    /// By the distance that the limit enforces: what is drawn is what is enforced.
    fn of_field(law: &FieldLimit, numbers: &[f64], bone: Vec3) -> Self {
        let distance = distance(law, numbers);
        let known = RefCell::new(HashMap::new());
        let deepest = |v: Vec3| {
            let found = fibre(&distance, bone, v);
            known.borrow_mut().insert(v.to_array().map(f64::to_bits), found.width);
            found.deepest
        };
        let patch = Patch::of_distance(&deepest, LEVEL);
        let known = known.borrow();
        let width = |v: &Vec3| match known.get(&v.to_array().map(f64::to_bits)) {
            Some(width) => *width,
            None => fibre(&distance, bone, *v).width,
        };
        let widths = patch.corners.iter().map(width).collect();
        Self { patch, widths }
    }
}

/// The distance of a rotation, with what else the limit reads.
fn distance<'a>(law: &'a FieldLimit, numbers: &'a [f64]) -> impl Fn(Quat) -> f64 + 'a {
    let mut asked = [0.0; MOST_LIMITED];
    asked.iter_mut().zip(numbers).for_each(|(to, from)| *to = *from);
    let count = numbers.len().min(MOST_LIMITED);
    move |q: Quat| {
        let mut asked = asked;
        asked[..4].copy_from_slice(&q.to_array());
        law.distance(&asked[..count])
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::figure::tests::seen;
    use super::*;
    use crate::limits::{About, Cloud, Settings, learn};
    use condyle_model::ModelBuilder;
    use condyle_model::limit::Limit;
    use std::sync::Arc;

    /// About z, then x, then y of the arm.
    fn turned([z, x, y]: [f64; 3]) -> Quat {
        let turn = Quat::from_axis_angle;
        turn(Vec3::Z, z) * turn(Vec3::X, x) * turn(Vec3::Y, y)
    }

    /// Rotations of an arm whose twist depends on where it points: it swings by 70 degrees forward and 40 back, 50 to the sides.
    fn limit() -> FieldLimit {
        let mut take = vec![];
        for i in -10..=10 {
            for j in -10..=10 {
                for k in -10..=10 {
                    let [z, x] = [7.0 * f64::from(i), 5.0 * f64::from(j)];
                    let z = if z < 0.0 { z * 4.0 / 7.0 } else { z };
                    let twist = f64::from(k) * (5.0 - 0.03 * z);
                    take.push(turned([z, x, twist].map(f64::to_radians)));
                }
            }
        }
        let cloud = Cloud::gather(&[&take], 0.0).expect("rotations");
        let settings = Settings { nodes: 48, ..Settings::default() };
        FieldLimit::new(Arc::new(learn(&cloud, &settings, About::default()).expect("settings")))
    }

    /// Points all along the drawn boundary, those between its corners too, are within 0.1 degrees of where the enforced limit
    /// ends: across the boundary some twist is allowed 0.1 degrees inward, and none 0.1 degrees outward, by all twists in steps of a
    /// third of a degree.
    #[test]
    fn the_drawn_boundary_is_the_enforced_one() {
        let law = limit();
        let bone = -Vec3::Y;
        let reach = Reach::of_field(&law, &[0.0, 0.0, 0.0, 1.0], bone);
        let allowed = |direction: Vec3| {
            let across = bone.cross(direction);
            let angle = across.norm().atan2(bone.dot(direction));
            let swing = Quat::exp(across.normalized() * angle);
            (0..1080).any(|i| {
                let twist = Quat::from_axis_angle(bone, f64::from(i) / 3.0 * 1f64.to_radians());
                law.rows_at(&(swing * twist).to_array())[0].0 >= 0.0
            })
        };
        let edges = reach.edges();
        assert!(!edges.is_empty());
        let (mut count, mut wrong) = (0, 0);
        for ends in edges.iter().flat_map(|edge| edge.windows(2)).step_by(5) {
            let along = (ends[1] - ends[0]).normalized();
            for share in [0.0, 0.25, 0.5, 0.75] {
                let at = (ends[0] * (1.0 - share) + ends[1] * share).normalized();
                let out = along.cross(at).normalized() * 0.1f64.to_radians();
                count += 1;
                let judged = [at - out, at + out].map(|to| allowed(to.normalized()));
                wrong += usize::from(judged != [true, false]);
            }
        }
        assert!(count > 100, "{count}");
        assert_eq!(wrong, 0, "of {count}");
    }

    /// Twists are told by lines as well as by colour, and a line says what a search finds on it.
    #[test]
    fn lines_say_the_twist() {
        let law = limit();
        let reach = Reach::of_field(&law, &[0.0, 0.0, 0.0, 1.0], -Vec3::Y);
        let lines = reach.lines();
        assert!(lines.len() > 1);
        let distance = |q: Quat| law.rows_at(&q.to_array())[0].0;
        for (degrees, line) in &lines {
            // A degree to either side of the line the twist is more and less than it says: near the boundary it falls steeply.
            let middle = line.len() / 2;
            let at = line[middle];
            let along = line[(middle + 1).min(line.len() - 1)] - line[middle.saturating_sub(1)];
            let across = along.cross(at).normalized() * 1f64.to_radians();
            let width = |v: Vec3| fibre(&distance, -Vec3::Y, v.normalized()).width.to_degrees();
            let sides = [width(at - across), width(at + across)];
            let [low, high] = [sides[0].min(sides[1]), sides[0].max(sides[1])];
            assert!(low < *degrees && *degrees < high, "{low} to {high} on the line of {degrees}");
        }
    }

    /// A field of a ball joint and one between segments are drawn about the joint, where the bone points.
    #[test]
    fn a_field_is_drawn_where_the_bone_is() {
        let law = limit();
        let mut builder = ModelBuilder::new("arm");
        let trunk = builder.segment("trunk", None);
        let arm = builder.segment("arm", Some(trunk));
        builder.place_joint(arm, Vec3::new(0.1, 0.4, 0.0));
        builder.marker("elbow", Some(arm), Vec3::new(0.0, -0.3, 0.0));
        let set = builder.joint_set("shoulder");
        let turn = builder.coordinate(set, "turn", condyle_model::CoordinateKind::Orientation);
        let legal = builder.component(set, "legal", Law::Field(law), vec![turn.into()]);
        let ball =
            builder.component(set, "ball", Law::Ball(condyle_model::component::Ball), vec![legal]);
        builder.output(set, arm, ball);
        let model = builder.build().expect("a model");
        let q = turned([0.4, -0.2, 0.3]);
        seen(&model, &q.to_array(), |figure| {
            let mut scene = Scene::default();
            super::super::limits(figure, false, &mut scene);
            assert!(!scene.surfaces.is_empty() && !scene.labels.is_empty());
            let joint = Vec3::new(0.1, 0.4, 0.0);
            let value = scene.lines.iter().find(|line| line.colour == palette::VALUE).unwrap();
            let tip = Vec3::from(value.points[1]) - joint;
            let arm = q.to_mat3() * -Vec3::Y;
            assert!((tip.normalized() - arm).norm() < 1e-9);
            // All of it on one sphere about the joint.
            let edges = scene
                .lines
                .iter()
                .filter(|line| line.colour == palette::LIMIT && line.width == 2.0);
            let points = edges.flat_map(|line| &line.points);
            assert!(points.clone().count() > 50);
            for point in points {
                assert!(((Vec3::from(*point) - joint).norm() - tip.norm()).abs() < 1e-9);
            }
        });
    }
}
