//! Meshes and skins of a model's file.

use super::Geometry;
#[cfg(any(feature = "surfaces", feature = "glb"))]
use crate::open;
use crate::open::OpenError;
use condyle_diagnostics::Read;
use condyle_model::Model;
use std::path::{Path, PathBuf};

/// Opens what the file of a model names: the meshes of an `.osim`, the skins of glTF. There is nothing in other files,
/// and in shipped models.
///
/// Meshes are looked for as OpenSim does: beside the model, in the folder `Geometry` beside it, then in
/// `folders`. A name that leads upwards or begins at the root counts by its last part alone.
///
/// # Warnings
/// `geometry/missing`, a note with the meshes that are nowhere; `geometry/unreadable` for one that is no mesh;
/// `geometry/ground` for those that belong to no segment; `geometry/size`. None of these is drawn.
///
/// # Errors
/// A file that cannot be read any more.
pub fn open(path: &Path, model: &Model, folders: &[PathBuf]) -> Result<Read<Geometry>, OpenError> {
    #[cfg(feature = "surfaces")]
    if !open::is_standard_input(path) && open::ending(path) == "osim" {
        return meshes::of(path, model, folders);
    }
    #[cfg(feature = "glb")]
    if open::is_gltf(path) && !open::is_standard_input(path) {
        return skins(path, model);
    }
    let _ = (path, model, folders);
    Ok(Read::clean(Geometry::default()))
}

#[cfg(feature = "glb")]
fn skins(path: &Path, model: &Model) -> Result<Read<Geometry>, OpenError> {
    use super::{Hold, Skin};
    use condyle_formats::glb;
    let read = open::surfaces(path)?;
    let segments: Vec<_> = model.segment_ids().collect();
    let hold = |carrier: glb::Carrier| Hold {
        segment: carrier.segment.and_then(|at| segments.get(at).copied()),
        bind: carrier.bind,
    };
    // Light as a screen takes it (IEC 61966-2-1).
    let shown = |x: f64| {
        let x = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
        (255.0 * x).round() as u8
    };
    let skins = read.value.into_iter().map(|cover| Skin {
        name: cover.name,
        mesh: cover.mesh,
        holds: cover.carriers.into_iter().map(hold).collect(),
        carriers: cover.joints,
        weights: cover.weights,
        colour: cover.colour.map(|light| light.map(shown)),
    });
    let geometry = Geometry { meshes: vec![], skins: skins.collect() };
    Ok(Read { value: geometry, warnings: read.warnings })
}

#[cfg(feature = "surfaces")]
mod meshes {
    use super::super::Placed;
    use super::{Geometry, Model, OpenError, Path, PathBuf, Read, open};
    use crate::open::Cause;
    use condyle_diagnostics::{Diagnostic, Error, listed};
    use condyle_formats::opensim::geometry::{self, Attached};
    use condyle_formats::surface;
    use condyle_math::Affine;
    use condyle_mesh::Mesh;
    use std::collections::HashMap;

    /// The most corners of all meshes of a model.
    const MOST_CORNERS: usize = 10_000_000;

