//! The `condyle` command.
//!
//! Exit codes: 0 success; 1 the input was read but a requested condition does not hold; 2 unusable
//! arguments or input. Results go to standard output or `-o`, everything else to standard error.

mod commands;
mod failure;
mod motion_format;
mod output;
mod progress;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = commands::Arguments::parse();
    match commands::run(arguments) {
        Ok(commands::Outcome::Done) => ExitCode::SUCCESS,
        Ok(commands::Outcome::DoesNotHold) => ExitCode::from(1),
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::from(2)
        }
    }
}
