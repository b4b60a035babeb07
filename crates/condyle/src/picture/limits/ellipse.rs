//! Two numbers inside an ellipse: the way of the bone's end around it.

use super::super::figure::Figure;
use super::super::marks::line;
use super::super::screw::{Motion, twists};
use super::super::sweep::Sweep;
use super::{fan, value};
use condyle_math::Vec3;
use condyle_math::function::Function;
use condyle_model::component::Ellipse;
use condyle_model::evaluate::Bound;
use condyle_model::limit::Limit;
use condyle_model::{CoordinateId, Law, SegmentId, Signal};
use condyle_render::{Scene, palette};
use std::f64::consts::TAU;

/// Points around an ellipse at least; where the way bends by more than this between two, in radians, there are more, and
/// so often.
const POINTS: usize = 32;
const BEND: f64 = 5e-4;
const BENDS: u32 = 6;

/// The part of an ellipse that the ranges of its two numbers leave, as its boundary about a place within.
pub(super) struct Around<'a> {
    law: &'a Ellipse,
    ranges: [[f64; 2]; 2],
    middle: [f64; 2],
}

impl<'a> Around<'a> {
    /// `None` where nothing is left, or the middle of the ellipse moved into the ranges is outside.
    fn new(law: &'a Ellipse, ranges: [[f64; 2]; 2]) -> Option<Self> {
        let mut middle = law.centre();
        for (number, [low, high]) in middle.iter_mut().zip(ranges) {
            if low > high {
                return None;
            }
            *number = number.max(low).min(high);
        }
        let inside = law.rows_at(&middle)[0].0 > 0.0;
        inside.then_some(Self { law, ranges, middle })
    }

    /// The two numbers on the boundary in a direction from the middle.
    fn at(&self, angle: f64) -> [f64; 2] {
        let (sin, cos) = angle.sin_cos();
        let along = [cos * self.law.half_axes()[0], sin * self.law.half_axes()[1]];
        let (s, c) = self.law.tilt().sin_cos();
        let turned = |[u, v]: [f64; 2]| [c * u - s * v, s * u + c * v];
        let way = turned(along);
        // In the ellipse's own axes, which are then those of a circle: |p + t·d| = 1.
        let own = |[x, y]: [f64; 2]| {
            let [a, b] = self.law.half_axes();
            [(c * x + s * y) / a, (c * y - s * x) / b]
        };
        let off = [0, 1].map(|i: usize| self.middle[i] - self.law.centre()[i]);
        let (p, d) = (own(off), own(way));
        let [pp, pd, dd] = [(p, p), (p, d), (d, d)].map(|(a, b)| a[0] * b[0] + a[1] * b[1]);
        let mut most = (-pd + (pd * pd - dd * (pp - 1.0)).max(0.0).sqrt()) / dd;
        for (i, [low, high]) in self.ranges.into_iter().enumerate() {
            let end = if way[i] > 0.0 { high } else { low };
            if way[i].abs() > 1e-12 {
                most = most.min((end - self.middle[i]) / way[i]);
            }
        }
        [0, 1].map(|i| self.middle[i] + most.max(0.0) * way[i])
    }
}

/// The coordinate that a port reads, and between which ends it may be: those of its range, and those that other
/// coordinates leave of it now.
pub(super) fn bounded(figure: &Figure, port: Signal) -> Option<(CoordinateId, [f64; 2])> {
    let components = figure.model.components();
    let (mut signal, mut ends) = (port, [f64::NEG_INFINITY, f64::INFINITY]);
    let mut narrow = |low: Option<f64>, high: Option<f64>| {
        ends = [ends[0].max(low.unwrap_or(ends[0])), ends[1].min(high.unwrap_or(ends[1]))];
    };
    for _ in 0..components.len() {
        match signal {
            Signal::Coordinate(id) => {
                let range = figure.model.coordinate(id).range;
                if range.enforced {
                    narrow(range.lower, range.upper);
                }
                return Some((id, ends));
            }
            Signal::Output(id, _) => {
                let Law::Depend(law) = &components[id.index()].law else { return None };
                let bound = figure.program.bounds().iter().find(|b| b.component == id)?;
                let driver = figure.pose.bounded(bound).nth(1)?;
                let end = |of: &Option<Function>| of.as_ref().map(|f| f.value_and_slope(driver).0);
                narrow(end(&law.lower), end(&law.upper));
                signal = *components[id.index()].inputs.first()?;
            }
            Signal::Segment(_) => return None,
        }
    }
    None
}

/// Draws an ellipse over two coordinates; such as they are where others bound them first; of what reads other numbers nothing is drawn.
pub(super) fn draw(
    figure: &Figure,
    sweep: &mut Sweep,
    bound: &Bound,
    law: &Ellipse,
    scene: &mut Scene,
) {
    let component = &figure.model.components()[bound.component.index()];
    let [first_in, second_in] = component.inputs[..] else { return };
    let Some((first, x)) = bounded(figure, first_in) else { return };
    let Some((second, y)) = bounded(figure, second_in) else { return };
    let Some(around) = Around::new(law, [x, y]) else { return };
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
    let mut seen = |angle: f64| {
        let [x, y] = around.at(angle);
        let at = sweep.with(&[(first, x), (second, y)])?;
        let place = at.pose.frame(base).rigid_inverse() * (at.pose.segment(segment) * own);
        let place = now * place;
        place.is_finite().then_some(place)
    };
    let step = TAU / POINTS as f64;
    let Some(start) = seen(0.0) else { return };
    let mut path: Vec<Vec3> = vec![start];
    // Pieces that are still to be looked at, the next one last.
    let mut open: Vec<(f64, f64, Option<Vec3>, u32)> =
        (0..POINTS).rev().map(|i| (step * i as f64, step * (i + 1) as f64, None, 0)).collect();
    while let Some((from, to, end, depth)) = open.pop() {
        let middle = 0.5 * (from + to);
        let (Some(before), Some(end)) = (path.last().copied(), end.or_else(|| seen(to))) else {
            continue;
        };
        let bent = (depth < BENDS).then(|| seen(middle)).flatten().filter(|place| {
            let flat = (before + end) * 0.5 - centre;
            let off = flat.cross(*place - centre).norm().atan2(flat.dot(*place - centre));
            off > BEND
        });
        match bent {
            Some(place) => {
                open.push((middle, to, Some(end), depth + 1));
                open.push((from, middle, Some(place), depth + 1));
            }
            None => path.push(end),
        }
    }
    scene.surfaces.push(fan(centre, &path, palette::LIMIT));
    scene.lines.push(line(path, 2.5, palette::LIMIT));
    scene.lines.push(value(centre, point));
}

/// The last segment of their joint set that both coordinates turn.
pub(super) fn moved_last(figure: &Figure, ids: [CoordinateId; 2]) -> Option<SegmentId> {
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
