//! Rotations that were taken: gathered from recordings, thinned, with a weight against uneven density.

use super::principal::principal;
use super::spread::Spread;
use condyle_diagnostics::{Diagnostic, Error};
use condyle_math::{Quat, Vec3};

/// The least angle between two rotations of a cloud, unless another is asked for: 2 degrees.
pub const SPACING: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// Unit quaternions of a child in a reference segment: no two nearer than a spacing, all with the sign nearer
/// to the reference rotation.
///
/// Frames of a recording lie along a curve, far denser than people's rotations are known; so a rotation is kept
/// only if none within the spacing was kept before. Each keeps the number of its take.
///
/// ```
/// use condyle_learn::limits::Cloud;
/// use condyle_math::{Quat, Vec3};
/// // A turn about x by a degree a frame, back and forth: kept is one frame in two, once.
/// let take: Vec<Quat> = (0..60).chain((0..60).rev())
///     .map(|i| Quat::from_axis_angle(Vec3::X, f64::from(i).to_radians()))
///     .collect();
/// let cloud = Cloud::gather(&[&take], 1.99f64.to_radians())?;
/// assert_eq!(cloud.rotations().len(), 30);
/// assert_eq!(cloud.gathered().near, 90);
/// // The reference is in the middle of 0, 2, … 58 degrees.
/// assert!((cloud.reference().log().x - 29f64.to_radians()).abs() < 1e-9);
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Cloud {
    rotations: Vec<Quat>,
    takes: Vec<u32>,
    weights: Vec<f64>,
    reference: Quat,
    spacing: f64,
    gathered: Gathered,
}

/// What became of the rotations that were given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gathered {
    /// How many were given.
    pub given: usize,
    /// How many of them have a component that is not finite, or are no rotations: the length is 0.
    pub unusable: usize,
    /// How many were left out because another within the spacing was kept.
    pub near: usize,
}

impl Gathered {
    /// What a person should know about it.
    #[must_use]
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let mut warnings = vec![];
        if self.unusable > 0 {
            let message = format!(
                "{} of {} rotations are left out: not finite, or of length 0",
                self.unusable, self.given
            );
            warnings.push(Diagnostic::warning("cloud/unusable", message));
        }
        warnings
    }
}

impl Cloud {
    /// The rotations of several takes, thinned to a spacing in radians; 0 keeps all that differ.
    ///
    /// # Errors
    /// `cloud/empty` if no rotation is left, `cloud/spacing` if the spacing is negative or not finite,
    /// `cloud/size` if there are more than 2³² rotations.
    pub fn gather(takes: &[&[Quat]], spacing: f64) -> Result<Self, Error> {
        if !(0.0..=1.0).contains(&spacing) {
            let message = format!("a spacing of {spacing} rad is not between 0 and 1 rad");
            return Err(Error::new("cloud/spacing", message));
        }
        let mut gathered = Gathered::default();
        let (mut rotations, mut of): (Vec<Quat>, Vec<u32>) = (vec![], vec![]);
        let least = spacing.max(1e-9);
        let mut spread = Spread::new(least);
        // cos(θ/2) of the spacing: above it two rotations are too near. An angle this small is told by
        // the chord, 2 sin(θ/4), which keeps its digits.
        let chord = 2.0 * (least / 4.0).sin();
        for (take, given) in takes.iter().enumerate() {
            let take = u32::try_from(take).map_err(|_| too_many())?;
            for &q in *given {
                gathered.given += 1;
                let norm = q.dot(q).sqrt();
                if !norm.is_finite() || norm < 1e-9 {
                    gathered.unusable += 1;
                    continue;
                }
                let q = q.normalized();
                let mut near = false;
                spread.visit(q, |index| {
                    near = rotations.get(index as usize).is_some_and(|&p| chord_to(p, q) < chord);
                    near
                });
                if near {
                    gathered.near += 1;
                    continue;
                }
                spread.insert(q, u32::try_from(rotations.len()).map_err(|_| too_many())?);
                rotations.push(q);
                of.push(take);
            }
        }
        if rotations.is_empty() {
            let message = if gathered.given == 0 {
                "there are no rotations".to_owned()
            } else {
                format!("none of {} rotations is finite and of a length above 0", gathered.given)
            };
            return Err(Error::new("cloud/empty", message)
                .with_help("give recordings with at least one rotation, qx,qy,qz,qw"));
        }
        let weights = weights(&rotations);
        let reference = mean(&rotations, &weights);
        for q in &mut rotations {
            if q.dot(reference) < 0.0 {
                *q = -*q;
            }
        }
        Ok(Self { rotations, takes: of, weights, reference, spacing, gathered })
    }

