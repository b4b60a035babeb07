//! Frames of trials from which laws of coordinates are learned.

use crate::open::{self, Cause, OpenError};
use crate::tracking::{self, Request, Tracking};
use condyle_diagnostics::{Diagnostic, Error, Read, did_you_mean};
use condyle_formats::Content;
use condyle_learn::coupling::{Groups, Samples};
use condyle_model::{CoordinateId, CoordinateKind, Model};
use condyle_motion::columns::is_length;
use condyle_motion::{AngleUnit, Motion, Recording, Table, Zeros};
use std::collections::HashMap;
use std::path::Path;

/// Which coordinates are meant, and how trials hold them.
#[derive(Clone, Debug, Default)]
pub struct Coupled {
    /// The model that markers are tracked with, or whose coordinates motions hold; without it tables hold coordinates.
    pub model: Option<Model>,
    /// The joint whose coordinates are meant, or the segment that it moves.
    pub joint: Option<String>,
    /// Coordinates of any joint that control.
    pub control: Vec<String>,
    /// Coordinates that follow.
    pub follow: Vec<String>,
    /// Who moves in which trial, and how; what it does not name is read from the names of files.
    pub groups: GroupTable,
    /// How markers are tracked.
    pub request: Request,
    /// What a marker at 0 0 0 is.
    pub zeros: Zeros,
    /// The unit of angles in motions that do not state it.
    pub angles: Option<AngleUnit>,
}

/// Groups of trials by the names of their files, with or without ending.
pub type GroupTable = HashMap<String, Groups>;

/// Frames of all trials.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    /// The frames.
    pub samples: Samples,
    /// What the columns are, where that is known.
    pub kinds: Vec<Option<CoordinateKind>>,
    /// What of a trial that was tracked is left at its markers: the mean over frames of their RMS, in metres; by trial.
    pub marker_rms: Vec<Option<f64>>,
}

/// A frame whose markers are so many times farther off than in the middle frame of its trial is tracked badly.
const FAR: f64 = 3.0;

fn failed(path: &Path, error: Error) -> OpenError {
    OpenError { path: path.to_owned(), cause: Cause::Content { error, text: None } }
}

/// Opens trials one after another, tracks those that hold markers, and takes the coordinates that are meant. `progress` is told
/// the trial, how many frames of it are done, and how many there are.
///
/// # Errors
/// As [`open::content`]; what trials lack of what is wanted; those of tracking.
pub fn gather(
    paths: &[&Path],
    wanted: &Coupled,
    progress: &mut (dyn FnMut(usize, usize, usize) + Send),
) -> Result<Read<Gathered>, OpenError> {
    let first = paths.first().copied().unwrap_or(Path::new(""));
    let meant = match &wanted.model {
        Some(model) => coordinates(model, wanted).map_err(|error| failed(first, error))?,
        None => vec![],
    };
    let mut gathered = Gathered::default();
    let mut warnings = vec![];
    if let Some(model) = &wanted.model {
        gathered.samples.columns = meant.iter().map(|id| model.coordinate_key(*id)).collect();
        gathered.kinds = meant.iter().map(|id| Some(model.coordinate(*id).kind)).collect();
        for id in &meant {
            if model.coordinate(*id).follows.is_some() {
                let key = model.coordinate_key(*id);
                let message = format!("`{key}` follows others in the model already");
                let help = "what is learned of it is what the model says; free it to learn from the recording";
                warnings.push(Diagnostic::warning("learn/follows", message).with_help(help));
            }
        }
    }
    for (index, path) in paths.iter().enumerate() {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let full = path.file_name().unwrap_or_default().to_string_lossy();
        let listed = wanted.groups.get(&*full).or_else(|| wanted.groups.get(&name));
        let groups = listed.cloned().unwrap_or_else(|| Groups::of_name(&name));
        let Read { value: content, warnings: said } = open::content_with(path, None, wanted.zeros)?;
        warnings.extend(said);
        let (rows, bad, rms) = match (content, &wanted.model) {
            (Content::Table(table), None) => {
                let rows = of_table(&mut gathered, table, wanted, &mut warnings);
                (rows.map_err(|error| failed(path, error))?, 0, None)
            }
            (Content::Table(mut table), Some(model)) => {
                let said = open::settled(model, &mut table, wanted.angles);
                warnings.extend(said.map_err(|error| failed(path, error))?);
                let (motion, said) = Motion::from_table(model, &table);
                // Columns of other coordinates do not matter; missing ones do.
                warnings.extend(said.into_iter().filter(|w| w.code != "motion/absent"));
                let absent = meant.iter().find(|id| {
                    let found = condyle_motion::columns::found_columns(model, **id, &table);
                    found.iter().any(Option::is_none)
                });
                if let Some(absent) = absent {
                    let key = model.coordinate_key(*absent);
                    let message = format!("the motion has no column for `{key}`");
                    return Err(failed(path, Error::new("learn/column", message)));
                }
                (of_motion(model, &meant, &motion), 0, None)
            }
            (Content::Recording(_) | Content::Trial(_), None) => {
                let error =
                    Error::new("learn/model", "markers need a model with which they are tracked")
                        .with_help("give one whose joint is free with --model M --joint J");
                return Err(failed(path, error));
            }
            (Content::Recording(recording), Some(model)) => {
                tracked(model, &meant, &recording, &wanted.request, &mut |done, all| {
                    progress(index, done, all);
                })
                .map_err(|error| failed(path, error))?
            }
            (Content::Trial(trial), Some(model)) => {
                let recording = &trial.recording;
                tracked(model, &meant, recording, &wanted.request, &mut |done, all| {
                    progress(index, done, all);
                })
                .map_err(|error| failed(path, error))?
            }
            (other, _) => {
                let message = format!("the file holds {}, no trial", other.kind().name());
                return Err(failed(path, Error::new("learn/content", message)));
            }
        };
        gathered.samples.add(&name, groups, &rows, bad);
        gathered.marker_rms.push(rms);
    }
    if gathered.samples.frames() == 0 {
        let error = Error::new("learn/no-frames", "no frame of any trial has all coordinates");
        return Err(failed(first, error));
    }
    Ok(Read { value: gathered, warnings })
}

