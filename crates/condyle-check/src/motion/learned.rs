//! Learned laws that are used outside the region in which they were learned, frame by frame.

use crate::{amount, finding, rounded};
use condyle_diagnostics::{Diagnostic, Severity};
use condyle_model::component::{Correlate, Law, Signal};
use condyle_model::model::ComponentId;
use condyle_model::{CoordinateId, Model, Pose};

/// Frames in which a law's controls are where they were not when it was learned.
#[derive(Clone, Debug, PartialEq)]
pub struct Extrapolated {
    /// The component of the law.
    pub component: ComponentId,
    /// In how many frames.
    pub frames: usize,
    /// First and last frame of every run.
    pub runs: Vec<[usize; 2]>,
    /// The frame that is farthest out, counted from 0.
    pub frame: usize,
    /// Its time in seconds.
    pub time: f64,
    /// Mahalanobis' distance there, in units of that of the farthest frame that was learned from.
    pub distance: f64,
    /// The controls there, each with its value.
    pub controls: Vec<(CoordinateId, f64)>,
    /// The first of them that is outside its bounds, by its number, and by how much; `None` where only their combination is new.
    pub beyond: Option<(usize, f64)>,
}

/// Collects where laws are used.
pub(super) struct Learned<'m> {
    model: &'m Model,
    laws: Vec<(ComponentId, Vec<CoordinateId>)>,
    pub(super) found: Vec<Extrapolated>,
}

impl<'m> Learned<'m> {
    /// Of laws with a region whose controls are coordinates.
    pub(super) fn new(model: &'m Model) -> Self {
        let laws = model.component_ids().filter_map(|id| {
            let component = &model.components()[id.index()];
            let Law::Correlate(Correlate { region: Some(_), .. }) = component.law else {
                return None;
            };
            let controls = component.inputs.iter().map(|input| match input {
                Signal::Coordinate(id) => Some(*id),
                Signal::Output(..) | Signal::Segment(_) => None,
            });
            Some((id, controls.collect::<Option<_>>()?))
        });
        Self { model, laws: laws.collect(), found: vec![] }
    }

    /// Looks at a pose that was evaluated with its limits off.
    pub(super) fn frame(&mut self, frame: usize, time: f64, pose: &Pose) {
        for (id, controls) in &self.laws {
            let law = &self.model.components()[id.index()].law;
            let Law::Correlate(Correlate { region: Some(region), .. }) = law else { continue };
            let values: Vec<f64> =
                controls.iter().map(|id| pose.coordinate(self.model, *id)[0]).collect();
            if region.contains(&values) {
                continue;
            }
            let here = Extrapolated {
                component: *id,
                frames: 1,
                runs: vec![[frame; 2]],
                frame,
                time,
                distance: region.distance_of(&values) / region.distance.max(1e-12),
                beyond: region.beyond(&values),
                controls: controls.iter().copied().zip(values).collect(),
            };
            let Some(known) = self.found.iter_mut().find(|known| known.component == *id) else {
                self.found.push(here);
                continue;
            };
            known.frames += 1;
            match known.runs.last_mut() {
                Some(run) if run[1] + 1 == frame => run[1] = frame,
                _ => known.runs.push([frame; 2]),
            }
            if here.distance > known.distance {
                let runs = std::mem::take(&mut known.runs);
                *known = Extrapolated { frames: known.frames, runs, ..here };
            }
        }
    }

    /// What is said of them; one sentence for laws of the same controls that leave them in the same frames.
    pub(super) fn say(&self) -> Vec<Diagnostic> {
        let model = self.model;
        let mut all: Vec<Diagnostic> = vec![];
        for (index, one) in self.found.iter().enumerate() {
            let alike =
                |other: &Extrapolated| other.runs == one.runs && other.controls == one.controls;
            if self.found[..index].iter().any(alike) {
                continue;
            }
            let own = self.found.iter().filter(|other| alike(other));
            let components: Vec<_> =
                own.map(|other| &model.components()[other.component.index()]).collect();
            let names = condyle_diagnostics::listed(components.iter().map(|c| c.name.as_str()));
            let (verb, plural) = if components.len() == 1 { ("is", "") } else { ("are", "s") };
            let frames = match one.frames {
                1 => "1 frame".to_owned(),
                count => format!("{count} frames"),
            };
            let shown = |(id, value): &(CoordinateId, f64)| {
                let key = model.coordinate_key(*id);
                format!("`{key}` {}", amount(model.coordinate(*id).kind, *value))
            };
            let controls: Vec<String> = one.controls.iter().map(shown).collect();
            let why = match one.beyond.and_then(|(k, by)| Some((one.controls.get(k)?, by))) {
                Some(((id, _), by)) => format!(
                    "`{}` is {} beyond where it was",
                    model.coordinate_key(*id),
                    amount(model.coordinate(*id).kind, by)
                ),
                None => format!(
                    "each was there, but not together ({} of the farthest frame)",
                    rounded(one.distance, 2)
                ),
            };
            all.push(finding(
                Severity::Warning,
                "motion/beyond-learned",
                components.iter().map(|c| model.component_subject(c)),
                format!(
                    "learned law{plural} {names} {verb} used outside the region of learning in {frames}; most in frame {} ({} s), {}: {why}",
                    one.frame,
                    rounded(one.time, 4),
                    controls.join(", "),
                ),
                "what a law says of angles that were never seen is a guess: learn it from motions that have them",
            ));
        }
        all
    }
}
