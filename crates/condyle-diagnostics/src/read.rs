//! What a reader answers with.

use crate::Diagnostic;

/// A value that was read, and the warnings and notes about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Read<T> {
    /// What the file holds.
    pub value: T,
    /// In the order of the file; empty for a clean one.
    pub warnings: Vec<Diagnostic>,
}

impl<T> Read<T> {
    /// A value without warnings.
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
