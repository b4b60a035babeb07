//! What is said to people.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::Write as _;

/// Writes a line to standard error; where that is closed or full nobody can be told.
pub(crate) fn say(text: &str) {
    let line = format!("{}\n", shown(text));
    let _ = std::io::stderr().write_all(line.as_bytes());
}

/// A text that moves no cursor and changes no colour: names from files may hold anything.
///
/// Control characters other than line ends and tabs, and those that turn the direction of writing, are
/// shown as `\u{1b}`.
pub(crate) fn shown(text: &str) -> Cow<'_, str> {
    let harmful = |c: char| match c {
        '\n' | '\t' => false,
        '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        c => c.is_control(),
    };
    if !text.contains(harmful) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        // Writing to a string cannot fail.
        let _ = match harmful(c) {
            true => write!(shown, "{}", c.escape_unicode()),
            false => shown.write_char(c),
        };
    }
    Cow::Owned(shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_moves_the_cursor_is_escaped() {
        assert_eq!(shown("knee\t40°\nhip"), "knee\t40°\nhip");
        assert_eq!(shown("a\u{1b}[31mb\r\u{7f}\u{9b}"), r"a\u{1b}[31mb\u{d}\u{7f}\u{9b}");
        assert_eq!(shown("a\u{202e}b"), r"a\u{202e}b");
    }
}
