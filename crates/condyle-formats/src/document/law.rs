//! Documents of kind `law`: how coordinates follow others, learned from recordings.
//!
//! ```text
//! document    = the head of every document, and
//! control     = the coordinates in control, in the order in which functions take them
//! kinds       = what they are: "rotation", "translation", "other" or "" where it is not known
//! source      = where the frames come from
//! frames      = the model and the joint whose coordinates they are
//! [region]    = where the controls were: low, high, centre, inverse, distance
//! [law.D]     = the law of coordinate D:
//! function    = { slopes, intercept } | { dimension, order, coefficients }, or
//! intercept, parts = a constant and one function for each control
//! kind        = what D is
//! ci95        = { intercept = [low, high], TERM = [low, high] }
//! r2, rmse, left_out_rmse, mean_left_out_rmse, accepted   = how far it can be believed
//! [learning]  = basis, ridge, terms, dropped, condition, trials: how it was learned
//! [joint]     = the joint's landmarks and names, as [law] in a document of kind `landmarks`
//! ```
//!
//! Numbers are in radians and metres. Only `control` and a function for each law must be given, so that a law from a paper
//! is a document of a few lines.

use super::fields::{Fields, Reader};
use super::landmarks::law_frame_lines;
use super::model::{function, number, numbers, several_of, text};
use super::region::region_lines;
use super::tree::Node;
use super::{Form, Kind, read_kind};
use condyle_diagnostics::{Error, Read};
use condyle_learn::coupling::{Basis, Law, LawFunction, Laws};
use condyle_learn::transfer::LawFrame;
use condyle_model::CoordinateKind;
use condyle_model::component::Region;
use std::fmt::Write;

const FORM: Form = Form {
    kind: Kind::Law,
    keys: &["control", "kinds", "source", "frames", "region", "law", "learning", "joint"],
    own: &[],
    repeated: &[],
};

const KINDS: [(&str, Option<CoordinateKind>); 4] = [
    ("rotation", Some(CoordinateKind::Rotation)),
    ("translation", Some(CoordinateKind::Translation)),
    ("other", Some(CoordinateKind::Other)),
    ("", None),
];

/// A law that was read from a document.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenLaw {
    /// The coordinate that follows.
    pub dependent: String,
    /// What it is, where that is known.
    pub kind: Option<CoordinateKind>,
    /// Its value from the controls.
    pub function: LawFunction,
    /// Intervals of 95 %, by the names of terms.
    pub ci95: Vec<(String, [f64; 2])>,
    /// The share of variance that it explains; NaN where that is not said.
    pub r2: f64,
    /// The root mean square error on the frames that it was learned from; NaN where that is not said.
    pub rmse: f64,
    /// The same on trials that were left out; NaN where that is not said.
    pub left_out_rmse: f64,
    /// The same of the mean of the other trials; NaN where that is not said.
    pub mean_left_out_rmse: f64,
    /// Whether it predicts trials that were left out better than their mean, beyond chance; `None` where that is not said.
    pub accepted: Option<bool>,
}

/// A document of laws.
#[derive(Clone, Debug, PartialEq)]
pub struct LawDocument {
    /// A name.
    pub name: String,
    /// Where the frames come from.
    pub source: String,
    /// The model and the joint whose coordinates they are.
    pub frames: String,
    /// The coordinates in control.
    pub controls: Vec<String>,
    /// What they are, where that is known.
    pub kinds: Vec<Option<CoordinateKind>>,
    /// Where the controls were; `None` where that is not said.
    pub region: Option<Region>,
    /// The laws.
    pub laws: Vec<WrittenLaw>,
    /// The terms, by name; of documents that people write empty.
    pub terms: Vec<String>,
    /// Terms that are sums of others in the data.
    pub dropped: Vec<String>,
    /// How the terms were chosen.
    pub basis: Basis,
    /// The joint's landmarks, and which coordinates are its angles and translations.
    pub joint: Option<LawFrame>,
    /// The ridge.
    pub ridge: f64,
    /// The condition number; NaN where it is not said.
    pub condition: f64,
    /// The names of the trials, and how many frames of each were used.
    pub trials: Vec<(String, usize)>,
}

