//! The map in `ARCHITECTURE.md`: it lists exactly the crates and the folders of sources, each crate
//! uses only crates above it, and the crates of the core use no files, threads or clocks, and no
//! third-party crates.
//!
//! The map alone defines the core: the crates that stand above [`FIRST_BEYOND_CORE`] in its
//! table. A map from which that cannot be told fails.

mod map;
mod source;

use crate::cargo::{self, Package};
use crate::outcome::{Context, Outcome};
use std::fs;
use std::path::{Path, PathBuf};

/// The first crate that is not part of the core.
const FIRST_BEYOND_CORE: &str = "condyle-formats";

/// Third-party crates that the core may use; tests may use any.
const FOREIGN_IN_CORE: [&str; 2] = ["nalgebra", "strsim"];

pub(super) fn run(context: &Context) -> Outcome {
    let mut findings = vec![];
    if let Err(error) = check(context, &mut findings) {
        findings.push(error);
    }
    findings.into()
}

fn check(context: &Context, findings: &mut Vec<String>) -> Result<(), String> {
    let crates = context.root.join("crates");
    let map = read(&context.root.join("ARCHITECTURE.md"))?;
    let order = map::crates_in_order(&map);
    let core = core(&order, findings);
    for name in order.iter().filter(|name| !crates.join(name).is_dir()) {
        findings.push(format!("{name} is in the table of crates but has no folder in crates"));
    }
    let packages = cargo::packages(context, "Cargo.toml")?;
    for folder in folders(&crates)? {
        let name = file_name(&folder);
        let Some(own) = order.iter().position(|known| *known == name) else {
            findings.push(format!("{name} is not in the table of crates of ARCHITECTURE.md"));
            continue;
        };
        let place = Path::new("crates").join(&name);
        match packages.iter().find(|package| package.folder == place) {
            Some(package) if package.name == name => {
                let others = (&order[..own], &packages[..]);
                dependencies(package, core.contains(&&*name), others, findings);
            }
            Some(package) => {
                findings.push(format!("the crate in crates/{name} is named {}", package.name));
            }
            None => findings.push(format!("crates/{name} is no package of the workspace")),
        }
        if core.contains(&&*name) {
            forbid_in_core(&folder, &context.root, findings)?;
        }
    }
    map_of_folders(&crates, &map::folders(&map), findings)
}

