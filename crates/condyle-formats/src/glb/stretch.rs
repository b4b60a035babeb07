//! An affine transform in two nodes.
//!
//! One node has sizes along its own axes only; of two, one in the other, the outer may be stretched along any axes of the inner,
//! which is every linear map.

use super::scene::LocalPose;
use condyle_math::{Affine, Mat3, Quat, Vec3};

/// The maximum number of sweeps; a few suffice.
const ROUNDS: usize = 40;

/// An affine transform in two nodes, the second in the first: exact whatever it is.
///
/// By the singular value decomposition L = U·Σ·Vᵀ the first is turned by U and has the sizes Σ, the second is turned by Vᵀ.
/// V is not unique where sizes are equal or exchanged; of all that are possible, the one near `axes` is taken, and becomes
/// `axes`, which start as the identity: along a motion the nodes turn quickly only where hardly anything is stretched, so that
/// what viewers show between two keys is near to what is between them.
///
/// ```
/// use condyle_formats::glb::in_two;
/// use condyle_math::{Affine, Mat3, Vec3};
/// // A shear of 0.3 of y along x: no single node has it.
/// let lean = Mat3::from_columns(Vec3::X, Vec3::Y + Vec3::X * 0.3, Vec3::Z);
/// let mut axes = Mat3::IDENTITY;
/// let (outer, inner) = in_two(Affine::new(lean, Vec3::Z), &mut axes);
/// assert_eq!(outer.translation, [0.0, 0.0, 1.0]);
/// // The sizes of a shear by s are s/2 + √(1 + s²/4) and its inverse.
/// let size = 0.15 + (1.0f64 + 0.15 * 0.15).sqrt();
/// let largest = outer.scale.iter().fold(0.0f64, |most, x| most.max(*x));
/// assert!((largest - size).abs() < 1e-12);
/// assert_eq!(inner.scale, [1.0; 3]);
/// ```
pub fn in_two(local: Affine, axes: &mut Mat3) -> (LocalPose, LocalPose) {
    let linear = local.linear;
    let square = linear.transpose() * linear;
    // As the axes of before see it, the square is nearly diagonal; rotations of at most an eighth of a turn make it so.
    let mut diagonal = axes.transpose() * square * *axes;
    for _ in 0..ROUNDS {
        let size = diagonal.x.x + diagonal.y.y + diagonal.z.z;
        let beside = [(0, 1), (0, 2), (1, 2)].map(|(p, q)| diagonal.at(p, q).abs());
        if !size.is_finite() || beside.iter().all(|x| *x <= 1e-17 * size) {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let turn = jacobi(&diagonal, p, q);
            diagonal = turn.transpose() * diagonal * turn;
            *axes = *axes * turn;
        }
    }
    let spread = linear * *axes;
    let mut columns = [spread.x, spread.y, spread.z];
    let mut sizes = columns.map(Vec3::norm);
    // The direction of the shortest axis is that which the others leave: it may be flattened, or reflected, which is its sign.
    let least = (0..3).min_by(|a, b| sizes[*a].total_cmp(&sizes[*b])).unwrap_or(0);
    let (a, b) = ((least + 1) % 3, (least + 2) % 3);
    let longer = if sizes[a] >= sizes[b] { (a, b) } else { (b, a) };
    let first = direction(columns[longer.0]).unwrap_or(Vec3::X);
    let second = columns[longer.1] - first * first.dot(columns[longer.1]);
    let second = direction(second).unwrap_or_else(|| across(first));
    (columns[longer.0], columns[longer.1]) = (first, second);
    let left = columns[a].cross(columns[b]);
    if columns[least].dot(left) < 0.0 {
        sizes[least] = -sizes[least];
    }
    columns[least] = left;
    let outer = Mat3::from_columns(columns[0], columns[1], columns[2]);
    let node = |rotation, translation, scale| LocalPose {
        translation,
        rotation: Quat::from_mat3(rotation).to_array(),
        scale,
    };
    (node(outer, local.translation.to_array(), sizes), node(axes.transpose(), [0.0; 3], [1.0; 3]))
}

