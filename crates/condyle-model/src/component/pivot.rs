//! Rotation about one axis whose centre moves as it turns (Shao & Ng-Thow-Hing 2003, section 4.4).
//!
//! The frame turns about the axis a by α, and at every angle the centre of the motion is c(α), a
//! point fixed in the parent. So R = R(a, α), and the place t of the frame's origin obeys
//!
//! ```text
//! dt/dα = a × (t - c(α)),   t(0) = 0
//! ```
//!
//! With one centre for each interval of angles ([`Centre::Intervals`]), every interval turns t about
//! its own centre, from 0 outwards in both directions; the ends belong to both neighbours, and the
//! outermost centres go on. This equals the source's product of rotations where its first interval
//! begins at 0, and leaves angle 0 the identity where it does not.
//!
//! With a smooth path of the centre ([`Centre::Path`], a cubic spline of the angle) each piece has a
//! closed form: with A = [a]× and everything taken across the axis,
//!
//! ```text
//! t = p(α) + R(a, α - α₀)·(t₀ - p(α₀)),   p = c - A·c′ - c″ + A·c‴
//! ```
//!
//! Intervals of width h come as near to it as h. Generator: the rotation (a, c × a) about the centre.
//! Kinks: at the ends of intervals the centre jumps, and with it the second derivative.

use super::{Law, Source};
use condyle_math::function::SimmSpline;
use condyle_math::{Affine, Mat3, Scalar, Vec3};

/// A hinge whose centre moves, as a knee's does.
#[derive(Clone, Debug, PartialEq)]
pub struct Pivot {
    /// The angle in radians.
    pub angle: Source,
    axis: Vec3,
    centre: Centre,
    /// Where the pieces meet, outwards from 0, with t there: for angles above and below 0.
    above: Vec<(f64, Vec3)>,
    below: Vec<(f64, Vec3)>,
}

/// Where the centre of a [`Pivot`] is at each angle.
#[derive(Clone, Debug, PartialEq)]
pub enum Centre {
    /// One centre for each interval: it holds up to this angle (radians), and is this point.
    Intervals(Vec<(f64, Vec3)>),
    /// A smooth path: splines of the angle for x, y and z.
    Path(Box<[SimmSpline; 3]>),
}

/// What no pivot can be made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PivotError {
    /// The axis has no direction.
    Axis,
    /// There is no centre.
    NoCentre,
    /// The angle of an interval does not lie above the one before it (position from 0).
    NotIncreasing(usize),
    /// A number is not finite (position from 0).
    NotFinite(usize),
}

impl std::fmt::Display for PivotError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Axis => f.write_str("the axis has no direction: give one such as [0, 0, 1]"),
            Self::NoCentre => f.write_str("no centre is given: at least one is needed"),
            Self::NotIncreasing(i) => {
                write!(f, "interval {} does not end above the one before it", i + 1)
            }
            Self::NotFinite(i) => write!(f, "interval {} holds a number that is not finite", i + 1),
        }
    }
}

impl std::error::Error for PivotError {}

impl Pivot {
    /// A pivot about an axis of any length.
    ///
    /// # Errors
    /// [`PivotError`] for an axis of length 0, no centre, intervals out of order.
    pub fn new(angle: Source, axis: Vec3, centre: Centre) -> Result<Self, PivotError> {
        let length = axis.norm();
        if !(length.is_finite() && length > 1e-9) {
            return Err(PivotError::Axis);
        }
        let ends: Vec<f64> = match &centre {
            Centre::Path(splines) => {
                let mut knots: Vec<f64> =
                    splines.iter().flat_map(|s| s.knots().map(|(x, _)| x)).collect();
                knots.sort_by(f64::total_cmp);
                knots.dedup();
                knots
            }
            Centre::Intervals(list) => {
                let wrong = |(to, at): &(f64, Vec3)| to.is_nan() || !at.is_finite();
                if let Some(i) = list.iter().position(wrong) {
                    return Err(PivotError::NotFinite(i));
                }
                if let Some(i) = (1..list.len()).find(|&i| list[i].0 <= list[i - 1].0) {
                    return Err(PivotError::NotIncreasing(i));
                }
                match list.split_last() {
                    Some((_, inner)) => inner.iter().map(|(to, _)| *to).collect(),
                    None => return Err(PivotError::NoCentre),
                }
            }
        };
        let start = vec![(0.0, Vec3::ZERO)];
        let mut pivot =
            Self { angle, axis: axis.normalized(), centre, above: start.clone(), below: start };
        for &end in ends.iter().filter(|&&end| end > 0.0) {
            let place = pivot.place(end);
            pivot.above.push((end, place));
        }
        for &end in ends.iter().rev().filter(|&&end| end < 0.0) {
            let place = pivot.place(end);
            pivot.below.push((end, place));
        }
        Ok(pivot)
    }

