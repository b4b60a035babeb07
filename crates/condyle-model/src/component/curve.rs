//! Motion along a curve in space: T = \[R(u) | c(u)\] (Rotenberg, *Skeletons*, section 2.2.4).
//!
//! c is a cubic spline of the parameter u, which may be an angle, a distance, or a fraction. With a
//! [`Heading`] the segment also rotates with the curve, like a car on a track: its `forward` axis f
//! follows the tangent t = c′/|c′|, and its `up` axis stays as near as possible to its direction at
//! rest, in the plane of the tangent and that direction:
//!
//! ```text
//! n = (up - (up·t)·t) / |…|,   R = [t, n, t × n]·[f, u, f × u]ᵀ
//! ```
//!
//! with u the normalised component of `up` perpendicular to f. The position has no kinks. The
//! second derivative of the heading is discontinuous at the knots. The heading is undefined where
//! c′ = 0 or where the tangent is along `up`: there R is built on an arbitrary perpendicular
//! direction. `condyle check` finds such curves. Generator: by dual numbers.

use super::{Contract, Fault, Geometry, Kind, MotionLaw, Port, PortType};
use condyle_diagnostics::Severity;
use condyle_math::function::SimmSpline;
use condyle_math::{Affine, Lane, Mat3, Scalar, Vec3};

/// Motion of a segment along a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The curve: splines of the parameter for x, y and z, in metres.
    pub path: Box<[SimmSpline; 3]>,
    /// The axes that follow the curve; `None` for a pure translation.
    pub heading: Option<Heading>,
}

impl Curve {
    pub(crate) const KIND: Kind =
        Kind { name: "curve", ports: &[Port::one("parameter", PortType::Scalar)] };
}

impl Contract for Curve {
    fn faults(&self) -> Vec<Fault> {
        if self.least_heading() >= 1e-3 {
            return vec![];
        }
        vec![Fault {
            severity: Severity::Warning,
            code: "model/curve-heading",
            said: "has a curve with zero velocity or parallel to `up` somewhere, so that its heading is \
                   undefined there"
                .to_owned(),
            help: "give another `up`, or a curve whose points differ",
        }]
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        let mut parts = vec![Geometry::Path(&mut self.path)];
        if let Some(Heading { forward, up }) = &mut self.heading {
            parts.push(Geometry::Direction("forward", forward));
            parts.push(Geometry::Direction("up", up));
        }
        parts
    }
}

/// How a segment rotates with its curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heading {
    /// The segment's axis that follows the tangent.
    pub forward: Vec3,
    /// The up axis: the same direction in the segment at rest and in the parent.
    pub up: Vec3,
}

impl Curve {
    /// The smallest sine of the angle between tangent and `up`, |c′ × up|/(|c′||up|), over a dense
    /// sampling between the knots: 0 if the heading is undefined somewhere, 1 without a heading.
    pub fn least_heading(&self) -> f64 {
        let Some(heading) = self.heading else { return 1.0 };
        let mut knots: Vec<f64> =
            self.path.iter().flat_map(|s| s.knots().map(|(u, _)| u)).collect();
        knots.sort_by(f64::total_cmp);
        let up = heading.up.normalized();
        let mut least = 1.0f64;
        for piece in knots.windows(2) {
            for i in 0..=32 {
                let u = piece[0] + (piece[1] - piece[0]) * f64::from(i) / 32.0;
                let [x, y, z] = [0, 1, 2].map(|k: usize| self.path[k].derivatives(u)[1]);
                let tangent = Vec3::new(x, y, z);
                let length = tangent.norm();
                let sine =
                    if length > 1e-9 { (tangent * (1.0 / length)).cross(up).norm() } else { 0.0 };
                least = least.min(sine);
            }
        }
        least
    }
}

