//! Dependencies: what `deny.toml` allows.

use crate::outcome::{Context, Outcome};
use crate::tool;

pub(super) fn run(_: &Context) -> Outcome {
    if !tool::is_installed(tool::cargo().arg("deny")) {
        return Outcome::Skipped("cargo-deny is not installed (cargo install cargo-deny)".into());
    }
    tool::run_cargo(&["deny", "check", "bans", "licenses", "sources"]).into()
}
