//! Formatting.

use crate::outcome::{Context, Outcome};
use crate::tool::run_cargo;

pub(super) fn run(_: &Context) -> Outcome {
    run_cargo(&["fmt", "--all", "--check"]).into()
}
