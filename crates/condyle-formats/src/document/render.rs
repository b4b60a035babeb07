//! Diagnostics shown with their line of the text and a caret.

use condyle_diagnostics::Diagnostic;
use std::fmt::Write;

/// How many characters of a line are shown.
const WIDTH: usize = 100;

/// Each diagnostic as `name:line:column: message`, its line of the text, a caret and its help.
///
/// ```
/// use condyle_formats::{Diagnostic, Place, document};
/// let said = Diagnostic::error("x/y", "unknown key `parnet`").at(Place::at(1, 1));
/// let shown = document::render("leg.toml", "parnet = 1", &[said.with_help("did you mean `parent`?")]);
/// assert_eq!(shown, "leg.toml:1:1: unknown key `parnet`
///   |
/// 1 | parnet = 1
///   | ^^^^^^ did you mean `parent`?
/// ");
/// ```
#[must_use]
pub fn render(name: &str, text: &str, said: &[Diagnostic]) -> String {
    let mut out = String::new();
    for one in said {
        let help = one.help.as_str();
        let place = one.place.filter(|p| p.line > 0);
        let Some(place) = place else {
            let _ = writeln!(out, "{name}: {}", plain(&one.sentence()));
            continue;
        };
        let column = place.column.max(1);
        let _ = writeln!(out, "{name}:{}:{column}: {}", place.line, plain(&one.message));
        let line = text.lines().nth(place.line - 1).unwrap_or_default();
        // A long line is cut around the place.
        let first = (column - 1).saturating_sub(WIDTH * 3 / 4);
        let shown: String = line.chars().skip(first).take(WIDTH).collect();
        let caret = column - 1 - first;
        let number = place.line.to_string();
        let margin = " ".repeat(number.len());
        let marks = "^".repeat(word(&shown, caret));
        let _ = writeln!(out, "{margin} |");
        let _ = writeln!(out, "{number} | {}", plain(&shown));
        let mark = format!("{margin} | {}{marks} {}", " ".repeat(caret), plain(help));
        let _ = writeln!(out, "{}", mark.trim_end());
    }
    out
}

/// The length of what stands at a column: a string, a word, or one character.
fn word(line: &str, column: usize) -> usize {
    let mut letters = line.chars().skip(column);
    match letters.next() {
        Some(quote @ ('"' | '\'')) => {
            let mut count = 1;
            for letter in letters {
                count += 1;
                if letter == quote {
                    break;
                }
            }
            count
        }
        Some(letter) if letter.is_alphanumeric() || "_-+$".contains(letter) => {
            // A dot belongs to a number, but separates the parts of a key.
            let marks = if letter.is_alphabetic() || letter == '_' { "_-" } else { "_-+." };
            let part = |c: &char| c.is_alphanumeric() || marks.contains(*c);
            1 + letters.take_while(part).count()
        }
        _ => 1,
    }
}

/// The text without control characters, which could move a terminal's cursor.
fn plain(text: &str) -> String {
    let shown = |c: char| match c {
        '\t' => ' ',
        c if c.is_control() => '\u{fffd}',
        c => c,
    };
    text.chars().map(shown).collect()
}
