//! Components: their laws from kind and parameters.

use super::value::At;
use crate::Error;
use crate::exchange::AXES;
use condyle_learn::limits::dependent::{
    self, Dependence, DependenceKnown, DependenceSettings, Drivers,
};
use condyle_learn::limits::field::made;
use condyle_math::{EulerOrder, Quat, Vec3};
use condyle_model::component::{
    Along, AngleNames, Angles, Ball, Centre, Combine, Compensate, ConstantCurvature, Contact,
    ContactPair, Correlate, Curve, Depend, Ellipse, Ellipsoid, FieldLimit, Gliding, HalfSpace,
    Heading, JointCone, Map, Parameters, Pivot, Place, Product, Reflection, Region, Registry,
    RelativeOrientation, RelativePosition, Rotate, Scale, Shear, SurfaceAxis, Swinging, Translate,
};
use condyle_model::limit::field::{
    About, Chart, Ends, Ground, Known, LearnedLimit, Settings, Shape, ShapeError, snapped,
};
use condyle_model::limit::{Cone, ConePoint, Projection};
use condyle_model::{CoordinateKind, Law};
use std::sync::Arc;

/// The law of a component.
pub(super) fn law(at: &At<'_>, laws: &Registry) -> Result<Law, Error> {
    let (kind, p, inputs) = (at.key("kind")?, at.key("parameters")?, at.key("inputs")?);
    let sides = ["lower", "upper"].map(|side| p.perhaps(side).map(|f| f.function()).transpose());
    Ok(match kind.text()? {
        "map" => {
            let functions = p.key("functions")?.list()?;
            Law::Map(Map {
                functions: functions.iter().map(At::function).collect::<Result<_, _>>()?,
            })
        }
        "combine" => Law::Combine(Combine { function: p.key("function")?.function_of_several()? }),
        "correlate" => Law::Correlate(Correlate {
            function: p.key("function")?.function_of_several()?,
            region: p.perhaps("region").map(|region| region_of(&region)).transpose()?,
        }),
        "depend" => {
            let [lower, upper] = sides;
            Law::Depend(Depend { lower: lower?, upper: upper? })
        }
        "relative_orientation" => {
            let reference = inputs.perhaps("reference").is_some();
            Law::RelativeOrientation(RelativeOrientation { reference })
        }
        "relative_position" => Law::RelativePosition(RelativePosition {
            reference: inputs.perhaps("reference").is_some(),
            point: p.key("point")?.vector()?,
            along: p.key("along")?.vectors()?,
        }),
        "angles" => angles(&p)?,
        "cone" => cone(&p)?,
        "ellipse" => {
            let [centre, half_axes] = [p.key("centre")?.some()?, p.key("half_axes")?.some()?];
            let ellipse = Ellipse::new(centre, half_axes, p.key("tilt")?.number()?);
            Law::Ellipse(ellipse.map_err(|error| p.error(error, "correct it"))?)
        }
        "half_space" => {
            let half = HalfSpace::new(p.key("normal")?.numbers()?, p.key("bound")?.number()?);
            Law::HalfSpace(half.map_err(|error| p.error(error, "correct it"))?)
        }
        "field" => field(&p)?,
        "contact" => contact(&p, &inputs)?,
        "rotate" => Law::Rotate(Rotate { axis: p.key("axis")?.vector()? }),
        "translate" => Law::Translate(Translate { axis: p.key("axis")?.vector()? }),
        "pivot" => pivot(&p)?,
        "ball" => Law::Ball(Ball),
        "product" => Law::Product(Product),
        "place" => Law::Place(Place { child_in_parent: p.key("child_in_parent")?.frame()? }),
        "ellipsoid" => {
            let words = [("opensim", SurfaceAxis::OpenSim), ("normal", SurfaceAxis::Normal)];
            let axis = p.key("surface_axis")?.word(&words)?;
            Law::Ellipsoid(Ellipsoid { radii: p.key("radii")?.vector()?, axis })
        }
        "constant_curvature" => Law::ConstantCurvature(ConstantCurvature {
            neutral: p.key("neutral")?.some()?,
            length: p.key("length")?.number()?,
        }),
        "compensate" => Law::Compensate(Compensate { weight: p.key("weight")?.number()? }),
        "scale" => {
            let axis = || p.key("axis")?.vector();
            let along = match p.key("along")?.text()? {
                "everywhere" => Along::Everywhere,
                "axis" => Along::Axis(axis()?),
                "volume" => Along::Volume(axis()?),
                other => return Err(p.unknown(other, ["everywhere", "axis", "volume"].into_iter())),
            };
            Law::Scale(Scale { along })
        }
        "shear" => Law::Shear(Shear {
            along: p.key("along")?.vector()?,
            across: p.key("across")?.vector()?,
        }),
        "curve" => {
            let heading = match p.perhaps("heading") {
                None => None,
                Some(h) => Some(Heading {
                    forward: h.key("forward")?.vector()?,
                    up: h.key("up")?.vector()?,
                }),
            };
            Law::Curve(Curve { path: p.key("path")?.path()?, heading })
        }
        "custom" => {
            let given = p.key("parameters")?;
            let mut parameters = Parameters::new();
            for key in given.keys() {
                parameters.insert(key.to_owned(), given.key(key)?.numbers()?);
            }
            let law = laws.make(p.key("law")?.text()?, parameters);
            Law::Custom(law.map_err(|why| p.error(why, "register it, or leave it out"))?)
        }
        other => return Err(kind.unknown(other, Law::KINDS.iter().map(|kind| kind.name))),
    })
}

