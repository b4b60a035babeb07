//! Names of columns and markers, of which no two may be the same.

use std::collections::{HashMap, HashSet};

/// The names, of equal ones all but the first with `#2`, `#3`, … after them; `renamed` is called with the
/// position of each of those, and its new name.
pub(crate) fn distinct<'n>(
    names: impl Iterator<Item = &'n str> + Clone,
    mut renamed: impl FnMut(usize, &str),
) -> Vec<String> {
    let mut taken: HashSet<String> = names.clone().map(str::to_owned).collect();
    let mut uses: HashMap<&str, usize> = HashMap::new();
    let mut labels = vec![];
    for (index, name) in names.enumerate() {
        let count = uses.entry(name).or_insert(0);
        *count += 1;
        if *count == 1 {
            labels.push(name.to_owned());
            continue;
        }
        let mut other = format!("{name}#{count}");
        while !taken.insert(other.clone()) {
            *count += 1;
            other = format!("{name}#{count}");
        }
        renamed(index, &other);
        labels.push(other);
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_taken_are_left_out() {
        let mut renamed = vec![];
        let found = distinct(["a", "a", "b", "a#2", "a"].into_iter(), |index, name| {
            renamed.push((index, name.to_owned()));
        });
        assert_eq!(found, ["a", "a#3", "b", "a#2", "a#4"]);
        assert_eq!(renamed, [(1, "a#3".to_owned()), (4, "a#4".to_owned())]);
    }
}
