//! A fixed axis between two segments.
//!
//! With Rᵢ, tᵢ the child in the parent in frame i, an axis that is fixed in both has directions a and b with Rᵢ·b = a: a and b are
//! the leading singular vectors of Σ Rᵢ. A point of it in both, perpendicular to them, solves the linear problem
//! (1 - a·aᵀ)·(Rᵢ·c + tᵢ - p) = 0. Angles are about a from the first frame on, and go on beyond half a turn from one frame to
//! the next; slides are along a. Nothing need be known of how the frames of the segments lie.

use condyle_math::{Affine, Vec3};
use condyle_solve::eigen;
use condyle_solve::regression::Regression;

/// An axis about which one segment turns in another and along which it slides.
#[derive(Clone, Debug, PartialEq)]
pub struct Screw {
    /// Its direction in the parent, of length 1, turned so that the largest component is positive.
    pub axis_in_parent: Vec3,
    /// The same in the child.
    pub axis_in_child: Vec3,
    /// The point of the axis that is nearest to the parent's origin, in metres.
    pub point_in_parent: Vec3,
    /// The point that is nearest to the child's origin.
    pub point_in_child: Vec3,
    /// The angle of each frame from the first one, in radians.
    pub angles: Vec<f64>,
    /// How far the child's point is along the axis from the parent's, in metres, frame by frame.
    pub slides: Vec<f64>,
    /// The root mean square distance of the child's point from the axis, in metres.
    pub rms: f64,
    /// The root mean square angle between the two directions, in radians.
    pub wobble: f64,
}

impl Screw {
    /// The axis of a motion of a child in a parent; `None` where it turns by less than a thousandth, or about several axes alike.
    ///
    /// ```
    /// use condyle_learn::calibration::Screw;
    /// use condyle_math::{Affine, Mat3, Vec3};
    /// // About z through (0, 0.1, 0), 3 mm along it for each radian.
    /// let motion: Vec<Affine> = (0..20)
    ///     .map(|i| {
    ///         let angle = 0.1 * f64::from(i);
    ///         let centre = Vec3::new(0.0, 0.1, 0.0);
    ///         Affine::from_translation(centre + Vec3::Z * (0.003 * angle))
    ///             * Affine::from_rotation(Mat3::rotation_z(angle))
    ///             * Affine::from_translation(-centre)
    ///     })
    ///     .collect();
    /// let screw = Screw::of(&motion).unwrap();
    /// assert!((screw.axis_in_parent - Vec3::Z).norm() < 1e-12);
    /// assert!((screw.point_in_parent - Vec3::new(0.0, 0.1, 0.0)).norm() < 1e-12);
    /// assert!((screw.slides[19] - screw.slides[0] - 0.003 * screw.angles[19]).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn of(child_in_parent: &[Affine]) -> Option<Self> {
        let count = child_in_parent.len() as f64;
        let mut sum = [[0.0; 3]; 3];
        for motion in child_in_parent {
            for (row, cells) in sum.iter_mut().enumerate() {
                for (column, cell) in cells.iter_mut().enumerate() {
                    *cell += motion.linear.at(row, column);
                }
            }
        }
        // MᵀM b = σ² b, and a = M b/σ.
        let gram: Vec<f64> =
            (0..9).map(|k| (0..3).map(|row| sum[row][k / 3] * sum[row][k % 3]).sum()).collect();
        let (values, vectors) = eigen::symmetric(&gram, 3);
        let best = (0..3).max_by(|i, j| values[*i].total_cmp(&values[*j]))?;
        let second = (0..3).filter(|k| *k != best).map(|k| values[k]).fold(0.0, f64::max);
        if values[best].is_nan() || values[best] - second <= 1e-6 * values[best] {
            return None;
        }
        let mut b = Vec3::from([0, 1, 2].map(|row: usize| vectors[row * 3 + best])).normalized();
        let rows = sum.map(Vec3::from);
        let mut a = Vec3::from(rows.map(|row| row.dot(b))).normalized();
        let largest =
            a.to_array().into_iter().fold(0.0f64, |m, x| if x.abs() > m.abs() { x } else { m });
        if largest < 0.0 {
            (a, b) = (-a, -b);
        }
        let across = perpendicular(b);
        let (f, g) = (across, b.cross(across));
        let first = child_in_parent.first()?.linear * f;
        let e = (first - a * a.dot(first)).normalized();
        let h = a.cross(e);
        // Unknown: c = c₁f + c₂g in the child, p = p₁e + p₂h in the parent.
        let (mut design, mut known) = (vec![], vec![]);
        for motion in child_in_parent {
            let [rf, rg] = [f, g].map(|v| motion.linear * v);
            for (along, unit) in [(e, [1.0, 0.0]), (h, [0.0, 1.0])] {
                design.extend([along.dot(rf), along.dot(rg), -unit[0], -unit[1]]);
                known.push(-along.dot(motion.translation));
            }
        }
        let fit = Regression::new(&design, 4, &[]);
        if fit.rank() < 4 {
            return None;
        }
        let x = fit.solve(&known);
        let (c, p) = (f * x[0] + g * x[1], e * x[2] + h * x[3]);
        let (mut angles, mut slides) = (vec![], vec![]);
        let (mut off, mut wobble) = (0.0, 0.0);
        for motion in child_in_parent {
            let turned = motion.linear * f;
            let angle = h.dot(turned).atan2(e.dot(turned));
            let last = angles.last().copied().unwrap_or(0.0);
            let turns = ((last - angle) / std::f64::consts::TAU).round();
            angles.push(angle + turns * std::f64::consts::TAU);
            let away = *motion * c - p;
            slides.push(a.dot(away));
            off += (away - a * a.dot(away)).norm_squared();
            wobble += (motion.linear * b - a).norm_squared();
        }
        Some(Self {
            axis_in_parent: a,
            axis_in_child: b,
            point_in_parent: p,
            point_in_child: c,
            angles,
            slides,
            rms: (off / count).sqrt(),
            wobble: (wobble / count).sqrt(),
        })
    }
}

/// A direction perpendicular to another.
fn perpendicular(axis: Vec3) -> Vec3 {
    let least = axis.to_array().map(f64::abs);
    let other = match least {
        [x, y, z] if x <= y && x <= z => Vec3::X,
        [_, y, z] if y <= z => Vec3::Y,
        _ => Vec3::Z,
    };
    axis.cross(other).normalized()
}
