//! The project's checks, with the same command on a laptop and in CI.
//!
//! `cargo xtask ci` runs them all, `cargo xtask NAME` one of them; each has a file in `checks/`.
//! `cargo xtask instructions --bless` rewrites the committed counts, `cargo xtask page --bless`
//! builds the page anew, `cargo xtask papers` makes the figures of the papers.

mod cargo;
mod checks;
mod outcome;
mod papers;
mod tool;
#[cfg(test)]
mod workspace;

use checks::CHECKS;
use outcome::{Context, Outcome};
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [first, rest @ ..] = &arguments[..]
        && first == "papers"
    {
        return papers(rest);
    }
    let bless = arguments.iter().any(|argument| argument == "--bless");
    let names: Vec<&str> =
        arguments.iter().map(String::as_str).filter(|name| *name != "--bless").collect();
    let chosen: Vec<&checks::Check> = match names[..] {
        ["ci"] => CHECKS.iter().collect(),
        [name] => CHECKS.iter().filter(|check| check.name == name).collect(),
        _ => vec![],
    };
    if chosen.is_empty() || (bless && names != ["instructions"] && names != ["page"]) {
        usage();
        return ExitCode::from(2);
    }
    let context = Context { root: cargo::root(), bless, trial: None };
    let (mut passed, mut failed, mut skipped) = (0, vec![], vec![]);
    for check in chosen {
        println!("== {}: {}", check.name, check.what);
        let start = Instant::now();
        let outcome = (check.run)(&context);
        let seconds = start.elapsed().as_secs_f64();
        match outcome {
            Outcome::Passed => {
                println!("== {} passed ({seconds:.1} s)", check.name);
                passed += 1;
            }
            Outcome::Failed(why) => {
                println!("== {} FAILED ({seconds:.1} s): {why}", check.name);
                failed.push(check.name);
            }
            Outcome::Skipped(why) => {
                println!("== {} skipped: {why}", check.name);
                skipped.push(check.name);
            }
        }
    }
    println!(
        "{passed} passed, {} failed{}, {} skipped{}",
        failed.len(),
        listed(&failed),
        skipped.len(),
        listed(&skipped)
    );
    if failed.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// `papers [FOLDER] [--only NAME]`.
fn papers(arguments: &[String]) -> ExitCode {
    let context = Context { root: cargo::root(), bless: false, trial: None };
    let texts: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let made = match texts[..] {
        [] => papers::run(&context, None, None),
        [folder] if !folder.starts_with('-') => papers::run(&context, Some(folder), None),
        ["--only", name] => papers::run(&context, None, Some(name)),
        [folder, "--only", name] => papers::run(&context, Some(folder), Some(name)),
        _ => {
            usage();
            return ExitCode::from(2);
        }
    };
    match made {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

fn listed(names: &[&str]) -> String {
    if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) }
}

fn usage() {
    eprintln!(
        "usage: cargo xtask ci | CHECK | instructions --bless | page --bless | papers [FOLDER] [--only NAME]\n\nchecks, in the order of ci:"
    );
    for check in CHECKS {
        eprintln!("  {:<13} {}", check.name, check.what);
    }
}
