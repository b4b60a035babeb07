//! Parameters of laws by how they change with the size of a body and on its other side.

use super::Reflection;
use condyle_math::function::SimmSpline;
use condyle_math::{Affine, Growth, Vec3};

/// A parameter of a law that has a place, a size or a direction.
pub(crate) enum Geometry<'a> {
    /// A direction, by its name in files; it is normalised when a model is built. Mirrored: D·a.
    Direction(&'static str, &'a mut Vec3),
    /// The axis of a turn, likewise. Mirrored: -D·a.
    Turning(&'static str, &'a mut Vec3),
    /// A length in the joint, along a direction of length 1.
    Length(&'a mut f64, Vec3),
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
            Self::Length(..) | Self::Frame(_) | Self::Path(_) | Self::Point(_) => None,
        }
    }

    /// Changes it with the growth of the joint, or of the segments at the ports.
    pub(crate) fn grow(self, joint: &Growth, segments: &[Growth]) {
        match self {
            Self::Direction(..) | Self::Turning(..) => {}
            Self::Length(length, along) => *length *= joint.length(along),
            Self::Frame(frame) => frame.translation = joint.point(frame.translation),
            Self::Path(path) => grow_path(path, joint),
            Self::Point(point) => {
                *point = segments.first().unwrap_or(&Growth::NONE).point(*point);
            }
        }
    }

    pub(crate) fn mirror(self, at: Reflection) {
        match self {
            Self::Direction(_, place) | Self::Point(place) => *place = at.point(*place),
            Self::Turning(_, axis) => *axis = at.turning(*axis),
            Self::Length(..) => {}
            Self::Frame(frame) => *frame = at.frame(*frame),
            Self::Path(path) => at.path(path),
        }
    }
}

/// Each part of a curve grows along its axis.
pub(crate) fn grow_path(path: &mut [SimmSpline; 3], joint: &Growth) {
    for (spline, axis) in path.iter_mut().zip([Vec3::X, Vec3::Y, Vec3::Z]) {
        spline.stretch(joint.length(axis), 1.0);
    }
}
