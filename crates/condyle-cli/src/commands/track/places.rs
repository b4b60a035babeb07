//! Where the results of each recording go, decided before anything is solved.

use super::Track;
use crate::failure::Failure;
use crate::{motion_format, output};
use condyle::formats::Format;
use condyle::open;
use std::path::{Component, Path, PathBuf};

/// Where the results of one recording go.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    pub(super) motion: Option<PathBuf>,
    pub(super) errors: Option<PathBuf>,
    /// The report beside the motion, by which a later run knows that it is done.
    pub(super) report: Option<PathBuf>,
}

impl Places {
    /// What is written beside the report, by name.
    pub(super) fn results(&self) -> Vec<(&'static str, &Path)> {
        let named = [("motion", &self.motion), ("errors", &self.errors)];
        named.into_iter().filter_map(|(what, place)| Some((what, place.as_deref()?))).collect()
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &Path> {
        [&self.motion, &self.errors, &self.report].into_iter().flatten().map(PathBuf::as_path)
    }
}

/// What a path of an argument means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::commands) enum Kind {
    /// Standard output, a pipe or a device.
    Stream,
    Folder,
    File,
}

impl Kind {
    /// A folder is one, or is not there yet and ends in `/` or has no ending.
    pub(in crate::commands) fn of(path: &Path) -> Self {
        let text = path.as_os_str().to_string_lossy();
        if path.is_dir() || text.ends_with(std::path::is_separator) {
            Self::Folder
        } else if output::is_stream(path) {
            Self::Stream
        } else if path.extension().is_none() && !path.exists() {
            Self::Folder
        } else {
            Self::File
        }
    }
}

/// The places of all recordings and the format of their motions.
pub(super) fn plan(asked: &Track) -> Result<(Vec<Places>, &'static Format), Failure> {
    let several = asked.trials.len() > 1;
    let streams = [&asked.output, &asked.errors, &asked.report].into_iter().flatten();
    let streams = streams.filter(|path| output::is_standard(path)).count();
    if streams + usize::from(asked.json) > 1 {
        return Err(Failure::new(
            "two results want standard output: of -o -, --errors -, --report - and --json give one",
        ));
    }
    let motion = asked.output.as_deref().map(|path| (path, Kind::of(path)));
    let errors = asked.errors.as_deref().map(|path| (path, Kind::of(path)));
    match motion {
        Some((_, Kind::Stream)) if several => {
            return Err(Failure::new(
                "several recordings cannot go to one stream: give a folder, such as -o results/",
            ));
        }
        Some((_, Kind::File)) if several => {
            return Err(Failure::new("several recordings need a folder for -o"));
        }
        None if asked.resume => {
            return Err(Failure::new("--resume needs -o: without results nothing is done before"));
        }
        Some((_, Kind::Stream)) if asked.resume => {
            return Err(Failure::new(
                "--resume needs results in files: give -o a file or a folder",
            ));
        }
        _ => {}
    }
    // The ending of a folder or of a stream is no format's.
    let named = motion.filter(|(_, kind)| *kind == Kind::File).map_or(Path::new("-"), |(p, _)| p);
    let format = motion_format::of_motion(named, asked.to.as_deref())?;
    match errors {
        Some((path, Kind::Stream | Kind::File)) if several => {
            return Err(Failure::new(format!(
                "{}: the errors of several recordings need a folder, such as --errors errors/",
                path.display()
            )));
        }
        Some((path, Kind::File)) => must_end(path, "csv", "a table of marker errors")?,
        _ => {}
    }
    if let Some(path) = &asked.report {
        match Kind::of(path) {
            Kind::Stream => {}
            Kind::File | Kind::Folder => must_end(path, "json", "a report")?,
        }
    }
    let folders = folders(&asked.trials);
    let places: Vec<Places> = asked
        .trials
        .iter()
        .zip(folders)
        .map(|(trial, folder)| {
            let inside = |place: &Path, ending: &str| {
                place.join(&folder).join(format!("{}.{ending}", stem(trial)))
            };
            let of = |(place, kind): (&Path, Kind), ending: &str| match kind {
                Kind::Folder => inside(place, ending),
                _ => place.to_owned(),
            };
            let motion_place = motion.map(|motion| of(motion, format.name));
            let mut errors_place = errors.map(|errors| of(errors, "csv"));
            if errors_place.is_some() && errors_place == motion_place {
                errors_place = errors.map(|errors| of(errors, "errors.csv"));
            }
            let beside = motion.filter(|(_, kind)| *kind == Kind::Folder || asked.resume);
            let report = beside.map(|(place, kind)| match kind {
                Kind::Folder => inside(place, "report.json"),
                _ => place.with_extension("report.json"),
            });
            Places { motion: motion_place, errors: errors_place, report }
        })
        .collect();
    let outputs = places.iter().flat_map(Places::all).chain(asked.report.as_deref());
    let outputs: Vec<&Path> = outputs.collect();
    let inputs = asked.trials.iter().chain([&asked.model]).chain(asked.asked.files());
    let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    output::check_distinct(&inputs, &outputs)?;
    Ok((places, format))
}

pub(in crate::commands) fn must_end(path: &Path, ending: &str, what: &str) -> Result<(), Failure> {
    match open::ending(path) == ending {
        true => Ok(()),
        false => Err(Failure::new(format!(
            "{}: {what} is written as .{ending}: end it in that",
            path.display()
        ))),
    }
}

/// The name of a recording without folder and ending.
pub(in crate::commands) fn stem(trial: &Path) -> String {
    match open::is_standard_input(trial) {
        true => "stdin".to_owned(),
        false => trial.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
    }
}

/// The folder of each recording, from the last folder that holds them all; none of those that come
/// through pipes.
pub(in crate::commands) fn folders(trials: &[PathBuf]) -> Vec<PathBuf> {
    let of = |trial: &PathBuf| -> Option<Vec<std::ffi::OsString>> {
        if output::is_stream(trial) {
            return None;
        }
        let whole = std::path::absolute(trial).ok()?;
        let mut parts = vec![];
        for part in whole.parent()?.components() {
            match part {
                Component::ParentDir => drop(parts.pop()),
                Component::CurDir => {}
                part => parts.push(part.as_os_str().to_owned()),
            }
        }
        Some(parts)
    };
    let all: Vec<_> = trials.iter().map(of).collect();
    let mut known = all.iter().flatten();
    let first = known.next().cloned().unwrap_or_default();
    let common = known.fold(first.len(), |common, parts| {
        first.iter().zip(parts).take(common).take_while(|(a, b)| a == b).count()
    });
    let relative = |parts: &Option<Vec<_>>| parts.iter().flatten().skip(common).collect();
    all.iter().map(relative).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_start_where_recordings_part() {
        let of = |trials: &[&str]| folders(&trials.iter().map(PathBuf::from).collect::<Vec<_>>());
        let expected = |folders: &[&str]| folders.iter().map(PathBuf::from).collect::<Vec<_>>();
        assert_eq!(of(&["d/s1/a/walk.trc", "d/s2/walk.trc"]), expected(&["s1/a", "s2"]));
        assert_eq!(of(&["d/walk.trc", "d/more/walk.trc"]), expected(&["", "more"]));
        assert_eq!(of(&["d/walk.trc", "d/../d/run.trc"]), expected(&["", ""]));
        assert_eq!(of(&["-", "d/walk.trc"]), expected(&["", ""]));
    }
}
