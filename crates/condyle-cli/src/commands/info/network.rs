//! The components of joint sets: what each reads and makes, and what limits what.

use condyle::model::component::{Component, Contact, Law, Signal, Swinging};
use condyle::{CoordinateKind, Model};
use serde_json::{Map, Value, json};

use super::model::amount;

/// What is at a port, by name: a coordinate's key, a component (with its set if that is another one, and its
/// output if it has several), a segment.
fn name(model: &Model, own: &Component, signal: Signal) -> String {
    match signal {
        Signal::Coordinate(id) => model.coordinate_key(id),
        Signal::Segment(id) => model.segment(id).name.clone(),
        Signal::Output(id, output) => {
            let from = &model.components()[id.index()];
            let mut name = from.name.clone();
            if from.joint_set != own.joint_set {
                name = format!("{}.{name}", model.joint_sets()[from.joint_set.index()].name);
            }
            if from.law.outputs().1 > 1 {
                name = format!("{name}.{}", output + 1);
            }
            name
        }
    }
}

/// Every joint set with its components and what moves its segments.
pub(super) fn to_json(model: &Model) -> Value {
    let sets = model.joint_set_ids().map(|set| {
        let components = model.components_of(set).map(|id| {
            let component = &model.components()[id.index()];
            let inputs: Map<String, Value> = component
                .by_port()
                .map(|(port, signals)| {
                    let mut names = signals.iter().map(|&signal| name(model, component, signal));
                    let value = match port.is_list() {
                        true => json!(names.collect::<Vec<_>>()),
                        false => json!(names.next()),
                    };
                    (port.name.to_owned(), value)
                })
                .collect();
            let mut value = json!({
                "name": component.name,
                "kind": component.law.kind().name,
                "inputs": inputs,
                "outputs": component.law.outputs().1,
            });
            if let Some(limit) = limit_json(&component.law) {
                value["limit"] = limit;
            }
            value
        });
        let components: Vec<Value> = components.collect();
        let moved: Map<String, Value> = model
            .outputs_of(set)
            .map(|(segment, motion)| {
                let motion = match motion {
                    Signal::Output(id, _) => model.components()[id.index()].name.clone(),
                    Signal::Coordinate(id) => model.coordinate_key(id),
                    Signal::Segment(id) => model.segment(id).name.clone(),
                };
                (model.segment(segment).name.clone(), json!(motion))
            })
            .collect();
        json!({
            "joint_set": model.joint_sets()[set.index()].name,
            "components": components,
            "output": moved,
        })
    });
    json!(sets.collect::<Vec<_>>())
}

/// The parameters of a limit, in radians and metres.
fn limit_json(law: &Law) -> Option<Value> {
    Some(match law {
        Law::Cone(cone) => {
            let points = cone.cone.points().iter().map(
                |point| json!({ "direction": point.direction.to_array(), "twist": point.twist }),
            );
            json!({
                "of": match cone.of {
                    Swinging::Angles(_) => "angles",
                    Swinging::Directions(_) => "directions",
                    Swinging::Orientation => "orientation",
                },
                "rest": cone.cone.rest().to_array(),
                "twist": cone.cone.twist_at_rest(),
                "points": points.collect::<Vec<_>>(),
            })
        }
        Law::Ellipse(ellipse) => json!({
            "centre": ellipse.centre(),
            "half_axes": ellipse.half_axes(),
            "tilt": ellipse.tilt(),
        }),
        Law::HalfSpace(half) => json!({ "normal": half.normal(), "bound": half.bound() }),
        Law::Field(field) => {
            let about = field.limit.about();
            json!({
                "limit": about.name,
                "child": about.child,
                "reference": about.reference,
                "source": about.source,
                "population": about.population,
                "samples": field.limit.ground().samples.len(),
                "share": field.limit.stated().map(|learned| learned.valid),
                "strict": field.strict,
            })
        }
        Law::Depend(depend) => {
            let domain = |f: &condyle::math::function::Function| json!({ "domain": f.domain() });
            json!({
                "lower": depend.lower.as_ref().map(domain),
                "upper": depend.upper.as_ref().map(domain),
            })
        }
        Law::Contact(Contact { most_gap, law, .. }) => json!({
            "radii": law.radii().to_array(),
            "centre_in_surface": law.ellipsoid_in_surface().translation.to_array(),
            "axis": law.axis().to_array(),
            "pairs": law.pairs().len(),
            "most_gap": most_gap,
        }),
        _ => return None,
    })
}

