//! Documents of kind `limit`: which rotations of a segment in another are possible, learned from samples.
//!
//! ```text
//! document     = the head of every document, and
//! child        = the segment whose rotation is limited
//! reference    = the one in which it is seen; without one it is the laboratory
//! source       = where the rotations come from: recordings, a paper
//! population   = who was measured
//! frames       = how the axes of both segments are defined: a recipe, or a model and a joint of it
//! [samples]
//! packed       = base64 of three u16 a rotation, little endian: see condyle_model::limit::field::packed
//! rotations    = or a list of [x, y, z, w]
//! takes        = how many of them, in their order, are from each take
//! names        = a name for each take
//! thinned      = the least angle between two of them that was asked for
//! axes         = [left, right]: left · q · right is a rotation in the axes of the map
//! [learning]
//! method       = "closing"
//! nodes, radii, layer, hole   = how it is learned (condyle_model::limit::field::Settings)
//! [learned]
//! spacing, radius, gap        = what was found: with these and `axes` the field is made again as it was
//! extreme, surface, outer, valid, holes
//! [shape]      = instead of all these: formulas, see `shape.rs`
//! [given]      = where the limit depends on another joint
//! name, reference             = the coordinate, or the segment whose rotation it is and the one in which it is seen
//! values       = the driver at each sample, radians or metres: base64 of an f32 each, little endian, or a list
//! packed       = of a rotation as of the samples; or a list `rotations`
//! slope, step, nodes, few, layer = how it is learned (condyle_model::limit::field::dependent::DependenceSettings)
//! radius, gap  = what was found
//! ```
//!
//! A rotation is a unit quaternion x, y, z, w of the child's axes in the reference's; q and -q are one rotation. Whatever
//! is not given is found from the samples, so that rotations alone are a limit.
//!
//! The field is no part of the file: it is made when it is first asked for, and answers as the one that was
//! learned.

mod given;
mod shape;
mod spheres;
mod write;

pub use spheres::{is_of_spheres, read_spheres, write_spheres};
pub(super) use write::named_keys;
pub use write::write;

use super::fields::{Fields, Reader};
use super::texts::Spot;
use super::tree::Node;
use super::{Form, Kind, read_kind};
use crate::text::base64;
use condyle_diagnostics::{Error, Read};
use condyle_learn::limits::field::{self, Ground, Hole, Known, Learned};
use condyle_learn::limits::{About, Cloud, LearnedLimit, Settings};
use condyle_math::Quat;
use condyle_model::limit::field::{Chart, snapped, unpacked};
use std::sync::Arc;

/// The tables and keys of a limit.
pub(super) const KEYS: &[&str] = &[
    "child",
    "reference",
    "source",
    "population",
    "frames",
    "samples",
    "learning",
    "learned",
    "given",
    "shape",
];

const FORM: Form = Form { kind: Kind::Limit, keys: KEYS, own: &[], repeated: &[] };

/// A quaternion is of length 1 but for this: as many digits as people write.
const UNIT: f64 = 1e-3;

/// Reads a learned limit. `include` gives the text of another document by its path.
///
/// # Errors
/// Everything that is wrong, in the order of the text.
///
/// ```
/// use condyle_formats::document::limit;
/// use condyle_math::{Quat, Vec3};
/// // Turns about z by up to 40 degrees, of which a person took nine.
/// let text = r#"
/// condyle = 1
/// kind = "limit"
/// child = "forearm"
/// reference = "humerus"
/// [learning]
/// nodes = 32
/// [samples]
/// rotations = [
///     [0, 0, -0.3420, 0.9397], [0, 0, -0.2588, 0.9659], [0, 0, -0.1736, 0.9848], [0, 0, -0.0872, 0.9962],
///     [0, 0, 0, 1],
///     [0, 0, 0.0872, 0.9962], [0, 0, 0.1736, 0.9848], [0, 0, 0.2588, 0.9659], [0, 0, 0.3420, 0.9397],
/// ]
/// "#;
/// let read = limit::read(text, &mut |_| Err("it stands alone".into()))?.value;
/// assert_eq!(read.ground().samples.len(), 9);
/// let far = Quat::from_axis_angle(Vec3::X, 2.0);
/// assert!(read.field().distance(far) < -1.5);
/// // Written and read again it is the same.
/// let again = limit::read(&limit::write(&read), &mut |_| Err("it stands alone".into()))?.value;
/// assert_eq!(again.ground(), read.ground());
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Read<LearnedLimit>, Error> {
    read_kind(&FORM, text, include, |mut reader, top| {
        let name = top.get("name").and_then(|node| reader.text(node, "name"));
        reader.limit(top, name.map(|name| name.text).unwrap_or_default())
    })
}

