//! Marker recordings, whatever file they came from.

/// A unit of length at the border of a file; inside, lengths are metres.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LengthUnit {
    /// `m`
    #[default]
    Metre,
    /// `cm`
    Centimetre,
    /// `mm`
    Millimetre,
    /// `in`, 0.0254 m
    Inch,
    /// `ft`, 0.3048 m
    Foot,
}

impl LengthUnit {
    /// The unit of this name, in any of the spellings met in files.
    ///
    /// ```
    /// use condyle_formats::LengthUnit;
    /// assert_eq!(LengthUnit::from_name(" MM "), Some(LengthUnit::Millimetre));
    /// assert_eq!(LengthUnit::from_name("meters"), Some(LengthUnit::Metre));
    /// assert_eq!(LengthUnit::from_name("furlong"), None);
    /// ```
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        // C3D cuts units to four letters: "mete".
        match name.trim().trim_end_matches('.').to_ascii_lowercase().as_str() {
            "m" | "mete" | "meter" | "meters" | "metre" | "metres" => Some(Self::Metre),
            "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => {
                Some(Self::Centimetre)
            }
            "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => {
                Some(Self::Millimetre)
            }
            "in" | "inch" | "inches" | "\"" => Some(Self::Inch),
            "ft" | "foot" | "feet" => Some(Self::Foot),
            _ => None,
        }
    }

    /// The short name, as files write it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Inch => "in",
            Self::Foot => "ft",
        }
    }

    /// A length in this unit, in metres.
    ///
    /// ```
    /// use condyle_formats::LengthUnit;
    /// assert_eq!(LengthUnit::Millimetre.to_metres(125.0), 0.125);
    /// assert_eq!(LengthUnit::Inch.to_metres(10.0), 0.254);
    /// ```
    #[must_use]
    pub fn to_metres(self, length: f64) -> f64 {
        // Dividing by a whole number rounds once, multiplying by 0.001 twice.
        match self {
            Self::Metre => length,
            Self::Centimetre => length / 100.0,
            Self::Millimetre => length / 1000.0,
            Self::Inch => length * 0.0254,
            Self::Foot => length * 0.3048,
        }
    }

    /// A length in metres, in this unit: of the neighbouring doubles that read back as the same
    /// length the one with the shortest decimal, so that a file read and written keeps its digits.
    #[must_use]
    pub fn from_metres(self, length: f64) -> f64 {
        let near = match self {
            Self::Metre => return length,
            Self::Centimetre => length * 100.0,
            Self::Millimetre => length * 1000.0,
            Self::Inch => length / 0.0254,
            Self::Foot => length / 0.3048,
        };
        [near, near.next_up(), near.next_down()]
            .into_iter()
            .filter(|candidate| self.to_metres(*candidate) == length)
            .min_by_key(|candidate| candidate.to_string().len())
            .unwrap_or(near)
    }
}

/// Marker positions over time, in metres.
///
/// ```
/// use condyle_formats::{LengthUnit, Recording};
/// let recording = Recording {
///     labels: vec!["LASI".into(), "RASI".into()],
///     rate: 100.0,
///     times: vec![0.0, 0.01],
///     positions: vec![Some([0.0, 1.0, 0.1]), Some([0.0, 1.0, -0.1]), None, Some([0.1, 1.0, -0.1])],
///     units: LengthUnit::Millimetre,
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
    /// Seconds, one per frame, never falling.
    pub times: Vec<f64>,
    /// Row by row, one per frame and marker; none where the marker was not seen.
    pub positions: Vec<Option<[f64; 3]>>,
    /// The unit of the file it came from, and of the file it goes to.
    pub units: LengthUnit,
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

    /// A marker's position in a frame, in metres; none if it was not seen or there is no such
    /// marker or frame.
    #[must_use]
    pub fn position(&self, frame: usize, marker: usize) -> Option<[f64; 3]> {
        if marker >= self.labels.len() {
            return None;
        }
        self.frame(frame).get(marker).copied().flatten()
    }

    /// All markers of one frame, in metres; empty if there is no such frame.
    #[must_use]
    pub fn frame(&self, frame: usize) -> &[Option<[f64; 3]>] {
        let width = self.labels.len();
        frame
            .checked_mul(width)
            .and_then(|start| self.positions.get(start..start.checked_add(width)?))
            .unwrap_or_default()
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
        self.positions.iter().filter(|p| p.is_none()).count()
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
        self.positions.iter().flatten().flatten().fold(0.0, |most, x| x.abs().max(most))
    }

    /// Why the fields do not fit together, if they do not.
    pub(crate) fn mismatch(&self) -> Option<String> {
        let (frames, labels) = (self.frames(), self.labels.len());
        (frames.checked_mul(labels) != Some(self.positions.len())).then(|| {
            format!(
                "{frames} frames of {labels} markers need {} positions, found {}",
                frames.saturating_mul(labels),
                self.positions.len()
            )
        })
    }
}

/// The longest side of the box around the markers of a frame; none for fewer than two.
fn side_of_box(frame: &[Option<[f64; 3]>]) -> Option<f64> {
    let mut seen = 0;
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for position in frame.iter().flatten() {
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
            positions: rows.concat(),
            units: LengthUnit::Metre,
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
    fn no_such_frame_or_marker() {
        let r = recording(&[&[Some([1.0; 3])], &[Some([2.0; 3])]]);
        assert_eq!(r.position(0, 1), None);
        assert_eq!(r.position(2, 0), None);
        assert!(r.frame(usize::MAX).is_empty());
    }

    #[test]
    fn a_length_read_and_written_keeps_its_digits() {
        for unit in [LengthUnit::Millimetre, LengthUnit::Centimetre, LengthUnit::Inch] {
            for thousandths in (-50_000_i32..50_000).step_by(7) {
                let written: f64 = format!("{thousandths}e-3").parse().unwrap();
                let metres = unit.to_metres(written);
                assert_eq!(unit.to_metres(unit.from_metres(metres)), metres);
                if unit == LengthUnit::Millimetre {
                    assert_eq!(unit.from_metres(metres), written);
                }
            }
        }
    }
}
