//! One pass over a text before it is parsed: size limits are checked, and common violations of the
//! XML grammar are repaired.
//!
//! Repairs keep the position of every byte, so that places in messages are places in the file:
//!
//! - a colon in a name with an undeclared prefix becomes `_`; where it is doubled
//!   (`<HuntCrossleyForce::ContactParametersSet>`, in 9 of 60 official OpenSim models) without a word;
//! - whatever precedes `<?xml`, and that declaration itself, becomes spaces;
//! - a comment that holds `--` becomes spaces, and so does a closing tag without an opening one
//!   (OpenSim's own task sets end with a stray `</OpenSimDocument>`), and whatever else follows the
//!   outermost element;
//! - an ampersand that begins no entity (`R&D`, `&nbsp;`) stands for itself, a `<` that begins no tag
//!   (`a < b`) becomes a space;
//! - control characters, which XML forbids even when escaped, become spaces.

use std::borrow::Cow;
use std::ops::Range;

use super::{MAX_ATTRIBUTES, MAX_DEPTH, MAX_PREFIXES};
use crate::text::column_at;
use condyle_diagnostics::{Diagnostic, Error, Place, Warnings};

/// Stands for a bare ampersand in a repaired text: one byte, and allowed by the parser.
pub(super) const AMPERSAND: char = '\u{7f}';

/// The text in a form that a namespace-aware parser accepts, with [`AMPERSAND`] for bare ones.
pub(super) fn repair<'a>(text: &'a str, warnings: &mut Warnings) -> Result<Cow<'a, str>, Error> {
    let clean = without_controls(text, warnings);
    let mut scan = Scan::new(&clean);
    scan.run()?;
    let Scan { colons, blanks, ampersands, .. } = scan;
    if colons.is_empty() && blanks.is_empty() && ampersands.is_empty() {
        return Ok(clean);
    }
    let text: &str = &clean;
    let mut bytes = text.as_bytes().to_vec();
    if let Some(&first) = ampersands.first() {
        warnings.add("xml/ampersand", || {
            let said = format!("`&` begins no entity here ({} such in the file)", ampersands.len());
            let said = Diagnostic::warning("xml/ampersand", said).at(place_at(text, first));
            said.with_help("it is read as it stands; XML wants `&amp;`")
        });
    }
    for &at in &ampersands {
        if let Some(byte) = bytes.get_mut(at) {
            *byte = AMPERSAND as u8;
        }
    }
    for (range, blank) in &blanks {
        warnings.add(blank.code(), || blank.warning().at(place_at(text, range.start)));
        for byte in bytes.get_mut(range.clone()).unwrap_or_default() {
            if !matches!(*byte, b'\n' | b'\r') {
                *byte = b' ';
            }
        }
    }
    let mut places = Places::new(text);
    for name in &colons {
        let place = places.at(name.start);
        let written = text.get(name.clone()).unwrap_or_default();
        // OpenSim itself writes names of nested C++ classes.
        if !written.contains("::") {
            warnings.add("xml/prefix", || {
                Diagnostic::note("xml/prefix", format!("`{written}` has an undeclared prefix"))
                    .at(place)
                    .with_help(format!("read as `{}`", written.replace(':', "_")))
            });
        }
        for byte in bytes.get_mut(name.clone()).unwrap_or_default() {
            if *byte == b':' {
                *byte = b'_';
            }
        }
    }
    // Whole characters were replaced by ASCII, so this never fails.
    String::from_utf8(bytes)
        .map(Cow::Owned)
        .map_err(|_| Error::new("xml/encoding", "the text could not be repaired"))
}

/// The text with spaces for the characters that XML forbids.
fn without_controls<'a>(text: &'a str, warnings: &mut Warnings) -> Cow<'a, str> {
    let forbidden = |c: char| {
        matches!(c, '\0'..='\x08' | '\x0b' | '\x0c' | '\x0e'..='\x1f' | AMPERSAND)
            || matches!(c, '\u{fffe}' | '\u{ffff}')
    };
    let Some(first) = text.find(forbidden) else { return Cow::Borrowed(text) };
    let mut clean = String::with_capacity(text.len());
    let mut count = 0usize;
    for c in text.chars() {
        if forbidden(c) {
            clean.extend(std::iter::repeat_n(' ', c.len_utf8()));
            count += 1;
        } else {
            clean.push(c);
        }
    }
    warnings.add("xml/control", || {
        let plural = if count == 1 { "" } else { "s" };
        let said = format!("the file holds {count} control character{plural}");
        let said = Diagnostic::warning("xml/control", said).at(place_at(text, first));
        said.with_help("read as spaces; was it damaged, or padded by a copy?")
    });
    Cow::Owned(clean)
}

