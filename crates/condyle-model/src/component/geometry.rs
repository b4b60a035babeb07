//! Parameters of laws by how they change with the size of a body and on its other side.

use super::Reflection;
use condyle_math::function::SimmSpline;
use condyle_math::{Affine, Vec3};

/// A parameter of a law that has a place, a size or a direction.
pub(crate) enum Geometry<'a> {
    /// A direction, by its name in files; it is normalised when a model is built. Mirrored: D·a.
    Direction(&'static str, &'a mut Vec3),
    /// The axis of a turn, likewise. Mirrored: -D·a.
    Turning(&'static str, &'a mut Vec3),
    /// A length in the joint.
    Length(&'a mut f64),
    /// A frame in the joint. Mirrored: D·T·D.
    Frame(&'a mut Affine),
    /// A curve in the joint. Mirrored: D·c.
    Path(&'a mut [SimmSpline; 3]),
    /// A point of the segment at the first port. Mirrored: D·p.
    Point(&'a mut Vec3),
}

impl<'a> Geometry<'a> {
    /// The direction with its name, if it is one.
    pub(crate) fn direction(self) -> Option<(&'static str, &'a mut Vec3)> {
        match self {
            Self::Direction(name, axis) | Self::Turning(name, axis) => Some((name, axis)),
            Self::Length(_) | Self::Frame(_) | Self::Path(_) | Self::Point(_) => None,
        }
    }

    /// Multiplies a length by the factor of the joint, or of the segments at the ports.
    pub(crate) fn grow(self, joint: f64, segments: &[f64]) {
        match self {
            Self::Direction(..) | Self::Turning(..) => {}
            Self::Length(length) => *length *= joint,
            Self::Frame(frame) => frame.translation = frame.translation * joint,
            Self::Path(path) => path.iter_mut().for_each(|spline| spline.stretch(joint, 1.0)),
            Self::Point(point) => *point = *point * segments.first().copied().unwrap_or(1.0),
        }
    }

    pub(crate) fn mirror(self, at: Reflection) {
        match self {
            Self::Direction(_, place) | Self::Point(place) => *place = at.point(*place),
            Self::Turning(_, axis) => *axis = at.turning(*axis),
            Self::Length(_) => {}
            Self::Frame(frame) => *frame = at.frame(*frame),
            Self::Path(path) => at.path(path),
        }
    }
}
