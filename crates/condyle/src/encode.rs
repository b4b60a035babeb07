//! Motions, models and recordings to the bytes of a format.

#[cfg(feature = "glb")]
use crate::scene;
use condyle_diagnostics::{Diagnostic, Error, Read};
#[cfg(feature = "glb")]
use condyle_formats::glb;
use condyle_formats::{ContentKind, Format, Id, bvh, c3d, csv, sto, trc};
#[cfg(feature = "document")]
use condyle_learn::limits::LearnedLimit;
use condyle_model::{Facing, Mode, Model};
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
        Id::Bvh => skeleton(format, &ahead(model), motion, Mode::Open, bvh::USUAL_UNIT),
        _ => {
            let table = motion_table(format, model, motion, name, remarks);
            self::table(format, &table).map(Read::clean)
        }
    }
}

/// A motion of a model, or a part of one, as the table that a format holds: in degrees, or in radians and
/// metres for a CSV.
pub fn motion_table(
    format: &Format,
    model: &Model,
    motion: &Motion,
    name: &str,
    remarks: &[(String, String)],
) -> Table {
    let mut table = motion.to_table(model, name);
    if format.id == Id::Csv {
        // A table for programs: the units of the library.
        table.values = motion.frames.concat();
        table.angle_unit = AngleUnit::Radians;
    } else {
        table.header = remarks.to_vec();
    }
    table
}

/// The lines before the rows of a table that will have so many of them, some of which are in `part`.
///
/// # Errors
/// As [`table`].
pub fn table_head(format: &Format, part: &Table, rows: usize) -> Result<String, Error> {
    match format.id {
        Id::Mot | Id::Sto => sto::head(part, rows),
        Id::Csv => Ok(csv::head(part)),
        _ => Err(not_written(format, ContentKind::Motion)),
    }
}

/// The rows of a part of a table: after [`table_head`] and the rows of all parts it is what [`table`] gives.
///
/// # Errors
/// As [`table`].
pub fn table_rows(format: &Format, part: &Table) -> Result<String, Error> {
    match format.id {
        Id::Mot | Id::Sto => Ok(sto::rows(part)),
        Id::Csv => Ok(csv::rows(part)),
        _ => Err(not_written(format, ContentKind::Motion)),
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

/// A surface alone as a scene, a metre for each unit.
///
/// # Errors
/// What the writer finds wrong.
#[cfg(feature = "glb")]
pub fn surface(mesh: condyle_mesh::Mesh, name: &str) -> Result<Vec<u8>, Error> {
    coloured_surface(mesh, vec![], name)
}

/// A surface alone with a colour for each corner, red, green and blue in linear light from 0 to 1.
///
/// # Errors
/// What the writer finds wrong.
#[cfg(feature = "glb")]
pub fn coloured_surface(
    mesh: condyle_mesh::Mesh,
    colours: Vec<[f32; 3]>,
    name: &str,
) -> Result<Vec<u8>, Error> {
    let node = glb::SceneNode { name: name.to_owned(), ..glb::SceneNode::default() };
    let surface = glb::Surface { mesh, colours, ..glb::Surface::default() };
    glb::write(&glb::Scene {
        name: name.to_owned(),
        nodes: vec![node],
        surfaces: vec![surface],
        ..glb::Scene::default()
    })
}

/// A model in the text of another program, with what was fitted, dropped or turned into something else.
///
/// # Errors
/// `format/not-written` if models are not written in this format.
pub fn model(format: &Format, model: &Model) -> Result<Read<Vec<u8>>, Error> {
    match format.id {
        #[cfg(feature = "opensim")]
        Id::OpenSim => Ok(condyle_formats::opensim::write(model).map(String::into_bytes)),
        #[cfg(feature = "robots")]
        Id::Urdf => Ok(condyle_formats::urdf::write(model).map(String::into_bytes)),
        #[cfg(feature = "robots")]
        Id::Mjcf => Ok(condyle_formats::mjcf::write(model).map(String::into_bytes)),
        _ => {
            let _ = model;
            Err(not_written(format, ContentKind::Model))
        }
    }
}

/// A learned limit as a document.
///
/// # Errors
/// `format/not-written` if limits are not written in this format.
#[cfg(feature = "document")]
pub fn limit(format: &Format, limit: &LearnedLimit) -> Result<Vec<u8>, Error> {
    match format.id {
        Id::Document => Ok(condyle_formats::document::limit::write(limit).into_bytes()),
        _ => Err(not_written(format, ContentKind::Limit)),
    }
}

/// A motion as a skeleton of plain bones that moves, with so many metres in a unit. Limits are applied here.
///
/// # Errors
/// `format/not-written` if skeletons are not written in this format; what the writer finds wrong.
pub fn skeleton(
    format: &Format,
    model: &Model,
    motion: &Motion,
    mode: Mode,
    metres_per_unit: f64,
) -> Result<Read<Vec<u8>>, Error> {
    match format.id {
        Id::Bvh => Ok(bvh::write(model, motion, mode, metres_per_unit)?.map(String::into_bytes)),
        // Its unit is stated: the metre.
        #[cfg(feature = "usd")]
        Id::Usda => Ok(condyle_formats::usd::write(model, motion, mode)?.map(String::into_bytes)),
        _ => Err(not_written(format, ContentKind::Scene)),
    }
}

/// A model turned so that it looks along z, as programs that read skeletons expect of one; one that is said to stand along z
/// is left as it is. Skeleton files say nothing of it, so that what comes from one should go back as it is.
pub fn ahead(model: &Model) -> Model {
    model.looking(Facing::PlusZ)
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
    recording_with_remarks(format, recording, name, &[])
}

/// As [`recording`]; remarks, such as what was done to it, are put into its header.
///
/// # Errors
/// As [`recording`].
pub fn recording_with_remarks(
    format: &Format,
    recording: &Recording,
    name: &str,
    remarks: &[String],
) -> Result<Vec<u8>, Error> {
    match format.id {
        Id::Trc => trc::write_with_remarks(recording, name, remarks).map(String::into_bytes),
        Id::Csv => {
            let mut markers = recording.to_table();
            markers.header.extend(remarks.iter().map(|remark| ("upkeep".into(), remark.clone())));
            table(format, &markers)
        }
        Id::C3d => {
            let mut trial = c3d::Trial::of(recording.clone());
            if !remarks.is_empty() {
                trial.parameters.set_texts("PROCESSING", "UPKEEP", remarks);
            }
            c3d::write(&trial)
        }
        _ => Err(not_written(format, ContentKind::Recording)),
    }
}

/// A trial: all of it as C3D; its markers and other points in other formats, where lengths are millimetres or, in
/// a CSV, metres, and all other numbers as they are.
///
/// # Errors
/// As [`recording`].
pub fn trial(format: &Format, trial: &c3d::Trial, name: &str) -> Result<Vec<u8>, Error> {
    match format.id {
        Id::C3d => c3d::write(trial),
        Id::Csv => table(format, &trial.to_table()),
        _ => recording(format, &trial.all_points(), name),
    }
}

fn not_written(format: &Format, kind: ContentKind) -> Error {
    let message = format!("{} is not written as .{}", kind.name(), format.name);
    Diagnostic::error("format/not-written", message)
        .with_help(format!("known are {}", Format::endings_that_write(kind)))
        .into()
}
