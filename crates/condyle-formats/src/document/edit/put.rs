//! Any value given to a key of the document itself: a wire, a component, a segment, or what stands in place of an
//! included value.

use super::change::Change;
use super::{Edited, Editing, Refused, Step, key_text, shown};
use crate::document::tree::{ends, own_tables, too_deep};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

impl Editing {
    /// Gives a key a value, which is written as TOML: `"elbow"`, `[0, 1, 0]`, `{ parent = "hand" }`. A value that stands
    /// in the document itself is replaced, a new one is added.
    ///
    /// # Errors
    /// [`Refused::Impossible`] if the value is no TOML, or a table stands at the key; [`Refused::Fault`] if the
    /// document could not be read any more.
    ///
    /// ```
    /// use condyle_formats::document::edit::Editing;
    /// let text = "condyle = 1\nkind = \"model\"\n[segment.shank]\nat = [0, -0.42, 0] # Dumas 2007\n";
    /// let editing = Editing::read("leg.toml", text, &mut |_| Err("none".into()), &|_| true).unwrap();
    /// let path = ["segment".to_owned(), "foot".to_owned(), "parent".to_owned()];
    /// let edited = editing.put(&path, "\"shank\"").unwrap();
    /// assert_eq!(edited.next.text(), format!("{text}\n[segment.foot]\nparent = \"shank\"\n"));
    /// ```
    pub fn put(&self, path: &[String], value: &str) -> Result<Edited, Refused> {
        let Some((last, table)) = path.split_last() else { return Err("give a path".into()) };
        self.changed(self.insertion(table, &[(last, value.to_owned())])?)
    }

    /// Adds several keys of one table at once, as [`put`](Self::put) does with one.
    ///
    /// # Errors
    /// As [`put`](Self::put).
    pub fn put_all(&self, table: &[String], keys: &[(String, String)]) -> Result<Edited, Refused> {
        let keys: Vec<(&str, String)> =
            keys.iter().map(|(key, value)| (key.as_str(), value.clone())).collect();
        self.changed(self.insertion(table, &keys)?)
    }

    /// The change that gives keys of a table their values.
    pub(super) fn insertion(
        &self,
        table: &[String],
        keys: &[(&str, String)],
    ) -> Result<Change, Refused> {
        for (key, value) in keys {
            let alone = format!("{} = {value}", key_text(key));
            let read = DeTable::parse_recoverable(&alone);
            if too_deep(&alone).is_some() || !read.1.is_empty() || read.0.get_ref().len() != 1 {
                return Err(Refused::Impossible(format!("{value} is no value of TOML")));
            }
        }
        let text = self.text();
        let (parsed, _) = DeTable::parse_recoverable(text);
        let parsed = parsed.get_ref();
        if let [(key, value)] = keys
            && let Some(found) = own_tables(parsed, table).and_then(|inner| inner.get(*key))
        {
            return replaced(text, table, key, found, value);
        }
        let change =
            |new: String, at: usize| Change { file: String::new(), at, old: String::new(), new };
        if own_tables(parsed, table).is_none() && !table.is_empty() && !inline(text, parsed, table)
        {
            let ending = if text.contains("\r\n") { "\r\n" } else { "\n" };
            let name: Vec<String> = table.iter().map(|key| key_text(key)).collect();
            let mut new = String::new();
            if !text.is_empty() && !text.ends_with('\n') {
                new.push_str(ending);
            }
            new.push_str(&format!("{ending}[{}]{ending}", name.join(".")));
            for (key, value) in keys {
                new.push_str(&format!("{} = {value}{ending}", key_text(key)));
            }
            return Ok(change(new, text.len()));
        }
        let (at, new) = place(text, parsed, table, keys)?;
        Ok(change(new, at))
    }
}

/// A value of the document itself in place of another.
fn replaced(
    text: &str,
    table: &[String],
    key: &str,
    found: &Spanned<DeValue<'_>>,
    value: &str,
) -> Result<Change, Refused> {
    let range = found.span();
    let is_inline = text.get(range.clone()).is_some_and(|old| old.starts_with('{'));
    if matches!(found.get_ref(), DeValue::Table(_)) && !is_inline {
        let mut path: Vec<Step> = table.iter().cloned().map(Step::Key).collect();
        path.push(Step::Key(key.to_owned()));
        return Err(Refused::Impossible(format!("`{}` is there already", shown(&path))));
    }
    let end = ends(text).get(&range.start).copied().unwrap_or(range.end);
    let old = text.get(range.start..end).ok_or("the place is not known")?.to_owned();
    Ok(Change { file: String::new(), at: range.start, old, new: value.to_owned() })
}

