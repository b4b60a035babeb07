//! Documents of kind `setup`: how recordings are tracked.
//!
//! ```text
//! document       = the head of every document, and
//! time           = [first, last] in seconds, either "none"
//! names          = a table of names: a path from the place of the document, or a shipped one
//! weight.M       = the weight of markers: a name of the model, with `*` for any letters; the last one
//!                  that fits counts
//! hold.C         = stiffness, or { stiffness, rest, unit }: a coordinate near a value
//! posture.P      = coordinates = { C = factor }, stiffness, rest, unit: a sum of several
//! coordinate.C   = weight, value, unit: a coordinate that should have a value
//! limits, robust = true|false
//! max_rms        = the largest plausible marker error, in metres
//! loop_weight    = the weight of loops; without it they are closed exactly
//! ```
//!
//! Stiffness and weights of coordinates are m² per rad² (or per m²). Values and rests are radians or
//! metres, or of the `unit` given; without one they are the model's defaults.

use super::fields::{Fields, Reader};
use super::tree::{Entry, Node, Value};
use super::{Form, Kind, read_kind};
use condyle_diagnostics::{Error, Read};

const FORM: Form = Form {
    kind: Kind::Setup,
    keys: &[
        "time",
        "names",
        "weight",
        "hold",
        "posture",
        "coordinate",
        "limits",
        "robust",
        "max_rms",
        "loop_weight",
    ],
    own: &[],
    repeated: &[],
};

/// How recordings are tracked; what is not said is `None` or empty.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct TrackSetup {
    /// First and last time in seconds, either of which may be infinite.
    pub time: Option<[f64; 2]>,
    /// A table of names, as written.
    pub names: Option<String>,
    /// Patterns of marker names with their weights, in the order of the text.
    pub weights: Vec<(String, f64)>,
    /// Coordinates, or sums of several, that rest at a value.
    pub postures: Vec<SetupPosture>,
    /// Coordinates that should have a value.
    pub coordinates: Vec<SetupCoordinate>,
    /// Whether coordinates are held to their enforced ranges.
    pub limits: Option<bool>,
    /// Whether faulty markers are looked for.
    pub robust: Option<bool>,
    /// The largest plausible marker error, in metres.
    pub max_rms: Option<f64>,
    /// The weight of loops.
    pub loop_weight: Option<f64>,
}

/// A sum of coordinates that rests at a value.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupPosture {
    /// The coordinates with their factors.
    pub coordinates: Vec<(String, f64)>,
    /// The value in radians (or metres); `None` for that of the defaults.
    pub rest: Option<f64>,
    /// The stiffness, m² per rad² (or per m²).
    pub stiffness: f64,
}

/// A coordinate that should have a value.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupCoordinate {
    /// Its name.
    pub name: String,
    /// The weight, m² per rad² (or per m²).
    pub weight: f64,
    /// The value in radians or metres; `None` for its default.
    pub value: Option<f64>,
}

/// Reads a setup document. `include` gives the text of another one by its path.
///
/// # Errors
/// Everything that is wrong, in the order of the text.
///
/// ```
/// use condyle_formats::document::setup;
/// let text = r#"
/// condyle = 1
/// kind = "setup"
/// time = [0.5, "none"]
/// [weight]
/// "*" = 1
/// "RTH*" = 0.1
/// [hold]
/// lumbar_bending = 1e-5
/// pelvis_tilt = { stiffness = 1e-6, rest = 10, unit = "deg" }
/// "#;
/// let setup = setup::read(text, &mut |_| Err("it stands alone".into()))?.value;
/// assert_eq!(setup.time, Some([0.5, f64::INFINITY]));
/// assert_eq!(setup.weights[1], ("RTH*".to_owned(), 0.1));
/// assert_eq!(setup.postures[0].rest, None);
/// assert_eq!(setup.postures[1].rest, Some(10f64.to_radians()));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Read<TrackSetup>, Error> {
    read_kind(&FORM, text, include, |mut reader, top| Some(reader.setup(top)))
}

