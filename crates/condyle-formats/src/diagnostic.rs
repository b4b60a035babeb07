//! What a reader says about a file: places, warnings and errors.
//!
//! Nothing in this crate prints. A reader answers with [`Read`], the value and its warnings, or
//! with an [`Error`]; both speak in [`Diagnostic`]s, which the caller renders with the file's name.

use std::fmt;

/// A position in a text or binary file.
///
/// ```
/// use condyle_formats::Place;
/// assert_eq!(Place::at(12, 3).to_string(), "line 12, column 3");
/// assert_eq!(Place::at_byte(40).to_string(), "byte 40");
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Place {
    /// Line, counted from 1; 0 where unknown.
    pub line: usize,
    /// Column in characters, counted from 1; 0 where the whole line is meant.
    pub column: usize,
    /// Offset in bytes from the start of the file.
    pub byte: Option<u64>,
}

impl Place {
    /// A line and a column, both counted from 1.
    #[must_use]
    pub fn at(line: usize, column: usize) -> Self {
        Self { line, column, byte: None }
    }

    /// A whole line, counted from 1.
    #[must_use]
    pub fn at_line(line: usize) -> Self {
        Self::at(line, 0)
    }

    /// A byte of a binary file, counted from 0.
    #[must_use]
    pub fn at_byte(byte: u64) -> Self {
        Self { line: 0, column: 0, byte: Some(byte) }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.line, self.column, self.byte) {
            (0, _, Some(byte)) => write!(f, "byte {byte}"),
            (0, _, None) => f.write_str("unknown place"),
            (line, 0, _) => write!(f, "line {line}"),
            (line, column, _) => write!(f, "line {line}, column {column}"),
        }
    }
}

/// One thing worth saying about a file: what, where, and what would be right.
///
/// ```
/// use condyle_formats::{Diagnostic, Place};
/// let said = Diagnostic::new("trc/cell", "`abc` is not a number")
///     .at(Place::at(12, 3))
///     .with_help("write a number, or leave the cell blank");
/// assert_eq!(
///     said.to_string(),
///     "line 12, column 3: `abc` is not a number (write a number, or leave the cell blank)",
/// );
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// A stable key, `family/fact`, for programs.
    pub code: &'static str,
    /// One sentence for people, lower case, without a full stop.
    pub message: String,
    /// Where in the file, if it has a place.
    pub place: Option<Place>,
    /// What would be right, or what was done about it.
    pub help: Option<String>,
}

impl Diagnostic {
    /// A diagnostic without a place or a remedy.
    #[must_use]
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), place: None, help: None }
    }

    /// The same, said of a place.
    #[must_use]
    pub fn at(mut self, place: Place) -> Self {
        self.place = Some(place);
        self
    }

    /// The same, with a remedy.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = self.place {
            write!(f, "{place}: ")?;
        }
        f.write_str(&self.message)?;
        if let Some(help) = &self.help {
            write!(f, " ({help})")?;
        }
        Ok(())
    }
}

/// A value that was read, and what its reader wondered about on the way.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Read<T> {
    /// What the file holds.
    pub value: T,
    /// In the order of the file; empty for a clean one.
    pub warnings: Vec<Diagnostic>,
}

impl<T> Read<T> {
    /// A value with nothing to say about it.
    #[must_use]
    pub fn clean(value: T) -> Self {
        Self { value, warnings: Vec::new() }
    }

    /// Turns the value into another and keeps the warnings.
    pub fn map<U>(self, f: impl FnOnce(T) -> U) -> Read<U> {
        Read { value: f(self.value), warnings: self.warnings }
    }

    /// Whether a warning of this code was given.
    #[must_use]
    pub fn warned(&self, code: &str) -> bool {
        self.warnings.iter().any(|w| w.code == code)
    }
}

/// Why a file could not be read or written.
///
/// ```
/// use condyle_formats::{Error, Place};
/// let error = Error::new("trc/empty", "the file is empty").at(Place::at_line(1));
/// assert_eq!(error.code(), "trc/empty");
/// assert_eq!(error.to_string(), "line 1: the file is empty");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Error(Box<Diagnostic>);

