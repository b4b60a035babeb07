//! What is asked of a tracking, by names.

use condyle_diagnostics::{Diagnostic, Error, did_you_mean};
use condyle_model::{CoordinateId, Model};
use condyle_motion::{BLANK, Motion, Table};
use condyle_track::{CoordinateTarget, PostureTarget, Targets, Wanted};
use std::collections::HashMap;

/// How a recording is tracked.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Weights by marker name; `None` gives every marker that model and recording share weight 1.
    pub marker_weights: Option<HashMap<String, f64>>,
    /// Weights that replace those, by patterns of marker names of the model: `*` is any letters, and of
    /// several patterns that fit one marker the last counts.
    pub weights: Vec<(String, f64)>,
    /// What labels of the recording are called in the model, the likeliest first; of these names the
    /// first that the model has is taken.
    pub names: Vec<(String, Vec<String>)>,
    /// Whose markers are meant, where the labels of several people differ by a prefix.
    pub subject: Option<String>,
    /// Coordinates that should have a value.
    pub coordinates: Vec<CoordinateRequest>,
    /// Coordinates, or sums of several, that are held near a rest value.
    pub postures: Vec<PostureRequest>,
    /// Where the values of [`CoordinateValue::PerTime`] are taken from: columns named after coordinates.
    pub coordinate_values: Option<Table>,
    /// First and last time, in seconds.
    pub time_range: Option<[f64; 2]>,
    /// Weight of squared loop errors; infinite closes loops exactly.
    pub closure_weight: f64,
    /// Hold coordinates to their enforced ranges.
    pub limits: bool,
    /// Put exchanged labels right, and leave markers out where they cannot be.
    pub robust: bool,
    /// The largest RMS of marker errors that is plausible, in metres: 0.1, since a model that is not
    /// scaled to its person is at 0.06 to 0.07.
    pub max_rms: f64,
    /// Threads; `None` for as many as there are cores.
    pub threads: Option<usize>,
}

/// A coordinate that should have a value: `weight (q - value)²` is added to F.
#[derive(Clone, Debug, PartialEq)]
pub struct CoordinateRequest {
    /// Its name in the model.
    pub name: String,
    /// The weight, m² per rad² (or per m²).
    pub weight: f64,
    /// The value.
    pub value: CoordinateValue,
}

/// The value that a coordinate should have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoordinateValue {
    /// Its default in the model.
    Default,
    /// The same in every frame, in radians or metres.
    Constant(f64),
    /// The value at the time of each frame in [`Request::coordinate_values`].
    PerTime,
}

/// A sum of coordinates that rests at a value: `stiffness (Σ factor q - rest)²` is minimised beside F
/// and reported apart from it.
#[derive(Clone, Debug, PartialEq)]
pub struct PostureRequest {
    /// The coordinates by name, each with its factor.
    pub coordinates: Vec<(String, f64)>,
    /// The value at rest, in radians (or metres); `None` for that of the model's defaults.
    pub rest: Option<f64>,
    /// The stiffness, m² per rad² (or per m²): with 1e-5 a radian weighs as much as 3.2 mm RMS.
    pub stiffness: f64,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            marker_weights: None,
            weights: vec![],
            names: vec![],
            subject: None,
            coordinates: vec![],
            postures: vec![],
            coordinate_values: None,
            time_range: None,
            closure_weight: f64::INFINITY,
            limits: true,
            robust: false,
            max_rms: 0.1,
            threads: None,
        }
    }
}

impl Request {
    /// Whether a coordinate should follow [`Request::coordinate_values`].
    pub fn wants_values(&self) -> bool {
        self.coordinates.iter().any(|c| c.value == CoordinateValue::PerTime)
    }

