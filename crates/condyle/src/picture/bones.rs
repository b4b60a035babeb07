//! Bones as simple shapes: from each segment's joint to where its children hang, with a ball at every joint.

use super::figure::Figure;
use condyle_math::Vec3;
use condyle_model::{Model, SegmentId};
use condyle_render::{Surface, palette, shape};

/// The surfaces of all segments, each with its segment.
pub(super) fn surfaces(figure: &Figure) -> Vec<(SegmentId, Surface)> {
    let model = figure.model;
    let mut surfaces = vec![];
    for id in model.segment_ids() {
        let frame = figure.pose.segment(id);
        let own = model.segment(id).joint_in_segment.translation;
        let mut bone = Surface::empty(figure.colour(Some(id), palette::BONE));
        let mut joint = Surface::empty(figure.colour(Some(id), palette::JOINT));
        let mut longest: f64 = 0.03;
        for end in ends(model, id) {
            let length = (end - own).norm();
            if length >= SHORTEST {
                longest = longest.max(length);
                shape::add_bone(&mut bone, own, end);
            }
        }
        let radius = (0.06 * longest).clamp(0.004, 0.02);
        shape::add_ball(&mut joint, own, radius, (20, 12));
        for mut surface in [bone, joint] {
            surface.transform(&frame, 0);
            surfaces.push((id, surface));
        }
    }
    surfaces
}

/// Shorter bones are not drawn, in metres.
const SHORTEST: f64 = 0.005;

/// Where the joints of a segment's children are in it; of a last segment, its farthest marker.
fn ends(model: &Model, id: SegmentId) -> Vec<Vec3> {
    let children: Vec<Vec3> = model
        .segments()
        .iter()
        .filter(|s| s.parent == Some(id))
        .map(|s| s.joint_in_parent.translation)
        .collect();
    if !children.is_empty() {
        return children;
    }
    let own = model.segment(id).joint_in_segment.translation;
    let marks = model.markers().iter().filter(|m| m.segment == Some(id)).map(|m| m.point);
    marks.max_by(|a, b| (*a - own).norm().total_cmp(&(*b - own).norm())).into_iter().collect()
}
