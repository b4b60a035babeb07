//! A limit given by formulas instead of samples: three turns, the ends of each of which depend on those before.
//!
//! ```text
//! R = turn(a₁, φ₁) · turn(a₂, φ₂) · turn(a₃, φ₃),   a₁, a₂, a₃ perpendicular to each other
//! φ₁ within [l₁, u₁],   φ₂ within [l₂(φ₁), u₂(φ₁)],   φ₃ within [l₃(φ₁, φ₂), u₃(φ₁, φ₂)]
//! ```
//!
//! Ends are tables, linear between their rows and columns and beyond them: a bilinear formula is a table of two rows and two
//! columns. φ₂ may go beyond a quarter turn. What is allowed besides is all that is within `beyond` of such a rotation.
//!
//! Lenarčič & Umek 1994 gave the shoulder in this form: abduction, flexion within ends that abduction moves, and the turn
//! about the arm's own axis within ends that both move.

use condyle_math::{Quat, Vec3};
use std::f64::consts::{PI, TAU};

/// Both ends of a turn, by the turns before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Ends {
    first: Vec<f64>,
    second: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

/// Three turns whose ends depend on those before.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    axes: [Vec3; 3],
    first: [f64; 2],
    second: Ends,
    third: Ends,
    beyond: f64,
    /// The axes as columns, the third with the sign of the right hand.
    basis: Quat,
    /// -1 where the third axis is against it.
    hand: f64,
}

/// Why three turns are no limit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShapeError {
    /// What is wrong with them.
    pub message: String,
    /// What would be right.
    pub help: &'static str,
}

fn wrong(message: impl Into<String>, help: &'static str) -> ShapeError {
    ShapeError { message: message.into(), help }
}

impl Ends {
    /// Ends at rows of the first turn and columns of the second, in radians, row by row; without columns, or with one,
    /// they depend on the first alone.
    ///
    /// # Errors
    /// If rows or columns do not rise, numbers are not finite or not as many as rows times columns, or a lower end is
    /// above its upper one.
    pub fn new(
        first: Vec<f64>,
        second: Vec<f64>,
        lower: Vec<f64>,
        upper: Vec<f64>,
    ) -> Result<Self, ShapeError> {
        let second = if second.is_empty() { vec![0.0] } else { second };
        let all = || first.iter().chain(&second).chain(&lower).chain(&upper);
        if !all().all(|number| number.is_finite()) {
            return Err(wrong("an end is no finite number", "give angles"));
        }
        let rises = |knots: &[f64]| knots.windows(2).all(|pair| pair[0] < pair[1]);
        if first.is_empty() || !rises(&first) || !rises(&second) {
            let message = "the angles at which ends are given do not rise";
            return Err(wrong(message, "give them in rising order, at least one"));
        }
        let count = first.len() * second.len();
        if lower.len() != count || upper.len() != count {
            let message = format!(
                "there are {} lower and {} upper ends for {} rows of {}",
                lower.len(),
                upper.len(),
                first.len(),
                second.len()
            );
            return Err(wrong(message, "give one of each for each row and column"));
        }
        if lower.iter().zip(&upper).any(|(lower, upper)| lower > upper) {
            return Err(wrong("a lower end is above its upper end", "exchange or correct them"));
        }
        Ok(Self { first, second, lower, upper })
    }

    /// The same ends whatever comes before.
    #[must_use]
    pub fn fixed([lower, upper]: [f64; 2]) -> Self {
        Self { first: vec![0.0], second: vec![0.0], lower: vec![lower], upper: vec![upper] }
    }

    /// The angles of the first turn at which ends are given.
    #[must_use]
    pub fn first(&self) -> &[f64] {
        &self.first
    }

    /// Those of the second turn.
    #[must_use]
    pub fn second(&self) -> &[f64] {
        &self.second
    }

    /// Lower ends, row by row.
    #[must_use]
    pub fn lower(&self) -> &[f64] {
        &self.lower
    }

    /// Upper ends, row by row.
    #[must_use]
    pub fn upper(&self) -> &[f64] {
        &self.upper
    }