impl From<&Laws> for LawDocument {
    fn from(laws: &Laws) -> Self {
        let law = |law: &Law| {
            let finite = |[low, high]: &[f64; 2]| low.is_finite() && high.is_finite();
            let named = std::iter::once("intercept").chain(laws.terms.iter().map(String::as_str));
            let intervals = named.zip(&law.ci95).filter(|(_, ends)| finite(ends));
            WrittenLaw {
                dependent: law.dependent.clone(),
                kind: law.kind,
                function: law.function.clone(),
                ci95: intervals.map(|(name, ends)| (name.to_owned(), *ends)).collect(),
                r2: law.r2,
                rmse: law.rmse,
                left_out_rmse: law.left_out.as_ref().map_or(f64::NAN, |left| left.rmse),
                mean_left_out_rmse: law.left_out.as_ref().map_or(f64::NAN, |l| l.rmse_of_mean),
                accepted: Some(law.accepted()),
            }
        };
        Self {
            name: laws.about.name.clone(),
            source: laws.about.source.clone(),
            frames: laws.about.frames.clone(),
            controls: laws.controls.clone(),
            kinds: laws.kinds.clone(),
            region: Some(laws.region.clone()),
            laws: laws.laws.iter().map(law).collect(),
            terms: laws.terms.clone(),
            dropped: laws.dropped.iter().map(|(name, _)| name.clone()).collect(),
            basis: laws.basis,
            joint: None,
            ridge: laws.ridge,
            condition: laws.condition,
            trials: laws.trials.iter().map(|trial| (trial.name.clone(), trial.frames)).collect(),
        }
    }
}

