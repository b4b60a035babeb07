//! The map in `ARCHITECTURE.md`: every crate and every folder of sources is on it, each crate uses
//! only crates above it, and the crates of the core keep their hands off files and threads.

use crate::outcome::{Context, Outcome};
use std::fs;
use std::path::{Path, PathBuf};

/// The first crate that is not of the core.
const FIRST_BEYOND_CORE: &str = "condyle-learn";

/// What the core has no use for.
const NOT_IN_CORE: [&str; 4] = ["std::fs", "std::net", "std::thread", "std::process"];

pub(super) fn run(context: &Context) -> Outcome {
    let mut findings = vec![];
    if let Err(error) = check(&context.root, &mut findings) {
        findings.push(error);
    }
    match findings[..] {
        [] => Outcome::Passed,
        _ => Outcome::Failed(format!("\n   {}", findings.join("\n   "))),
    }
}

fn check(root: &Path, findings: &mut Vec<String>) -> Result<(), String> {
    let map = read(&root.join("ARCHITECTURE.md"))?;
    let order = crates_in_order(&map);
    let place = |name: &str| order.iter().position(|known| *known == name);
    for folder in folders(&root.join("crates"))? {
        let name = file_name(&folder);
        let Some(own) = place(&name) else {
            findings.push(format!("{name} is not in the table of crates of ARCHITECTURE.md"));
            continue;
        };
        for used in workspace_dependencies(&read(&folder.join("Cargo.toml"))?) {
            if place(&used).is_none_or(|other| other >= own) {
                findings.push(format!("{name} uses {used}, which does not stand above it"));
            }
        }
        for family in folders(&folder.join("src"))? {
            let name = format!("{name}/{}/", file_name(&family));
            if !map.contains(&format!("`{name}`")) {
                findings.push(format!("the folder {name} is not on the map of ARCHITECTURE.md"));
            }
        }
        if place(FIRST_BEYOND_CORE).is_some_and(|first| own < first) {
            forbid(&folder.join("src"), root, findings)?;
        }
    }
    Ok(())
}

/// The crates of the table, from the ground up: rows that begin with a name in code.
fn crates_in_order(map: &str) -> Vec<&str> {
    map.lines()
        .filter_map(|line| line.strip_prefix("| `")?.split_once('`'))
        .filter(|(name, _)| name.starts_with("condyle") && !name.contains('/'))
        .map(|(name, _)| name)
        .collect()
}

/// The crates of this workspace among the dependencies of a manifest, those of tests included.
fn workspace_dependencies(manifest: &str) -> Vec<String> {
    let mut listed = false;
    let mut names = vec![];
    for line in manifest.lines() {
        if line.starts_with('[') {
            listed = line.trim_matches(['[', ']']).ends_with("dependencies");
        } else if listed && line.starts_with("condyle") {
            let end = line.find(['.', '=', ' ']).unwrap_or(line.len());
            names.push(line[..end].to_owned());
        }
    }
    names
}

fn forbid(folder: &Path, root: &Path, findings: &mut Vec<String>) -> Result<(), String> {
    let mut waiting = vec![folder.to_owned()];
    while let Some(folder) = waiting.pop() {
        waiting.extend(folders(&folder)?);
        for file in entries(&folder)?.into_iter().filter(|path| path.is_file()) {
            let text = read(&file)?;
            for word in NOT_IN_CORE.iter().filter(|word| text.contains(*word)) {
                let file = file.strip_prefix(root).unwrap_or(&file).display();
                findings.push(format!("{file} has {word}, which the core does without"));
            }
        }
    }
    Ok(())
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let fail = |error| format!("{}: {error}", folder.display());
    let entries = fs::read_dir(folder).map_err(fail)?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    Ok(paths)
}

fn folders(folder: &Path) -> Result<Vec<PathBuf>, String> {
    Ok(entries(folder)?.into_iter().filter(|path| path.is_dir()).collect())
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_gives_the_order() {
        let map = "| crate | what |\n| `condyle-math` | x |\n| `condyle-math/function/` | y |\n\
                   | `condyle` | z |\n";
        assert_eq!(crates_in_order(map), ["condyle-math", "condyle"]);
    }

    #[test]
    fn dependencies_are_found_in_every_section() {
        let manifest = "[package]\nname = \"condyle-x\"\n[dependencies]\n\
                        condyle-math.workspace = true\ncondyle = { path = \"y\" }\nrayon = \"1\"\n\
                        [dev-dependencies]\ncondyle-model.workspace = true\n[features]\n";
        assert_eq!(workspace_dependencies(manifest), ["condyle-math", "condyle", "condyle-model"]);
    }
}
