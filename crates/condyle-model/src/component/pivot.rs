//! Rotation about an axis with a moving instantaneous centre (Shao & Ng-Thow-Hing 2003, section
//! 4.4).
//!
//! The frame rotates about the axis a by α, and at every angle the instantaneous centre of rotation
//! is c(α), in the parent frame. So R = R(a, α), and the position t of the frame's origin satisfies
//!
//! ```text
//! dt/dα = a × (t - c(α)),   t(0) = 0
//! ```
//!
//! With one centre for each interval of angles ([`Centre::Intervals`]), t is rotated about the
//! centre of each interval in turn, from 0 outwards in both directions; t is continuous at the ends
//! of intervals, and the outermost centres apply beyond them. This equals the product of rotations
//! of the paper if the first interval begins at 0; otherwise angle 0 is still the identity.
//!
//! With a smooth path of the centre ([`Centre::Path`], a cubic spline of the angle) each piece has
//! a closed form: with A = [a]× and all vectors projected perpendicular to the axis,
//!
//! ```text
//! t = p(α) + R(a, α)·m,   p = c - A·c′ - c″ + A·c‴,   m = R(a, -α₀)·(t₀ - p(α₀))
//! ```
//!
//! where the piece begins at α₀ with t₀. The particular solution p is a cubic in α like c, and
//! c = p + A·p′ perpendicular to the axis. Intervals of width h approximate it with an error of
//! order h. Generator: the rotation (a, c × a) about the centre. Kinks: at the ends of intervals
//! the centre, and with it the derivative, is discontinuous.

use super::geometry::grow_path;
use super::{Contract, Geometry, Kind, Mirrored, MotionLaw, Port, PortType, Reflection};
use condyle_math::function::SimmSpline;
use condyle_math::{Affine, Growth, Lane, Mat3, Scalar, Vec3};

/// A hinge with a moving centre, like the knee.
#[derive(Clone, Debug, PartialEq)]
pub struct Pivot {
    axis: Vec3,
    centre: Centre,
    /// The upper ends of the pieces, increasing; the last piece has none.
    ends: Vec<f64>,
    pieces: Vec<Piece>,
}

/// An interval of angles on which the centre is a cubic: t = p(α) + R(a, α)·m.
#[derive(Clone, Debug, PartialEq)]
struct Piece {
    /// The angle about which the cubic is expanded, inside the interval.
    from: f64,
    /// The Taylor coefficients of p there: the k-th derivative over k!.
    particular: [Vec3; 4],
    /// m: the homogeneous solution, fixed by the position at the beginning of the interval.
    lag: Vec3,
}

/// The centre of a [`Pivot`] as a function of the angle.
#[derive(Clone, Debug, PartialEq)]
pub enum Centre {
    /// One centre for each interval: its upper end (radians) and the centre (metres).
    Intervals(Vec<(f64, Vec3)>),
    /// A smooth path: splines of the angle for x, y and z.
    Path(Box<[SimmSpline; 3]>),
}