/// Reads laws. `include` gives the text of another document by its path.
///
/// # Errors
/// Everything that is wrong, in the order of the text.
///
/// ```
/// use condyle_formats::document::law;
/// // Table 1 of Pronost et al. 2010 has such rows: metres per radian, and the constant.
/// let text = r#"
/// condyle = 1
/// kind = "law"
/// control = ["adduction", "flexion", "rotation"]
/// [law.tx]
/// function = { slopes = [0.005, 0.035, -0.012], intercept = 0.048 }
/// "#;
/// let read = law::read(text, &mut |_| Err("it stands alone".into()))?.value;
/// assert_eq!(read.laws[0].function.value(&[0.0, 1.0, 0.0]), 0.048 + 0.035);
/// // Written and read again it is the same function.
/// let again = law::read(&law::write(&read), &mut |_| Err("it stands alone".into()))?.value;
/// assert_eq!(again.laws[0].function, read.laws[0].function);
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(
    text: &str,
    include: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Read<LawDocument>, Error> {
    read_kind(&FORM, text, include, |mut reader, top| reader.laws(top))
}

impl Reader<'_> {
    fn said(&mut self, fields: &Fields<'_>, key: &str) -> Option<String> {
        let Some(node) = fields.get(key) else { return Some(String::new()) };
        self.text(node, key).map(|name| name.text)
    }

    /// A number that may be left out.
    fn perhaps(&mut self, fields: &Fields<'_>, key: &str) -> Option<f64> {
        self.number_or(fields, key, f64::NAN)
    }

    fn kind_of(&mut self, node: &Node, label: &str) -> Option<Option<CoordinateKind>> {
        let name = self.text(node, label)?;
        let found = KINDS.iter().find(|(word, _)| *word == name.text);
        if found.is_none() {
            let message = format!("unknown kind of coordinate `{}`", name.text);
            let help = "give \"rotation\", \"translation\", \"other\" or \"\"";
            self.texts.error(name.spot, "law/kind", message, help);
        }
        found.map(|(_, kind)| *kind)
    }

    fn laws(&mut self, top: &Fields<'_>) -> Option<LawDocument> {
        let [name, source, frames] = ["name", "source", "frames"].map(|key| self.said(top, key));
        let control =
            self.required(top, "control", "the coordinates in control, such as [\"flexion\"]");
        let controls: Option<Vec<String>> = control.and_then(|node| {
            let (names, _) = self.names(node, "control");
            if names.is_empty() {
                self.length(node.spot, "`control` names nothing".to_owned(), "name a coordinate");
                return None;
            }
            Some(names.into_iter().map(|name| name.text).collect())
        });
        let controls = controls?;
        let kinds = match top.get("kinds") {
            None => Some(vec![None; controls.len()]),
            Some(node) => self.list(node, "kinds").and_then(|list| {
                let kinds: Vec<_> = list.iter().map(|node| self.kind_of(node, "kinds")).collect();
                let kinds: Vec<Option<CoordinateKind>> =
                    kinds.into_iter().collect::<Option<_>>()?;
                if kinds.len() != controls.len() {
                    let message = format!("`kinds` has {} names", kinds.len());
                    self.length(node.spot, message, format!("give {}", controls.len()));
                    return None;
                }
                Some(kinds)
            }),
        };
        let region = match top.get("region") {
            None => Some(None),
            Some(node) => self.region(node, "region", controls.len()).map(Some),
        };
        let joint = match top.get("joint") {
            None => Some(None),
            Some(node) => self.law_frame(node, "joint").map(Some),
        };
        let Some(table) = top.get("law") else {
            self.missing(top, "law", "a table [law.D] for a coordinate D that follows");
            return None;
        };
        let entries = self.entries(table, "law");
        let mut laws = vec![];
        for entry in entries {
            laws.push(self.written_law(&entry.node, &entry.key.text, controls.len()));
        }
        let learning = match top.get("learning") {
            Some(node) => {
                let known = ["basis", "ridge", "terms", "dropped", "condition", "trials"];
                Some(self.table(node, node.spot, "learning".to_owned(), &known))
            }
            None => None,
        };
        let mut document = LawDocument {
            name: name?,
            source: source?,
            frames: frames?,
            kinds: kinds?,
            region: region?,
            laws: laws.into_iter().collect::<Option<_>>()?,
            controls,
            terms: vec![],
            dropped: vec![],
            basis: Basis::Linear,
            joint: joint?,
            ridge: 0.0,
            condition: f64::NAN,
            trials: vec![],
        };
        if let Some(fields) = learning {
            document.ridge = self.number_or(&fields, "ridge", 0.0)?;
            document.condition = self.perhaps(&fields, "condition")?;
            let named = |reader: &mut Self, key| -> Vec<String> {
                let node = fields.get(key);
                let names = node.map(|node| reader.names(node, key).0).unwrap_or_default();
                names.into_iter().map(|name| name.text).collect()
            };
            document.terms = named(self, "terms");
            document.dropped = named(self, "dropped");
            if let Some(node) = fields.get("basis") {
                let name = self.text(node, "basis")?;
                let Some(basis) = Basis::named(&name.text) else {
                    let message = format!("unknown basis `{}`", name.text);
                    let help =
                        "give linear, polynomial:2 to polynomial:6, or spline:3 to spline:20";
                    self.texts.error(name.spot, "law/basis", message, help);
                    return None;
                };
                document.basis = basis;
            }
            if let Some(node) = fields.get("trials") {
                for entry in self.entries(node, "trials") {
                    let count = self.count(&entry.node, &entry.key.text)?;
                    document.trials.push((entry.key.text.clone(), count));
                }
            }
        }
        Some(document)
    }

    fn written_law(&mut self, node: &Node, name: &str, controls: usize) -> Option<WrittenLaw> {
        let known = [
            "function",
            "intercept",
            "parts",
            "kind",
            "ci95",
            "r2",
            "rmse",
            "left_out_rmse",
            "mean_left_out_rmse",
            "accepted",
        ];
        let fields = self.table(node, node.spot, format!("law.{name}"), &known);
        let function = match (fields.get("function"), fields.get("parts")) {
            (Some(_), Some(parts)) => {
                self.exclusive(parts, "function", "parts");
                return None;
            }
            (Some(node), None) => {
                let function = self.several(node, "function")?;
                if function.arity() != controls {
                    let message = format!("`function` takes {} numbers", function.arity());
                    self.length(node.spot, message, format!("`control` names {controls}"));
                    return None;
                }
                LawFunction::Several(function)
            }
            (None, Some(node)) => {
                let intercept = self.number_or(&fields, "intercept", 0.0)?;
                let list = self.list(node, "parts")?;
                let parts: Vec<_> = list.iter().map(|node| self.function(node, "parts")).collect();
                if parts.len() != controls {
                    let message = format!("`parts` has {} functions", parts.len());
                    self.length(
                        node.spot,
                        message,
                        format!("give {controls}, one for each control"),
                    );
                    return None;
                }
                LawFunction::Sum { intercept, parts: parts.into_iter().collect::<Option<_>>()? }
            }
            (None, None) => {
                self.missing(&fields, "function", "{ slopes = [...], intercept = 0 }");
                return None;
            }
        };
        let kind = match fields.get("kind") {
            Some(node) => self.kind_of(node, "kind")?,
            None => None,
        };
        let mut ci95 = vec![];
        if let Some(node) = fields.get("ci95") {
            for entry in self.entries(node, "ci95") {
                ci95.push((entry.key.text.clone(), self.some::<2>(&entry.node, &entry.key.text)?));
            }
        }
        let accepted = fields.get("accepted").map(|node| self.flag(Some(node), "accepted", false));
        Some(WrittenLaw {
            dependent: name.to_owned(),
            kind,
            function,
            ci95,
            r2: self.perhaps(&fields, "r2")?,
            rmse: self.perhaps(&fields, "rmse")?,
            left_out_rmse: self.perhaps(&fields, "left_out_rmse")?,
            mean_left_out_rmse: self.perhaps(&fields, "mean_left_out_rmse")?,
            accepted,
        })
    }
}

