//! Limits of kind `limit` whose method is `herda2003`: spheres in the vector part of quaternions.
//!
//! ```text
//! [learning]
//! method       = "herda2003"
//! [spheres]
//! placement    = "centred" | "as-recorded"
//! reference    = the mean rotation, [x, y, z, w]
//! stickiness   = k
//! each         = a list of [x, y, z, radius]
//! energy       = E at the end
//! stages       = a list of [spheres, E], before cleaning
//! removed      = how many spheres cleaning removed as too large, too far, too sparse
//! [samples]
//! packed, takes, names, thinned
//! ```

use super::write::packed_samples;
use super::{Fields, Form, Kind, Reader, Samples, read_kind};
use crate::document::model::{number, numbers, text};
use condyle_diagnostics::{Error, Read};
use condyle_learn::limits::About;
use condyle_learn::limits::herda2003::{
    Chart, LearnedSpheres, Placement, Primitive, Removed, SphereField, SphereLimit,
};
use condyle_math::Vec3;
use std::fmt::Write;

const FORM: Form = Form {
    kind: Kind::Limit,
    keys: &[
        "child",
        "reference",
        "source",
        "population",
        "frames",
        "samples",
        "learning",
        "spheres",
    ],
    own: &[],
    repeated: &[],
};

const PLACEMENTS: [(&str, Placement); 2] =
    [("centred", Placement::Centred), ("as-recorded", Placement::AsRecorded)];

/// Whether a document of kind `limit` says that its method is that of Herda et al. 2003.
#[must_use]
pub fn is_of_spheres(text: &str) -> bool {
    text.lines().any(|line| {
        let value = line.trim().strip_prefix("method").map(str::trim_start);
        let value = value.and_then(|rest| rest.strip_prefix('=')).map(str::trim_start);
        value.is_some_and(|value| value.starts_with("\"herda2003\""))
    })
}

/// Reads a limit of spheres. `include` gives the text of another document by its path.
///
/// # Errors
/// Everything that is wrong, in the order of the text.
///
/// ```
/// use condyle_formats::document::limit::{read_spheres, write_spheres};
/// use condyle_math::{Quat, Vec3};
/// let text = r#"
/// condyle = 1
/// kind = "limit"
/// child = "humerus"
/// [learning]
/// method = "herda2003"
/// [spheres]
/// placement = "centred"
/// reference = [0, 0, 0, 1]
/// stickiness = 5
/// each = [[0, 0, 0, 0.5]]
/// [samples]
/// rotations = [[0, 0, 0, 1], [0.3, 0, 0, 0.9539]]
/// "#;
/// let read = read_spheres(text, &mut |_| Err("it stands alone".into()))?.value;
/// // sin(θ/2) = 0.5 at 60 degrees.
/// let turn = |degrees: f64| Quat::from_axis_angle(Vec3::X, degrees.to_radians());
/// assert!(read.limit.allows(turn(59.9)) && !read.limit.allows(turn(60.1)));
/// let again = read_spheres(&write_spheres(&read), &mut |_| Err("it stands alone".into()))?.value;
/// assert_eq!(again, read);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read_spheres(
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Read<LearnedSpheres>, Error> {
    read_kind(&FORM, text, include, |mut reader, top| {
        let name = top.get("name").and_then(|node| reader.text(node, "name"));
        reader.spheres(top, name.map(|name| name.text).unwrap_or_default())
    })
}

