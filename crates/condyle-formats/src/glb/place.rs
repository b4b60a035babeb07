//! The transform of a node that is nearest to an affine transform.

use super::scene::LocalPose;
use crate::skeleton::Place;
use condyle_math::Affine;

impl LocalPose {
    /// The node transform nearest to an affine transform, and the shear that it omits.
    ///
    /// The shear is |L - R·S| in the Frobenius norm, without unit: the error of a point of the node
    /// is at most that times its distance from the node's origin. It is 0 up to rounding if the
    /// transform is a rotation and scales along the node's axes. A reflection has three negative
    /// scales. For a singular transform the rotation is undetermined and omitted; scales and shear
    /// remain correct.
    ///
    /// ```
    /// use condyle_formats::glb::LocalPose;
    /// use condyle_math::{Affine, Mat3, Vec3};
    /// let stretch = Mat3::from_columns(Vec3::X * 2.0, Vec3::Y, Vec3::Z * 0.5);
    /// let turned = Mat3::rotation_z(0.3) * stretch;
    /// let (place, shear) = LocalPose::nearest(Affine::new(turned, Vec3::X));
    /// assert!((place.rotation[2] - 0.15f64.sin()).abs() < 1e-15);
    /// assert!((place.scale[0] - 2.0).abs() < 1e-15 && (place.scale[2] - 0.5).abs() < 1e-15);
    /// assert!(shear < 1e-15);
    /// ```
    pub fn nearest(local: Affine) -> (Self, f64) {
        let (place, shear) = Place::nearest(local);
        let own = Self {
            translation: place.translation.to_array(),
            rotation: place.rotation.to_array(),
            scale: place.scale.to_array(),
        };
        (own, shear)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_math::{Mat3, Quat, Vec3};

    fn difference(a: Mat3, b: Mat3) -> Mat3 {
        Mat3::from_columns(a.x - b.x, a.y - b.y, a.z - b.z)
    }

    fn norm(m: Mat3) -> f64 {
        (m.x.dot(m.x) + m.y.dot(m.y) + m.z.dot(m.z)).sqrt()
    }

    fn turned(place: &LocalPose) -> Mat3 {
        let [sx, sy, sz] = place.scale;
        let r = Quat::from(place.rotation).to_mat3();
        Mat3::from_columns(r.x * sx, r.y * sy, r.z * sz)
    }

    fn far(a: Mat3, b: Mat3) -> f64 {
        norm(difference(a, b))
    }

    #[test]
    fn sizes_along_the_axes_come_back_however_unequal() {
        let turn = Mat3::rotation_x(0.7) * Mat3::rotation_y(-1.2) * Mat3::rotation_z(2.9);
        for [x, y, z] in [[2.0, 1.0, 0.5], [1e-6, 1.0, 1e6], [3.0, 3.0, 3.0], [1e-3, 1e-3, 1e6]] {
            let sizes = Mat3::from_columns(Vec3::X * x, Vec3::Y * y, Vec3::Z * z);
            let (place, shear) = LocalPose::nearest(Affine::new(turn * sizes, Vec3::ZERO));
            let largest = x.max(y).max(z);
            for (found, expected) in place.scale.iter().zip([x, y, z]) {
                assert!((found - expected).abs() < 1e-14 * largest, "{:?}", place.scale);
            }
            let q = Quat::from(place.rotation);
            // The direction of the thinnest axis is known up to the rounding error of the longest.
            let thinnest = x.min(y).min(z);
            assert!(q.angle_to(Quat::from_mat3(turn)) < 1e-14 * largest / thinnest + 1e-7);
            assert!(shear < 1e-14 * largest);
        }
    }

    #[test]
    fn a_shear_has_the_closed_form_of_its_polar_decomposition() {
        // L = [[1, s], [0, 1]] in a plane: with tan φ = s/2 it is R(-φ)·P, and
        // P = R(φ)·L = [[cos φ, s cos φ - sin φ], [sin φ, s sin φ + cos φ]], whose off-diagonal
        // elements are both sin φ.
        let s = 0.3;
        let phi = f64::atan(s / 2.0);
        let linear = Mat3::from_columns(Vec3::X, Vec3::Y + Vec3::X * s, Vec3::Z);
        let (place, shear) = LocalPose::nearest(Affine::new(linear, Vec3::ZERO));
        assert!((place.rotation[2] + (phi / 2.0).sin()).abs() < 1e-15);
        let expected = [phi.cos(), s * phi.sin() + phi.cos(), 1.0];
        for (found, expected) in place.scale.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-15, "{:?}", place.scale);
        }
        assert!((shear - 2f64.sqrt() * phi.sin()).abs() < 1e-15);
        assert!((far(turned(&place), linear) - shear).abs() < 1e-15);
    }

    #[test]
    fn space_that_is_reversed_or_flattened() {
        let mirror = Mat3::from_columns(Vec3::X, Vec3::Y * 2.0, -Vec3::Z);
        let (place, shear) = LocalPose::nearest(Affine::new(mirror, Vec3::ZERO));
        assert!(far(turned(&place), mirror) < 1e-14 && shear < 1e-14);
        assert!(place.scale.iter().all(|s| *s < 0.0));
        let flat = Mat3::from_columns(Vec3::X, Vec3::Y * 2.0, Vec3::ZERO);
        let (place, shear) = LocalPose::nearest(Affine::new(flat, Vec3::ZERO));
        assert_eq!((place.scale, shear), ([1.0, 2.0, 0.0], 0.0));
    }

    #[test]
    fn a_rotation_stays_as_it_is() {
        let turn = Mat3::rotation_y(1.1) * Mat3::rotation_z(-0.4);
        let (place, shear) = LocalPose::nearest(Affine::new(turn, Vec3::Z));
        assert_eq!(place.rotation, Quat::from_mat3(turn).to_array());
        assert_eq!((place.translation, place.scale, shear), ([0.0, 0.0, 1.0], [1.0; 3], 0.0));
    }
}
