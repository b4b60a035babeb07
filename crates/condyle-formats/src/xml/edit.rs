//! Changes of a text at elements that were read from it: all else stays as it is written, letter for
//! letter, comments and the spaces between elements too.

use super::Element;
use std::ops::Range;

/// Changes of one text, made all at once.
#[derive(Debug)]
pub(crate) struct Edits<'t> {
    text: &'t str,
    changes: Vec<(Range<usize>, String)>,
}

impl<'t> Edits<'t> {
    /// Changes of the text that a document was parsed from, without a byte order mark.
    pub(crate) fn new(text: &'t str) -> Self {
        Self { text, changes: vec![] }
    }

    /// Puts a text, as XML has it, in place of everything inside an element.
    pub(crate) fn set_text(&mut self, element: Element<'_>, value: &str) {
        let span = self.span(element);
        match self.inside(&span) {
            Some(inside) => self.changes.push((inside, value.to_owned())),
            None => self.open(&span, value),
        }
    }

    /// Puts XML before all that stands inside an element.
    pub(crate) fn prepend(&mut self, element: Element<'_>, xml: &str) {
        let span = self.span(element);
        match self.inside(&span) {
            Some(inside) => self.changes.push((inside.start..inside.start, xml.to_owned())),
            None => self.open(&span, xml),
        }
    }

    /// Puts XML after all that stands inside an element.
    pub(crate) fn append(&mut self, element: Element<'_>, xml: &str) {
        let span = self.span(element);
        match self.inside(&span) {
            Some(inside) => self.changes.push((inside.end..inside.end, xml.to_owned())),
            None => self.open(&span, xml),
        }
    }

    /// Puts XML around an element.
    pub(crate) fn wrap(&mut self, element: Element<'_>, before: &str, after: &str) {
        let span = self.span(element);
        self.changes.push((span.start..span.start, before.to_owned()));
        self.changes.push((span.end..span.end, after.to_owned()));
    }

    /// Puts XML in place of an element.
    pub(crate) fn replace(&mut self, element: Element<'_>, xml: &str) {
        let span = self.span(element);
        self.changes.push((span, xml.to_owned()));
    }

    /// How an element is written, its tags included.
    pub(crate) fn written(&self, element: Element<'_>) -> &'t str {
        self.text.get(self.span(element)).unwrap_or_default()
    }

    /// The text with its changes. Of two that overlap the first in the text is made.
    pub(crate) fn finish(mut self) -> String {
        self.changes.sort_by_key(|(range, _)| (range.start, range.end));
        let more: usize = self.changes.iter().map(|(_, new)| new.len()).sum();
        let mut text = String::with_capacity(self.text.len() + more);
        let mut reached = 0;
        for (range, new) in &self.changes {
            if range.start < reached {
                continue;
            }
            text.push_str(self.text.get(reached..range.start).unwrap_or_default());
            text.push_str(new);
            reached = range.end;
        }
        text.push_str(self.text.get(reached..).unwrap_or_default());
        text
    }

    fn span(&self, element: Element<'_>) -> Range<usize> {
        let span = element.span();
        span.start.min(self.text.len())..span.end.min(self.text.len())
    }

    /// What stands between the tags of an element; none of one that is written `<a/>`.
    fn inside(&self, span: &Range<usize>) -> Option<Range<usize>> {
        let whole = self.text.get(span.clone())?;
        let start = start_tag(whole)?;
        if whole.get(..start)?.ends_with("/>") {
            return None;
        }
        let end = whole.rfind("</")?;
        (start <= end).then(|| span.start + start..span.start + end)
    }

    /// Gives an element that is written `<a/>` something inside.
    fn open(&mut self, span: &Range<usize>, value: &str) {
        let whole = self.text.get(span.clone()).unwrap_or_default();
        let name = whole.get(1..).unwrap_or_default();
        let name = name.split(|c: char| c.is_whitespace() || matches!(c, '/' | '>')).next();
        let name = name.unwrap_or_default();
        if let Some(slash) = whole.ends_with("/>").then(|| span.end - 2) {
            self.changes.push((slash..span.end, format!(">{value}</{name}>")));
        }
    }
}

/// Where the start tag at the beginning of a text ends.
fn start_tag(text: &str) -> Option<usize> {
    let mut quote = None;
    for (at, byte) in text.bytes().enumerate() {
        match (quote, byte) {
            (None, b'>') => return Some(at + 1),
            (None, b'"' | b'\'') => quote = Some(byte),
            (Some(open), _) if open == byte => quote = None,
            _ => {}
        }
    }
    None
}

/// A text as it stands inside an element or an attribute.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::xml::XmlDocument;

    #[test]
    fn all_else_stays_as_it_is_written() {
        let text = "<?xml version='1.0'?>\n<a n='>'><!-- kept -->\n <b x=\"/>\"/> <c>1 <!-- é --> 2</c>\n\
                    <D::e q='1' />\t<f> <g/></f></a>\n";
        let document = XmlDocument::parse(text).unwrap().value;
        let child = |name: &str| document.root().child(name).unwrap();
        let mut edits = Edits::new(text);
        edits.set_text(child("c"), "3");
        edits.set_text(child("b"), "4");
        edits.prepend(child("D__e"), "<h/>");
        edits.wrap(child("f").child("g").unwrap(), "<w>", "</w>");
        edits.append(child("f"), "!");
        edits.prepend(document.root(), "?");
        assert_eq!(edits.written(child("f")), "<f> <g/></f>");
        assert_eq!(
            edits.finish(),
            "<?xml version='1.0'?>\n<a n='>'>?<!-- kept -->\n <b x=\"/>\">4</b> <c>3</c>\n\
             <D::e q='1' ><h/></D::e>\t<f> <w><g/></w>!</f></a>\n"
        );
    }

    #[test]
    fn nothing_changed_is_the_text_itself() {
        let text = "<a>\r\n<b/></a>";
        assert_eq!(Edits::new(text).finish(), text);
    }

    #[test]
    fn what_is_replaced_is_not_changed_inside() {
        let text = "<a><b><c/></b></a>";
        let document = XmlDocument::parse(text).unwrap().value;
        let b = document.root().child("b").unwrap();
        let mut edits = Edits::new(text);
        edits.set_text(b.child("c").unwrap(), "1");
        edits.replace(b, "<d/>");
        assert_eq!(edits.finish(), "<a><d/></a>");
    }
}