impl Reader<'_> {
    fn spheres(&mut self, top: &Fields<'_>, name: String) -> Option<LearnedSpheres> {
        let about = self.about(top, name);
        if let Some(fields) = self.table_of(top, "learning", &["method"]) {
            self.word(&fields, "method", &[("herda2003", ())])?;
        }
        for (key, what) in [("spheres", "a table with the spheres"), ("samples", "the rotations")] {
            if top.get(key).is_none() {
                self.missing(top, key, what);
            }
        }
        let keys = ["placement", "reference", "stickiness", "each", "energy", "stages", "removed"];
        let fields = self.table_of(top, "spheres", &keys)?;
        let limit = self.sphere_limit(&fields);
        let samples =
            self.table_of(top, "samples", &["packed", "rotations", "takes", "names", "thinned"])?;
        let Samples { rotations, takes, names, thinned, .. } = self.samples(&samples)?;
        let about = About { takes: names, ..about? };
        Some(LearnedSpheres { about, limit: limit?, samples: rotations, takes, thinned })
    }

    fn sphere_limit(&mut self, fields: &Fields<'_>) -> Option<SphereLimit> {
        let placement = self.word(fields, "placement", &PLACEMENTS)?;
        let reference = self.required(fields, "reference", "the mean rotation, [x, y, z, w]")?;
        let reference = self.side(reference, "reference")?;
        let stickiness = self.required(fields, "stickiness", "a number above 0")?;
        let stickiness = self.positive(stickiness, "stickiness")?;
        let each = self.required(fields, "each", "a list of [x, y, z, radius]")?;
        let mut primitives = vec![];
        for node in self.list(each, "each")? {
            let [x, y, z, radius] = self.some::<4>(node, "each")?;
            if radius < 0.0 {
                let message = format!("a sphere has radius {radius}");
                self.texts.error(node.spot, "limit/sphere", message, "give 0 or more");
                return None;
            }
            primitives.push(Primitive { centre: Vec3::new(x, y, z), radius });
        }
        if primitives.is_empty() {
            let message = "`each` has no sphere".to_owned();
            self.texts.error(each.spot, "limit/sphere", message, "give [x, y, z, radius]");
            return None;
        }
        let energy = match fields.get("energy") {
            Some(node) => self.not_negative(node, "energy")?,
            None => 0.0,
        };
        let mut history = vec![];
        if let Some(node) = fields.get("stages") {
            for stage in self.list(node, "stages")? {
                let [count, energy] = self.some::<2>(stage, "stages")?;
                history.push((count.clamp(0.0, 1e6) as usize, energy));
            }
        }
        let removed = match fields.get("removed") {
            None => Removed::default(),
            Some(node) => {
                let [large, far, sparse] =
                    self.some::<3>(node, "removed")?.map(|n| n.clamp(0.0, 1e6) as usize);
                Removed { large, far, sparse }
            }
        };
        let field = SphereField { primitives, stickiness };
        Some(SphereLimit {
            chart: Chart::new(reference, placement),
            field,
            energy,
            history,
            removed,
        })
    }
}

/// Writes a limit of spheres; what was read and is written again is the same text.
#[must_use]
pub fn write_spheres(spheres: &LearnedSpheres) -> String {
    let LearnedSpheres { about, limit, samples, takes, thinned } = spheres;
    let mut out = String::from("condyle = 1\nkind = \"limit\"\n");
    let reference = about.reference.as_deref().unwrap_or_default();
    for (key, value) in [
        ("name", about.name.as_str()),
        ("child", &about.child),
        ("reference", reference),
        ("source", &about.source),
        ("population", &about.population),
        ("frames", &about.frames),
    ] {
        if !value.is_empty() || key == "child" {
            let _ = writeln!(out, "{key} = {}", text(value));
        }
    }
    out.push_str("\n[learning]\nmethod = \"herda2003\"\n\n[spheres]\n");
    let placement = PLACEMENTS.iter().find(|(_, p)| *p == limit.chart.placement());
    let _ = writeln!(out, "placement = \"{}\"", placement.map_or("centred", |(name, _)| name));
    let _ = writeln!(out, "reference = {}", numbers(&limit.chart.reference().to_array()));
    let _ = writeln!(out, "stickiness = {}", number(limit.field.stickiness));
    let _ = writeln!(out, "energy = {}", number(limit.energy));
    let stages: Vec<String> =
        limit.history.iter().map(|(count, energy)| numbers(&[*count as f64, *energy])).collect();
    let _ = writeln!(out, "stages = [{}]", stages.join(", "));
    let Removed { large, far, sparse } = limit.removed;
    let _ = writeln!(out, "removed = [{large}, {far}, {sparse}]");
    out.push_str("each = [\n");
    for sphere in &limit.field.primitives {
        let Vec3 { x, y, z } = sphere.centre;
        let _ = writeln!(out, "    {},", numbers(&[x, y, z, sphere.radius]));
    }
    out.push_str("]\n\n[samples]\n");
    let counts: Vec<f64> = takes.iter().map(|count| f64::from(*count)).collect();
    let _ = writeln!(out, "takes = {}", numbers(&counts));
    if !about.takes.is_empty() {
        let names: Vec<String> = about.takes.iter().map(|name| text(name)).collect();
        let _ = writeln!(out, "names = [{}]", names.join(", "));
    }
    let _ = writeln!(out, "thinned = {}", number(*thinned));
    packed_samples(&mut out, samples);
    out
}
