//! The fuzz targets: each file is one, each has seeds, all of them build and pass on their seeds.
//!
//! Finding new inputs requires a nightly compiler and hours. Building a target and running it on
//! the files in `fuzz/seeds/` requires neither: without instrumentation libFuzzer runs the files
//! that it is given.

use crate::cargo::{self, Program};
use crate::outcome::{Context, Outcome};
use crate::tool;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The workspace of the targets.
const MANIFEST: &str = "fuzz/Cargo.toml";

pub(super) fn run(context: &Context) -> Outcome {
    match lists(context) {
        Ok(findings) if findings.is_empty() => {}
        Ok(findings) => return findings.into(),
        Err(error) => return Outcome::Failed(error),
    }
    let compiler = std::env::var_os("CXX").unwrap_or_else(|| "c++".into());
    if !tool::is_installed(&mut Command::new(&compiler)) {
        return Outcome::Skipped(format!(
            "libFuzzer wants a C++ compiler, and `{}` is not installed",
            compiler.to_string_lossy()
        ));
    }
    replay(context)
}

/// Compares target files, programs of the manifest and folders of seeds.
fn lists(context: &Context) -> Result<Vec<String>, String> {
    let packages = cargo::packages(context, MANIFEST)?;
    let programs: Vec<&Program> = packages.iter().flat_map(|package| &package.programs).collect();
    let folder = context.root.join("fuzz");
    let files = names(&folder.join("fuzz_targets"), |path| {
        path.extension().is_some_and(|ending| ending == "rs")
    })?;
    let mut findings = vec![];
    for name in &files {
        let source = Path::new("fuzz_targets").join(format!("{name}.rs"));
        if !programs.iter().any(|program| program.source == source) {
            findings.push(format!("fuzz_targets/{name}.rs is no [[bin]] of {MANIFEST}"));
        }
    }
    for Program { name, source } in &programs {
        if *source != Path::new("fuzz_targets").join(format!("{name}.rs")) {
            let source = source.display();
            findings.push(format!("the target {name} is in {source}, not in its file"));
        } else if !files.contains(name) {
            findings.push(format!("the target {name} of {MANIFEST} has no file in fuzz_targets"));
        }
        if seeds(context, name).is_ok_and(|seeds| seeds.is_empty()) {
            findings.push(format!("the target {name} has no seed in fuzz/seeds/{name}"));
        }
    }
    for name in names(&folder.join("seeds"), Path::is_dir)? {
        if !programs.iter().any(|program| program.name == name) {
            findings.push(format!("fuzz/seeds/{name} is of no target"));
        }
    }
    Ok(findings)
}

/// Builds the targets and runs each on its seeds.
fn replay(context: &Context) -> Outcome {
    let programs = match cargo::build(context, &["--bins", "--manifest-path", MANIFEST]) {
        Ok(programs) if programs.is_empty() => vec![Err("cargo named no program".to_owned())],
        Ok(programs) => programs.into_iter().map(Ok).collect(),
        Err(error) => vec![Err(error)],
    };
    let results = programs.into_iter().map(|program| {
        let (name, path) = program?;
        let mut command = Command::new(path);
        command.current_dir(&context.root).args(seeds(context, &name)?);
        tool::run(context, &mut command)
    });
    results.filter_map(Result::err).collect::<Vec<_>>().into()
}

/// The seeds of a target, from the root.
fn seeds(context: &Context, target: &str) -> Result<Vec<PathBuf>, String> {
    let folder = Path::new("fuzz/seeds").join(target);
    if !context.root.join(&folder).is_dir() {
        return Ok(vec![]);
    }
    let mut files = vec![];
    for entry in entries(&context.root.join(&folder))?.iter().filter(|path| path.is_file()) {
        files.extend(entry.file_name().map(|name| folder.join(name)));
    }
    Ok(files)
}

/// The names, without extensions, of the entries of one kind in a folder.
fn names(folder: &Path, kind: fn(&Path) -> bool) -> Result<BTreeSet<String>, String> {
    let entries = entries(folder)?.into_iter().filter(|path| kind(path));
    Ok(entries.filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned())).collect())
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let fail = |error| format!("{}: {error}", folder.display());
    let mut paths = vec![];
    for entry in fs::read_dir(folder).map_err(fail)? {
        paths.push(entry.map_err(fail)?.path());
    }
    paths.sort();
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    /// A target that handles files like those of libFuzzer, in two lines.
    const TARGET: &str = "fn main() {\n    for file in std::env::args().skip(1) {\n        \
                          assert!(!std::fs::read_to_string(file).unwrap().contains(\"bad\"));\n    \
                          }\n}\n";

    const BIN: &str = "[[bin]]\nname = \"trc\"\npath = \"fuzz_targets/trc.rs\"\n";

    fn lists_alone(context: &Context) -> Outcome {
        lists(context).map_or_else(Outcome::Failed, Outcome::from)
    }

    fn sound() -> Workspace {
        Workspace::new()
            .file(MANIFEST, "[package]\nname = \"fuzz\"\nedition = \"2024\"\n[workspace]\n")
            .with(MANIFEST, BIN)
            .file("fuzz/fuzz_targets/trc.rs", TARGET)
            .file("fuzz/seeds/trc/good", "good")
            .passes(lists_alone)
    }

    #[test]
    fn a_seed_that_a_target_does_not_take_fails() {
        sound().passes(replay).file("fuzz/seeds/trc/z", "bad").fails(replay, "!std::fs::read");
    }

    #[test]
    fn a_target_that_does_not_build_fails() {
        sound().file("fuzz/fuzz_targets/trc.rs", "fn main() { 1 }").fails(replay, "mismatched");
    }

    #[test]
    fn a_file_that_is_no_target_fails() {
        sound()
            .file("fuzz/fuzz_targets/new.rs", TARGET)
            .fails(run, "fuzz_targets/new.rs is no [[bin]] of fuzz/Cargo.toml");
    }

    #[test]
    fn a_target_without_its_file_fails() {
        let gone = BIN.replace("trc", "gone");
        sound().with(MANIFEST, &gone).fails(run, "the target gone of fuzz/Cargo.toml has no file");
        sound()
            .with_instead(MANIFEST, "name = \"trc\"", "name = \"other\"")
            .fails(run, "the target other is in fuzz_targets/trc.rs, not in its file");
    }

    #[test]
    fn a_target_without_seeds_and_seeds_without_a_target_fail() {
        let new = BIN.replace("trc", "new");
        sound()
            .with(MANIFEST, &new)
            .file("fuzz/fuzz_targets/new.rs", TARGET)
            .fails(run, "the target new has no seed in fuzz/seeds/new");
        sound().file("fuzz/seeds/old/seed", "").fails(run, "fuzz/seeds/old is of no target");
    }
}
