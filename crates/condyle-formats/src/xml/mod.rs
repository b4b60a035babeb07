//! XML as the model formats use it: elements by name, numbers in text, no document types.
//!
//! A thin tree over [`roxmltree`], which does the parsing. It owns its text, is flat in memory,
//! and rejects what no model needs: document type declarations, more than [`MAX_DEPTH`] nested
//! elements, more than [`MAX_NODES`] nodes, more than 512 MiB. Names are without their prefix.
//!
//! Files that are nearly XML are repaired first, with a warning for each repair: colons in names
//! with an undeclared prefix become `_` (`HuntCrossleyForce::ContactParametersSet` is read as
//! `HuntCrossleyForce__ContactParametersSet`, without a word), bare ampersands stand for themselves,
//! control characters are spaces, and whatever precedes `<?xml`, comments that hold `--` and whatever
//! follows the outermost element are skipped.
//!
//! ```
//! use condyle_formats::XmlDocument;
//! let text = "<Body name=\"tibia_r\"><mass>3.7</mass><mass_center>0 -0.18 0</mass_center></Body>";
//! let body = XmlDocument::parse(text)?.value;
//! let body = body.root();
//! assert_eq!(body.attribute("name"), Some("tibia_r"));
//! assert_eq!(body.child_f64("mass")?, Some(3.7));
//! assert_eq!(body.require("mass_center")?.numbers::<3>()?, [0.0, -0.18, 0.0]);
//! # Ok::<(), condyle_formats::Error>(())
//! ```

#[cfg(feature = "opensim")]
pub(crate) mod edit;
mod element;
mod repair;

pub use element::Element;

use crate::text::{check_size, decode, last_line};
use condyle_diagnostics::{Error, Place, Read, Warnings};
use repair::{AMPERSAND, Places, repair};

/// How deep elements may be nested.
pub const MAX_DEPTH: usize = 256;
/// How many nodes (elements, texts and comments) a document may have.
pub const MAX_NODES: u32 = 2_000_000;
/// How many names one start tag may hold.
const MAX_ATTRIBUTES: usize = 1000;
/// How many namespace prefixes may be in scope.
const MAX_PREFIXES: usize = 64;
/// The parent of the root, and the sibling of the last child.
const NONE: u32 = u32::MAX;

/// A parsed document.
#[derive(Debug, Clone)]
pub struct XmlDocument {
    /// In document order; the root element comes first.
    nodes: Vec<Node>,
    attributes: Vec<(Span, Span)>,
    /// All names, values and texts, one after another.
    heap: String,
}

#[derive(Debug, Clone)]
struct Node {
    name: Span,
    /// The element's own text, trimmed; without that of its children and comments.
    text: Span,
    attributes: (u32, u32),
    parent: u32,
    first_child: u32,
    last_child: u32,
    next: u32,
    line: u32,
    column: u32,
    byte: u64,
    /// How many bytes it takes in the text.
    #[cfg(feature = "opensim")]
    length: u32,
}

/// A part of the heap.
#[derive(Debug, Clone, Copy, Default)]
struct Span {
    start: u32,
    end: u32,
}

impl XmlDocument {
    /// Parses a text, after the repairs listed in [the module](self).
    ///
    /// # Errors
    ///
    /// `xml/syntax` with line and column, `xml/dtd`, `xml/depth`, `xml/attributes`,
    /// `xml/prefixes`, `xml/nodes`, `text/size`.
    pub fn parse(text: &str) -> Result<Read<Self>, Error> {
        check_size(text.len())?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut warnings = Warnings::default();
        let text = repair(text, &mut warnings)?;
        let options = roxmltree::ParsingOptions {
            allow_dtd: false,
            nodes_limit: MAX_NODES,
            ..Default::default()
        };
        let parsed = roxmltree::Document::parse_with_options(&text, options)
            .map_err(|e| explain(&e, &text))?;
        Ok(Read { value: Self::copy(&parsed)?, warnings: warnings.finish() })
    }

