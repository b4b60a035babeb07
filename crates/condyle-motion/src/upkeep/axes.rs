//! Other axes for positions.

use super::{Series, argument};
use condyle_diagnostics::Error;
use std::fmt;
use std::str::FromStr;

/// What the new x, y and z are in the old axes: a turn by right angles.
///
/// ```
/// use condyle_motion::upkeep::Axes;
/// // A laboratory with z up: the new y is the old z, and to stay right-handed the new z is the old -y.
/// let axes: Axes = "x,z,-y".parse()?;
/// assert_eq!(axes.turned([1.0, 2.0, 3.0]), [1.0, 3.0, -2.0]);
/// assert!("x,z,y".parse::<Axes>().is_err());
/// # Ok::<(), condyle_diagnostics::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes([(usize, bool); 3]);

impl Axes {
    /// A position in the new axes.
    #[must_use]
    pub fn turned(self, position: [f64; 3]) -> [f64; 3] {
        self.0.map(|(axis, negative)| if negative { -position[axis] } else { position[axis] })
    }

    pub(super) fn turn(self, series: &mut Series) -> Result<String, Error> {
        let (triples, rest) = series.columns.as_chunks_mut::<3>();
        if !rest.is_empty() {
            return Err(argument("axes are turned in triples of columns only".into()));
        }
        for columns in triples {
            for row in 0..series.times.len() {
                let turned = self.turned([columns[0][row], columns[1][row], columns[2][row]]);
                for (column, value) in columns.iter_mut().zip(turned) {
                    column[row] = value;
                }
            }
        }
        Ok(format!("turned axes: x, y, z are the former {self}"))
    }
}

impl FromStr for Axes {
    type Err = Error;

    /// Three of `x`, `y`, `z` with signs, separated by commas.
    fn from_str(text: &str) -> Result<Self, Error> {
        let wrong = |why: &str| {
            Err(argument(format!("axes `{text}`: {why}"))
                .with_help("three of x, y, z, each once, with signs: x,z,-y makes y of a former z"))
        };
        let parts: Vec<&str> = text.split(',').map(str::trim).collect();
        let Ok(parts): Result<[&str; 3], _> = parts.try_into() else {
            return wrong("there must be three");
        };
        let mut axes = [(0, false); 3];
        for (axis, part) in axes.iter_mut().zip(parts) {
            let letter = part.trim_start_matches(['+', '-']);
            let Some(old) = ["x", "y", "z"].iter().position(|l| l.eq_ignore_ascii_case(letter))
            else {
                return wrong("unknown axis");
            };
            *axis = (old, part.starts_with('-'));
        }
        let [a, b, c] = axes.map(|(axis, _)| axis);
        if a == b || b == c || a == c {
            return wrong("an axis is there twice");
        }
        // The sign of the permutation times those of the axes is the determinant.
        let even = (b + 3 - a) % 3 == 1;
        let flips = axes.iter().filter(|(_, negative)| *negative).count();
        if even != (flips % 2 == 0) {
            return wrong("that is a mirror image, which makes left sides of right ones");
        }
        Ok(Self(axes))
    }
}

impl fmt::Display for Axes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (axis, negative)) in self.0.into_iter().enumerate() {
            let (comma, sign) = (if i > 0 { ", " } else { "" }, if negative { "-" } else { "" });
            write!(f, "{comma}{sign}{}", ["x", "y", "z"][axis])?;
        }
        Ok(())
    }
}
