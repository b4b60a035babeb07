//! Comparison of two motions, coordinate by coordinate.

use crate::columns::{coordinate_name, found_columns};
use crate::{AngleUnit, Between, Table, between};
use condyle_math::Quat;
use condyle_model::{CoordinateKind, Model};

/// Times that differ by less, in seconds, are the same: files have times with about six digits.
const SAME_TIME: f64 = 1e-6;

/// What two tables have in common, and how much it differs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// First and last time that are compared, and how many times of A there are.
    pub time: [f64; 2],
    /// Rows of A that are compared.
    pub frames: usize,
    /// The differences of what both hold, in the order of the model or of A.
    pub differences: Vec<Difference>,
    /// Names that only A, only B has.
    pub only: [Vec<String>; 2],
}

/// The difference of two series: B minus A at the times of A.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The coordinate's key, or the name of the column in A.
    pub name: String,
    /// `deg`, `m`, or nothing where it is unknown.
    pub unit: &'static str,
    /// Rows in which both hold a number.
    pub frames: usize,
    /// Mean difference; NaN without frames, as all below.
    pub mean: f64,
    /// Root mean square of the difference.
    pub rms: f64,
    /// Largest absolute difference.
    pub largest: f64,
    /// The time of the largest, in seconds.
    pub time: f64,
}

/// Why two motions cannot be compared.
#[derive(Clone, Debug, PartialEq)]
pub enum Incomparable {
    /// They have no name in common; the names of A and B.
    Names([Vec<String>; 2]),
    /// They do not overlap in time.
    Times,
}

/// The columns of a quantity that both motions hold.
struct Shared {
    name: String,
    unit: &'static str,
    /// One column, or four of an orientation: in A, in B.
    columns: [Vec<usize>; 2],
    /// What the numbers of A and of B are multiplied by.
    factors: [f64; 2],
}

/// The factor that converts a rotation to degrees; an unstated unit means radians.
fn to_degrees(table: &Table) -> f64 {
    if table.angle_unit == AngleUnit::Degrees { 1.0 } else { 1f64.to_degrees() }
}

/// Compares B with A at the times of A, B interpolated between its rows: linearly, or along the
/// shortest arc for orientations.
///
/// With a model, coordinates are compared, rotations in degrees; without one, columns of the same
/// name without conversion.
///
/// # Errors
/// [`Incomparable`] without a common name or time.
///
/// ```
/// use condyle_motion::{Table, difference};
/// let table = |values: [f64; 2]| Table {
///     columns: vec!["slide".into()],
///     times: vec![0.0, 1.0],
///     values: values.to_vec(),
///     ..Table::default()
/// };
/// let compared = difference::compare(None, &table([1.0, 2.0]), &table([1.0, 2.5])).unwrap();
/// assert_eq!((compared.differences[0].largest, compared.differences[0].time), (0.5, 1.0));
/// ```
pub fn compare(model: Option<&Model>, a: &Table, b: &Table) -> Result<Comparison, Incomparable> {
    let sides = [a, b];
    let (shared, only) = match model {
        Some(model) => by_model(model, sides),
        None => by_name(sides),
    };
    if shared.is_empty() {
        return Err(Incomparable::Names(only));
    }
    let rows = a.times.iter().enumerate();
    let moments: Vec<(usize, Between)> =
        rows.filter_map(|(row, &t)| Some((row, between(&b.times, t, SAME_TIME)?))).collect();
    let (Some(&(first, _)), Some(&(last, _))) = (moments.first(), moments.last()) else {
        return Err(Incomparable::Times);
    };
    Ok(Comparison {
        time: [a.times[first], a.times[last]],
        frames: moments.len(),
        differences: shared.into_iter().map(|s| difference(s, sides, &moments)).collect(),
        only,
    })
}

/// Coordinates of a model that both sides hold: angles in degrees, lengths in metres.
fn by_model(model: &Model, sides: [&Table; 2]) -> (Vec<Shared>, [Vec<String>; 2]) {
    let (mut shared, mut only) = (vec![], [vec![], vec![]]);
    let mut used = [vec![], vec![]];
    for id in model.coordinate_ids() {
        let found = sides
            .map(|side| found_columns(model, id, side).into_iter().collect::<Option<Vec<usize>>>());
        for (used, found) in used.iter_mut().zip(&found) {
            used.extend(found.iter().flatten().copied());
        }
        let name = model.coordinate_key(id);
        match found {
            [Some(a), Some(b)] => {
                let (unit, factors) = match model.coordinate(id).kind {
                    CoordinateKind::Rotation => ("deg", sides.map(to_degrees)),
                    CoordinateKind::Translation => ("m", [1.0; 2]),
                    CoordinateKind::Orientation => ("deg", [1.0; 2]),
                    CoordinateKind::Scale | CoordinateKind::Other => ("", [1.0; 2]),
                };
                shared.push(Shared { name, unit, columns: [a, b], factors });
            }
            [Some(_), None] => only[0].push(name),
            [None, Some(_)] => only[1].push(name),
            [None, None] => {}
        }
    }
    for ((side, used), only) in sides.iter().zip(used).zip(&mut only) {
        let names = side.columns.iter().enumerate();
        only.extend(names.filter(|(i, _)| !used.contains(i)).map(|(_, name)| name.clone()));
    }
    (shared, only)
}

/// Columns of the same name, compared without conversion.
fn by_name([a, b]: [&Table; 2]) -> (Vec<Shared>, [Vec<String>; 2]) {
    let (mut shared, mut only) = (vec![], [vec![], vec![]]);
    let mut used = vec![false; b.columns.len()];
    for (column, name) in a.columns.iter().enumerate() {
        let bare = coordinate_name(name).unwrap_or(name);
        let found = b.column(name).or_else(|| b.column(bare));
        match found.filter(|&found| !used[found]) {
            Some(found) => {
                used[found] = true;
                shared.push(Shared {
                    name: name.clone(),
                    unit: "",
                    columns: [vec![column], vec![found]],
                    factors: [1.0; 2],
                });
            }
            None => only[0].push(name.clone()),
        }
    }
    let rest = b.columns.iter().zip(used).filter(|(_, used)| !used);
    only[1].extend(rest.map(|(name, _)| name.clone()));
    (shared, only)
}

fn difference(shared: Shared, [a, b]: [&Table; 2], moments: &[(usize, Between)]) -> Difference {
    let Shared { name, unit, columns, factors } = shared;
    let (mean, rms, largest, time) = (f64::NAN, f64::NAN, f64::NAN, f64::NAN);
    let mut d = Difference { name, unit, frames: 0, mean, rms, largest, time };
    let (mut sum, mut squares) = (0.0, 0.0);
    let numbers = |table: &Table, row: usize, side: usize| -> Vec<f64> {
        let values = columns[side].iter().map(|&c| table.value(row, c).unwrap_or(f64::NAN));
        values.map(|v| v * factors[side]).collect()
    };
    for (row, moment) in moments {
        let of_a = numbers(a, *row, 0);
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
            d.time = a.times[*row];
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
