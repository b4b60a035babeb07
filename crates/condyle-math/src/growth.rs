//! Growth of a body along three axes.

use crate::{Mat3, Vec3};

/// How much a body grows along each of three axes at a right angle to each other, seen from some frame.
///
/// ```text
/// point      p′ = S p,   S = Rᵀ diag(f) R   with R the frame in the body
/// length     |S a| along a direction a
/// direction  S a/|S a|
/// ```
///
/// With equal factors S is a number, which keeps its bits whatever the frame.
///
/// ```
/// use condyle_math::{Mat3, Growth, Vec3};
/// // 10 % longer, no wider: seen from a frame whose x goes along the body's y.
/// let taller = Growth::along_axes([1.0, 1.1, 1.0]);
/// let seen = taller.within(Mat3::rotation_z(std::f64::consts::FRAC_PI_2));
/// assert!((seen.point(Vec3::X) - Vec3::new(1.1, 0.0, 0.0)).norm() < 1e-15);
/// assert!((seen.length(Vec3::Y) - 1.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// The factor, where it is the same along all axes.
    even: Option<f64>,
    linear: Mat3,
}

impl Growth {
    /// Nothing grows.
    pub const NONE: Self = Self { even: Some(1.0), linear: Mat3::IDENTITY };

    /// Factors along the axes of the frame.
    #[must_use]
    pub fn along_axes(factors: [f64; 3]) -> Self {
        let [x, y, z] = factors;
        let even = (x == y && y == z).then_some(x);
        let linear = Mat3::from_columns(Vec3::X * x, Vec3::Y * y, Vec3::Z * z);
        Self { even, linear }
    }

    /// The same seen from a frame that is turned.
    #[must_use]
    pub fn within(&self, frame: Mat3) -> Self {
        match self.even {
            Some(_) => *self,
            None => Self { even: None, linear: frame.transpose() * self.linear * frame },
        }
    }

    /// Whether it leaves everything as it is.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.even == Some(1.0)
    }

    /// Whether it is the same along all axes.
    #[must_use]
    pub fn is_even(&self) -> bool {
        self.even.is_some()
    }

    /// Where a point of the body goes.
    #[must_use]
    pub fn point(&self, point: Vec3) -> Vec3 {
        match self.even {
            Some(factor) => point * factor,
            None => self.linear * point,
        }
    }

    /// The factor of a length along a direction of length 1.
    #[must_use]
    pub fn length(&self, along: Vec3) -> f64 {
        match self.even {
            Some(factor) => factor,
            None => (self.linear * along).norm(),
        }
    }

    /// Where a direction of length 1 points afterwards.
    #[must_use]
    pub fn direction(&self, along: Vec3) -> Vec3 {
        match self.even {
            Some(_) => along,
            None => (self.linear * along).normalized(),
        }
    }

    /// The mean of the three factors: for a length without a direction.
    #[must_use]
    pub fn mean(&self) -> f64 {
        let trace = || (0..3).map(|k| self.linear.at(k, k)).sum::<f64>() / 3.0;
        self.even.unwrap_or_else(trace)
    }
}
