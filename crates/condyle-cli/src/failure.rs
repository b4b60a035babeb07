//! Why a command failed, and warnings.

use crate::screen::say;
use condyle::formats::document;
use condyle::open::{Cause, OpenError, located};
use condyle::{Diagnostic, Error, Read};
use std::fmt;
use std::path::Path;

/// A message for a person; the process ends with exit code 2.
#[derive(Debug)]
pub(crate) struct Failure(String);

impl Failure {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self(message.into())
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl From<OpenError> for Failure {
    fn from(error: OpenError) -> Self {
        match &error.cause {
            Cause::Content { text: Some(text), error: content } => {
                let name = error.path.display().to_string();
                let shown: Vec<String> = content
                    .iter()
                    .map(|one| document::render(&name, text, std::slice::from_ref(one)))
                    .collect();
                Self(shown.join("error: ").trim_end().to_owned())
            }
            _ => Self(error.to_string()),
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self(error.to_string())
    }
}

/// Prints warnings about a file and returns its value.
pub(crate) fn warned<T>(path: &Path, read: Read<T>) -> T {
    warn_about(path, &read.warnings);
    read.value
}

/// Prints warnings about a file.
pub(crate) fn warn_about(path: &Path, warnings: &[Diagnostic]) {
    for warning in warnings {
        say(&format!("{}: {}", warning.severity.name(), located(path, warning)));
    }
}
