//! Lints, those of the compiler included.

use crate::cargo;
use crate::outcome::{Context, Outcome};

pub(super) fn run(context: &Context) -> Outcome {
    let arguments = ["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"];
    cargo::run(context, &arguments).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    #[test]
    fn a_lint_of_clippy_fails() {
        let sound = Workspace::of_one_crate().passes(run);
        let planted = "\n/// One.\npub fn one() -> u32 {\n    return 1;\n}\n";
        sound.with("src/lib.rs", planted).fails(run, "needless_return");
    }

    #[test]
    fn a_warning_of_the_compiler_in_a_test_fails() {
        let sound = Workspace::of_one_crate().file("tests/twice.rs", "").passes(run);
        let planted = "#[test]\nfn twice() {\n    let unused = 1;\n}\n";
        sound.file("tests/twice.rs", planted).fails(run, "unused variable");
    }
}
