//! The markers of the model and the labels of the recording that a tracking did not use.

use condyle_diagnostics::nearest;
use condyle_model::Model;

/// A name that was not used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unused {
    /// The name.
    pub name: String,
    /// The unused name of the other side that is most like it, if each is the other's.
    pub partner: Option<String>,
}

/// What was not used on either side.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct UnusedMarkers {
    /// Markers of the model that the recording does not have or never shows, or that have no weight.
    pub model: Vec<Unused>,
    /// Labels of the recording that are no marker of the model, are never seen, or have no weight.
    pub recording: Vec<Unused>,
    /// Labels of those that are a marker of the model, but that no frame shows.
    pub never_seen: Vec<String>,
    /// Markers of the model, among those, that the recording has, but that have the weight 0.
    pub without_weight: Vec<String>,
}

impl UnusedMarkers {
    /// What is left when these markers and these labels, by their positions, are used.
    pub(super) fn of(model: &Model, labels: &[String], names: &[String], used: &[usize]) -> Self {
        let markers = model.markers().iter().map(|marker| &marker.name);
        let model: Vec<&String> = markers.filter(|name| !names.contains(name)).collect();
        let recording = labels.iter().enumerate().filter(|(index, _)| !used.contains(index));
        let recording: Vec<&String> = recording.map(|(_, label)| label).collect();
        // A model with the marker sets of many laboratories has hundreds that are not meant.
        let few = model.len() * recording.len() <= MOST_COMPARED;
        let nearest_of = |name: &str, others: &[&String]| -> Option<String> {
            let bare = name.rsplit(':').next().unwrap_or(name);
            // What both sides have was left out by its weight.
            let others = others.iter().filter(|other| !other.eq_ignore_ascii_case(bare));
            nearest(bare, others.map(|other| other.as_str())).map(str::to_owned)
        };
        let of = |these: &[&String], others: &[&String]| {
            let unused = these.iter().map(|&name| {
                let both_ways = |other: &String| nearest_of(other, these).as_ref() == Some(name);
                let partner = few.then(|| nearest_of(name, others)).flatten();
                Unused { name: name.clone(), partner: partner.filter(both_ways) }
            });
            unused.collect()
        };
        Self { model: of(&model, &recording), recording: of(&recording, &model), ..Self::default() }
    }
}

/// How many pairs of names are compared at most.
const MOST_COMPARED: usize = 100_000;

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_model::ModelBuilder;

    #[test]
    fn unused_names_find_each_other_and_nothing_else() {
        let mut b = ModelBuilder::new("leg");
        let thigh = b.segment("thigh", None);
        for name in ["RKNE", "r_ankle_lat", "r_ankle_med", "off", "far"] {
            b.marker(name, Some(thigh), condyle_math::Vec3::X);
        }
        let model = b.build().unwrap();
        let labels = ["Anna:RKNE", "R_ankle_latt", "off", "C7"].map(String::from);
        let unused = UnusedMarkers::of(&model, &labels, &["RKNE".to_owned()], &[0]);
        let of = |list: &[Unused]| -> Vec<(String, Option<String>)> {
            list.iter().map(|one| (one.name.clone(), one.partner.clone())).collect()
        };
        let some = |name: &str, partner: Option<&str>| (name.to_owned(), partner.map(String::from));
        assert_eq!(
            of(&unused.model),
            [
                some("r_ankle_lat", Some("R_ankle_latt")),
                some("r_ankle_med", None),
                some("off", None),
                some("far", None),
            ]
        );
        assert_eq!(
            of(&unused.recording),
            [some("R_ankle_latt", Some("r_ankle_lat")), some("off", None), some("C7", None)]
        );
    }
}
