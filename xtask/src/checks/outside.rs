//! What a user builds: the facade with few features, a program outside the workspace whose only
//! dependency is the facade, and that program for the browser where the target is installed.

use crate::cargo;
use crate::outcome::{Context, Outcome};
use crate::tool;
use std::path::Path;
use std::process::Command;

/// A program that has the facade as its only dependency.
const MANIFEST: &str = "examples/streaming/Cargo.toml";

/// Features of the facade that must build alone.
const FEATURES: [&str; 6] = ["", "formats", "document", "opensim", "poses", "glb"];

/// The target of browsers.
const BROWSER: &str = "wasm32-unknown-unknown";

/// Runs a module's `main` in Node; a panic in it is an error there.
const NODE: &str = "const fs = require('fs'); WebAssembly.instantiate(fs.readFileSync(process.argv[1]))\
                    .then(m => m.instance.exports.main(0, 0))\
                    .catch(e => { console.error(e); process.exit(1); })";

pub(super) fn run(context: &Context) -> Outcome {
    features(context).and_then(|()| outside(context)).into()
}

fn features(context: &Context) -> Result<(), String> {
    for features in FEATURES {
        let arguments = ["check", "--package", "condyle", "--no-default-features", "--features"];
        let mut command = cargo::command(context);
        command.args(arguments).arg(features).env("RUSTFLAGS", "-D warnings");
        // Other flags would build everything else anew.
        command.env("CARGO_TARGET_DIR", context.root.join("target/features"));
        tool::run(context, &mut command)?;
    }
    Ok(())
}

fn outside(context: &Context) -> Result<(), String> {
    cargo::run(context, &["run", "--manifest-path", MANIFEST])?;
    let mut rustc = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    rustc.args(["--print", "target-libdir", "--target", BROWSER]);
    let library = tool::output(context, &mut rustc)?;
    if !Path::new(library.trim()).is_dir() {
        println!("   the target {BROWSER} is not installed: not built for the browser");
        return Ok(());
    }
    let arguments = ["--release", "--target", BROWSER, "--manifest-path", MANIFEST];
    for (_, program) in cargo::build(context, &arguments)? {
        if tool::is_installed(&mut Command::new("node")) {
            tool::run(context, Command::new("node").args(["-e", NODE]).arg(&program))?;
        } else {
            println!("   node is not installed: built for the browser, not run");
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    /// A facade of one function, and a program that calls it.
    fn sound() -> Workspace {
        let features: String = FEATURES[1..].iter().map(|f| format!("{f} = []\n")).collect();
        Workspace::new()
            .file(
                "Cargo.toml",
                &format!(
                    "[package]\nname = \"condyle\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
                     [features]\n{features}\n[workspace]\nexclude = [\"examples\"]\n"
                ),
            )
            .file(
                "src/lib.rs",
                "//! Sound.\n\n/// Twice.\npub fn twice(x: u32) -> u32 {\n    2 * x\n}\n",
            )
            .file(
                MANIFEST,
                "[package]\nname = \"streaming\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
                 [workspace]\n\n[dependencies]\ncondyle = { path = \"../..\" }\n",
            )
            .file(
                "examples/streaming/src/main.rs",
                "fn main() {\n    assert_eq!(condyle::twice(2), 4);\n}\n",
            )
    }

    #[test]
    fn a_program_that_panics_fails() {
        let main = "examples/streaming/src/main.rs";
        sound().passes(run).with_instead(main, "4", "5").fails(run, "streaming");
    }

    #[test]
    fn a_type_that_cannot_be_named_fails() {
        sound().with_instead("src/lib.rs", "pub fn", "fn").fails(run, "twice");
    }

    #[test]
    fn a_feature_that_does_not_build_alone_fails() {
        let planted =
            "\n#[cfg(all(feature = \"glb\", not(feature = \"opensim\")))]\nfn unused() {}\n";
        sound().with("src/lib.rs", planted).fails(run, "unused");
    }
}
