//! The test command, word for word as the README gives it.

use crate::outcome::{Context, Outcome};
use crate::tool::run_cargo;

pub(super) fn run(context: &Context) -> Outcome {
    test(context).into()
}

fn test(context: &Context) -> Result<(), String> {
    let readme = std::fs::read_to_string(context.root.join("README.md"))
        .map_err(|error| format!("README.md: {error}"))?;
    let arguments = test_command(&readme).ok_or("README.md gives no line `cargo test …`")?;
    run_cargo(&arguments)
}

/// The arguments of the first line that runs the tests.
fn test_command(readme: &str) -> Option<Vec<&str>> {
    let line = readme.lines().find(|line| line.trim().starts_with("cargo test"))?;
    Some(line.split_whitespace().skip(1).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_is_taken_as_it_stands() {
        let readme = "Run `cargo test`:\n\n    cargo run -p x\n    cargo test --workspace\n";
        assert_eq!(test_command(readme), Some(vec!["test", "--workspace"]));
    }
}
