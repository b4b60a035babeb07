//! Numbers that look like degrees where radians are read, or like millimetres where metres are.
//!
//! A joint turns by less than a whole turn, and a body is smaller than 10 m: what is far beyond that,
//! and fits when it is read in the other unit, was most likely written in it.

use super::{Inspected, finding, length, rounded};
use condyle_diagnostics::{Diagnostic, Severity};
use condyle_math::Vec3;
use condyle_math::function::{Curve, Function};
use condyle_model::CoordinateKind;
use condyle_model::component::{Centre, Component, Law, Signal, Swinging};
use std::f64::consts::{PI, TAU};

/// A length beyond this, in metres, is none of a body's.
const LARGEST: f64 = 10.0;

/// An angle beyond this, in radians, is none of a joint's; a few decimals are rounded.
const WHOLE_TURN: f64 = TAU * 1.001;

/// The largest number of degrees that is taken for an angle.
const MOST_DEGREES: f64 = 720.0;

pub(super) fn check(subject: &Inspected<'_>, findings: &mut Vec<Diagnostic>) {
    for component in subject.model.components() {
        degrees(subject, component, findings);
        millimetres(subject, component, findings);
    }
}

/// Numbers of a component that are compared with one angle.
struct Angles {
    /// What they are, as part of a sentence.
    what: &'static str,
    numbers: Vec<f64>,
    /// The angle: a signal, or what the component's output is used as.
    of: Signal,
    /// What to write instead.
    help: &'static str,
}

