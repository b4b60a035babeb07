//! Why something cannot be used.

use crate::{Diagnostic, Place, Severity};
use std::fmt;
use std::ops::Deref;

/// Why a file cannot be read or a model cannot be built: one diagnostic or several, the first of
/// which is the most important. Dereferences to the list, which is never empty.
///
/// ```
/// use condyle_diagnostics::{Error, Place};
/// let error = Error::new("trc/empty", "the file is empty").at(Place::at_line(1));
/// assert_eq!(error.code(), "trc/empty");
/// assert_eq!(error.to_string(), "line 1: the file is empty");
/// assert_eq!(error.len(), 1);
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct Error(Box<Content>);

#[derive(Clone, PartialEq, Eq)]
struct Content {
    diagnostics: Vec<Diagnostic>,
    contradiction: bool,
}

impl Error {
    /// An error of one diagnostic without a place or a remedy.
    #[must_use]
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Diagnostic::error(code, message).into()
    }

    /// An error of several diagnostics; `None` if there are none.
    #[must_use]
    pub fn of(diagnostics: Vec<Diagnostic>) -> Option<Self> {
        let content = Content { diagnostics, contradiction: false };
        (!content.diagnostics.is_empty()).then(|| Self(Box::new(content)))
    }

    /// The same, marked as a contradiction: the input was read, but what it describes contradicts
    /// itself.
    #[must_use]
    pub fn contradiction(mut self) -> Self {
        self.0.contradiction = true;
        self
    }

    /// Whether the input was read, but what it describes contradicts itself.
    #[must_use]
    pub fn is_contradiction(&self) -> bool {
        self.0.contradiction
    }

    /// The same, its first diagnostic said of a place.
    #[must_use]
    pub fn at(mut self, place: Place) -> Self {
        self.0.diagnostics[0].place = Some(place);
        self
    }

    /// The same, its first diagnostic with a remedy.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.0.diagnostics[0].help = help.into();
        self
    }

    /// The stable key of the first diagnostic.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self[0].code
    }

    /// Where the first diagnostic is, if it has a place.
    #[must_use]
    pub fn place(&self) -> Option<Place> {
        self[0].place
    }

    /// All diagnostics, at least one.
    #[must_use]
    pub fn into_diagnostics(self) -> Vec<Diagnostic> {
        self.0.diagnostics
    }
}

impl Deref for Error {
    type Target = [Diagnostic];

    fn deref(&self) -> &[Diagnostic] {
        &self.0.diagnostics
    }
}

/// One diagnostic a line.
impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, diagnostic) in self.iter().enumerate() {
            let separator = if index > 0 { "\n" } else { "" };
            write!(f, "{separator}{diagnostic}")?;
        }
        Ok(())
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl std::error::Error for Error {}

impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Self {
        let diagnostics = vec![Diagnostic { severity: Severity::Error, ..diagnostic }];
        Self(Box::new(Content { diagnostics, contradiction: false }))
    }
}