    /// The axis, of length 1.
    pub fn axis(&self) -> Vec3 {
        self.axis
    }

    /// Where the centre is.
    pub fn centre(&self) -> &Centre {
        &self.centre
    }

    /// The piece that an angle falls into: where it begins, nearest to 0, and t there.
    fn piece(&self, angle: f64) -> (f64, Vec3) {
        let list = if angle < 0.0 { &self.below } else { &self.above };
        let reached = list.partition_point(|(begin, _)| begin.abs() < angle.abs());
        list[reached.saturating_sub(1)]
    }

    /// The centre on the piece that runs from `begin` to `angle`, with its derivatives there.
    fn centre_on(&self, begin: f64, angle: f64, at: f64) -> [Vec3; 4] {
        match &self.centre {
            Centre::Intervals(list) => {
                // The inside of the piece tells which interval it is.
                let inside = 0.5 * (begin + angle);
                let index = list.partition_point(|(to, _)| *to < inside).min(list.len() - 1);
                [list[index].1, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO]
            }
            Centre::Path(splines) => {
                // Derivatives of the piece's own cubic, also at its far end.
                let inside = 0.5 * (begin + angle);
                let [x, y, z] = [0, 1, 2].map(|i: usize| {
                    let [v, d1, d2, d3] = splines[i].derivatives(inside);
                    let h = at - inside;
                    [
                        v + h * (d1 + h * (d2 / 2.0 + h * d3 / 6.0)),
                        d1 + h * (d2 + h * d3 / 2.0),
                        d2 + h * d3,
                        d3,
                    ]
                });
                [0, 1, 2, 3].map(|k: usize| Vec3::new(x[k], y[k], z[k]))
            }
        }
    }

    /// Where the frame's origin is at an angle.
    fn place(&self, angle: f64) -> Vec3 {
        let (begin, start) = self.piece(angle);
        if angle == begin {
            return start;
        }
        let a = self.axis;
        let across = |v: Vec3| v - a * a.dot(v);
        let particular = |at: f64| {
            let [c, d1, d2, d3] = self.centre_on(begin, angle, at);
            across(c) - a.cross(d1) - across(d2) + a.cross(d3)
        };
        let turn = Mat3::rotation_about(a, (angle - begin).sin_cos());
        particular(angle) + turn * (start - particular(begin))
    }

    /// The instantaneous centre at an angle: the point of the parent that does not move.
    pub fn centre_at(&self, angle: f64) -> Vec3 {
        let (begin, _) = self.piece(angle);
        // On a piece of no length (at 0) look a little outwards.
        let end = if angle == begin { begin + 1e-9 } else { angle };
        self.centre_on(begin, end, angle)[0]
    }
}

