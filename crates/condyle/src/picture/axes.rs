//! Axes of joints: those of now, and where they go over the range of a coordinate.

use super::figure::Figure;
use super::marks::{label, line};
use super::screw::{Motion, coordinates, twists};
use super::sweep::Sweep;
use condyle_math::{Affine, Vec3};
use condyle_model::{CoordinateId, SegmentId};
use condyle_render::{Scene, Surface, palette, shape};

/// The axis about which each coordinate turns each segment in its parent now, or along which it moves it.
pub(super) fn axes(figure: &Figure, named: bool, scene: &mut Scene) {
    let owners = coordinates(figure.model);
    let mut heads = Surface::empty(palette::MOTION);
    for id in figure.model.segment_ids().filter(|&id| figure.is_signed(id)) {
        let place = figure.joint(id).translation;
        for (direction, twist) in moved(figure, id) {
            let Some(motion) = Motion::of(twist, place) else { continue };
            let (from, to) = match motion {
                Motion::Turn { axis, centre, .. } => {
                    (centre - axis * figure.unit, centre + axis * figure.unit)
                }
                Motion::Glide { velocity } => {
                    (place, place + velocity * (1.5 * figure.unit / velocity.norm()))
                }
            };
            let width = if matches!(motion, Motion::Turn { .. }) { 2.0 } else { 4.0 };
            scene.lines.push(line(vec![from, to], width, palette::MOTION));
            let tip = to + (to - from) * 0.12;
            shape::add_cone(&mut heads, to, tip, 0.1 * figure.unit);
            if named && let Some(&coordinate) = owners.get(direction) {
                let key = figure.model.coordinate_key(coordinate);
                label(tip, &key, palette::MOTION, scene);
            }
        }
    }
    scene.surfaces.push(heads);
}

/// Directions that move a segment in its parent.
fn moved(figure: &Figure, id: SegmentId) -> Vec<(usize, condyle_math::Twist)> {
    twists(figure.program, figure.jacobian, id, figure.model.segment(id).parent)
}

/// How far the centre of a fixed axis moves at most, in metres.
const FIXED: f64 = 2e-4;

/// A centre that is farther from its joint is not drawn, in metres: the segment all but glides.
const FAR: f64 = 0.15;

/// The moving centre of every joint: where the axis of each coordinate meets the plane across it through the
/// joint, now and over the coordinate's range.
///
/// Of a fixed axis that is a ball; of one that moves, its path with the centre of now on it, and the axis.
pub(super) fn centres(figure: &Figure, scene: &mut Scene) {
    let mut now = Surface::empty(palette::MOTION);
    let owners = coordinates(figure.model);
    let mut sweep = Sweep::new(figure);
    for id in figure.model.segment_ids().filter(|&id| figure.is_signed(id)) {
        let joint = figure.joint(id).translation;
        for (direction, twist) in moved(figure, id) {
            let Some(Motion::Turn { axis, centre, .. }) = Motion::of(twist, joint) else {
                continue;
            };
            let Some(&coordinate) = owners.get(direction) else { continue };
            if (centre - joint).norm() > FAR {
                continue;
            }
            let runs = path(figure, &mut sweep, coordinate, (id, direction), (joint, axis));
            shape::add_ball(&mut now, centre, 0.08 * figure.unit, (16, 10));
            let span = runs.iter().flatten().map(|p| (*p - centre).norm()).fold(0.0, f64::max);
            if span > FIXED {
                let [from, to] = [-0.6, 0.6].map(|s| centre + axis * (s * figure.unit));
                scene.lines.push(line(vec![from, to], 1.5, palette::MOTION));
                scene.lines.extend(runs.into_iter().map(|run| line(run, 3.0, palette::MOTION)));
            }
        }
    }
    scene.surfaces.push(now);
}

/// The centres over the range of a coordinate, carried along with the parent of now.
fn path(
    figure: &Figure,
    sweep: &mut Sweep,
    coordinate: CoordinateId,
    (id, direction): (SegmentId, usize),
    (joint, axis): (Vec3, Vec3),
) -> Vec<Vec<Vec3>> {
    let mut runs = vec![vec![]];
    let parent = figure.model.segment(id).parent;
    let now = figure.pose.frame(parent);
    for value in sweep.values(coordinate) {
        let Some(at) = sweep.at(coordinate, value) else { continue };
        let then = at.pose.frame(parent);
        let carried: Affine = now * then.rigid_inverse();
        let twists = twists(figure.program, at.jacobian, id, parent);
        let Some((_, twist)) = twists.into_iter().find(|(d, _)| *d == direction) else { continue };
        let place = carried.rigid_inverse() * joint;
        let Some(Motion::Turn { axis: turned, centre, .. }) = Motion::of(twist, place) else {
            continue;
        };
        let (turned, centre) = (carried.linear * turned, carried * centre);
        let slope = turned.dot(axis);
        let met = centre + turned * ((joint - centre).dot(axis) / slope);
        // An axis that lies in the plane does not meet it.
        let good = slope.abs() > 0.3 && (met - joint).norm() < FAR;
        match runs.last_mut() {
            Some(run) if good => run.push(met),
            Some(run) if !run.is_empty() => runs.push(vec![]),
            _ => {}
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::super::figure::tests::{model, seen};
    use super::*;

    #[test]
    fn a_wheel_turns_about_the_point_that_touches_the_ground() {
        // A wheel of 50 mm whose middle is at 0 when it has turned by 0. Turned by a it is at 0.05·a, and its
        // centre of rotation is its lowest point.
        let wheel = model(
            r#"
            condyle = 1
            kind = "model"
            [segment.wheel]
            at = [0, 1, 0]
            [joint_set.wheel]
            coordinate.a = { range = [-1, 1] }
            component.far.map = { input = "a", function = { linear = [0.05, 0] } }
            component.go.translate = { distance = "far", axis = [1, 0, 0] }
            component.turn.rotate = { angle = "a", axis = [0, 0, -1] }
            output.wheel = ["go", "turn"]
            "#,
        );
        seen(&wheel, &[0.4], |figure| {
            let mut scene = Scene::default();
            centres(figure, &mut scene);
            let [axis, path] = &scene.lines[..] else { panic!("an axis and a path") };
            assert!((axis.points[0][0] - 0.02).abs() < 1e-12);
            assert_eq!(path.points.len(), 49);
            for (index, point) in path.points.iter().enumerate() {
                let expected = [0.05 * (-1.0 + index as f64 / 24.0), 0.95, 0.0];
                for (found, expected) in point.iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-12, "{index}: {point:?}");
                }
            }
        });
    }

    #[test]
    fn a_hinge_stays_where_it_is() {
        let hinge = model(
            r#"
            condyle = 1
            kind = "model"
            [segment.a]
            [segment.b]
            parent = "a"
            at = [0, -0.4, 0]
            [joint.b]
            type = "hinge"
            segment = "b"
            axis = [0, 0, 1]
            coordinate.angle = { range = [0, 1] }
            "#,
        );
        seen(&hinge, &[0.3], |figure| {
            let mut scene = Scene::default();
            centres(figure, &mut scene);
            assert!(scene.lines.is_empty(), "a fixed centre has no path");
            axes(figure, true, &mut scene);
            // From 5 cm behind the joint to 5 cm before it.
            assert_eq!(scene.lines[0].points, [[0.0, -0.4, -0.05], [0.0, -0.4, 0.05]]);
            assert_eq!(scene.labels[0].text, "angle");
        });
    }
}
