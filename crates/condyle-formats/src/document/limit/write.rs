//! Writes a learned limit: the samples in base64, and all numbers with which the same field is made again.

use super::super::model::{number, numbers, text};
use super::given::given;
use crate::text::base64;
use condyle_learn::limits::LearnedLimit;
use condyle_learn::limits::field::{Ground, Learned};
use condyle_model::limit::field::packed;
use std::fmt::Write;

/// How many letters of base64 stand in a line: 24 rotations and a half.
const WIDTH: usize = 100;

/// Writes a limit; what was read and is written again is the same text.
#[must_use]
pub fn write(limit: &LearnedLimit) -> String {
    let mut out = String::from("condyle = 1\nkind = \"limit\"\n");
    named_keys(&mut out, limit, "");
    out
}

/// As [`keys`], its name before them.
pub(in crate::document) fn named_keys(out: &mut String, limit: &LearnedLimit, within: &str) {
    if !limit.about().name.is_empty() {
        let _ = writeln!(out, "name = {}", text(&limit.about().name));
    }
    keys(out, limit, within);
}

/// The keys and tables of a limit, whose tables are below `within`, which ends with a dot or is empty.
fn keys(out: &mut String, limit: &LearnedLimit, within: &str) {
    let about = limit.about();
    let _ = writeln!(out, "child = {}", text(&about.child));
    let mut line = |key: &str, value: &str| {
        if !value.is_empty() {
            let _ = writeln!(out, "{key} = {}", text(value));
        }
    };
    line("reference", about.reference.as_deref().unwrap_or_default());
    line("source", &about.source);
    line("population", &about.population);
    line("frames", &about.frames);
    let ground = limit.ground();
    let Ground { samples, takes, thinned, chart, settings, known, shape } = &**ground;
    if let Some(shape) = shape {
        return super::shape::write_shape(out, shape, settings.nodes, within);
    }
    let _ = writeln!(out, "\n[{within}learning]");
    let _ = writeln!(out, "method = \"closing\"");
    let _ = writeln!(out, "nodes = {}", settings.nodes);
    let _ = writeln!(out, "radii = {} # radians", numbers(&settings.radius));
    if let Some(layer) = settings.gap {
        let _ = writeln!(out, "layer = {}", number(layer));
    }
    let hole = settings.hole.map_or("[]".to_owned(), |hole| numbers(&hole));
    let _ = writeln!(out, "hole = {hole}");
    if let Some(known) = known {
        let _ = writeln!(out, "\n[{within}learned]");
        for (key, angle) in
            [("spacing", known.spacing), ("radius", known.radius), ("gap", known.gap)]
        {
            let _ = writeln!(out, "{key} = {} # {:.2} degrees", number(angle), angle.to_degrees());
        }
    }
    if let Some(Learned { extreme, surface, outer, valid, holes, .. }) =
        limit.stated().filter(|_| known.is_some())
    {
        let _ = writeln!(out, "extreme = {}", number(*extreme));
        let _ = writeln!(out, "surface = {}", number(*surface));
        let _ = writeln!(out, "outer = {} # of all rotations", number(*outer));
        let _ = writeln!(out, "valid = {}", number(*valid));
        if !holes.is_empty() {
            out.push_str("holes = [\n");
            for hole in holes {
                let (centre, radius) = (numbers(&hole.centre.to_array()), number(hole.radius));
                let share = number(hole.share);
                let _ = writeln!(
                    out,
                    "    {{ centre = {centre}, radius = {radius}, share = {share} }},"
                );
            }
            out.push_str("]\n");
        }
    }
    if let Some(dependence) = limit.dependence() {
        given(out, dependence, within);
    }
    let _ = writeln!(out, "\n[{within}samples]");
    let counts: Vec<f64> = takes.iter().map(|count| f64::from(*count)).collect();
    let _ = writeln!(out, "takes = {}", numbers(&counts));
    if !about.takes.is_empty() {
        let names: Vec<String> = about.takes.iter().map(|name| text(name)).collect();
        let _ = writeln!(out, "names = [{}]", names.join(", "));
    }
    let _ = writeln!(out, "thinned = {}", number(*thinned));
    let [left, right] = chart.sides().map(|q| numbers(&q.to_array()));
    let _ = writeln!(out, "axes = [\n    {left},\n    {right},\n]");
    packed_samples(out, samples);
}

/// Rotations in base64.
pub(super) fn packed_samples(out: &mut String, samples: &[condyle_math::Quat]) {
    let bytes: Vec<u8> =
        samples.iter().flat_map(|q| packed(*q)).flat_map(u16::to_le_bytes).collect();
    let _ = writeln!(out, "# {} rotations: three u16 each, within 0.01 degrees", samples.len());
    letters(out, "packed", &bytes);
}

/// Bytes in base64 under a key.
pub(super) fn letters(out: &mut String, key: &str, bytes: &[u8]) {
    let letters = base64::encode(bytes);
    let _ = writeln!(out, "{key} = \"\"\"");
    for row in letters.as_bytes().chunks(WIDTH) {
        out.push_str(std::str::from_utf8(row).unwrap_or_default());
        out.push('\n');
    }
    out.push_str("\"\"\"\n");
}
