//! The rotations that one recording shows.

use super::given;
use crate::open::{self, Cause, OpenError};
use condyle_diagnostics::{Diagnostic, Error, Place, Read};
use condyle_formats::{Content, Format, Id, csv};
use condyle_learn::frames::{Orientated, Recipe};
use condyle_learn::rotations::{self, Pair};
use condyle_model::Model;
use condyle_motion::{AngleUnit, Animation, Motion, Orientations, Table, Zeros};
use std::path::Path;

/// Whose rotation is meant, and how a recording shows it.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Which markers give it, with the name of the recipe.
    pub recipe: Option<(String, Recipe)>,
    /// The model whose coordinates a motion holds, with its name.
    pub model: Option<(String, Model)>,
    /// A segment, or a joint set that moves one; a sensor of inertial recordings.
    pub joint: Option<String>,
    /// The segment in which it is seen; without it the parent, of sensors their world.
    pub reference: Option<String>,
    /// Whose markers are meant, where the labels of several people begin with their names.
    pub subject: Option<String>,
    /// What the limit is to depend on.
    pub given: Option<super::Wished>,
    /// What a marker at 0 0 0 is.
    pub zeros: Zeros,
    /// The unit of angles in motions that do not state it.
    pub angles: Option<AngleUnit>,
}

/// What a recording shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Take {
    /// The name of its file, without folder and ending.
    pub name: String,
    /// The rotations, and what was left out.
    pub found: Orientated,
    /// Whose they are.
    pub child: String,
    /// In what they are seen; `None` for the laboratory, or what a table does not say.
    pub reference: Option<String>,
    /// How the axes of both are defined.
    pub frames: String,
    /// What the limit depends on, at each rotation.
    pub given: Option<super::Driven>,
}

fn failed(path: &Path, error: Error) -> OpenError {
    OpenError { path: path.to_owned(), cause: Cause::Content { error, text: None } }
}

/// Opens a recording and takes its rotations.
///
/// Markers need a recipe; a motion of a model its model and a joint; a skeleton with its motion a joint; a table
/// of qx, qy, qz, qw nothing; inertial sensors the name of one.
///
/// # Errors
/// As [`open::content`]; what the recording lacks of what is wanted.
pub fn take(path: &Path, wanted: &Wanted) -> Result<Read<Take>, OpenError> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    if let Some((title, recipe)) = &wanted.recipe {
        let mut read = open::recording_with(path, wanted.zeros)?;
        let found = recipe.rotations_of(&read.value, wanted.subject.as_deref());
        let mut found = found.map_err(|error| failed(path, error))?;
        let given = wanted.given.as_ref().map(|wished| {
            given::of_markers(wished, &read.value, wanted.subject.as_deref(), &mut found)
        });
        let given = given.transpose().map_err(|error| failed(path, error))?;
        read.warnings.extend(found.warnings());
        let value = Take {
            name,
            found,
            child: recipe.child.name.clone(),
            reference: recipe.reference.as_ref().map(|frame| frame.name.clone()),
            frames: format!("recipe {title}"),
            given,
        };
        return Ok(Read { value, warnings: read.warnings });
    }
    if let Some((title, model)) = &wanted.model {
        let read = open::motion_with(path, model, wanted.angles)?;
        if read.value.frames.is_empty() {
            let error = Error::new("learn/no-frames", "the file holds no frames of the model")
                .with_help("give a motion whose columns are named after coordinates of the model");
            return Err(failed(path, error));
        }
        let from = Source { name, model, frames: format!("model {title}") };
        return posed(path, from, &read.value, wanted, read.warnings);
    }
    let Read { value, warnings } = open::content_with(path, None, wanted.zeros)?;
    match value {
        Content::Animation(found) => {
            let Animation { model, motion } = *found;
            let frames = format!("skeleton {}", model.name());
            posed(path, Source { name, model: &model, frames }, &motion, wanted, warnings)
        }
        Content::Table(table) => of_table(path, name, &table, wanted, warnings),
        Content::Recording(_) | Content::Trial(_) => {
            let shipped: Vec<&str> = crate::shipped::recipes().collect();
            let error = Error::new(
                "learn/recipe",
                "markers need a recipe that says which of them give a segment's axes",
            )
            .with_help(format!("give one with --recipe: a file, or one of {}", shipped.join(", ")));
            Err(failed(path, error))
        }
        other => {
            let message = format!("the file holds {}, no recording", other.kind().name());
            Err(failed(path, Error::new("learn/content", message)))
        }
    }
}

struct Source<'m> {
    name: String,
    model: &'m Model,
    frames: String,
}