/// The number of an axis.
fn axis(at: &At<'_>) -> Result<usize, Error> {
    at.word(&[(AXES[0], 0), (AXES[1], 1), (AXES[2], 2)])
}

fn angles(p: &At<'_>) -> Result<Law, Error> {
    let kind = p.key("angles")?;
    let names = match kind.text()? {
        "euler" => {
            let order = p.key("order")?;
            let orders = EulerOrder::ALL.map(|order| order.to_string());
            let words: Vec<_> = orders.iter().map(String::as_str).zip(EulerOrder::ALL).collect();
            AngleNames::Euler(order.word(&words)?)
        }
        "swing_twist" => AngleNames::SwingTwist(axis(&p.key("axis")?)?),
        other => return Err(kind.unknown(other, ["euler", "swing_twist"].into_iter())),
    };
    let mirrored = match p.perhaps("mirrored") {
        Some(at) => Reflection::new(axis(&at)?),
        None => None,
    };
    Ok(Law::Angles(Angles { names, mirrored }))
}

fn cone(p: &At<'_>) -> Result<Law, Error> {
    let (kind, axes) = (p.key("of")?, p.key("axes")?);
    let wrong = |count: &str| axes.error(format!("there are not {count} axes"), "give them");
    let of = match kind.text()? {
        "angles" => {
            Swinging::Angles(axes.vectors()?.try_into().map_err(|_: Vec<Vec3>| wrong("three"))?)
        }
        "directions" => {
            Swinging::Directions(axes.vectors()?.try_into().map_err(|_: Vec<Vec3>| wrong("two"))?)
        }
        "orientation" => Swinging::Orientation,
        other => {
            return Err(kind.unknown(other, ["angles", "directions", "orientation"].into_iter()));
        }
    };
    let mut points = vec![];
    for point in p.key("points")?.list()? {
        let twist = point.perhaps("twist").map(|twist| twist.some()).transpose()?;
        points.push(ConePoint { direction: point.key("direction")?.vector()?, twist });
    }
    let words = [("nearest", Projection::Nearest), ("toward_rest", Projection::TowardRest)];
    let cone = Cone::new(
        p.key("rest")?.vector()?,
        p.perhaps("twist_at_rest").map(|twist| twist.some()).transpose()?,
        points,
        p.key("subdivisions")?.count()?,
        p.key("projection")?.word(&words)?,
    );
    let cone = cone.map_err(|error| p.error(error, "correct it"))?;
    Ok(Law::Cone(JointCone { of, cone }))
}

/// Three turns whose ends depend on those before.
fn shape(p: &At<'_>) -> Result<Shape, Error> {
    let wrong = |at: &At<'_>, error: ShapeError| at.error(error.message, error.help);
    let ends = |key: &str| -> Result<Ends, Error> {
        let at = p.key(key)?;
        let [first, second, lower, upper] =
            ["first", "second", "lower", "upper"].map(|key| at.key(key)?.numbers());
        Ends::new(first?, second?, lower?, upper?).map_err(|error| wrong(&at, error))
    };
    let axes = p.key("axes")?;
    let Ok(three) = <[Vec3; 3]>::try_from(axes.vectors()?) else {
        return Err(axes.error("these are not three directions", "give the axes of three turns"));
    };
    let (first, beyond) = (p.key("first")?.some()?, p.key("beyond")?.number()?);
    let shape = Shape::new(three, first, ends("second")?, ends("third")?, beyond);
    shape.map_err(|error| wrong(p, error))
}

