//! The `condyle` command.
//!
//! Exit codes: 0 success; 1 the input was read but a requested condition does not hold; 2 unusable
//! arguments or input. Results go to standard output or `-o`, everything else to standard error.

// Both panic where nobody can be told: `output` and `screen` do not.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod commands;
mod digest;
mod failure;
mod motion_format;
mod output;
mod progress;
mod screen;

use clap::Parser;
use screen::say;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = commands::Arguments::parse();
    match commands::run(arguments) {
        Ok(commands::Outcome::Done) => ExitCode::SUCCESS,
        Ok(commands::Outcome::DoesNotHold) => ExitCode::from(1),
        Err(failure) => {
            say(&format!("error: {failure}"));
            ExitCode::from(2)
        }
    }
}
