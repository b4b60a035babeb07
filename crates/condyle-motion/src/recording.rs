//! Marker recordings, independent of file formats.

use crate::LengthUnit;

/// The observed position of a marker in one frame, in metres, or missing: 24 bytes.
///
/// ```
/// use condyle_motion::Observed;
/// assert_eq!(Observed::from([0.0, 1.0, 0.1]).position(), Some([0.0, 1.0, 0.1]));
/// assert_eq!(Observed::MISSING.position(), None);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Observed([f64; 3]);

impl Observed {
    /// Not seen.
    pub const MISSING: Self = Self([f64::NAN; 3]);

    /// The position; `None` where the marker was not seen.
    #[must_use]
    #[inline]
    pub fn position(self) -> Option<[f64; 3]> {
        // A missing marker is stored as NaN, so that the option takes no extra bytes.
        (!self.0[0].is_nan()).then_some(self.0)
    }

    /// The position, to be changed in place; `None` where the marker was not seen.
    pub fn position_mut(&mut self) -> Option<&mut [f64; 3]> {
        (!self.0[0].is_nan()).then_some(&mut self.0)
    }
}

/// A position with a part that is not a number counts as missing.
impl From<[f64; 3]> for Observed {
    #[inline]
    fn from(position: [f64; 3]) -> Self {
        let [x, y, z] = position;
        if x.is_nan() | y.is_nan() | z.is_nan() { Self::MISSING } else { Self(position) }
    }
}

impl From<Option<[f64; 3]>> for Observed {
    fn from(position: Option<[f64; 3]>) -> Self {
        position.map_or(Self::MISSING, Self::from)
    }
}

impl PartialEq for Observed {
    fn eq(&self, other: &Self) -> bool {
        self.position() == other.position()
    }
}

/// Marker positions over time, in metres.
///
/// ```
/// use condyle_motion::{LengthUnit, Observed, Recording};
/// let recording = Recording {
///     labels: vec!["LASI".into(), "RASI".into()],
///     rate: 100.0,
///     times: vec![0.0, 0.01],
///     positions: [Some([0.0, 1.0, 0.1]), Some([0.0, 1.0, -0.1]), None, Some([0.1, 1.0, -0.1])]
///         .map(Observed::from)
///         .to_vec(),
///     units: LengthUnit::Millimetre,
///     ..Recording::default()
/// };
/// assert_eq!(recording.position(1, 1), Some([0.1, 1.0, -0.1]));
/// assert_eq!(recording.position(1, 0), None);
/// assert_eq!(recording.gaps()[0].marker, 0);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recording {
    /// Marker names; no two are the same.
    pub labels: Vec<String>,
    /// Frames per second.
    pub rate: f64,
    /// Seconds, one per frame, never decreasing.
    pub times: Vec<f64>,
    /// Row by row, one per frame and marker.
    pub positions: Vec<Observed>,
    /// The unit of the file it came from, and of the file it goes to.
    pub units: LengthUnit,
    /// How sure each position is, from 0 to 1, in the order of the positions; `None` where nobody says, as
    /// for markers that cameras track. Estimators of poses say it.
    pub confidences: Option<Vec<f64>>,
}

/// A run of frames in which one marker was not seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gap {
    /// Index of the marker.
    pub marker: usize,
    /// First frame without it.
    pub first: usize,
    /// Number of frames, at least 1.
    pub frames: usize,
}