/// How many bytes of an entity start here: `&amp;`, `&#xe9;`; `None` if the ampersand is bare.
fn entity(rest: &str) -> Option<usize> {
    let end = rest.bytes().take(12).position(|b| b == b';')?;
    let name = rest.get(1..end)?;
    let known = match name.strip_prefix('#') {
        None => matches!(name, "amp" | "lt" | "gt" | "quot" | "apos"),
        Some(digits) => {
            let value = match digits.strip_prefix('x') {
                Some(hex) => u32::from_str_radix(hex, 16),
                None => digits.parse(),
            };
            let sign = digits.contains(['+', '-']);
            value.ok().and_then(char::from_u32).is_some_and(|c| {
                !sign
                    && (c >= ' ' || matches!(c, '\t' | '\n' | '\r'))
                    && !matches!(c, '\u{fffe}' | '\u{ffff}')
            })
        }
    };
    known.then_some(end + 1)
}

/// What is replaced by spaces.
#[derive(Debug, Clone, Copy)]
enum Blank {
    BeforeDeclaration,
    Declaration,
    Comment,
    StrayEnd,
    AfterEnd,
    Less,
}

impl Blank {
    fn code(self) -> &'static str {
        match self {
            Self::BeforeDeclaration | Self::Declaration => "xml/before-declaration",
            Self::AfterEnd => "xml/after-end",
            Self::Less => "xml/less",
            Self::Comment => "xml/comment",
            Self::StrayEnd => "xml/stray-end",
        }
    }

    fn warning(self) -> Diagnostic {
        let (message, help) = match self {
            Self::BeforeDeclaration => {
                ("the file does not start with `<?xml`", "the text before it was skipped")
            }
            Self::Declaration => {
                ("`<?xml` does not stand at the beginning", "the declaration was skipped")
            }
            Self::AfterEnd => (
                "something follows the end of the outermost element",
                "it was skipped; does the file hold two documents?",
            ),
            Self::Less => ("`<` begins no tag here", "read as a space; XML wants `&lt;`"),
            Self::Comment => ("a comment holds `--`", "the comment was skipped"),
            Self::StrayEnd => ("a closing tag closes nothing", "it was skipped"),
        };
        Diagnostic::warning(self.code(), message).with_help(help)
    }
}

/// Line and column of one byte offset, counted from the start of the text.
pub(super) fn place_at(text: &str, offset: usize) -> Place {
    Places::new(text).at(offset)
}

/// Lines and columns of rising offsets, found in one pass over the text.
pub(super) struct Places<'a> {
    text: &'a str,
    line: usize,
    line_start: usize,
    reached: usize,
}

impl<'a> Places<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, line: 1, line_start: 0, reached: 0 }
    }

    /// The place of an offset that is not before the previous one requested.
    pub(super) fn at(&mut self, offset: usize) -> Place {
        let bytes = self.text.as_bytes();
        while self.reached < offset {
            let Some(byte) = bytes.get(self.reached) else { break };
            let ends = match byte {
                b'\n' => true,
                b'\r' => bytes.get(self.reached + 1) != Some(&b'\n'),
                _ => false,
            };
            self.reached += 1;
            if ends {
                self.line += 1;
                self.line_start = self.reached;
            }
        }
        // Counting the characters of a model on a single line would take quadratic time: beyond
        // this width, columns are counted in bytes.
        let width = offset.saturating_sub(self.line_start);
        let column = if width > 4096 {
            width + 1
        } else {
            self.text.get(self.line_start..).map_or(0, |line| column_at(line, width))
        };
        Place { line: self.line, column, byte: Some(offset as u64) }
    }
}

/// The results of one pass over the markup.
struct Scan<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    /// Prefixes in scope, each with the depth of the element that declared it.
    prefixes: Vec<(usize, &'a str)>,
    /// Names whose colons must be replaced.
    colons: Vec<Range<usize>>,
    blanks: Vec<(Range<usize>, Blank)>,
    /// Where bare ampersands are.
    ampersands: Vec<usize>,
    /// Where the outermost element ends.
    end: Option<usize>,
}