fn degrees(subject: &Inspected<'_>, component: &Component, findings: &mut Vec<Diagnostic>) {
    let model = subject.model;
    let mut said: Vec<(String, &'static str)> = vec![];
    for Angles { what, numbers, of, help } in angles(subject, component) {
        if subject.kind_of(of) != CoordinateKind::Rotation {
            continue;
        }
        let most = numbers.iter().fold(0.0f64, |most, n| most.max(n.abs()));
        let range = subject.range_of(of).map(|(low, high)| low.abs().max(high.abs()));
        if !look_like_degrees(most, range) {
            continue;
        }
        let taken = match range {
            Some(range) => {
                format!(", but {} stays within {}°", name(subject, of), degrees_of(range))
            }
            None => String::new(),
        };
        said.push((format!("{what} go to {} radians{taken}", rounded(most, 3)), help));
    }
    let (Some((_, help)), kind) = (said.first(), component.law.kind().name) else { return };
    let what: Vec<&str> = said.iter().map(|(what, _)| what.as_str()).collect();
    findings.push(finding(
        Severity::Warning,
        "lint/degrees",
        [model.component_subject(component)],
        format!("{kind} `{}`: {}: these look like degrees", component.name, what.join("; ")),
        *help,
    ));
}

fn degrees_of(radians: f64) -> String {
    rounded(radians.to_degrees(), 1)
}

/// Whether numbers up to `most` are degrees rather than radians of an angle within `range`.
fn look_like_degrees(most: f64, range: Option<f64>) -> bool {
    match range.filter(|range| *range > 1e-3) {
        // As degrees they fit what the angle does.
        Some(range) => {
            let fit = most.to_radians() <= 2.5 * range;
            let ratio = most / range;
            fit && (ratio > 6.0 && most > WHOLE_TURN || ratio > 20.0 && most > PI * 1.01)
        }
        None => most > WHOLE_TURN && most <= MOST_DEGREES,
    }
}

fn name(subject: &Inspected<'_>, signal: Signal) -> String {
    match signal {
        Signal::Coordinate(id) => format!("`{}`", subject.key(id)),
        Signal::Output(id, _) => format!("`{}`", subject.model.components()[id.index()].name),
        Signal::Segment(_) => "it".to_owned(),
    }
}

/// Arguments and values of a function that are written as numbers; none of a polynomial.
fn knots(function: &Function) -> (Vec<f64>, Vec<f64>) {
    let (x, y): (Vec<f64>, Vec<f64>) = match &function.curve {
        Curve::PiecewiseLinear(lines) => lines.knots().unzip(),
        Curve::SimmSpline(spline) => spline.knots().unzip(),
        Curve::Constant(value) => (vec![], vec![*value]),
        Curve::Linear { intercept, .. } => (vec![], vec![*intercept]),
        Curve::Polynomial(_) => (vec![], vec![]),
    };
    (x, y.into_iter().map(|y| y * function.factor).collect())
}

/// The angles that are written as numbers in a component.
fn angles(subject: &Inspected<'_>, component: &Component) -> Vec<Angles> {
    const FUNCTION: &str = "write `in = \"deg\"` for arguments and `out = \"deg\"` for values in degrees, or \
                            radians";
    const UNIT: &str = "write `in = \"deg\"`, or radians";
    const DOCUMENT: &str = "write `angles = \"deg\"` at the top of the document, or radians";
    let input = |k: usize| component.inputs.get(k).copied();
    let mut list = vec![];
    let mut add = |what, numbers: Vec<f64>, of: Option<Signal>, help| {
        if let Some(of) = of.filter(|_| !numbers.is_empty()) {
            list.push(Angles { what, numbers, of, help });
        }
    };
    match &component.law {
        Law::Map(map) => {
            for (output, function) in map.functions.iter().enumerate() {
                let (x, y) = knots(function);
                add("its arguments", x, input(0), FUNCTION);
                add("its values", y, subject.output(component, output), FUNCTION);
            }
        }
        Law::Depend(depend) => {
            let (x, y): (Vec<_>, Vec<_>) =
                [&depend.lower, &depend.upper].into_iter().flatten().map(knots).unzip();
            add("its arguments", x.concat(), component.at("driver").first().copied(), FUNCTION);
            add("its bounds", y.concat(), component.at("passive").first().copied(), FUNCTION);
        }
        Law::Contact(contact) => {
            for (axis, &driver) in component.at("drivers").iter().enumerate().take(2) {
                let at = contact.law.pairs().iter().map(|pair| pair.at[axis]).collect();
                add("the driver's values at its pairs", at, Some(driver), UNIT);
            }
        }
        Law::Cone(cone) => {
            let points = cone.cone.points().iter().filter_map(|point| point.twist);
            let twists: Vec<f64> = points.chain(cone.cone.twist_at_rest()).flatten().collect();
            let of = match cone.of {
                Swinging::Angles(_) => input(2),
                Swinging::Directions(_) | Swinging::Orientation => input(0),
            };
            add("its bounds of twist", twists, of, DOCUMENT);
        }
        Law::Ellipse(ellipse) => {
            add("its lengths", [ellipse.centre(), ellipse.half_axes()].concat(), input(0), UNIT);
        }
        Law::HalfSpace(half_space) => {
            let size = half_space.normal().iter().fold(0.0f64, |a, b| a.max(b.abs())).max(1e-9);
            add("its bound", vec![half_space.bound() / size], input(0), UNIT);
        }
        Law::Pivot(pivot) => {
            let ends = match pivot.centre() {
                Centre::Intervals(list) => {
                    list.iter().map(|(to, _)| *to).filter(|to| to.is_finite()).collect()
                }
                Centre::Path(splines) => {
                    splines.iter().flat_map(|spline| spline.knots().map(|(x, _)| x)).collect()
                }
            };
            add("the ends of its intervals", ends, input(0), DOCUMENT);
        }
        _ => {}
    }
    list
}

/// The longest length that is written in a component, and what it is.
fn longest(law: &Law) -> Option<(&'static str, f64)> {
    let largest = |v: Vec3| v.to_array().into_iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let most = |points: &mut dyn Iterator<Item = Vec3>| points.map(largest).fold(0.0f64, f64::max);
    let lengths = match law {
        Law::Contact(contact) => {
            let law = &contact.law;
            let points = law.pairs().iter().flat_map(|pair| [pair.first, pair.second]);
            vec![
                ("a radius", largest(law.radii())),
                ("the centre of its ellipsoid", largest(law.ellipsoid_in_surface().translation)),
                ("a point of a pair", most(&mut points.into_iter())),
            ]
        }
        Law::Ellipsoid(ellipsoid) => vec![("a radius", largest(ellipsoid.radii))],
        Law::Pivot(pivot) => match pivot.centre() {
            Centre::Intervals(list) => {
                vec![("a centre", most(&mut list.iter().map(|(_, at)| *at)))]
            }
            Centre::Path(splines) => {
                let places = splines.iter().flat_map(|spline| spline.knots().map(|(_, y)| y.abs()));
                vec![("a centre", places.fold(0.0, f64::max))]
            }
        },
        Law::ConstantCurvature(arc) => vec![("the arc", arc.length.abs())],
        Law::Place(place) => vec![("the place", largest(place.child_in_parent.translation))],
        Law::Curve(curve) => {
            let places = curve.path.iter().flat_map(|spline| spline.knots().map(|(_, y)| y.abs()));
            vec![("a point of its path", places.fold(0.0, f64::max))]
        }
        _ => vec![],
    };
    lengths.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))
}

fn millimetres(subject: &Inspected<'_>, component: &Component, findings: &mut Vec<Diagnostic>) {
    let Some((what, most)) = longest(&component.law).filter(|(_, most)| *most > LARGEST) else {
        return;
    };
    let kind = component.law.kind().name;
    findings.push(finding(
        Severity::Warning,
        "lint/millimetres",
        [subject.model.component_subject(component)],
        format!("{kind} `{}`: {what} measures {}", component.name, length(most)),
        "lengths of a model are in metres: were these millimetres?",
    ));
}
