//! `condyle export`: what is seen, as one file to send.

use super::Outcome;
use crate::failure::{Failure, warn_about};
use crate::output;
use clap::{Args, Subcommand};
use condyle_view::{Session, exported};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Export {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Write the page of a model as one HTML file: it opens without a server, poses the model and plays its motions.
    Page(Page),
}

#[derive(Debug, Args)]
struct Page {
    /// The model: a file, or the name of a shipped one.
    model: PathBuf,
    /// Motions of it, or marker recordings, which are tracked.
    motion: Vec<PathBuf>,
    /// A folder in which the meshes are that an `.osim` names, beside its own folder and `Geometry` there.
    #[arg(long, value_name = "DIR")]
    geometry: Vec<PathBuf>,
    /// What stands above the page; without it, the name of the model's file.
    #[arg(long)]
    title: Option<String>,
    /// Files of all formats can be dropped on the page, also models of OpenSim and skeletons of GLB: 0.9 MB more.
    #[arg(long)]
    all_formats: bool,
    /// Where to write the page; `-` is standard output.
    #[arg(short, long, value_name = "X.html")]
    output: PathBuf,
}

impl Export {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        match self.what {
            What::Page(page) => page.run(),
        }
    }
}

impl Page {
    fn run(self) -> Result<Outcome, Failure> {
        let inputs = [&self.model].into_iter().chain(&self.motion);
        let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
        output::check_distinct(&inputs, &[&self.output])?;
        let read = Session::open(&self.model, &self.motion, &self.geometry)?;
        warn_about(&self.model, &read.warnings);
        let mut session = read.value;
        if let Some(title) = self.title {
            session.title = title;
        }
        output::write(&self.output, exported(&session, self.all_formats).as_bytes())?;
        Ok(Outcome::Done)
    }
}
