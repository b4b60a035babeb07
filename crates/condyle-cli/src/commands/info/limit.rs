//! What `info` says of a learned limit.

use condyle::limits::{Ends, Hole, LearnedLimit};
use condyle::math::Vec3;
use serde_json::{Value, json};
use std::fmt::Write;

/// The angles of the samples' turns about the child's x, y and z axes, as components of the turn from their
/// mean, least and greatest, in degrees.
fn extent(limit: &LearnedLimit) -> [[f64; 2]; 3] {
    let ground = limit.ground();
    let mean = ground.chart.outward(condyle::math::Quat::IDENTITY);
    let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for q in &ground.samples {
        let turn: Vec3 = (mean.conjugate() * *q).log();
        for (bounds, angle) in extent.iter_mut().zip(turn.to_array()) {
            *bounds = [bounds[0].min(angle.to_degrees()), bounds[1].max(angle.to_degrees())];
        }
    }
    extent
}

pub(super) fn to_json(limit: &LearnedLimit) -> Value {
    if let Some(shape) = &limit.ground().shape {
        let about = limit.about();
        let ends = |ends: &Ends| {
            let all = ends.lower().iter().chain(ends.upper()).map(|end| end.to_degrees());
            json!([
                all.clone().fold(f64::INFINITY, f64::min),
                all.fold(f64::NEG_INFINITY, f64::max)
            ])
        };
        return json!({
            "kind": "limit",
            "name": about.name,
            "child": about.child,
            "reference": about.reference,
            "source": about.source,
            "population": about.population,
            "frames": about.frames,
            "share": limit.learned().valid,
            "shape": {
                "axes": shape.axes().map(|axis| axis.to_array()),
                "first_deg": shape.first().map(f64::to_degrees),
                "second_deg": ends(shape.second()),
                "third_deg": ends(shape.third()),
                "beyond_deg": shape.beyond().to_degrees(),
            },
        });
    }
    let (about, ground, learned) = (limit.about(), limit.ground(), limit.learned());
    let takes: Vec<Value> = ground
        .takes
        .iter()
        .enumerate()
        .map(|(index, count)| json!({ "name": about.takes.get(index), "samples": count }))
        .collect();
    let hole = |hole: &Hole| {
        json!({
            "centre": hole.centre.to_array(),
            "radius_deg": hole.radius.to_degrees(),
            "share": hole.share,
        })
    };
    json!({
        "kind": "limit",
        "name": about.name,
        "child": about.child,
        "reference": about.reference,
        "source": about.source,
        "population": about.population,
        "frames": about.frames,
        "samples": ground.samples.len(),
        "takes": takes,
        "thinned_deg": ground.thinned.to_degrees(),
        "mean": ground.chart.outward(condyle::math::Quat::IDENTITY).to_array(),
        "extent_deg": extent(limit),
        "share": learned.valid,
        "share_with_holes": learned.outer,
        "spacing_deg": learned.spacing.to_degrees(),
        "radius_deg": learned.radius.to_degrees(),
        "gap_deg": learned.gap.to_degrees(),
        "holes": learned.holes.iter().map(hole).collect::<Vec<_>>(),
        "given": limit.dependence().map(|given| json!({ "name": given.name, "reference": given.reference })),
    })
}

pub(super) fn to_text(limit: &LearnedLimit) -> String {
    let (about, ground, learned) = (limit.about(), limit.ground(), limit.learned());
    let mut out = format!(
        "a {} limit{}{}: {} in {}\n",
        if ground.shape.is_some() { "published" } else { "learned" },
        if about.name.is_empty() { "" } else { " " },
        about.name,
        about.child,
        about.reference.as_deref().unwrap_or("the laboratory"),
    );
    for (what, said) in
        [("source", &about.source), ("population", &about.population), ("frames", &about.frames)]
    {
        let said = if said.is_empty() { "not said" } else { said };
        let _ = writeln!(out, "  {what}: {said}");
    }
    if let Some(shape) = &ground.shape {
        let [low, high] = shape.first().map(f64::to_degrees);
        let _ = writeln!(
            out,
            "  three turns, the first by {low:.0} to {high:.0} degrees, the ends of each by those before; {:.0} degrees beyond",
            shape.beyond().to_degrees()
        );
        let _ = writeln!(out, "  valid are {:.2} % of all rotations", 100.0 * learned.valid);
        return out;
    }
    let _ = writeln!(
        out,
        "  {} samples of {} takes, typically {:.1} degrees apart",
        ground.samples.len(),
        ground.takes.len(),
        learned.spacing.to_degrees()
    );
    for (name, count) in about.takes.iter().zip(&ground.takes) {
        let _ = writeln!(out, "    {count:6} {name}");
    }
    let _ = writeln!(
        out,
        "  valid are {:.2} % of all rotations; with {} holes {:.2} %",
        100.0 * learned.valid,
        learned.holes.len(),
        100.0 * learned.outer
    );
    if let Some(given) = limit.dependence() {
        let within = given.reference.as_ref().map_or(String::new(), |r| format!(" in {r}"));
        let _ = writeln!(
            out,
            "  depends on {}{within}: boundaries move by at most {} per unit of it",
            given.name, given.settings.slope
        );
    }
    for (axis, [least, most]) in ["x", "y", "z"].into_iter().zip(extent(limit)) {
        let _ = writeln!(
            out,
            "  turned about {axis} by {least:.0} to {most:.0} degrees from the mean rotation"
        );
    }
    out
}
