//! The page of `condyle view`: its built files are of the sources beside them.
//!
//! `page/dist/sources.sha256` has one line for all sources and one for each built file. A source that changes without
//! a new build is found, and so is a built file that changes by itself. Sources are those of the page and of the
//! crate that it calls; the library below changes every day, and whether the built evaluator still computes the same is
//! what the check `evaluator` asks, pose by pose.
//!
//! `cargo xtask page --bless` builds it anew. It needs Node with the packages of `page/package-lock.json`
//! (`npm ci`), the target `wasm32-unknown-unknown`, and `xz`.

use crate::cargo;
use crate::outcome::{Context, Outcome};
use crate::tool;
use flate2::{Compression, write::GzEncoder};
use sha2::{Digest, Sha256};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the page.
pub(super) const PAGE: &str = "crates/condyle-view/page";
/// What the page is built from, files and folders.
const SOURCES: [&str; 6] = [
    "crates/condyle-view/page/src",
    "crates/condyle-view/page/build.mjs",
    "crates/condyle-view/page/package.json",
    "crates/condyle-view/page/package-lock.json",
    "crates/condyle-view/page/tsconfig.json",
    "crates/condyle-wasm/src",
];
/// What is built.
const BUILT: [&str; 4] = ["index.html", "assets/page.js", "assets/core.wasm.lzma", READERS];
/// Readers of all formats, which the page fetches when a file needs them.
const READERS: &str = "assets/readers.wasm.lzma";
/// The most that they may weigh, in bytes.
const HEAVIEST_READERS: usize = 1_500_000;
/// The list of hashes.
const HASHES: &str = "crates/condyle-view/page/dist/sources.sha256";
/// The most that the page may weigh as a server that packs sends it, in bytes.
const HEAVIEST: usize = 1_000_000;
/// The target of browsers.
const BROWSER: &str = "wasm32-unknown-unknown";

pub(super) fn run(context: &Context) -> Outcome {
    if context.bless
        && let Err(error) = build(context)
    {
        return Outcome::Failed(error);
    }
    check(context).into()
}

fn check(context: &Context) -> Result<(), String> {
    let found = hashes(&context.root)?;
    let file = context.root.join(HASHES);
    if context.bless {
        std::fs::write(&file, &found).map_err(|error| format!("{HASHES}: {error}"))?;
    }
    let kept = std::fs::read_to_string(&file).map_err(|error| format!("{HASHES}: {error}"))?;
    let differ: Vec<&str> = found
        .lines()
        .filter(|line| !kept.lines().any(|other| other == *line))
        .filter_map(|line| line.split_once("  ").map(|(_, name)| name))
        .collect();
    if differ.is_empty() {
        return weight(&context.root);
    }
    Err(format!(
        "the built page is not of its sources ({}): `cargo xtask page --bless` builds it",
        differ.join(", ")
    ))
}

/// The page as it is sent: text packed by gzip, the evaluator as it is packed.
fn weight(root: &Path) -> Result<(), String> {
    let mut all = 0;
    let size = read(&root.join(PAGE).join("dist").join(READERS))?.len();
    if size > HEAVIEST_READERS {
        return Err(format!("the readers of all formats weigh {size} bytes"));
    }
    for name in BUILT.into_iter().filter(|name| *name != READERS) {
        let bytes = read(&root.join(PAGE).join("dist").join(name))?;
        let mut packed = GzEncoder::new(vec![], Compression::default());
        packed.write_all(&bytes).map_err(|error| error.to_string())?;
        let packed = packed.finish().map_err(|error| error.to_string())?;
        all += packed.len().min(bytes.len());
    }
    println!("   the page weighs {} kB, and readers of all formats {} kB", all / 1000, size / 1000);
    if all > HEAVIEST { Err(format!("the page weighs {all} bytes")) } else { Ok(()) }
}

/// The list of hashes as it should be.
fn hashes(root: &Path) -> Result<String, String> {
    let mut files = vec![];
    for source in SOURCES {
        collect(&root.join(source), &mut files)?;
    }
    files.sort();
    let mut all = Sha256::new();
    for file in &files {
        let name = file.strip_prefix(root).unwrap_or(file).to_string_lossy().replace('\\', "/");
        all.update(name.as_bytes());
        all.update([0]);
        all.update(Sha256::digest(read(file)?));
    }
    let mut list = format!("{}  sources\n", hex(&all.finalize()));
    for name in BUILT {
        let bytes = read(&root.join(PAGE).join("dist").join(name))?;
        list += &format!("{}  {name}\n", hex(&Sha256::digest(bytes)));
    }
    Ok(list)
}

fn read(file: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// All files of a folder, or a file.
fn collect(path: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    let mut open = vec![path.to_owned()];
    while let Some(path) = open.pop() {
        if path.is_file() {
            files.push(path);
            continue;
        }
        let fail = |error: std::io::Error| format!("{}: {error}", path.display());
        for entry in std::fs::read_dir(&path).map_err(fail)? {
            open.push(entry.map_err(fail)?.path());
        }
    }
    Ok(())
}

/// Builds the evaluator and the page.
fn build(context: &Context) -> Result<(), String> {
    let folder = context.root.join("target/page");
    let built = folder.join(BROWSER).join("page/condyle_wasm.wasm");
    let mut modules = vec![];
    for (name, features) in [("core.wasm", ""), ("readers.wasm", "readers")] {
        let mut command = cargo::command(context);
        command.args(["build", "--package", "condyle-wasm", "--profile", "page", "--target"]);
        command.args([BROWSER, "--features", features]);
        tool::run(context, command.env("CARGO_TARGET_DIR", &folder))?;
        let module = folder.join(name);
        std::fs::copy(&built, &module).map_err(|error| format!("{name}: {error}"))?;
        modules.push(module);
    }
    let page = context.root.join(PAGE);
    if !page.join("node_modules").is_dir() {
        tool::run(context, Command::new("npm").arg("ci").current_dir(&page))?;
    }
    let types = page.join("node_modules/typescript/bin/tsc");
    tool::run(context, Command::new("node").arg(types).arg("--noEmit").current_dir(&page))?;
    tool::run(context, Command::new("node").arg("build.mjs").args(modules).current_dir(&page))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    fn built() -> Workspace {
        let mut workspace = Workspace::new();
        for source in SOURCES {
            let name =
                if source.ends_with("src") { format!("{source}/a.ts") } else { source.into() };
            workspace = workspace.file(&name, "one\n");
        }
        for name in BUILT {
            workspace = workspace.file(&format!("{PAGE}/dist/{name}"), "built\n");
        }
        let list = hashes(&workspace.context().root).expect("all files are there");
        workspace.file(HASHES, &list)
    }

    #[test]
    fn a_source_that_changes_without_a_build_fails() {
        let source = format!("{PAGE}/src/a.ts");
        built().passes(run).with(&source, "two\n").fails(run, "not of its sources (sources)");
        let other = format!("{PAGE}/src/b.ts");
        built().file(&other, "").fails(run, "not of its sources (sources)");
    }

    #[test]
    fn a_built_file_that_changes_by_itself_fails() {
        let program = format!("{PAGE}/dist/assets/page.js");
        built().with(&program, "x").fails(run, "assets/page.js");
    }
}
