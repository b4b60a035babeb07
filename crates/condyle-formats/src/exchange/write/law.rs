//! The parameters of components.

use super::{frame, function, function_of_several, spline, vector};
use crate::exchange::AXES;
use condyle_math::Vec3;
use condyle_math::function::SimmSpline;
use condyle_model::component::{
    Along, AngleNames, Angles, Ball, Centre, Combine, Compensate, ConstantCurvature, Contact,
    ContactPair, Correlate, Curve, Depend, Ellipsoid, FieldLimit, Gliding, Heading, JointCone, Map,
    Place, Product, Region, RelativeOrientation, RelativePosition, Rotate, Scale, Shear,
    SurfaceAxis, Swinging, Translate,
};
use condyle_model::limit::field::dependent::{
    Dependence, DependenceKnown, DependenceSettings, Drivers,
};
use condyle_model::limit::field::{About, Ends, Ground, Known, Settings, Shape};
use condyle_model::limit::{ConePoint, Projection};
use condyle_model::{CoordinateKind, Law};
use serde_json::{Value, json};

/// The parameters of a component, beside what is at its ports.
pub(super) fn parameters(law: &Law) -> Value {
    match law {
        Law::Map(Map { functions }) => {
            json!({ "functions": functions.iter().map(function).collect::<Value>() })
        }
        Law::Combine(Combine { function }) => json!({ "function": function_of_several(function) }),
        Law::Correlate(Correlate { function, region }) => {
            let region = region.as_ref().map(|region| {
                let Region { low, high, centre, inverse, distance } = region;
                json!({
                    "low": low,
                    "high": high,
                    "centre": centre,
                    "inverse": inverse,
                    "distance": distance,
                })
            });
            json!({ "function": function_of_several(function), "region": region })
        }
        Law::Depend(Depend { lower, upper }) => {
            json!({ "lower": lower.as_ref().map(function), "upper": upper.as_ref().map(function) })
        }
        Law::RelativeOrientation(RelativeOrientation { reference: _ }) => json!({}),
        Law::RelativePosition(RelativePosition { reference: _, point, along }) => {
            json!({ "point": vector(*point), "along": vectors(along) })
        }
        Law::Angles(Angles { names, mirrored }) => {
            let mirrored = mirrored.map(|at| AXES[at.axis() % 3]);
            match names {
                AngleNames::Euler(order) => json!({
                    "angles": "euler",
                    "order": order.to_string(),
                    "mirrored": mirrored,
                }),
                AngleNames::SwingTwist(axis) => json!({
                    "angles": "swing_twist",
                    "axis": AXES[axis % 3],
                    "mirrored": mirrored,
                }),
            }
        }
        Law::Cone(law) => cone(law),
        Law::Ellipse(ellipse) => json!({
            "centre": ellipse.centre(),
            "half_axes": ellipse.half_axes(),
            "tilt": ellipse.tilt(),
        }),
        Law::HalfSpace(half) => json!({ "normal": half.normal(), "bound": half.bound() }),
        Law::Field(law) => field(law),
        Law::Contact(law) => contact(law),
        Law::Rotate(Rotate { axis }) | Law::Translate(Translate { axis }) => {
            json!({ "axis": vector(*axis) })
        }
        Law::Pivot(pivot) => {
            let centre = match pivot.centre() {
                Centre::Intervals(list) => {
                    let one = |(to, at): &(f64, Vec3)| json!({ "to": to.is_finite().then_some(to), "at": vector(*at) });
                    json!({ "kind": "intervals", "intervals": list.iter().map(one).collect::<Value>() })
                }
                Centre::Path(splines) => json!({ "kind": "path", "path": path(splines) }),
            };
            json!({ "axis": vector(pivot.axis()), "centre": centre })
        }
        Law::Ball(Ball) | Law::Product(Product) => json!({}),
        Law::Place(Place { child_in_parent }) => {
            json!({ "child_in_parent": frame(*child_in_parent) })
        }
        Law::Ellipsoid(Ellipsoid { radii, axis }) => {
            let axis = match axis {
                SurfaceAxis::OpenSim => "opensim",
                SurfaceAxis::Normal => "normal",
            };
            json!({ "radii": vector(*radii), "surface_axis": axis })
        }
        Law::ConstantCurvature(ConstantCurvature { neutral, length }) => {
            json!({ "neutral": neutral, "length": length })
        }
        Law::Compensate(Compensate { weight }) => json!({ "weight": weight }),
        Law::Scale(Scale { along }) => match along {
            Along::Everywhere => json!({ "along": "everywhere" }),
            Along::Axis(axis) => json!({ "along": "axis", "axis": vector(*axis) }),
            Along::Volume(axis) => json!({ "along": "volume", "axis": vector(*axis) }),
        },
        Law::Shear(Shear { along, across }) => {
            json!({ "along": vector(*along), "across": vector(*across) })
        }
        Law::Curve(Curve { path: splines, heading }) => {
            let heading = heading.map(
                |Heading { forward, up }| json!({ "forward": vector(forward), "up": vector(up) }),
            );
            json!({ "path": path(splines), "heading": heading })
        }
        Law::Custom(custom) => json!({ "law": custom.law, "parameters": custom.parameters }),
    }
}

