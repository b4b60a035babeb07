//! One thing that is said about a model, a file or a motion.

use crate::{Place, Subject};
use std::fmt;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Worth knowing; makes no check fail.
    Note,
    /// Allowed, but unlikely to be meant.
    Warning,
    /// Contradicts itself, breaks an enforced limit, or cannot be used.
    Error,
}

impl Severity {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// One thing that is said: what, about what, where, and what would be right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// A stable key, `family/fact`, for programs.
    pub code: &'static str,
    /// What it is about; may be empty.
    pub subjects: Vec<Subject>,
    /// One sentence for people, lower case, without a full stop.
    pub message: String,
    /// What would be right, or what was done about it; may be empty.
    pub help: String,
    /// Where in the file, if it has a place.
    pub place: Option<Place>,
}

impl Diagnostic {
    /// A diagnostic without subjects, help or place.
    #[must_use]
    pub fn new(severity: Severity, code: &'static str, message: impl Into<String>) -> Self {
        let (subjects, help) = (vec![], String::new());
        Self { severity, code, subjects, message: message.into(), help, place: None }
    }

    /// Something worth knowing.
    #[must_use]
    pub fn note(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Note, code, message)
    }

    /// Something that is unlikely to be meant.
    #[must_use]
    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, message)
    }

    /// Something that cannot be used.
    #[must_use]
    pub fn error(code: &'static str, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, message)
    }

    /// The same, said of one more subject.
    #[must_use]
    pub fn about(mut self, subject: Subject) -> Self {
        self.subjects.push(subject);
        self
    }

    /// The same, said of more subjects.
    #[must_use]
    pub fn about_all(mut self, subjects: impl IntoIterator<Item = Subject>) -> Self {
        self.subjects.extend(subjects);
        self
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
        self.help = help.into();
        self
    }

    /// The message with the help in parentheses behind it, without the place.
    #[must_use]
    pub fn sentence(&self) -> String {
        match self.help.as_str() {
            "" => self.message.clone(),
            help => format!("{} ({help})", self.message),
        }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = self.place {
            write!(f, "{place}: ")?;
        }
        f.write_str(&self.sentence())
    }
}

/// At most six names in backquotes, and how many more there are.
///
/// ```
/// use condyle_diagnostics::listed;
/// assert_eq!(listed(["a", "b"]), "`a`, `b`");
/// assert_eq!(listed(["x"; 8]), "`x`, `x`, `x`, `x`, `x`, `x` and 2 more");
/// ```
pub fn listed<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    let mut names = names.into_iter();
    let shown: Vec<String> = names.by_ref().take(6).map(|n| format!("`{}`", n.as_ref())).collect();
    match names.count() {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}
