//! Dependencies: what `deny.toml` allows, and known vulnerabilities.
//!
//! Vulnerabilities are looked up in a database that is downloaded. If that fails, one downloaded
//! before is used; if there is none, the check reports that and continues: a network that is down
//! is not an error of this project.

use crate::outcome::{Context, Outcome};
use crate::{cargo, tool};
use std::path::PathBuf;
use std::time::Duration;

/// How long downloading the database of vulnerabilities may take.
const PATIENCE: Duration = Duration::from_secs(90);

pub(super) fn run(context: &Context) -> Outcome {
    if !is_installed(context) {
        return Outcome::Skipped("cargo-deny is not installed (cargo install cargo-deny)".into());
    }
    if let Err(error) = cargo::run(context, &["deny", "check", "bans", "licenses", "sources"]) {
        return Outcome::Failed(error);
    }
    advisories(
        || tool::run_within(PATIENCE, cargo::command(context).args(["deny", "fetch", "db"])),
        has_database,
        || cargo::run(context, &["deny", "--offline", "check", "advisories"]),
    )
    .into()
}

fn is_installed(context: &Context) -> bool {
    tool::is_installed(cargo::command(context).arg("deny"))
}

/// Checks against the database of vulnerabilities, if there is one.
fn advisories(
    fetch: impl FnOnce() -> Result<(), String>,
    has_database: impl FnOnce() -> bool,
    check: impl FnOnce() -> Result<(), String>,
) -> Result<(), String> {
    if let Err(error) = fetch() {
        if !has_database() {
            println!("   advisories skipped: no database could be fetched ({error})");
            return Ok(());
        }
        println!("   the database of advisories is that of an earlier day ({error})");
    }
    check()
}

/// Whether a database was downloaded before: each is a folder where cargo-deny keeps them.
fn has_database() -> bool {
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(std::env::home_dir()?.join(".cargo")));
    let Some(kept) = home.map(|home| home.join("advisory-dbs")) else { return false };
    // An interrupted clone has its `.git` but nothing checked out.
    std::fs::read_dir(kept)
        .is_ok_and(|kept| kept.flatten().any(|entry| entry.path().join("crates").is_dir()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Workspace;

    /// Checks a crate against the project's own rules only: tests download nothing.
    fn rules(context: &Context) -> Outcome {
        cargo::run(context, &["deny", "--offline", "check", "bans", "licenses", "sources"]).into()
    }

    fn sound() -> Option<Workspace> {
        let workspace = Workspace::of_one_crate();
        if !is_installed(&workspace.context()) {
            eprintln!("skipped: cargo-deny is not installed");
            return None;
        }
        let file = cargo::root().join("deny.toml");
        let rules = std::fs::read_to_string(file).expect("the project has rules");
        Some(workspace.file("deny.toml", &rules))
    }

    #[test]
    fn a_licence_that_is_not_allowed_fails() {
        let Some(sound) = sound() else { return };
        sound
            .passes(rules)
            .with_instead("Cargo.toml", "\"MIT\"", "\"GPL-3.0-only\"")
            .fails(rules, "licenses FAILED")
            .fails(run, "licenses FAILED");
    }

    #[test]
    fn two_versions_of_one_crate_fail() {
        let Some(sound) = sound() else { return };
        let twin = |version| {
            format!("[package]\nname = \"twin\"\nversion = \"{version}\"\nlicense = \"MIT\"\n")
        };
        let one =
            "[dependencies]\nfirst = { package = \"twin\", version = \"1\", path = \"first\" }\n";
        let two = "second = { package = \"twin\", version = \"2\", path = \"second\" }\n";
        sound
            .file("first/Cargo.toml", &twin("1.0.0"))
            .file("first/src/lib.rs", "")
            .file("second/Cargo.toml", &twin("2.0.0"))
            .file("second/src/lib.rs", "")
            .with_instead("Cargo.toml", "[workspace]\n", one)
            .passes(rules)
            .with("Cargo.toml", two)
            .fails(rules, "bans FAILED");
    }

    #[test]
    fn a_known_fault_fails_with_a_database_of_any_age() {
        let fault = || Err("a fault".to_owned());
        let no_network = || Err("no network".to_owned());
        assert_eq!(advisories(|| Ok(()), || unreachable!(), fault), fault());
        assert_eq!(advisories(|| Ok(()), || unreachable!(), || Ok(())), Ok(()));
        assert_eq!(advisories(no_network, || true, fault), fault());
        assert_eq!(advisories(no_network, || true, || Ok(())), Ok(()));
    }

    #[test]
    fn no_network_and_no_database_are_no_fault() {
        let no_network = || Err("no network".to_owned());
        assert_eq!(advisories(no_network, || false, || unreachable!()), Ok(()));
    }
}