impl Law for Pivot {
    #[inline]
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        let angle = inputs[0];
        let rotation = Mat3::rotation_about(self.axis.cast(), angle.sin_cos());
        let component = |pick: fn(Vec3) -> f64| {
            angle.chain(|x| {
                let place = self.place(x);
                (pick(place), pick(self.axis.cross(place - self.centre_at(x))))
            })
        };
        Affine::new(rotation, Vec3::new(component(|v| v.x), component(|v| v.y), component(|v| v.z)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::position::CoordinateId;

    fn pivot(centre: Centre) -> Pivot {
        Pivot::new(Source::Coordinate(CoordinateId(0)), Vec3::Z * 2.0, centre).unwrap()
    }

    fn about(centre: Vec3, degrees: f64) -> Affine {
        let turn = Affine::from_rotation(Mat3::rotation_z(degrees.to_radians()));
        Affine::from_translation(centre) * turn * Affine::from_translation(-centre)
    }

    fn off(a: Affine, b: Affine) -> f64 {
        a.to_rows().iter().zip(b.to_rows()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn seventy_degrees_are_fifty_about_the_first_centre_then_twenty_about_the_second() {
        // Shao & Ng-Thow-Hing 2003, figure 4: intervals [0, 50] and [50, 90].
        let (c1, c2) = (Vec3::new(0.1, 0.0, 0.3), Vec3::new(0.15, -0.05, 0.0));
        let ends = [50f64.to_radians(), 90f64.to_radians()];
        let pivot = pivot(Centre::Intervals(vec![(ends[0], c1), (ends[1], c2)]));
        let at = |degrees: f64| pivot.transform(&[degrees.to_radians()]);
        assert!(off(at(70.0), about(c2, 20.0) * about(c1, 50.0)) < 1e-15);
        assert!(off(at(50.0), about(c1, 50.0)) < 1e-15);
        // Beyond both ends the outermost centres go on.
        assert!(off(at(120.0), about(c2, 70.0) * about(c1, 50.0)) < 1e-15);
        assert!(off(at(-30.0), about(c1, -30.0)) < 1e-15);
        assert_eq!(at(0.0), Affine::IDENTITY);
    }

    #[test]
    fn angle_zero_is_the_identity_wherever_the_intervals_begin() {
        let centres = [(-60.0, 0.1), (-20.0, 0.2), (40.0, 0.3), (80.0, 0.4)]
            .map(|(to, x): (f64, f64)| (to.to_radians(), Vec3::new(x, 0.05, 0.0)));
        let pivot = pivot(Centre::Intervals(centres.to_vec()));
        let at = |degrees: f64| pivot.transform(&[degrees.to_radians()]);
        assert_eq!(at(0.0), Affine::IDENTITY);
        // 0 lies in the third interval; -70 goes back through it and the second into the first.
        let c = centres.map(|(_, c)| c);
        let expected = about(c[0], -10.0) * about(c[1], -40.0) * about(c[2], -20.0);
        assert!(off(at(-70.0), expected) < 1e-15);
    }

    #[test]
    fn intervals_converge_to_the_path_as_one_over_their_number() {
        let x = vec![-1.0, -0.2, 0.5, 1.2, 2.0];
        let spline = |y: [f64; 5]| SimmSpline::new(x.clone(), y.to_vec()).unwrap();
        let splines = [
            spline([0.02, 0.0, 0.01, 0.03, 0.02]),
            spline([-0.01, 0.01, 0.02, 0.0, -0.02]),
            spline([0.0, 0.02, 0.01, 0.0, 0.01]),
        ];
        let smooth = pivot(Centre::Path(Box::new(splines.clone())));
        let error = |n: usize| {
            let width = 3.0 / n as f64;
            let centres = (0..n).map(|i| {
                let to = -1.0 + width * (i + 1) as f64;
                // The centre at the inner end, so that the error is of first order.
                let at = if to <= 0.0 { to } else { to - width };
                (to, Vec3::from([0, 1, 2].map(|k: usize| splines[k].value_and_slope(at).0)))
            });
            let steps = pivot(Centre::Intervals(centres.collect()));
            off(steps.transform(&[1.7]), smooth.transform(&[1.7]))
        };
        let (coarse, fine) = (error(500), error(5000));
        assert!(fine < 1e-5, "{fine}");
        assert!((coarse / fine / 10.0 - 1.0).abs() < 0.05, "{coarse} {fine}");
    }

    #[test]
    fn the_path_obeys_its_differential_equation() {
        let x = vec![-1.0, 0.3, 1.0, 2.0];
        let spline = |y: [f64; 4]| SimmSpline::new(x.clone(), y.to_vec()).unwrap();
        let splines =
            [spline([0.0, 0.1, 0.3, 0.2]), spline([0.1, 0.0, -0.1, 0.1]), spline([0.0; 4])];
        let pivot = pivot(Centre::Path(Box::new(splines)));
        let h = 1e-6;
        for i in 0..60 {
            let angle = -1.7 + 0.0737 * f64::from(i);
            let slope = (pivot.place(angle + h) - pivot.place(angle - h)) * (0.5 / h);
            let exact = pivot.axis().cross(pivot.place(angle) - pivot.centre_at(angle));
            assert!((slope - exact).norm() < 1e-8, "{angle}");
        }
    }

    #[test]
    fn what_cannot_pivot_is_refused() {
        let source = Source::Coordinate(CoordinateId(0));
        let make = |axis, list| Pivot::new(source, axis, Centre::Intervals(list)).unwrap_err();
        assert_eq!(make(Vec3::ZERO, vec![(1.0, Vec3::X)]), PivotError::Axis);
        assert_eq!(make(Vec3::X, vec![]), PivotError::NoCentre);
        let crossed = vec![(1.0, Vec3::X), (1.0, Vec3::Y)];
        assert_eq!(make(Vec3::X, crossed), PivotError::NotIncreasing(1));
    }
}
