//! Constraints: couplers become dependencies of coordinates, the rest closures.

use super::function::{self, AnyFunction};
use super::{Base, Reader, is_constraint, triple};
use crate::opensim::model::frame::Frames;
use crate::xml::Element;
use condyle_diagnostics::{Error, nearest};
use condyle_math::function::FunctionOfSeveral;
use condyle_math::{Affine, EulerOrder, Vec3};
use condyle_model::model::{Closure, Condition};
use condyle_model::{CoordinateId, Signal};
use std::collections::HashMap;

/// Reads all constraints.
pub(super) fn read_all(reader: &mut Reader<'_, '_>) -> Result<(), Error> {
    // For every coordinate that follows others, those others.
    let mut leaders: HashMap<CoordinateId, Vec<CoordinateId>> = HashMap::new();
    let mut unknown = vec![];
    for element in reader.parts(is_constraint) {
        reader.uses(element);
        let off = element.child_bool("isDisabled")?.unwrap_or(false)
            || !element.child_bool("isEnforced")?.unwrap_or(true);
        if off {
            continue;
        }
        let name = element.attribute("name").filter(|n| !n.is_empty());
        let name = name.unwrap_or(element.name()).to_owned();
        let condition = match element.name() {
            "CoordinateCouplerConstraint" => {
                coupler(reader, element, &mut leaders)?;
                continue;
            }
            "PointConstraint" => Condition::Points { at: points(reader, element)? },
            "ConstantDistanceConstraint" => Condition::Distance {
                at: points(reader, element)?,
                distance: element.child_f64("constant_distance")?.unwrap_or(1.0),
            },
            "WeldConstraint" => {
                let [a, b] = [frame(reader, element, 1)?, frame(reader, element, 2)?];
                Condition::Frames { at: [a, b] }
            }
            _ => {
                unknown.push(element);
                continue;
            }
        };
        reader.builder.closure(Closure { name, condition });
    }
    let help = "such constraints are not known, so tracking will not enforce them";
    reader.say_of_each_class(&unknown, "osim/unknown-constraint", "ignored", help);
    Ok(())
}

fn body(
    reader: &Reader<'_, '_>,
    element: Element<'_>,
    number: usize,
) -> Result<(Base, Affine), Error> {
    let names = [format!("body_{number}"), format!("frame{number}"), format!("frame_{number}")];
    let reference = names.iter().find_map(|name| {
        let plain = element.child(name).filter(|e| !e.text().is_empty());
        Frames::socket(element, name).or(plain)
    });
    match reference {
        Some(reference) => reader.frames.resolve(element, reference),
        None => Err(element
            .error(
                "osim/no-frame",
                format!("{} does not name its body {number}", element.describe()),
            )
            .with_help(format!("add <socket_body_{number}> with the path of a body"))),
    }
}

fn points(reader: &Reader<'_, '_>, element: Element<'_>) -> Result<[(Base, Vec3); 2], Error> {
    let point = |number: usize| -> Result<(Base, Vec3), Error> {
        let (base, frame) = body(reader, element, number)?;
        Ok((base, frame * triple(element, &format!("location_body_{number}"))?))
    };
    Ok([point(1)?, point(2)?])
}

fn frame(
    reader: &Reader<'_, '_>,
    element: Element<'_>,
    number: usize,
) -> Result<(Base, Affine), Error> {
    let (base, outer) = body(reader, element, number)?;
    // Before version 4 the frame in the body was part of the constraint.
    let angles = triple(element, &format!("orientation_body_{number}"))?.to_array();
    let origin = triple(element, &format!("location_body_{number}"))?;
    Ok((base, outer * Affine::new(EulerOrder::XYZ.to_mat3(angles), origin)))
}

fn coordinate(
    reader: &Reader<'_, '_>,
    element: Element<'_>,
    at: Element<'_>,
    name: &str,
) -> Result<CoordinateId, Error> {
    let name = name.rsplit('/').next().unwrap_or(name);
    let coordinates = reader.builder.coordinates();
    let index = coordinates.iter().position(|c| c.name == name);
    match index.and_then(|index| reader.builder.coordinate_at(index)) {
        Some(id) => Ok(id),
        None => {
            let near = nearest(name, coordinates.iter().map(|c| c.name.as_str()));
            let error = at.error(
                "osim/unknown-coordinate",
                format!("{} names no coordinate of the model: `{name}`", element.describe()),
            );
            Err(match near {
                Some(near) => error.with_help(format!("did you mean `{near}`?")),
                None => error.with_help("name a coordinate of one of the joints"),
            })
        }
    }
}