impl Recording {
    /// Number of frames.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.times.len()
    }

    /// Index of a marker by its exact name.
    #[must_use]
    pub fn marker(&self, label: &str) -> Option<usize> {
        self.labels.iter().position(|l| l == label)
    }

    /// A marker's position in a frame, in metres; `None` if it was not seen or there is no such
    /// marker or frame.
    #[must_use]
    pub fn position(&self, frame: usize, marker: usize) -> Option<[f64; 3]> {
        if marker >= self.labels.len() {
            return None;
        }
        self.frame(frame).get(marker)?.position()
    }

    /// All markers of one frame, in metres; empty if there is no such frame.
    #[must_use]
    pub fn frame(&self, frame: usize) -> &[Observed] {
        let width = self.labels.len();
        frame
            .checked_mul(width)
            .and_then(|start| self.positions.get(start..start.checked_add(width)?))
            .unwrap_or_default()
    }

    /// How sure a marker's position in a frame is, from 0 to 1; 1 where nobody says.
    ///
    /// ```
    /// use condyle_motion::{Observed, Recording};
    /// let recording = Recording {
    ///     labels: vec!["nose".into(), "left_ear".into()],
    ///     times: vec![0.0],
    ///     positions: vec![Observed::from([0.0, 1.6, 0.1]); 2],
    ///     confidences: Some(vec![0.9, 0.4]),
    ///     ..Recording::default()
    /// };
    /// assert_eq!(recording.confidence(0, 1), 0.4);
    /// ```
    #[must_use]
    pub fn confidence(&self, frame: usize, marker: usize) -> f64 {
        let width = self.labels.len();
        let known = self.confidences.as_ref().filter(|_| marker < width);
        let place = frame.checked_mul(width).and_then(|start| start.checked_add(marker));
        known.zip(place).and_then(|(all, place)| all.get(place)).copied().unwrap_or(1.0)
    }

    /// The runs of frames in which a marker was not seen, marker by marker.
    #[must_use]
    pub fn gaps(&self) -> Vec<Gap> {
        let mut gaps = Vec::new();
        for marker in 0..self.labels.len() {
            let mut open: Option<Gap> = None;
            for frame in 0..self.frames() {
                match (self.position(frame, marker), &mut open) {
                    (None, Some(gap)) => gap.frames += 1,
                    (None, None) => open = Some(Gap { marker, first: frame, frames: 1 }),
                    (Some(_), _) => gaps.extend(open.take()),
                }
            }
            gaps.extend(open);
        }
        gaps
    }

    /// How many positions are missing.
    #[must_use]
    pub fn missing(&self) -> usize {
        self.positions.iter().filter(|p| p.position().is_none()).count()
    }

    /// The usual size of a frame: the median, over at most 101 frames, of the longest side of
    /// the box around the markers, in metres. None if no frame has two markers.
    #[must_use]
    pub fn extent(&self) -> Option<f64> {
        let step = self.frames().div_ceil(101).max(1);
        let mut sizes: Vec<f64> = (0..self.frames())
            .step_by(step)
            .filter_map(|frame| side_of_box(self.frame(frame)))
            .collect();
        sizes.sort_by(f64::total_cmp);
        sizes.get(sizes.len() / 2).copied()
    }

    /// The largest absolute coordinate, in metres; 0 without markers.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.positions
            .iter()
            .filter_map(|p| p.position())
            .flatten()
            .fold(0.0, |most: f64, x| x.abs().max(most))
    }

    /// Why the fields are inconsistent, if they are.
    #[must_use]
    pub fn mismatch(&self) -> Option<String> {
        let (frames, labels) = (self.frames(), self.labels.len());
        if let Some(all) = &self.confidences
            && all.len() != self.positions.len()
        {
            let (positions, all) = (self.positions.len(), all.len());
            return Some(format!("{positions} positions need as many confidences, found {all}"));
        }
        (frames.checked_mul(labels) != Some(self.positions.len())).then(|| {
            format!(
                "{frames} frames of {labels} markers need {} positions, found {}",
                frames.saturating_mul(labels),
                self.positions.len()
            )
        })
    }
}

/// The longest side of the box around the markers of a frame; `None` for fewer than two.
fn side_of_box(frame: &[Observed]) -> Option<f64> {
    let mut seen = 0;
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for position in frame.iter().filter_map(|p| p.position()) {
        seen += 1;
        for axis in 0..3 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
        }
    }
    let side = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    (seen >= 2).then_some(side)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recording(rows: &[&[Option<[f64; 3]>]]) -> Recording {
        let width = rows[0].len();
        Recording {
            labels: (0..width).map(|i| format!("m{i}")).collect(),
            rate: 1.0,
            times: (0..rows.len()).map(|i| i as f64).collect(),
            positions: rows.concat().into_iter().map(Observed::from).collect(),
            units: LengthUnit::Metre,
            confidences: None,
        }
    }

    #[test]
    fn gaps_are_runs_of_one_marker() {
        let (here, gone) = (Some([0.0; 3]), None);
        let r = recording(&[&[gone, here], &[gone, gone], &[here, here], &[gone, here]]);
        let gaps: Vec<_> = r.gaps().iter().map(|g| (g.marker, g.first, g.frames)).collect();
        assert_eq!(gaps, [(0, 0, 2), (0, 3, 1), (1, 1, 1)]);
        assert_eq!(r.missing(), 4);
    }

    #[test]
    fn extent_is_the_longest_side() {
        let r = recording(&[&[Some([0.0; 3]), Some([1.0, -2.0, 0.5]), None]]);
        assert_eq!(r.extent(), Some(2.0));
        assert_eq!(r.reach(), 2.0);
        assert_eq!(recording(&[&[Some([1.0; 3])]]).extent(), None);
    }

    #[test]
    fn a_marker_place_takes_24_bytes() {
        assert_eq!(size_of::<Observed>(), 24);
        assert_eq!(Observed::from([0.0, f64::NAN, 0.0]), Observed::MISSING);
    }

    #[test]
    fn no_such_frame_or_marker() {
        let r = recording(&[&[Some([1.0; 3])], &[Some([2.0; 3])]]);
        assert_eq!(r.position(0, 1), None);
        assert_eq!(r.position(2, 0), None);
        assert!(r.frame(usize::MAX).is_empty());
    }
}
