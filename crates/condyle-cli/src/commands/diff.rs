//! `condyle diff`: two motions, coordinate by coordinate.

use super::{Angles, Outcome};
use crate::failure::{Failure, warn_about, warned};
use crate::output::{self, columns, wrapped};
use crate::screen::say;
use clap::Args;
use condyle::motion::difference::{Comparison, Difference, Incomparable, compare};
use condyle::open::{Cause, OpenError};
use condyle::{AngleUnit, Error, Table, open};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Diff {
    /// A motion, at whose times the two are compared.
    a: PathBuf,
    /// Another motion; interpolated linearly between its frames.
    b: PathBuf,
    /// The model of both; with it rotations are known, and compared in degrees.
    #[arg(long, value_name = "M")]
    model: Option<PathBuf>,
    /// The unit of angles in motions that do not state it; without it, it is guessed by their size.
    #[arg(long, value_enum)]
    angles: Option<Angles>,
    /// One JSON document on standard output.
    #[arg(long)]
    json: bool,
}

impl Diff {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let model = match &self.model {
            Some(path) => Some(warned(path, open::model(path)?)),
            None => None,
        };
        let [a, b] =
            [&self.a, &self.b].map(|path| open::table(path).map(|read| warned(path, read)));
        let (mut a, mut b) = (a?, b?);
        for (path, table) in [(&self.a, &mut a), (&self.b, &mut b)] {
            // What a file states is not what is told of the other.
            let told = self.angles.filter(|_| {
                matches!(table.angle_unit, AngleUnit::Unstated | AngleUnit::RadiansAsRule)
            });
            let said = match &model {
                Some(model) => open::settled(model, table, told.map(Into::into)),
                None => table.settle_angles(None, told.map(Into::into)),
            };
            warn_about(path, &said.map_err(|error| wrong(path, error))?);
        }
        if model.is_none() && a.angle_unit != b.angle_unit {
            say(&format!(
                "warning: {} has {}, {} has {}; without --model rotations cannot be distinguished \
                 from lengths, so the numbers are compared without conversion",
                self.a.display(),
                unit_name(&a),
                self.b.display(),
                unit_name(&b),
            ));
        }
        let compared = compare(model.as_ref(), &a, &b).map_err(|why| self.failure(&why, &a, &b))?;
        match self.json {
            true => output::print_json(&json(&compared))?,
            false => output::print(self.text(&compared).as_bytes())?,
        }
        Ok(Outcome::Done)
    }

    fn failure(&self, why: &Incomparable, a: &Table, b: &Table) -> Failure {
        let (first, second) = (self.a.display(), self.b.display());
        Failure::new(match why {
            Incomparable::Names(only) => {
                let [of_a, of_b] = only
                    .each_ref()
                    .map(|names| names.iter().take(4).cloned().collect::<Vec<_>>().join(", "));
                format!(
                    "{first} and {second} have no coordinate in common: the first has {of_a}, …; the \
                     second {of_b}, …"
                )
            }
            Incomparable::Times => format!(
                "the motions do not overlap in time: {first} has {}, {second} has {}",
                span(&a.times),
                span(&b.times)
            ),
        })
    }

    fn text(&self, compared: &Comparison) -> String {
        let mut text = format!(
            "{} minus {}: {} frames from {} to {} s\n",
            self.b.display(),
            self.a.display(),
            compared.frames,
            compared.time[0],
            compared.time[1],
        );
        let head = ["coordinate", "unit", "mean", "RMS", "largest", "at"].map(str::to_owned);
        let mut rows = vec![head.to_vec()];
        for d in &compared.differences {
            let number = |v: f64| if v.is_finite() { format!("{v:.6}") } else { "-".to_owned() };
            let at = if d.time.is_finite() { format!("{} s", d.time) } else { "-".to_owned() };
            rows.push(vec![
                d.name.clone(),
                d.unit.to_owned(),
                number(d.mean),
                number(d.rms),
                number(d.largest),
                at,
            ]);
        }
        text.push_str(&columns(&rows));
        for (path, names) in [&self.a, &self.b].into_iter().zip(&compared.only) {
            if !names.is_empty() {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                text.push_str(&wrapped(&format!("only in {}:", path.display()), &names));
            }
        }
        text
    }
}

fn wrong(path: &Path, error: Error) -> Failure {
    let cause = Cause::Content { error, text: None };
    Failure::from(OpenError { path: path.to_owned(), cause })
}

fn unit_name(table: &Table) -> &'static str {
    table.angle_unit.name()
}

fn span(times: &[f64]) -> String {
    match times {
        [] => "no frames".to_owned(),
        [first, ..] => format!("{first} to {} s", times.last().unwrap_or(first)),
    }
}

fn json(compared: &Comparison) -> Value {
    let coordinate = |d: &Difference| {
        json!({
            "name": d.name,
            "unit": d.unit,
            "frames": d.frames,
            "mean": d.mean,
            "rms": d.rms,
            "largest": d.largest,
            "largest_time": d.time,
        })
    };
    json!({
        "frames": compared.frames,
        "time": compared.time,
        "coordinates": compared.differences.iter().map(coordinate).collect::<Vec<_>>(),
        "only_in_a": compared.only[0],
        "only_in_b": compared.only[1],
    })
}