    /// The weight of each of the model's markers.
    ///
    /// # Errors
    /// `track/weight` where a weight is out of bounds, `track/unknown-marker` where a pattern fits no
    /// marker.
    pub(super) fn weights_of(&self, model: &Model) -> Result<Vec<f64>, Error> {
        let names = || model.markers().iter().map(|marker| marker.name.as_str());
        let base = |name: &str| match &self.marker_weights {
            None => 1.0,
            Some(weights) => weights.get(name).copied().unwrap_or(0.0),
        };
        let mut weights: Vec<f64> = names().map(base).collect();
        for (weight, name) in weights.iter().zip(names()) {
            check_weight(*weight, name)?;
        }
        for (pattern, weight) in &self.weights {
            check_weight(*weight, pattern)?;
            let mut fits = false;
            for (place, _) in
                weights.iter_mut().zip(names()).filter(|(_, n)| fits_pattern(pattern, n))
            {
                (*place, fits) = (*weight, true);
            }
            if !fits {
                let message =
                    format!("the weight of `{pattern}` is that of no marker of the model");
                let all =
                    || "names of markers are those of the model, `*` stands for any letters".into();
                let help = did_you_mean(pattern, names(), all);
                return Err(Error::new("track/unknown-marker", message).with_help(help));
            }
        }
        Ok(weights)
    }

    /// Checks the numbers of coordinates, postures and loops.
    pub(super) fn check(&self) -> Result<(), Error> {
        for task in &self.coordinates {
            check_weight(task.weight, &task.name)?;
        }
        for posture in &self.postures {
            let finite = posture.coordinates.iter().all(|(_, factor)| factor.abs() <= HEAVIEST);
            let names: Vec<&str> =
                posture.coordinates.iter().map(|(name, _)| name.as_str()).collect();
            check_weight(posture.stiffness, &names.join(", "))?;
            if !finite || !posture.rest.is_none_or(|rest| rest.abs() <= HEAVIEST) {
                let message =
                    format!("the posture of {} has numbers that are too large", names.join(", "));
                return Err(Error::new("track/posture", message));
            }
        }
        if self.closure_weight.is_finite() {
            check_weight(self.closure_weight, "loops")?;
        }
        Ok(())
    }

    /// The labels of a recording by the names that [`Request::names`] gives them in a model.
    pub(super) fn renamed(
        &self,
        model: &Model,
        labels: &[String],
        warnings: &mut Vec<Diagnostic>,
    ) -> Vec<String> {
        let known = |name: &&String| model.markers().iter().any(|marker| marker.name == **name);
        let renamed = |label: &String| {
            let bare = label.rsplit(':').next().unwrap_or(label);
            let entry = self.names.iter().find(|(from, _)| from == label).map(|entry| ("", entry));
            // The prefix stays: it tells whose marker it is.
            let prefix = label.strip_suffix(bare).unwrap_or_default();
            let other = || self.names.iter().find(|(from, _)| from == bare);
            let entry = entry.or_else(|| other().map(|entry| (prefix, entry)));
            let Some((prefix, (_, names))) = entry else { return label.clone() };
            match (names.iter().find(known), &names[..]) {
                (Some(name), _) => format!("{prefix}{name}"),
                (None, [only]) => {
                    let names = model.markers().iter().map(|marker| marker.name.as_str());
                    let message =
                        format!("`{label}` is called `{only}`, which is no marker of the model");
                    let help =
                        did_you_mean(only, names, || "the label is used as it is".to_owned());
                    let said = Diagnostic::warning("track/unknown-marker", message);
                    warnings.push(said.with_help(help));
                    label.clone()
                }
                _ => label.clone(),
            }
        };
        labels.iter().map(renamed).collect()
    }

