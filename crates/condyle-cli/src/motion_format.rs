//! The format in which something is written.

use crate::failure::{Failure, warned};
use clap::builder::PossibleValuesParser;
use condyle::formats::{ContentKind, FORMATS, Format};
use condyle::{Model, Motion, Recording, encode, open};
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
