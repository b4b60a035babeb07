//! A joint in place of another: three rotations in an order, and a centre that functions of coordinates move.

use super::{Coupler, add_couplers, model_in};
use crate::opensim::model::frame::{Frames, is_default};
use crate::opensim::model::is_joint;
use crate::opensim::write::function::{numbers, several};
use crate::xml::edit::{Edits, escaped};
use crate::xml::{Element, XmlDocument};
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings};
use condyle_math::function::FunctionOfSeveral;
use condyle_math::{Affine, EulerOrder, Vec3};
use std::collections::HashSet;
use std::fmt::Write as _;

/// The first version whose joints state their ends as frames.
const FRAMES_IN_JOINTS: u32 = 30505;

/// A joint that is put in place of the one that moves a body.
#[derive(Clone, Debug, PartialEq)]
pub struct JointInPlace {
    /// The body that it moves.
    pub child: String,
    /// Its frame in the parent body.
    pub in_parent: Affine,
    /// Its frame in the child.
    pub in_child: Affine,
    /// The rotations, in their order.
    pub turns: [TurnOf; 3],
    /// The translations, along directions that do not lie in a plane.
    pub slides: [SlideOf; 3],
    /// Coordinates of the joint that the old one may not have.
    pub coordinates: Vec<NewCoordinate>,
    /// Coordinates that follow others, where a joint cannot say it itself.
    pub couplers: Vec<Coupler>,
}

/// A rotation about an axis of the joint's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct TurnOf {
    /// The axis, of length 1.
    pub axis: Vec3,
    /// The coordinates that it is a function of.
    pub drivers: Vec<String>,
    /// The angle from them.
    pub angle: FunctionOfSeveral,
}

/// A translation along a direction of the joint's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct SlideOf {
    /// The direction, of length 1.
    pub along: Vec3,
    /// The coordinates of the joint that it is a function of; none where it is constant.
    pub drivers: Vec<String>,
    /// The distance from them (metres).
    pub distance: FunctionOfSeveral,
}

/// A coordinate of the new joint. One of the old joint of that name is kept as it is written.
#[derive(Clone, Debug, PartialEq)]
pub struct NewCoordinate {
    /// Its name.
    pub name: String,
    /// Its value at rest, in radians or metres.
    pub default: f64,
    /// What its range is.
    pub range: [f64; 2],
}

/// The model file with the joint that moves a body replaced. Its name and its frames stay, and coordinates of the old joint that the new
/// one has, too; others are gone, with a warning.
///
/// # Errors
/// Where the text is no model, has no such body or no joint that moves it.
pub fn with_joint(text: &str, new: &JointInPlace) -> Result<Read<String>, Error> {
    let mut warnings = Warnings::default();
    let document = XmlDocument::parse(text)?.value;
    let model = model_in(&document)?;
    let version = model.parent().and_then(|root| root.attribute("Version"));
    let version: u32 = version.and_then(|v| v.trim().parse().ok()).unwrap_or(u32::MAX);
    let found =
        model.descendants().filter(|e| is_joint(e.name()) && !is_default(*e)).find_map(|joint| {
            let [parent, child] = ends(joint)?;
            (child == new.child).then_some((joint, parent))
        });
    let Some((joint, parent)) = found else {
        let message = format!("no joint moves the body `{}`", new.child);
        return Err(Error::new("osim/no-joint", message)
            .with_help("name a body that a joint moves in its parent, not the other way round"));
    };
    let mut edits = Edits::new(text);
    let old: Vec<Element<'_>> = joint.descendants().filter(|e| e.is("Coordinate")).collect();
    let named = |name: &str| old.iter().copied().find(|e| e.attribute("name") == Some(name));
    let mut coordinates = String::new();
    for NewCoordinate { name, default, range } in &new.coordinates {
        match named(name) {
            Some(element) => coordinates.push_str(edits.written(element)),
            None => {
                let _ = write!(
                    coordinates,
                    "<Coordinate name=\"{}\"><default_value>{}</default_value><range>{}</range>\
                     <clamped>false</clamped><locked>false</locked></Coordinate>",
                    escaped(name),
                    numbers([*default]),
                    numbers(*range)
                );
            }
        }
        coordinates.push('\n');
    }
    for gone in old.iter().filter_map(|e| e.attribute("name")) {
        if !new.coordinates.iter().any(|c| c.name == gone) {
            let message = format!("the coordinate `{gone}` of {} is gone", joint.describe());
            let help = "what refers to it, such as an actuator, has to go too";
            warnings.push(Diagnostic::warning("osim/coordinate-gone", message).with_help(help));
        }
    }
    let name = joint.attribute("name").unwrap_or("joint");
    let spatial = spatial(new);
    let xml = if version < FRAMES_IN_JOINTS {
        let place = |frame: Affine| numbers(frame.translation.to_array());
        let turn = |frame: Affine| numbers(EulerOrder::XYZ.from_mat3(frame.linear));
        format!(
            "<CustomJoint name=\"{}\"><parent_body>{}</parent_body>\
             <location_in_parent>{}</location_in_parent><orientation_in_parent>{}</orientation_in_parent>\
             <location>{}</location><orientation>{}</orientation>\
             <CoordinateSet><objects>\n{coordinates}</objects></CoordinateSet><reverse>false</reverse>\n{spatial}</CustomJoint>",
            escaped(name),
            escaped(&parent),
            place(new.in_parent),
            turn(new.in_parent),
            place(new.in_child),
            turn(new.in_child),
        )
    } else {
        let kept: String = joint
            .child("frames")
            .into_iter()
            .flat_map(|list| list.children().map(|e| edits.written(e).to_owned() + "\n"))
            .collect();
        let taken: HashSet<&str> =
            joint.descendants().filter_map(|e| e.attribute("name")).collect();
        let frame = |body: &str, at: Affine| {
            let mut name = format!("{body}_law");
            while taken.contains(name.as_str()) {
                name.push('_');
            }
            let path = match body {
                "ground" => "/ground".to_owned(),
                body => format!("/bodyset/{}", escaped(body)),
            };
            let xml = format!(
                "<PhysicalOffsetFrame name=\"{0}\"><socket_parent>{path}</socket_parent><translation>{1}</translation>\
                 <orientation>{2}</orientation></PhysicalOffsetFrame>\n",
                escaped(&name),
                numbers(at.translation.to_array()),
                numbers(EulerOrder::XYZ.from_mat3(at.linear)),
            );
            (escaped(&name), xml)
        };
        let (parent_name, parent_xml) = frame(&parent, new.in_parent);
        let (child_name, child_xml) = frame(&new.child, new.in_child);
        format!(
            "<CustomJoint name=\"{}\"><socket_parent_frame>{parent_name}</socket_parent_frame>\
             <socket_child_frame>{child_name}</socket_child_frame>\n<coordinates>\n{coordinates}</coordinates>\n\
             <frames>\n{kept}{parent_xml}{child_xml}</frames>\n{spatial}</CustomJoint>",
            escaped(name)
        )
    };
    edits.replace(joint, &xml);
    let made: Vec<&str> = new.coordinates.iter().map(|c| c.name.as_str()).collect();
    add_couplers(&mut edits, model, &new.couplers, &made)?;
    Ok(Read { value: edits.finish(), warnings: warnings.finish() })
}

