//! The range of one coordinate: the way of a point of what it moves, everything else held.

use super::super::figure::Figure;
use super::super::marks::{label, line};
use super::super::screw::{Motion, twists};
use super::super::sweep::Sweep;
use super::{fan, value};
use condyle_math::Vec3;
use condyle_model::{CoordinateId, CoordinateKind, SegmentId};
use condyle_render::{Line, Scene, Surface, palette, shape};

/// Draws the range of a coordinate, if it has one: where a limit ends it earlier, the rest is grey,
/// as is a range that is not enforced.
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
    // A range that is not enforced is told in grey.
    let enforced = figure.model.coordinate(id).range.enforced;
    // The point goes with the segment; the way is seen from the base as it stands now.
    let own = figure.pose.segment(segment).linear.inverse()
        * (point - figure.pose.segment(segment).translation);
    let now = figure.pose.frame(base);
    let seen = |sweep: &mut Sweep, value: f64| {
        let at = sweep.at(id, value)?;
        let moved = at.pose.segment(segment) * own;
        let place = now * (at.pose.frame(base).rigid_inverse() * moved);
        place.is_finite().then_some((enforced && at.legal, place))
    };
    let mut runs: Vec<(bool, Vec<Vec3>)> = vec![];
    let mut before: Option<(f64, bool)> = None;
    for value in sweep.values(id) {
        let Some((legal, place)) = seen(sweep, value) else { continue };
        // Where a limit ends it, the end is looked for: what is drawn is what is enforced.
        if let Some((from, last)) = before.filter(|(_, last)| *last != legal) {
            let end = ended(from, value, |middle| seen(sweep, middle).is_none_or(|s| s.0 == last));
            if let (Some((_, place)), Some((_, run))) = (seen(sweep, end), runs.last_mut()) {
                run.push(place);
            }
        }
        match runs.last_mut() {
            Some((same, run)) if *same == legal => run.push(place),
            Some((_, run)) => {
                let shared = run.last().copied().unwrap_or(place);
                runs.push((legal, vec![shared, place]));
            }
            None => runs.push((legal, vec![place])),
        }
        before = Some((value, legal));
    }
    // What moves nothing is not seen: a scale about the joint.
    let first = runs.first().and_then(|(_, run)| run.first().copied());
    let moves = |p: &Vec3| first.is_some_and(|first| (*p - first).norm() > 1e-6);
    if !runs.iter().flat_map(|(_, run)| run).any(moves) {
        runs.clear();
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

/// Halvings of a step of a sweep: to a thousandth of a degree.
const HALVINGS: u32 = 12;

/// The last value, from one that is `like` the first to one that is not, that is like the first.
fn ended(mut from: f64, mut to: f64, mut like: impl FnMut(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + to);
        if like(middle) { from = middle } else { to = middle }
    }
    from
}

