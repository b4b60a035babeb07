//! An ellipse over two numbers.
//!
//! Two angles whose ends depend on each other: the circumduction of a wrist is a tilted ellipse of
//! flexion and deviation, and no box. With c the centre, a and b the half axes and φ the angle from the
//! first number to the first half axis,
//!
//! ```text
//! u = R(-φ)·(x - c),   legal: (u₁/a)² + (u₂/b)² ≤ 1
//! g = ±|x - p|,        ∂g/∂x = the inward normal at p
//! ```
//!
//! with p the nearest point of the ellipse, found as the root of Eberly's equation in one unknown. Kinks:
//! inside on the part of the long axis whose points have two nearest ones. None outside, so that the
//! nearest legal numbers are continuous.

use super::{Contract, Geometry, Kind, Port, PortType};
use crate::limit::{Limit, MOST_LIMITED, MOST_ROWS, NO_ROW, Row, padded};
use std::fmt;

/// Two numbers inside an ellipse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    centre: [f64; 2],
    half_axes: [f64; 2],
    tilt: f64,
}

/// Why numbers do not make an [`Ellipse`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EllipseError;

impl fmt::Display for EllipseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("it needs a finite centre, a finite tilt and two positive half axes")
    }
}

impl std::error::Error for EllipseError {}

impl Ellipse {
    /// The ellipse with this centre and these half axes, the first turned by `tilt` (radians) from the
    /// first number toward the second. All in the unit of the numbers.
    ///
    /// # Errors
    /// For half axes that are not positive, and numbers that are not finite.
    ///
    /// ```
    /// use condyle_model::component::Ellipse;
    /// use condyle_model::limit::Limit;
    /// // A wrist: 70 degrees of flexion and 25 of deviation about neutral.
    /// let wrist = Ellipse::new([0.0, 0.0], [70f64.to_radians(), 25f64.to_radians()], 0.0).unwrap();
    /// let moved = wrist.legal(&[90f64.to_radians(), 0.0]).unwrap();
    /// assert!((moved[0] - 70f64.to_radians()).abs() < 1e-12 && moved[1] == 0.0);
    /// // Both at once are less: the corner of the box is outside.
    /// assert!(wrist.rows_at(&[1.2, 0.4])[0].0 < 0.0);
    /// ```
    pub fn new(centre: [f64; 2], half_axes: [f64; 2], tilt: f64) -> Result<Self, EllipseError> {
        let sound = half_axes.iter().all(|&a| a > 1e-9 && a.is_finite());
        if !sound || !tilt.is_finite() || !centre.iter().all(|c| c.is_finite()) {
            return Err(EllipseError);
        }
        Ok(Self { centre, half_axes, tilt })
    }

    /// Its centre.
    pub fn centre(&self) -> [f64; 2] {
        self.centre
    }

    /// Its half axes.
    pub fn half_axes(&self) -> [f64; 2] {
        self.half_axes
    }

    /// The angle of the first half axis.
    pub fn tilt(&self) -> f64 {
        self.tilt
    }

    fn inward(&self, numbers: &[f64]) -> [f64; 2] {
        let (s, c) = self.tilt.sin_cos();
        let [x, y] = [0, 1].map(|i: usize| numbers.get(i).copied().unwrap_or(0.0) - self.centre[i]);
        [c * x + s * y, c * y - s * x]
    }

    fn outward(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let (s, c) = self.tilt.sin_cos();
        [c * u - s * v, s * u + c * v]
    }

    /// The nearest point of the ellipse, both in its own axes.
    fn nearest(&self, point: [f64; 2]) -> [f64; 2] {
        // In the first quadrant, the long axis first.
        let swapped = self.half_axes[0] < self.half_axes[1];
        let order = |v: [f64; 2]| if swapped { [v[1], v[0]] } else { v };
        let [a, b] = order(self.half_axes);
        let [x, y] = order(point.map(f64::abs));
        let found = if y > 0.0 {
            // p = (a²x/(t + a²), b²y/(t + b²)) is on the ellipse for one t > -b²: with t = b²(s - 1),
            // (n·z₁/(s + n - 1))² + (z₂/s)² = 1, n = (a/b)², z = (x/a, y/b), which falls in s.
            let (z, n) = ([x / a, y / b], (a / b) * (a / b));
            // It is convex there, so that Newton's steps from below never pass the root; a start where
            // one term alone is 1 is below it.
            let mut s = z[1].max(n * (z[0] - 1.0) + 1.0);
            for _ in 0..100 {
                let (first, second) = (n * z[0] / (s + n - 1.0), z[1] / s);
                let value = first * first + second * second - 1.0;
                let slope = first * first / (s + n - 1.0) + second * second / s;
                let next = s + 0.5 * value / slope;
                // No further step: as near as rounding lets it.
                if next.is_nan() || next <= s {
                    break;
                }
                s = next;
            }
            [n * x / (s + n - 1.0), y / s]
        } else {
            // On the long axis: beside the foci the vertex is nearest, between them two points.
            let share = a * x / (a * a - b * b).max(1e-300);
            if a > b && share < 1.0 {
                [a * share, b * (1.0 - share * share).max(0.0).sqrt()]
            } else {
                [a, 0.0]
            }
        };
        let [u, v] = order(found);
        [u.copysign(point[0]), v.copysign(point[1])]
    }
}

impl Ellipse {
    pub(crate) const KIND: Kind = Kind {
        name: "ellipse",
        ports: &[Port::one("first", PortType::Scalar), Port::one("second", PortType::Scalar)],
    };
}

impl Contract for Ellipse {
    fn outputs(&self) -> (PortType, usize) {
        (PortType::Scalar, 2)
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }
}

impl Limit for Ellipse {
    fn rows(&self) -> usize {
        1
    }

    fn rows_at(&self, numbers: &[f64]) -> [Row; MOST_ROWS] {
        let point = self.inward(numbers);
        let on = self.nearest(point);
        let [a, b] = self.half_axes;
        // The gradient of the ellipse's equation at p is along its outward normal.
        let normal = [on[0] / (a * a), on[1] / (b * b)];
        let length = normal[0].hypot(normal[1]).max(1e-300);
        let normal = normal.map(|n| n / length);
        let off = [point[0] - on[0], point[1] - on[1]];
        let distance = -(off[0] * normal[0] + off[1] * normal[1]);
        let [x, y] = self.outward(normal);
        [(distance, padded([-x, -y])), NO_ROW, NO_ROW]
    }

    fn legal(&self, numbers: &[f64]) -> Option<[f64; MOST_LIMITED]> {
        let point = self.inward(numbers);
        let [u, v] = [point[0] / self.half_axes[0], point[1] / self.half_axes[1]];
        // Numbers that this has moved stay: a rounding does not count.
        let outside = u * u + v * v;
        if outside <= 1.0 + 1e-12 || outside.is_nan() {
            return None;
        }
        let [x, y] = self.outward(self.nearest(point));
        Some(padded([self.centre[0] + x, self.centre[1] + y]))
    }

    fn margin(&self, _: &[f64]) -> f64 {
        f64::INFINITY
    }
}