fn field(p: &At<'_>) -> Result<Law, Error> {
    let quaternion = |at: &At<'_>| -> Result<Quat, Error> {
        let q = Quat::from(at.some::<4>()?);
        match (q.dot(q).sqrt() - 1.0).abs() < 1e-6 {
            true => Ok(q),
            false => Err(at.error("this is no unit quaternion", "give x, y, z, w of length 1")),
        }
    };
    let text = |key: &str| p.key(key)?.text().map(str::to_owned);
    let texts = |key: &str| -> Result<Vec<String>, Error> {
        p.key(key)?.list()?.iter().map(|name| name.text().map(str::to_owned)).collect()
    };
    let about = About {
        name: text("name")?,
        child: text("child")?,
        reference: p.perhaps("reference").map(|at| at.text().map(str::to_owned)).transpose()?,
        source: text("source")?,
        population: text("population")?,
        frames: text("frames")?,
        takes: texts("names")?,
    };
    let rotations = p.key("rotations")?;
    let samples = rotations
        .list()?
        .iter()
        .map(|q| Ok(snapped(quaternion(q)?)))
        .collect::<Result<Vec<_>, Error>>()?;
    let given = p.key("takes")?;
    let takes = given.list()?.iter().map(At::count).collect::<Result<Vec<_>, _>>()?;
    let sum: usize = takes.iter().map(|count| *count as usize).sum();
    let shape = p.perhaps("shape").map(|at| shape(&at)).transpose()?;
    if shape.is_none() && samples.is_empty() || sum != samples.len() {
        let message = format!("{sum} rotations of takes, but {} are there", samples.len());
        return Err(given.error(message, "give the number of rotations of each take, at least one"));
    }
    let nodes = p.key("nodes")?;
    let radii = p.key("radii")?;
    let settings = Settings {
        nodes: nodes.count()? as usize,
        radius: radii.some()?,
        gap: p.perhaps("layer").map(|at| at.number()).transpose()?,
        hole: p.perhaps("hole").map(|at| at.some()).transpose()?,
    };
    let [least, most] = settings.radius;
    if !(24..=256).contains(&settings.nodes) {
        return Err(nodes.error("there are not 24 to 256 nodes", "give as many"));
    }
    if !(least > 0.0 && least <= most && most < std::f64::consts::PI) {
        return Err(radii.error("they do not rise between 0 and half a turn", "correct them"));
    }
    let known = match p.perhaps("known") {
        None => None,
        Some(at) => {
            let [spacing, radius, gap] =
                ["spacing", "radius", "gap"].map(|key| at.key(key)?.number());
            let (spacing, radius, gap) = (spacing?, radius?, gap?);
            if !(spacing > 0.0 && radius > 0.0 && gap >= 0.0 && radius < std::f64::consts::PI) {
                return Err(
                    at.error("these are no angles between 0 and half a turn", "correct them")
                );
            }
            Some(Known { spacing, radius, gap })
        }
    };
    let [left, right] = p.key("axes")?.two()?;
    let chart = Chart::of_sides([quaternion(&left)?, quaternion(&right)?]);
    let thinned = p.key("thinned")?.number()?;
    let shape = shape.map(Arc::new);
    let ground = Ground { samples, takes, thinned, chart, settings, known, shape };
    let mirrored = match p.perhaps("mirrored") {
        Some(at) => Reflection::new(axis(&at)?),
        None => None,
    };
    let count = ground.samples.len();
    let limit = LearnedLimit::new(about, Arc::new(ground), None, made);
    let limit = match p.perhaps("given") {
        Some(at) => limit.depending_on(depending(&at, count)?, dependent::made),
        None => limit,
    };
    let axes = |key: &str| p.perhaps(key).map_or(Ok(Quat::IDENTITY), |at| quaternion(&at));
    Ok(Law::Field(FieldLimit {
        limit: Arc::new(limit),
        driver_in_reference: axes("driver_in_reference")?,
        driver_in_segment: axes("driver_in_segment")?,
        in_reference: quaternion(&p.key("in_reference")?)?,
        in_segment: quaternion(&p.key("in_segment")?)?,
        mirrored,
        strict: p.key("strict")?.flag()?,
    }))
}

