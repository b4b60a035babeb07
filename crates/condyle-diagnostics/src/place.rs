//! Positions in files.

use std::fmt;

/// A position in a text or binary file.
///
/// ```
/// use condyle_diagnostics::Place;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_read_naturally() {
        assert_eq!(Place::at_line(7).to_string(), "line 7");
        assert_eq!(Place::default().to_string(), "unknown place");
    }
}
