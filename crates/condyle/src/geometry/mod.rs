//! What a model looks like beside its own shapes: meshes that its file names, and skins.
//!
//! A mesh belongs to one segment and is drawn in place of that segment's generated bone. A skin is carried by several
//! segments at every corner. Neither is a part of the [`Model`](crate::Model): a pose needs none of them, and who draws
//! asks for them ([`open`]).

#[cfg(feature = "formats")]
mod opened;
mod skin;

use condyle_mesh::Mesh;
use condyle_model::SegmentId;

#[cfg(feature = "formats")]
pub use opened::open;
pub use skin::{Hold, Skin};

/// Meshes and skins of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Geometry {
    /// Meshes, each of a segment.
    pub meshes: Vec<Placed>,
    /// What several segments carry.
    pub skins: Vec<Skin>,
}

impl Geometry {
    /// Whether there is nothing of either kind.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.meshes.is_empty() && self.skins.is_empty()
    }
}

/// A mesh in the frame of its segment, in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// The file it comes from, as the model names it.
    pub name: String,
    /// The segment.
    pub segment: SegmentId,
    /// The surface.
    pub mesh: Mesh,
}
