//! `condyle info`: the contents of a file.

mod law;
mod limit;
mod model;
mod network;
mod recording;
mod setup;
mod table;
mod trial;

use super::{Outcome, ZerosArgument, zeros};
use crate::failure::{Failure, warned};
use crate::output;
use clap::Args;
use condyle::formats::Content;
use condyle::formats::document::goals::NamedGoal;
use condyle::open;
use serde_json::{Value, json};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Info {
    /// A model (a file, or the name of a shipped one), a marker recording, a motion or another table,
    /// a setup of tracking, a table of names, a learned limit, or learned laws.
    file: PathBuf,
    /// What a marker at exactly 0 0 0 is; without it, it is missing where it is elsewhere in other frames.
    #[arg(long, value_enum)]
    zeros: Option<ZerosArgument>,
    /// Whose markers are shown, where the labels of several people begin with their names: `Anna:RFHD`.
    #[arg(long, value_name = "NAME")]
    subject: Option<String>,
    /// One JSON document on standard output, in radians and metres.
    #[arg(long)]
    json: bool,
}

impl Info {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let read = open::content_with(&self.file, None, zeros(self.zeros))?;
        let mut content = warned(&self.file, read);
        if let Some(subject) = &self.subject {
            match &mut content {
                Content::Recording(recording) => *recording = recording.of_subject(subject)?,
                Content::Trial(trial) => {
                    let recording = trial.recording.of_subject(subject)?;
                    content = Content::Recording(recording);
                }
                _ => {}
            }
        }
        if self.json {
            output::print_json(&to_json(&content))?;
        } else {
            let text = format!("{}: {}", self.file.display(), to_text(&content));
            output::print(text.as_bytes())?;
        }
        Ok(Outcome::Done)
    }
}

fn to_json(content: &Content) -> Value {
    match content {
        Content::Model(model) => model::to_json(model),
        Content::Document(document) => model::to_json(&document.model),
        Content::Recording(recording) => recording::to_json(recording),
        Content::Trial(trial) => trial::to_json(trial),
        Content::Table(table) => table::to_json(table),
        Content::Animation(found) => json!({
            "kind": "animation",
            "model": model::to_json(&found.model),
            "motion": table::to_json(&found.motion.to_table(&found.model, found.model.name())),
        }),
        Content::Setup(setup) => setup::to_json(setup),
        Content::Tasks(tasks) => setup::tasks_to_json(tasks),
        Content::Names(table) => json!({
            "kind": "names",
            "names": table.iter().cloned().collect::<std::collections::BTreeMap<_, _>>(),
        }),
        Content::Goals(list) => {
            let goal =
                |goal: &NamedGoal| json!({ "kind": goal.aim.kind(), "name": goal.name.text });
            json!({ "kind": "goals", "goals": list.goals.iter().map(goal).collect::<Vec<_>>() })
        }
        Content::Limit(limit) => limit::to_json(limit),
        Content::Law(law) => law::to_json(law),
        Content::Recipe(recipe) => json!({
            "kind": "recipe",
            "child": recipe.child.name,
            "reference": recipe.reference.as_ref().map(|frame| &frame.name),
            "places": recipe.places(),
        }),
        other => json!({ "kind": other.kind().name() }),
    }
}

fn to_text(content: &Content) -> String {
    match content {
        Content::Model(model) => model::to_text(model),
        Content::Document(document) => model::to_text(&document.model),
        Content::Recording(recording) => recording::to_text(recording),
        Content::Trial(trial) => trial::to_text(trial),
        Content::Table(table) => table::to_text(table),
        Content::Animation(found) => {
            let table = found.motion.to_table(&found.model, found.model.name());
            format!("{}\n{}", model::to_text(&found.model), table::to_text(&table))
        }
        Content::Setup(setup) => setup::to_text(setup),
        Content::Tasks(tasks) => setup::tasks_to_text(tasks),
        Content::TrackSetup(written) => setup::written_to_text(written),
        Content::Names(table) => format!("a table of {} names\n", table.len()),
        Content::Goals(list) => {
            let goal = |goal: &NamedGoal| format!("  {} {}\n", goal.aim.kind(), goal.name.text);
            let goals: String = list.goals.iter().map(goal).collect();
            format!("{} goals of a pose\n{goals}", list.goals.len())
        }
        Content::Limit(limit) => limit::to_text(limit),
        Content::Law(law) => law::to_text(law),
        Content::Spheres(spheres) => format!(
            "a learned limit of {} spheres (Herda et al. 2003): {} in {}\n",
            spheres.limit.field.primitives.len(),
            spheres.about.child,
            spheres.about.reference.as_deref().unwrap_or("the laboratory")
        ),
        Content::Recipe(recipe) => {
            let reference = recipe.reference.as_ref().map_or("laboratory", |frame| &frame.name);
            let places = recipe.places().join(", ");
            format!("a recipe: {} in {reference}, from {places}\n", recipe.child.name)
        }
        other => format!("{}\n", other.kind().name()),
    }
}
