//! Elements of a document: names, children, numbers.

use super::{NONE, Node, XmlDocument};
use crate::text::number;
use condyle_diagnostics::{Error, Place};

/// One element of a document; a copyable handle.
#[derive(Debug, Clone, Copy)]
pub struct Element<'d> {
    document: &'d XmlDocument,
    index: u32,
}

impl PartialEq for Element<'_> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.document, other.document) && self.index == other.index
    }
}

impl<'d> Element<'d> {
    pub(super) fn new(document: &'d XmlDocument, index: u32) -> Self {
        Self { document, index }
    }

    /// Its number in document order.
    #[cfg(feature = "opensim")]
    pub(crate) fn number(self) -> u32 {
        self.index
    }

    fn node(self) -> Option<&'d Node> {
        self.document.nodes.get(self.index as usize)
    }

    fn other(self, index: u32) -> Option<Self> {
        (index != NONE).then_some(Self { document: self.document, index })
    }

    /// The name without its prefix.
    #[must_use]
    pub fn name(self) -> &'d str {
        self.node().map_or("", |n| self.document.slice(n.name))
    }

    /// Whether this is the name, exactly.
    #[must_use]
    pub fn is(self, name: &str) -> bool {
        self.name() == name
    }

    /// Where the start tag begins.
    #[must_use]
    pub fn place(self) -> Place {
        self.node().map_or_else(Place::default, |n| Place {
            line: n.line as usize,
            column: n.column as usize,
            byte: Some(n.byte),
        })
    }

    /// The element as it is shown in messages: `<Body name="tibia_r">`.
    ///
    /// ```
    /// use condyle_formats::XmlDocument;
    /// let read = XmlDocument::parse("<Body name='t'><mass/></Body>")?;
    /// assert_eq!(read.value.root().describe(), "<Body name=\"t\">");
    /// # Ok::<(), condyle_formats::Error>(())
    /// ```
    #[must_use]
    pub fn describe(self) -> String {
        match self.attribute("name") {
            Some(name) => format!("<{} name=\"{name}\">", self.name()),
            None => format!("<{}>", self.name()),
        }
    }

    /// The bytes that it takes in the text it was parsed from; none of one that was put in.
    #[cfg(feature = "opensim")]
    pub(crate) fn span(self) -> std::ops::Range<usize> {
        let node = self.node();
        let start = node.map_or(0, |n| usize::try_from(n.byte).unwrap_or(0));
        start..start + node.map_or(0, |n| n.length as usize)
    }

    /// An error about this element, at its place.
    #[must_use]
    pub fn error(self, code: &'static str, message: impl Into<String>) -> Error {
        Error::new(code, message).at(self.place())
    }

    /// The element around this one; `None` for the root.
    #[must_use]
    pub fn parent(self) -> Option<Self> {
        self.node().and_then(|n| self.other(n.parent))
    }

    /// The elements directly inside, in order.
    pub fn children(self) -> impl Iterator<Item = Element<'d>> + Clone {
        let mut next = self.node().and_then(|n| self.other(n.first_child));
        std::iter::from_fn(move || {
            let current = next?;
            next = current.node().and_then(|n| current.other(n.next));
            Some(current)
        })
    }

    /// The elements directly inside that have this name.
    pub fn children_named<'n>(
        self,
        name: &'n str,
    ) -> impl Iterator<Item = Element<'d>> + Clone + use<'d, 'n> {
        self.children().filter(move |child| child.is(name))
    }

    /// The first element directly inside that has this name.
    #[must_use]
    pub fn child(self, name: &str) -> Option<Self> {
        self.children().find(|child| child.is(name))
    }

    /// This element and all inside it, in document order.
    pub fn descendants(self) -> impl Iterator<Item = Element<'d>> + Clone {
        // Elements are stored in document order, so a subtree is a run that ends where the next
        // element outside it begins.
        let mut end = self.document.nodes.len() as u32;
        let mut outer = Some(self);
        while let Some(node) = outer.and_then(Self::node) {
            if node.next != NONE {
                end = node.next;
                break;
            }
            outer = self.other(node.parent);
        }
        (self.index..end).map(move |index| Element { document: self.document, index })
    }

    /// Follows child names downwards: `find(&["JointSet", "objects"])`.
    #[must_use]
    pub fn find(self, path: &[&str]) -> Option<Self> {
        path.iter().try_fold(self, |element, name| element.child(name))
    }

    /// The child of this name.
    ///
    /// # Errors
    ///
    /// `xml/missing-element`, naming this element.
    pub fn require(self, name: &str) -> Result<Self, Error> {
        self.child(name).ok_or_else(|| {
            self.error("xml/missing-element", format!("{} has no <{name}>", self.describe()))
        })
    }

    /// An attribute's value.
    #[must_use]
    pub fn attribute(self, name: &str) -> Option<&'d str> {
        self.attributes().find(|(n, _)| *n == name).map(|(_, value)| value)
    }

    /// Names and values of the attributes, in order.
    pub fn attributes(self) -> impl Iterator<Item = (&'d str, &'d str)> + Clone {
        let document = self.document;
        let (start, end) = self.node().map_or((0, 0), |n| n.attributes);
        let pairs = document.attributes.get(start as usize..end as usize).unwrap_or_default();
        pairs.iter().map(|(n, v)| (document.slice(*n), document.slice(*v)))
    }

    /// A required attribute that must not be blank, trimmed.
    ///
    /// # Errors
    ///
    /// `xml/missing-attribute`, naming this element.
    pub fn require_attribute(self, name: &str) -> Result<&'d str, Error> {
        self.attribute(name).map(str::trim).filter(|v| !v.is_empty()).ok_or_else(|| {
            self.error(
                "xml/missing-attribute",
                format!("{} has no attribute `{name}`", self.describe()),
            )
        })
    }

    /// The element's own text, trimmed; without that of its children and comments.
    #[must_use]
    pub fn text(self) -> &'d str {
        self.node().map_or("", |n| self.document.slice(n.text))
    }

    /// The text of a child; `None` if there is no such child or it is blank.
    #[must_use]
    pub fn child_text(self, name: &str) -> Option<&'d str> {
        self.child(name).map(Self::text).filter(|text| !text.is_empty())
    }

    /// The text as one number; see [`number`] for its spellings.
    ///
    /// # Errors
    ///
    /// `xml/number`, with element, text and what was expected.
    pub fn f64(self) -> Result<f64, Error> {
        number(self.text()).ok_or_else(|| self.expected("xml/number", "a number"))
    }

    /// The text as numbers separated by space, by commas or semicolons with space, or by those alone;
    /// brackets around them and the `~` that SimTK writes are allowed.
    ///
    /// # Errors
    ///
    /// `xml/number`, naming the part that is not a number; a comma that may be a decimal one is none
    /// that separates.
    ///
    /// ```
    /// use condyle_formats::XmlDocument;
    /// let read = XmlDocument::parse("<range>-1.5 1.#INF</range>")?;
    /// assert_eq!(read.value.root().f64s()?, [-1.5, f64::INFINITY]);
    /// let read = XmlDocument::parse("<location>~[0,-0.1, 0.03]</location>")?;
    /// assert_eq!(read.value.root().f64s()?, [0.0, -0.1, 0.03]);
    /// # Ok::<(), condyle_formats::Error>(())
    /// ```
    pub fn f64s(self) -> Result<Vec<f64>, Error> {
        let wrong = |part: &str, help: String| {
            let message = format!("`{}` in {} is not a number", clip(part), self.describe());
            self.error("xml/number", message).with_help(help)
        };
        let separated = "expected numbers separated by spaces";
        let mut numbers = vec![];
        for cell in unbracketed(self.text()).split_whitespace() {
            let parts = cell.trim_matches([',', ';']);
            if parts.is_empty() {
                continue;
            }
            if let Some(value) = number(parts) {
                numbers.push(value);
                continue;
            }
            // `0,5` is five tenths to many: only what cannot be one number is split.
            if parts.matches([',', ';']).count() == 1 && !parts.contains(['.', ';']) {
                let point = parts.replace(',', ".");
                return Err(match number(&point) {
                    Some(_) => {
                        wrong(parts, format!("write {point}: the decimal separator is a point"))
                    }
                    None => wrong(parts, separated.to_owned()),
                });
            }
            for part in parts.split([',', ';']) {
                numbers.push(number(part).ok_or_else(|| wrong(parts, separated.to_owned()))?);
            }
        }
        Ok(numbers)
    }

    /// The text as exactly `N` numbers.
    ///
    /// # Errors
    ///
    /// `xml/number`, or `xml/count` with the count expected and found.
    pub fn numbers<const N: usize>(self) -> Result<[f64; N], Error> {
        let found = self.f64s()?;
        <[f64; N]>::try_from(found).map_err(|found| {
            self.error("xml/count", format!("{} holds {} numbers", self.describe(), found.len()))
                .with_help(format!("expected {N}"))
        })
    }

    /// The text as a boolean: `true`, `false`, `1`, `0`, `yes` or `no`, in any case.
    ///
    /// # Errors
    ///
    /// `xml/bool`, with element, text and what was expected.
    pub fn bool(self) -> Result<bool, Error> {
        match self.text().to_ascii_lowercase().as_str() {
            "true" | "1" | "yes" => Ok(true),
            "false" | "0" | "no" => Ok(false),
            _ => Err(self.expected("xml/bool", "`true` or `false`")),
        }
    }

    /// A child's number; `None` if there is no such child or it is blank.
    ///
    /// # Errors
    ///
    /// As [`Element::f64`].
    pub fn child_f64(self, name: &str) -> Result<Option<f64>, Error> {
        self.filled(name).map(Self::f64).transpose()
    }

    /// A child's numbers; `None` if there is no such child or it is blank.
    ///
    /// # Errors
    ///
    /// As [`Element::numbers`].
    pub fn child_numbers<const N: usize>(self, name: &str) -> Result<Option<[f64; N]>, Error> {
        self.filled(name).map(Self::numbers).transpose()
    }

    /// A child's truth; `None` if there is no such child or it is blank.
    ///
    /// # Errors
    ///
    /// As [`Element::bool`].
    pub fn child_bool(self, name: &str) -> Result<Option<bool>, Error> {
        self.filled(name).map(Self::bool).transpose()
    }

    fn filled(self, name: &str) -> Option<Self> {
        self.child(name).filter(|child| !child.text().is_empty())
    }

    fn expected(self, code: &'static str, what: &str) -> Error {
        let found = match self.text() {
            "" => format!("{} is blank", self.describe()),
            text => format!("`{}` in {} is not {what}", clip(text), self.describe()),
        };
        self.error(code, found).with_help(format!("expected {what}"))
    }
}

