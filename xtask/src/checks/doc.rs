//! Documentation: a broken link is an error.

use crate::outcome::{Context, Outcome};
use crate::{cargo, tool};

pub(super) fn run(context: &Context) -> Outcome {
    let mut command = cargo::command(context);
    command.args(["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings");
    tool::run(context, &mut command).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    #[test]
    fn a_link_to_nowhere_fails() {
        let sound = Workspace::of_one_crate().passes(run);
        let planted = "\n/// Unlike [`thrice`].\npub fn once() {}\n";
        sound.with("src/lib.rs", planted).fails(run, "unresolved link to `thrice`");
    }
}
