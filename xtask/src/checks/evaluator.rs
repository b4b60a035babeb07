//! The evaluator of the page in Node: it poses all shipped models as the library does, to 1e-12, and so it does those of files
//! that the second module reads.

use super::page::PAGE;
use crate::cargo;
use crate::outcome::{Context, Outcome};
use crate::tool;
use std::process::Command;

pub(super) fn run(context: &Context) -> Outcome {
    for needed in ["node", "xz"] {
        if !tool::is_installed(&mut Command::new(needed)) {
            return Outcome::Skipped(format!("`{needed}` is not installed"));
        }
    }
    compare(context).into()
}

fn compare(context: &Context) -> Result<(), String> {
    let folder = context.root.join("target/golden-poses");
    let example = ["--package", "condyle-wasm", "--features", "readers", "--example", "golden"];
    let programs = cargo::build(context, &example)?;
    let (_, program) = programs.first().ok_or("cargo named no program")?;
    tool::run(context, Command::new(program).arg(&folder))?;
    let script = context.root.join(PAGE).join("test/golden.mjs");
    tool::run(context, Command::new("node").arg(script).arg(&folder))
}