    /// Decodes and parses bytes; see [`crate::text::decode`]. UTF-16 is recognised without a byte order
    /// mark too, by its first `<`.
    ///
    /// # Errors
    ///
    /// As [`XmlDocument::parse`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Read<Self>, Error> {
        let text = text_of(bytes)?;
        let mut read = Self::parse(&text.value)?;
        read.warnings.splice(0..0, text.warnings);
        Ok(read)
    }

    /// The outermost element.
    #[must_use]
    pub fn root(&self) -> Element<'_> {
        Element::new(self, 0)
    }

    /// How many elements there are.
    #[must_use]
    pub fn elements(&self) -> usize {
        self.nodes.len()
    }

    /// Copies the parser's tree in document order, without recursion.
    fn copy(parsed: &roxmltree::Document<'_>) -> Result<Self, Error> {
        let mut document = Self { nodes: Vec::new(), attributes: Vec::new(), heap: String::new() };
        let mut places = Places::new(parsed.input_text());
        // The elements that are open at the current node: (parser's node, ours).
        let mut open: Vec<(roxmltree::NodeId, u32)> = Vec::new();
        for node in parsed.root_element().descendants().filter(roxmltree::Node::is_element) {
            let parent_id = node.parent().map(|p| p.id());
            while open.last().is_some_and(|(id, _)| Some(*id) != parent_id) {
                open.pop();
            }
            let parent = open.last().map_or(NONE, |(_, ours)| *ours);
            let index = u32::try_from(document.nodes.len()).unwrap_or(NONE);
            open.push((node.id(), index));
            let place = places.at(node.range().start);
            if open.len() > MAX_DEPTH {
                return Err(Error::new("xml/depth", "elements are nested too deep").at(place));
            }
            document.push(node, parent, index, place);
        }
        Ok(document)
    }

    fn push(&mut self, node: roxmltree::Node<'_, '_>, parent: u32, index: u32, place: Place) {
        let mut own = String::new();
        for text in node.children().filter(roxmltree::Node::is_text).filter_map(|t| t.text()) {
            own.push_str(text);
            own.push(' ');
        }
        let attributes = node.attributes().map(|a| (a.name(), a.value()));
        self.append(node.tag_name().name(), own.trim(), attributes, parent, index, place);
        #[cfg(feature = "opensim")]
        if let Some(own) = self.nodes.last_mut() {
            own.length = u32::try_from(node.range().len()).unwrap_or(0);
        }
    }

    /// This document with what stands inside elements of others put first into some of its own. The
    /// places of what is put in are those of the element that received it.
    #[cfg(feature = "opensim")]
    pub(crate) fn with_inserted(&self, inserted: &[(Element<'_>, Element<'_>)]) -> Self {
        let mut whole = Self { nodes: Vec::new(), attributes: Vec::new(), heap: String::new() };
        let mut copy = |from: Element<'_>, parent: u32, place: Place| -> u32 {
            let index = u32::try_from(whole.nodes.len()).unwrap_or(NONE);
            whole.append(from.name(), from.text(), from.attributes(), parent, index, place);
            index
        };
        // Where each element of a document went.
        let parent = |went: &[u32], first: u32, e: Element<'_>| {
            let parent = e.parent().map(|p| p.number().wrapping_sub(first) as usize);
            parent.and_then(|p| went.get(p)).copied().unwrap_or(NONE)
        };
        let mut went: Vec<u32> = Vec::with_capacity(self.nodes.len());
        for own in self.root().descendants() {
            let mother = parent(&went, 0, own);
            went.push(copy(own, mother, own.place()));
            for (host, guest) in inserted.iter().filter(|(host, _)| *host == own) {
                let mut there = vec![*went.last().unwrap_or(&NONE)];
                for e in guest.descendants().skip(1) {
                    let mother = parent(&there, guest.number(), e);
                    there.push(copy(e, mother, host.place()));
                }
            }
        }
        whole
    }

    fn append<'t>(
        &mut self,
        name: &str,
        text: &str,
        attributes: impl Iterator<Item = (&'t str, &'t str)>,
        parent: u32,
        index: u32,
        place: Place,
    ) {
        let first = self.attributes.len() as u32;
        for (name, value) in attributes {
            let pair = (self.keep(name), self.keep(value));
            self.attributes.push(pair);
        }
        let attributes = (first, self.attributes.len() as u32);
        let (name, text) = (self.keep(name), self.keep(text));
        self.nodes.push(Node {
            name,
            text,
            attributes,
            parent,
            first_child: NONE,
            last_child: NONE,
            next: NONE,
            line: u32::try_from(place.line).unwrap_or(0),
            column: u32::try_from(place.column).unwrap_or(0),
            byte: place.byte.unwrap_or_default(),
            #[cfg(feature = "opensim")]
            length: 0,
        });
        let Some(mother) = self.nodes.get_mut(parent as usize) else { return };
        let before = mother.last_child;
        mother.last_child = index;
        if before == NONE {
            mother.first_child = index;
        } else if let Some(sister) = self.nodes.get_mut(before as usize) {
            sister.next = index;
        }
    }

    /// Appends a text to the heap. The heap is smaller than the document, which is limited far
    /// below 4 GiB; a span that would not fit is empty.
    fn keep(&mut self, text: &str) -> Span {
        let start = u32::try_from(self.heap.len());
        let end = u32::try_from(self.heap.len() + text.len());
        let (Ok(start), Ok(end)) = (start, end) else { return Span::default() };
        for (index, part) in text.split(AMPERSAND).enumerate() {
            if index > 0 {
                self.heap.push('&');
            }
            self.heap.push_str(part);
        }
        Span { start, end }
    }

    fn slice(&self, span: Span) -> &str {
        self.heap.get(span.start as usize..span.end as usize).unwrap_or_default()
    }
}