/// Why arguments do not make a [`Pivot`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PivotError {
    /// The axis has no direction.
    Axis,
    /// There is no centre.
    NoCentre,
    /// The end of an interval is not above the previous one (position from 0).
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
    /// A pivot about an axis of any length except zero.
    ///
    /// # Errors
    /// [`PivotError`] for an axis of length 0, no centre, numbers that are not finite, or intervals
    /// that are not increasing.
    pub fn new(axis: Vec3, centre: Centre) -> Result<Self, PivotError> {
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
        let mut pivot = Self { axis: super::unit(axis), centre, ends: vec![], pieces: vec![] };
        // Integrate from 0 outwards: each piece begins with the position at the end of the previous
        // one. The side below 0 is processed with negated ends.
        let mut sides = [vec![], vec![]];
        for (side, sign) in sides.iter_mut().zip([-1.0, 1.0]) {
            let mut outer: Vec<f64> = ends.iter().map(|e| e * sign).filter(|e| *e > 0.0).collect();
            outer.sort_by(f64::total_cmp);
            let (mut begin, mut place) = (0.0, Vec3::ZERO);
            for end in outer.into_iter().chain([f64::INFINITY]) {
                // An angle strictly inside selects the piece of the centre without ties at its
                // ends.
                let inside = 0.5 * (begin + end.min(begin + 1.0));
                let piece = pivot.piece(sign * begin, sign * inside, place);
                place = pivot.place_on(&piece, sign * end.min(begin + 1e9)).0;
                side.push((sign * begin, piece));
                begin = end;
            }
        }
        let [below, above] = sides;
        for (begin, piece) in below.into_iter().rev() {
            pivot.ends.push(begin);
            pivot.pieces.push(piece);
        }
        for (begin, piece) in above {
            if begin > 0.0 {
                pivot.ends.push(begin);
            }
            pivot.pieces.push(piece);
        }
        Ok(pivot)
    }

    /// The axis, of length 1.
    pub fn axis(&self) -> Vec3 {
        self.axis
    }

    /// The centre as a function of the angle, as given.
    pub fn centre(&self) -> &Centre {
        &self.centre
    }

    /// The centre if it is given as a single point; otherwise `None`.
    pub fn fixed_centre(&self) -> Option<Vec3> {
        match &self.centre {
            Centre::Intervals(list) => match list[..] {
                [(_, centre)] => Some(centre),
                _ => None,
            },
            Centre::Path(_) => None,
        }
    }

    /// The piece that contains the angle `inside` and begins at the angle `begin` with the origin
    /// of the frame at `place`.
    fn piece(&self, begin: f64, inside: f64, place: Vec3) -> Piece {
        let [c, d1, d2, d3] = match &self.centre {
            Centre::Intervals(list) => {
                let index = list.partition_point(|(to, _)| *to < inside).min(list.len() - 1);
                [list[index].1, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO]
            }
            Centre::Path(splines) => {
                let [x, y, z] = [0, 1, 2].map(|i: usize| splines[i].derivatives(inside));
                [0, 1, 2, 3].map(|k: usize| Vec3::new(x[k], y[k], z[k]))
            }
        };
        let a = self.axis;
        let across = |v: Vec3| v - a * a.dot(v);
        // p = c - A·c′ - c″ + A·c‴ and its derivatives over k!, with A² = -1 perpendicular to the
        // axis.
        let particular = [
            across(c) - a.cross(d1) - across(d2) + a.cross(d3),
            across(d1) - a.cross(d2) - across(d3),
            (across(d2) - a.cross(d3)) * 0.5,
            across(d3) * (1.0 / 6.0),
        ];
        let mut piece = Piece { from: inside, particular, lag: Vec3::ZERO };
        let back = Mat3::rotation_about(a, (-begin).sin_cos());
        piece.lag = back * (place - piece.particular_at(begin).0);
        piece
    }

    /// The piece that contains an angle; at an end the one nearer to 0.
    #[inline]
    fn piece_at(&self, angle: f64) -> &Piece {
        let index = if angle < 0.0 {
            self.ends.partition_point(|&end| end <= angle)
        } else {
            self.ends.partition_point(|&end| end < angle)
        };
        &self.pieces[index.min(self.pieces.len() - 1)]
    }

    /// The position of the frame's origin at an angle of a piece, and its derivative.
    #[inline]
    fn place_on(&self, piece: &Piece, angle: f64) -> (Vec3, Vec3) {
        let turned = Mat3::rotation_about(self.axis, Scalar::sin_cos(angle)) * piece.lag;
        let (particular, slope) = piece.particular_at(angle);
        (particular + turned, slope + self.axis.cross(turned))
    }

    /// The instantaneous centre of rotation at an angle, in the parent frame: the given point on
    /// the instantaneous axis.
    pub fn centre_at(&self, angle: f64) -> Vec3 {
        match &self.centre {
            Centre::Path(splines) => {
                Vec3::from([0, 1, 2].map(|i: usize| splines[i].value_and_slope(angle).0))
            }
            Centre::Intervals(list) => {
                let reached = match angle < 0.0 {
                    true => list.partition_point(|(to, _)| *to <= angle),
                    false => list.partition_point(|(to, _)| *to < angle),
                };
                list[reached.min(list.len() - 1)].1
            }
        }
    }
}

