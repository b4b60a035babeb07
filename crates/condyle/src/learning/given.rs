//! What a limit depends on, as recordings show it.

use condyle_diagnostics::{Diagnostic, Error, listed};
use condyle_learn::frames::{Orientated, Recipe};
use condyle_learn::limits::dependent::{
    Asked, DependenceSettings, Driver, Drivers, Pairs, limit as dependent_limit,
};
use condyle_learn::limits::{About, Cloud, Gathered, LearnedLimit, SPACING, left_out};
use condyle_learn::rotations::{self, Pair};
use condyle_math::Quat;
use condyle_model::{CoordinateKind, Model};
use condyle_motion::{Motion, Orientations, Recording, Table};

use super::Take;
use super::limit::{How, about, are_independent, raw, warnings};
use condyle_learn::limits::dependent::Dependence;

/// What a limit is to depend on.
#[derive(Clone, Debug, Default)]
pub struct Wished {
    /// A coordinate, or a segment whose rotation it is; of a table a column.
    pub name: String,
    /// The segment in which a rotation is seen; without it, its parent.
    pub reference: Option<String>,
    /// Which markers give its rotation, with the name of the recipe.
    pub recipe: Option<(String, Recipe)>,
}

/// The driver at each rotation of a take.
#[derive(Clone, Debug, PartialEq)]
pub struct Driven {
    /// The coordinate or segment.
    pub name: String,
    /// Of a rotation, the segment in which it is seen.
    pub reference: Option<String>,
    /// What a coordinate measures, as far as the recording tells.
    pub kind: Option<CoordinateKind>,
    /// Its values.
    pub drivers: Drivers,
}

/// The columns of a table that hold the rotation of a driver.
pub const DRIVER_COLUMNS: [&str; 4] = ["gx", "gy", "gz", "gw"];

fn column(table: &Table, name: &str) -> Option<usize> {
    table.columns.iter().position(|own| own.trim().eq_ignore_ascii_case(name))
}

/// The driver in each row of a table: the column of its name, in radians or metres, or that name with `_deg` or `_m`; of a
/// rotation gx, gy, gz, gw. `None` in rows without.
///
/// # Errors
/// `given/columns` if the table has none of these.
pub fn drivers_of_table(
    table: &Table,
    name: &str,
    turns: Option<bool>,
) -> Result<Vec<Option<Driver>>, Error> {
    let rows = 0..table.rows();
    let cell = |row: usize, at: usize| table.row(row).get(at).copied().unwrap_or(f64::NAN);
    let scalar = [
        (name.to_owned(), 1.0),
        (format!("{name}_deg"), 1f64.to_radians()),
        (format!("{name}_m"), 1.0),
    ];
    let scalar = scalar.iter().find_map(|(name, unit)| Some((column(table, name)?, *unit)));
    if let Some((at, unit)) = scalar.filter(|_| turns != Some(true)) {
        let value = |row| Some(cell(row, at) * unit).filter(|value| value.is_finite());
        return Ok(rows.map(|row| value(row).map(Driver::Scalar)).collect());
    }
    let turn = DRIVER_COLUMNS.map(|name| column(table, name));
    if let ([Some(x), Some(y), Some(z), Some(w)], true) = (turn, turns != Some(false)) {
        let value = |row| {
            let q = Quat::from([x, y, z, w].map(|at| cell(row, at)));
            let length = q.dot(q);
            (length.is_finite() && length > 1e-12).then(|| Driver::Rotation(q.normalized()))
        };
        return Ok(rows.map(value).collect());
    }
    let wanted = match turns {
        Some(true) => "gx, gy, gz, gw: the rotation of what the limit depends on".to_owned(),
        Some(false) => format!(
            "`{name}` in radians or metres, `{name}_deg` in degrees, or `{name}_m` in metres"
        ),
        None => format!("`{name}`, `{name}_deg`, `{name}_m`, or gx, gy, gz, gw"),
    };
    let message =
        format!("the table does not tell `{name}`: its columns are {}", listed(&table.columns));
    Err(Error::new("given/columns", message).with_help(format!("add the columns {wanted}")))
}

/// Keeps the rotations whose frames have a driver.
pub(super) fn kept(
    found: &mut Orientated,
    drivers: &[Option<Driver>],
    name: String,
    reference: Option<String>,
) -> Driven {
    let (mut scalars, mut turns) = (vec![], vec![]);
    let frames = std::mem::take(&mut found.frames);
    let rotations = std::mem::take(&mut found.rotations);
    for (frame, q) in frames.into_iter().zip(rotations) {
        match drivers.get(frame).copied().flatten() {
            Some(Driver::Scalar(value)) => scalars.push(value),
            Some(Driver::Rotation(q)) => turns.push(q),
            None => {
                found.missing += 1;
                continue;
            }
        }
        found.frames.push(frame);
        found.rotations.push(q);
    }
    let drivers =
        if turns.is_empty() { Drivers::Scalars(scalars) } else { Drivers::Rotations(turns) };
    Driven { name, reference, kind: None, drivers }
}

