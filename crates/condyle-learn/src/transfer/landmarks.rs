//! Three landmarks of a joint's parent, and their frame.

use condyle_diagnostics::Error;
use condyle_math::{Affine, Mat3, Vec3};

/// Three landmarks of a joint's parent, in any frame of it, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landmarks {
    /// At the parent's origin, above the joint: the great trochanter of a thigh.
    pub origin: Vec3,
    /// At the medial end of the joint's axis.
    pub medial: Vec3,
    /// At its lateral end.
    pub lateral: Vec3,
    /// Whether it is a joint of the left side, on which the lateral end is the left end.
    pub left: bool,
}

impl Landmarks {
    /// The points in the order origin, medial, lateral.
    #[must_use]
    pub fn points(&self) -> [Vec3; 3] {
        [self.origin, self.medial, self.lateral]
    }

    /// Their frame: at the origin; z to the right along the joint's axis, y in the plane of the three, from the middle of the ends
    /// toward the origin, x forward (Pronost et al. 2010, 3.1).
    ///
    /// ```
    /// use condyle_learn::transfer::Landmarks;
    /// use condyle_math::Vec3;
    /// let thigh = Landmarks {
    ///     origin: Vec3::new(0.0, 0.9, 0.2),
    ///     medial: Vec3::new(0.0, 0.5, 0.05),
    ///     lateral: Vec3::new(0.0, 0.5, 0.15),
    ///     left: false,
    /// };
    /// let frame = thigh.frame()?;
    /// assert_eq!(frame.translation, thigh.origin);
    /// // To the right is z, up is y, and forward is x.
    /// assert!((frame.linear * Vec3::X - Vec3::X).norm() < 1e-15);
    /// assert!((frame.linear * Vec3::Z - Vec3::Z).norm() < 1e-15);
    /// # Ok::<(), condyle_diagnostics::Error>(())
    /// ```
    ///
    /// # Errors
    /// `transfer/landmarks` where they lie on a line or are not finite.
    pub fn frame(&self) -> Result<Affine, Error> {
        let side = match self.left {
            true => self.medial - self.lateral,
            false => self.lateral - self.medial,
        };
        let up = self.origin - (self.medial + self.lateral) * 0.5;
        let z = side.normalized();
        let y = up - z * z.dot(up);
        if !(side.norm() > 1e-4 && y.norm() > 0.05 * up.norm() && y.norm() > 1e-4) {
            let message = "three landmarks lie on a line";
            return Err(Error::new("transfer/landmarks", message).with_help(
                "give the origin above the joint and both ends of its axis, in metres",
            ));
        }
        let y = y.normalized();
        Ok(Affine::new(Mat3::from_columns(y.cross(z), y, z), self.origin))
    }
}
