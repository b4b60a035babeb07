//! The components of a joint set as a graph, in SVG: what is given at the left, transforms of segments at the right.
//!
//! A component stands one column to the right of the last of those that it reads.

use serde_json::Value;
use std::collections::HashMap;

const COLUMN: usize = 190;
const ROW: usize = 46;
const WIDTH: usize = 150;
const HEIGHT: usize = 34;

/// The graph of joint set `set` of an answer of `condyle info --json`.
pub(super) fn svg(answer: &str, set: &str) -> Result<String, String> {
    let answer: Value = serde_json::from_str(answer).map_err(|error| error.to_string())?;
    let networks = answer["networks"].as_array().ok_or("no networks")?;
    let network =
        networks.iter().find(|network| network["joint_set"] == set || network["name"] == set);
    let network = network.ok_or_else(|| format!("no joint set {set}"))?;
    let components = network["components"].as_array().ok_or("no components")?;
    let mut nodes: Vec<(String, String)> = vec![];
    let mut wires: Vec<(String, String)> = vec![];
    for component in components {
        let name = component["name"].as_str().unwrap_or_default().to_owned();
        let kind = component["kind"].as_str().unwrap_or_default().to_owned();
        for source in component["inputs"].as_object().into_iter().flat_map(|inputs| inputs.values())
        {
            let sources = match source {
                Value::Array(list) => list.iter().filter_map(Value::as_str).collect(),
                Value::String(one) => vec![one.as_str()],
                _ => vec![],
            };
            for source in sources {
                // `cone.2` is the second output of `cone`; what a joint set does not make is given.
                let source = source.split('.').next().unwrap_or(source).to_owned();
                wires.push((source, name.clone()));
            }
        }
        nodes.push((name, kind));
    }
    for (source, _) in &wires {
        if !nodes.iter().any(|(name, _)| name == source) {
            nodes.push((source.clone(), "given".to_owned()));
        }
    }
    let mut column: HashMap<&str, usize> =
        nodes.iter().map(|(name, _)| (name.as_str(), 0)).collect();
    // A network has no loops, so that columns settle within as many rounds as there are nodes.
    for _ in 0..nodes.len() {
        for (source, reader) in &wires {
            let least = column.get(source.as_str()).copied().unwrap_or(0) + 1;
            let own = column.entry(reader.as_str()).or_insert(0);
            *own = (*own).max(least);
        }
    }
    let mut filled: HashMap<usize, usize> = HashMap::new();
    let mut place: HashMap<&str, (usize, usize)> = HashMap::new();
    for (name, _) in &nodes {
        let at = column.get(name.as_str()).copied().unwrap_or(0);
        let row = filled.entry(at).or_insert(0);
        place.insert(name.as_str(), (20 + at * COLUMN, 20 + *row * ROW));
        *row += 1;
    }
    let columns = filled.len();
    let rows = filled.values().copied().max().unwrap_or(0);
    let (width, height) = (columns * COLUMN + 20, rows * ROW + 30);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
    );
    for (source, reader) in &wires {
        let (Some((x, y)), Some((u, v))) = (place.get(source.as_str()), place.get(reader.as_str()))
        else {
            continue;
        };
        let (x, y, v) = (x + WIDTH, y + HEIGHT / 2, v + HEIGHT / 2);
        let middle = x + 20;
        out.push_str(&format!(
            "<path d=\"M{x} {y} C{middle} {y} {} {v} {u} {v}\" fill=\"none\" stroke=\"#5b6b7b\"/>\n",
            u.saturating_sub(20)
        ));
    }
    for (name, kind) in &nodes {
        let Some((x, y)) = place.get(name.as_str()) else { continue };
        let fill = if kind == "given" { "#dde7ef" } else { "#f4efe2" };
        out.push_str(&format!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" rx=\"4\" fill=\"{fill}\" stroke=\"#2e425c\"/>\
             <text x=\"{}\" y=\"{}\" fill=\"#111\">{name}</text><text x=\"{}\" y=\"{}\" fill=\"#555\">{kind}</text>\n",
            x + 6,
            y + 14,
            x + 6,
            y + 28
        ));
    }
    out.push_str("</svg>\n");
    Ok(out)
}