/// The coordinates that are meant: those of the joint that are no orientation and move, and those that are named.
fn coordinates(model: &Model, wanted: &Coupled) -> Result<Vec<CoordinateId>, Error> {
    let mut meant: Vec<CoordinateId> = vec![];
    if let Some(joint) = &wanted.joint {
        let named = model.joint_set_ids().find(|s| model.joint_sets()[s.index()].name == *joint);
        let set = named.or_else(|| {
            let segment = model.find_segment(joint).ok()?;
            model.segment(segment).joint_set
        });
        let Some(set) = set else {
            let names: Vec<&str> = model.joint_sets().iter().map(|set| set.name.as_str()).collect();
            let all = || format!("joints are: {}", condyle_diagnostics::listed(&names));
            let help = did_you_mean(joint, names.iter().copied(), all);
            let message = format!("no joint and no segment with one is called `{joint}`");
            return Err(Error::new("learn/joint", message).with_help(help));
        };
        for id in model.coordinates_of(set) {
            let coordinate = model.coordinate(id);
            if coordinate.kind.stored() != 1 {
                let message =
                    format!("`{}` is an orientation, which is no single number", coordinate.name);
                let help = "give the joint three angles";
                return Err(Error::new("learn/orientation", message).with_help(help));
            }
            if !coordinate.locked {
                meant.push(id);
            }
        }
    }
    for name in wanted.control.iter().chain(&wanted.follow) {
        let id = model.find_coordinate(name)?;
        if !meant.contains(&id) {
            meant.push(id);
        }
    }
    if meant.is_empty() {
        let message = "which coordinates are meant is not said";
        let help = "name a joint with --joint, or coordinates with --control and --follow";
        return Err(Error::new("learn/joint", message).with_help(help));
    }
    Ok(meant)
}

fn of_motion(model: &Model, meant: &[CoordinateId], motion: &Motion) -> Vec<f64> {
    let row = |frame: &Vec<f64>| meant.iter().map(|id| model.value(frame, *id)).collect::<Vec<_>>();
    motion.frames.iter().flat_map(row).collect()
}