/// The text of a file, as [`XmlDocument::from_bytes`] decodes it.
pub(crate) fn text_of(bytes: &[u8]) -> Result<Read<std::borrow::Cow<'_, str>>, Error> {
    let marked = match bytes {
        [b'<', 0, ..] => Some([b"\xff\xfe", bytes].concat()),
        [0, b'<', ..] => Some([b"\xfe\xff", bytes].concat()),
        _ => None,
    };
    let mut text = match &marked {
        Some(marked) => decode(marked)?.map(|text| std::borrow::Cow::Owned(text.into_owned())),
        None => decode(bytes)?,
    };
    // A file that declares Latin-1 was read correctly: no warning.
    let head: String = text.value.chars().take(200).collect::<String>().to_lowercase();
    if head.contains("encoding=\"iso-8859-1\"") || head.contains("encoding=\"windows-1252\"") {
        text.warnings.clear();
    }
    Ok(text)
}

/// The parser's error with the wording and places of this crate.
fn explain(error: &roxmltree::Error, text: &str) -> Error {
    let position = error.pos();
    let sentence = error.to_string();
    let message = sentence.split(" at ").next().unwrap_or_default().trim().to_owned();
    let place = Place::at(position.row as usize, position.col as usize);
    match error {
        roxmltree::Error::NodesLimitReached => {
            Error::new("xml/nodes", format!("the document has more than {MAX_NODES} nodes"))
                .at(Place::at_line(1))
                .with_help("no model or setup file needs that; is the file damaged?")
        }
        roxmltree::Error::DtdDetected => {
            Error::new("xml/dtd", "the file has a document type declaration")
                .with_help("remove `<!DOCTYPE ...>`; entities are not expanded")
        }
        roxmltree::Error::UnexpectedCloseTag(expected, found, _) => {
            Error::new("xml/syntax", format!("`</{found}>` closes what `<{expected}>` opened"))
                .at(place)
                .with_help(format!(
                    "write `</{expected}>`, or look for a tag that was never closed"
                ))
        }
        roxmltree::Error::UnclosedRootNode => {
            Error::new("xml/syntax", "the outermost element is never closed")
                .at(last_line(text))
                .with_help("the file ends here; was it cut off?")
        }
        roxmltree::Error::NoRootNode => Error::new("xml/syntax", "there is no element")
            .at(Place::at_line(1))
            .with_help("this is not an XML file"),
        // The parser gives no place for the end of the text.
        roxmltree::Error::UnexpectedEndOfStream => {
            Error::new("xml/syntax", "the text ends inside a tag")
                .at(last_line(text))
                .with_help("the file ends here; was it cut off?")
        }
        _ => Error::new("xml/syntax", message)
            .at(place)
            .with_help("this is not well-formed XML; is the file damaged or cut off?"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_those_of_the_file() {
        let read = XmlDocument::parse("\n<?xml version='1.0'?>\r\n<a>\r\n  é<b/></a>").unwrap();
        assert!(read.warned("xml/before-declaration"));
        let b = read.value.root().child("b").unwrap().place();
        assert_eq!((b.line, b.column), (4, 4));
    }

    #[test]
    fn a_repaired_name_is_found() {
        let read = XmlDocument::parse("<a><H::P><x>1</x></H::P></a>").unwrap();
        assert!(read.warnings.is_empty(), "{:?}", read.warnings);
        let inner = read.value.root().child("H__P").unwrap();
        assert_eq!(inner.child_f64("x").unwrap(), Some(1.0));
    }

    #[test]
    fn errors_have_places_and_remedies() {
        let error = XmlDocument::parse("<a>\n <b></c></a>").unwrap_err();
        assert_eq!(
            error.to_string(),
            "line 2, column 5: `</c>` closes what `<b>` opened \
             (write `</b>`, or look for a tag that was never closed)"
        );
        for (text, code) in [
            ("", "xml/syntax"),
            ("no markup", "xml/syntax"),
            ("<a>", "xml/syntax"),
            ("<!DOCTYPE a [<!ENTITY l \"l\">]><a>&l;</a>", "xml/dtd"),
            ("<!DOCTYPE a><a/>", "xml/dtd"),
        ] {
            assert_eq!(XmlDocument::parse(text).unwrap_err().code(), code, "{text}");
        }
    }

    #[test]
    fn bare_ampersands_are_read_as_they_stand() {
        let read = XmlDocument::parse("<a n='R&D'>S&J &amp; &lol;</a>").unwrap();
        assert_eq!(read.value.root().attribute("n"), Some("R&D"));
        assert_eq!(read.value.root().text(), "S&J & &lol;");
        assert_eq!(read.warnings.len(), 1);
    }

    #[test]
    fn elements_of_another_document_are_put_in() {
        let own = XmlDocument::parse("<a>\n<s file='x'><z/></s><t/></a>").unwrap().value;
        let other = XmlDocument::parse("<o><s n='1'><p><q>5</q></p><r/></s></o>").unwrap().value;
        let host = own.root().child("s").unwrap();
        let whole = own.with_inserted(&[(host, other.root().child("s").unwrap())]);
        let names: Vec<_> = whole.root().descendants().map(|e| e.name().to_owned()).collect();
        assert_eq!(names, ["a", "s", "p", "q", "r", "z", "t"]);
        let set = whole.root().child("s").unwrap();
        assert_eq!(set.children().map(Element::name).collect::<Vec<_>>(), ["p", "r", "z"]);
        let q = set.find(&["p", "q"]).unwrap();
        assert_eq!((q.text(), q.place().line), ("5", 2));
        assert_eq!(q.parent().unwrap().parent(), Some(set));
    }

    #[test]
    fn half_a_million_open_tags_are_refused() {
        let error = XmlDocument::parse(&"<a>".repeat(500_000)).unwrap_err();
        assert_eq!(error.code(), "xml/depth");
    }

    #[test]
    fn utf_16_needs_no_mark() {
        let text: Vec<u16> = "<a>é</a>".encode_utf16().collect();
        let little: Vec<u8> = text.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let big: Vec<u8> = text.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        for bytes in [little, big] {
            assert_eq!(XmlDocument::from_bytes(&bytes).unwrap().value.root().text(), "é");
        }
    }

    #[test]
    fn latin_1_is_read_as_declared() {
        let read =
            XmlDocument::from_bytes(b"<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><a>\xe9</a>")
                .unwrap();
        assert_eq!(read.value.root().text(), "é");
        assert!(read.warnings.is_empty());
        assert!(XmlDocument::from_bytes(b"<a>\xe9</a>").unwrap().warned("text/encoding"));
    }
}
