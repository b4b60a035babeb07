//! A posed figure that is drawn.

use super::focus::Chosen;
use condyle_model::{Jacobian, Model, Pose, Program, SegmentId};
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
    /// A length that suits signs beside bones, in metres: a share of what the picture shows.
    pub(super) unit: f64,
}

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

    /// Whether signs are drawn for a segment: where something is looked at, only for that.
    pub(super) fn is_signed(&self, segment: SegmentId) -> bool {
        self.chosen.is_none_or(|chosen| chosen.has(segment))
    }
}
