//! A model: segments, coordinates, loops, postures and markers.

use super::network;
use crate::output::{columns, wrapped};
use condyle::check::circles;
use condyle::model::PostureTerm;
use condyle::model::component::Signal;
use condyle::model::model::{Condition, Facing};
use condyle::model::{Closure, UpAxis};
use condyle::{CoordinateId, CoordinateKind, Model, SegmentId};
use serde_json::{Value, json};
use std::collections::HashSet;

pub(super) fn to_json(model: &Model) -> Value {
    let segments: Vec<Value> = model
        .segments()
        .iter()
        .map(|segment| {
            json!({
                "name": segment.name,
                "parent": segment.parent.map(|id| &model.segment(id).name),
                "joint_set": segment.joint_set.map(|id| &model.joint_sets()[id.index()].name),
            })
        })
        .collect();
    let keys = keys(model);
    let circles = circles(model);
    let coordinates: Vec<Value> = model
        .coordinate_ids()
        .map(|id| {
            let coordinate = model.coordinate(id);
            let default = match coordinate.kind {
                CoordinateKind::Orientation => json!(coordinate.default),
                _ => json!(coordinate.default[0]),
            };
            json!({
                "key": keys[id.index()],
                "name": coordinate.name,
                "joint_set": model.joint_sets()[coordinate.joint_set.index()].name,
                "kind": coordinate.kind.name(),
                "default": default,
                "range": [coordinate.range.lower, coordinate.range.upper],
                "clamped": coordinate.range.enforced,
                "typical": coordinate.typical,
                "circle": circles.contains(&id),
                "locked": coordinate.locked,
                "drives": coordinate.drives,
                "follows": leader_keys(model, id, &keys),
            })
        })
        .collect();
    let closures: Vec<Value> =
        model.closures().iter().map(|closure| closure_json(model, closure, &keys)).collect();
    let postures: Vec<Value> = model
        .postures()
        .iter()
        .map(|posture| {
            let term =
                |(id, factor): &(CoordinateId, f64)| (keys[id.index()].clone(), json!(factor));
            json!({
                "name": posture.name,
                "sum": posture.sum.iter().map(term).collect::<serde_json::Map<_, _>>(),
                "rest": posture.rest,
                "stiffness": posture.stiffness,
                "source": posture.source,
            })
        })
        .collect();
    let markers: Vec<Value> = model
        .markers()
        .iter()
        .map(|marker| {
            json!({
                "name": marker.name,
                "segment": marker.segment.map(|id| &model.segment(id).name),
                "point": marker.point.to_array(),
            })
        })
        .collect();
    json!({
        "kind": "model",
        "name": model.name(),
        "up": up(model),
        "facing": model.facing().name_in(model.up()),
        "segments": segments,
        "joint_sets": model.joint_sets().iter().map(|set| &set.name).collect::<Vec<_>>(),
        "coordinates": coordinates,
        "networks": network::to_json(model),
        "closures": closures,
        "postures": postures,
        "markers": markers,
    })
}

fn up(model: &Model) -> &'static str {
    match model.up() {
        UpAxis::Y => "y",
        UpAxis::Z => "z",
    }
}

fn keys(model: &Model) -> Vec<String> {
    model.coordinate_ids().map(|id| model.coordinate_key(id)).collect()
}

/// The coordinates that a coupled one follows; `None` for one that follows nothing.
fn leader_keys<'k>(model: &Model, id: CoordinateId, keys: &'k [String]) -> Vec<&'k str> {
    let mut leaders = vec![];
    let mut seen = HashSet::new();
    let mut open: Vec<Signal> = model.coordinate(id).follows.into_iter().collect();
    while let Some(source) = open.pop() {
        if !seen.insert(source) {
            continue;
        }
        match source {
            Signal::Coordinate(leader) => leaders.push(leader),
            Signal::Output(component, _) => {
                open.extend(model.components()[component.index()].values());
            }
            Signal::Segment(_) => {}
        }
    }
    leaders.sort_unstable();
    leaders.into_iter().map(|id| keys[id.index()].as_str()).collect()
}

/// The two ends of a closure between segments, or none for one between coordinates.
fn ends(closure: &Closure) -> Option<[Option<SegmentId>; 2]> {
    match &closure.condition {
        Condition::Points { at } | Condition::Distance { at, .. } => Some(at.map(|(s, _)| s)),
        Condition::Frames { at } => Some(at.map(|(s, _)| s)),
        Condition::Coupling { .. } => None,
    }
}

fn closure_kind(closure: &Closure) -> &'static str {
    match closure.condition {
        Condition::Points { .. } => "points",
        Condition::Frames { .. } => "frames",
        Condition::Distance { .. } => "distance",
        Condition::Coupling { .. } => "coupling",
    }
}

