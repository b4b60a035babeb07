//! The page in a real browser: pixels, sliders, dragging, motions, files.

use super::page::PAGE;
use crate::cargo;
use crate::outcome::{Context, Outcome};
use crate::tool;
use std::process::Command;
use std::time::Duration;

/// What is run: the page as a file and as a static site, the page as it is served, which edits a model, what people need
/// who see little or use keys alone, meshes, skins and rows of figures, poses over time and by goals, rotations in the
/// space of quaternions, and that the page shows what `condyle render` shows.
const SCRIPTS: [&str; 7] = [
    "browser.mjs",
    "authoring.mjs",
    "accessible.mjs",
    "looks.mjs",
    "posing.mjs",
    "rotations.mjs",
    "render.mjs",
];
/// The texts of the shipped models.
const MODELS: &str = "crates/condyle/models";
/// The longest that each of them may take, on a machine that does other things as well.
const LIMIT: Duration = Duration::from_secs(1200);

pub(super) fn run(context: &Context) -> Outcome {
    let named = std::env::var_os("CHROMIUM");
    let known = ["chromium", "chromium-browser", "google-chrome"].map(Into::into);
    let mut browsers = named.into_iter().chain(known);
    let Some(browser) = browsers.find(|name| tool::is_installed(&mut Command::new(name))) else {
        return Outcome::Skipped("no Chromium is installed (CHROMIUM may name one)".to_owned());
    };
    let page = context.root.join(PAGE);
    if !tool::is_installed(&mut Command::new("node")) {
        return Outcome::Skipped("node is not installed".to_owned());
    }
    if !page.join("node_modules/playwright-core").is_dir() {
        let why = format!("its packages are not there: `npm ci` in {PAGE} installs them");
        return Outcome::Skipped(why);
    }
    let built = cargo::build(context, &["--package", "condyle-cli"]);
    let result = built.and_then(|programs| {
        let (_, command) = programs.first().ok_or("cargo named no program")?;
        for script in SCRIPTS {
            let mut node = Command::new("node");
            node.arg(page.join("test").join(script)).arg(command).arg(which(&browser));
            tool::run_within(LIMIT, node.arg(context.root.join(MODELS)))?;
        }
        Ok(())
    });
    result.into()
}

/// The path of a program.
fn which(name: &std::ffi::OsStr) -> std::ffi::OsString {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&folders).map(|folder| folder.join(name));
    found.into_iter().find(|path| path.is_file()).map_or_else(|| name.to_owned(), Into::into)
}