impl<'a> Scan<'a> {
    fn new(text: &'a str) -> Self {
        let (colons, blanks, prefixes) = (Vec::new(), Vec::new(), Vec::new());
        Self { text, at: 0, depth: 0, prefixes, colons, blanks, ampersands: vec![], end: None }
    }

    /// Walks from tag to tag. Broken markup ends the walk: the parser reports the error.
    fn run(&mut self) -> Result<(), Error> {
        self.declaration();
        while let Some(found) = self.text.get(self.at..).and_then(|rest| rest.find('<')) {
            self.ampersands_in(self.at..self.at + found);
            if self.end.is_some_and(|end| self.junk_from(end, self.at + found)) {
                return Ok(());
            }
            self.at += found;
            let rest = &self.text[self.at..];
            let known = if rest.starts_with("<!--") {
                let start = self.at;
                let whole = self.skip_past(4, "-->");
                let inside = self.text.get(start + 4..self.at.saturating_sub(3));
                if whole && inside.is_some_and(|c| c.contains("--") || c.ends_with('-')) {
                    self.blanks.push((start..self.at, Blank::Comment));
                }
                whole
            } else if rest.starts_with("<![CDATA[") {
                self.skip_past(9, "]]>")
            } else if rest.starts_with("<?") {
                let start = self.at;
                let whole = self.skip_past(2, "?>");
                let declares =
                    rest.strip_prefix("<?xml").is_some_and(|r| r.starts_with([' ', '\t']));
                if whole && declares && start > 0 {
                    self.blanks.push((start..self.at, Blank::Declaration));
                }
                whole
            } else if rest.starts_with("<!") {
                return Err(Error::new("xml/dtd", "the file has a document type declaration")
                    .at(place_at(self.text, self.at))
                    .with_help("remove `<!DOCTYPE ...>`; entities are not expanded"));
            } else if rest.starts_with("</") {
                self.end_tag()
            } else if self.depth > 0 && !rest[1..].starts_with(is_name_start) {
                self.blanks.push((self.at..self.at + 1, Blank::Less));
                self.at += 1;
                true
            } else {
                self.start_tag()?
            };
            if !known {
                return Ok(());
            }
        }
        if let Some(end) = self.end {
            self.junk_from(end, self.text.len());
        }
        Ok(())
    }

    /// Records the bare ampersands of a text or of a value.
    fn ampersands_in(&mut self, range: Range<usize>) {
        let Some(text) = self.text.get(range.clone()) else { return };
        let bare = text.match_indices('&').filter(|(at, _)| entity(&text[*at..]).is_none());
        self.ampersands.extend(bare.map(|(at, _)| range.start + at));
    }

    /// Whether something other than space, comments, instructions and closing tags follows the
    /// outermost element before `to`, or begins there; all that follows is then blanked.
    fn junk_from(&mut self, end: usize, to: usize) -> bool {
        let between = self.text.get(self.at.max(end)..to).unwrap_or_default();
        let markup = self.text.get(to..).unwrap_or_default();
        let element =
            markup.strip_prefix('<').is_some_and(|rest| !rest.starts_with(['!', '?', '/']));
        if between.trim().is_empty() && !element {
            return false;
        }
        let start = self.at.max(end);
        let skipped = self.text.get(start..).unwrap_or_default();
        let start = start + (skipped.len() - skipped.trim_start().len());
        self.ampersands.retain(|at| *at < start);
        self.blanks.push((start..self.text.len(), Blank::AfterEnd));
        true
    }

    /// If anything precedes `<?xml`, replaces it and the declaration by spaces.
    fn declaration(&mut self) {
        let before = |found: usize| self.text.get(..found).unwrap_or_default();
        let Some(found) = self.text.find("<?xml").filter(|f| *f > 0) else { return };
        if before(found).contains('<') {
            return;
        }
        if let Some(end) = self.text[found..].find("?>") {
            self.blanks.push((0..found + end + 2, Blank::BeforeDeclaration));
            self.at = found + end + 2;
        }
    }

    fn skip_past(&mut self, opening: usize, closing: &str) -> bool {
        let from = self.at + opening;
        match self.text.get(from..).and_then(|rest| rest.find(closing)) {
            Some(found) => {
                self.at = from + found + closing.len();
                true
            }
            None => false,
        }
    }

