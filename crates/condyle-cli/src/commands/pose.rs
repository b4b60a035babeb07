//! `condyle pose`: the pose that meets goals.

use super::Outcome;
use crate::failure::{Failure, warned};
use crate::output;
use clap::Args;
use condyle::formats::document::goals::GoalList;
use condyle::formats::poses;
use condyle::open::{self, Cause, OpenError};
use condyle::posing::{self, By, Miss, Posed};
use condyle::{CoordinateId, CoordinateKind, Model};
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Pose {
    /// The model: a file, or the name of a shipped one.
    model: PathBuf,
    /// What the pose should do: a document of `kind = "goals"`.
    goals: PathBuf,
    /// A pose in JSON to be near, in place of the model's rest.
    #[arg(long, value_name = "P.json")]
    rest: Option<PathBuf>,
    /// Where to write the pose, in JSON; `-` is standard output.
    #[arg(short, long, value_name = "P.json")]
    output: Option<PathBuf>,
    /// One JSON document on standard output.
    #[arg(long)]
    json: bool,
}

/// A coordinate that is nearer to rest than this, in radians or metres, is not listed.
const MOVED: f64 = 1e-6;

impl Pose {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let to_screen = self.output.as_deref() == Some(Path::new("-"));
        if to_screen && self.json {
            let message = "--json and -o - both want standard output: give one of them";
            return Err(Failure::new(message));
        }
        let inputs: Vec<&Path> = [&self.model, &self.goals]
            .into_iter()
            .chain(&self.rest)
            .map(PathBuf::as_path)
            .collect();
        let outputs: Vec<&Path> = self.output.iter().map(PathBuf::as_path).collect();
        output::check_distinct(&inputs, &outputs)?;
        let model = warned(&self.model, open::model(&self.model)?);
        let list = warned(&self.goals, open::goals(&self.goals)?);
        let rest = match &self.rest {
            Some(path) => Some(self.rest(path, &model)?),
            None => None,
        };
        let posed = posing::pose(&model, &list, rest.as_deref()).map_err(|error| {
            let text = std::fs::read_to_string(&self.goals).ok();
            Failure::from(OpenError {
                path: self.goals.clone(),
                cause: Cause::Content { error, text },
            })
        })?;
        if let Some(path) = &self.output {
            output::write(path, poses::write(&model, &posed.answer.coordinates).as_bytes())?;
        }
        if self.json {
            output::print_json(&report(&model, &list, &posed))?;
        } else if !to_screen {
            output::print(table(&model, &list, &posed).as_bytes())?;
        }
        Ok(if posed.answer.is_met() { Outcome::Done } else { Outcome::DoesNotHold })
    }

    fn rest(&self, path: &Path, model: &Model) -> Result<Vec<f64>, Failure> {
        let mut poses = warned(path, open::poses(path, model)?);
        match poses.motion.frames.len() {
            1 => Ok(poses.motion.frames.swap_remove(0)),
            count => {
                let path = path.display();
                Err(Failure::new(format!("{path}: the file holds {count} poses: give one")))
            }
        }
    }
}

/// What a goal lacks, with its unit.
fn lacks(miss: &Miss) -> String {
    if miss.angle {
        format!("{:.3}°", miss.off.to_degrees())
    } else {
        format!("{:.3} mm", 1e3 * miss.off)
    }
}

/// How a coordinate is written down: its value and how far it is from rest, if that can be seen.
fn moved(model: &Model, posed: &Posed, id: CoordinateId) -> Option<(String, String)> {
    let (now, rest) = (&posed.answer.coordinates, &posed.goals.rest.pose);
    let place = model.stored_range(id);
    if !place.clone().any(|i| (now[i] - rest[i]).abs() > MOVED) {
        return None;
    }
    let (value, change) = (now[place.start], now[place.start] - rest[place.start]);
    Some(match model.coordinate(id).kind {
        CoordinateKind::Rotation => {
            (format!("{:.2}°", value.to_degrees()), format!("{:+.2}°", change.to_degrees()))
        }
        CoordinateKind::Translation => {
            (format!("{:.2} mm", 1e3 * value), format!("{:+.2} mm", 1e3 * change))
        }
        CoordinateKind::Orientation => {
            let q = now[place].iter().map(|v| format!("{v:.4}")).collect::<Vec<_>>();
            (format!("[{}]", q.join(", ")), String::new())
        }
        _ => (format!("{value:.4}"), format!("{change:+.4}")),
    })
}

fn table(model: &Model, list: &GoalList, posed: &Posed) -> String {
    let answer = &posed.answer;
    let rows: Vec<Vec<String>> = list
        .goals
        .iter()
        .zip(&answer.misses)
        .map(|(goal, miss)| {
            let state = match (miss.is_met(), miss.weighted) {
                (true, _) => "met".to_owned(),
                (false, true) => format!("off by {}", lacks(miss)),
                (false, false) => format!("missed by {}", lacks(miss)),
            };
            let weight = goal.weight.map_or(String::new(), |weight| format!("weight {weight}"));
            vec![goal.aim.kind().to_owned(), goal.name.text.clone(), state, weight]
        })
        .collect();
    let mut text = "goals\n".to_owned();
    text.push_str(&output::columns(&rows));
    if !model.closures().is_empty() {
        text.push_str(&format!("loops closed to {:.1e} m or rad\n", answer.closure_error));
    }
    let ids: Vec<CoordinateId> = model.coordinate_ids().collect();
    let rows: Vec<Vec<String>> = ids
        .iter()
        .filter_map(|&id| {
            let (value, change) = moved(model, posed, id)?;
            let by = match answer.by[id.index()] {
                By::Goals => "by goals",
                By::Shared => "by goals and rest",
                By::Rest => "by rest",
                By::Limit => "at its limit",
                By::Held => "held",
                By::Follows => "follows others",
            };
            Some(vec![model.coordinate_key(id), value, change, by.to_owned()])
        })
        .collect();
    let left = ids.len() - rows.len();
    text.push_str("coordinates that left rest, by how much, and what says where they are\n");
    text.push_str(&output::columns(&rows));
    text.push_str(&format!("{left} of {} coordinates are at rest\n", ids.len()));
    text
}

fn report(model: &Model, list: &GoalList, posed: &Posed) -> Value {
    let answer = &posed.answer;
    let goal = |(goal, miss): (&condyle::formats::document::goals::NamedGoal, &Miss)| {
        let unit = if miss.angle { "off_rad" } else { "off_m" };
        json!({
            "kind": goal.aim.kind(),
            "name": goal.name.text,
            "met": miss.is_met(),
            unit: miss.off,
            "weight": goal.weight,
        })
    };
    let (mut coordinates, mut by) = (Map::new(), Map::new());
    let mut at_limit = vec![];
    for id in model.coordinate_ids() {
        let key = model.coordinate_key(id);
        let value = match &answer.coordinates[model.stored_range(id)] {
            [one] => json!(one),
            several => json!(several),
        };
        coordinates.insert(key.clone(), value);
        by.insert(key.clone(), json!(answer.by[id.index()].name()));
        if answer.by[id.index()] == By::Limit {
            at_limit.push(key);
        }
    }
    json!({
        "met": answer.is_met(),
        "goals": list.goals.iter().zip(&answer.misses).map(goal).collect::<Vec<_>>(),
        "closure_error": answer.closure_error,
        "rest_m2": answer.rest,
        "coordinates": coordinates,
        "by": by,
        "at_limit": at_limit,
        "starts": answer.starts,
        "iterations": answer.iterations,
    })
}