/// A number with at most one decimal.
fn tidy(x: f64) -> f64 {
    let rounded = (x * 10.0).round() / 10.0;
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// What a coordinate moves, and in what: the segment of its joint set that carries most others, of those that
/// turn or glide at least half as much as any in the parent of the first.
pub(super) fn moved(
    figure: &Figure,
    id: CoordinateId,
) -> Option<(SegmentId, Option<SegmentId>, Motion)> {
    let model = figure.model;
    let direction = model.tangent_range(id).start;
    let set = model.coordinate(id).joint_set;
    let motion = |segment: SegmentId, base: Option<SegmentId>| {
        let twists = twists(figure.program, figure.jacobian, segment, base);
        let found = twists.into_iter().find(|(d, _)| *d == direction)?.1;
        Motion::of(found, figure.joint(segment).translation)
    };
    let order = model.parents_first();
    let own = order.into_iter().filter(|&s| model.segment(s).joint_set == Some(set));
    let own: Vec<SegmentId> = own.collect();
    let first = own.iter().copied().find(|&s| motion(s, model.segment(s).parent).is_some())?;
    let base = model.segment(first).parent;
    let motions = own.into_iter().filter_map(|s| Some((s, motion(s, base)?)));
    let motions: Vec<(SegmentId, Motion)> = motions.collect();
    let turns = motions.iter().any(|(_, m)| matches!(m, Motion::Turn { .. }));
    let alike = |m: &Motion| matches!(m, Motion::Turn { .. }) == turns;
    let most = motions.iter().filter(|(_, m)| alike(m)).map(|(_, m)| m.size()).fold(0.0, f64::max);
    let carried = |segment: SegmentId| {
        let all = model.segment_ids();
        all.filter(|&id| model.path_to_root(id).any(|above| above == segment)).count()
    };
    let (segment, motion) = motions
        .into_iter()
        .filter(|(_, m)| alike(m) && m.size() >= 0.5 * most)
        .max_by_key(|(segment, _)| carried(*segment))?;
    Some((segment, base, motion))
}

#[cfg(test)]
mod tests {
    use super::super::super::figure::tests::{model, seen};
    use super::*;

    /// A shank that bends from -10° to 130°, by a driver not beyond 60° of it.
    const LEG: &str = r#"
        condyle = 1
        kind = "model"
        angles = "deg"
        [segment.thigh]
        [segment.shank]
        parent = "thigh"
        at = [0, -0.4, 0]
        [segment.foot]
        parent = "shank"
        at = [0, -0.4, 0]
        [joint_set.knee]
        coordinate.bent = { range = [-10, 130] }
        coordinate.driver = { range = [0, 1], enforced = false }
        component.held.depend = { passive = "bent", driver = "driver", upper = 1.0471975511965976 }
        component.turn.rotate = { angle = "held", axis = [0, 0, -1] }
        output.shank = ["turn"]
        "#;

    /// The angle between two ends as seen from a joint, in degrees.
    fn angle(joint: [f64; 3], [a, b]: [[f64; 3]; 2]) -> f64 {
        let [a, b] = [a, b].map(|p| Vec3::from(p) - Vec3::from(joint));
        a.cross(b).norm().atan2(a.dot(b)).to_degrees()
    }

    #[test]
    fn an_arc_spans_the_range_and_what_another_limit_takes_is_grey() {
        let leg = model(LEG);
        seen(&leg, &[0.5, 0.0], |figure| {
            let mut scene = Scene::default();
            let bent = leg.find_coordinate("bent").unwrap();
            draw(figure, &mut Sweep::new(figure), bent, true, &mut scene);
            let ends = |line: &Line| [line.points[0], line.points[line.points.len() - 1]];
            let joint = [0.0, -0.4, 0.0];
            let of = |colour| scene.lines.iter().find(|l| l.colour == colour && l.points.len() > 2);
            // From -10° to 60°, the end to a thousandth of a degree: what is drawn is what is enforced.
            let legal = angle(joint, ends(of(palette::LIMIT).expect("what is allowed")));
            assert!(legal <= 70.0 + 1e-4 && legal > 70.0 - 2e-3, "{legal}");
            let rest = angle(joint, ends(of(palette::LEADER).expect("what is not")));
            assert!((legal + rest - 140.0).abs() < 1e-9);
            // The sign of now is where the bone points: 0.5 rad from straight down.
            let now = scene.lines.iter().find(|l| l.colour == palette::VALUE).unwrap();
            let down = [0.0, -1.0, 0.0];
            assert!((angle(joint, [now.points[1], down]).to_radians() - 0.5).abs() < 1e-12);
            assert_eq!(scene.labels[0].text, "bent 28.6° [-10, 130]");
            // Triangles of the fan are over the legal part alone.
            let fan: usize = scene.surfaces.iter().map(|s| s.triangles.len()).sum();
            assert_eq!(fan, of(palette::LIMIT).unwrap().points.len() - 1);
        });
    }

    #[test]
    fn a_bar_is_as_long_as_the_range_of_a_glide() {
        let slide = model(
            r#"
            condyle = 1
            kind = "model"
            [segment.a]
            [joint_set.a]
            coordinate.x = { kind = "translation", range = [-0.02, 0.05] }
            component.go.translate = { distance = "x", axis = [0, 1, 0] }
            output.a = ["go"]
            "#,
        );
        seen(&slide, &[0.01], |figure| {
            let mut scene = Scene::default();
            let x = slide.find_coordinate("x").unwrap();
            draw(figure, &mut Sweep::new(figure), x, false, &mut scene);
            let [bar] = &scene.lines[..] else { panic!("one bar") };
            let ends = [bar.points[0][1], bar.points[bar.points.len() - 1][1]];
            assert!((ends[0] + 0.02).abs() < 1e-12 && (ends[1] - 0.05).abs() < 1e-12, "{ends:?}");
        });
    }
}