    /// Both ends at angles of the turns before.
    #[must_use]
    pub fn at(&self, first: f64, second: f64) -> [f64; 2] {
        let (i, s) = between(&self.first, first);
        let (j, t) = between(&self.second, second);
        let columns = self.second.len();
        let value = |of: &[f64]| {
            let at = |i: usize, j: usize| {
                let (i, j) = (i.min(self.first.len() - 1), j.min(columns - 1));
                of.get(i * columns + j).copied().unwrap_or(0.0)
            };
            let row = |i: usize| {
                let (a, b) = (at(i, j), at(i, j + 1));
                a + t * (b - a)
            };
            let (a, b) = (row(i), row(i + 1));
            a + s * (b - a)
        };
        [value(&self.lower), value(&self.upper)]
    }
}

/// The interval of rising knots that holds a value or is nearest to it, and the part of it, which is beyond 0 or 1 outside.
fn between(knots: &[f64], x: f64) -> (usize, f64) {
    let last = knots.len().saturating_sub(2);
    let i = knots.iter().skip(1).take(last).take_while(|knot| **knot <= x).count();
    match (knots.get(i), knots.get(i + 1)) {
        (Some(a), Some(b)) => (i, (x - a) / (b - a)),
        _ => (0, 0.0),
    }
}

impl Shape {
    /// Turns about three axes; `beyond` in radians, 0 or more.
    ///
    /// ```
    /// use condyle_math::{Quat, Vec3};
    /// use condyle_model::limit::field::{Ends, Shape};
    /// let degrees = |ends: [f64; 2]| ends.map(f64::to_radians);
    /// let box_of = [degrees([-30.0, 60.0]), degrees([-20.0, 20.0]), degrees([-10.0, 40.0])];
    /// let shape = Shape::new(Vec3::UNITS, box_of[0], Ends::fixed(box_of[1]), Ends::fixed(box_of[2]), 0.0)?;
    /// assert!(shape.contains(Quat::from_axis_angle(Vec3::X, 59f64.to_radians())));
    /// assert!(!shape.contains(Quat::from_axis_angle(Vec3::X, 61f64.to_radians())));
    /// # Ok::<(), condyle_model::limit::field::ShapeError>(())
    /// ```
    ///
    /// # Errors
    /// If axes are not perpendicular to each other, ends cross or span more than a full turn, or the second turn goes
    /// farther than half a turn.
    pub fn new(
        axes: [Vec3; 3],
        first: [f64; 2],
        second: Ends,
        third: Ends,
        beyond: f64,
    ) -> Result<Self, ShapeError> {
        if !axes.iter().all(|axis| axis.norm() > 1e-9 && axis.norm().is_finite()) {
            return Err(wrong("an axis has no direction", "give three directions"));
        }
        let [a, b, c] = axes.map(Vec3::normalized);
        let off = [a.dot(b), b.dot(c), a.dot(c)].map(f64::abs);
        if off.iter().any(|cosine| *cosine > 1e-6) {
            let message = "the axes are not perpendicular to each other";
            return Err(wrong(message, "give three that are"));
        }
        if !(first[0] < first[1] && first[1] - first[0] <= TAU) {
            let message = "the ends of the first turn do not rise, or by more than a full turn";
            return Err(wrong(message, "give the lower and the upper end"));
        }
        if !(0.0..PI).contains(&beyond) {
            let message = "`beyond` is negative, or half a turn or more";
            return Err(wrong(message, "give an angle"));
        }
        let side = a.cross(b);
        let basis = Quat::from_mat3(condyle_math::Mat3::from_columns(a, b, side)).normalized();
        let hand = side.dot(c).signum();
        let axes = [a, b, c];
        let shape = Self { axes, first, second, third, beyond, basis, hand };
        // Ends are linear between knots along each angle, so what is right on a fine grid is right.
        for i in 0..=32 {
            let first = first[0] + (first[1] - first[0]) * f64::from(i) / 32.0;
            let [low, high] = shape.second.at(first, 0.0);
            if !(low <= high && -PI <= low && high <= PI) {
                let message = format!(
                    "at {:.0} degrees of the first turn the ends of the second are {:.0} and {:.0}",
                    first.to_degrees(),
                    low.to_degrees(),
                    high.to_degrees()
                );
                return Err(wrong(message, "they must rise and be within half a turn"));
            }
            for j in 0..=32 {
                let second = low + (high - low) * f64::from(j) / 32.0;
                let [low, high] = shape.third.at(first, second);
                if !(low <= high && high - low <= TAU) {
                    let message = format!(
                        "at {:.0} and {:.0} degrees of the turns before the ends of the third are {:.0} and {:.0}",
                        first.to_degrees(),
                        second.to_degrees(),
                        low.to_degrees(),
                        high.to_degrees()
                    );
                    return Err(wrong(message, "they must rise, by a full turn at most"));
                }
            }
        }
        Ok(shape)
    }