fn by_frame(turned: &Orientated, frames: usize) -> Vec<Option<Driver>> {
    let mut drivers = vec![None; frames];
    for (frame, q) in turned.frames.iter().zip(&turned.rotations) {
        if let Some(driver) = drivers.get_mut(*frame) {
            *driver = Some(Driver::Rotation(*q));
        }
    }
    drivers
}

/// Of markers, by a second recipe.
pub(super) fn of_markers(
    wished: &Wished,
    recording: &Recording,
    subject: Option<&str>,
    found: &mut Orientated,
) -> Result<Driven, Error> {
    let Some((_, recipe)) = &wished.recipe else {
        let error =
            Error::new("given/recipe", "how markers give what the limit depends on is not said");
        return Err(error.with_help("give a second recipe with --given-recipe"));
    };
    let turned = recipe.rotations_of(recording, subject)?;
    let frames = turned.frames.iter().chain(&found.frames).max().map_or(0, |last| last + 1);
    let reference = recipe.reference.as_ref().map(|frame| frame.name.clone());
    Ok(kept(found, &by_frame(&turned, frames), recipe.child.name.clone(), reference))
}

/// Of a motion: a coordinate by its name, else a segment or joint.
pub(super) fn of_motion(
    wished: &Wished,
    model: &Model,
    motion: &Motion,
    found: &mut Orientated,
) -> Result<Driven, Error> {
    let coordinate = model.find_coordinate(&wished.name);
    let turn = Pair::named(model, &wished.name, wished.reference.as_deref());
    match (coordinate, turn) {
        (Ok(id), _) if model.coordinate(id).kind != CoordinateKind::Orientation => {
            let at = model.stored_range(id).start;
            let value = |frame: &Vec<f64>| frame.get(at).copied().filter(|value| value.is_finite());
            let drivers: Vec<Option<Driver>> =
                motion.frames.iter().map(|frame| value(frame).map(Driver::Scalar)).collect();
            let kind = Some(model.coordinate(id).kind);
            Ok(Driven { kind, ..kept(found, &drivers, model.coordinate_key(id), None) })
        }
        (_, Ok(pair)) => {
            let turned = rotations::segments(model, motion, &[pair])?;
            let turned = turned.into_iter().next().unwrap_or_default();
            let named = |segment| model.segment(segment).name.clone();
            let drivers = by_frame(&turned, motion.frames.len());
            Ok(kept(found, &drivers, named(pair.child), pair.reference.map(named)))
        }
        (Err(_), Err(error)) => {
            let message = format!("`{}` is neither a coordinate nor a segment", wished.name);
            Err(Error::new("given/name", message).with_help(error.to_string()))
        }
        (Ok(_), Err(error)) => Err(error),
    }
}

/// Of inertial sensors.
pub(super) fn of_sensors(
    wished: &Wished,
    sensors: &Orientations,
    found: &mut Orientated,
) -> Result<Driven, Error> {
    let turned = rotations::of_sensors(sensors, &wished.name, wished.reference.as_deref())?;
    let drivers = by_frame(&turned, sensors.frames());
    Ok(kept(found, &drivers, wished.name.clone(), wished.reference.clone()))
}

/// Of a table of rotations.
pub(super) fn of_table(
    wished: &Wished,
    table: &Table,
    found: &mut Orientated,
) -> Result<Driven, Error> {
    let drivers = drivers_of_table(table, &wished.name, None)?;
    let driven = kept(found, &drivers, wished.name.clone(), wished.reference.clone());
    let scalar = matches!(driven.drivers, Drivers::Scalars(_));
    let metres = scalar && column(table, &format!("{}_m", wished.name)).is_some();
    Ok(Driven { kind: metres.then_some(CoordinateKind::Translation), ..driven })
}

/// A limit that depends on another joint, and how it came about.
#[derive(Clone, Debug)]
pub struct LearnedGiven {
    /// The limit.
    pub limit: LearnedLimit,
    /// What became of all rotations.
    pub gathered: Gathered,
    /// Whether most rotations are independent of those before and after them.
    pub independent: bool,
    /// The distances of samples that were left out in turn to what the others say at their drivers, in radians, rising.
    pub left_out: Vec<f64>,
    /// What a person should know.
    pub warnings: Vec<Diagnostic>,
}

