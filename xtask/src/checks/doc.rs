//! Documentation: a broken link is an error.

use crate::outcome::{Context, Outcome};
use crate::tool;

pub(super) fn run(_: &Context) -> Outcome {
    let mut command = tool::cargo();
    command.args(["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings");
    tool::run(&mut command).into()
}