    pub(super) fn of(
        path: &Path,
        model: &Model,
        folders: &[PathBuf],
    ) -> Result<Read<Geometry>, OpenError> {
        let fail = |cause| OpenError { path: path.to_owned(), cause };
        let bytes = open::bytes(path)?;
        let named = geometry::read(&bytes, &mut |name| open::included(path, name));
        let content = |error: Error| fail(Cause::Content { error, text: None });
        let Read { value: named, mut warnings } = named.map_err(content)?;
        let (mut found, mut missing) = (HashMap::<&str, Option<Mesh>>::new(), vec![]);
        let (mut geometry, mut grounded, mut corners) = (Geometry::default(), 0usize, 0usize);
        for Attached { segment, file, place } in &named {
            let segment = segment.as_ref().and_then(|name| model.find_segment(name).ok());
            let Some(segment) = segment else {
                grounded += 1;
                continue;
            };
            let mesh = found.entry(file.as_str()).or_insert_with(|| {
                let Some(at) = looked_for(path, file, folders) else {
                    missing.push(file.clone());
                    return None;
                };
                let read = open::bytes(&at).map_err(|error| error.to_string());
                let read = read.and_then(|b| surface::from_bytes(&b).map_err(|e| e.to_string()));
                match read {
                    Ok(Read { value, warnings: told }) => {
                        warnings.extend(told.into_iter().map(|mut said| {
                            said.message = format!("{file}: {}", said.message);
                            said
                        }));
                        Some(value)
                    }
                    Err(why) => {
                        let message = format!("{file} is not drawn: {why}");
                        warnings.push(Diagnostic::warning("geometry/unreadable", message));
                        None
                    }
                }
            });
            let Some(mesh) = mesh else { continue };
            corners += mesh.positions.len();
            if corners > MOST_CORNERS {
                let message = format!("{file} and what follows is not drawn: it is too much");
                let help = format!("at most {MOST_CORNERS} corners are drawn of a model");
                warnings.push(Diagnostic::warning("geometry/size", message).with_help(help));
                break;
            }
            let mesh = placed(mesh, *place);
            geometry.meshes.push(Placed { name: file.clone(), segment, mesh });
        }
        if !missing.is_empty() {
            let message = format!(
                "{} of {} mesh files are not there: {}",
                missing.len(),
                found.len(),
                listed(&missing)
            );
            let help = "they are looked for beside the model, in `Geometry` there, and in folders that are given; \
                        bones are drawn by joints instead";
            warnings.push(Diagnostic::note("geometry/missing", message).with_help(help));
        }
        if grounded > 0 {
            let message = format!("{grounded} meshes are fixed to the ground and not drawn");
            warnings.push(Diagnostic::note("geometry/ground", message));
        }
        Ok(Read { value: geometry, warnings })
    }

    /// The file of a mesh, if it is there.
    fn looked_for(model: &Path, file: &str, folders: &[PathBuf]) -> Option<PathBuf> {
        let file = inside(file)?;
        let beside = model.parent().unwrap_or(Path::new(""));
        let own = [beside.to_owned(), beside.join("Geometry")];
        let mut places = own.iter().chain(folders).map(|folder| folder.join(&file));
        places.find(|place| place.is_file())
    }

    /// A name that leads to nowhere outside a folder; models come with paths of their authors' machines.
    fn inside(file: &str) -> Option<PathBuf> {
        let file = file.trim().replace('\\', "/");
        let parts: Vec<&str> = file.split('/').filter(|part| !matches!(*part, "" | ".")).collect();
        let last = *parts.last()?;
        let strange = |part: &&str| *part == ".." || part.contains(':') || part.contains('\0');
        if strange(&last) {
            return None;
        }
        match file.starts_with('/') || parts.iter().any(strange) {
            true => Some(PathBuf::from(last)),
            false => Some(parts.iter().collect()),
        }
    }

    fn placed(mesh: &Mesh, at: Affine) -> Mesh {
        let positions = mesh.positions.iter().map(|p| at * *p).collect();
        let mut triangles = mesh.triangles.clone();
        if at.linear.determinant() < 0.0 {
            // In the mirror triangles are seen from behind.
            triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        Mesh::of(positions, triangles)
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn a_name_stays_in_its_folder() {
            for (name, expected) in [
                ("femur.vtp", Some("femur.vtp")),
                ("bones/femur.vtp", Some("bones/femur.vtp")),
                ("..\\..\\bones\\femur.vtp", Some("femur.vtp")),
                ("/etc/passwd", Some("passwd")),
                ("C:\\OpenSim\\Geometry\\femur.vtp", Some("femur.vtp")),
                ("bones/../../x.stl", Some("x.stl")),
                ("..", None),
                ("", None),
                ("C:", None),
            ] {
                assert_eq!(inside(name).as_deref(), expected.map(Path::new), "{name}");
            }
        }
    }
}