    /// Adds coordinates and postures to the targets of frames at these times; what cannot be tracked is
    /// a warning.
    pub(super) fn add_coordinates(
        &self,
        model: &Model,
        times: &[f64],
        targets: &mut Targets,
        warnings: &mut Vec<Diagnostic>,
    ) {
        let file = self.coordinate_values.as_ref().map(|table| {
            let mut settled = table.clone();
            match settled.settle_angles(Some(model), None) {
                Ok(said) => warnings.extend(said),
                Err(error) => warnings.extend(error.into_diagnostics().into_iter().map(|said| {
                    let help = "radians are assumed, as OpenSim does";
                    Diagnostic::warning(said.code, said.message).with_help(help)
                })),
            }
            let (motion, said) = Motion::from_table(model, &settled);
            warnings.extend(said.into_iter().filter(|d| d.code == BLANK));
            (motion, table)
        });
        for CoordinateRequest { name, weight, value } in &self.coordinates {
            let Some(coordinate) = find(model, name, warnings) else { continue };
            let wanted = match (value, &file) {
                (CoordinateValue::Default, _) => {
                    Wanted::Constant(model.coordinate(coordinate).default[0])
                }
                (CoordinateValue::Constant(value), _) => Wanted::Constant(*value),
                (CoordinateValue::PerTime, Some((motion, table)))
                    if table.column(name).is_some() =>
                {
                    let at = |&t| motion.at(model, t).map(|q| model.value(&q, coordinate));
                    Wanted::PerFrame(times.iter().map(|t| at(t).unwrap_or(f64::NAN)).collect())
                }
                (CoordinateValue::PerTime, _) => {
                    let message = format!("no coordinate file gives values for `{name}`");
                    let said = Diagnostic::warning("track/no-coordinate-file", message);
                    warnings.push(said.with_help("the task is ignored"));
                    continue;
                }
            };
            targets.coordinates.push(CoordinateTarget { coordinate, weight: *weight, wanted });
        }
        for PostureRequest { coordinates, rest, stiffness } in &self.postures {
            let known =
                coordinates.iter().map(|(name, a)| Some((find(model, name, warnings)?, *a)));
            let terms: Option<Vec<(CoordinateId, f64)>> = known.collect();
            if let Some(terms) = terms {
                let default = |&(id, a): &(CoordinateId, f64)| a * model.coordinate(id).default[0];
                let rest = rest.unwrap_or_else(|| terms.iter().map(default).sum());
                targets.postures.push(PostureTarget { terms, rest, stiffness: *stiffness });
            }
        }
    }
}

/// Weights other than 0 lie between one over this and this, so that their sums stay finite and no
/// marker vanishes beside another.
const HEAVIEST: f64 = 1e9;

fn check_weight(weight: f64, name: &str) -> Result<(), Error> {
    if weight == 0.0 || (1.0 / HEAVIEST..=HEAVIEST).contains(&weight) {
        return Ok(());
    }
    let message = format!("the weight {weight:e} of `{name}` is out of bounds");
    let help = "give 0, or a number from 1e-9 to 1e9";
    Err(Error::new("track/weight", message).with_help(help))
}

/// Whether a name fits a pattern, in which `*` stands for any letters.
pub(crate) fn fits_pattern(pattern: &str, name: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut rest) = name.strip_prefix(parts.next().unwrap_or_default()) else { return false };
    let Some(last) = parts.next_back() else { return rest.is_empty() };
    for part in parts {
        match rest.find(part) {
            Some(at) => rest = &rest[at + part.len()..],
            None => return false,
        }
    }
    rest.ends_with(last)
}

/// A coordinate by its name; an unknown one is a warning.
fn find(model: &Model, name: &str, warnings: &mut Vec<Diagnostic>) -> Option<CoordinateId> {
    let ignored = |error: &dyn std::fmt::Display| {
        let said = Diagnostic::warning("track/unknown-coordinate", format!("{error}"));
        said.with_help("the task is ignored")
    };
    model.find_coordinate(name).map_err(|error| warnings.push(ignored(&error))).ok()
}

#[cfg(test)]
mod tests {
    use super::fits_pattern;

    #[test]
    fn a_star_stands_for_any_letters() {
        for (pattern, name, fits) in [
            ("RASI", "RASI", true),
            ("RASI", "RASIS", false),
            ("*", "", true),
            ("*", "RASI", true),
            ("R*", "RASI", true),
            ("R*", "LASI", false),
            ("*ASI", "RASI", true),
            ("*thigh*", "r_thigh4", true),
            ("r*h*4", "r_thigh4", true),
            ("r*h*5", "r_thigh4", false),
            ("aba*aba", "aba", false),
            ("**", "x", true),
        ] {
            assert_eq!(fits_pattern(pattern, name), fits, "{pattern} {name}");
        }
    }
}