fn closure_json(model: &Model, closure: &Closure, keys: &[String]) -> Value {
    let mut value = json!({
        "name": closure.name,
        "kind": closure_kind(closure),
        "rows": closure.condition.rows(),
    });
    if let Some(ends) = ends(closure) {
        value["segments"] = json!(ends.map(|end| end.map(|id| &model.segment(id).name)));
    }
    match &closure.condition {
        Condition::Distance { distance, .. } => value["distance"] = json!(distance),
        Condition::Coupling { follower, driver, .. } => {
            value["follower"] = json!(keys[follower.index()]);
            value["driver"] = json!(keys[driver.index()]);
        }
        Condition::Points { .. } | Condition::Frames { .. } => {}
    }
    value
}

pub(super) fn to_text(model: &Model) -> String {
    let free = model.coordinates().iter().filter(|c| c.follows.is_none() && !c.locked);
    let mut text = format!(
        "model `{}`, {} up{}\n{} segments, {} joint sets, {} coordinates ({} of them free), {} loops, \
         {} markers\n",
        model.name(),
        up(model),
        match model.facing() {
            Facing::PlusX => String::new(),
            other => format!(", facing {}", other.name_in(model.up())),
        },
        model.segments().len(),
        model.joint_sets().len(),
        model.coordinates().len(),
        free.count(),
        model.closures().len(),
        model.markers().len(),
    );
    text.push_str("\nsegments, each with the joint set that moves it\n");
    text.push_str(&columns(&segment_rows(model)));
    if !model.coordinates().is_empty() {
        text.push_str("\ncoordinates: default and range\n");
        text.push_str(&columns(&coordinate_rows(model)));
    }
    let limits = network::limit_rows(model);
    if !limits.is_empty() {
        text.push_str("\nlimits of several together: what each bounds, and how\n");
        text.push_str(&columns(&limits));
    }
    let network = network::rows(model);
    if !network.is_empty() {
        text.push_str("\ncomponents of joint sets that are no plain joints: what each reads\n");
        text.push_str(&columns(&network));
    }
    if !model.closures().is_empty() {
        text.push_str("\nloops, which tracking closes and `fk` does not\n");
        let keys = keys(model);
        let rows = model.closures().iter().map(|c| closure_row(model, c, &keys));
        text.push_str(&columns(&rows.collect::<Vec<_>>()));
    }
    if !model.postures().is_empty() {
        text.push_str("\npostures, which tracking holds: sum of coordinates, rest, stiffness\n");
        let keys = keys(model);
        let rows = model.postures().iter().map(|posture| posture_row(model, posture, &keys));
        text.push_str(&columns(&rows.collect::<Vec<_>>()));
    }
    if !model.markers().is_empty() {
        text.push_str("\nmarkers\n");
        text.push_str(&marker_lines(model));
    }
    text
}

/// The tree from its roots, a parent before its children, each level indented by two spaces.
fn segment_rows(model: &Model) -> Vec<Vec<String>> {
    let mut children: Vec<Vec<SegmentId>> = vec![vec![]; model.segments().len()];
    let mut open = vec![];
    let ids: Vec<SegmentId> = model.segment_ids().collect();
    for id in ids.into_iter().rev() {
        match model.segment(id).parent {
            Some(parent) => children[parent.index()].push(id),
            None => open.push((id, 0)),
        }
    }
    let mut rows = vec![];
    while let Some((id, depth)) = open.pop() {
        let segment = model.segment(id);
        let set = segment.joint_set.map(|set| model.joint_sets()[set.index()].name.clone());
        // The indentation of a very deep tree is limited.
        let margin = " ".repeat(2 * depth.min(40));
        rows.push(vec![
            format!("{margin}{}", segment.name),
            set.unwrap_or_else(|| "(fixed)".to_owned()),
        ]);
        open.extend(children[id.index()].iter().map(|&child| (child, depth + 1)));
    }
    rows
}