/// What a limit with so many samples depends on.
fn depending(p: &At<'_>, samples: usize) -> Result<Dependence, Error> {
    let drivers = match (p.perhaps("values"), p.perhaps("rotations")) {
        (Some(at), None) => {
            let values = at.list()?.iter().map(At::number).collect::<Result<Vec<_>, Error>>()?;
            Drivers::Scalars(values)
        }
        (None, Some(at)) => {
            let one = |q: &At<'_>| Ok(snapped(Quat::from(q.some::<4>()?)));
            Drivers::Rotations(at.list()?.iter().map(one).collect::<Result<Vec<_>, Error>>()?)
        }
        _ => return Err(p.error("it has no driver", "give one of `values` and `rotations`")),
    };
    if drivers.len() != samples {
        let message = format!("{} values of the driver for {samples} samples", drivers.len());
        return Err(p.error(message, "give the driver at each sample"));
    }
    let nodes = p.key("nodes")?;
    let settings = DependenceSettings {
        slope: p.key("slope")?.number()?,
        step: p.key("step")?.number()?,
        nodes: nodes.count()? as usize,
        few: p.key("few")?.count()?,
        gap: p.perhaps("layer").map(|at| at.number()).transpose()?,
    };
    if !((24..=128).contains(&settings.nodes) && settings.slope >= 0.0 && settings.step > 0.0) {
        return Err(nodes
            .error("there are not 24 to 128 nodes, or slope or step are below 0", "correct them"));
    }
    let known = match p.perhaps("known") {
        None => None,
        Some(at) => {
            let (radius, gap) = (at.key("radius")?.number()?, at.key("gap")?.number()?);
            let turn = std::f64::consts::PI;
            if !(radius > 0.0 && radius < turn && (0.0..turn).contains(&gap)) {
                return Err(
                    at.error("these are no angles between 0 and half a turn", "correct them")
                );
            }
            Some(DependenceKnown { radius, gap })
        }
    };
    let reference = p.perhaps("reference").map(|at| at.text().map(str::to_owned)).transpose()?;
    let name = p.key("name")?.text()?.to_owned();
    let kind = match p.perhaps("unit") {
        None => drivers.usual_kind(),
        Some(at) => match (at.text()?, &drivers) {
            ("rad", Drivers::Scalars(_)) => CoordinateKind::Rotation,
            ("m", Drivers::Scalars(_)) => CoordinateKind::Translation,
            ("1", Drivers::Scalars(_)) => CoordinateKind::Other,
            _ => {
                let help = "give rad, m or 1 of a coordinate, none of a rotation";
                return Err(at.error("this is no unit of a driver", help));
            }
        },
    };
    Ok(Dependence { name, reference, kind, drivers, settings, known })
}

fn contact(p: &At<'_>, inputs: &At<'_>) -> Result<Law, Error> {
    let mut pairs = vec![];
    for pair in p.key("pairs")?.list()? {
        pairs.push(ContactPair {
            first: pair.key("first")?.vector()?,
            second: pair.key("second")?.vector()?,
            at: pair.key("at")?.some()?,
        });
    }
    let place = p.key("ellipsoid_in_surface")?.frame()?;
    let law = Gliding::new(place, p.key("radii")?.vector()?, p.key("axis")?.vector()?, pairs);
    Ok(Law::Contact(Contact {
        before: inputs.perhaps("before").is_some(),
        most_gap: p.perhaps("most_gap").map(|gap| gap.number()).transpose()?,
        law: law.map_err(|error| p.error(error, "correct it"))?,
    }))
}

fn pivot(p: &At<'_>) -> Result<Law, Error> {
    let given = p.key("centre")?;
    let kind = given.key("kind")?;
    let centre = match kind.text()? {
        "intervals" => {
            let mut intervals = vec![];
            for one in given.key("intervals")?.list()? {
                let to = one.perhaps("to").map_or(Ok(f64::INFINITY), |to| to.number())?;
                intervals.push((to, one.key("at")?.vector()?));
            }
            Centre::Intervals(intervals)
        }
        "path" => Centre::Path(given.key("path")?.path()?),
        other => return Err(kind.unknown(other, ["intervals", "path"].into_iter())),
    };
    let pivot = Pivot::new(p.key("axis")?.vector()?, centre);
    Ok(Law::Pivot(pivot.map_err(|error| p.error(error, "correct it"))?))
}

/// Whether it fits the function is checked when the model is built.
fn region_of(p: &At<'_>) -> Result<Region, Error> {
    Ok(Region {
        low: p.key("low")?.numbers()?,
        high: p.key("high")?.numbers()?,
        centre: p.key("centre")?.numbers()?,
        inverse: p.key("inverse")?.numbers()?,
        distance: p.key("distance")?.number()?,
    })
}
