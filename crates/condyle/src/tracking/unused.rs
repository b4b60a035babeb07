//! The markers of the model and the labels of the recording that a tracking did not use.

use condyle_diagnostics::nearest;
use condyle_model::Model;

/// A name that was not used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unused {
    /// The name.
    pub name: String,
    /// The unused name of the other side that is most like it, if one is.
    pub partner: Option<String>,
}

/// What was not used on either side.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct UnusedMarkers {
    /// Markers of the model that the recording does not have, or that have no weight.
    pub model: Vec<Unused>,
    /// Labels of the recording that are no marker of the model, or have no weight.
    pub recording: Vec<Unused>,
}

impl UnusedMarkers {
    /// What is left when these markers and these labels, by their positions, are used.
    pub(super) fn of(model: &Model, labels: &[String], names: &[String], used: &[usize]) -> Self {
        let markers = model.markers().iter().map(|marker| &marker.name);
        let model: Vec<&String> = markers.filter(|name| !names.contains(name)).collect();
        let recording = labels.iter().enumerate().filter(|(index, _)| !used.contains(index));
        let recording: Vec<&String> = recording.map(|(_, label)| label).collect();
        let of = |these: &[&String], others: &[&String]| {
            let partner = |name: &str| {
                let name = name.rsplit(':').next().unwrap_or(name);
                nearest(name, others.iter().map(|other| other.as_str())).map(str::to_owned)
            };
            // A model with the marker sets of many laboratories has hundreds that are not meant.
            let few = these.len() * others.len() <= MOST_COMPARED;
            let unused = these.iter().map(|&name| Unused {
                name: name.clone(),
                partner: few.then(|| partner(name)).flatten(),
            });
            unused.collect()
        };
        Self { model: of(&model, &recording), recording: of(&recording, &model) }
    }
}

/// How many pairs of names are compared at most.
const MOST_COMPARED: usize = 100_000;
