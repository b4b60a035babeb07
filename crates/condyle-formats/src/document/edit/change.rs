//! A number given another value, and the document read anew with it.

use super::way::{Target, Way, WayKind};
use super::{Editing, Step, line_and_column, shown};
use condyle_diagnostics::Error;
use std::fmt;

/// How far the value that is read afterwards may be from what was asked for, relative to it.
const EXACT: f64 = 1e-9;

/// Bytes of a text that are replaced by others.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The text by its path from the document; empty for the document itself.
    pub file: String,
    /// The byte at which it begins.
    pub at: usize,
    /// What stood there.
    pub old: String,
    /// What stands there now.
    pub new: String,
}

/// A change that was made to texts in memory.
#[derive(Clone, Debug)]
pub struct Edited {
    /// What was replaced.
    pub change: Change,
    /// The line of it, counted from 1.
    pub line: usize,
    /// The paths of the mirrored side that follow.
    pub mirrored: Vec<Vec<Step>>,
    /// The document with it.
    pub next: Editing,
}

/// Why a change was not made.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Refused {
    /// There is nothing at this path, it cannot be changed this way, or it cannot have this value; a sentence.
    Impossible(String),
    /// The document could not be read any more: what would be wrong, and the text that it would have.
    Fault {
        /// What would be wrong.
        error: Error,
        /// The changed text, by its path from the document.
        file: String,
        /// What it would be.
        text: String,
    },
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Impossible(why) => f.write_str(why),
            Self::Fault { error, .. } => {
                write!(f, "the document could not be read any more: {error}")
            }
        }
    }
}

impl std::error::Error for Refused {}

impl From<&str> for Refused {
    fn from(why: &str) -> Self {
        Self::Impossible(why.to_owned())
    }
}

/// A finite number as TOML has it, as short as it can be without loss.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    match value {
        // Without the sign of a zero.
        0.0 => "0".to_owned(),
        value if !(1e-5..1e15).contains(&size) => format!("{value:e}"),
        value => format!("{value}"),
    }
}

/// The number that is written for a value: the shorter of the exact one and one without the noise of a division.
fn solved(value: f64, slope: f64, offset: f64) -> f64 {
    let exact = (value - offset) / slope;
    let short: f64 = format!("{exact:.14e}").parse().unwrap_or(exact);
    let back = offset + slope * short;
    if (back - value).abs() <= 4e-16 * value.abs() { short } else { exact }
}

impl Editing {
    /// Gives a number another value, in its unit; by its first way if none is named. The number of the mirrored side
    /// is set on the written side, with the same value.
    ///
    /// # Errors
    /// [`Refused::Impossible`] if there is no such number or way; [`Refused::Fault`] if the document could not be
    /// read any more.
    pub fn set(&self, path: &[Step], value: f64, way: Option<WayKind>) -> Result<Edited, Refused> {
        let name = shown(path);
        let Some(editable) = self.find(path) else {
            return Err(Refused::Impossible(format!("there is no number `{name}`")));
        };
        if !value.is_finite() {
            return Err(Refused::Impossible(format!("`{name}` cannot be {value}")));
        }
        let chosen = match way {
            None => editable.ways.first(),
            Some(kind) => editable.ways.iter().find(|way| way.kind == kind),
        };
        let Some(Way { target, .. }) = chosen else {
            return Err(Refused::Impossible(format!("`{name}` cannot be changed this way")));
        };
        let edited = match target {
            Target::Replace { source, range, affine, signed } => {
                let new = number(solved(value, affine.slope, affine.offset));
                if new.starts_with('-') && !signed {
                    let why =
                        format!("the number in the expression of `{name}` cannot be negative");
                    return Err(Refused::Impossible(why));
                }
                let source = self.sources.get(*source).ok_or("the text is not known")?;
                let old = source.text.get(range.clone()).ok_or("the place is not known")?;
                // A value that does not change keeps its digits.
                let same = old.parse::<f64>().ok() == new.parse().ok() && !old.is_empty();
                let new = if same { old.to_owned() } else { new };
                let change =
                    Change { file: source.name.clone(), at: range.start, old: old.to_owned(), new };
                self.changed(change)?
            }
            Target::Override { path, pieces, piece, affine, enforced } => {
                let mut pieces = pieces.as_ref().clone();
                let new = number(solved(value, affine.slope, affine.offset));
                if let Some(piece) = pieces.get_mut(*piece) {
                    *piece = new;
                }
                let mut keys = vec![];
                if let Some((last, table)) = path.split_last() {
                    keys.push((last.as_str(), pieces.concat()));
                    keys.extend(enforced.map(|on| ("enforced", on.to_string())));
                    self.changed(self.insertion(table, &keys)?)?
                } else {
                    return Err("the place is not known".into());
                }
            }
        };
        let there = edited.next.find(&editable.path).map(|found| {
            // Another text may have another unit of angles.
            let degree = std::f64::consts::PI / 180.0;
            match (found.unit, editable.unit) {
                ("deg", "rad") => found.value * degree,
                ("rad", "deg") => found.value / degree,
                _ => found.value,
            }
        });
        match there {
            Some(found) if (found - value).abs() <= EXACT * value.abs().max(EXACT) => {}
            _ => {
                let why = format!("`{name}` would not have this value afterwards: edit the text");
                return Err(Refused::Impossible(why));
            }
        }
        let mirrored = editable.mirrored.iter().cloned().collect();
        Ok(Edited { mirrored, ..edited })
    }

    /// The document with a change, if it can be read.
    pub(super) fn changed(&self, change: Change) -> Result<Edited, Refused> {
        let source = self.source(&change.file).ok_or("the text is not known")?;
        let end = change.at + change.old.len();
        let (Some(before), Some(after)) = (source.text.get(..change.at), source.text.get(end..))
        else {
            return Err("the place is not known".into());
        };
        let text = [before, &change.new, after].concat();
        let line = line_and_column(&text, change.at).0;
        match self.with(&change.file, &text) {
            Ok(next) => Ok(Edited { change, line, mirrored: vec![], next }),
            Err(error) => Err(Refused::Fault { error, file: change.file, text }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{number, solved};

    #[test]
    fn numbers_are_short_and_come_back() {
        assert_eq!(number(-0.43), "-0.43");
        assert_eq!(number(-0.0), "0");
        assert_eq!(number(12.0), "12");
        for value in [1e-7, -3.2e20, 1.0 / 3.0, 123456.789] {
            assert_eq!(number(value).parse::<f64>().unwrap(), value);
        }
        // 0.155 s is 0.16 for s = 1.0322580645161290...; -(0.3) for a minus before a constant.
        assert_eq!(number(solved(-0.3, -1.0, 0.0)), "0.3");
        assert_eq!(number(solved(0.0616, 0.385, 0.0)), "0.16");
        // The whole of pi / 2 is kept.
        assert_eq!(number(solved(90.0, 180.0 / std::f64::consts::PI, 0.0)), "1.5707963267948966");
    }
}
