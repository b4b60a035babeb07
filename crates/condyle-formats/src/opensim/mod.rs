//! OpenSim's XML files.

pub mod coupled;
pub mod geometry;
pub mod model;
pub mod scale;
pub mod scale_setup;
pub mod setup;
mod write;

use crate::Include;
use crate::xml::XmlDocument;
use condyle_diagnostics::{Error, Read};
use condyle_model::Model;
pub use write::{write, written};

/// What a file of OpenSim holds.
#[derive(Clone, Debug)]
pub enum Holding {
    /// A model.
    Model(Model),
    /// A setup of inverse kinematics.
    Setup(setup::IkSetup),
    /// The tasks of one.
    Tasks(setup::IkTaskSet),
}

/// Reads a file of OpenSim, whose kind is determined by its elements: a model, a setup of inverse
/// kinematics, or the tasks of one. Sets of a model that are files of their own are asked of `include`.
///
/// # Errors
/// What is wrong, with its place; `osim/unknown` if it is none of these.
pub fn read(bytes: &[u8], include: &mut Include<'_>) -> Result<Read<Holding>, Error> {
    let document = XmlDocument::from_bytes(bytes)?;
    let root = document.value.root();
    if model::of(root).is_some() {
        return Ok(model::from_document(document, include)?.map(Holding::Model));
    }
    if setup::tool_of(root).is_some() {
        return Ok(setup::from_document(document)?.map(Holding::Setup));
    }
    if setup::tasks_of(root).is_some() {
        return Ok(setup::tasks_from_document(document)?.map(Holding::Tasks));
    }
    if let Some(tool) = scale_setup::tool_of(root) {
        return Err(tool
            .error(
                "osim/scale-setup",
                "this is a setup of scaling, no model and no setup of tracking",
            )
            .with_help("give it to `condyle scale --setup`"));
    }
    let message = "the file holds no <Model>, no <InverseKinematicsTool> and no <IKTaskSet>";
    let found = root.children().next().unwrap_or(root);
    Err(found
        .error("osim/unknown", message)
        .with_help("give a model, or a setup of OpenSim's inverse kinematics"))
}
