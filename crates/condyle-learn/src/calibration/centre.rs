//! Fixed points between two segments, and centres of spheres.

use condyle_diagnostics::Error;
use condyle_math::{Affine, Vec3};
use condyle_solve::regression::Regression;

/// A point that is fixed in a child and in its parent: Rᵢ·c + tᵢ = p in the least squares over all frames (Ehrig et al. 2006, the
/// symmetric centre of rotation estimation).
#[derive(Clone, Debug, PartialEq)]
pub struct Centre {
    /// p, in metres.
    pub in_parent: Vec3,
    /// c.
    pub in_child: Vec3,
    /// The root mean square distance of both, in metres.
    pub rms: f64,
    /// How well the motion determines it: beyond some hundreds it turns nearly about one axis, along which the centre is anywhere.
    pub condition: f64,
}

impl Centre {
    /// The centre of a motion of a child in a parent.
    ///
    /// # Errors
    /// `calibration/axis` where the child turns about one axis only, or not at all.
    ///
    /// ```
    /// use condyle_learn::calibration::Centre;
    /// use condyle_math::{Affine, Quat, Vec3};
    /// let (hip, head) = (Vec3::new(0.1, -0.2, 0.3), Vec3::new(0.0, 0.05, 0.0));
    /// let motion: Vec<Affine> = (0..30)
    ///     .map(|i| {
    ///         let t = 0.3 * f64::from(i);
    ///         let turn = Quat::exp(Vec3::new(0.5 * t.sin(), 0.3 * (1.3 * t).cos(), 0.2 * t)).to_mat3();
    ///         Affine::from_translation(hip) * Affine::from_rotation(turn) * Affine::from_translation(-head)
    ///     })
    ///     .collect();
    /// let centre = Centre::of(&motion)?;
    /// assert!((centre.in_parent - hip).norm() < 1e-12 && (centre.in_child - head).norm() < 1e-12);
    /// # Ok::<(), condyle_diagnostics::Error>(())
    /// ```
    pub fn of(child_in_parent: &[Affine]) -> Result<Self, Error> {
        let (mut design, mut known) = (vec![], vec![]);
        for motion in child_in_parent {
            let t = motion.translation.to_array();
            for row in 0..3 {
                design.extend((0..3).map(|column| motion.linear.at(row, column)));
                design.extend((0..3).map(|column| if row == column { -1.0 } else { 0.0 }));
                known.push(-t[row]);
            }
        }
        let fit = Regression::new(&design, 6, &[]);
        if fit.rank() < 6 {
            let message =
                "the segment turns about one axis only, along which the centre can be anywhere";
            return Err(Error::new("calibration/axis", message)
                .with_help("record a motion with turns about two axes, or fit an axis"));
        }
        let x = fit.solve(&known);
        let in_child = Vec3::new(x[0], x[1], x[2]);
        let in_parent = Vec3::new(x[3], x[4], x[5]);
        let off = child_in_parent.iter().map(|m| (*m * in_child - in_parent).norm_squared());
        let rms = (off.sum::<f64>() / child_in_parent.len() as f64).sqrt();
        Ok(Self { in_parent, in_child, rms, condition: fit.condition() })
    }
}

/// A sphere near points.
#[derive(Clone, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre, in metres.
    pub centre: Vec3,
    /// Its radius, in metres.
    pub radius: f64,
    /// The root mean square distance of the points from it.
    pub rms: f64,
}

/// The sphere of a marker that turns about a fixed centre: 2·c·p + (r² - |c|²) = |p|² in the least squares, about the mean of
/// the points; `None` where they lie in a plane.
///
/// ```
/// use condyle_learn::calibration::sphere;
/// use condyle_math::Vec3;
/// let centre = Vec3::new(1.0, 2.0, 3.0);
/// let points: Vec<Vec3> = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X].map(|d| centre + d * 0.4).to_vec();
/// let found = sphere(&points).unwrap();
/// assert!((found.centre - centre).norm() < 1e-14 && (found.radius - 0.4).abs() < 1e-14);
/// ```
#[must_use]
pub fn sphere(points: &[Vec3]) -> Option<Sphere> {
    let count = points.len() as f64;
    let mean = points.iter().fold(Vec3::ZERO, |sum, p| sum + *p) * (1.0 / count);
    let (mut design, mut known) = (vec![], vec![]);
    for point in points {
        let [x, y, z] = (*point - mean).to_array();
        design.extend([2.0 * x, 2.0 * y, 2.0 * z, 1.0]);
        known.push(x * x + y * y + z * z);
    }
    let fit = Regression::new(&design, 4, &[]);
    if fit.rank() < 4 {
        return None;
    }
    let x = fit.solve(&known);
    let centre = Vec3::new(x[0], x[1], x[2]);
    let radius = (x[3] + centre.norm_squared()).max(0.0).sqrt();
    let off = points.iter().map(|p| ((*p - mean - centre).norm() - radius).powi(2));
    let rms = (off.sum::<f64>() / count).sqrt();
    Some(Sphere { centre: centre + mean, radius, rms })
}
