//! Formatting.

use crate::cargo;
use crate::outcome::{Context, Outcome};

pub(super) fn run(context: &Context) -> Outcome {
    cargo::run(context, &["fmt", "--all", "--check"]).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    #[test]
    fn an_unformatted_line_fails() {
        let sound = Workspace::of_one_crate().passes(run);
        sound.with("src/lib.rs", "\nconst  WIDE : u32=1;\n").fails(run, "const  WIDE : u32=1;");
    }
}