    /// The rotations, each of length 1, with the sign nearer to the reference.
    #[must_use]
    pub fn rotations(&self) -> &[Quat] {
        &self.rotations
    }

    /// The take that each rotation is from, counted from 0.
    #[must_use]
    pub fn takes(&self) -> &[u32] {
        &self.takes
    }

    /// A weight for each rotation, 1 on average: small where rotations are dense.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The mean of the rotations on SO(3), by their weights, those that are far counted less.
    #[must_use]
    pub fn reference(&self) -> Quat {
        self.reference
    }

    /// The least angle between two rotations, in radians.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// What became of the rotations that were given.
    #[must_use]
    pub fn gathered(&self) -> Gathered {
        self.gathered
    }
}

fn too_many() -> Error {
    Error::new("cloud/size", "there are more than 4294967295 rotations")
}

/// |p - q| for the nearer sign.
fn chord_to(p: Quat, q: Quat) -> f64 {
    let (p, q) = (p.to_array(), q.to_array());
    let (mut minus, mut plus) = (0.0, 0.0);
    for (a, b) in p.into_iter().zip(q) {
        minus += (a - b) * (a - b);
        plus += (a + b) * (a + b);
    }
    f64::min(minus, plus).sqrt()
}

/// The typical distance to the eighth neighbour over what it is in a lattice: an estimate of
/// (volume / number)^(1/3), in radians, from up to 200 of the rotations.
pub(super) fn typical_spacing(rotations: &[Quat]) -> f64 {
    const NEIGHBOURS: usize = 8;
    let step = rotations.len().div_ceil(200).max(1);
    let mut typical: Vec<f64> = rotations
        .iter()
        .step_by(step)
        .map(|q| {
            let mut nearest = [f64::NEG_INFINITY; NEIGHBOURS + 1];
            for p in rotations {
                let mut dot = q.dot(*p).abs();
                for kept in &mut nearest {
                    if dot > *kept {
                        std::mem::swap(kept, &mut dot);
                    }
                }
            }
            let found = nearest.iter().filter(|dot| dot.is_finite()).count();
            let far = nearest[found.max(1) - 1].min(1.0);
            // A ball of radius r that holds n rotations: 4π r³/3 = n spacing³.
            let volume = 4.0 / 3.0 * std::f64::consts::PI;
            2.0 * far.acos() * (volume / (found.max(2) - 1) as f64).cbrt()
        })
        .collect();
    typical.sort_by(f64::total_cmp);
    typical.get(typical.len() / 2).copied().unwrap_or(0.0).max(1e-4)
}

/// How many rotations, itself among them, are within a radius of each.
pub(super) fn counts(rotations: &[Quat], radius: f64) -> Vec<u32> {
    let mut spread = Spread::new(radius);
    for (index, &q) in (0..).zip(rotations) {
        spread.insert(q, index);
    }
    let chord = 2.0 * (radius / 4.0).sin();
    // Cells that are seen under both signs are seen once where the signs are far apart: 2 visits of
    // one rotation need a cell that is its own mirror image, and there are none.
    let near = |q: Quat| {
        let mut count = 0;
        spread.visit(q, |index| {
            let near = rotations.get(index as usize).is_some_and(|&p| chord_to(p, q) <= chord);
            count += u32::from(near);
            false
        });
        count.max(1)
    };
    rotations.iter().map(|&q| near(q)).collect()
}

fn weights(rotations: &[Quat]) -> Vec<f64> {
    let counts = counts(rotations, 2.0 * typical_spacing(rotations));
    let mut weights: Vec<f64> = counts.into_iter().map(|count| 1.0 / f64::from(count)).collect();
    let mean = weights.iter().sum::<f64>() / weights.len() as f64;
    weights.iter_mut().for_each(|weight| *weight /= mean);
    weights
}

