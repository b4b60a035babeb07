//! `condyle limits`: what learned limits say of rotations, of the mobility of a joint, and to engines.

mod engine;
mod mesh;
mod report;

use super::Outcome;
use crate::failure::{Failure, warned};
use crate::output;
use crate::screen::say;
use clap::{Args, Subcommand};
use condyle::formats::csv;
use condyle::learn::limits::State;
use condyle::learn::limits::dependent::Drivers;
use condyle::learn::rotations;
use condyle::learning::{self, Answered, Limit};
use condyle::math::Quat;
use condyle::open::{self, Cause, OpenError};
use condyle::{Error, Table};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Limits {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Tell of rotations whether they are possible, by how many degrees, and the nearest that are.
    Query(Query),
    /// Tell how mobile a joint is, what to record next, and what two limits have in common.
    Report(report::Report),
    /// Tell what game and robot engines can hold of a limit, in their own numbers, and what is lost.
    Engine(engine::Engine),
    /// Draw the boundary of a limit as a surface (.glb): in quaternion space, or the directions that a bone reaches.
    Mesh(mesh::Mesh),
}

impl Limits {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        match self.what {
            What::Query(query) => query.run(),
            What::Report(report) => report.run(),
            What::Engine(engine) => engine.run(),
            What::Mesh(mesh) => mesh.run(),
        }
    }
}

/// Tell of rotations whether they are possible, by how many degrees, and the nearest that are.
///
/// Added are the columns state (valid, invalid, or unknown where nothing was recorded), distance_deg (to the boundary, positive
/// inside), nx,ny,nz,nw (the nearest valid rotation) and evidence (degrees to the nearest recorded rotation). Rows that
/// are no rotation keep these cells blank. A limit that depends on another joint needs that in the table, too: the column of its
/// coordinate in radians (or its name with _deg), or gx,gy,gz,gw of its rotation; where these are blank so are the answers.
#[derive(Debug, Args)]
struct Query {
    /// The limit: a document of `kind = "limit"`.
    limit: PathBuf,
    /// A table with the columns qx,qy,qz,qw, in any order: the child in the reference segment.
    rotations: PathBuf,
    /// Where to write the table with the added columns; `-` and without it standard output.
    #[arg(short, long, value_name = "OUT.csv")]
    output: Option<PathBuf>,
    /// One JSON document on standard output.
    #[arg(long)]
    json: bool,
}

/// The columns that are added.
const ADDED: &str = "state,distance_deg,nx,ny,nz,nw,evidence";

impl Query {
    fn run(self) -> Result<Outcome, Failure> {
        let to_screen = self.output.as_deref().is_none_or(|path| path == Path::new("-"));
        if self.json && self.output.as_deref() == Some(Path::new("-")) {
            let message = "--json and -o - both want standard output: give one of them";
            return Err(Failure::new(message));
        }
        let outputs: Vec<&Path> = self.output.iter().map(PathBuf::as_path).collect();
        output::check_distinct(&[&self.limit, &self.rotations], &outputs)?;
        let limit = warned(&self.limit, open::any_limit(&self.limit)?);
        let mut read = open::table(&self.rotations)?;
        let timed = !read.warnings.iter().any(|said| said.code == "csv/no-time");
        read.warnings.retain(|said| said.code != "csv/no-time");
        let table = warned(&self.rotations, read);
        let asked = rotations::of_table(&table).map_err(|error| self.wrong(error))?;
        if asked.rotations.is_empty() {
            let error = Error::new("limits/empty", "the table holds no rotation")
                .with_help("give rows of qx, qy, qz, qw with a length above 0");
            return Err(self.wrong(error));
        }
        let mut answers: Vec<Option<Answered>> = vec![None; table.rows()];
        let drivers = match limit.dependence() {
            None => vec![],
            Some(given) => {
                let turns = Some(matches!(given.drivers, Drivers::Rotations(_)));
                let found = learning::drivers_of_table(&table, &given.name, turns);
                found.map_err(|error| self.wrong(error))?
            }
        };
        for (row, q) in asked.frames.iter().zip(&asked.rotations) {
            let driver = drivers.get(*row).copied().flatten();
            if drivers.is_empty() || driver.is_some() {
                answers[*row] = limit.answer_given(*q, driver);
            }
        }
        self.warn(&asked, &table);
        if !self.json || self.output.is_some() {
            let text = rows(&table, timed, &answers);
            match &self.output {
                Some(path) => output::write(path, text.as_bytes())?,
                None => output::write(Path::new("-"), text.as_bytes())?,
            }
        }
        if self.json {
            output::print_json(&report(&limit, &answers))?;
        } else if !to_screen {
            output::print(summary(&answers).as_bytes())?;
        }
        Ok(Outcome::Done)
    }

