//! What a page is answered.

use condyle::{Diagnostic, Error};
use serde_json::{Value, json};

/// A JSON text, and numbers to which it refers by their places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    /// JSON.
    pub text: String,
    /// Numbers of four bytes each, the least byte first, or a file; the text says what is where.
    pub numbers: Vec<u8>,
}

/// Why a question has no answer: sentences with places, as JSON.
pub type Fault = Value;

impl Answer {
    /// An answer of a text alone.
    #[must_use]
    pub fn of(text: &Value) -> Self {
        Self { text: text.to_string(), numbers: vec![] }
    }

    /// Adds numbers in single precision; where they begin, in bytes, and how many they are.
    pub(crate) fn floats(&mut self, numbers: impl IntoIterator<Item = f64>) -> Value {
        let start = self.numbers.len();
        self.numbers.extend(numbers.into_iter().flat_map(|x| (x as f32).to_le_bytes()));
        json!([start, (self.numbers.len() - start) / 4])
    }

    /// Adds positions of corners.
    pub(crate) fn corners(&mut self, numbers: impl IntoIterator<Item = u32>) -> Value {
        let start = self.numbers.len();
        self.numbers.extend(numbers.into_iter().flat_map(u32::to_le_bytes));
        json!([start, (self.numbers.len() - start) / 4])
    }
}

/// Everything that is wrong, as a page shows it.
pub(crate) fn fault(error: &Error) -> Fault {
    json!({ "faults": error.iter().map(said).collect::<Vec<_>>() })
}

/// One sentence of our own.
pub(crate) fn sentence(text: impl Into<String>) -> Fault {
    json!({ "faults": [{ "severity": "error", "text": text.into() }] })
}

/// A diagnostic with its place.
pub(crate) fn said(diagnostic: &Diagnostic) -> Value {
    let place = diagnostic.place;
    json!({
        "severity": diagnostic.severity.name(),
        "code": diagnostic.code,
        "text": diagnostic.sentence(),
        "line": place.map(|p| p.line).filter(|line| *line > 0),
        "column": place.map(|p| p.column).filter(|column| *column > 0),
    })
}
