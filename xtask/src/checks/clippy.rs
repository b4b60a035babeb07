//! Lints, those of the compiler included.

use crate::outcome::{Context, Outcome};
use crate::tool::run_cargo;

pub(super) fn run(_: &Context) -> Outcome {
    run_cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]).into()
}
