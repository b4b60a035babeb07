//! JSON that is changed in places, all other bytes as they are.

use std::ops::Range;

/// Text of JSON that was parsed before, and what is put in place of parts of it.
pub(super) struct Splice<'t> {
    text: &'t [u8],
    /// In any order; no two overlap.
    edits: Vec<(Range<usize>, String)>,
    /// Elements to be added to lists of the top object, and whether the old ones are dropped.
    lists: Vec<(&'static str, Vec<String>, bool)>,
}

impl<'t> Splice<'t> {
    pub(super) fn new(text: &'t [u8]) -> Self {
        Self { text, edits: vec![], lists: vec![] }
    }

    /// Puts a text in place of a part.
    pub(super) fn replace(&mut self, part: Range<usize>, text: String) {
        self.edits.push((part, text));
    }

    /// Adds an element to a list of the top object, after those there are or in their place.
    pub(super) fn add(&mut self, list: &'static str, element: String, anew: bool) {
        match self.lists.iter_mut().find(|known| known.0 == list) {
            Some((_, elements, _)) => elements.push(element),
            None => self.lists.push((list, vec![element], anew)),
        }
    }

    /// Members of an object that begins at `start`: each with its key, the place where that begins, and its value.
    pub(super) fn members(&self, start: usize) -> Vec<(String, usize, Range<usize>)> {
        let mut found = vec![];
        let mut at = self.skip_blank(start + 1);
        while self.text.get(at) == Some(&b'"') {
            let key = at..self.end(at);
            let name = serde_json::from_slice(self.text.get(key.clone()).unwrap_or_default());
            let value = self.skip_blank(self.skip_blank(key.end) + 1);
            let value = value..self.end(value);
            let next = self.skip_blank(value.end);
            found.push((name.unwrap_or_default(), key.start, value));
            if self.text.get(next) != Some(&b',') {
                break;
            }
            at = self.skip_blank(next + 1);
        }
        found
    }

    /// The value of a member of an object; the last of several, as readers of JSON take it.
    pub(super) fn member(&self, start: usize, key: &str) -> Option<Range<usize>> {
        self.members(start).into_iter().rev().find(|member| member.0 == key).map(|member| member.2)
    }

    /// Elements of a list that begins at `start`.
    pub(super) fn elements(&self, start: usize) -> Vec<Range<usize>> {
        let mut found = vec![];
        let mut at = self.skip_blank(start + 1);
        while !matches!(self.text.get(at), None | Some(b']')) {
            let value = at..self.end(at);
            let next = self.skip_blank(value.end);
            found.push(value);
            if self.text.get(next) != Some(&b',') {
                break;
            }
            at = self.skip_blank(next + 1);
        }
        found
    }

    /// Where the top object begins.
    pub(super) fn top(&self) -> usize {
        self.skip_blank(if self.text.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 })
    }

    /// The text with all changes.
    pub(super) fn finish(mut self) -> Vec<u8> {
        let top = self.top();
        let mut missing = vec![];
        for (name, elements, anew) in std::mem::take(&mut self.lists) {
            let elements = elements.join(",");
            match self.member(top, name) {
                Some(list) if anew => self.edits.push((list, format!("[{elements}]"))),
                Some(list) => {
                    let last = list.end.saturating_sub(1);
                    let comma = if self.elements(list.start).is_empty() { "" } else { "," };
                    self.edits.push((last..last, format!("{comma}{elements}")));
                }
                None => missing.push(format!("\"{name}\":[{elements}],")),
            }
        }
        if !missing.is_empty() {
            // glTF has an asset, so that something follows.
            self.edits.push((top + 1..top + 1, missing.concat()));
        }
        self.edits.sort_by_key(|edit| edit.0.start);
        let mut out = Vec::with_capacity(self.text.len());
        let mut at = 0;
        for (part, text) in &self.edits {
            out.extend(self.text.get(at..part.start).unwrap_or_default());
            out.extend(text.as_bytes());
            at = part.end.max(at);
        }
        out.extend(self.text.get(at..).unwrap_or_default());
        out
    }

    fn skip_blank(&self, at: usize) -> usize {
        let blank = |byte: &&u8| matches!(byte, b' ' | b'\t' | b'\r' | b'\n');
        at + self.text.get(at..).unwrap_or_default().iter().take_while(blank).count()
    }

    /// Where the value that begins at `at` ends.
    fn end(&self, at: usize) -> usize {
        let (mut depth, mut at) = (0usize, at);
        while let Some(byte) = self.text.get(at) {
            match byte {
                b'"' => {
                    at += 1;
                    while let Some(inner) = self.text.get(at).filter(|inner| **inner != b'"') {
                        at += if *inner == b'\\' { 2 } else { 1 };
                    }
                    if depth == 0 {
                        return (at + 1).min(self.text.len());
                    }
                }
                b'{' | b'[' => depth += 1,
                b'}' | b']' if depth == 0 => return at,
                b'}' | b']' => {
                    depth -= 1;
                    if depth == 0 {
                        return at + 1;
                    }
                }
                b',' | b' ' | b'\t' | b'\r' | b'\n' if depth == 0 => return at,
                _ => {}
            }
            at += 1;
        }
        self.text.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_changed_changes() {
        let text = br#"{ "asset" : {"v":"2.0","x":"a]\"}"} , "nodes":[ {"m" : [1, 2]}, 7 ],"empty":[ ], "n": -1.50e1}"#;
        let mut splice = Splice::new(text);
        let top = splice.top();
        let keys: Vec<String> = splice.members(top).into_iter().map(|m| m.0).collect();
        assert_eq!(keys, ["asset", "nodes", "empty", "n"]);
        let number = splice.member(top, "n").unwrap();
        assert_eq!(&text[number.clone()], b"-1.50e1");
        splice.replace(number, "3".into());
        let nodes = splice.member(top, "nodes").unwrap();
        assert_eq!(splice.elements(nodes.start).len(), 2);
        splice.add("nodes", "8".into(), false);
        splice.add("empty", "9".into(), false);
        splice.add("empty", "10".into(), false);
        splice.add("new", "11".into(), false);
        let out = String::from_utf8(splice.finish()).unwrap();
        let expected = r#"{"new":[11], "asset" : {"v":"2.0","x":"a]\"}"} , "nodes":[ {"m" : [1, 2]}, 7 ,8],"empty":[ 9,10], "n": 3}"#;
        assert_eq!(out, expected);
    }

    #[test]
    fn a_list_is_made_anew() {
        let mut splice = Splice::new(b"{\"a\": [1, 2], \"b\": 3}");
        splice.add("a", "4".into(), true);
        splice.add("a", "5".into(), true);
        assert_eq!(splice.finish(), b"{\"a\": [4,5], \"b\": 3}");
    }
}
