//! Markers: put where they were recorded, added from a set of their own, taken away.

use super::{element_of, written};
use crate::opensim::model::frame::{Frames, POINT_FRAME, is_default};
use crate::opensim::model::{Base, triple};
use crate::xml::edit::{Edits, escaped};
use crate::xml::{Element, XmlDocument, text_of};
use condyle_diagnostics::{Error, Read};
use condyle_math::Vec3;
use condyle_model::ModelBuilder;

/// The first version whose markers name their frame by a socket.
const SOCKETS: u32 = 30505;

/// Where a marker is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkerPlace {
    /// Its name.
    pub name: String,
    /// Its place in the body that carries it (metres), not in a frame that is fixed in that body.
    pub in_body: [f64; 3],
}

/// The markers of a model.
fn markers(model: Element<'_>) -> impl Iterator<Item = Element<'_>> {
    model.descendants().filter(|e| e.is("Marker") && !is_default(*e))
}

/// The names of markers that are fixed: those that stay where they are when others are placed.
///
/// # Errors
/// Where the text is no model.
pub fn fixed_markers(text: &str) -> Result<Vec<String>, Error> {
    let document = XmlDocument::parse(text)?.value;
    let mut names = vec![];
    for marker in markers(element_of(&document)?) {
        if marker.child_bool("fixed")?.unwrap_or(false) {
            names.extend(marker.attribute("name").map(str::to_owned));
        }
    }
    Ok(names)
}

/// A model file with some of its markers elsewhere in their bodies.
///
/// # Errors
/// Where the text is no model.
pub fn with_markers_at(text: &str, places: &[MarkerPlace]) -> Result<String, Error> {
    let document = XmlDocument::parse(text)?.value;
    let model = element_of(&document)?;
    let frames = Frames::collect(model, &mut ModelBuilder::new(""))?;
    let mut edits = Edits::new(text);
    for marker in markers(model) {
        let name = marker.attribute("name").unwrap_or_default();
        let Some(place) = places.iter().find(|place| place.name == name) else { continue };
        let (_, frame) = frames.of_part(marker, POINT_FRAME)?;
        let local = written(&(frame.rigid_inverse() * Vec3::from(place.in_body)).to_array());
        match marker.child("location") {
            Some(location) => edits.set_text(location, &local),
            None => edits.append(marker, &format!("<location>{local}</location>")),
        }
    }
    Ok(edits.finish())
}

/// A model file without the markers of these names.
///
/// # Errors
/// Where the text is no model.
pub fn without_markers(text: &str, names: &[String]) -> Result<String, Error> {
    let document = XmlDocument::parse(text)?.value;
    let model = element_of(&document)?;
    let mut edits = Edits::new(text);
    for marker in markers(model) {
        if marker.attribute("name").is_some_and(|name| names.iter().any(|n| n == name)) {
            edits.replace(marker, "");
        }
    }
    Ok(edits.finish())
}

/// A model file with the markers of a set of its own: those that it has under the same name are replaced,
/// the others added, as OpenSim does.
///
/// # Errors
/// Where a text is not XML, or a marker of the set stands in a body that the model does not have;
/// `scale/marker-set` where the other file holds no markers.
pub fn with_marker_set(text: &str, set: &[u8]) -> Result<Read<String>, Error> {
    let Read { value: other, mut warnings } = text_of(set)?;
    let other = XmlDocument::parse(other.strip_prefix('\u{feff}').unwrap_or(&other))?;
    warnings.extend(other.warnings);
    let other = other.value.root();
    let added: Vec<Element<'_>> = markers(other).collect();
    if added.is_empty() {
        return Err(other
            .error("scale/marker-set", "the file holds no <Marker>")
            .with_help("give a set of markers for this model"));
    }
    let document = XmlDocument::parse(text)?.value;
    let model = element_of(&document)?;
    let frames = Frames::collect(model, &mut ModelBuilder::new(""))?;
    let version = model.parent().and_then(|root| root.attribute("Version"));
    let version: u32 = version.and_then(|v| v.trim().parse().ok()).unwrap_or(u32::MAX);
    let mut edits = Edits::new(text);
    let mut xml = String::new();
    for marker in added {
        let name = marker.require_attribute("name")?;
        if let Some(own) = markers(model).find(|e| e.attribute("name") == Some(name)) {
            edits.replace(own, "");
        }
        let reference = Frames::reference(marker, POINT_FRAME)?;
        let body = reference.text().rsplit('/').next().unwrap_or_default();
        let Some(base) = base_named(&frames, body) else {
            let message = format!("marker `{name}` is fixed in `{body}`, which is no body");
            return Err(reference.error("osim/unknown-frame", message));
        };
        let location = written(&triple(marker, "location")?.to_array());
        let fixed = marker.child_bool("fixed")?.unwrap_or(false);
        let frame = match (version < SOCKETS, base) {
            (true, _) => format!("<body>{}</body>", escaped(body)),
            (false, None) => "<socket_parent_frame>/ground</socket_parent_frame>".to_owned(),
            (false, Some(_)) => {
                let path = format!("/bodyset/{}", escaped(body));
                format!("<socket_parent_frame>{path}</socket_parent_frame>")
            }
        };
        xml.push_str(&format!(
            "<Marker name=\"{}\">{frame}<location>{location}</location><fixed>{fixed}</fixed></Marker>\n",
            escaped(name)
        ));
    }
    let set = model.children().find(|e| e.is("MarkerSet"));
    match set.map(|set| (set, set.child("objects"))) {
        Some((_, Some(objects))) => edits.append(objects, &xml),
        Some((set, None)) => edits.append(set, &format!("<objects>\n{xml}</objects>")),
        None => {
            let set = "<MarkerSet name=\"markerset\"><objects>\n";
            edits.append(model, &format!("{set}{xml}</objects></MarkerSet>\n"));
        }
    }
    Ok(Read { value: edits.finish(), warnings })
}

fn base_named(frames: &Frames<'_>, name: &str) -> Option<Base> {
    if name == "ground" {
        return Some(None);
    }
    let found = frames.bodies().find(|(body, _)| body.attribute("name") == Some(name));
    found.map(|(_, base)| base)
}
