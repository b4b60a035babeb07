//! What a picture looks at.

use condyle_diagnostics::{Error, did_you_mean};
use condyle_model::{Model, SegmentId};

/// What is looked at: segments, or all that joint sets move, by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Focus {
    /// The names; none is the whole figure.
    pub names: Vec<String>,
    /// How many times larger than in a picture of the whole figure; without it, as large as fits.
    pub zoom: Option<f64>,
    /// Draw it in the accent colour, and the rest pale.
    pub highlight: bool,
}

/// The segments that are looked at.
#[derive(Clone, Debug)]
pub(super) struct Chosen(Vec<bool>);

impl Chosen {
    pub(super) fn has(&self, segment: SegmentId) -> bool {
        self.0.get(segment.index()).copied().unwrap_or(false)
    }
}

impl Focus {
    /// The segments of these names; `None` for the whole figure.
    ///
    /// # Errors
    /// `picture/unknown` for a name that is neither of a segment nor of a joint set.
    pub(super) fn resolve(&self, model: &Model) -> Result<Option<Chosen>, Error> {
        if self.names.is_empty() {
            return Ok(None);
        }
        let mut chosen = vec![false; model.segments().len()];
        for name in &self.names {
            let set = model.joint_set_ids().find(|id| model.joint_sets()[id.index()].name == *name);
            if let Ok(segment) = model.find_segment(name) {
                chosen[segment.index()] = true;
            } else if let Some(set) = set {
                model.outputs_of(set).for_each(|(segment, _)| chosen[segment.index()] = true);
            } else {
                let segments = model.segments().iter().map(|s| s.name.as_str());
                let sets = model.joint_sets().iter().map(|s| s.name.as_str());
                let help = did_you_mean(name, segments.chain(sets), || {
                    "`condyle info` lists segments and joint sets".to_owned()
                });
                let message = format!("no segment or joint set is called `{name}`");
                return Err(Error::new("picture/unknown", message).with_help(help));
            }
        }
        Ok(Some(Chosen(chosen)))
    }
}