/// The crates of the core.
fn core<'m>(order: &'m [&'m str], findings: &mut Vec<String>) -> &'m [&'m str] {
    match order.iter().position(|name| *name == FIRST_BEYOND_CORE) {
        Some(0) => {
            findings.push(format!("no crate stands above {FIRST_BEYOND_CORE}: there is no core"));
            &[]
        }
        Some(first) => &order[..first],
        None => {
            findings.push(format!(
                "{FIRST_BEYOND_CORE}, above which the core is, is not in the table of crates of \
                 ARCHITECTURE.md"
            ));
            &[]
        }
    }
}

/// Checks that a crate uses only the crates above it, and one of the core few others besides.
fn dependencies(
    package: &Package,
    is_core: bool,
    (above, packages): (&[&str], &[Package]),
    findings: &mut Vec<String>,
) {
    let name = &package.name;
    for used in &package.dependencies {
        let other = &used.name;
        // Also recognised by name: a crate that was removed is still one of this project.
        let is_ours =
            other.starts_with("condyle") || packages.iter().any(|package| package.name == *other);
        if is_ours && !above.contains(&other.as_str()) {
            findings.push(format!("{name} uses {other}, which does not stand above it"));
        }
        let is_foreign = !is_ours && !FOREIGN_IN_CORE.contains(&other.as_str());
        if is_core && is_foreign && !used.for_tests {
            findings.push(format!("{name} uses {other}, which the core does without"));
        }
    }
}

fn forbid_in_core(folder: &Path, root: &Path, findings: &mut Vec<String>) -> Result<(), String> {
    let sources = folder.join("src");
    for folder in [vec![sources.clone()], folders_below(&sources)?].concat() {
        for file in entries(&folder)?.into_iter().filter(|path| path.is_file()) {
            for (line, what) in source::forbidden_in_core(&read(&file)?) {
                let file = file.strip_prefix(root).unwrap_or(&file).display();
                findings.push(format!("{file}:{line} has {what}, which the core does without"));
            }
        }
    }
    Ok(())
}

/// Compares the folders of sources, however deep, with those on the map.
fn map_of_folders(
    crates: &Path,
    named: &[String],
    findings: &mut Vec<String>,
) -> Result<(), String> {
    for folder in folders(crates)? {
        let sources = folder.join("src");
        for family in folders_below(&sources)? {
            let below = family.strip_prefix(&sources).unwrap_or(&family);
            let parts: Vec<_> = below.iter().map(|part| part.to_string_lossy()).collect();
            let name = format!("{}/{}/", file_name(&folder), parts.join("/"));
            if !named.contains(&name) {
                findings.push(format!("the folder {name} is not on the map of ARCHITECTURE.md"));
            }
        }
    }
    for name in named {
        let (of, below) = name.split_once('/').unwrap_or((name, ""));
        let places = [crates.join(of).join("src").join(below), crates.join(of).join(below)];
        if !places.iter().any(|place| place.is_dir()) {
            findings.push(format!("the folder {name} is on the map but not there"));
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
    let mut paths = vec![];
    for entry in entries {
        paths.push(entry.map_err(fail)?.path());
    }
    paths.sort();
    Ok(paths)
}

fn folders(folder: &Path) -> Result<Vec<PathBuf>, String> {
    Ok(entries(folder)?.into_iter().filter(|path| path.is_dir()).collect())
}

/// All folders in a folder, those in them included.
fn folders_below(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let mut found = folders(folder)?;
    let mut next = 0;
    while let Some(folder) = found.get(next) {
        let inner = folders(folder)?;
        found.extend(inner);
        next += 1;
    }
    Ok(found)
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    const MAP: &str = "| crate | what |\n| --- | --- |\n| `condyle-math` | numbers |\n\
                       | `condyle-model` | bodies |\n| `condyle-formats` | files |\n\n\
                       | folder | contract |\n| `condyle-model/joint/` | x |\n\
                       | `condyle-model/joint/knee/`, `hip/` | y |\n";

    /// Three crates in order.
    fn sound() -> Workspace {
        let manifest = |name, dependencies| {
            format!("[package]\nname = \"condyle-{name}\"\n\n[dependencies]\n{dependencies}")
        };
        let math = "condyle-math = { path = \"../condyle-math\" }\n";
        Workspace::new()
            .file("ARCHITECTURE.md", MAP)
            .file("Cargo.toml", "[workspace]\nresolver = \"3\"\nmembers = [\"crates/*\"]\n")
            .file("crates/condyle-math/Cargo.toml", &manifest("math", ""))
            .file("crates/condyle-math/src/lib.rs", "//! No `std::fs` here.\nuse std::fmt;\n")
            .file(
                "crates/condyle-model/Cargo.toml",
                &manifest("model", &format!("{math}strsim = \"1\"\n")),
            )
            .file("crates/condyle-model/src/lib.rs", "")
            .file("crates/condyle-model/src/joint/mod.rs", "")
            .file("crates/condyle-model/src/joint/knee/mod.rs", "")
            .file("crates/condyle-model/src/joint/hip/mod.rs", "")
            .file("crates/condyle-formats/Cargo.toml", &manifest("formats", "toml = \"1\"\n"))
            .file("crates/condyle-formats/src/lib.rs", "use std::{fs, thread};\n")
            .passes(run)
    }

    #[test]
    fn a_file_in_the_core_fails() {
        sound().with("crates/condyle-math/src/lib.rs", "fn f() { std::fs::read(x); }\n").fails(
            run,
            "crates/condyle-math/src/lib.rs:3 has std::fs, which the core does without",
        );
    }

    #[test]
    fn a_nested_import_in_a_deep_folder_of_the_core_fails() {
        sound()
            .file("crates/condyle-model/src/joint/knee/mod.rs", "use std::{cmp, fs::{self}};\n")
            .fails(run, "knee/mod.rs:1 has std::fs, which the core does without");
    }

    #[test]
    fn a_thread_or_a_clock_in_the_core_fails() {
        sound()
            .file("crates/condyle-model/src/lib.rs", "use std::thread;\n")
            .fails(run, "crates/condyle-model/src/lib.rs:1 has std::thread")
            .file("crates/condyle-model/src/lib.rs", "use std::time::Instant;\n")
            .fails(run, "crates/condyle-model/src/lib.rs:1 has std::time::Instant");
    }

    #[test]
    fn a_dependency_on_a_crate_below_fails() {
        let upward = "condyle-formats = { path = \"../condyle-formats\" }\n";
        let message = "condyle-math uses condyle-formats, which does not stand above it";
        for section in ["", "[dev-dependencies]\n", "[target.'cfg(unix)'.dependencies]\n"] {
            let planted = format!("{section}{upward}");
            sound().with("crates/condyle-math/Cargo.toml", &planted).fails(run, message);
        }
        let table = "[dependencies.condyle-formats]\npath = \"../condyle-formats\"\n";
        sound().with("crates/condyle-math/Cargo.toml", table).fails(run, message);
        let renamed = upward.replace("{ path", "{ package = \"condyle-formats\", path");
        let renamed = renamed.replacen("condyle-formats", "other", 1);
        sound().with("crates/condyle-math/Cargo.toml", &renamed).fails(run, message);
    }

    #[test]
    fn a_crate_of_others_in_the_core_fails_except_in_tests() {
        sound()
            .with("crates/condyle-math/Cargo.toml", "[dev-dependencies]\nproptest = \"1\"\n")
            .passes(run)
            .with("crates/condyle-math/Cargo.toml", "[build-dependencies]\ncc = \"1\"\n")
            .fails(run, "condyle-math uses cc, which the core does without");
        sound()
            .with("crates/condyle-model/Cargo.toml", "[dependencies.serde]\nversion = \"1\"\n")
            .fails(run, "condyle-model uses serde, which the core does without");
    }

    #[test]
    fn a_folder_that_is_not_on_the_map_fails_at_any_depth() {
        sound()
            .file("crates/condyle-math/src/function/mod.rs", "")
            .fails(run, "the folder condyle-math/function/ is not on the map");
        sound()
            .file("crates/condyle-model/src/joint/toe/mod.rs", "")
            .fails(run, "the folder condyle-model/joint/toe/ is not on the map");
    }

    #[test]
    fn a_folder_that_is_only_on_the_map_fails() {
        sound()
            .with("ARCHITECTURE.md", "| `condyle-math/gone/` | z |\n")
            .fails(run, "the folder condyle-math/gone/ is on the map but not there");
    }

    #[test]
    fn a_crate_that_is_not_in_the_table_fails() {
        sound()
            .file("crates/condyle-new/Cargo.toml", "[package]\nname = \"condyle-new\"\n")
            .file("crates/condyle-new/src/lib.rs", "")
            .fails(run, "condyle-new is not in the table of crates");
    }

    #[test]
    fn a_crate_that_is_only_in_the_table_fails() {
        sound()
            .with("ARCHITECTURE.md", "\n| `condyle-learn` | z |\n")
            .fails(run, "condyle-learn is in the table of crates but has no folder");
    }

    #[test]
    fn a_folder_that_cargo_does_not_know_or_knows_by_another_name_fails() {
        sound()
            .with_instead("Cargo.toml", "[\"crates/*\"]", "[\"crates/condyle-m*\"]")
            .fails(run, "crates/condyle-formats is no package of the workspace");
        sound()
            .with_instead("crates/condyle-formats/Cargo.toml", "condyle-formats", "other")
            .fails(run, "the crate in crates/condyle-formats is named other");
    }

    #[test]
    fn a_map_without_the_end_of_the_core_fails() {
        sound()
            .with_instead("ARCHITECTURE.md", "| `condyle-formats` | files |\n", "")
            .fails(run, "condyle-formats, above which the core is, is not in the table");
        let first = "| `condyle-formats` | files |\n| `condyle-math` | numbers |\n";
        sound()
            .with_instead("ARCHITECTURE.md", "| `condyle-math` | numbers |\n", first)
            .fails(run, "no crate stands above condyle-formats: there is no core");
    }

    #[test]
    fn a_workspace_without_a_map_fails() {
        let workspace = Workspace::of_one_crate();
        workspace.fails(run, "ARCHITECTURE.md: ");
    }
}
