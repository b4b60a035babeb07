//! Laws put into a model file in its own text: muscles, shapes, masses and what is not understood stay letter for letter.
//!
//! [`with_couplers`] lets coordinates follow others by a `CoordinateCouplerConstraint` each; [`with_joint`] puts a joint in place of
//! another whose centre moves by functions of its own angles.

mod joint;

pub use joint::{JointInPlace, NewCoordinate, SlideOf, TurnOf, with_joint};

use super::model::frame::is_default;
use super::model::of;
use super::write::function::several;
use crate::xml::edit::{Edits, escaped};
use crate::xml::{Element, XmlDocument};
use condyle_diagnostics::{Error, did_you_mean};
use condyle_math::function::FunctionOfSeveral;

/// A coordinate that follows others.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupler {
    /// The coordinate that follows.
    pub dependent: String,
    /// Those in control, in the order of the function's arguments.
    pub drivers: Vec<String>,
    /// Its value from theirs, in radians and metres.
    pub function: FunctionOfSeveral,
}

/// The model file in which coordinates follow others. A coupler that the file has for such a coordinate is replaced, and the
/// coordinate is no longer locked.
///
/// ```
/// use condyle_formats::opensim::coupled::{Coupler, with_couplers};
/// use condyle_math::function::FunctionOfSeveral;
/// let text = r#"<OpenSimDocument Version="40000"><Model name="bolt"><JointSet><objects>
/// <CustomJoint name="j"><coordinates><Coordinate name="turn"/><Coordinate name="along"/></coordinates></CustomJoint>
/// </objects></JointSet><!-- mine --></Model></OpenSimDocument>"#;
/// let pitch = FunctionOfSeveral::Linear { slopes: vec![0.001], intercept: 0.02 };
/// let coupler = Coupler { dependent: "along".into(), drivers: vec!["turn".into()], function: pitch };
/// let coupled = with_couplers(text, &[coupler])?;
/// assert!(coupled.contains("<coefficients>0.001 0.02</coefficients>"));
/// assert!(coupled.contains("<independent_coordinate_names>turn</independent_coordinate_names>"));
/// assert!(coupled.contains("<!-- mine -->"));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
///
/// # Errors
/// Where the text is no model, or names a coordinate that the model does not have.
pub fn with_couplers(text: &str, couplers: &[Coupler]) -> Result<String, Error> {
    let document = XmlDocument::parse(text)?.value;
    let model = model_in(&document)?;
    let mut edits = Edits::new(text);
    add_couplers(&mut edits, model, couplers, &[])?;
    Ok(edits.finish())
}

fn model_in(document: &XmlDocument) -> Result<Element<'_>, Error> {
    let root = document.root();
    of(root).ok_or_else(|| {
        root.error("osim/no-model", format!("{} holds no <Model>", root.describe()))
            .with_help("give an OpenSim model")
    })
}

/// The bare name of a coordinate.
fn bare(key: &str) -> &str {
    key.rsplit('/').next().unwrap_or(key)
}

fn coordinates(model: Element<'_>) -> impl Iterator<Item = Element<'_>> {
    model.descendants().filter(|e| e.is("Coordinate") && !is_default(*e))
}

/// Adds couplers; `made` are coordinates that are added in the same turn.
fn add_couplers(
    edits: &mut Edits<'_>,
    model: Element<'_>,
    couplers: &[Coupler],
    made: &[&str],
) -> Result<(), Error> {
    let names: Vec<&str> = coordinates(model)
        .filter_map(|coordinate| coordinate.attribute("name"))
        .chain(made.iter().copied())
        .collect();
    for key in couplers.iter().flat_map(|c| c.drivers.iter().chain([&c.dependent])) {
        if !names.contains(&bare(key)) {
            let all = || "name a coordinate of one of its joints".to_owned();
            let help = did_you_mean(bare(key), names.iter().copied(), all);
            let message = format!("the model has no coordinate `{key}`");
            return Err(Error::new("osim/unknown-coordinate", message).with_help(help));
        }
    }
    let follows = |name: &str| couplers.iter().any(|c| bare(&c.dependent) == bare(name));
    for old in model.descendants().filter(|e| e.is("CoordinateCouplerConstraint")) {
        if !is_default(old) && old.child_text("dependent_coordinate_name").is_some_and(follows) {
            edits.replace(old, "");
        }
    }
    for coordinate in coordinates(model) {
        if coordinate.attribute("name").is_some_and(follows)
            && coordinate.child_bool("locked")?.unwrap_or(false)
            && let Some(locked) = coordinate.child("locked")
        {
            edits.set_text(locked, "false");
        }
    }
    let mut xml = String::new();
    for Coupler { dependent, drivers, function } in couplers {
        let dependent = escaped(bare(dependent));
        let drivers: Vec<String> = drivers.iter().map(|key| escaped(bare(key))).collect();
        // That it is enforced is the default of every version; the element that says so is not the same in all.
        xml.push_str(&format!(
            "\n<CoordinateCouplerConstraint name=\"{dependent}_law\">\
             <coupled_coordinates_function>{}</coupled_coordinates_function>\
             <independent_coordinate_names>{}</independent_coordinate_names>\
             <dependent_coordinate_name>{dependent}</dependent_coordinate_name>\
             <scale_factor>1</scale_factor></CoordinateCouplerConstraint>",
            several(function),
            drivers.join(" ")
        ));
    }
    if xml.is_empty() {
        return Ok(());
    }
    let set = model.children().find(|e| e.is("ConstraintSet"));
    match set.map(|set| (set, set.child("objects"))) {
        Some((_, Some(objects))) => edits.append(objects, &format!("{xml}\n")),
        Some((set, None)) => edits.append(set, &format!("<objects>{xml}\n</objects>")),
        None => edits.append(
            model,
            &format!(
                "<ConstraintSet name=\"constraintset\"><objects>{xml}\n</objects></ConstraintSet>\n"
            ),
        ),
    }
    Ok(())
}

#[cfg(test)]
mod tests;
