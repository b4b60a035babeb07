//! The texts of a document, places in them, and the errors and warnings about them.

use condyle_diagnostics::{Diagnostic, Error, Place, Severity};

/// How many errors are kept; more than that have a common cause.
const MOST_ERRORS: usize = 50;

/// A place: the number of its text, and the byte where it begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Spot {
    pub(super) file: u32,
    pub(super) start: usize,
}

/// A name in a document, and its place.
#[derive(Clone, Debug)]
pub(super) struct Name {
    pub(super) text: String,
    pub(super) spot: Spot,
}

/// The unit of a document's angles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Angles {
    Degrees,
    #[default]
    Radians,
}

/// One text: the document itself, or one that it includes.
struct File {
    name: String,
    text: String,
    line_starts: Vec<usize>,
    /// The line that includes it, in the document itself.
    included_at: Option<Spot>,
    angles: Angles,
}

/// All texts of a document, with the errors and warnings about them.
#[derive(Default)]
pub(super) struct Texts {
    files: Vec<File>,
    errors: Vec<Diagnostic>,
    surplus: usize,
    warnings: Vec<Diagnostic>,
}

impl Texts {
    /// Adds a text and returns its number.
    pub(super) fn add(&mut self, name: &str, text: &str, included_at: Option<Spot>) -> u32 {
        let breaks = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i + 1);
        self.files.push(File {
            name: name.to_owned(),
            text: text.to_owned(),
            line_starts: std::iter::once(0).chain(breaks).collect(),
            included_at,
            angles: Angles::Radians,
        });
        self.files.len() as u32 - 1
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.files.iter().any(|f| f.name == name)
    }

    pub(super) fn len(&self) -> usize {
        self.files.len()
    }

    pub(super) fn set_angles(&mut self, file: u32, angles: Angles) {
        self.files[file as usize].angles = angles;
    }

    /// The unit of angles at a spot.
    pub(super) fn angles(&self, spot: Spot) -> Angles {
        self.files[spot.file as usize].angles
    }

    fn place(&self, spot: Spot) -> Place {
        let file = &self.files[spot.file as usize];
        let mut start = spot.start.min(file.text.len());
        while !file.text.is_char_boundary(start) {
            start -= 1;
        }
        let line = file.line_starts.partition_point(|&s| s <= start);
        let from = file.line_starts[line - 1];
        let column = file.text[from..start].chars().count() + 1;
        Place { line, column, byte: Some(start as u64) }
    }

    /// A diagnostic about a spot. In an included text, it is placed at the line that includes it.
    pub(super) fn said(
        &self,
        spot: Spot,
        severity: Severity,
        code: &'static str,
        message: String,
    ) -> Diagnostic {
        let file = &self.files[spot.file as usize];
        match file.included_at {
            None => Diagnostic::new(severity, code, message).at(self.place(spot)),
            Some(at) => {
                let Place { line, column, .. } = self.place(spot);
                let message = format!("{}:{line}:{column}: {message}", file.name);
                Diagnostic::new(severity, code, message).at(self.place(at))
            }
        }
    }

    pub(super) fn push(&mut self, error: Diagnostic) {
        if self.errors.len() < MOST_ERRORS {
            self.errors.push(error);
        } else {
            self.surplus += 1;
        }
    }

    pub(super) fn error(
        &mut self,
        spot: Spot,
        code: &'static str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.error_with(spot, code, || (message.into(), help.into()));
    }

    /// An error whose message and help are computed only if it is kept.
    pub(super) fn error_with<M: Into<String>>(
        &mut self,
        spot: Spot,
        code: &'static str,
        say: impl FnOnce() -> (M, String),
    ) {
        if self.errors.len() < MOST_ERRORS {
            let (message, help) = say();
            let said = self.said(spot, Severity::Error, code, message.into());
            self.errors.push(said.with_help(help));
        } else {
            self.surplus += 1;
        }
    }

    pub(super) fn warn(&mut self, warning: Diagnostic) {
        self.warnings.push(warning);
    }

    pub(super) fn count(&self) -> usize {
        self.errors.len() + self.surplus
    }

    pub(super) fn failed(&self) -> bool {
        !self.errors.is_empty()
    }

    /// The warnings, or all errors in the order of the text.
    pub(super) fn finish(mut self) -> Result<Vec<Diagnostic>, Error> {
        self.errors.sort_by_key(|e| e.place.map_or(u64::MAX, |p| p.byte.unwrap_or(0)));
        if self.surplus > 0 {
            let message = format!("and {} more errors", self.surplus);
            self.errors.push(Diagnostic::error("document/more", message));
        }
        Error::of(self.errors).map_or(Ok(self.warnings), Err)
    }
}
