//! Joints as elements.

use super::coupling::{Coordinate, Coordinates, Drive, Holder};
use super::function::numbers;
use super::{Moved, offset};
use crate::plain::{Tree, Value, completed};
use condyle_math::Vec3;
use std::fmt::Write as _;

/// The joint of a body.
pub(super) fn moved(
    out: &mut String,
    moved: &Moved,
    number: usize,
    tree: &Tree,
    coordinates: &Coordinates,
) {
    let piece = &moved.piece;
    let (class, fixed) =
        if piece.is_fixed() { ("WeldJoint", true) } else { ("CustomJoint", false) };
    let name = &moved.joint;
    let (parent, child) = (format!("{name}_parent"), format!("{name}_child"));
    let _ = write!(
        out,
        "<{class} name=\"{name}\"><socket_parent_frame>{parent}</socket_parent_frame>\
         <socket_child_frame>{child}</socket_child_frame>"
    );
    if !fixed {
        out.push_str("<coordinates>");
        coordinates.of_joint(number).for_each(|c| coordinate(out, c));
        out.push_str("</coordinates>");
    }
    out.push_str("<frames>");
    offset(out, &parent, &moved.parent, &piece.before);
    offset(out, &child, &format!("/bodyset/{}", moved.body), &piece.after.rigid_inverse());
    out.push_str("</frames>");
    if !fixed {
        out.push_str("<SpatialTransform>");
        for (word, axes) in [("rotation", &piece.turns), ("translation", &piece.slides)] {
            let values: Vec<Option<Value>> = axes.iter().map(|&(_, value)| Some(value)).collect();
            for (i, direction) in completed(axes).into_iter().enumerate() {
                let drive = match values.get(i).copied().flatten() {
                    Some(value) => coordinates.drive(tree, number, value),
                    None => Drive::Constant(0.0),
                };
                axis(out, &format!("{word}{}", i + 1), direction, &drive);
            }
        }
        out.push_str("</SpatialTransform>");
    }
    let _ = writeln!(out, "</{class}>");
}

/// The joint of a body that holds numbers.
pub(super) fn holder(out: &mut String, holder: &Holder, coordinates: &Coordinates) {
    let name = &holder.name;
    let _ = write!(
        out,
        "<CustomJoint name=\"{name}_joint\"><socket_parent_frame>/ground</socket_parent_frame>\
         <socket_child_frame>/bodyset/{name}</socket_child_frame><coordinates>"
    );
    let all = holder.turn.iter().chain(&holder.slides);
    all.filter_map(|&at| coordinates.get(at)).for_each(|c| coordinate(out, c));
    out.push_str("</coordinates><SpatialTransform>");
    let turns = [holder.turn, None, None];
    let slides = [0, 1, 2].map(|i| holder.slides.get(i).copied());
    for (word, numbers) in [("rotation", turns), ("translation", slides)] {
        for (i, at) in numbers.into_iter().enumerate() {
            let drive = match at.and_then(|at| coordinates.get(at)) {
                Some(coordinate) => Drive::Plain(&coordinate.name),
                None => Drive::Constant(0.0),
            };
            axis(out, &format!("{word}{}", i + 1), Vec3::UNITS[i], &drive);
        }
    }
    out.push_str("</SpatialTransform></CustomJoint>\n");
}

fn coordinate(out: &mut String, coordinate: &Coordinate) {
    let range = coordinate.range;
    // A side without a bound is far outside, as OpenSim itself writes it.
    let lower = range.lower.map_or("-inf".to_owned(), |v| numbers([v]));
    let upper = range.upper.map_or("inf".to_owned(), |v| numbers([v]));
    let _ = write!(
        out,
        "<Coordinate name=\"{}\"><default_value>{}</default_value><range>{lower} {upper}</range>\
         <clamped>{}</clamped><locked>{}</locked></Coordinate>",
        coordinate.name,
        numbers([range.nearest(coordinate.default)]),
        range.enforced && (range.lower.is_some() || range.upper.is_some()),
        coordinate.locked,
    );
}

fn axis(out: &mut String, name: &str, direction: Vec3, drive: &Drive<'_>) {
    let (drivers, function) = match drive {
        Drive::Plain(name) => {
            (*name, "<LinearFunction><coefficients>1 0</coefficients></LinearFunction>".to_owned())
        }
        Drive::Function(name, function) => (*name, function.clone()),
        Drive::Constant(value) => {
            ("", format!("<Constant><value>{}</value></Constant>", numbers([*value])))
        }
    };
    let _ = write!(
        out,
        "<TransformAxis name=\"{name}\"><coordinates>{drivers}</coordinates><axis>{}</axis>{function}</TransformAxis>",
        numbers(direction.to_array())
    );
}
