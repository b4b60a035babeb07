//! Signs beside bones: axes of segments, markers, names.

use super::figure::Figure;
use condyle_math::Vec3;
use condyle_render::{Label, Line, Scene, Surface, palette, shape};

/// The axes of every segment.
pub(super) fn frames(figure: &Figure, scene: &mut Scene) {
    for id in figure.model.segment_ids().filter(|&id| figure.is_signed(id)) {
        let frame = figure.pose.segment(id);
        let axes = [
            (frame.linear.x, palette::AXIS_X),
            (frame.linear.y, palette::AXIS_Y),
            (frame.linear.z, palette::AXIS_Z),
        ];
        for (axis, colour) in axes {
            let end = frame.translation + axis * figure.unit;
            scene.lines.push(line(vec![frame.translation, end], 2.0, colour));
        }
    }
}

/// A ball at every marker.
pub(super) fn markers(figure: &Figure, scene: &mut Scene) {
    let mut surface = Surface::empty(palette::MARKER);
    for marker in figure.model.markers() {
        if marker.segment.is_none_or(|id| figure.is_signed(id)) {
            let at = figure.pose.frame(marker.segment) * marker.point;
            shape::add_ball(&mut surface, at, 0.12 * figure.unit, (12, 8));
        }
    }
    scene.surfaces.push(surface);
}

/// Names of segments, in the middle of their bones; of markers too where these are shown.
pub(super) fn names(figure: &Figure, markers: bool, scene: &mut Scene) {
    let model = figure.model;
    for id in model.segment_ids().filter(|&id| figure.is_signed(id)) {
        let at = figure.pose.segment(id) * model.segment(id).joint_in_segment.translation;
        let ends = model.segments().iter().filter(|s| s.parent == Some(id));
        let end = ends
            .map(|s| figure.pose.segment(id) * s.joint_in_parent.translation)
            .max_by(|a, b| (*a - at).norm().total_cmp(&(*b - at).norm()));
        let at = end.map_or(at, |end| (at + end) * 0.5);
        label(at, &model.segment(id).name, palette::TEXT, scene);
    }
    for marker in model.markers().iter().filter(|_| markers) {
        if marker.segment.is_none_or(|id| figure.is_signed(id)) {
            let at = figure.pose.frame(marker.segment) * marker.point;
            label(at, &marker.name, palette::MARKER, scene);
        }
    }
}

/// A label in a scene.
pub(super) fn label(at: Vec3, text: &str, colour: palette::Colour, scene: &mut Scene) {
    scene.labels.push(Label { at: at.to_array(), text: text.to_owned(), colour });
}

/// A line that is faintly seen through what is before it.
pub(super) fn line(points: Vec<Vec3>, width: f64, colour: palette::Colour) -> Line {
    let points = points.into_iter().map(Vec3::to_array).collect();
    Line { points, width, colour, opacity: 1.0, through: 0.35 }
}
