//! The format in which something is written.

use crate::failure::{Failure, warned};
use crate::output::not_written;
use clap::builder::PossibleValuesParser;
use condyle::formats::{ContentKind, FORMATS, Format, csv};
use condyle::tracking::Tracking;
use condyle::{Model, Motion, Recording, encode, open};
use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;

/// What a motion may be written as.
const MOTION: [ContentKind; 2] = [ContentKind::Motion, ContentKind::Scene];

/// The names that `--to` takes for these kinds.
pub(crate) fn names(kinds: &'static [ContentKind]) -> PossibleValuesParser {
    let written = FORMATS.iter().filter(|f| f.writes.iter().any(|kind| kinds.contains(kind)));
    PossibleValuesParser::new(written.map(|f| f.name).collect::<Vec<_>>())
}

/// The names that `--to` takes for motions.
pub(crate) fn motions() -> PossibleValuesParser {
    names(&MOTION)
}

/// The format of a motion: by `--to`, else by the ending of the path.
pub(crate) fn of_motion(path: &Path, to: Option<&str>) -> Result<&'static Format, Failure> {
    let by_ending = if path == Path::new("-") { "mot".to_owned() } else { open::ending(path) };
    let found = Format::of_ending(to.unwrap_or(&by_ending));
    found.filter(|f| f.writes.iter().any(|kind| MOTION.contains(kind))).ok_or_else(|| {
        let known = MOTION.map(Format::endings_that_write).join(", ");
        Failure::new(format!(
            "{}: the ending names no format for a motion (known are {known}; or give --to)",
            path.display()
        ))
    })
}

/// A motion in a format.
pub(crate) fn encoded(
    format: &Format,
    model: &Model,
    motion: &Motion,
    name: &str,
    markers: Option<(&Recording, &[usize])>,
    remarks: &[(String, String)],
) -> Result<Vec<u8>, Failure> {
    Ok(warned(Path::new(name), encode::motion(format, model, motion, name, markers, remarks)?))
}

/// How many frames are put into words at once.
const PART: usize = 4096;

/// Writes what was tracked in a format; tables part by part, as they may be long.
pub(crate) fn write_tracked(
    output: &mut impl Write,
    place: &Path,
    format: &Format,
    model: &Model,
    tracking: &Tracking,
    name: &str,
    recording: &Recording,
) -> Result<(), Failure> {
    let fail = |error: io::Error| not_written(place, error);
    let remarks = tracking.remarks(model);
    if !format.writes.contains(&ContentKind::Motion) {
        let markers = Some((recording, tracking.labels.as_slice()));
        let bytes = encoded(format, model, &tracking.motion(), name, markers, &remarks)?;
        return output.write_all(&bytes).map_err(fail);
    }
    let count = tracking.answers.len();
    let table = |frames: Range<usize>| {
        let part = tracking.motion_of(frames);
        encode::motion_table(format, model, &part, name, &remarks)
    };
    let head = encode::table_head(format, &table(0..0), count)?;
    output.write_all(head.as_bytes()).map_err(fail)?;
    for start in (0..count).step_by(PART) {
        let rows = encode::table_rows(format, &table(start..start + PART))?;
        output.write_all(rows.as_bytes()).map_err(fail)?;
    }
    Ok(())
}

/// Writes the error of each marker in each frame, part by part.
pub(crate) fn write_errors(output: &mut impl Write, tracking: &Tracking) -> io::Result<()> {
    let count = tracking.answers.len();
    for start in (0..count.max(1)).step_by(PART) {
        let frames = start..(start + PART).min(count);
        let rows = frames.flat_map(|frame| {
            let errors = tracking.markers.iter().zip(tracking.answers.marker_errors(frame));
            let seen = errors.filter(|(_, error)| error.is_finite());
            seen.map(move |(name, &error)| (tracking.times[frame], name.as_str(), error))
        });
        let text = csv::write_marker_errors(rows);
        // Only the first part has the line of names.
        let names = text.find('\n').map_or(0, |end| end + 1);
        output.write_all(
            text.as_bytes().get(if start == 0 { 0 } else { names }..).unwrap_or_default(),
        )?;
    }
    Ok(())
}
