//! The test command, exactly as in the README.

use crate::cargo;
use crate::outcome::{Context, Outcome};

pub(super) fn run(context: &Context) -> Outcome {
    test(context).into()
}

fn test(context: &Context) -> Result<(), String> {
    let readme = std::fs::read_to_string(context.root.join("README.md"))
        .map_err(|error| format!("README.md: {error}"))?;
    let arguments = test_command(&readme).ok_or("README.md gives no line `cargo test …`")?;
    cargo::run(context, &arguments)
}

/// The arguments of the first line that runs the tests.
fn test_command(readme: &str) -> Option<Vec<&str>> {
    let line = readme.lines().find(|line| line.trim().starts_with("cargo test"))?;
    Some(line.split_whitespace().skip(1).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    #[test]
    fn the_command_is_taken_as_it_stands() {
        let readme = "Run `cargo test`:\n\n    cargo run -p x\n    cargo test --workspace\n";
        assert_eq!(test_command(readme), Some(vec!["test", "--workspace"]));
    }

    const README: &str = "# Sound\n\n    cargo test --workspace\n";

    #[test]
    fn a_failing_test_fails() {
        let test = |right| {
            format!("#[test]\nfn twice() {{\n    assert_eq!(sound::twice(2), {right});\n}}\n")
        };
        let sound = Workspace::of_one_crate().file("README.md", README);
        let sound = sound.file("tests/twice.rs", &test(4)).passes(run);
        sound.file("tests/twice.rs", &test(5)).fails(run, "test result: FAILED");
    }

    #[test]
    fn a_failing_example_in_the_documentation_fails() {
        let sound = Workspace::of_one_crate().file("README.md", README);
        let planted =
            "\n/// ```\n/// assert_eq!(sound::twice(2), 5);\n/// ```\npub fn shown() {}\n";
        sound.with("src/lib.rs", planted).fails(run, "test result: FAILED");
    }

    #[test]
    fn a_readme_without_the_command_fails() {
        let silent = Workspace::of_one_crate().fails(run, "README.md: ");
        silent.file("README.md", "# Silent\n").fails(run, "gives no line `cargo test");
    }
}
