//! Instances joined with the other tables of a document.

use crate::document::texts::{Context, Spot, Texts};
use crate::document::tree::{Entry, Value};
use std::collections::{HashMap, HashSet};

/// Merges entries of the same name: tables with their entries; of other values the first, which
/// is the document's own. Two instances may not give the same.
pub(super) fn join(texts: &mut Texts, entries: Vec<Entry>) -> Vec<Entry> {
    let mut joiner = Joiner { texts, told: HashSet::new() };
    joiner.join(entries, &mut vec![])
}

struct Joiner<'s> {
    texts: &'s mut Texts,
    /// The pairs of instances that are reported already.
    told: HashSet<(u32, u32)>,
}

impl Joiner<'_> {
    /// Recursive as deep as the tree is.
    fn join(&mut self, entries: Vec<Entry>, path: &mut Vec<String>) -> Vec<Entry> {
        let mut index: HashMap<String, usize> = HashMap::new();
        let mut joined: Vec<(Entry, bool)> = Vec::with_capacity(entries.len());
        for entry in entries {
            let Some(&known) = index.get(&entry.key.text) else {
                index.insert(entry.key.text.clone(), joined.len());
                joined.push((entry, false));
                continue;
            };
            let (first, grown) = &mut joined[known];
            let both_empty = |a: &[Entry], b: &[Entry]| a.is_empty() && b.is_empty();
            match (&mut first.node.value, entry.node.value) {
                (Value::Table(a), Value::Table(b)) if !both_empty(a, &b) => {
                    a.extend(b);
                    *grown = true;
                }
                _ if first.key.spot.context == 0 => {}
                _ => self.twice(first.key.spot, entry.key.spot, path, &entry.key.text),
            }
        }
        let join = |(mut entry, grown): (Entry, bool)| {
            if let Value::Table(inner) = &mut entry.node.value
                && grown
            {
                path.push(entry.key.text.clone());
                *inner = self.join(std::mem::take(inner), path);
                path.pop();
            }
            entry
        };
        joined.into_iter().map(join).collect()
    }

    fn twice(&mut self, first: Spot, second: Spot, path: &[String], key: &str) {
        if !self.told.insert((first.context, second.context)) {
            return;
        }
        let instance = |texts: &Texts, spot| match texts.context(spot) {
            Some(Context::Instance { name, at, .. }) => (name.clone(), *at),
            _ => (String::new(), spot),
        };
        let ((name, at), (other, here)) =
            (instance(self.texts, first), instance(self.texts, second));
        let line = self.texts.line(at);
        let path = path.join(".");
        let message = match first.context == second.context {
            true => format!("instance `{name}` gives `{key}` of [{path}] twice"),
            false => {
                format!("instances `{name}` ({line}) and `{other}` both give `{key}` of [{path}]")
            }
        };
        let help = "give each instance names of its own";
        self.texts.error(here, "document/duplicate", message, help);
    }
}