/// From the first axis of Σ w q qᵀ, the weighted mean of logarithms until it is 0, with Huber's weights
/// beyond twice the median distance.
fn mean(rotations: &[Quat], weights: &[f64]) -> Quat {
    let mut moments = [[0.0; 4]; 4];
    for (q, weight) in rotations.iter().zip(weights) {
        let q = q.to_array();
        for i in 0..4 {
            for j in 0..4 {
                moments[i][j] += weight * q[i] * q[j];
            }
        }
    }
    let (_, axes) = principal(moments);
    let mut mean = Quat::from(axes[0]).normalized();
    let mut distances: Vec<f64> = rotations.iter().map(|q| mean.angle_to(*q)).collect();
    let middle = distances.len() / 2;
    distances.select_nth_unstable_by(middle, f64::total_cmp);
    let far = 2.0 * distances[middle];
    for _ in 0..50 {
        let (mut sum, mut total) = (Vec3::ZERO, 0.0);
        for (q, weight) in rotations.iter().zip(weights) {
            let to = (mean.conjugate() * *q).log();
            let weight = weight * if to.norm() > far { far / to.norm() } else { 1.0 };
            sum += to * weight;
            total += weight;
        }
        let step = sum * (1.0 / total);
        mean = (mean * Quat::exp(step)).normalized();
        if step.norm() < 1e-12 {
            break;
        }
    }
    if mean.w < 0.0 { -mean } else { mean }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_lengths_and_faults_do_not_matter() {
        let turn = |degrees: f64| Quat::from_axis_angle(Vec3::Z, degrees.to_radians());
        let double = |q: Quat| Quat::from(q.to_array().map(|c| -2.0 * c));
        let plain = [turn(0.0), turn(10.0), turn(20.0)];
        let odd = [double(turn(0.0)), turn(10.0), double(turn(20.0)), turn(10.0)];
        let broken = [Quat::from([f64::NAN; 4]), Quat::from([0.0; 4])];
        let one = Cloud::gather(&[&plain], SPACING).unwrap();
        let two = Cloud::gather(&[&odd, &broken], SPACING).unwrap();
        assert_eq!(two.gathered(), Gathered { given: 6, unusable: 2, near: 1 });
        for (a, b) in one.rotations().iter().zip(two.rotations()) {
            assert!(a.dot(*b) > 1.0 - 1e-15);
        }
        // By hand: the mean of 0, 10 and 20 degrees about one axis.
        assert!(one.reference().angle_to(turn(10.0)) < 1e-9);
    }

    #[test]
    fn half_turns_that_differ_in_sign_alone_are_one() {
        // 179.5 and 180.5 degrees about one axis are a degree apart, with quaternions nearly opposite.
        let take = [179.5f64, 180.5, 183.0]
            .map(|degrees| Quat::from_axis_angle(Vec3::Y, degrees.to_radians()))
            .map(|q| if q.w < 0.0 { -q } else { q });
        let cloud = Cloud::gather(&[&take], SPACING).unwrap();
        assert_eq!(cloud.rotations().len(), 2);
        assert!(cloud.rotations()[0].dot(cloud.rotations()[1]) > 0.9);
    }

    #[test]
    fn dense_parts_weigh_less() {
        // 100 rotations within 2 degrees and 100 from 40 to 60 degrees: with weights the mean is beyond
        // that of the frames.
        let turn = |degrees: f64| Quat::from_axis_angle(Vec3::X, degrees.to_radians());
        let take: Vec<Quat> = (0..100)
            .map(|i| turn(0.02 * f64::from(i)))
            .chain((0..100).map(|i| turn(40.0 + 0.2 * f64::from(i))))
            .collect();
        let cloud = Cloud::gather(&[&take], 0.0).unwrap();
        assert_eq!(cloud.rotations().len(), 200);
        assert!(cloud.reference().log().x.to_degrees() > 26.0);
    }

    #[test]
    fn nothing_gives_an_error() {
        assert_eq!(Cloud::gather(&[], SPACING).unwrap_err().code(), "cloud/empty");
        let zero: &[Quat] = &[Quat::from([0.0; 4])];
        assert_eq!(Cloud::gather(&[zero], SPACING).unwrap_err().code(), "cloud/empty");
        assert_eq!(Cloud::gather(&[zero], f64::NAN).unwrap_err().code(), "cloud/spacing");
    }
}
