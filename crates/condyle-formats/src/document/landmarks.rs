//! Documents of kind `landmarks`: where a law's landmarks are, and which joint of another figure it is carried to.
//!
//! ```text
//! document  = the head of every document, and
//! [law]     = the law's side; it may stand as [joint] in the document of the law instead:
//! origin, medial, lateral = points in the axes in which the law's translations are (metres)
//! side      = "right" or "left"; right if not given
//! order     = the order of the rotations; zxy if not given
//! angles    = their names in the law, in that order; flexion, adduction, rotation if not given
//! centre    = along x, y and z: the names of the translations that follow, or numbers (metres); tx, ty, tz if not given
//! [target]  = the other figure's side:
//! joint     = the segment that the joint moves, or the joint
//! origin, medial, lateral = a marker's or a segment's name | [x, y, z] in the parent's axes
//!             | { near = segment, by = [x, y, z] }, a step along the axes of the world in the zero posture (metres)
//! side      = as above
//! zero      = the posture in which the law's angles are 0: { coordinate = angle, or [x, y, z, w] }; defaults if not given
//! drivers   = { control of another joint = the target's coordinate }; the same names if not given
//! holds     = true: the joint stays where the target has it while all is 0, and the law says how it travels
//! ```
//!
//! Names of angles and translations may be the ends of the law's: `knee_r_flexion` is `flexion`.

use super::fields::{Fields, Reader};
use super::model::{number, numbers, text};
use super::tree::{Node, Value};
use super::{Form, Kind, read_kind};
use condyle_diagnostics::{Error, Read};
use condyle_learn::transfer::{Along, LandmarkPlace, Landmarks, LawFrame, TargetJoint};
use std::fmt::Write;

const FORM: Form =
    Form { kind: Kind::Landmarks, keys: &["law", "target"], own: &[], repeated: &[] };
const SIDES: [(&str, bool); 2] = [("right", false), ("left", true)];
const WANTED: &str = "a point [x, y, z] in metres";

/// Where a law is carried to.
#[derive(Clone, Debug, PartialEq)]
pub struct LandmarksDocument {
    /// The law's side; `None` where the document of the law says it.
    pub law: Option<LawFrame>,
    /// The other figure's side.
    pub target: TargetJoint,
}

/// Reads landmarks. `include` gives the text of another document by its path.
///
/// # Errors
/// Everything that is wrong, in the order of the text.
///
/// ```
/// use condyle_formats::document::landmarks;
/// use condyle_learn::transfer::LandmarkPlace;
/// let text = r#"
/// condyle = 1
/// kind = "landmarks"
/// [law]
/// origin = [0, 0, 0]
/// medial = [0, -0.41, -0.05]
/// lateral = [0, -0.41, 0.05]
/// [target]
/// joint = "LeftLeg"
/// side = "left"
/// origin = { near = "LeftUpLeg", by = [-0.08, 0, 0] }
/// medial = { near = "LeftLeg", by = [0.05, 0, 0] }
/// lateral = { near = "LeftLeg", by = [-0.05, 0, 0] }
/// "#;
/// let read = landmarks::read(text, &mut |_| Err("it stands alone".into()))?.value;
/// assert!(read.target.left && !read.law.as_ref().unwrap().landmarks.left);
/// assert_eq!(read.law.unwrap().angles, ["flexion", "adduction", "rotation"]);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Read<LandmarksDocument>, Error> {
    read_kind(&FORM, text, include, |mut reader, top| {
        let law = match top.get("law") {
            None => Some(None),
            Some(node) => reader.law_frame(node, "law").map(Some),
        };
        let target = reader.required(top, "target", "a table [target]");
        let target = target.and_then(|node| reader.target_joint(node));
        Some(LandmarksDocument { law: law?, target: target? })
    })
}

