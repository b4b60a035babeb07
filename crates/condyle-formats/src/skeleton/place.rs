//! The place of a node or bone that is nearest to an affine transform.
//!
//! A node is placed by a translation T, a rotation R and a scale S along each of its own
//! axes, as T·R·S. Of a linear map L the polar decomposition L = Q·P gives the rotation Q that is
//! nearest to it and a symmetric stretch P (Higham 1986, *Computing the polar decomposition*). R is
//! Q and S the diagonal of P, which is exact where L stretches along the node's axes alone. What
//! is off the diagonal is a shear, which a node cannot hold.

use condyle_math::{Affine, Mat3, Quat, Vec3};

/// The maximum number of iterations for the rotation; about ten suffice.
const ROUNDS: usize = 40;

/// A translation, a rotation and three scales: T·R·S.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// In metres.
    pub translation: Vec3,
    /// Of length 1.
    pub rotation: Quat,
    /// Along each of its own axes.
    pub scale: Vec3,
}

impl Place {
    /// The place nearest to an affine transform, and the shear that it omits.
    ///
    /// The shear is |L - R·S| in the Frobenius norm, without unit: the error of a point is at most that
    /// times its distance from the origin of the place. It is 0 up to rounding if the transform is a
    /// rotation and scales along the axes. A reflection has three negative scales. For a singular transform
    /// the rotation is undetermined and omitted; scales and shear remain correct.
    ///
    /// ```
    /// use condyle_formats::skeleton::Place;
    /// use condyle_math::{Affine, Mat3, Vec3};
    /// let stretch = Mat3::from_columns(Vec3::X * 2.0, Vec3::Y, Vec3::Z * 0.5);
    /// let turned = Mat3::rotation_z(0.3) * stretch;
    /// let (place, shear) = Place::nearest(Affine::new(turned, Vec3::X));
    /// assert!((place.rotation.z - 0.15f64.sin()).abs() < 1e-15);
    /// assert!((place.scale.x - 2.0).abs() < 1e-15 && shear < 1e-15);
    /// ```
    #[must_use]
    pub fn nearest(local: Affine) -> (Self, f64) {
        let Affine { linear, translation } = local;
        let square = linear.transpose() * linear;
        if norm(difference(square, Mat3::IDENTITY)) < 1e-12 && linear.determinant() > 0.0 {
            let rotation = Quat::from_mat3(linear);
            return (Self { translation, rotation, scale: Vec3::new(1.0, 1.0, 1.0) }, 0.0);
        }
        let turn = rotation_of(linear);
        let stretch = turn.transpose() * linear;
        let scale = Vec3::new(stretch.x.x, stretch.y.y, stretch.z.z);
        let held = Mat3::from_columns(turn.x * scale.x, turn.y * scale.y, turn.z * scale.z);
        let shear = norm(difference(linear, held));
        (Self { translation, rotation: Quat::from_mat3(turn), scale }, shear)
    }

    /// The rotation nearest to a linear map, and how far the map is from it in the Frobenius norm: 0 for a
    /// rotation.
    #[must_use]
    pub fn turn(linear: Mat3) -> (Mat3, f64) {
        let square = linear.transpose() * linear;
        if norm(difference(square, Mat3::IDENTITY)) < 1e-12 && linear.determinant() > 0.0 {
            return (linear, 0.0);
        }
        let turn = rotation_of(linear);
        (turn, norm(difference(linear, turn)))
    }
}

/// The rotation of a linear map by Newton's iteration X ← (g·X + (g·X)⁻ᵀ)/2 with Higham's factor g;
/// for a reflection that of its negative, for a singular map the identity.
fn rotation_of(linear: Mat3) -> Mat3 {
    let mut x = linear;
    for _ in 0..ROUNDS {
        let other = x.inverse().transpose();
        let factor = (norm(other) / norm(x)).sqrt();
        if !factor.is_normal() {
            return Mat3::IDENTITY;
        }
        let mean = |a: Vec3, b: Vec3| (a * factor + b * (1.0 / factor)) * 0.5;
        let next = Mat3::from_columns(mean(x.x, other.x), mean(x.y, other.y), mean(x.z, other.z));
        let step = norm(difference(next, x));
        x = next;
        if step < 1e-14 {
            break;
        }
    }
    if x.determinant() < 0.0 { Mat3::from_columns(-x.x, -x.y, -x.z) } else { x }
}

fn difference(a: Mat3, b: Mat3) -> Mat3 {
    Mat3::from_columns(a.x - b.x, a.y - b.y, a.z - b.z)
}

fn norm(m: Mat3) -> f64 {
    (m.x.dot(m.x) + m.y.dot(m.y) + m.z.dot(m.z)).sqrt()
}
