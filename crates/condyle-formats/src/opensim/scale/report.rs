//! What was scaled, and what was not.

use std::collections::BTreeMap;

/// What became of the parts of a model file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// The bodies, in the order of the file.
    pub bodies: Vec<ScaledBody>,
    /// How many of each kind of part were multiplied by the factors of their body, 1 included.
    pub scaled: BTreeMap<&'static str, usize>,
    /// Parts that were scaled though OpenSim leaves them: what, and which.
    pub beyond: Vec<(&'static str, String)>,
    /// Parts that were not scaled.
    pub left: Vec<Left>,
    /// Paths that touch a surface that they wrap, in the default pose: their lengths are measured along
    /// straight lines instead.
    pub wrapping: Vec<String>,
}

/// A body.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaledBody {
    /// Its name.
    pub name: String,
    /// Its factors along its axes.
    pub factors: [f64; 3],
    /// Its mass before and after (kilograms); none where the file states none.
    pub mass: Option<[f64; 2]>,
}

/// Something that was not scaled.
#[derive(Clone, Debug, PartialEq)]
pub struct Left {
    /// What it is.
    pub part: String,
    /// Why.
    pub why: &'static str,
}

impl Report {
    pub(super) fn count(&mut self, kind: &'static str) {
        *self.scaled.entry(kind).or_default() += 1;
    }

    pub(super) fn leave(&mut self, part: String, why: &'static str) {
        self.left.push(Left { part, why });
    }

    /// The mass of all bodies before and after (kilograms).
    #[must_use]
    pub fn mass(&self) -> [f64; 2] {
        let masses = || self.bodies.iter().filter_map(|body| body.mass);
        [masses().map(|m| m[0]).sum(), masses().map(|m| m[1]).sum()]
    }

    /// The report as Markdown, for people.
    #[must_use]
    pub fn markdown(&self) -> String {
        let mut text = String::from("| body | x | y | z | mass before (kg) | after |\n");
        text.push_str("| --- | --: | --: | --: | --: | --: |\n");
        for body in &self.bodies {
            let [x, y, z] = body.factors;
            let mass = body.mass.map_or(" |".to_owned(), |[a, b]| format!("{a:.4} | {b:.4}"));
            text.push_str(&format!("| {} | {x:.4} | {y:.4} | {z:.4} | {mass} |\n", body.name));
        }
        let [before, after] = self.mass();
        if before > 0.0 {
            text.push_str(&format!("| all | | | | {before:.4} | {after:.4} |\n"));
        }
        if !self.scaled.is_empty() {
            text.push_str("\nMultiplied by the factors of their body:\n\n");
        }
        for (kind, count) in &self.scaled {
            text.push_str(&format!("- {count} {kind}\n"));
        }
        let mut list = |title: &str, rows: Vec<String>| {
            if !rows.is_empty() {
                text.push_str(&format!("\n{title}\n\n"));
                rows.iter().for_each(|row| text.push_str(&format!("- {row}\n")));
            }
        };
        let beyond = self.beyond.iter().map(|(what, which)| format!("{what}: {which}"));
        list("Scaled, though OpenSim leaves them:", beyond.collect());
        let left = self.left.iter().map(|left| format!("{}: {}", left.part, left.why));
        list("Not scaled:", left.collect());
        list(
            "Wrapped around a surface in the default pose, so that their lengths, measured along \
             straight lines, may be off by some percent:",
            self.wrapping.clone(),
        );
        text
    }
}
