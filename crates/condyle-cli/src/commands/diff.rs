//! `condyle diff`: two motions, coordinate by coordinate.

use super::Outcome;
use crate::failure::{Failure, warned};
use crate::output::{self, columns, wrapped};
use clap::Args;
use condyle::formats::{AngleUnit, Table, coordinate_name};
use condyle::math::Quat;
use condyle::{CoordinateId, CoordinateKind, Model, motion, open};
use serde_json::json;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Diff {
    /// A motion, at whose times the two are compared.
    a: PathBuf,
    /// Another motion; interpolated linearly between its frames.
    b: PathBuf,
    /// The model of both: tells rotations, which are then compared in degrees.
    #[arg(long, value_name = "M")]
    model: Option<PathBuf>,
    /// One JSON document on standard output.
    #[arg(long)]
    json: bool,
}

/// Times that differ by less are the same: files give times with six digits or so.
const SAME_TIME: f64 = 1e-6;

/// A motion with the path it came from.
struct Side<'p> {
    path: &'p Path,
    table: Table,
}

impl Side<'_> {
    /// What turns the numbers of a rotation into degrees; an unstated unit means radians.
    fn to_degrees(&self) -> f64 {
        if self.table.angle_unit == AngleUnit::Degrees { 1.0 } else { 1f64.to_degrees() }
    }

    fn unit_name(&self) -> &'static str {
        match self.table.angle_unit {
            AngleUnit::Degrees => "degrees",
            AngleUnit::Radians => "radians",
            AngleUnit::Unstated => "no unit, which means radians",
        }
    }
}

/// Where something that both motions hold stands in each.
struct Shared {
    name: String,
    unit: &'static str,
    /// One column, or four of an orientation: in A, in B.
    columns: [Vec<usize>; 2],
    /// What the numbers of A and of B are multiplied by.
    factors: [f64; 2],
}

/// How far two series are apart.
struct Distance {
    frames: usize,
    mean: f64,
    rms: f64,
    largest: f64,
    time: f64,
}

/// What can be compared, and what only one side has.
struct Pairing {
    shared: Vec<Shared>,
    only: [Vec<String>; 2],
}

