//! Cargo, and its metadata of a workspace: manifests are read by cargo only, so that every notation
//! of a dependency is recognised.

use crate::outcome::Context;
use crate::tool;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The root of the workspace: the folder above this package.
pub(crate) fn root() -> PathBuf {
    let package = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    package.parent().map(PathBuf::from).unwrap_or(package)
}

/// The cargo that runs this program, at the root of the workspace.
pub(crate) fn command(context: &Context) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(&context.root);
    if let Some(folder) = &context.trial {
        command.env("CARGO_TARGET_DIR", folder).env("CARGO_TERM_COLOR", "never");
    }
    command
}

/// Runs cargo with these arguments; it inherits our output.
pub(crate) fn run(context: &Context, arguments: &[&str]) -> Result<(), String> {
    tool::run(context, command(context).args(arguments))
}

/// The folder of what cargo builds.
pub(crate) fn target_folder(context: &Context) -> Result<PathBuf, String> {
    let mut command = command(context);
    command.args(["metadata", "--format-version", "1", "--no-deps"]);
    let answer = tool::output(context, &mut command)?;
    let answer: Value = serde_json::from_str(&answer).map_err(|error| error.to_string())?;
    Ok(text(&answer, "target_directory")?.into())
}

/// A package of a workspace.
pub(crate) struct Package {
    /// Its name.
    pub(crate) name: String,
    /// Its folder, from the root of its workspace.
    pub(crate) folder: PathBuf,
    /// Its dependencies, of every section and for every platform.
    pub(crate) dependencies: Vec<Dependency>,
    /// The programs built from it.
    pub(crate) programs: Vec<Program>,
}

/// A dependency of a package.
pub(crate) struct Dependency {
    /// The name of the other package, even if it is renamed here.
    pub(crate) name: String,
    /// Whether it is for tests, benches and examples only.
    pub(crate) for_tests: bool,
}

/// A program of a package.
pub(crate) struct Program {
    /// Its name.
    pub(crate) name: String,
    /// Its main file, from the root of its workspace.
    pub(crate) source: PathBuf,
}

/// The packages of the workspace of a manifest.
pub(crate) fn packages(context: &Context, manifest: &str) -> Result<Vec<Package>, String> {
    let mut command = command(context);
    command.args(["metadata", "--no-deps", "--offline", "--format-version", "1"]);
    command.args(["--manifest-path", manifest]);
    let said = tool::output(context, &mut command)?;
    let said: Value = serde_json::from_str(&said).map_err(|error| format!("cargo: {error}"))?;
    let root = Path::new(text(&said, "workspace_root")?);
    list(&said, "packages")?.iter().map(|package| Package::read(package, root)).collect()
}

impl Package {
    fn read(package: &Value, root: &Path) -> Result<Self, String> {
        let inside = |path| {
            let path = Path::new(path);
            path.strip_prefix(root).unwrap_or(path).to_owned()
        };
        let mut programs = vec![];
        for target in list(package, "targets")? {
            if list(target, "kind")?.iter().any(|kind| kind == "bin") {
                let source = inside(text(target, "src_path")?);
                programs.push(Program { name: text(target, "name")?.to_owned(), source });
            }
        }
        let mut dependencies = vec![];
        for used in list(package, "dependencies")? {
            let for_tests = used["kind"] == "dev";
            dependencies.push(Dependency { name: text(used, "name")?.to_owned(), for_tests });
        }
        let folder = inside(text(package, "manifest_path")?).parent().map(PathBuf::from);
        let name = text(package, "name")?.to_owned();
        Ok(Self { name, folder: folder.unwrap_or_default(), dependencies, programs })
    }
}

/// Builds with these arguments of `cargo build`; the resulting programs, by name.
pub(crate) fn build(
    context: &Context,
    arguments: &[&str],
) -> Result<Vec<(String, PathBuf)>, String> {
    let mut command = command(context);
    command.arg("build").args(arguments).arg("--message-format=json-render-diagnostics");
    let mut programs = vec![];
    for line in tool::output(context, &mut command)?.lines().filter(|line| line.starts_with('{')) {
        let message: Value =
            serde_json::from_str(line).map_err(|error| format!("cargo: {error}"))?;
        if let Some(program) = message["executable"].as_str() {
            programs.push((text(&message["target"], "name")?.to_owned(), program.into()));
        }
    }
    Ok(programs)
}

fn text<'v>(value: &'v Value, key: &str) -> Result<&'v str, String> {
    value[key].as_str().ok_or_else(|| format!("cargo gave no `{key}`"))
}

fn list<'v>(value: &'v Value, key: &str) -> Result<&'v [Value], String> {
    value[key].as_array().map(Vec::as_slice).ok_or_else(|| format!("cargo gave no `{key}`"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    #[test]
    fn dependencies_are_found_however_they_are_written() {
        let workspace = Workspace::new().file(
            "Cargo.toml",
            "[package]\nname = \"x\"\n\
             [lib]\npath = \"x.rs\"\n\
             [dependencies]\na.version = \"1\"\nrenamed = { package = \"b\", version = \"1\" }\n\
             [dependencies.c]\nversion = \"1\"\n\
             [target.'cfg(unix)'.dependencies]\nd = \"1\"\n\
             [target.'cfg(unix)'.dependencies.e]\nversion = \"1\"\n\
             [build-dependencies]\nf = \"1\"\n\
             [dev-dependencies]\ng = \"1\"\n",
        );
        let packages = packages(&workspace.context(), "Cargo.toml").expect("cargo reads it");
        let [package] = &packages[..] else { panic!("one package") };
        let names = |for_tests| {
            let of = package.dependencies.iter().filter(|used| used.for_tests == for_tests);
            let mut names: Vec<&str> = of.map(|used| used.name.as_str()).collect();
            names.sort_unstable();
            names.concat()
        };
        assert_eq!((names(false).as_str(), names(true).as_str()), ("abcdef", "g"));
        assert_eq!((package.name.as_str(), package.folder.as_path()), ("x", Path::new("")));
    }
}