    /// The axes of the turns, of length 1.
    #[must_use]
    pub fn axes(&self) -> [Vec3; 3] {
        self.axes
    }

    /// The ends of the first turn.
    #[must_use]
    pub fn first(&self) -> [f64; 2] {
        self.first
    }

    /// The ends of the second turn.
    #[must_use]
    pub fn second(&self) -> &Ends {
        &self.second
    }

    /// The ends of the third turn.
    #[must_use]
    pub fn third(&self) -> &Ends {
        &self.third
    }

    /// How far beyond these ends a rotation may be, in radians.
    #[must_use]
    pub fn beyond(&self) -> f64 {
        self.beyond
    }

    /// The rotation of three angles.
    #[must_use]
    pub fn rotation(&self, angles: [f64; 3]) -> Quat {
        let [a, b, c] = self.axes;
        let [x, y, z] = angles;
        Quat::from_axis_angle(a, x) * Quat::from_axis_angle(b, y) * Quat::from_axis_angle(c, z)
    }

    /// Angles at parts from 0 to 1 of the way between the ends of each turn.
    #[must_use]
    pub fn angles_at(&self, parts: [f64; 3]) -> [f64; 3] {
        let part = |[low, high]: [f64; 2], t: f64| low + t * (high - low);
        let first = part(self.first, parts[0]);
        let second = part(self.second.at(first, 0.0), parts[1]);
        [first, second, part(self.third.at(first, second), parts[2])]
    }

    /// A rotation inside: in the middle between all ends.
    #[must_use]
    pub fn middle(&self) -> Quat {
        self.rotation(self.angles_at([0.5; 3]))
    }

    /// Both triples of angles that make a rotation: (φ₁, φ₂, φ₃) and (φ₁ + π, π - φ₂, φ₃ + π), each turn beginning at its
    /// lower end, so that one within its ends is not seen a full turn off.
    #[must_use]
    pub fn angles(&self, q: Quat) -> [[f64; 3]; 2] {
        let m = (self.basis.conjugate() * q * self.basis).to_mat3();
        let [x, y, z] = Vec3::UNITS.map(|axis| m * axis);
        let second = z.x.clamp(-1.0, 1.0).asin();
        let first = (-z.y).atan2(z.z);
        let third = (-y.x).atan2(x.x);
        // What is at a lower end but for rounding is not a full turn off.
        let from = |low: f64, angle: f64| low - 1e-12 + (angle - low + 1e-12).rem_euclid(TAU);
        [[first, second, third], [first + PI, PI - second, third + PI]].map(|[a, b, c]| {
            let first = from(self.first[0], a);
            let second = from(self.second.at(first, 0.0)[0], b);
            [first, second, from(self.third.at(first, second)[0], c * self.hand)]
        })
    }

    /// Whether a rotation is within the ends, those of `beyond` not counted.
    #[must_use]
    pub fn contains(&self, q: Quat) -> bool {
        self.angles(q).into_iter().any(|[first, second, third]| {
            first <= self.first[1]
                && second <= self.second.at(first, 0.0)[1]
                && third <= self.third.at(first, second)[1]
        })
    }
}