/// `v` normalised, or `instead` if its length is below 1e-12.
fn unit<S: Scalar>(v: Vec3<S>, instead: Vec3<S>) -> Vec3<S> {
    let square = v.dot(v);
    let (least, one) = (S::from_f64(1e-24), S::one());
    let safe = square.select_less(least, one, square).sqrt();
    let pick = |v: S, other: S| square.select_less(least, other, v / safe);
    Vec3::new(pick(v.x, instead.x), pick(v.y, instead.y), pick(v.z, instead.z))
}

/// A unit vector perpendicular to another vector.
fn across(v: Vec3) -> Vec3 {
    // The cross product with a coordinate axis that is far from parallel to v.
    let pick = if v.x.abs() < 0.6 * v.norm() { Vec3::X } else { Vec3::Y };
    v.cross(pick).normalized()
}

impl MotionLaw for Curve {
    fn transform<S: Scalar>(&self, inputs: &[S]) -> Affine<S> {
        // The derivative of an order of component k, with its own slope for the chain rule.
        let at = |k: usize, order: usize| {
            inputs[0].chain(|u| {
                let all = self.path[k].derivatives(u);
                (all[order], all[order + 1])
            })
        };
        let along = |k: usize| inputs[0].chain(|u| self.path[k].value_and_slope(u));
        let place = Vec3::new(along(0), along(1), along(2));
        let Some(Heading { forward, up }) = self.heading else {
            return Affine::from_translation(place);
        };
        let forward = forward.normalized();
        let own_up = unit(up - forward * up.dot(forward), across(forward));
        let rest = Mat3::from_columns(forward, own_up, forward.cross(own_up));
        let tangent = unit(Vec3::new(at(0, 1), at(1, 1), at(2, 1)), forward.cast());
        let up: Vec3<S> = up.normalized().cast();
        // Only the value: the arbitrary direction has no derivatives.
        let instead = S::lane_by_lane(tangent.to_array(), |tangent| {
            across(tangent.map(Lane::value).into()).cast().to_array()
        });
        let normal = unit(up - tangent * up.dot(tangent), instead.into());
        let frame = Mat3::from_columns(tangent, normal, tangent.cross(normal));
        Affine::new(frame * rest.transpose().cast(), place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circular arc of radius 2 in the ground plane, with dense knots.
    fn track(heading: Option<Heading>) -> Curve {
        let u: Vec<f64> = (0..=200).map(|i| f64::from(i) * 0.01).collect();
        let spline = |f: &dyn Fn(f64) -> f64| {
            SimmSpline::new(u.clone(), u.iter().map(|&u| f(u)).collect()).unwrap()
        };
        let path =
            [spline(&|u| 2.0 * u.sin()), spline(&|_| 0.0), spline(&|u| 2.0 * (u.cos() - 1.0))];
        Curve { path: Box::new(path), heading }
    }

    #[test]
    fn a_car_turns_with_its_track() {
        let heading = Heading { forward: Vec3::X, up: Vec3::Y };
        let curve = track(Some(heading));
        for u in [0.3, 0.9, 1.4] {
            // On a circle about y the tangent (cos u, 0, -sin u) is x rotated by u about y.
            let found = curve.transform(&[u]);
            let expected = Mat3::rotation_y(u);
            for i in 0..9 {
                let (row, column) = (i / 3, i % 3);
                let off = found.linear.at(row, column) - expected.at(row, column);
                assert!(off.abs() < 1e-6, "{u} {off}");
            }
            let place = Vec3::new(2.0 * u.sin(), 0.0, 2.0 * (u.cos() - 1.0));
            assert!((found.translation - place).norm() < 1e-8);
        }
        assert_eq!(track(None).transform(&[0.7]).linear, Mat3::IDENTITY);
        assert!((curve.least_heading() - 1.0).abs() < 1e-12);
        // With up along the track the heading is undefined at its start, but still a rotation.
        let steep = track(Some(Heading { forward: Vec3::X, up: Vec3::X }));
        assert!(steep.least_heading() < 1e-6);
        assert!(steep.transform(&[0.0]).linear.determinant() > 0.999);
    }
}