    fn byte(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn skip_while(&mut self, accept: impl Fn(u8) -> bool) -> Range<usize> {
        let start = self.at;
        while self.byte().is_some_and(&accept) {
            self.at += 1;
        }
        start..self.at
    }

    fn name(&mut self) -> Range<usize> {
        self.skip_while(|b| !matches!(b, b' ' | b'\t' | b'\r' | b'\n' | b'/' | b'>' | b'=' | b'<'))
    }

    fn space(&mut self) {
        self.skip_while(|b| matches!(b, b' ' | b'\t' | b'\r' | b'\n'));
    }

    /// Passes `<name a="b" c='d'>`; false if it is broken.
    fn start_tag(&mut self) -> Result<bool, Error> {
        let start = self.at;
        self.at += 1;
        self.depth += 1;
        let mut names = vec![self.name()];
        let closed = loop {
            self.space();
            match self.byte() {
                Some(b'>') => break false,
                Some(b'/') if self.text.as_bytes().get(self.at + 1) == Some(&b'>') => break true,
                None | Some(b'/' | b'<' | b'=') => return Ok(false),
                Some(_) => {}
            }
            let name = self.name();
            self.space();
            if self.byte() != Some(b'=') {
                return Ok(false);
            }
            self.at += 1;
            self.space();
            let Some(quote @ (b'"' | b'\'')) = self.byte() else { return Ok(false) };
            self.at += 1;
            let value = self.skip_while(|b| b != quote);
            let inside = self.text.get(value.clone()).unwrap_or_default();
            let less = inside.match_indices('<').map(|(at, _)| value.start + at);
            self.blanks.extend(less.map(|at| (at..at + 1, Blank::Less)));
            self.ampersands_in(value);
            if self.byte().is_none() {
                return Ok(false);
            }
            self.at += 1;
            if let Some(prefix) = self.text.get(name.clone()).and_then(|n| n.strip_prefix("xmlns:"))
                && !prefix.is_empty()
            {
                self.prefixes.push((self.depth, prefix));
            }
            names.push(name);
            self.check_bounds(start, names.len())?;
        };
        self.check_bounds(start, names.len())?;
        for (index, name) in names.into_iter().enumerate() {
            self.judge(name, index > 0);
        }
        self.at += if closed { 2 } else { 1 };
        if closed {
            self.leave();
        }
        Ok(true)
    }

    /// Passes `</name>`; false if it is broken.
    fn end_tag(&mut self) -> bool {
        let start = self.at;
        self.at += 2;
        let name = self.name();
        self.space();
        if self.byte() != Some(b'>') {
            return false;
        }
        self.at += 1;
        if self.depth == 0 {
            self.blanks.push((start..self.at, Blank::StrayEnd));
        } else {
            self.judge(name, false);
            self.leave();
        }
        true
    }

    fn leave(&mut self) {
        while self.prefixes.last().is_some_and(|(depth, _)| *depth >= self.depth) {
            self.prefixes.pop();
        }
        self.depth = self.depth.saturating_sub(1);
        if self.depth == 0 && self.end.is_none() {
            self.end = Some(self.at);
        }
    }

    /// Records a name whose colons a namespace-aware parser would reject.
    fn judge(&mut self, name: Range<usize>, attribute: bool) {
        let Some(written) = self.text.get(name.clone()).filter(|n| n.contains(':')) else { return };
        let fine = match written.split_once(':') {
            Some((prefix, local)) if !local.is_empty() && !local.contains(':') => {
                prefix == "xml"
                    || (attribute && prefix == "xmlns")
                    || self.prefixes.iter().any(|(_, declared)| *declared == prefix)
            }
            _ => false,
        };
        if !fine {
            self.colons.push(name);
        }
    }

    fn check_bounds(&self, start: usize, names: usize) -> Result<(), Error> {
        let (code, message) = if self.depth > MAX_DEPTH {
            ("xml/depth", format!("elements are nested more than {MAX_DEPTH} deep"))
        } else if names > MAX_ATTRIBUTES {
            ("xml/attributes", format!("an element has more than {MAX_ATTRIBUTES} attributes"))
        } else if self.prefixes.len() > MAX_PREFIXES {
            ("xml/prefixes", format!("more than {MAX_PREFIXES} namespace prefixes are in scope"))
        } else {
            return Ok(());
        };
        Err(Error::new(code, message)
            .at(place_at(self.text, start))
            .with_help("no model or setup file needs that; is the file damaged?"))
    }
}

/// Whether a name may begin with it.
fn is_name_start(c: char) -> bool {
    c.is_alphabetic() || matches!(c, '_' | ':') || c as u32 > 0x7f
}

#[cfg(test)]
#[path = "repair_tests.rs"]
mod tests;