/// What a table of samples says.
struct Samples {
    rotations: Vec<Quat>,
    takes: Vec<u32>,
    names: Vec<String>,
    thinned: f64,
    chart: Option<Chart>,
}

/// The name of a key in messages.
fn below(top: &Fields<'_>, key: &str) -> String {
    if top.label.is_empty() { key.to_owned() } else { format!("{}.{key}", top.label) }
}

impl Reader<'_> {
    /// What people want to know of a limit, but for the names of its takes.
    fn about(&mut self, top: &Fields<'_>, name: String) -> Option<About> {
        let child = self.required(top, "child", "the segment whose rotation is limited");
        let child = child.and_then(|node| self.text(node, "child"));
        let said = |reader: &mut Self, key| {
            let node = top.get(key)?;
            reader.text(node, key).map(|said| said.text)
        };
        let reference = said(self, "reference");
        let [source, population, frames] =
            ["source", "population", "frames"].map(|key| said(self, key).unwrap_or_default());
        let child = child?.text;
        Some(About { name, child, reference, source, population, frames, takes: vec![] })
    }

    /// The limit whose keys are in a table.
    pub(super) fn limit(&mut self, top: &Fields<'_>, name: String) -> Option<LearnedLimit> {
        let about = self.about(top, name);
        if let Some(node) = top.get("shape") {
            for key in ["samples", "learning", "learned"] {
                if top.get(key).is_some() {
                    self.exclusive(node, "shape", key);
                    return None;
                }
            }
            let label = below(top, "shape");
            let ground = self.shape(node, label)?;
            return Some(LearnedLimit::new(about?, Arc::new(ground), None, field::made));
        }
        let learning = ["method", "nodes", "radii", "layer", "hole"];
        let settings = match self.table_of(top, "learning", &learning) {
            Some(fields) => self.settings(&fields),
            None => Some(Settings::default()),
        };
        let learned = ["spacing", "radius", "gap", "extreme", "surface", "outer", "valid", "holes"];
        let learned = match self.table_of(top, "learned", &learned) {
            Some(fields) => Some(self.learned(&fields)?),
            None => None,
        };
        if top.get("samples").is_none() {
            let wanted =
                "a table with the rotations, `packed` or `rotations`, or one of formulas, `shape`";
            self.missing(top, "samples", wanted);
        }
        let keys = ["packed", "rotations", "takes", "names", "thinned", "axes"];
        let samples = self.table_of(top, "samples", &keys)?;
        let Samples { rotations, takes, names, thinned, chart } = self.samples(&samples)?;
        let given = match top.get("given") {
            Some(_) => Some(self.given(top, rotations.len())?),
            None => None,
        };
        let (known, learned) = learned.unzip();
        let about = About { takes: names, ..about? };
        let settings = settings?;
        let ground = match chart {
            Some(chart) => {
                let known = known.flatten();
                let samples = rotations;
                Ground { samples, takes, thinned, chart, settings, known, shape: None }
            }
            None => {
                let cloud = Cloud::gather(&[&rotations], 0.0).ok()?;
                let ground = field::ground(&cloud, &settings).ok()?;
                // Each sample has its driver: then none is left out.
                let ground = match given {
                    Some(_) => Ground { samples: rotations, ..ground },
                    None => ground,
                };
                Ground { thinned, takes: vec![ground.samples.len() as u32], ..ground }
            }
        };
        let limit = LearnedLimit::new(about, Arc::new(ground), learned.flatten(), field::made);
        Some(match given {
            Some(given) => limit.depending_on(given, field::dependent::made),
            None => limit,
        })
    }

    /// A table below another, if it is there.
    fn table_of<'t>(&mut self, top: &Fields<'t>, key: &str, known: &[&str]) -> Option<Fields<'t>> {
        let node = top.get(key)?;
        let label = below(top, key);
        Some(self.table(node, node.spot, label, known))
    }

    fn settings(&mut self, fields: &Fields<'_>) -> Option<Settings> {
        self.word(fields, "method", &[("closing", ())])?;
        let mut settings = Settings::default();
        if let Some(node) = fields.get("nodes") {
            settings.nodes = self.nodes(node)?;
        }
        if let Some(node) = fields.get("radii") {
            let unit = self.angle_unit(node.spot);
            let [least, most] = self.some::<2>(node, "radii")?.map(|radius| radius * unit);
            if !(least > 0.0 && least <= most && most < std::f64::consts::PI) {
                let message = "`radii` do not rise from above 0 to below half a turn".to_owned();
                let help = "give the least and the greatest radius of empty balls";
                self.texts.error(node.spot, "limit/settings", message, help);
                return None;
            }
            settings.radius = [least, most];
        }
        if let Some(node) = fields.get("layer") {
            settings.gap = Some(self.angle(node, "layer")?);
        }
        if let Some(node) = fields.get("hole") {
            settings.hole = match self.list(node, "hole")? {
                [] => None,
                _ => Some(self.some::<2>(node, "hole")?),
            };
        }
        Some(settings)
    }

    /// An angle of 0 or more, below half a turn, in radians.
    fn angle(&mut self, node: &Node, label: &str) -> Option<f64> {
        let angle = self.not_negative(node, label)? * self.angle_unit(node.spot);
        if angle < std::f64::consts::PI {
            return Some(angle);
        }
        let message = format!("`{label}` is half a turn or more");
        self.texts.error(node.spot, "limit/angle", message, "give an angle below that");
        None
    }

    fn learned(&mut self, fields: &Fields<'_>) -> Option<(Option<Known>, Option<Learned>)> {
        let mut angles = [None; 3];
        for (angle, key) in angles.iter_mut().zip(["spacing", "radius", "gap"]) {
            if let Some(node) = fields.get(key) {
                *angle = Some(self.angle(node, key)?);
            }
        }
        let known = match angles {
            [Some(spacing), Some(radius), Some(gap)] if spacing > 0.0 && radius > 0.0 => {
                Some(Known { spacing, radius, gap })
            }
            [None, None, None] => None,
            _ => {
                let message =
                    format!("[{}] has not all of `spacing`, `radius`, `gap`", fields.label);
                let help = "give all three, spacing and radius above 0, or none";
                self.texts.error(fields.spot, "limit/learned", message, help);
                return None;
            }
        };
        let mut shares = [None; 4];
        for (share, key) in shares.iter_mut().zip(["extreme", "surface", "outer", "valid"]) {
            if let Some(node) = fields.get(key) {
                *share = Some(self.not_negative(node, key)?);
            }
        }
        let mut holes = vec![];
        if let Some(node) = fields.get("holes") {
            for hole in self.list(node, "holes")? {
                let fields =
                    self.table(hole, hole.spot, "holes".into(), &["centre", "radius", "share"]);
                let centre = self.required(&fields, "centre", "a rotation, [x, y, z, w]");
                let centre = centre.and_then(|node| self.rotation_of(node, "centre"));
                let radius = self.required(&fields, "radius", "an angle");
                let radius = radius.and_then(|node| self.angle(node, "radius"));
                let share = self.required(&fields, "share", "a share of all rotations");
                let share = share.and_then(|node| self.not_negative(node, "share"));
                holes.push(Hole { centre: centre?, radius: radius?, share: share? });
            }
        }
        let learned = match (known, shares) {
            (Some(known), [Some(extreme), Some(surface), Some(outer), Some(valid)]) => {
                let Known { spacing, radius, gap } = known;
                Some(Learned { spacing, radius, gap, extreme, surface, outer, valid, holes })
            }
            _ => None,
        };
        Some((known, learned))
    }

    fn samples(&mut self, fields: &Fields<'_>) -> Option<Samples> {
        let rotations = match (fields.get("packed"), fields.get("rotations")) {
            (Some(node), Some(_)) => {
                self.exclusive(node, "packed", "rotations");
                return None;
            }
            (Some(node), None) => {
                let text = self.text(node, "packed")?;
                self.unpacked(&text.text, text.spot)?
            }
            (None, Some(node)) => {
                let list = self.list(node, "rotations")?;
                // Read to the end, so that every error is reported.
                let all: Vec<Option<Quat>> =
                    list.iter().map(|node| self.rotation_of(node, "rotations")).collect();
                all.into_iter().map(|q| q.map(snapped)).collect::<Option<Vec<_>>>()?
            }
            (None, None) => {
                self.missing(fields, "packed", "the rotations, `packed` or as a list `rotations`");
                return None;
            }
        };
        if rotations.is_empty() {
            let message = "there are no rotations".to_owned();
            self.texts.error(fields.spot, "limit/empty", message, "give at least one");
            return None;
        }
        let takes = match fields.get("takes") {
            None => vec![rotations.len() as u32],
            Some(node) => {
                let list = self.list(node, "takes")?;
                let counts: Option<Vec<usize>> =
                    list.iter().map(|node| self.count(node, "takes")).collect();
                let counts = counts?;
                let sum: usize = counts.iter().sum();
                if sum != rotations.len() {
                    let message = format!(
                        "`takes` sum up to {sum}, but there are {} rotations",
                        rotations.len()
                    );
                    self.length(node.spot, message, "give the number of rotations of each take");
                    return None;
                }
                counts.into_iter().map(|count| count as u32).collect()
            }
        };
        let mut names = vec![];
        if let Some(node) = fields.get("names") {
            names = self.names(node, "names").0.into_iter().map(|name| name.text).collect();
            if names.len() != takes.len() {
                let message = format!("there are {} names for {} takes", names.len(), takes.len());
                self.length(node.spot, message, "name each take, or none");
                return None;
            }
        }
        let thinned = match fields.get("thinned") {
            None => 0.0,
            Some(node) => self.angle(node, "thinned")?,
        };
        let chart = match fields.get("axes") {
            None => None,
            Some(node) => {
                let list = self.list(node, "axes")?;
                let sides: Vec<Option<Quat>> =
                    list.iter().map(|node| self.side(node, "axes")).collect();
                let Ok([left, right]) = <[_; 2]>::try_from(sides) else {
                    let message = format!("`axes` has {} rotations", list.len());
                    self.length(node.spot, message, "give [left, right]");
                    return None;
                };
                Some(Chart::of_sides([left?, right?]))
            }
        };
        Some(Samples { rotations, takes, names, thinned, chart })
    }

    /// Rotations in base64.
    fn unpacked(&mut self, text: &str, spot: Spot) -> Option<Vec<Quat>> {
        let wrong = |reader: &mut Self, message: String| {
            let help = "six bytes a rotation, in base64, as condyle writes them";
            reader.texts.error(spot, "limit/packed", message, help);
        };
        let Some(bytes) = base64::decode(text) else {
            wrong(self, "`packed` is no base64".to_owned());
            return None;
        };
        if bytes.len() % 6 != 0 {
            wrong(self, format!("`packed` has {} bytes, which is no multiple of 6", bytes.len()));
            return None;
        }
        let mut rotations = Vec::with_capacity(bytes.len() / 6);
        for (index, six) in bytes.chunks_exact(6).enumerate() {
            let code = std::array::from_fn(|i| {
                let byte = |at: usize| six.get(at).copied().unwrap_or(0);
                u16::from_le_bytes([byte(2 * i), byte(2 * i + 1)])
            });
            let Some(q) = unpacked(code) else {
                wrong(self, format!("rotation {index} of `packed` is none: {code:?}"));
                return None;
            };
            rotations.push(q);
        }
        Some(rotations)
    }

    /// A unit quaternion x, y, z, w.
    pub(super) fn rotation_of(&mut self, node: &Node, label: &str) -> Option<Quat> {
        let q = Quat::from(self.some::<4>(node, label)?);
        self.of_length_one(node, label, q, UNIT).then(|| q.normalized())
    }

    /// One that is taken to the last digit.
    fn side(&mut self, node: &Node, label: &str) -> Option<Quat> {
        let q = Quat::from(self.some::<4>(node, label)?);
        self.of_length_one(node, label, q, 1e-9).then_some(q)
    }

    fn of_length_one(&mut self, node: &Node, label: &str, q: Quat, tolerance: f64) -> bool {
        let length = q.dot(q).sqrt();
        if (length - 1.0).abs() <= tolerance {
            return true;
        }
        let message = format!("a rotation of `{label}` has length {length}, not 1");
        let help = "give a unit quaternion, x, y, z, w";
        self.texts.error(node.spot, "limit/quaternion", message, help);
        false
    }
}

#[cfg(test)]
mod tests;
