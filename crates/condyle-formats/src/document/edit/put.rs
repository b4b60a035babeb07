//! Any value given to a key of the document itself: a wire, a component, a segment, or what stands in place of an
//! included value.

use super::change::Change;
use super::{Edited, Editing, Refused, Step, key_text, shown};
use crate::document::tree::{ends, own_tables, too_deep};
use toml::Spanned;
use toml::de::{DeTable, DeValue};
use toml_edit::{DocumentMut, Item, Table, Value as NewValue};

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
        let change = |new: String, at: usize| Change {
            file: String::new(),
            at,
            old: String::new(),
            new,
        };
        if own_tables(parsed, table).is_none() && !table.is_empty() && !inline(text, parsed, table) {
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
        let written = inserted(text, table, keys)?;
        // What was added, in one piece; all else must be as it was.
        let added = written.len().checked_sub(text.len());
        let common = text.bytes().zip(written.bytes()).take_while(|(a, b)| a == b).count();
        let mut common = common;
        while !text.is_char_boundary(common) || !written.is_char_boundary(common) {
            common -= 1;
        }
        let same = added.and_then(|added| written.get(common + added..)) == text.get(common..);
        match added.and_then(|added| written.get(common..common + added)) {
            Some(new) if same => Ok(change(new.to_owned(), common)),
            _ => {
                let path: Vec<Step> = table.iter().cloned().map(Step::Key).collect();
                let why = format!("[{}] cannot be added to as it is written: edit the text", shown(&path));
                Err(Refused::Impossible(why))
            }
        }
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

/// The text with keys added to a table that is there.
fn inserted(text: &str, table: &[String], keys: &[(&str, String)]) -> Result<String, Refused> {
    let wrong = |_| Refused::from("the text could not be read");
    let mut document: DocumentMut = text.parse().map_err(wrong)?;
    let mut here: &mut Item = document.as_item_mut();
    for key in table {
        let Some(like) = here.as_table_like_mut() else {
            return Err(Refused::Impossible(format!("`{key}` is no table")));
        };
        let implicit = || {
            let mut table = Table::new();
            table.set_implicit(true);
            Item::Table(table)
        };
        here = like.entry(key).or_insert_with(implicit);
    }
    let Some(like) = here.as_table_like_mut() else { return Err("this is no table".into()) };
    for (key, value) in keys {
        let value: NewValue =
            value.parse().map_err(|_| Refused::Impossible(format!("{value} is no value")))?;
        like.insert(key, Item::Value(value));
    }
    Ok(document.to_string())
}
