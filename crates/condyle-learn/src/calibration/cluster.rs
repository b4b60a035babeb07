//! Markers that are rigid to a segment.

use condyle_math::{Affine, Quat, Vec3};
use condyle_motion::{Observed, Recording};
use condyle_solve::eigen;

/// The rigid transform that brings points nearest to where they are seen (least squares, Horn 1987), and the root mean square
/// of what is left, in metres. Points that are not seen do not count; `None` with fewer than three, or where those that
/// are seen lie on a line.
///
/// ```
/// use condyle_learn::calibration::placed;
/// use condyle_math::Vec3;
/// let rest = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// // A quarter turn about z, and a step along x; the fourth is not seen.
/// let seen = [Some(Vec3::X), Some(Vec3::new(1.0, 1.0, 0.0)), Some(Vec3::ZERO), None];
/// let (transform, rms) = placed(&rest, &seen).unwrap();
/// assert!((transform * Vec3::Z - Vec3::new(1.0, 0.0, 1.0)).norm() < 1e-15 && rms < 1e-15);
/// ```
#[must_use]
pub fn placed(points: &[Vec3], seen: &[Option<Vec3>]) -> Option<(Affine, f64)> {
    let pairs: Vec<(Vec3, Vec3)> =
        points.iter().zip(seen).filter_map(|(p, s)| Some((*p, (*s)?))).collect();
    if pairs.len() < 3 {
        return None;
    }
    let share = 1.0 / pairs.len() as f64;
    let mean = |side: fn(&(Vec3, Vec3)) -> Vec3| {
        pairs.iter().fold(Vec3::ZERO, |sum, pair| sum + side(pair)) * share
    };
    let (from, to) = (mean(|p| p.0), mean(|p| p.1));
    // S[i][j] = Σ pᵢ·sⱼ about the means.
    let mut s = [[0.0; 3]; 3];
    let mut size = 0.0;
    for (point, place) in &pairs {
        let (p, q) = ((*point - from).to_array(), (*place - to).to_array());
        for i in 0..3 {
            size += p[i] * p[i] + q[i] * q[i];
            for j in 0..3 {
                s[i][j] += p[i] * q[j];
            }
        }
    }
    let n = [
        s[0][0] + s[1][1] + s[2][2],
        s[1][2] - s[2][1],
        s[2][0] - s[0][2],
        s[0][1] - s[1][0],
        s[1][2] - s[2][1],
        s[0][0] - s[1][1] - s[2][2],
        s[0][1] + s[1][0],
        s[2][0] + s[0][2],
        s[2][0] - s[0][2],
        s[0][1] + s[1][0],
        s[1][1] - s[0][0] - s[2][2],
        s[1][2] + s[2][1],
        s[0][1] - s[1][0],
        s[2][0] + s[0][2],
        s[1][2] + s[2][1],
        s[2][2] - s[0][0] - s[1][1],
    ];
    let (values, vectors) = eigen::symmetric(&n, 4);
    let best = (0..4).max_by(|a, b| values[*a].total_cmp(&values[*b]))?;
    let second = (0..4).filter(|k| *k != best).map(|k| values[k]).fold(f64::MIN, f64::max);
    // On a line a turn about it changes nothing: two eigenvalues are equal.
    if values[best] - second <= 1e-9 * size {
        return None;
    }
    let q = [1, 2, 3, 0].map(|row: usize| vectors[row * 4 + best]);
    let turn = Affine::from_rotation(Quat::from(q).normalized().to_mat3());
    let transform = Affine::from_translation(to - turn * from) * turn;
    let left: f64 = pairs.iter().map(|(p, s)| (transform * *p - *s).norm_squared()).sum();
    Some((transform, (left * share).sqrt()))
}

/// Markers that are rigid to a segment, and where they are in it.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Cluster {
    /// Their labels.
    pub labels: Vec<String>,
    /// Their places, in metres.
    pub points: Vec<Vec3>,
}

impl Cluster {
    /// The markers of a standing trial at the mean of the frames that show them, in the laboratory's frame. Those that no
    /// frame shows are left out.
    #[must_use]
    pub fn standing(recording: &Recording, labels: &[&str]) -> Self {
        let mut cluster = Self::default();
        for label in labels {
            let Some(marker) = recording.marker(label) else { continue };
            let seen: Vec<Vec3> = (0..recording.frames())
                .filter_map(|frame| recording.position(frame, marker).map(Vec3::from))
                .collect();
            if seen.is_empty() {
                continue;
            }
            let sum = seen.iter().fold(Vec3::ZERO, |sum, p| sum + *p);
            cluster.labels.push((*label).to_owned());
            cluster.points.push(sum * (1.0 / seen.len() as f64));
        }
        cluster
    }

    /// The place of a marker.
    #[must_use]
    pub fn point(&self, label: &str) -> Option<Vec3> {
        self.labels.iter().position(|l| l == label).map(|k| self.points[k])
    }

    /// The same seen from another frame.
    #[must_use]
    pub fn within(&self, frame: Affine) -> Self {
        let inverse = frame.rigid_inverse();
        let points = self.points.iter().map(|point| inverse * *point).collect();
        Self { labels: self.labels.clone(), points }
    }

    /// Where the segment is in a frame of a recording, and the RMS of what is left at its markers; `None` with fewer than three of them.
    #[must_use]
    pub fn pose(&self, recording: &Recording, frame: usize) -> Option<(Affine, f64)> {
        let seen: Vec<Option<Vec3>> = self
            .labels
            .iter()
            .map(|label| recording.position(frame, recording.marker(label)?).map(Vec3::from))
            .collect();
        placed(&self.points, &seen)
    }

    /// Puts markers of the cluster that a recording does not show where the others say they are; those it never has become new
    /// labels. The result is how many positions were rebuilt.
    pub fn rebuild(&self, recording: &mut Recording) -> usize {
        for label in &self.labels {
            if recording.marker(label).is_none() {
                add(recording, label);
            }
        }
        let mut rebuilt = 0;
        for frame in 0..recording.frames() {
            let Some((pose, _)) = self.pose(recording, frame) else { continue };
            for (label, point) in self.labels.iter().zip(&self.points) {
                let Some(marker) = recording.marker(label) else { continue };
                if recording.position(frame, marker).is_none() {
                    let place = frame * recording.labels.len() + marker;
                    recording.positions[place] = Observed::from((pose * *point).to_array());
                    rebuilt += 1;
                }
            }
        }
        rebuilt
    }
}

/// A label that no frame shows.
fn add(recording: &mut Recording, label: &str) {
    let before = recording.labels.len();
    let widened = |width: usize| -> Vec<Option<usize>> {
        (0..recording.frames())
            .flat_map(|frame| (0..before).map(move |m| Some(frame * width + m)).chain([None]))
            .collect()
    };
    let places = widened(before);
    let positions = places
        .iter()
        .map(|place| place.map_or(Observed::MISSING, |place| recording.positions[place]));
    let positions = positions.collect();
    let confidences = recording
        .confidences
        .as_ref()
        .map(|given| places.iter().map(|place| place.map_or(1.0, |place| given[place])).collect());
    recording.positions = positions;
    recording.confidences = confidences;
    recording.labels.push(label.to_owned());
}
