//! Motions, models and recordings to the bytes of a format.

#[cfg(feature = "glb")]
use crate::scene;
use condyle_diagnostics::{Diagnostic, Error, Read};
#[cfg(feature = "glb")]
use condyle_formats::glb;
use condyle_formats::{ContentKind, Format, Id, csv, sto, trc};
#[cfg(feature = "glb")]
use condyle_model::Mode;
use condyle_model::Model;
use condyle_motion::{AngleUnit, Motion, Recording, Table};

/// A motion of a model: a table in degrees, a CSV in radians and metres, or a scene of plain bones in
/// which recorded markers are shown beside the model's.
///
/// `markers` gives a recording and which of its labels are shown. `remarks` are keys and values of the
/// header of a table, such as [`Tracking::remarks`](crate::tracking::Tracking::remarks); a CSV and a scene
/// have no place for them.
///
/// # Errors
/// `format/not-written` if motions are not written in this format; what the writer finds wrong.
pub fn motion(
    format: &Format,
    model: &Model,
    motion: &Motion,
    name: &str,
    markers: Option<(&Recording, &[usize])>,
    remarks: &[(String, String)],
) -> Result<Read<Vec<u8>>, Error> {
    let _ = markers;
    match format.id {
        #[cfg(feature = "glb")]
        Id::Glb => scene(model, motion, Mode::Open, markers),
        Id::Csv => {
            let mut table = motion.to_table(model, name);
            // A table for programs: the units of the library.
            table.values = motion.frames.concat();
            table.angle_unit = AngleUnit::Radians;
            self::table(format, &table).map(Read::clean)
        }
        _ => {
            let table = Table { header: remarks.to_vec(), ..motion.to_table(model, name) };
            self::table(format, &table).map(Read::clean)
        }
    }
}

/// A motion as a scene of plain bones. Limits are applied here, since not all of them can be said by
/// coordinates.
///
/// # Errors
/// What the writer finds wrong.
#[cfg(feature = "glb")]
pub fn scene(
    model: &Model,
    motion: &Motion,
    mode: Mode,
    markers: Option<(&Recording, &[usize])>,
) -> Result<Read<Vec<u8>>, Error> {
    let Read { value, warnings } = scene::baked(model, motion, mode, markers);
    Ok(Read { value: glb::write(&value)?, warnings })
}

/// A table, number by number.
///
/// # Errors
/// `format/not-written` if tables are not written in this format; what the writer finds wrong.
pub fn table(format: &Format, table: &Table) -> Result<Vec<u8>, Error> {
    match format.id {
        Id::Mot | Id::Sto => sto::write(table).map(String::into_bytes),
        Id::Csv => csv::write(table).map(String::into_bytes),
        _ => Err(not_written(format, ContentKind::Motion)),
    }
}

/// A marker recording; `name` is what its header says.
///
/// # Errors
/// `format/not-written` if recordings are not written in this format; what the writer finds wrong.
pub fn recording(format: &Format, recording: &Recording, name: &str) -> Result<Vec<u8>, Error> {
    match format.id {
        Id::Trc => trc::write(recording, name).map(String::into_bytes),
        Id::Csv => table(format, &recording.to_table()),
        _ => Err(not_written(format, ContentKind::Recording)),
    }
}

fn not_written(format: &Format, kind: ContentKind) -> Error {
    let message = format!("{} is not written as .{}", kind.name(), format.name);
    Diagnostic::error("format/not-written", message)
        .with_help(format!("known are {}", Format::endings_that_write(kind)))
        .into()
}
