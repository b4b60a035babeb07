//! The two tables of `ARCHITECTURE.md`: the crates from the ground up, and the folders.

/// The crates of the table, from the ground up: rows that begin with a name in code.
pub(super) fn crates_in_order(map: &str) -> Vec<&str> {
    let names = first_cells(map).filter_map(|cell| cell.strip_prefix('`')?.split_once('`'));
    names.map(|(name, _)| name).filter(|name| is_of_this_project(name)).collect()
}

/// The folders of the table, each relative to the folder of crates, with a `/` at the end. A name
/// that does not begin with a crate is a sibling of the one before it in its row.
pub(super) fn folders(map: &str) -> Vec<String> {
    let mut found = vec![];
    for cell in first_cells(map) {
        let mut parent = "";
        for name in cell.split('`').skip(1).step_by(2).filter(|name| name.ends_with('/')) {
            if is_of_this_project(name.split('/').next().unwrap_or_default()) {
                let end = name.trim_end_matches('/').rfind('/').map_or(0, |slash| slash + 1);
                parent = &name[..end];
                found.push(name.to_owned());
            } else if !parent.is_empty() {
                found.push(format!("{parent}{name}"));
            }
        }
    }
    found
}

fn first_cells(map: &str) -> impl Iterator<Item = &str> {
    map.lines().filter_map(|line| Some(line.strip_prefix("| ")?.split_once(" |")?.0))
}

fn is_of_this_project(name: &str) -> bool {
    name == "condyle" || (name.starts_with("condyle-") && !name.contains('/'))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAP: &str = "| crate | what |\n| `condyle-math` | x |\n| `condyle` | z |\n\n\
                       Prose about `condyle/prose/`.\n\n| folder | contract |\n\
                       | `condyle-math/function/` | y `condyle/mentioned/` |\n\
                       | `condyle/document/read/`, `write/` | z |\n";

    #[test]
    fn the_table_gives_the_order() {
        assert_eq!(crates_in_order(MAP), ["condyle-math", "condyle"]);
    }

    #[test]
    fn only_the_table_names_folders() {
        let expected =
            ["condyle-math/function/", "condyle/document/read/", "condyle/document/write/"];
        assert_eq!(folders(MAP), expected);
    }
}