impl Piece {
    /// p and p′ at an angle, by Horner's scheme.
    #[inline]
    fn particular_at(&self, angle: f64) -> (Vec3, Vec3) {
        let h = angle - self.from;
        let [p0, p1, p2, p3] = self.particular;
        let value = p0 + (p1 + (p2 + p3 * h) * h) * h;
        (value, p1 + (p2 * 2.0 + p3 * (3.0 * h)) * h)
    }
}

impl Pivot {
    pub(crate) const KIND: Kind =
        Kind { name: "pivot", ports: &[Port::one("angle", PortType::Scalar)] };
}

impl Contract for Pivot {
    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![]
    }

    fn grow(&mut self, joint: &Growth, _: &[Growth]) {
        self.change(self.axis, |centre| match centre {
            Centre::Intervals(list) => list.iter_mut().for_each(|(_, at)| *at = joint.point(*at)),
            Centre::Path(path) => grow_path(path, joint),
        });
    }

    fn mirror(&mut self, at: Reflection) -> Result<Mirrored, String> {
        self.change(at.turning(self.axis), |centre| match centre {
            Centre::Intervals(list) => list.iter_mut().for_each(|(_, c)| *c = at.point(*c)),
            Centre::Path(path) => at.path(path),
        });
        Ok(Mirrored::default())
    }
}

impl Pivot {
    /// Replaces the axis and changes the centre.
    fn change(&mut self, axis: Vec3, change: impl FnOnce(&mut Centre)) {
        let mut centre = self.centre.clone();
        change(&mut centre);
        if let Ok(pivot) = Self::new(axis, centre) {
            *self = pivot;
        }
    }
}

impl MotionLaw for Pivot {
    #[inline]
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        let angle = inputs[0];
        let rotation = Mat3::rotation_about(self.axis.cast(), angle.sin_cos());
        // Which piece holds the angle differs from lane to lane.
        let [px, py, pz, mx, my, mz] = S::lane_by_lane([angle], |[angle]| {
            let piece = self.piece_at(angle.value());
            let particular = |k: fn(Vec3) -> f64| {
                angle.chain(|x| {
                    let (value, slope) = piece.particular_at(x);
                    (k(value), k(slope))
                })
            };
            let lag: Vec3<S::Lane> = piece.lag.cast();
            [particular(|v| v.x), particular(|v| v.y), particular(|v| v.z), lag.x, lag.y, lag.z]
        });
        let (place, lag) = (Vec3::new(px, py, pz), Vec3::new(mx, my, mz));
        Affine::new(rotation, place + rotation * lag)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pivot(centre: Centre) -> Pivot {
        Pivot::new(Vec3::Z * 2.0, centre).unwrap()
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
            let place = |angle| pivot.transform(&[angle]).translation;
            let slope = (place(angle + h) - place(angle - h)) * (0.5 / h);
            let exact = pivot.axis().cross(place(angle) - pivot.centre_at(angle));
            assert!((slope - exact).norm() < 1e-8, "{angle}");
        }
    }

    #[test]
    fn what_cannot_pivot_is_refused() {
        let make = |axis, list| Pivot::new(axis, Centre::Intervals(list)).unwrap_err();
        assert_eq!(make(Vec3::ZERO, vec![(1.0, Vec3::X)]), PivotError::Axis);
        assert_eq!(make(Vec3::X, vec![]), PivotError::NoCentre);
        let crossed = vec![(1.0, Vec3::X), (1.0, Vec3::Y)];
        assert_eq!(make(Vec3::X, crossed), PivotError::NotIncreasing(1));
    }
}
