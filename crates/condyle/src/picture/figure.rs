//! A posed figure that is drawn.

use super::focus::Chosen;
use super::limits::Reaches;
use super::screw::twists;
use condyle_math::{Affine, Vec3};
use condyle_model::{CoordinateId, Jacobian, Model, Pose, Program, SegmentId};
use condyle_render::palette::{self, Colour};

/// A model with its program, and one pose of it with its Jacobian.
pub(super) struct Figure<'a> {
    pub(super) model: &'a Model,
    pub(super) program: &'a Program,
    pub(super) stored: &'a [f64],
    pub(super) pose: &'a Pose,
    pub(super) jacobian: &'a Jacobian,
    /// What its bones look like.
    pub(super) surfaces: &'a crate::Figure,
    /// What is looked at, where something is.
    pub(super) chosen: Option<&'a Chosen>,
    /// Whether the rest is pale.
    pub(super) highlight: bool,
    /// What learned limits reach, worked out once.
    pub(super) reaches: &'a Reaches,
    /// A length that suits signs beside bones, in metres: a share of what the picture shows.
    pub(super) unit: f64,
}

/// A child whose joint is nearer to its parent's tells nothing of where the parent points, in metres.
const NEAR: f64 = 0.005;

impl Figure<'_> {
    /// The colour of something of a segment: as it is, or by whether it is highlighted.
    pub(super) fn colour(&self, segment: Option<SegmentId>, plain: Colour) -> Colour {
        match self.chosen.filter(|_| self.highlight) {
            None => plain,
            Some(chosen) if segment.is_some_and(|s| chosen.has(s)) => {
                if plain == palette::BONE {
                    palette::ACCENT
                } else {
                    plain
                }
            }
            Some(_) => palette::PALE,
        }
    }

    /// Where the moving end of a segment's joint is in the world.
    pub(super) fn joint(&self, id: SegmentId) -> Affine {
        self.pose.segment(id) * self.model.segment(id).joint_in_segment
    }

    /// The farthest joint of a segment's children from its own, or its farthest marker if it has none; its
    /// own joint if it has neither.
    pub(super) fn far_end(&self, id: SegmentId) -> Vec3 {
        let frame = self.pose.segment(id);
        let own = self.joint(id).translation;
        let away = |p: &Vec3| (*p - own).norm();
        let farthest = |a: &Vec3, b: &Vec3| away(a).total_cmp(&away(b));
        let children = self.model.segments().iter().filter(|s| s.parent == Some(id));
        let children = children.map(|s| frame * s.joint_in_parent.translation);
        let markers = self.model.markers().iter().filter(|m| m.segment == Some(id));
        let markers = markers.map(|m| frame * m.point);
        children
            .filter(|p| away(p) > NEAR)
            .max_by(farthest)
            .or_else(|| markers.max_by(farthest))
            .unwrap_or(own)
    }

    /// The first segment, from the root outwards, that one of some coordinates moves in its parent.
    pub(super) fn first_moved(&self, ids: &[CoordinateId]) -> Option<SegmentId> {
        let directions: Vec<usize> =
            ids.iter().flat_map(|&id| self.model.tangent_range(id)).collect();
        self.model.parents_first().into_iter().find(|&segment| {
            let parent = self.model.segment(segment).parent;
            let moving = twists(self.program, self.jacobian, segment, parent);
            moving.iter().any(|(direction, _)| directions.contains(direction))
        })
    }

    /// Whether signs are drawn for a segment: where something is looked at, only for that.
    pub(super) fn is_signed(&self, segment: SegmentId) -> bool {
        self.chosen.is_none_or(|chosen| chosen.has(segment))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Looks at a model in a pose, with signs of 5 cm.
    pub(in super::super) fn seen(model: &Model, stored: &[f64], look: impl FnOnce(&Figure)) {
        let program = Program::compile(model);
        let (mut pose, mut jacobian) = (Pose::new(&program), Jacobian::new(&program));
        program.evaluate_with_jacobian(stored, &mut pose, &mut jacobian).expect("its length");
        let surfaces = crate::Figure::new(model);
        look(&Figure {
            model,
            program: &program,
            stored,
            pose: &pose,
            jacobian: &jacobian,
            surfaces: &surfaces,
            chosen: None,
            highlight: false,
            reaches: &Reaches::default(),
            unit: 0.05,
        });
    }

    /// A document as a model.
    pub(in super::super) fn model(text: &str) -> Model {
        let read = condyle_formats::document::read(text, &mut |_| Err("alone".into()));
        read.expect("a model").value.model
    }
}