/// The rotation in the plane of two axes after which a symmetric matrix has nothing at their place, by Jacobi: the smaller of
/// the two angles.
fn jacobi(matrix: &Mat3, p: usize, q: usize) -> Mat3 {
    let off = matrix.at(p, q);
    if off == 0.0 {
        return Mat3::IDENTITY;
    }
    let theta = (matrix.at(q, q) - matrix.at(p, p)) / (2.0 * off);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = (t * t + 1.0).sqrt().recip();
    // By columns.
    let mut turn = Vec3::UNITS.map(Vec3::to_array);
    (turn[p][p], turn[q][q], turn[q][p], turn[p][q]) = (c, c, t * c, -t * c);
    let [x, y, z] = turn.map(Vec3::from);
    Mat3::from_columns(x, y, z)
}

fn direction(v: Vec3) -> Option<Vec3> {
    let length = v.norm();
    (length > 1e-12).then(|| v * length.recip())
}

/// Some direction at a right angle.
fn across(v: Vec3) -> Vec3 {
    let other = if v.x.abs() < 0.6 { Vec3::X } else { Vec3::Y };
    v.cross(other).normalized()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(place: &LocalPose) -> Mat3 {
        let [sx, sy, sz] = place.scale;
        let r = Quat::from(place.rotation).to_mat3();
        Mat3::from_columns(r.x * sx, r.y * sy, r.z * sz)
    }

    fn far(a: Mat3, b: Mat3) -> f64 {
        [a.x - b.x, a.y - b.y, a.z - b.z].iter().map(|v| v.norm()).sum()
    }

    #[test]
    fn two_nodes_hold_every_transform_and_show_little_else_between_keys() {
        let mut axes = Mat3::IDENTITY;
        let at = |t: f64| {
            // Without shear at t = 1.57 and 3.14, and with sizes that pass each other.
            let lean = Mat3::from_columns(
                Vec3::X * (1.0 + 0.3 * t.sin()),
                Vec3::Y + Vec3::X * (0.5 * (2.0 * t).sin()),
                Vec3::Z * (1.0 + 0.2 * t.cos()) + Vec3::Y * 0.1,
            );
            Mat3::rotation_x(t) * lean
        };
        let half = |a: [f64; 4], b: [f64; 4]| {
            let (a, b) = (Quat::from(a), Quat::from(b));
            let b = if a.dot(b) < 0.0 { -b } else { b };
            let sum = [a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w];
            Quat::from(sum).normalized().to_array()
        };
        let between = |a: &LocalPose, b: &LocalPose| LocalPose {
            rotation: half(a.rotation, b.rotation),
            scale: std::array::from_fn(|i| 0.5 * (a.scale[i] + b.scale[i])),
            ..*a
        };
        let mut last: Option<(LocalPose, LocalPose)> = None;
        for step in 0..400 {
            let t = f64::from(step) * 0.01;
            let (outer, inner) = in_two(Affine::new(at(t), Vec3::X * t), &mut axes);
            assert!(far(turned(&outer) * turned(&inner), at(t)) < 1e-13, "{t}");
            if let Some((a, b)) = last {
                let shown = turned(&between(&a, &outer)) * turned(&between(&b, &inner));
                assert!(far(shown, at(t - 0.005)) < 0.02, "{t}");
            }
            last = Some((outer, inner));
        }
        for linear in [
            Mat3::from_columns(Vec3::X, Vec3::Y * 2.0 + Vec3::X, -Vec3::Z),
            Mat3::from_columns(Vec3::X, Vec3::Y * 2.0 + Vec3::X, Vec3::ZERO),
            Mat3::from_columns(Vec3::X, Vec3::X, Vec3::X),
            Mat3::from_columns(Vec3::ZERO, Vec3::ZERO, Vec3::ZERO),
        ] {
            let (outer, inner) =
                in_two(Affine::new(linear, Vec3::ZERO), &mut Mat3::IDENTITY.clone());
            assert!(far(turned(&outer) * turned(&inner), linear) < 1e-12, "{linear:?}");
        }
    }
}
