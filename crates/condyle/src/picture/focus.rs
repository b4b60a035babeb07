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

/// What is looked at.
#[derive(Clone, Debug)]
pub(super) struct Chosen {
    segments: Vec<bool>,
    /// The first segments of the joint sets that are looked at.
    pub(super) joints: Vec<SegmentId>,
}

impl Chosen {
    pub(super) fn has(&self, segment: SegmentId) -> bool {
        self.segments.get(segment.index()).copied().unwrap_or(false)
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
        let (mut segments, mut joints) = (vec![false; model.segments().len()], vec![]);
        for name in &self.names {
            let set = model.joint_set_ids().find(|id| model.joint_sets()[id.index()].name == *name);
            if let Ok(segment) = model.find_segment(name) {
                segments[segment.index()] = true;
            } else if let Some(set) = set {
                model.outputs_of(set).for_each(|(segment, _)| segments[segment.index()] = true);
                let moved = |s: &SegmentId| model.segment(*s).joint_set == Some(set);
                joints.extend(model.parents_first().into_iter().find(moved));
            } else {
                let known = model.segments().iter().map(|s| s.name.as_str());
                let sets = model.joint_sets().iter().map(|s| s.name.as_str());
                let help = did_you_mean(name, known.chain(sets), || {
                    "`condyle info` lists segments and joint sets".to_owned()
                });
                let message = format!("no segment or joint set is called `{name}`");
                return Err(Error::new("picture/unknown", message).with_help(help));
            }
        }
        Ok(Some(Chosen { segments, joints }))
    }
}
