//! The meshes that a model of OpenSim names, and where they are attached.
//!
//! | element | versions | where it stands |
//! | --- | --- | --- |
//! | `<Mesh>` in `<attached_geometry>` | since 3.3 | in the frame around it, or the one that `socket_frame` names; stretched by `scale_factors` |
//! | `<DisplayGeometry>` in a body's `<VisibleObject>` | before 4 | in the body, by the `transform`s of both (three angles, body-fixed xyz, and a place), stretched by the product of the `scale_factors` of both |
//! | names in `<geometry_files>` | before 2 | in the body, stretched by `scale_factors` |
//!
//! What is hidden (`<visible>false`, `<display_preference>0`) is left out, and so are the defaults of a file.

use super::model::frame::{Frames, is_default};
use super::model::{include, of};
use crate::Include;
use crate::xml::{Element, XmlDocument};
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings};
use condyle_math::{Affine, EulerOrder, Mat3, Vec3};
use condyle_model::ModelBuilder;

/// A mesh that a model names.
#[derive(Clone, Debug, PartialEq)]
pub struct Attached {
    /// The name of the body; `None` for the ground.
    pub segment: Option<String>,
    /// The file, as the model names it.
    pub file: String,
    /// From the file's corners to the body: its frame, and how it is stretched there.
    pub place: Affine,
}

/// Most meshes of a model.
const MOST: usize = 100_000;

/// The meshes that a model names, in the order of its file. Sets that are files of their own are asked of `include`.
///
/// # Warnings
/// `geometry/frame` for a mesh in a frame that is not there, which is left out.
///
/// # Errors
/// As [`model::read`](super::model::read), as far as frames are concerned; `xml/number` for factors that are no numbers.
///
/// ```
/// let text = r#"<OpenSimDocument Version="40000"><Model name="arm"><BodySet><objects>
///   <Body name="forearm"><attached_geometry><Mesh name="ulna"><socket_frame>..</socket_frame>
///     <scale_factors>1 2 1</scale_factors><mesh_file>ulna.vtp</mesh_file></Mesh></attached_geometry></Body>
///   </objects></BodySet></Model></OpenSimDocument>"#;
/// let mut none = |name: &str| Err(name.to_owned());
/// let meshes = condyle_formats::opensim::geometry::read(text.as_bytes(), &mut none)?.value;
/// assert_eq!((meshes[0].file.as_str(), meshes[0].place.linear.y.y), ("ulna.vtp", 2.0));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(bytes: &[u8], include: &mut Include<'_>) -> Result<Read<Vec<Attached>>, Error> {
    let document = include::put_in(XmlDocument::from_bytes(bytes)?, include)?;
    let root = document.value.root();
    let mut warnings = Warnings::default();
    let Some(model) = of(root) else { return Ok(Read::clean(vec![])) };
    let frames = Frames::collect(model, &mut ModelBuilder::new(""))?;
    let bodies: Vec<&str> =
        frames.bodies().map(|(body, _)| body.attribute("name").unwrap_or_default()).collect();
    let mut all: Vec<Attached> = vec![];
    for element in model.descendants().filter(|element| !is_default(*element)) {
        if all.len() > MOST {
            let message = format!("the model names more than {MOST} meshes");
            return Err(element.error("osim/size", message));
        }
        let mut found = match element.name() {
            "Mesh" => match attached(element, &frames, &bodies) {
                Ok(mesh) => mesh.into_iter().collect(),
                Err(error) => {
                    let told = error.into_diagnostics().into_iter().next();
                    let message = told.map_or_else(String::new, |told| told.message);
                    warnings.push(
                        Diagnostic::warning("geometry/frame", message)
                            .at(element.place())
                            .with_help("the mesh is not drawn"),
                    );
                    continue;
                }
            },
            "VisibleObject" => displayed(element)?,
            _ => continue,
        };
        found.retain(|mesh| {
            !mesh.file.is_empty() && mesh.place.to_rows().iter().all(|x| x.is_finite())
        });
        all.append(&mut found);
    }
    Ok(Read { value: all, warnings: warnings.finish() })
}

/// A mesh in a frame.
fn attached<'d>(
    mesh: Element<'d>,
    frames: &Frames<'d>,
    bodies: &[&str],
) -> Result<Option<Attached>, Error> {
    let file = mesh.child_text("mesh_file").unwrap_or_default().to_owned();
    let appearance = mesh.child("Appearance");
    if appearance.and_then(|look| look.child_bool("visible").ok().flatten()) == Some(false) {
        return Ok(None);
    }
    // Lists of properties are no parts of their own, so the frame around the list owns the mesh.
    let around = mesh.parent().filter(|e| e.is("attached_geometry")).and_then(|e| e.parent());
    let own = around.map(|frame| frames.at(frame)).transpose()?.flatten();
    let named = Frames::socket(mesh, "frame").filter(|frame| frame.text() != "..");
    let (base, place) = match (named, own) {
        (Some(frame), _) => frames.resolve(around.unwrap_or(mesh), frame)?,
        (None, Some(own)) => own,
        (None, None) => return Ok(None),
    };
    let segment = base.and_then(|id| bodies.get(id.index())).map(|name| (*name).to_owned());
    Ok(Some(Attached { segment, file, place: place * stretched(factors(mesh)?) }))
}

/// What a body shows, before version 4.
fn displayed(visible: Element<'_>) -> Result<Vec<Attached>, Error> {
    let Some(body) = visible.parent().filter(|e| e.is("Body")) else { return Ok(vec![]) };
    let segment = body.attribute("name").filter(|name| *name != "ground").map(str::to_owned);
    let (outer, factors_of_all) = (transform(visible)?, factors(visible)?);
    let mut all = vec![];
    for geometry in visible.descendants().filter(|e| e.is("DisplayGeometry")) {
        if geometry.child_text("display_preference") == Some("0") {
            continue;
        }
        let file = geometry.child_text("geometry_file").unwrap_or_default().to_owned();
        let place =
            outer * transform(geometry)? * stretched(factors(geometry)?.times(factors_of_all));
        all.push(Attached { segment: segment.clone(), file, place });
    }
    for file in visible.child_text("geometry_files").unwrap_or_default().split_whitespace() {
        let place = outer * stretched(factors_of_all);
        all.push(Attached { segment: segment.clone(), file: file.to_owned(), place });
    }
    Ok(all)
}

fn factors(element: Element<'_>) -> Result<Vec3, Error> {
    Ok(element.child_numbers::<3>("scale_factors")?.map_or(Vec3::new(1.0, 1.0, 1.0), Vec3::from))
}

fn stretched(factors: Vec3) -> Affine {
    let linear = Mat3::from_columns(Vec3::X * factors.x, Vec3::Y * factors.y, Vec3::Z * factors.z);
    Affine::new(linear, Vec3::ZERO)
}

fn transform(element: Element<'_>) -> Result<Affine, Error> {
    let Some([a, b, c, x, y, z]) = element.child_numbers::<6>("transform")? else {
        return Ok(Affine::IDENTITY);
    };
    Ok(Affine::new(EulerOrder::XYZ.to_mat3([a, b, c]), Vec3::new(x, y, z)))
}