/// A vector without its brackets: `(0 1 2)`, `~[0,1,2]`, `{0;1;2}`.
fn unbracketed(text: &str) -> &str {
    let text = text.trim().trim_start_matches('~').trim_start();
    let inside = |pair: (char, char)| text.strip_prefix(pair.0)?.strip_suffix(pair.1);
    [('(', ')'), ('[', ']'), ('{', '}')].into_iter().find_map(inside).unwrap_or(text)
}

/// The beginning of a text, for a message.
fn clip(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}...", text.get(..end).unwrap_or_default()),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> XmlDocument {
        XmlDocument::parse(text).unwrap().value
    }

    #[test]
    fn vectors_are_read_with_commas_and_brackets() {
        let read = |text: &str| parse(&format!("<v>{text}</v>")).root().f64s();
        for text in [
            "0, -0.1, 3",
            "0 -0.1 3",
            "0,-0.1,3",
            "0 , -0.1 , 3",
            "0;-0.1;3",
            "(0 -0.1 3)",
            "~[0,-0.1,3]",
            "[0, -0.1, 3]",
            "{0 -0.1 3}",
            "0, -0.1, 3,",
            "0\t-0.1\n3",
        ] {
            assert_eq!(read(text).unwrap(), [0.0, -0.1, 3.0], "{text}");
        }
        assert_eq!(read("-1.5,2").unwrap(), [-1.5, 2.0]);
        assert!(read("").unwrap().is_empty());
        for text in ["0,1", "0 -0,1 0,03", "1,2 3,4"] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains("the decimal separator is a point"), "{error}");
        }
        for text in ["a", "0, b", "1,,2", "NA NA NA", "1 (2 3"] {
            assert_eq!(read(text).unwrap_err().code(), "xml/number", "{text}");
        }
    }

    #[test]
    fn a_tree_is_walked_in_order() {
        let document = parse("<a><b><c/><d/></b><b n='2'/><e>t</e></a>");
        let a = document.root();
        let names = |i: &mut dyn Iterator<Item = Element<'_>>| {
            i.map(|e| e.name().to_owned()).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(names(&mut a.children()), "b b e");
        assert_eq!(names(&mut a.descendants()), "a b c d b e");
        assert_eq!(names(&mut a.child("b").unwrap().descendants()), "b c d");
        assert_eq!(names(&mut a.find(&["b", "d"]).unwrap().descendants()), "d");
        assert_eq!(a.children_named("b").count(), 2);
        assert_eq!(a.find(&["b", "d"]).unwrap().parent(), a.child("b"));
        assert_eq!(a.parent(), None);
        assert_eq!(a.child_text("e"), Some("t"));
        assert_eq!(a.child_text("b"), None);
        assert_eq!(document.elements(), 6);
    }

    #[test]
    fn comments_do_not_cut_text() {
        let document = parse("<a> 1 2 <!-- and --> 3 </a>");
        assert_eq!(document.root().numbers::<3>().unwrap(), [1.0, 2.0, 3.0]);
    }

    #[test]
    fn numbers_and_truths() {
        let document = parse("<a><v>(0 -1.#IND NaN)</v><t> TRUE </t><o/><i>inf</i></a>");
        let a = document.root();
        let v = a.require("v").unwrap().f64s().unwrap();
        assert_eq!(v.len(), 3);
        assert!(v[1].is_nan() && v[2].is_nan());
        assert_eq!(a.child_bool("t").unwrap(), Some(true));
        assert_eq!(a.child_bool("o").unwrap(), None);
        assert_eq!(a.child_f64("i").unwrap(), Some(f64::INFINITY));
        assert_eq!(a.child_f64("absent").unwrap(), None);
    }

    #[test]
    fn errors_name_the_element_and_its_line() {
        let document =
            parse("<a>\n<Body name='t'><mass>heavy</mass><c>1 2</c><b>maybe</b></Body></a>");
        let body = document.root().require("Body").unwrap();
        assert_eq!(
            body.child_f64("mass").unwrap_err().to_string(),
            "line 2, column 16: `heavy` in <mass> is not a number (expected a number)"
        );
        assert_eq!(
            body.child_numbers::<3>("c").unwrap_err().to_string(),
            "line 2, column 34: <c> holds 2 numbers (expected 3)"
        );
        assert_eq!(
            body.child_bool("b").unwrap_err().to_string(),
            "line 2, column 44: `maybe` in <b> is not `true` or `false` \
             (expected `true` or `false`)"
        );
        assert_eq!(
            body.require("inertia").unwrap_err().to_string(),
            "line 2, column 1: <Body name=\"t\"> has no <inertia>"
        );
        assert_eq!(body.require_attribute("id").unwrap_err().code(), "xml/missing-attribute");
    }
}