impl Error {
    /// An error without a place or a remedy.
    #[must_use]
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self(Box::new(Diagnostic::new(code, message)))
    }

    /// The same, said of a place.
    #[must_use]
    pub fn at(mut self, place: Place) -> Self {
        self.0.place = Some(place);
        self
    }

    /// The same, with a remedy.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.0.help = Some(help.into());
        self
    }

    /// The stable key of what is wrong.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.0.code
    }

    /// Where in the file, if it has a place.
    #[must_use]
    pub fn place(&self) -> Option<Place> {
        self.0.place
    }

    /// The whole of it.
    #[must_use]
    pub fn diagnostic(&self) -> &Diagnostic {
        &self.0
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for Error {}

impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Self {
        Self(Box::new(diagnostic))
    }
}

impl From<Error> for Diagnostic {
    fn from(error: Error) -> Self {
        *error.0
    }
}

/// How many warnings of one code are kept in full.
const KEPT_PER_CODE: usize = 5;

/// Collects warnings; after a few of one code it counts the rest, so that a file of a million
/// short rows costs five sentences and a sum.
#[derive(Debug, Default)]
pub(crate) struct Warnings {
    kept: Vec<Diagnostic>,
    counts: Vec<(&'static str, usize)>,
}

impl Warnings {
    /// Adds one; the closure runs only if the sentence will be kept.
    pub(crate) fn add(&mut self, code: &'static str, say: impl FnOnce() -> Diagnostic) {
        let count = match self.counts.iter_mut().find(|(c, _)| *c == code) {
            Some((_, count)) => {
                *count += 1;
                *count
            }
            None => {
                self.counts.push((code, 1));
                1
            }
        };
        if count <= KEPT_PER_CODE {
            self.kept.push(say());
        }
    }

    /// Adds one that is already a sentence.
    pub(crate) fn push(&mut self, warning: Diagnostic) {
        self.add(warning.code, || warning);
    }

    /// Adds those of an inner reader.
    pub(crate) fn extend(&mut self, warnings: Vec<Diagnostic>) {
        for warning in warnings {
            self.push(warning);
        }
    }

    /// The list, each code's surplus summed up at the end.
    pub(crate) fn finish(mut self) -> Vec<Diagnostic> {
        for (code, count) in self.counts {
            if count > KEPT_PER_CODE {
                self.kept.push(Diagnostic::new(
                    code,
                    format!("and {} more like the last `{code}`", count - KEPT_PER_CODE),
                ));
            }
        }
        self.kept
    }
}

/// The candidate that a mistyped name most likely meant.
///
/// Similar means a Jaro-Winkler similarity of at least 0.8 between the lower-case names.
///
/// ```
/// use condyle_formats::nearest;
/// assert_eq!(nearest("knee_angel_r", ["hip_flexion_r", "knee_angle_r"]), Some("knee_angle_r"));
/// assert_eq!(nearest("knee_angel_r", ["lumbar"]), None);
/// ```
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // The measure is quadratic in length: nobody mistypes a name of two hundred letters.
    let clip = |s: &str| s.chars().take(200).collect::<String>().to_lowercase();
    let name = clip(name);
    candidates
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(&name, &clip(candidate)), candidate))
        .filter(|(similarity, _)| *similarity >= 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surplus_warnings_are_counted() {
        let mut warnings = Warnings::default();
        for line in 1..=9 {
            warnings.add("x/y", || Diagnostic::new("x/y", "odd").at(Place::at_line(line)));
        }
        let list = warnings.finish();
        assert_eq!(list.len(), 6);
        assert_eq!(list[4].to_string(), "line 5: odd");
        assert_eq!(list[5].message, "and 4 more like the last `x/y`");
    }

    #[test]
    fn places_read_naturally() {
        assert_eq!(Place::at_line(7).to_string(), "line 7");
        assert_eq!(Place::default().to_string(), "unknown place");
    }

    #[test]
    fn a_name_like_nothing_has_no_neighbour() {
        assert_eq!(nearest("", ["a", "b"]), None);
        assert_eq!(nearest("R.ASIS", ["r.asis"]), Some("r.asis"));
    }
}
