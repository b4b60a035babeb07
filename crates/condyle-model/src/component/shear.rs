//! Shear of a segment: T = \[I + s·a·nᵀ | 0\] (Rotenberg, *Skeletons*, section 2.2.5).
//!
//! A point at distance d from the plane with the normal n moves by s·d along a. The two directions
//! are perpendicular, so the volume is preserved, the inverse is the shear by -s, and the inverse
//! transpose, which transforms normals, is I - s·n·aᵀ. Generator: a·nᵀ, which is not rigid. Kinks:
//! amounts are clamped to ±10⁶.

use super::{Contract, Fault, Geometry, Kind, Port, PortType};
use condyle_diagnostics::Severity;
use condyle_math::{Mat3, Scalar, Vec3};

/// A shear by one amount: the displacement per unit of distance from the plane, dimensionless; 0 is the
/// identity.
#[derive(Clone, Debug, PartialEq)]
pub struct Shear {
    /// The direction a of the displacement; it is normalised when the model is built.
    pub along: Vec3,
    /// The normal n of the plane, perpendicular to `along`; normalised as well.
    pub across: Vec3,
}

impl Shear {
    pub(crate) const KIND: Kind =
        Kind { name: "shear", ports: &[Port::one("amount", PortType::Scalar)] };
}

impl Contract for Shear {
    fn faults(&self) -> Vec<Fault> {
        if self.along.normalized().dot(self.across.normalized()).abs() <= 1e-6 {
            return vec![];
        }
        vec![Fault {
            severity: Severity::Error,
            code: "model/shear-axes",
            said: "has two directions that are not perpendicular".to_owned(),
            help: "layers slide at a right angle to the direction in which they are stacked",
        }]
    }

    fn deforms(&self) -> bool {
        true
    }

    fn geometry(&mut self) -> Vec<Geometry<'_>> {
        vec![
            Geometry::Direction("along", &mut self.along),
            Geometry::Direction("across", &mut self.across),
        ]
    }
}

/// The largest absolute amount; larger ones are clamped.
const MOST: f64 = 1e6;

/// I + s·a·nᵀ.
#[inline]
pub(crate) fn matrix<S: Scalar>(along: Vec3, across: Vec3, amount: S) -> Mat3<S> {
    let (a, n): (Vec3<S>, Vec3<S>) = (along.cast(), across.cast());
    let (least, most) = (S::from_f64(-MOST), S::from_f64(MOST));
    let amount = amount.select_less(least, least, amount);
    let amount = amount.select_less(most, amount, most);
    let column = |unit: Vec3, part: S| unit.cast::<S>() + a * (part * amount);
    Mat3::from_columns(column(Vec3::X, n.x), column(Vec3::Y, n.y), column(Vec3::Z, n.z))
}

/// a·nᵀ, the generator per unit of the amount.
pub(crate) fn rate(along: Vec3, across: Vec3, amount: f64) -> Mat3 {
    let along = if amount.abs() <= MOST { along } else { Vec3::ZERO };
    Mat3::from_columns(along * across.x, along * across.y, along * across.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_slide_by_their_distance() {
        // x increases with y: in the row-vector form of the source the amount is in the second row.
        let m = matrix(Vec3::X, Vec3::Y, 0.3);
        assert_eq!(m * Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.6, 2.0, 3.0));
        assert_eq!(matrix(Vec3::X, Vec3::Y, -0.3) * m, Mat3::IDENTITY);
        assert_eq!(m.determinant(), 1.0);
    }

    #[test]
    fn normals_go_with_the_inverse_transpose() {
        let (along, across) = (Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.8, 0.6, 0.0));
        let m = matrix(along, across, 0.7);
        let normals = matrix(across, along, -0.7);
        let (tangent, normal) = (Vec3::new(0.3, -0.5, 0.2), Vec3::new(0.5, 0.3, 0.0));
        assert_eq!(tangent.dot(normal), 0.0);
        assert!((m * tangent).dot(normals * normal).abs() < 1e-15);
    }
}
