//! `condyle info`: what is in a file.

mod model;
mod recording;
mod setup;
mod table;

use super::Outcome;
use crate::failure::{Failure, warned};
use crate::output;
use clap::Args;
use condyle::formats::opensim::setup as ik;
use condyle::formats::{Read, Recording, Table};
use condyle::open::{self, Cause, OpenError};
use condyle::{Model, formats, shipped};
use serde_json::Value;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Info {
    /// A model (a file, or the name of a shipped one), a marker recording, a motion or another table,
    /// or a setup of inverse kinematics.
    file: PathBuf,
    /// One JSON document on standard output, in radians and metres.
    #[arg(long)]
    json: bool,
}

/// What a file turned out to hold.
enum Content {
    Model(Model),
    Recording(Recording),
    Table(Table),
    Setup(ik::IkSetup),
    Tasks(ik::IkTaskSet),
}

impl Info {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let content = warned(&self.file, content(&self.file)?);
        if self.json {
            output::print_json(&content.to_json())?;
        } else {
            output::print(content.to_text(&self.file).as_bytes())?;
        }
        Ok(Outcome::Done)
    }
}

impl Content {
    fn to_json(&self) -> Value {
        match self {
            Self::Model(model) => model::to_json(model),
            Self::Recording(recording) => recording::to_json(recording),
            Self::Table(table) => table::to_json(table),
            Self::Setup(setup) => setup::to_json(setup),
            Self::Tasks(tasks) => setup::tasks_to_json(tasks),
        }
    }

    fn to_text(&self, path: &Path) -> String {
        let name = path.display();
        match self {
            Self::Model(model) => format!("{name}: {}", model::to_text(model)),
            Self::Recording(recording) => format!("{name}: {}", recording::to_text(recording)),
            Self::Table(table) => format!("{name}: {}", table::to_text(table)),
            Self::Setup(setup) => format!("{name}: {}", setup::to_text(setup)),
            Self::Tasks(tasks) => format!("{name}: {}", setup::tasks_to_text(tasks)),
        }
    }
}

fn content(path: &Path) -> Result<Read<Content>, Failure> {
    Ok(match open::ending(path).as_str() {
        // A word that is no file is the name of a shipped model, or a mistake that tells them.
        "" if shipped::asked_for(path).is_some() => open::model(path)?.map(Content::Model),
        "osim" | "toml" => open::model(path)?.map(Content::Model),
        "trc" => open::recording(path)?.map(Content::Recording),
        "mot" | "sto" | "csv" => open::table(path)?.map(Content::Table),
        "xml" => xml(path)?,
        _ => {
            return Err(Failure::new(format!(
                "{}: the ending names no format that can be read (known are .osim, .toml, .trc, \
                 .mot, .sto, .csv, and .xml for setups and models)",
                path.display()
            )));
        }
    })
}

/// An `.xml` file says by its elements what it is.
fn xml(path: &Path) -> Result<Read<Content>, Failure> {
    let no_model = match open::model(path) {
        Ok(model) => return Ok(model.map(Content::Model)),
        Err(error) if is_about(&error, "osim/no-model") => error,
        Err(error) => return Err(error.into()),
    };
    match open::ik_setup(path) {
        Ok(setup) => return Ok(setup.map(Content::Setup)),
        Err(error) if is_about(&error, "setup/not-ik") => {}
        Err(error) => return Err(error.into()),
    }
    let bytes = std::fs::read(path)
        .map_err(|error| Failure::new(format!("{}: {error}", path.display())))?;
    match ik::tasks_from_bytes(&bytes) {
        Ok(tasks) => Ok(tasks.map(Content::Tasks)),
        Err(error) if error.code() == "setup/no-tasks" => {
            let place = match &no_model.cause {
                Cause::Content { error, .. } => error.place(),
                _ => None,
            };
            let said = formats::Diagnostic::error(
                "info/unknown",
                "the file holds no <Model>, no <InverseKinematicsTool> and no <IKTaskSet>",
            );
            let said = formats::Diagnostic { place, ..said }
                .with_help("give a model, or a setup of OpenSim's inverse kinematics");
            Err(Failure::new(open::located(path, &said)))
        }
        Err(error) => Err(Failure::about(path, &error)),
    }
}

fn is_about(error: &OpenError, code: &str) -> bool {
    matches!(&error.cause, Cause::Content { error, .. } if error.code() == code)
}