fn vectors(list: &[Vec3]) -> Value {
    list.iter().map(|v| vector(*v)).collect()
}

fn path(splines: &[SimmSpline; 3]) -> Value {
    splines.iter().map(spline).collect()
}

fn cone(JointCone { of, cone }: &JointCone) -> Value {
    let (of, axes) = match of {
        Swinging::Angles(axes) => ("angles", vectors(axes)),
        Swinging::Directions(axes) => ("directions", vectors(axes)),
        Swinging::Orientation => ("orientation", json!([])),
    };
    let point = |ConePoint { direction, twist }: &ConePoint| json!({ "direction": vector(*direction), "twist": twist });
    json!({
        "of": of,
        "axes": axes,
        "rest": vector(cone.rest()),
        "twist_at_rest": cone.twist_at_rest(),
        "points": cone.points().iter().map(point).collect::<Value>(),
        "subdivisions": cone.subdivisions(),
        "projection": match cone.projection() {
            Projection::Nearest => "nearest",
            Projection::TowardRest => "toward_rest",
        },
    })
}

/// A learned limit: axes, and all that it was learned from.
/// What a limit depends on.
fn given(dependence: &Dependence) -> Value {
    let Dependence { name, reference, kind, drivers, settings, known } = dependence;
    let DependenceSettings { slope, step, nodes, few, gap } = settings;
    let (values, rotations) = match drivers {
        Drivers::Scalars(values) => (Some(json!(values)), None),
        Drivers::Rotations(all) => {
            (None, Some(all.iter().map(|q| json!(q.to_array())).collect::<Value>()))
        }
    };
    let known =
        known.map(|DependenceKnown { radius, gap }| json!({ "radius": radius, "gap": gap }));
    json!({
        "name": name,
        "reference": reference,
        "unit": match kind {
            CoordinateKind::Translation => Some("m"),
            CoordinateKind::Scale | CoordinateKind::Other => Some("1"),
            CoordinateKind::Rotation | CoordinateKind::Orientation => None,
        },
        "values": values,
        "rotations": rotations,
        "slope": slope,
        "step": step,
        "nodes": nodes,
        "few": few,
        "layer": gap,
        "known": known,
    })
}

fn field(law: &FieldLimit) -> Value {
    let FieldLimit {
        limit,
        in_reference,
        in_segment,
        driver_in_reference,
        driver_in_segment,
        mirrored,
        strict,
    } = law;
    let About { name, child, reference, source, population, frames, takes: names } = limit.about();
    let Ground { samples, takes, thinned, chart, settings, known, shape } = &**limit.ground();
    let Settings { nodes, radius, gap, hole } = settings;
    let known = known.map(
        |Known { spacing, radius, gap }| json!({ "spacing": spacing, "radius": radius, "gap": gap }),
    );
    let rotations: Value = samples.iter().map(|q| json!(q.to_array())).collect();
    let mut written = json!({
        "in_reference": in_reference.to_array(),
        "in_segment": in_segment.to_array(),
        "mirrored": mirrored.map(|at| AXES[at.axis() % 3]),
        "strict": strict,
        "name": name,
        "child": child,
        "reference": reference,
        "source": source,
        "population": population,
        "frames": frames,
        "names": names,
        "takes": takes,
        "thinned": thinned,
        "axes": chart.sides().map(|q| q.to_array()),
        "nodes": nodes,
        "radii": radius,
        "layer": gap,
        "hole": hole,
        "known": known,
        "rotations": rotations,
    });
    if let Some(keys) = written.as_object_mut() {
        if let Some(shape) = shape {
            keys.insert("shape".to_owned(), shape_of(shape));
        }
        // Limits that depend on nothing are written as they were before there were others.
        if let Some(dependence) = limit.dependence() {
            keys.insert("given".to_owned(), given(dependence));
            keys.insert("driver_in_reference".to_owned(), json!(driver_in_reference.to_array()));
            keys.insert("driver_in_segment".to_owned(), json!(driver_in_segment.to_array()));
        }
    }
    written
}

/// Three turns whose ends depend on those before.
fn shape_of(shape: &Shape) -> Value {
    let ends = |ends: &Ends| {
        json!({
            "first": ends.first(),
            "second": ends.second(),
            "lower": ends.lower(),
            "upper": ends.upper(),
        })
    };
    json!({
        "axes": vectors(&shape.axes()),
        "first": shape.first(),
        "second": ends(shape.second()),
        "third": ends(shape.third()),
        "beyond": shape.beyond(),
    })
}

fn contact(Contact { before: _, most_gap, law }: &Contact) -> Value {
    let law: &Gliding = law;
    let pair = |ContactPair { first, second, at }: &ContactPair| json!({ "first": vector(*first), "second": vector(*second), "at": at });
    json!({
        "ellipsoid_in_surface": frame(law.ellipsoid_in_surface()),
        "radii": vector(law.radii()),
        "axis": vector(law.axis()),
        "pairs": law.pairs().iter().map(pair).collect::<Value>(),
        "most_gap": most_gap,
    })
}