/// A table of the limits that are components: name, kind, what it bounds, how.
pub(super) fn limit_rows(model: &Model) -> Vec<Vec<String>> {
    let angle = |x: f64| amount(CoordinateKind::Rotation, x, false);
    let length = |x: f64| amount(CoordinateKind::Translation, x, false);
    let span = |[low, high]: [f64; 2]| format!("{} to {}", angle(low), angle(high));
    let mut rows = vec![];
    for component in model.components() {
        let names = |signals: &[Signal]| {
            let names = signals.iter().map(|&signal| name(model, component, signal));
            names.collect::<Vec<_>>().join(", ")
        };
        let (of, how) = match &component.law {
            Law::Cone(cone) => {
                let rest = cone.cone.rest();
                let swing = |v: condyle::math::Vec3| rest.cross(v).norm().atan2(rest.dot(v));
                let reach = cone.cone.points().iter().map(|point| swing(point.direction));
                let (low, high) = reach.fold((f64::INFINITY, 0.0f64), |(low, high), reach| {
                    (low.min(reach), high.max(reach))
                });
                let swing =
                    format!("{} points, swing {}", cone.cone.points().len(), span([low, high]));
                let twist = match cone.cone.twist_at_rest() {
                    Some(twist) => format!("twist {} at rest", span(twist)),
                    None => "any twist".to_owned(),
                };
                (names(&component.inputs), format!("{swing}; {twist}"))
            }
            Law::Depend(depend) => {
                let sides = match (&depend.lower, &depend.upper) {
                    (Some(_), Some(_)) => "from below and above",
                    (Some(_), None) => "from below",
                    _ => "from above",
                };
                let driver = names(component.at("driver"));
                (names(component.at("passive")), format!("bounded {sides} by {driver}"))
            }
            Law::Ellipse(ellipse) => {
                let axes = ellipse.half_axes().map(|x| format!("{x:.4}"));
                (names(&component.inputs), format!("half axes {}", axes.join(" and ")))
            }
            Law::HalfSpace(half) => {
                let normal: Vec<String> = half.normal().iter().map(f64::to_string).collect();
                let how =
                    format!("[{}] times these at most {:.4}", normal.join(", "), half.bound());
                (names(&component.inputs), how)
            }
            Law::Field(field) => {
                let about = field.limit.about();
                let share = field.limit.stated().map_or(String::new(), |learned| {
                    format!(", {:.1} % of all rotations", 100.0 * learned.valid)
                });
                let source = match about.source.is_empty() {
                    true => String::new(),
                    false => format!("; {}", about.source),
                };
                let ground = field.limit.ground();
                let from = match &ground.shape {
                    Some(_) => "three turns".to_owned(),
                    None => format!("{} samples", ground.samples.len()),
                };
                (names(&component.inputs), format!("{from}{share}{source}"))
            }
            Law::Contact(Contact { most_gap, law, .. }) => {
                let radii = law.radii().to_array().map(length);
                let gap = match most_gap {
                    Some(gap) => format!("a gap of at most {}", length(*gap)),
                    None => "any gap".to_owned(),
                };
                let on = format!(
                    "{} on {}",
                    names(component.at("segment")),
                    names(component.at("surface"))
                );
                let pairs = law.pairs().len();
                (on, format!("ellipsoid of {}; {pairs} pairs; {gap}", radii.join(", ")))
            }
            _ => continue,
        };
        let set = &model.joint_sets()[component.joint_set.index()].name;
        let kind = component.law.kind().name.to_owned();
        rows.push(vec![format!("{set}/{}", component.name), kind, of, how]);
    }
    rows
}

/// Whether a component is one of a plain joint, or of a custom joint of OpenSim: functions of coordinates that
/// turn or move a segment along fixed axes. There are many of these, and `--json` lists them.
fn plain(component: &Component) -> bool {
    matches!(
        component.law,
        Law::Map(_)
            | Law::Rotate(_)
            | Law::Translate(_)
            | Law::Ball(_)
            | Law::Product(_)
            | Law::Place(_)
    )
}

/// The components of each joint set that is no plain joint: name, kind, what is at its ports.
pub(super) fn rows(model: &Model) -> Vec<Vec<String>> {
    let mut rows = vec![];
    for set in model.joint_set_ids() {
        let components: Vec<&Component> =
            model.components_of(set).map(|id| &model.components()[id.index()]).collect();
        if components.iter().all(|component| plain(component)) {
            continue;
        }
        let set = &model.joint_sets()[set.index()].name;
        for component in components {
            let ports = component.by_port().filter(|(_, signals)| !signals.is_empty());
            let ports = ports.map(|(port, signals)| {
                let names = signals.iter().map(|&signal| name(model, component, signal));
                format!("{} {}", port.name, names.collect::<Vec<_>>().join(", "))
            });
            let ports: Vec<String> = ports.collect();
            rows.push(vec![
                format!("{set}/{}", component.name),
                component.law.kind().name.to_owned(),
                ports.join("; "),
            ]);
        }
    }
    rows
}