/// Whether one of the tables on a path is written in braces, so that nothing can be added to it elsewhere.
fn inline(text: &str, top: &DeTable<'_>, table: &[String]) -> bool {
    let mut here = top;
    for key in table {
        let Some(next) = here.get(key.as_str()) else { return false };
        let span = next.span();
        match next.get_ref() {
            DeValue::Table(inner) => {
                if text.get(span).is_some_and(|found| found.starts_with('{')) {
                    return true;
                }
                here = inner;
            }
            _ => return true,
        }
    }
    false
}

/// Where keys are added to a table that is there, or that is in one in braces, and how.
fn place(
    text: &str,
    top: &DeTable<'_>,
    table: &[String],
    keys: &[(&str, String)],
) -> Result<(usize, String), Refused> {
    let mut here = top;
    let mut span = 0..0;
    for (depth, key) in table.iter().enumerate() {
        let Some(next) = here.get(key.as_str()) else { break };
        let DeValue::Table(inner) = next.get_ref() else {
            return Err(Refused::Impossible(format!("`{key}` is no table")));
        };
        (here, span) = (inner, next.span());
        if text.get(span.clone()).is_some_and(|found| found.starts_with('{')) {
            return in_braces(text, inner, span, &table[depth + 1..], keys);
        }
    }
    let ending = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let written = |prefix: &str| {
        let line = |(key, value): &(&str, String)| format!("{prefix}{} = {value}", key_text(key));
        keys.iter().map(line).collect::<Vec<_>>().join(ending)
    };
    let line_end = |at: usize| {
        let rest = text.get(at..).unwrap_or_default();
        rest.find('\n').map_or(text.len(), |end| at + end + 1)
    };
    // After the last value that stands in this table itself.
    let own = here.iter().filter(|(_, value)| match value.get_ref() {
        DeValue::Table(_) => text.get(value.span()).is_some_and(|found| found.starts_with('{')),
        _ => true,
    });
    let last = own.map(|(key, value)| (key.span().start, value.span().end)).max();
    let (at, prefix) = match last {
        Some((key, end)) => {
            let from = text.get(..key).unwrap_or_default().rfind('\n').map_or(0, |at| at + 1);
            let prefix = text.get(from..key).unwrap_or_default();
            if prefix.contains(['{', '=', '#']) {
                return Err("it cannot be added to as it is written: edit the text".into());
            }
            (line_end(end), prefix)
        }
        // A table with a header and nothing else in it.
        None if text.get(span.start..).is_some_and(|found| found.starts_with('[')) => {
            (line_end(span.end), "")
        }
        None => return Err("it cannot be added to as it is written: edit the text".into()),
    };
    let before = if text.get(..at).is_some_and(|t| t.ends_with('\n')) { "" } else { ending };
    Ok((at, format!("{before}{}{ending}", written(prefix))))
}

/// Where keys are added to a table in braces, and how.
fn in_braces(
    text: &str,
    mut inner: &DeTable<'_>,
    mut span: std::ops::Range<usize>,
    mut below: &[String],
    keys: &[(&str, String)],
) -> Result<(usize, String), Refused> {
    while let Some((first, rest)) = below.split_first()
        && let Some(next) = inner.get(first.as_str())
        && let DeValue::Table(deeper) = next.get_ref()
        && text.get(next.span()).is_some_and(|found| found.starts_with('{'))
    {
        (inner, span, below) = (deeper, next.span(), rest);
    }
    let prefix: String = below.iter().map(|key| format!("{}.", key_text(key))).collect();
    let pair = |(key, value): &(&str, String)| format!("{prefix}{} = {value}", key_text(key));
    let pairs = keys.iter().map(pair).collect::<Vec<_>>().join(", ");
    // The values of dotted keys are deeper.
    let mut open: Vec<_> = inner.iter().map(|(_, value)| value).collect();
    let mut last = None;
    while let Some(value) = open.pop() {
        match value.get_ref() {
            DeValue::Table(table)
                if !text.get(value.span()).is_some_and(|found| found.starts_with('{')) =>
            {
                open.extend(table.iter().map(|(_, value)| value));
            }
            _ => last = last.max(Some(value.span().end)),
        }
    }
    match last {
        Some(end) if end < span.end => Ok((end, format!(", {pairs}"))),
        None => Ok((span.start + 1, format!(" {pairs} "))),
        Some(_) => Err("it cannot be added to as it is written: edit the text".into()),
    }
}