impl Reader<'_> {
    fn setup(&mut self, top: &Fields<'_>) -> TrackSetup {
        let mut setup = TrackSetup {
            time: top.get("time").and_then(|node| self.times(node)),
            names: top.get("names").and_then(|n| self.text(n, "names")).map(|name| name.text),
            limits: top.get("limits").map(|n| self.flag(Some(n), "limits", true)),
            robust: top.get("robust").map(|n| self.flag(Some(n), "robust", false)),
            max_rms: top.get("max_rms").and_then(|n| self.positive(n, "max_rms")),
            loop_weight: top.get("loop_weight").and_then(|n| self.positive(n, "loop_weight")),
            ..TrackSetup::default()
        };
        for entry in top.get("weight").map_or(&[][..], |node| self.entries(node, "weight")) {
            if let Some(weight) = self.not_negative(&entry.node, &entry.key.text) {
                setup.weights.push((entry.key.text.clone(), weight));
            }
        }
        for entry in top.get("hold").map_or(&[][..], |node| self.entries(node, "hold")) {
            let held = self.held(entry);
            setup.postures.extend(held);
        }
        for entry in top.get("posture").map_or(&[][..], |node| self.entries(node, "posture")) {
            let posture = self.posture(entry);
            setup.postures.extend(posture);
        }
        for entry in top.get("coordinate").map_or(&[][..], |node| self.entries(node, "coordinate"))
        {
            let coordinate = self.wanted(entry);
            setup.coordinates.extend(coordinate);
        }
        setup
    }

    fn times(&mut self, node: &Node) -> Option<[f64; 2]> {
        let [first, last] = self.list(node, "time")? else {
            self.length(node.spot, "`time` is no pair".to_owned(), "give [first, last]");
            return None;
        };
        let mut side = |node: &Node, open: f64| match &node.value {
            Value::Text(text) if text == "none" => Some(open),
            _ => self.number(node, "time"),
        };
        let [first, last] = [side(first, f64::NEG_INFINITY), side(last, f64::INFINITY)];
        let (first, last) = first.zip(last)?;
        if first > last {
            let message = format!("no time lies between {first} and {last}");
            self.texts.error(node.spot, "setup/time", message, "give [first, last]");
        }
        Some([first, last])
    }

    /// A coordinate that is held: its stiffness, or a table.
    fn held(&mut self, entry: &Entry) -> Option<SetupPosture> {
        let name = &entry.key.text;
        let coordinates = vec![(name.clone(), 1.0)];
        if !matches!(entry.node.value, Value::Table(_)) {
            let stiffness = self.positive(&entry.node, name)?;
            return Some(SetupPosture { coordinates, rest: None, stiffness });
        }
        let known = ["stiffness", "rest", "unit"];
        let fields = self.table(&entry.node, entry.key.spot, format!("hold.{name}"), &known);
        let (stiffness, rest) = (self.stiffness(&fields), self.value(&fields, "rest"));
        Some(SetupPosture { coordinates, rest, stiffness: stiffness? })
    }

    fn posture(&mut self, entry: &Entry) -> Option<SetupPosture> {
        let label = format!("posture.{}", entry.key.text);
        let known = ["coordinates", "stiffness", "rest", "unit"];
        let fields = self.table(&entry.node, entry.key.spot, label, &known);
        let (stiffness, rest) = (self.stiffness(&fields), self.value(&fields, "rest"));
        let node =
            self.required(&fields, "coordinates", "names with factors, such as { a = 1 }")?;
        let mut coordinates = vec![];
        for entry in self.entries(node, "coordinates") {
            if let Some(factor) = self.number(&entry.node, &entry.key.text) {
                coordinates.push((entry.key.text.clone(), factor));
            }
        }
        if coordinates.is_empty() {
            let message = "`coordinates` names none".to_owned();
            let help = "give names with factors, such as { a = 1 }";
            self.texts.error(node.spot, "setup/posture", message, help);
        }
        Some(SetupPosture { coordinates, rest, stiffness: stiffness? })
    }

    fn wanted(&mut self, entry: &Entry) -> Option<SetupCoordinate> {
        let name = entry.key.text.clone();
        let known = ["weight", "value", "unit"];
        let fields = self.table(&entry.node, entry.key.spot, format!("coordinate.{name}"), &known);
        let value = self.value(&fields, "value");
        let weight = self.required(&fields, "weight", "a number of 0 or more")?;
        Some(SetupCoordinate { name, weight: self.not_negative(weight, "weight")?, value })
    }

    fn stiffness(&mut self, fields: &Fields<'_>) -> Option<f64> {
        let node = self.required(fields, "stiffness", "a number above 0, such as 1e-5")?;
        self.positive(node, "stiffness")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setup(inside: &str) -> Result<TrackSetup, Error> {
        let text = format!("condyle = 1\nkind = \"setup\"\n{inside}");
        read(&text, &mut |_| Err("it stands alone".into())).map(|read| read.value)
    }

    #[test]
    fn all_that_can_be_said_is_read() {
        let read = setup(
            "names = \"cmu\"\nlimits = false\nrobust = true\nmax_rms = 0.05\nloop_weight = 20\n\
             [posture.rhythm]\ncoordinates = { a = 2.4, b = -0.5 }\nstiffness = 3e-5\n\
             [coordinate.knee]\nweight = 10\nvalue = 90\nunit = \"deg\"\n\
             [coordinate.hip]\nweight = 1\n",
        );
        let at = |name: &str, weight, value| SetupCoordinate { name: name.into(), weight, value };
        let expected = TrackSetup {
            names: Some("cmu".into()),
            limits: Some(false),
            robust: Some(true),
            max_rms: Some(0.05),
            loop_weight: Some(20.0),
            postures: vec![SetupPosture {
                coordinates: vec![("a".into(), 2.4), ("b".into(), -0.5)],
                rest: None,
                stiffness: 3e-5,
            }],
            coordinates: vec![at("knee", 10.0, Some(90f64.to_radians())), at("hip", 1.0, None)],
            ..TrackSetup::default()
        };
        assert_eq!(read.unwrap(), expected);
        assert_eq!(setup("").unwrap(), TrackSetup::default());
    }

    #[test]
    fn faults_are_placed() {
        for (text, said) in [
            ("time = [2, 1]", "line 3, column 8: no time lies between 2 and 1"),
            ("time = [2]", "line 3, column 8: `time` is no pair"),
            ("wieght = 1", "line 3, column 1: unknown key `wieght` (did you mean `weight`?)"),
            ("[weight]\na = -1", "line 4, column 5: `a` is -1 (give a number of 0 or more)"),
            ("[hold]\na = 0", "line 4, column 5: `a` is 0 (give a number above 0)"),
            ("[hold.a]\nrest = 1", "line 3, column 7: [hold.a] has no `stiffness`"),
            (
                "angles = \"deg\"\n[hold.a]\nstiffness = 1\nrest = 9",
                "line 6, column 8: `rest` has no unit",
            ),
            (
                "[posture.p]\nstiffness = 1\ncoordinates = {}",
                "line 5, column 15: `coordinates` names none",
            ),
            ("[posture.p]\nstiffness = 1", "line 3, column 10: [posture.p] has no `coordinates`"),
        ] {
            let error = setup(text).unwrap_err().to_string();
            assert!(error.starts_with(said), "{error}");
        }
    }
}