/// How what a limit depends on is used; what is not said is what is usual for it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HowGiven {
    /// By how much a boundary may move per unit of the driver.
    pub slope: Option<f64>,
    /// How far the values of the driver are apart at which limits are learned.
    pub step: Option<f64>,
}

/// Learns a limit that depends on what each take has as [`Take::given`].
///
/// Frames of recordings are thinned together with their drivers. The limit without its driver is learned as
/// [`learn`](super::learn) does.
///
/// # Errors
/// As [`learn`](super::learn); `given/takes` where takes do not tell the same driver.
pub fn learn_given(
    takes: &[Take],
    how: &How,
    by: &HowGiven,
    name: &str,
) -> Result<LearnedGiven, Error> {
    let raw = raw(takes);
    let independent = are_independent(&raw);
    let driven: Option<Vec<&Driven>> = takes.iter().map(|take| take.given.as_ref()).collect();
    let driven = driven
        .filter(|all| !all.is_empty())
        .ok_or_else(|| Error::new("given/takes", "not all takes tell what the limit depends on"))?;
    // A take of which nothing is left is of no kind.
    let kinds = |d: &&&Driven| !d.drivers.is_empty();
    let first = driven.iter().find(kinds).or(driven.first()).copied();
    let Some(first) = first else {
        return Err(Error::new("cloud/empty", "there are no takes"));
    };
    if let Some(other) = driven.iter().find(|other| other.name != first.name) {
        let message = format!("takes depend on `{}` and on `{}`", first.name, other.name);
        return Err(Error::new("given/takes", message));
    }
    let mut settings = DependenceSettings::of(&first.drivers);
    settings.slope = by.slope.unwrap_or(settings.slope);
    settings.step = by.step.unwrap_or(settings.step);
    settings.gap = how.offset;
    let spacing = how.spacing.unwrap_or(if independent { 0.0 } else { SPACING });
    let pairs: Vec<(&[Quat], Drivers)> = raw
        .iter()
        .copied()
        .zip(&driven)
        .map(|(rotations, driven)| match (rotations.is_empty(), &first.drivers) {
            (true, Drivers::Scalars(_)) => (rotations, Drivers::Scalars(vec![])),
            (true, Drivers::Rotations(_)) => (rotations, Drivers::Rotations(vec![])),
            (false, _) => (rotations, driven.drivers.clone()),
        })
        .collect();
    let pairs = Pairs::gather(&pairs, spacing, settings.slope)?;
    let whole = super::limit::settings(how);
    let whole = match independent {
        true => whole,
        false => left_out(&raw, spacing.max(1e-3), &whole)?.settings(&whole),
    };
    let cloud = Cloud::gather(&[&pairs.rotations], 0.0)?;
    // Takes after the last one that gave samples have none to name.
    let last = pairs.takes.iter().max().map_or(0, |last| *last as usize + 1);
    let names: Vec<String> = takes.iter().take(last).map(|take| take.name.clone()).collect();
    let source = format!("recordings {}", names.join(", "));
    let asked = Asked {
        about: About { source, takes: names, ..about(takes, &cloud, name) },
        name: first.name.clone(),
        reference: first.reference.clone(),
        kind: first.kind,
        settings: Some(settings),
        whole,
        curves: (!independent).then_some(spacing),
    };
    let (limit, left_out) = dependent_limit(&pairs, &asked)?;
    let gathered = pairs.gathered;
    let warnings = warnings(&cloud, takes);
    Ok(LearnedGiven { limit, gathered, independent, left_out, warnings })
}

/// At each value of the driver the share of all rotations that is valid (of a hinge, of a full turn) and how many samples
/// there are about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Bin {
    /// The value of the driver.
    pub at: Driver,
    /// The share.
    pub share: f64,
    /// The samples.
    pub samples: u32,
    /// Of a hinge its bounds in radians.
    pub bounds: Option<[f64; 2]>,
}

/// The bins of a limit that depends on another joint; `None` of others.
#[must_use]
pub fn bins(limit: &LearnedLimit) -> Option<(&Dependence, Vec<Bin>)> {
    let given = limit.given()?;
    let made = given.made();
    let mut bins = vec![];
    for cell in 0..made.cells.len() {
        let (Some(at), Some(share)) = (made.cells.value(cell), made.shares.get(cell)) else {
            continue;
        };
        // Before and behind the values that were recorded, what the nearest say goes on.
        let samples = made.counts.get(cell).copied().unwrap_or(0);
        if matches!(at, Driver::Scalar(_)) && (cell == 0 || cell + 1 == made.cells.len()) {
            continue;
        }
        bins.push(Bin { at, share: *share, samples, bounds: given.bounds(at) });
    }
    Some((given.dependence(), bins))
}