/// The names of the bodies that a joint connects.
fn ends(joint: Element<'_>) -> Option<[String; 2]> {
    let body = |names: &[&str]| {
        let reference = Frames::reference(joint, names).ok()?;
        Some(carrier(joint, reference.text()))
    };
    let parent = body(&["parent_frame", "parent_body"])?;
    let holder = joint.parent().filter(|holder| holder.is("Joint")).and_then(|h| h.parent());
    let child = match holder.filter(|body| body.is("Body")) {
        Some(holder) => holder.attribute("name")?.to_owned(),
        None => body(&["child_frame", "child_body"])?,
    };
    Some([parent, child])
}

/// The body that a frame of a joint is fixed in: frames of the joint by its own list, else the last name of the path.
fn carrier(joint: Element<'_>, reference: &str) -> String {
    let last = |text: &str| text.rsplit('/').next().unwrap_or(text).to_owned();
    let mut name = last(reference);
    for _ in 0..8 {
        let own = joint
            .child("frames")
            .into_iter()
            .flat_map(|list| list.children())
            .find(|e| e.attribute("name") == Some(name.as_str()));
        let Some(parent) = own.and_then(|e| Frames::socket(e, "parent")) else { break };
        name = last(parent.text());
    }
    name
}

fn spatial(new: &JointInPlace) -> String {
    let mut out = "<SpatialTransform>\n".to_owned();
    let turns = new.turns.iter().map(|turn| (turn.axis, &turn.drivers, &turn.angle));
    let slides = new.slides.iter().map(|slide| (slide.along, &slide.drivers, &slide.distance));
    let words = ["rotation", "translation"];
    for (number, (axis, drivers, function)) in turns.chain(slides).enumerate() {
        let drivers: Vec<String> = drivers.iter().map(|name| escaped(name)).collect();
        let function = match (drivers.is_empty(), function) {
            (true, FunctionOfSeveral::Linear { intercept, .. }) => {
                format!("<Constant><value>{}</value></Constant>", numbers([*intercept]))
            }
            _ => several(function),
        };
        let _ = writeln!(
            out,
            "<TransformAxis name=\"{}{}\"><coordinates>{}</coordinates><axis>{}</axis><function>{function}</function></TransformAxis>",
            words[number / 3],
            number % 3 + 1,
            drivers.join(" "),
            numbers(axis.to_array()),
        );
    }
    out.push_str("</SpatialTransform>\n");
    out
}
