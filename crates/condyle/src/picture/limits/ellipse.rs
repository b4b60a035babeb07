//! Two numbers inside an ellipse: the way of the bone's end around it.

use super::super::figure::Figure;
use super::super::marks::line;
use super::super::screw::{Motion, twists};
use super::super::sweep::Sweep;
use super::{fan, value};
use condyle_math::Vec3;
use condyle_model::component::Ellipse;
use condyle_model::evaluate::Bound;
use condyle_model::{CoordinateId, SegmentId, Signal};
use condyle_render::{Scene, palette};
use std::f64::consts::TAU;

/// Points around an ellipse.
const POINTS: usize = 96;

/// Draws an ellipse over two coordinates; of what reads other numbers nothing is drawn.
pub(super) fn draw(
    figure: &Figure,
    sweep: &mut Sweep,
    bound: &Bound,
    law: &Ellipse,
    scene: &mut Scene,
) {
    let component = &figure.model.components()[bound.component.index()];
    let [Signal::Coordinate(first), Signal::Coordinate(second)] = component.inputs[..] else {
        return;
    };
    let Some(segment) = moved_last(figure, [first, second]) else { return };
    if !figure.is_signed(segment) {
        return;
    }
    let centre = figure.joint(segment).translation;
    let off = figure.far_end(segment) - centre;
    let length = off.norm();
    if !(length > 1e-4 && length.is_finite()) {
        return;
    }
    let reach = (0.7 * length).clamp(1.2 * figure.unit, 3.0 * figure.unit);
    let point = centre + off * (reach / length);
    let frame = figure.pose.segment(segment);
    let own = frame.linear.inverse() * (point - frame.translation);
    // What carries the first of what the two coordinates move.
    let base = figure.first_moved(&[first, second]).and_then(|s| figure.model.segment(s).parent);
    let now = figure.pose.frame(base);
    let (sin, cos) = law.tilt().sin_cos();
    let mut path: Vec<Vec3> = vec![];
    for index in 0..=POINTS {
        let (s, c) = (TAU * index as f64 / POINTS as f64).sin_cos();
        let [u, v] = [c * law.half_axes()[0], s * law.half_axes()[1]];
        let [x, y] = [law.centre()[0] + cos * u - sin * v, law.centre()[1] + sin * u + cos * v];
        let [x, y] = [(first, x), (second, y)]
            .map(|(id, value)| (id, figure.model.coordinate(id).range.nearest(value)));
        let Some(at) = sweep.with(&[x, y]) else { continue };
        let place = at.pose.frame(base).rigid_inverse() * (at.pose.segment(segment) * own);
        path.push(now * place);
    }
    scene.surfaces.push(fan(centre, &path, palette::LIMIT));
    scene.lines.push(line(path, 2.5, palette::LIMIT));
    scene.lines.push(value(centre, point));
}

/// The last segment of their joint set that both coordinates turn.
fn moved_last(figure: &Figure, ids: [CoordinateId; 2]) -> Option<SegmentId> {
    let model = figure.model;
    let moves = |segment: SegmentId, id: CoordinateId| {
        let direction = model.tangent_range(id).start;
        let twists = twists(figure.program, figure.jacobian, segment, None);
        let found = twists.into_iter().find(|(d, _)| *d == direction);
        found.and_then(|(_, t)| Motion::of(t, figure.joint(segment).translation)).is_some()
    };
    let sets = ids.map(|id| Some(model.coordinate(id).joint_set));
    let order = model.parents_first().into_iter().rev();
    let mut own = order.filter(|&s| sets.contains(&model.segment(s).joint_set));
    own.find(|&s| ids.iter().all(|&id| moves(s, id)))
}
