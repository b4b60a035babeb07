//! The evaluator in Python: it poses the conformance model and all shipped models as the library does.

use crate::cargo;
use crate::outcome::{Context, Outcome};
use crate::tool;
use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};

/// The program that is compared.
const EVALUATOR: &str = "examples/evaluator.py";

/// Where the shipped models are.
const MODELS: &str = "crates/condyle/models";

/// How many poses of each shipped model are compared, open and posed.
const POSES: &str = "100";

pub(super) fn run(context: &Context) -> Outcome {
    let python = std::env::var_os("PYTHON").unwrap_or_else(|| "python3".into());
    let mut import = Command::new(&python);
    import.args(["-c", "import numpy"]).stdout(Stdio::null()).stderr(Stdio::null());
    if !import.status().is_ok_and(|status| status.success()) {
        let python = python.to_string_lossy().into_owned();
        let why = format!("`{python}` with NumPy is not there (PYTHON may name another)");
        return Outcome::Skipped(why);
    }
    compare(context, &python).into()
}

fn compare(context: &Context, python: &OsString) -> Result<(), String> {
    let docs = context.root.join("docs/exchange");
    pair(context, python, &docs, "conformance")?;
    let example = ["--package", "condyle", "--example", "conformance"];
    let programs = cargo::build(context, &example)?;
    let (_, program) = programs.first().ok_or("cargo named no program")?;
    let folder = context.root.join("target/exchange");
    for name in models(&context.root.join(MODELS))? {
        let mut command = Command::new(program);
        tool::run(context, command.args([&name, POSES]).arg(&folder).current_dir(&context.root))?;
        pair(context, python, &folder, &name)?;
    }
    Ok(())
}

/// Compares one model with its poses.
fn pair(context: &Context, python: &OsString, folder: &Path, name: &str) -> Result<(), String> {
    let mut command = Command::new(python);
    command.arg(EVALUATOR).current_dir(&context.root);
    for ending in ["json", "poses.json"] {
        command.arg(folder.join(format!("{name}.{ending}")));
    }
    tool::run(context, &mut command)
}

/// The names of the shipped models.
fn models(folder: &Path) -> Result<Vec<String>, String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let toml = |path: &Path| path.extension().is_some_and(|ending| ending == "toml");
    let mut names: Vec<String> = entries
        .filter_map(|entry| Some(entry.ok()?.path()).filter(|path| toml(path)))
        .filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    if names.is_empty() { Err(format!("{}: no model", folder.display())) } else { Ok(names) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn context() -> Context {
        Context { root: cargo::root(), bless: false, trial: Some("unused".into()) }
    }

    #[test]
    #[cfg(unix)]
    fn an_evaluator_that_disagrees_fails_the_check() {
        let folder = cargo::root().join("docs/exchange");
        assert!(pair(&context(), &"false".into(), &folder, "conformance").is_err());
        assert_eq!(pair(&context(), &"true".into(), &folder, "conformance"), Ok(()));
    }

    #[test]
    fn every_shipped_model_is_compared_and_a_folder_without_any_is_an_error() {
        let names = models(&cargo::root().join(MODELS)).unwrap();
        assert!(names.contains(&"human".to_owned()) && names.len() >= 10, "{names:?}");
        assert!(models(&cargo::root().join("docs/exchange/nothing")).is_err());
        assert!(models(&cargo::root().join("docs/pictures")).is_err());
    }
}
