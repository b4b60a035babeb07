//! Shapes: what the bones of a character look like.

use super::SegmentId;
use condyle_math::Vec3;
use condyle_mesh::{Finish, Form};

/// A surface that is fixed in a segment, or hangs between two.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Its name, unique in the model.
    pub name: String,
    /// The segment whose frame it is given in.
    pub segment: SegmentId,
    /// The surface.
    pub form: Form,
    /// How it looks.
    pub finish: Finish,
    /// Where a tube ends that hangs between two segments, such as a costal cartilage: a point of another
    /// segment, in metres. The part between moves from the one to the other along the tube.
    pub until: Option<(SegmentId, Vec3)>,
}
