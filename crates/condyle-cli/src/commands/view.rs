//! `condyle view`: the page in the browser.

use super::Outcome;
use crate::failure::{Failure, warn_about};
use crate::screen::say;
use clap::Args;
use condyle_view::server::{Server, StartError, Wanted};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

#[derive(Debug, Args)]
pub(crate) struct View {
    /// The model: a file, or the name of a shipped one; without it, files can be dropped onto the page.
    model: Option<PathBuf>,
    /// Motions of the model, and recordings, which are tracked.
    #[arg(requires = "model")]
    motion: Vec<PathBuf>,
    /// The port of the page's address; without it, one that is free.
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
    /// A folder in which the meshes are that an `.osim` names, beside its own folder and `Geometry` there.
    #[arg(long, value_name = "DIR")]
    geometry: Vec<PathBuf>,
    /// Do not open a browser: only print the address.
    #[arg(long)]
    no_open: bool,
}

impl View {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let runtime =
            tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build();
        let runtime = runtime.map_err(|error| Failure::new(format!("no threads: {error}")))?;
        let named = self.model.clone().unwrap_or_default();
        let wanted = Wanted {
            model: self.model,
            motions: self.motion,
            meshes: self.geometry,
            port: self.port,
            folder: PathBuf::new(),
        };
        runtime.block_on(async {
            let started = Server::start(wanted).await.map_err(|error| match error {
                StartError::Open(error) => Failure::from(error),
                StartError::Io(error) => Failure::new(format!("port {}: {error}", self.port)),
            })?;
            warn_about(Path::new(&named), &started.warnings);
            let server = started.value;
            let address = server.address();
            crate::output::print(format!("{address}\n").as_bytes())?;
            say("the page is there until this ends: ctrl-c");
            if !self.no_open && !open_browser(&address) {
                say("no browser was found: open this address in one");
            }
            let end = async {
                // Without a handler the signal ends the process as well.
                let _ = tokio::signal::ctrl_c().await;
            };
            server.run(end).await.map_err(|error| Failure::new(error.to_string()))
        })?;
        Ok(Outcome::Done)
    }
}

/// Asks the system to open an address; whether a program for that was found.
fn open_browser(address: &str) -> bool {
    let programs: &[&[&str]] = if cfg!(target_os = "macos") {
        &[&["open"]]
    } else if cfg!(windows) {
        &[&["rundll32", "url.dll,FileProtocolHandler"]]
    } else {
        &[&["xdg-open"], &["gio", "open"], &["wslview"]]
    };
    programs.iter().any(|program| {
        let Some((name, arguments)) = program.split_first() else { return false };
        let mut command = Command::new(name);
        command.args(arguments).arg(address);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        command.spawn().is_ok()
    })
}