impl Reader<'_> {
    /// The law's side of a transfer.
    pub(super) fn law_frame(&mut self, node: &Node, label: &str) -> Option<LawFrame> {
        let known = ["origin", "medial", "lateral", "side", "order", "angles", "centre"];
        let fields = self.table(node, node.spot, label.to_owned(), &known);
        let origin = self.required_vector(&fields, "origin", WANTED);
        let medial = self.required_vector(&fields, "medial", WANTED);
        let lateral = self.required_vector(&fields, "lateral", WANTED);
        let left = self.word(&fields, "side", &SIDES);
        let order = match fields.get("order") {
            Some(node) => self.order(node, "order"),
            None => "zxy".parse().ok(),
        };
        let angles = match fields.get("angles") {
            None => Some(["flexion", "adduction", "rotation"].map(str::to_owned)),
            Some(node) => self.three_of(node, "angles").map(|names| names.map(|n| n.to_owned())),
        };
        let centre = match fields.get("centre") {
            None => Some(["tx", "ty", "tz"].map(|name| Along::Follows(name.to_owned()))),
            Some(node) => self.centre_of(node),
        };
        let landmarks =
            Landmarks { origin: origin?, medial: medial?, lateral: lateral?, left: left? };
        Some(LawFrame { landmarks, order: order?, angles: angles?, centre: centre? })
    }

    fn three_of(&mut self, node: &Node, label: &str) -> Option<[String; 3]> {
        let (names, _) = self.names(node, label);
        let names: Vec<String> = names.into_iter().map(|name| name.text).collect();
        let count = names.len();
        let three = names.try_into().ok();
        if three.is_none() {
            self.length(node.spot, format!("`{label}` has {count} names"), "give 3");
        }
        three
    }

    fn centre_of(&mut self, node: &Node) -> Option<[Along; 3]> {
        let list = self.list(node, "centre")?;
        let mut all = vec![];
        for node in list {
            all.push(match &node.value {
                Value::Text(name) => Along::Follows(name.clone()),
                _ => Along::Fixed(self.number(node, "centre")?),
            });
        }
        let count = all.len();
        let three = all.try_into().ok();
        if three.is_none() {
            let message = format!("`centre` has {count} parts");
            self.length(node.spot, message, "give 3: along x, y and z, a name or a number each");
        }
        three
    }

    fn target_joint(&mut self, node: &Node) -> Option<TargetJoint> {
        let known = ["joint", "origin", "medial", "lateral", "side", "zero", "drivers", "holds"];
        let fields = self.table(node, node.spot, "target".to_owned(), &known);
        let joint = self.required(&fields, "joint", "the name of the segment that it moves");
        let joint = joint.and_then(|node| self.text(node, "joint"));
        let [origin, medial, lateral] =
            ["origin", "medial", "lateral"].map(|key| self.landmark_place(&fields, key));
        let left = self.word(&fields, "side", &SIDES);
        let mut zero = vec![];
        for entry in fields.get("zero").map_or(&[][..], |node| self.entries(node, "zero")) {
            let values = match &entry.node.value {
                // Quaternions are rounded in texts.
                Value::List(_) => {
                    let q = self.some::<4>(&entry.node, &entry.key.text)?;
                    let size = q.iter().map(|x| x * x).sum::<f64>().sqrt();
                    if (size - 1.0).abs() > 0.01 {
                        let message = format!("`{}` is no quaternion of length 1", entry.key.text);
                        let help = "give x, y, z, w";
                        self.texts.error(entry.node.spot, "landmarks/zero", message, help);
                        return None;
                    }
                    q.map(|x| x / size).to_vec()
                }
                _ => {
                    let unit = self.angle_unit(entry.node.spot);
                    vec![unit * self.number(&entry.node, &entry.key.text)?]
                }
            };
            zero.push((entry.key.text.clone(), values));
        }
        let mut drivers = vec![];
        for entry in fields.get("drivers").map_or(&[][..], |node| self.entries(node, "drivers")) {
            let name = self.text(&entry.node, &entry.key.text)?;
            drivers.push((entry.key.text.clone(), name.text));
        }
        let holds = self.flag(fields.get("holds"), "holds", false);
        let places = [origin?, medial?, lateral?];
        Some(TargetJoint { joint: joint?.text, places, left: left?, zero, drivers, holds })
    }

    fn landmark_place(&mut self, fields: &Fields<'_>, key: &str) -> Option<LandmarkPlace> {
        let wanted = "a marker's name, a point [x, y, z] of the parent, or { near = SEGMENT, by = [x, y, z] }";
        let node = self.required(fields, key, wanted)?;
        match &node.value {
            Value::Text(name) => Some(LandmarkPlace::Named(name.clone())),
            Value::Table(_) => {
                let near = self.table(node, node.spot, key.to_owned(), &["near", "by"]);
                let segment = self.required(&near, "near", "the name of a segment");
                let segment = segment.and_then(|node| self.text(node, "near"));
                let by = self.required_vector(&near, "by", "a step [x, y, z] in metres");
                Some(LandmarkPlace::Near { segment: segment?.text, by: by? })
            }
            _ => self.vector(node, key).map(LandmarkPlace::InParent),
        }
    }
}

/// The lines of a law's side.
pub(super) fn law_frame_lines(frame: &LawFrame) -> String {
    let mut out = String::new();
    let points = ["origin", "medial", "lateral"].into_iter().zip(frame.landmarks.points());
    for (key, point) in points {
        let _ = writeln!(out, "{key} = {}", numbers(&point.to_array()));
    }
    let side = if frame.landmarks.left { "left" } else { "right" };
    let order: String =
        frame.order.axes().iter().filter_map(|axis| "xyz".chars().nth(*axis)).collect();
    let _ = writeln!(out, "side = \"{side}\"\norder = \"{order}\"");
    let angles: Vec<String> = frame.angles.iter().map(|name| text(name)).collect();
    let _ = writeln!(out, "angles = [{}]", angles.join(", "));
    let centre = frame.centre.iter().map(|along| match along {
        Along::Follows(name) => text(name),
        Along::Fixed(place) => number(*place),
    });
    let _ = writeln!(out, "centre = [{}]", centre.collect::<Vec<_>>().join(", "));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_placed() {
        let law = "[law]\norigin = [0,0,0]\nmedial = [0,-0.4,-0.05]\nlateral = [0,-0.4,0.05]\n";
        let target =
            "[target]\njoint = \"knee\"\norigin = \"GT\"\nmedial = [0,1,2]\nlateral = \"LE\"\n";
        for (inside, said) in [
            (law.to_owned(), "[] has no `target`"),
            (format!("{law}angles = [\"a\"]\n{target}"), "`angles` has 1 names"),
            (format!("{law}centre = [\"a\", 1]\n{target}"), "`centre` has 2 parts"),
            (format!("{target}medial2 = 1\n"), "unknown key `medial2`"),
            (format!("{target}side = \"middle\"\n"), "unknown value `middle` of `side`"),
            ("[target]\njoint = \"k\"\n".to_owned(), "[target] has no `origin`"),
        ] {
            let text = format!("condyle = 1\nkind = \"landmarks\"\n{inside}");
            let error = read(&text, &mut |_| Err("it stands alone".into())).unwrap_err();
            assert!(error.to_string().contains(said), "{error}");
        }
    }
}