fn coordinate_rows(model: &Model) -> Vec<Vec<String>> {
    let keys = keys(model);
    let circles = circles(model);
    model
        .coordinate_ids()
        .map(|id| {
            let coordinate = model.coordinate(id);
            let mut row = vec![keys[id.index()].clone(), coordinate.kind.name().to_owned()];
            if coordinate.kind == CoordinateKind::Orientation {
                let parts = coordinate.default.map(|part| part.to_string());
                row.extend([parts.join(" "), String::new(), String::new()]);
            } else {
                let range = coordinate.range;
                let shown = [Some(coordinate.default[0]), range.lower, range.upper];
                let far = shown.into_iter().flatten().any(|v| v.abs() >= 1.0);
                let side = |v: Option<f64>, absent: &str| {
                    v.map_or_else(|| absent.to_owned(), |v| amount(coordinate.kind, v, far))
                };
                row.push(amount(coordinate.kind, coordinate.default[0], far));
                row.push(side(range.lower, "-∞"));
                row.push(side(range.upper, "∞"));
            }
            let mut marks = vec![];
            if coordinate.range.enforced {
                marks.push("clamped".to_owned());
            }
            if let Some([low, high]) = coordinate.typical {
                let far = low.abs().max(high.abs()) >= 1.0;
                let [low, high] = [low, high].map(|v| amount(coordinate.kind, v, far));
                marks.push(format!("people reach {low} to {high}"));
            }
            if circles.contains(&id) {
                marks.push("a circle".to_owned());
            }
            if coordinate.locked {
                marks.push("locked".to_owned());
            }
            if let Some(drives) = &coordinate.drives {
                marks.push(format!("drives {drives}"));
            }
            if coordinate.follows.is_some() {
                let leaders = leader_keys(model, id, &keys);
                marks.push(if leaders.is_empty() {
                    "constant".to_owned()
                } else {
                    format!("follows {}", leaders.join(", "))
                });
            }
            row.push(marks.join(", "));
            row
        })
        .collect()
}

/// A value with its unit: degrees, millimetres, or metres for great lengths.
pub(super) fn amount(kind: CoordinateKind, value: f64, far: bool) -> String {
    match kind {
        CoordinateKind::Rotation => format!("{}°", rounded(value.to_degrees(), 2)),
        CoordinateKind::Translation if far => format!("{} m", rounded(value, 3)),
        CoordinateKind::Translation => format!("{} mm", rounded(1e3 * value, 1)),
        CoordinateKind::Scale | CoordinateKind::Other | CoordinateKind::Orientation => {
            rounded(value, 4)
        }
    }
}

/// A few decimals, without zeros at the end or a minus before zero.
fn rounded(value: f64, decimals: usize) -> String {
    if value.abs() >= 1e9 {
        return format!("{value:.3e}");
    }
    let text = format!("{value:.decimals$}");
    match text.trim_end_matches('0').trim_end_matches('.') {
        "-0" => "0".to_owned(),
        trimmed => trimmed.to_owned(),
    }
}

fn closure_row(model: &Model, closure: &Closure, keys: &[String]) -> Vec<String> {
    let name = |end: Option<SegmentId>| {
        end.map_or_else(|| "the world".to_owned(), |id| model.segment(id).name.clone())
    };
    let said = match (&closure.condition, ends(closure)) {
        (Condition::Coupling { follower, driver, .. }, _) => {
            format!("{} follows {}", keys[follower.index()], keys[driver.index()])
        }
        (Condition::Distance { distance, .. }, Some([a, b])) => {
            format!("{} to {}: {} mm", name(a), name(b), rounded(1e3 * distance, 1))
        }
        (_, Some([a, b])) => format!("{} and {}", name(a), name(b)),
        (_, None) => String::new(),
    };
    vec![closure.name.clone(), closure_kind(closure).to_owned(), said]
}

fn posture_row(model: &Model, posture: &PostureTerm, keys: &[String]) -> Vec<String> {
    let mut sum = String::new();
    for (id, factor) in &posture.sum {
        let key = &keys[id.index()];
        let sign = if *factor < 0.0 { "-" } else { "+" };
        sum.push_str(&match (sum.is_empty(), factor.abs() == 1.0) {
            (true, true) if *factor > 0.0 => key.clone(),
            (true, true) => format!("-{key}"),
            (true, false) => format!("{factor} {key}"),
            (false, true) => format!(" {sign} {key}"),
            (false, false) => format!(" {sign} {} {key}", factor.abs()),
        });
    }
    let kind = |(id, _): &(CoordinateId, f64)| model.coordinate(*id).kind;
    let kind = posture.sum.first().map_or(CoordinateKind::Other, kind);
    let rest = amount(kind, posture.rest, false);
    let stiffness = format!("{:e}", posture.stiffness);
    // A posture of one coordinate often has its name.
    let sum = if sum == posture.name { String::new() } else { sum };
    vec![posture.name.clone(), sum, rest, stiffness]
}

/// Marker names, one paragraph for each segment that has any.
fn marker_lines(model: &Model) -> String {
    let mut names: Vec<Vec<&str>> = vec![vec![]; model.segments().len() + 1];
    let world = model.segments().len();
    for marker in model.markers() {
        names[marker.segment.map_or(world, SegmentId::index)].push(&marker.name);
    }
    let mut text = String::new();
    let segments = model.segments().iter().map(|s| s.name.as_str()).chain(Some("the world"));
    for (segment, names) in segments.zip(names) {
        if !names.is_empty() {
            text.push_str(&wrapped(&format!("{segment} ({}):", names.len()), &names));
        }
    }
    text
}