fn posed(
    path: &Path,
    from: Source<'_>,
    motion: &Motion,
    wanted: &Wanted,
    mut warnings: Vec<Diagnostic>,
) -> Result<Read<Take>, OpenError> {
    let Some(joint) = &wanted.joint else {
        let names: Vec<&str> = from.model.segments().iter().map(|s| s.name.as_str()).collect();
        let error = Error::new("learn/joint", "which joint is not said")
            .with_help(format!("name a segment with --joint: {}", names.join(", ")));
        return Err(failed(path, error));
    };
    let wrong = |error| failed(path, error);
    let pair = Pair::named(from.model, joint, wanted.reference.as_deref()).map_err(wrong)?;
    let found = rotations::segments(from.model, motion, &[pair]).map_err(wrong)?;
    let mut found = found.into_iter().next().unwrap_or_default();
    let given = wanted.given.as_ref();
    let given = given.map(|wished| given::of_motion(wished, from.model, motion, &mut found));
    let given = given.transpose().map_err(wrong)?;
    warnings.extend(found.warnings());
    let named = |s| from.model.segment(s).name.clone();
    let value = Take {
        name: from.name,
        found,
        child: named(pair.child),
        reference: pair.reference.map(named),
        frames: from.frames,
        given,
    };
    Ok(Read { value, warnings })
}

fn of_table(
    path: &Path,
    name: String,
    table: &Table,
    wanted: &Wanted,
    warnings: Vec<Diagnostic>,
) -> Result<Read<Take>, OpenError> {
    let wrong = |error| failed(path, error);
    if rotations::in_table(table).is_some() {
        let mut found = rotations::of_table(table).map_err(wrong)?;
        let given = wanted.given.as_ref();
        let given = given.map(|wished| given::of_table(wished, table, &mut found));
        let given = given.transpose().map_err(wrong)?;
        // Rotations have no time, and whether their order is one does not matter here.
        let mut warnings: Vec<Diagnostic> =
            warnings.into_iter().filter(|said| said.code != "csv/no-time").collect();
        warnings.extend(found.warnings().into_iter().map(|said| placed(path, &found, said)));
        let value = Take {
            name,
            found,
            child: wanted.joint.clone().unwrap_or_else(|| "child".to_owned()),
            reference: wanted.reference.clone(),
            frames: "as in the tables of quaternions".to_owned(),
            given,
        };
        return Ok(Read { value, warnings });
    }
    let sensors = Orientations::from_table(table).map_err(|_| {
        let error = Error::new(
            "learn/table",
            "the table holds no orientations: neither qx, qy, qz, qw nor sensors",
        )
        .with_help("for a motion give its model and a joint: --model M --joint J");
        failed(path, error)
    })?;
    let joint = match (&wanted.joint, &sensors.value.labels[..]) {
        (Some(joint), _) => joint.clone(),
        (None, [only]) => only.clone(),
        (None, several) => {
            let error = Error::new("learn/joint", "which sensor is not said")
                .with_help(format!("name one with --joint: {}", several.join(", ")));
            return Err(failed(path, error));
        }
    };
    let found = rotations::of_sensors(&sensors.value, &joint, wanted.reference.as_deref());
    let mut found = found.map_err(wrong)?;
    let given = wanted.given.as_ref();
    let given = given.map(|wished| given::of_sensors(wished, &sensors.value, &mut found));
    let given = given.transpose().map_err(wrong)?;
    let mut warnings: Vec<Diagnostic> =
        warnings.into_iter().filter(|said| said.code != "sto/vector-cells").collect();
    warnings.extend(sensors.warnings);
    warnings.extend(found.warnings());
    let value = Take {
        name,
        found,
        child: joint,
        reference: wanted.reference.clone(),
        frames: "sensors".to_owned(),
        given,
    };
    Ok(Read { value, warnings })
}

/// A warning about rows that are no rotations, with the line of the first in a text.
fn placed(path: &Path, found: &Orientated, said: Diagnostic) -> Diagnostic {
    let Some(first) = found.unusable.first().filter(|_| said.code == "rotations/unusable") else {
        return said;
    };
    let text = Format::of_ending(&open::ending(path)).is_some_and(|f| f.id == Id::Csv);
    let line = text
        .then(|| std::fs::read(path).ok().and_then(|bytes| csv::line_of_row(&bytes, *first)))
        .flatten();
    match line {
        None => said,
        Some(line) => {
            let count = found.unusable.len();
            let message = format!(
                "{count} of {} rotations are left out: not finite, or of length 0; the first is on this line",
                found.given()
            );
            Diagnostic::warning("rotations/unusable", message).at(Place::at_line(line))
        }
    }
}
