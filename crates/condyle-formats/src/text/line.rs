//! Lines that end with LF, CR LF or a lone CR.

use condyle_diagnostics::Place;

/// What stands behind the last line of some files: NUL, and the end-of-file sign of DOS.
const PADDING: [char; 2] = ['\0', '\u{1a}'];

/// One line without its end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line<'a> {
    /// Counted from 1.
    pub(crate) number: usize,
    /// Offset of the first byte in the text.
    pub(crate) start: usize,
    pub(crate) text: &'a str,
}

impl<'a> Line<'a> {
    /// The place of a part of this line; `part` must be a slice of its text.
    pub(crate) fn place_of(&self, part: &str) -> Place {
        let offset = (part.as_ptr() as usize).wrapping_sub(self.text.as_ptr() as usize);
        let column = column_at(self.text, offset);
        Place {
            line: self.number,
            column,
            byte: (column > 0).then_some((self.start + offset) as u64),
        }
    }

    /// The place of the line as a whole.
    pub(crate) fn place(&self) -> Place {
        Place { line: self.number, column: 0, byte: Some(self.start as u64) }
    }

    /// Whether there is nothing but space and what old programs pad files with.
    pub(crate) fn is_blank(&self) -> bool {
        self.text.trim_matches(|c: char| c.is_whitespace() || PADDING.contains(&c)).is_empty()
    }
}

/// The column, in characters counted from 1, of a byte offset in a line; 0 if it is not in it.
pub(crate) fn column_at(line: &str, offset: usize) -> usize {
    line.get(..offset).map_or(0, |before| before.chars().count() + 1)
}

/// The lines of a text from some place on.
#[derive(Debug, Clone)]
pub(crate) struct Lines<'a> {
    /// Without padding at its end.
    text: &'a str,
    start: usize,
    number: usize,
}

impl<'a> Lines<'a> {
    /// From a line of this text on.
    pub(crate) fn from_line(text: &'a str, line: Line<'_>) -> Self {
        let text = text.trim_end_matches(PADDING);
        Self { text, start: line.start, number: line.number.saturating_sub(1) }
    }

    /// The text, and where in it the next line starts.
    pub(crate) fn rest(&self) -> (&'a str, usize) {
        (self.text, self.start)
    }

    /// Leaves out the next line, which ends here with its line end.
    pub(crate) fn skip_to(&mut self, end: usize) {
        self.start = end;
        self.number += 1;
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let rest = self.text.get(self.start..).filter(|rest| !rest.is_empty())?;
        let end = line_end(rest.as_bytes());
        let (body, tail) = rest.split_at(end);
        self.number += 1;
        let line = Line { number: self.number, start: self.start, text: body };
        let ending = match tail.as_bytes() {
            [b'\r', b'\n', ..] => 2,
            [] => 0,
            _ => 1,
        };
        self.start += end + ending;
        Some(line)
    }
}

/// Where a line ends: 32 bytes at once.
fn line_end(bytes: &[u8]) -> usize {
    let is_end = |b: &u8| *b == b'\n' || *b == b'\r';
    let (blocks, _) = bytes.as_chunks::<32>();
    let whole = blocks
        .iter()
        .position(|block| block.iter().fold(false, |found, b| found | is_end(b)))
        .unwrap_or(blocks.len());
    let start = 32 * whole;
    let rest = bytes.get(start..).unwrap_or_default();
    start + rest.iter().position(is_end).unwrap_or(rest.len())
}

/// The lines of a text, without a leading byte order mark and padding at its end.
pub(crate) fn lines(text: &str) -> Lines<'_> {
    let text = text.trim_end_matches(PADDING);
    let start = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    Lines { text, start, number: 0 }
}

/// The place of the last line that is not blank: where an incomplete file ends.
pub(crate) fn last_line(text: &str) -> Place {
    let end = text.trim_end().len();
    Place::at_line(lines(&text[..end]).last().map_or(1, |line| line.number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_line_end() {
        let found: Vec<_> =
            lines("\u{feff}a\r\nb\rc\n\nd").map(|l| (l.number, l.start, l.text)).collect();
        assert_eq!(found, [(1, 3, "a"), (2, 6, "b"), (3, 8, "c"), (4, 10, ""), (5, 11, "d")]);
        assert_eq!(lines("").count(), 0);
        assert_eq!(lines("a\n").count(), 1);
        assert_eq!(lines("a\nb\u{1a}\0\0").last().unwrap().text, "b");
        assert!(lines("a\n\u{1a}\n").last().unwrap().is_blank());
        assert_eq!(last_line("a\r\nb\n \n"), Place::at_line(2));
        assert_eq!(last_line(" "), Place::at_line(1));
    }

    #[test]
    fn columns_count_characters() {
        let line = lines("é\tabc").next().unwrap();
        assert_eq!(line.place_of(&line.text[3..]), Place { line: 1, column: 3, byte: Some(3) });
    }
}