    fn wrong(&self, error: Error) -> Failure {
        let cause = Cause::Content { error, text: None };
        OpenError { path: self.rotations.clone(), cause }.into()
    }

    /// Says which rows are none, and that some are not of length 1.
    fn warn(&self, asked: &condyle::learn::frames::Orientated, table: &Table) {
        let path = self.rotations.display();
        if let Some(first) = asked.unusable.first() {
            let line =
                std::fs::read(&self.rotations).ok().and_then(|b| csv::line_of_row(&b, *first));
            let at = line.map_or(String::new(), |line| format!(":{line}"));
            say(&format!(
                "warning: {path}{at}: {} of {} rows are no rotations: not finite, or of length 0; their cells stay blank{}",
                asked.unusable.len(),
                table.rows(),
                if line.is_some() { " (the first is on this line)" } else { "" },
            ));
        }
        if asked.scaled > 0 {
            say(&format!(
                "warning: {path}: {} quaternions are not of length 1 to a thousandth: they are made so",
                asked.scaled
            ));
        }
    }
}

/// A number with the digits of a thousandth of a thousandth.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

fn name_cell(name: &str) -> String {
    match name.contains([',', ';', '\t', '"', '#']) {
        true => format!("\"{}\"", name.replace('"', "\"\"")),
        false => name.to_owned(),
    }
}

/// The table as it was, with the answers beside it.
fn rows(table: &Table, timed: bool, answers: &[Option<Answered>]) -> String {
    let names: Vec<String> = table.columns.iter().map(|name| name_cell(name)).collect();
    let mut text = String::new();
    if timed {
        text.push_str("time,");
    }
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{},{ADDED}", names.join(","));
    for (row, answer) in answers.iter().enumerate() {
        if timed {
            let _ = write!(text, "{},", table.times.get(row).copied().unwrap_or(0.0));
        }
        for value in table.row(row) {
            match value.is_nan() {
                true => text.push(','),
                false => {
                    let _ = write!(text, "{value},");
                }
            }
        }
        let Some(answer) = answer else {
            text.push_str(",,,,,,\n");
            continue;
        };
        let _ = write!(text, "{},", answer.state.name());
        if let Some(distance) = answer.distance {
            let _ = write!(text, "{}", rounded(distance.to_degrees()));
        }
        match answer.nearest {
            Some(n) => {
                let _ = write!(text, ",{},{},{},{}", n.x, n.y, n.z, n.w);
            }
            None => text.push_str(",,,,"),
        }
        // A limit by formulas has no samples.
        match answer.evidence.is_nan() {
            true => text.push_str(",\n"),
            false => {
                let _ = writeln!(text, ",{}", rounded(answer.evidence.to_degrees()));
            }
        }
    }
    text
}

/// How many answers are of each state, and how many rows are no rotation.
fn counts(answers: &[Option<Answered>]) -> [usize; 4] {
    let of = |state| answers.iter().flatten().filter(|answer| answer.state == state).count();
    let none = answers.iter().filter(|answer| answer.is_none()).count();
    [of(State::Valid), of(State::Invalid), of(State::Unknown), none]
}

fn summary(answers: &[Option<Answered>]) -> String {
    let [valid, invalid, unknown, none] = counts(answers);
    let mut text = format!(
        "{} rotations: {valid} valid, {invalid} invalid, {unknown} unknown",
        answers.len() - none
    );
    if none > 0 {
        text.push_str(&format!("; {none} rows are no rotation"));
    }
    let outside = answers.iter().flatten().filter_map(|answer| answer.distance);
    let worst = outside.fold(0.0, f64::min);
    if worst < 0.0 {
        text.push_str(&format!("; the farthest is {:.1}° outside", -worst.to_degrees()));
    }
    text.push('\n');
    text
}

fn report(limit: &Limit, answers: &[Option<Answered>]) -> Value {
    let about = match limit {
        Limit::Field(limit) => limit.about(),
        Limit::Spheres(spheres) => &spheres.about,
    };
    let [valid, invalid, unknown, none] = counts(answers);
    let array = |q: Quat| json!(q.to_array());
    let answer = |answer: &Option<Answered>| match answer {
        None => Value::Null,
        Some(answer) => json!({
            "state": answer.state.name(),
            "distance_deg": answer.distance.map(f64::to_degrees),
            "nearest": answer.nearest.map(array),
            "evidence": {
                "nearest_sample_deg": answer.evidence.to_degrees(),
                "samples_near": answer.count,
            },
        }),
    };
    json!({
        "child": about.child,
        "reference": about.reference,
        "given": limit.dependence().map(|given| &given.name),
        "source": about.source,
        "valid": valid,
        "invalid": invalid,
        "unknown": unknown,
        "unusable": none,
        "rotations": answers.iter().map(answer).collect::<Vec<_>>(),
    })
}
