//! A recording as it would be if something about it had been done otherwise.

use condyle_math::Vec3;
use condyle_motion::{Observed, Recording};
use std::fmt;

/// A change to a whole recording.
#[derive(Clone, Debug, PartialEq)]
pub enum Variant {
    /// The names of two labels are exchanged, for each of these pairs of positions among the labels.
    Exchanged(Vec<[usize; 2]>),
    /// One axis points the other way: 0 for x, 1 for y, 2 for z.
    Mirrored(usize),
    /// Everything turned about an axis by so many quarter turns, counter-clockwise.
    Turned {
        /// 0 for x, 1 for y, 2 for z.
        axis: usize,
        /// Quarter turns.
        quarters: u8,
    },
    /// Every length times a factor.
    Scaled(f64),
    /// Each label has the positions of another: for each its position among the labels.
    Permuted(Vec<usize>),
}

/// The name of an axis.
pub(super) fn axis_name(axis: usize) -> char {
    ['x', 'y', 'z'][axis.min(2)]
}

impl Variant {
    /// The changed recording; labels that a variant does not have stay as they are.
    ///
    /// ```
    /// use condyle::formats::{Observed, Recording};
    /// use condyle::tracking::Variant;
    /// let recording = Recording {
    ///     labels: vec!["L".into(), "R".into()],
    ///     times: vec![0.0],
    ///     positions: vec![Observed::from([1.0, 2.0, 3.0]), Observed::from([4.0, 5.0, 6.0])],
    ///     ..Recording::default()
    /// };
    /// let turned = Variant::Turned { axis: 0, quarters: 1 }.of(&recording);
    /// assert_eq!(turned.position(0, 0), Some([1.0, -3.0, 2.0]));
    /// let exchanged = Variant::Exchanged(vec![[0, 1]]).of(&recording);
    /// assert_eq!(exchanged.position(0, 0), Some([4.0, 5.0, 6.0]));
    /// ```
    #[must_use]
    pub fn of(&self, recording: &Recording) -> Recording {
        let mut changed = recording.clone();
        let width = recording.labels.len();
        match self {
            Self::Exchanged(pairs) => {
                let known = pairs.iter().filter(|pair| pair.iter().all(|&label| label < width));
                for row in changed.positions.chunks_exact_mut(width.max(1)) {
                    known.clone().for_each(|&[a, b]| row.swap(a, b));
                }
                for row in
                    changed.confidences.iter_mut().flat_map(|c| c.chunks_exact_mut(width.max(1)))
                {
                    known.clone().for_each(|&[a, b]| row.swap(a, b));
                }
            }
            Self::Permuted(from) => {
                let rows = recording.positions.chunks_exact(width.max(1));
                for (row, old) in changed.positions.chunks_exact_mut(width.max(1)).zip(rows) {
                    for (place, &label) in row.iter_mut().zip(from) {
                        *place = old.get(label).copied().unwrap_or(Observed::MISSING);
                    }
                }
            }
            Self::Mirrored(_) | Self::Turned { .. } | Self::Scaled(_) => {
                let seen = changed.positions.iter_mut().filter_map(Observed::position_mut);
                seen.for_each(|position| *position = self.point(*position));
            }
        }
        changed
    }

    /// Where a point of space goes.
    fn point(&self, mut p: [f64; 3]) -> [f64; 3] {
        match *self {
            Self::Mirrored(axis) => p[axis % 3] = -p[axis % 3],
            Self::Turned { axis, quarters } => {
                let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
                for _ in 0..quarters % 4 {
                    (p[next], p[last]) = (-p[last], p[next]);
                }
            }
            Self::Scaled(factor) => p = (Vec3::from(p) * factor).to_array(),
            Self::Exchanged(_) | Self::Permuted(_) => {}
        }
        p
    }
}

/// What is the matter with a recording that this change puts right.
impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exchanged(_) => f.write_str("the left and right labels are exchanged"),
            Self::Mirrored(axis) => {
                write!(
                    f,
                    "the recording is mirrored (its {} axis points the other way)",
                    axis_name(*axis)
                )
            }
            Self::Turned { quarters: 2, .. } => f.write_str("the recording is upside down"),
            Self::Turned { axis, quarters } => {
                let degrees = if *quarters % 4 == 1 { 90 } else { -90 };
                write!(
                    f,
                    "the axes of the recording are turned: it fits turned about {} by {degrees}°",
                    axis_name(*axis)
                )
            }
            Self::Scaled(factor) if *factor >= 1.0 => {
                write!(
                    f,
                    "the unit of the recording is wrong: its lengths are {factor} times too small"
                )
            }
            Self::Scaled(factor) => {
                let times = (1.0 / factor).round();
                write!(
                    f,
                    "the unit of the recording is wrong: its lengths are {times} times too large"
                )
            }
            Self::Permuted(_) => f.write_str("the labels are permuted"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three labels in two frames, one of them missing once.
    fn recording() -> Recording {
        let places = [
            Some([1.0, 2.0, 3.0]),
            Some([-1.0, 0.5, 0.0]),
            None,
            Some([0.1, 0.2, 0.3]),
            Some([4.0, 5.0, 6.0]),
            Some([7.0, 8.0, 9.0]),
        ];
        Recording {
            labels: ["a", "b", "c"].map(String::from).to_vec(),
            times: vec![0.0, 1.0],
            positions: places.map(Observed::from).to_vec(),
            ..Recording::default()
        }
    }

    #[test]
    fn every_variant_is_undone_by_its_inverse() {
        let r = recording();
        let pairs = [
            (Variant::Exchanged(vec![[0, 2]]), Variant::Exchanged(vec![[2, 0]])),
            (Variant::Mirrored(1), Variant::Mirrored(1)),
            (Variant::Scaled(8.0), Variant::Scaled(0.125)),
            (Variant::Permuted(vec![1, 2, 0]), Variant::Permuted(vec![2, 0, 1])),
        ];
        for (there, back) in pairs {
            assert_ne!(there.of(&r), r, "{there}");
            assert_eq!(back.of(&there.of(&r)), r, "{there}");
        }
        for axis in 0..3 {
            let quarter = Variant::Turned { axis, quarters: 1 };
            assert_eq!(quarter.of(&quarter.of(&r)), Variant::Turned { axis, quarters: 2 }.of(&r));
            assert_eq!(Variant::Turned { axis, quarters: 3 }.of(&quarter.of(&r)), r);
        }
    }

    #[test]
    fn a_turn_keeps_the_hand_and_a_mirror_does_not() {
        // The volume x · (y × z) of the images of the three unit vectors is the determinant.
        let volume = |variant: Variant| {
            let units = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            let [x, y, z] = units.map(|unit| Vec3::from(variant.point(unit)));
            x.dot(y.cross(z))
        };
        for axis in 0..3 {
            assert_eq!(volume(Variant::Mirrored(axis)), -1.0);
            for quarters in 0..4 {
                assert_eq!(volume(Variant::Turned { axis, quarters }), 1.0);
            }
        }
    }

    #[test]
    fn labels_that_are_not_there_are_left_alone() {
        let r = recording();
        assert_eq!(Variant::Exchanged(vec![[0, 7]]).of(&r), r);
        let lost = Variant::Permuted(vec![9]).of(&r);
        assert_eq!((lost.position(0, 0), lost.position(0, 1)), (None, r.position(0, 1)));
        assert_eq!(Variant::Permuted(vec![]).of(&Recording::default()), Recording::default());
    }
}
