//! Words of such files, with their lines.

use crate::text::{Line, lines, number};
use condyle_diagnostics::Place;

/// One line without its comment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<'a> {
    pub(super) line: Line<'a>,
    pub(super) text: &'a str,
}

fn separates(c: char) -> bool {
    c.is_whitespace() || matches!(c, ',' | '(' | ')' | '\0' | '\u{1a}')
}

impl<'a> Row<'a> {
    pub(super) fn words(&self) -> impl Iterator<Item = &'a str> + Clone + use<'a> {
        self.text.split(separates).filter(|word| !word.is_empty())
    }

    pub(super) fn place(&self) -> Place {
        self.line.place()
    }
}

/// The lines that hold anything, without comments.
pub(super) fn rows(text: &str) -> impl Iterator<Item = Row<'_>> + Clone {
    lines(text).filter_map(|line| {
        let text = line.text.split('#').next().unwrap_or("");
        let row = Row { line, text };
        row.words().next().is_some().then_some(row)
    })
}

/// A number, or infinity; None of anything else.
pub(super) fn value(word: &str) -> Option<f64> {
    number(word).filter(|value| !value.is_nan())
}