/// Coordinates, how many frames were tracked badly, and the RMS of the markers of the others.
pub(super) type Rows = (Vec<f64>, usize, Option<f64>);

/// The coordinates that are meant in the frames of a recording that are tracked well.
pub(super) fn tracked(
    model: &Model,
    meant: &[CoordinateId],
    recording: &Recording,
    request: &Request,
    progress: &mut (dyn FnMut(usize, usize) + Send),
) -> Result<Rows, Error> {
    let tracking = tracking::track(model, recording, request, progress)?;
    let errors = frame_errors(&tracking);
    let mut rising: Vec<f64> = errors.iter().flatten().copied().collect();
    rising.sort_by(f64::total_cmp);
    let Some(middle) = rising.get(rising.len() / 2) else {
        return Err(Error::new("learn/not-tracked", "no frame could be tracked"));
    };
    let most = FAR * middle.max(1e-6);
    let (mut rows, mut bad, mut sum, mut good) = (vec![], 0, 0.0, 0usize);
    for (frame, error) in errors.iter().enumerate() {
        match error {
            Some(error) if *error <= most => {
                let stored = tracking.answers.coordinates(frame);
                rows.extend(meant.iter().map(|id| model.value(stored, *id)));
                sum += error;
                good += 1;
            }
            _ => bad += 1,
        }
    }
    Ok((rows, bad, (good > 0).then(|| sum / good as f64)))
}

/// The RMS of the markers of each frame; `None` where it was not solved.
fn frame_errors(tracking: &Tracking) -> Vec<Option<f64>> {
    (0..tracking.answers.len())
        .map(|frame| {
            let answer = tracking.answers.get(frame)?;
            let solved = answer.status.is_solved();
            let seen: Vec<f64> =
                answer.marker_errors.iter().copied().filter(|e| e.is_finite()).collect();
            let squares: f64 = seen.iter().map(|e| e * e).sum();
            (solved && !seen.is_empty()).then(|| (squares / seen.len() as f64).sqrt())
        })
        .collect()
}