/// `dependent = scale · f(independents)`: the dependent coordinate follows, unless that would be
/// cyclic; a cyclic coupler is kept as a closure.
fn coupler(
    reader: &mut Reader<'_, '_>,
    element: Element<'_>,
    leaders: &mut HashMap<CoordinateId, Vec<CoordinateId>>,
) -> Result<(), Error> {
    let dependent_at = element.require("dependent_coordinate_name")?;
    let dependent = coordinate(reader, element, dependent_at, dependent_at.text())?;
    let independents_at = element.require("independent_coordinate_names")?;
    let mut independents = vec![];
    let separates = |c: char| c.is_whitespace() || matches!(c, ',' | ';');
    for name in independents_at.text().split(separates).filter(|name| !name.is_empty()) {
        independents.push(coordinate(reader, element, independents_at, name)?);
    }
    let scale = element.child_f64("scale_factor")?.unwrap_or(1.0);
    let holder = element.require("coupled_coordinates_function")?;
    let function = function::inside(holder)?.ok_or_else(|| {
        holder
            .error("osim/no-function", format!("{} has no function", element.describe()))
            .with_help("put a function such as <LinearFunction> inside")
    })?;
    if leaders.contains_key(&dependent) {
        reader.warn(
            "osim/coupled-twice",
            element,
            format!("coordinate `{}` is the dependent of two couplers", dependent_at.text()),
            "the first one is used",
        );
        return Ok(());
    }
    let circular = leads_to(leaders, &independents, dependent);
    let arity = match &function {
        AnyFunction::One(_) => 1,
        AnyFunction::Several(f) => f.arity(),
    };
    if arity != independents.len() {
        return Err(independents_at
            .error(
                "osim/arity",
                format!(
                    "{} names {} independent coordinates but its function takes {arity}",
                    element.describe(),
                    independents.len()
                ),
            )
            .with_help("list as many coordinates as the function has arguments"));
    }
    let name = element.attribute("name").filter(|n| !n.is_empty()).unwrap_or("coupler").to_owned();
    match function {
        AnyFunction::One(mut function) => {
            function.factor *= scale;
            let driver = independents[0];
            if circular {
                reader.warn(
                    "osim/cyclic-coupler",
                    element,
                    format!("{} closes a circle of couplers", element.describe()),
                    "it is kept as a constraint, which tracking enforces",
                );
                let condition = Condition::Coupling { follower: dependent, driver, function };
                reader.builder.closure(Closure { name, condition });
                return Ok(());
            }
            let set = reader.builder.coordinates()[dependent.index()].joint_set;
            let leader = reader.builder.map(set, &name, driver, function);
            reader.builder.follow(dependent, leader);
        }
        AnyFunction::Several(function) => {
            if circular {
                return Err(element
                    .error(
                        "osim/cyclic-coupler",
                        format!("{} closes a circle of couplers", element.describe()),
                    )
                    .with_help("remove one coupler of the circle"));
            }
            let set = reader.builder.coordinates()[dependent.index()].joint_set;
            let sources = independents.iter().map(|&id| Signal::Coordinate(id)).collect();
            let mut leader = reader.builder.combine(set, &name, sources, function);
            if scale != 1.0 {
                let scaled = FunctionOfSeveral::Linear { slopes: vec![scale], intercept: 0.0 };
                let name = format!("{name}_scaled");
                leader = reader.builder.combine(set, &name, vec![leader], scaled);
            }
            reader.builder.follow(dependent, leader);
        }
    }
    leaders.insert(dependent, independents);
    Ok(())
}

/// Whether any of `from` follows `goal`, directly or through others, or is it.
fn leads_to(
    leaders: &HashMap<CoordinateId, Vec<CoordinateId>>,
    from: &[CoordinateId],
    goal: CoordinateId,
) -> bool {
    let mut open = from.to_vec();
    let mut seen = std::collections::HashSet::new();
    while let Some(id) = open.pop() {
        if id == goal {
            return true;
        }
        if seen.insert(id) {
            open.extend(leaders.get(&id).into_iter().flatten());
        }
    }
    false
}