impl Diff {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let model = match &self.model {
            Some(path) => Some(warned(path, open::model(path)?)),
            None => None,
        };
        let side = |path| -> Result<Side<'_>, Failure> {
            Ok(Side { path, table: warned(path, open::table(path)?) })
        };
        let sides = [side(&self.a)?, side(&self.b)?];
        let pairing = match &model {
            Some(model) => by_model(model, &sides),
            None => by_name(&sides),
        };
        if pairing.shared.is_empty() {
            let some = |names: &[String]| names.iter().take(4).cloned().collect::<Vec<_>>();
            return Err(Failure::new(format!(
                "{} and {} have no coordinate in common: the first has {}, …; the second {}, …",
                self.a.display(),
                self.b.display(),
                some(&pairing.only[0]).join(", "),
                some(&pairing.only[1]).join(", "),
            )));
        }
        let moments = moments(&sides)?;
        let distances: Vec<Distance> =
            pairing.shared.iter().map(|shared| distance(shared, &sides, &moments)).collect();
        if self.json {
            self.print_json(&sides, &pairing, &moments, &distances)?;
        } else {
            self.print_text(&sides, &pairing, &moments, &distances)?;
        }
        Ok(Outcome::Done)
    }

    fn print_json(
        &self,
        sides: &[Side<'_>; 2],
        pairing: &Pairing,
        moments: &[Moment],
        distances: &[Distance],
    ) -> Result<(), Failure> {
        let coordinates: Vec<_> = pairing
            .shared
            .iter()
            .zip(distances)
            .map(|(shared, d)| {
                json!({
                    "name": shared.name,
                    "unit": shared.unit,
                    "frames": d.frames,
                    "mean": d.mean,
                    "rms": d.rms,
                    "largest": d.largest,
                    "largest_time": d.time,
                })
            })
            .collect();
        let time = |moment: Option<&Moment>| moment.map(|m| sides[0].table.times[m.row]);
        output::print_json(&json!({
            "frames": moments.len(),
            "time": [time(moments.first()), time(moments.last())],
            "coordinates": coordinates,
            "only_in_a": pairing.only[0],
            "only_in_b": pairing.only[1],
        }))
    }

    fn print_text(
        &self,
        sides: &[Side<'_>; 2],
        pairing: &Pairing,
        moments: &[Moment],
        distances: &[Distance],
    ) -> Result<(), Failure> {
        let times = &sides[0].table.times;
        let ends = [moments.first(), moments.last()].map(|m| m.map_or(f64::NAN, |m| times[m.row]));
        let mut text = format!(
            "{} minus {}: {} frames from {} to {} s\n",
            self.b.display(),
            self.a.display(),
            moments.len(),
            ends[0],
            ends[1],
        );
        let head = ["coordinate", "unit", "mean", "RMS", "largest", "at"].map(str::to_owned);
        let mut rows = vec![head.to_vec()];
        for (shared, d) in pairing.shared.iter().zip(distances) {
            let number = |v: f64| if v.is_finite() { format!("{v:.6}") } else { "-".to_owned() };
            let at = if d.time.is_finite() { format!("{} s", d.time) } else { "-".to_owned() };
            rows.push(vec![
                shared.name.clone(),
                shared.unit.to_owned(),
                number(d.mean),
                number(d.rms),
                number(d.largest),
                at,
            ]);
        }
        text.push_str(&columns(&rows));
        for (side, names) in sides.iter().zip(&pairing.only) {
            if !names.is_empty() {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                text.push_str(&wrapped(&format!("only in {}:", side.path.display()), &names));
            }
        }
        output::print(text.as_bytes())
    }
}

/// Coordinates of a model that both sides hold: angles in degrees, lengths in metres.
fn by_model(model: &Model, sides: &[Side<'_>; 2]) -> Pairing {
    let mut pairing = Pairing { shared: vec![], only: [vec![], vec![]] };
    let mut used = [vec![], vec![]];
    for id in model.coordinate_ids() {
        let found = [0, 1].map(|i| coordinate_columns(model, id, &sides[i].table));
        for (used, found) in used.iter_mut().zip(&found) {
            used.extend(found.iter().flatten().copied());
        }
        let name = model.coordinate_key(id);
        match found {
            [Some(a), Some(b)] => {
                let (unit, factors) = match model.coordinate(id).kind {
                    CoordinateKind::Rotation => {
                        ("deg", [sides[0].to_degrees(), sides[1].to_degrees()])
                    }
                    CoordinateKind::Translation => ("m", [1.0; 2]),
                    CoordinateKind::Orientation => ("deg", [1.0; 2]),
                    CoordinateKind::Scale | CoordinateKind::Other => ("", [1.0; 2]),
                };
                pairing.shared.push(Shared { name, unit, columns: [a, b], factors });
            }
            [Some(_), None] => pairing.only[0].push(name),
            [None, Some(_)] => pairing.only[1].push(name),
            [None, None] => {}
        }
    }
    for ((side, used), only) in sides.iter().zip(used).zip(&mut pairing.only) {
        let names = side.table.columns.iter().enumerate();
        only.extend(names.filter(|(i, _)| !used.contains(i)).map(|(_, name)| name.clone()));
    }
    pairing
}

/// The columns of a coordinate, by its key or by a path that ends in its joint and name.
fn coordinate_columns(model: &Model, id: CoordinateId, table: &Table) -> Option<Vec<usize>> {
    let coordinate = model.coordinate(id);
    let path =
        format!("/{}/{}", model.joint_sets()[coordinate.joint_set.index()].name, coordinate.name);
    let holds = |column: &String| {
        let bare = column.strip_suffix("/value").unwrap_or(column);
        format!("/{bare}").ends_with(&path)
    };
    motion::columns(model, id)
        .iter()
        .map(|name| table.column(name).or_else(|| table.columns.iter().position(holds)))
        .collect()
}

/// Columns of one name, compared as they are.
fn by_name(sides: &[Side<'_>; 2]) -> Pairing {
    let [a, b] = sides;
    if a.to_degrees() != b.to_degrees() {
        eprintln!(
            "warning: {} says {}, {} {}; without --model rotations cannot be told from lengths, so \
             the numbers are compared as they are",
            a.path.display(),
            a.unit_name(),
            b.path.display(),
            b.unit_name(),
        );
    }
    let mut pairing = Pairing { shared: vec![], only: [vec![], vec![]] };
    let mut used = vec![false; b.table.columns.len()];
    for (column, name) in a.table.columns.iter().enumerate() {
        let bare = coordinate_name(name).unwrap_or(name);
        let found = b.table.column(name).or_else(|| b.table.column(bare));
        match found.filter(|&found| !used[found]) {
            Some(found) => {
                used[found] = true;
                pairing.shared.push(Shared {
                    name: name.clone(),
                    unit: "",
                    columns: [vec![column], vec![found]],
                    factors: [1.0; 2],
                });
            }
            None => pairing.only[0].push(name.clone()),
        }
    }
    let rest = b.table.columns.iter().zip(used).filter(|(_, used)| !used);
    pairing.only[1].extend(rest.map(|(name, _)| name.clone()));
    pairing
}

/// A row of A, and the rows of B around its time.
struct Moment {
    row: usize,
    before: usize,
    after: usize,
    /// From 0 at the row before to 1 at the row after.
    share: f64,
}

/// The rows of A at whose times B has values.
fn moments(sides: &[Side<'_>; 2]) -> Result<Vec<Moment>, Failure> {
    let [a, b] = [&sides[0].table.times, &sides[1].table.times];
    let span = |times: &[f64]| match times {
        [] => "no frames".to_owned(),
        [first, ..] => format!("{first} to {} s", times.last().unwrap_or(first)),
    };
    let none = || {
        Failure::new(format!(
            "the motions do not overlap in time: {} has {}, {} has {}",
            sides[0].path.display(),
            span(a),
            sides[1].path.display(),
            span(b),
        ))
    };
    let (Some(&first), Some(&last)) = (b.first(), b.last()) else { return Err(none()) };
    let mut moments = vec![];
    for (row, &time) in a.iter().enumerate() {
        if time < first - SAME_TIME || time > last + SAME_TIME {
            continue;
        }
        let after = b.partition_point(|&t| t < time).min(b.len() - 1);
        let before = after.saturating_sub(1);
        let nearest =
            if (b[before] - time).abs() < (b[after] - time).abs() { before } else { after };
        moments.push(if (b[nearest] - time).abs() <= SAME_TIME {
            Moment { row, before: nearest, after: nearest, share: 0.0 }
        } else {
            let share = (time - b[before]) / (b[after] - b[before]);
            Moment { row, before, after, share }
        });
    }
    if moments.is_empty() { Err(none()) } else { Ok(moments) }
}

fn distance(shared: &Shared, sides: &[Side<'_>; 2], moments: &[Moment]) -> Distance {
    let [a, b] = [&sides[0].table, &sides[1].table];
    let mut d =
        Distance { frames: 0, mean: f64::NAN, rms: f64::NAN, largest: f64::NAN, time: f64::NAN };
    let (mut sum, mut squares) = (0.0, 0.0);
    let numbers = |table: &Table, row: usize, side: usize| -> Vec<f64> {
        let values = shared.columns[side].iter().map(|&c| table.value(row, c).unwrap_or(f64::NAN));
        values.map(|v| v * shared.factors[side]).collect()
    };
    for moment in moments {
        let of_a = numbers(a, moment.row, 0);
        let (before, after) = (numbers(b, moment.before, 1), numbers(b, moment.after, 1));
        let difference = match (&of_a[..], &before[..], &after[..]) {
            (&[value], &[before], &[after]) => before + (after - before) * moment.share - value,
            _ => angle_between(&of_a, &before, &after, moment.share),
        };
        if !difference.is_finite() {
            continue;
        }
        d.frames += 1;
        sum += difference;
        squares += difference * difference;
        if d.largest.is_nan() || difference.abs() > d.largest {
            d.largest = difference.abs();
            d.time = a.times[moment.row];
        }
    }
    if d.frames > 0 {
        d.mean = sum / d.frames as f64;
        d.rms = (squares / d.frames as f64).sqrt();
    }
    d
}

/// The angle in degrees from one rotation to another that is interpolated between two.
fn angle_between(value: &[f64], before: &[f64], after: &[f64], share: f64) -> f64 {
    let quat = |q: &[f64]| -> Option<Quat> {
        let q: [f64; 4] = q.try_into().ok()?;
        Some(Quat::from(q).normalized())
    };
    let (Some(value), Some(before), Some(after)) = (quat(value), quat(before), quat(after)) else {
        return f64::NAN;
    };
    let turn = (before.conjugate() * after).log();
    (before * Quat::exp(turn * share)).angle_to(value).to_degrees()
}