/// The values of a table whose columns are the coordinates; those of the first trial are those of all.
fn of_table(
    gathered: &mut Gathered,
    mut table: Table,
    wanted: &Coupled,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Vec<f64>, Error> {
    // What a table does not state stays as it is: wheels turn by more than joints do, so that sizes tell nothing.
    if let Some(told) = wanted.angles {
        table.angle_unit = told;
    }
    let degrees = table.angle_unit == AngleUnit::Degrees;
    let names: Vec<String> = if !gathered.samples.columns.is_empty() {
        gathered.samples.columns.clone()
    } else if wanted.control.is_empty() || wanted.follow.is_empty() {
        // Named ones first keep the names that were given.
        let given: Vec<String> = wanted.control.iter().chain(&wanted.follow).cloned().collect();
        let places: Vec<usize> = given.iter().filter_map(|name| table.column(name)).collect();
        let others = table.columns.iter().enumerate().filter(|(c, _)| !places.contains(c));
        let others = others.filter_map(|(_, column)| {
            let bare = condyle_motion::columns::coordinate_name(column)?;
            Some(if table.column(bare).is_some() { bare.to_owned() } else { column.clone() })
        });
        given.iter().cloned().chain(others).collect()
    } else {
        wanted.control.iter().chain(&wanted.follow).cloned().collect()
    };
    let places: Vec<usize> = names
        .iter()
        .map(|name| {
            table.column(name).ok_or_else(|| {
                let all =
                    || format!("columns are: {}", condyle_diagnostics::listed(&table.columns));
                let columns = table.columns.iter().map(String::as_str);
                let help = did_you_mean(name, columns, all);
                Error::new("learn/column", format!("there is no column `{name}`")).with_help(help)
            })
        })
        .collect::<Result<_, _>>()?;
    let kinds: Vec<Option<CoordinateKind>> =
        names.iter().map(|name| kind_of(name, degrees)).collect();
    let factors: Vec<f64> = kinds
        .iter()
        .map(|kind| match kind {
            Some(CoordinateKind::Rotation) if degrees => 1f64.to_radians(),
            _ => 1.0,
        })
        .collect();
    if gathered.samples.columns.is_empty() {
        if degrees {
            let lengths: Vec<&String> =
                names.iter().zip(&factors).filter(|(_, f)| **f == 1.0).map(|(n, _)| n).collect();
            if !lengths.is_empty() {
                let message = format!(
                    "{} taken as lengths by their names; all other columns are degrees",
                    condyle_diagnostics::listed(&lengths)
                );
                let help = "give the model of the motion with --model to be sure";
                warnings.push(Diagnostic::note("learn/lengths", message).with_help(help));
            }
        }
        gathered.samples.columns = names;
        gathered.kinds = kinds;
    }
    let row = |row: usize| {
        let cells = table.row(row);
        places
            .iter()
            .zip(&factors)
            .map(|(c, f)| cells.get(*c).copied().unwrap_or(f64::NAN) * f)
            .collect::<Vec<_>>()
    };
    Ok((0..table.rows()).flat_map(row).collect())
}

/// A translation or a rotation by the name of its column; in a table of degrees all that is no length is an angle.
fn kind_of(name: &str, degrees: bool) -> Option<CoordinateKind> {
    let lower = name.to_ascii_lowercase();
    let bare = lower.rsplit('/').next().unwrap_or(&lower);
    let turns = ["rot", "angle", "flex", "duct", "tilt", "list", "exten", "elev"];
    let ends = ["_x", "_y", "_z"];
    let turned = turns.iter().any(|word| bare.contains(word));
    let along = ["x", "y", "z", "t_x", "t_y", "t_z"].contains(&bare)
        || (ends.iter().any(|end| bare.ends_with(end)) && !turned)
        || bare.contains("distance");
    if is_length(name) || along {
        return Some(CoordinateKind::Translation);
    }
    (degrees || turned).then_some(CoordinateKind::Rotation)
}

/// Reads a table of groups: lines of `file,subject,motion` or `file,subject,motion,sub_motion` below a line that names them.
///
/// ```
/// let table = condyle::learning::group_table("file,subject,motion\nwalk_a.trc,Anna,walk\n")?;
/// assert_eq!(table["walk_a.trc"].subject, "Anna");
/// # Ok::<(), condyle::Error>(())
/// ```
///
/// # Errors
/// `learn/groups` with the line that is wrong.
pub fn group_table(text: &str) -> Result<GroupTable, Error> {
    let wrong = |line: usize, message: String| {
        let place = condyle_diagnostics::Place::at_line(line);
        Error::new("learn/groups", message).at(place).with_help(
            "begin with a line `file,subject,motion` or `file,subject,motion,sub_motion`",
        )
    };
    let mut lines = text.lines().enumerate().filter(|(_, line)| {
        let line = line.trim();
        !line.is_empty() && !line.starts_with('#')
    });
    let cells = |line: &str| -> Vec<String> {
        line.trim_start_matches('\u{feff}')
            .split([',', ';', '\t'])
            .map(|cell| cell.trim().trim_matches('"').to_owned())
            .collect()
    };
    let Some((at, head)) = lines.next() else {
        return Err(wrong(1, "the table of groups is empty".to_owned()));
    };
    let head: Vec<String> = cells(head).iter().map(|cell| cell.to_ascii_lowercase()).collect();
    let place = |name: &str| head.iter().position(|cell| cell == name);
    let Some(file) = place("file").or_else(|| place("trial")) else {
        return Err(wrong(at + 1, "the table of groups has no column `file`".to_owned()));
    };
    let [subject, motion, sub] = ["subject", "motion", "sub_motion"].map(place);
    let mut table = GroupTable::new();
    for (at, line) in lines {
        let cells = cells(line);
        let of = |column: Option<usize>| {
            column.and_then(|c| cells.get(c)).cloned().filter(|cell| !cell.is_empty())
        };
        let Some(name) = of(Some(file)) else {
            return Err(wrong(at + 1, "the line names no file".to_owned()));
        };
        let bare = Path::new(&name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let guessed = Groups::of_name(&bare);
        let motion = of(motion).unwrap_or(guessed.motion);
        let groups = Groups {
            subject: of(subject).unwrap_or(guessed.subject),
            sub_motion: of(sub).unwrap_or_else(|| motion.clone()),
            motion,
        };
        table.insert(name, groups);
    }
    Ok(table)
}
