//! The range of one coordinate: the way of a point of what it moves, everything else held.

use super::super::figure::Figure;
use super::super::marks::{label, line};
use super::super::screw::{Motion, twists};
use super::super::sweep::Sweep;
use super::{fan, value};
use condyle_math::Vec3;
use condyle_model::{CoordinateId, CoordinateKind, SegmentId};
use condyle_render::{Line, Scene, Surface, palette, shape};

/// Draws the range of a coordinate, if it has one: where a limit ends it earlier, the rest is grey.
pub(super) fn draw(
    figure: &Figure,
    sweep: &mut Sweep,
    id: CoordinateId,
    named: bool,
    scene: &mut Scene,
) {
    let Some(ends) = sweep.range(id) else { return };
    let Some((segment, base, motion)) = moved(figure, id) else { return };
    if !figure.is_signed(segment) {
        return;
    }
    let (point, centre) = match motion {
        Motion::Turn { axis, centre, .. } => {
            let far = figure.far_end(segment);
            let middle = centre + axis * (far - centre).dot(axis);
            let off = far - middle;
            let length = off.norm();
            let off = match length > 0.003 {
                true => off * length.recip(),
                false => shape::across(axis)[0],
            };
            let long = length.max(figure.unit);
            let radius = (0.6 * long).clamp(0.8 * figure.unit, 3.0 * figure.unit);
            (middle + off * radius, Some(middle))
        }
        Motion::Glide { .. } => (figure.joint(segment).translation, None),
    };
    // The point goes with the segment; the way is seen from the base as it stands now.
    let own = figure.pose.segment(segment).linear.inverse()
        * (point - figure.pose.segment(segment).translation);
    let now = figure.pose.frame(base);
    let mut runs: Vec<(bool, Vec<Vec3>)> = vec![];
    for value in sweep.values(id) {
        let Some(at) = sweep.at(id, value) else { continue };
        let place = now * (at.pose.frame(base).rigid_inverse() * (at.pose.segment(segment) * own));
        if !place.is_finite() {
            continue;
        }
        match runs.last_mut() {
            Some((legal, run)) if *legal == at.legal => run.push(place),
            Some((_, run)) => {
                let shared = run.last().copied().unwrap_or(place);
                runs.push((at.legal, vec![shared, place]));
            }
            None => runs.push((at.legal, vec![place])),
        }
    }
    for (legal, run) in &runs {
        let (width, colour) = match (legal, centre) {
            (false, _) => (1.5, palette::LEADER),
            (true, Some(_)) => (2.5, palette::LIMIT),
            (true, None) => (5.0, palette::LIMIT),
        };
        scene.lines.push(line(run.clone(), width, colour));
        if let (true, Some(centre)) = (legal, centre) {
            scene.surfaces.push(fan(centre, run, palette::LIMIT));
        }
    }
    match centre {
        Some(centre) => {
            scene.lines.push(value(centre, point));
            let firsts = runs.first().and_then(|(_, run)| run.first());
            let lasts = runs.last().and_then(|(_, run)| run.last());
            for &end in firsts.into_iter().chain(lasts) {
                let ray = line(vec![centre, end], 1.0, palette::LIMIT);
                scene.lines.push(Line { opacity: 0.7, ..ray });
            }
        }
        None => {
            let mut mark = Surface::empty(palette::VALUE);
            shape::add_ball(&mut mark, point, 0.09 * figure.unit, (14, 10));
            scene.surfaces.push(mark);
        }
    }
    if named {
        let key = figure.model.coordinate_key(id);
        let now = figure.model.value(figure.stored, id);
        let (factor, unit) = match figure.model.coordinate(id).kind {
            CoordinateKind::Rotation => (1f64.to_degrees(), "°"),
            CoordinateKind::Translation => (1e3, " mm"),
            _ => (1.0, ""),
        };
        let [now, low, high] = [now, ends[0], ends[1]].map(|x| tidy(x * factor));
        let text = format!("{key} {now}{unit} [{low}, {high}]");
        label(point, &text, palette::TEXT, scene);
    }
}

/// A number with at most one decimal.
fn tidy(x: f64) -> f64 {
    let rounded = (x * 10.0).round() / 10.0;
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// What a coordinate moves, and in what: of the segments of its joint set the first, or where another turns or
/// glides more than twice as much in the parent of the first, the one that does most.
fn moved(figure: &Figure, id: CoordinateId) -> Option<(SegmentId, Option<SegmentId>, Motion)> {
    let model = figure.model;
    let direction = model.tangent_range(id).start;
    let set = model.coordinate(id).joint_set;
    let turning = |segment: SegmentId, base: Option<SegmentId>| {
        let twists = twists(figure.program, figure.jacobian, segment, base);
        let found = twists.into_iter().find(|(d, _)| *d == direction)?.1;
        Motion::of(found, figure.joint(segment).translation)
    };
    let order = model.parents_first();
    let own: Vec<SegmentId> =
        order.into_iter().filter(|&s| model.segment(s).joint_set == Some(set)).collect();
    let first = own.iter().copied().find(|&s| turning(s, model.segment(s).parent).is_some())?;
    let base = model.segment(first).parent;
    let motions = own.into_iter().filter_map(|s| Some((s, turning(s, base)?)));
    let motions: Vec<(SegmentId, Motion)> = motions.collect();
    let most = motions.iter().map(|(_, m)| m.size()).fold(0.0, f64::max);
    if let Some(&(segment, motion)) = motions.first().filter(|(_, m)| m.size() > 0.5 * most) {
        return Some((segment, base, motion));
    }
    let motions = motions.into_iter();
    let turns = motions.clone().any(|(_, m)| matches!(m, Motion::Turn { .. }));
    // Of equals the last is the farthest out.
    let (segment, motion) = motions
        .filter(|(_, m)| matches!(m, Motion::Turn { .. }) == turns)
        .max_by(|(_, a), (_, b)| a.size().total_cmp(&(b.size() + 1e-9)))?;
    Some((segment, base, motion))
}