/// Writes laws; what was read and is written again is the same text.
#[must_use]
pub fn write(laws: &LawDocument) -> String {
    let mut out = String::from("condyle = 1\nkind = \"law\"\n");
    for (key, value) in [("name", &laws.name), ("source", &laws.source), ("frames", &laws.frames)] {
        if !value.is_empty() {
            let _ = writeln!(out, "{key} = {}", text(value));
        }
    }
    let list = |names: &[String]| {
        let names: Vec<String> = names.iter().map(|name| text(name)).collect();
        format!("[{}]", names.join(", "))
    };
    let word = |kind| KINDS.iter().find(|(_, k)| *k == kind).map_or("", |(word, _)| *word);
    let _ = writeln!(out, "control = {}", list(&laws.controls));
    if laws.kinds.iter().any(Option::is_some) {
        let kinds: Vec<String> = laws.kinds.iter().map(|kind| word(*kind).to_owned()).collect();
        let _ = writeln!(out, "kinds = {}", list(&kinds));
    }
    for law in &laws.laws {
        let _ = writeln!(out, "\n[law.{}]", key(&law.dependent));
        if law.kind.is_some() {
            let _ = writeln!(out, "kind = \"{}\"", word(law.kind));
        }
        match &law.function {
            LawFunction::Several(function) => {
                let _ = writeln!(out, "function = {}", several_of(function));
            }
            LawFunction::Sum { intercept, parts } => {
                let _ = writeln!(out, "intercept = {}", number(*intercept));
                let parts: Vec<String> = parts.iter().map(function).collect();
                let _ = writeln!(out, "parts = [{}]", parts.join(", "));
            }
        }
        for (key, value) in [
            ("r2", law.r2),
            ("rmse", law.rmse),
            ("left_out_rmse", law.left_out_rmse),
            ("mean_left_out_rmse", law.mean_left_out_rmse),
        ] {
            if value.is_finite() {
                let _ = writeln!(out, "{key} = {}", number(value));
            }
        }
        if let Some(accepted) = law.accepted {
            let _ = writeln!(out, "accepted = {accepted}");
        }
        if !law.ci95.is_empty() {
            let one =
                |(name, ends): &(String, [f64; 2])| format!("{} = {}", key(name), numbers(ends));
            let all: Vec<String> = law.ci95.iter().map(one).collect();
            let _ = writeln!(out, "ci95 = {{ {} }}", all.join(", "));
        }
    }
    if let Some(region) = &laws.region {
        out.push_str("\n[region]\n");
        for line in region_lines(region) {
            let _ = writeln!(out, "{line}");
        }
    }
    if let Some(joint) = &laws.joint {
        let _ = write!(out, "\n[joint]\n{}", law_frame_lines(joint));
    }
    let learned = !laws.terms.is_empty() || !laws.trials.is_empty() || laws.condition.is_finite();
    if learned {
        out.push_str("\n[learning]\n");
        let _ = writeln!(out, "basis = \"{}\"", laws.basis.name());
        let _ = writeln!(out, "ridge = {}", number(laws.ridge));
        let _ = writeln!(out, "terms = {}", list(&laws.terms));
        if !laws.dropped.is_empty() {
            let _ = writeln!(out, "dropped = {}", list(&laws.dropped));
        }
        if laws.condition.is_finite() {
            let _ = writeln!(out, "condition = {}", number(laws.condition));
        }
        if !laws.trials.is_empty() {
            out.push_str("\n[learning.trials] # frames of each\n");
            for (name, frames) in &laws.trials {
                let _ = writeln!(out, "{} = {frames}", key(name));
            }
        }
    }
    out
}

/// A key, in quotes where it needs them.
fn key(name: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(plain) { name.to_owned() } else { text(name) }
}

#[cfg(test)]
mod tests;
