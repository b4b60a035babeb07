//! Learned laws that are used outside the region in which they were learned, frame by frame.

use crate::{amount, finding, rounded};
use condyle_diagnostics::{Diagnostic, Severity};
use condyle_math::EulerOrder;
use condyle_model::component::{AngleNames, Angles, Correlate, Law, Signal};
use condyle_model::model::ComponentId;
use condyle_model::{CoordinateId, CoordinateKind, Model, Pose, SegmentId};

/// What a learned law is a function of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// A coordinate.
    Coordinate(CoordinateId),
    /// An angle of a segment in another: an output of a component of kind `angles`, counted from 0.
    Angle(ComponentId, usize),
}

impl Control {
    /// The coordinate's key, or the output as documents name it: `knee_angles`, `knee_angles.2`, `knee_angles.3`.
    #[must_use]
    pub fn name(self, model: &Model) -> String {
        match self {
            Self::Coordinate(id) => model.coordinate_key(id),
            Self::Angle(id, 0) => model.components()[id.index()].name.clone(),
            Self::Angle(id, k) => format!("{}.{}", model.components()[id.index()].name, k + 1),
        }
    }

    fn kind(self, model: &Model) -> CoordinateKind {
        match self {
            Self::Coordinate(id) => model.coordinate(id).kind,
            Self::Angle(..) => CoordinateKind::Rotation,
        }
    }
}

/// How a control's value is had from a pose.
enum Reading {
    Coordinate(CoordinateId),
    /// An angle, in an order, of the first segment in the second, or in the world.
    Angle(SegmentId, Option<SegmentId>, EulerOrder, usize),
}

impl Reading {
    fn value(&self, model: &Model, pose: &Pose) -> f64 {
        match self {
            Self::Coordinate(id) => pose.coordinate(model, *id)[0],
            Self::Angle(segment, reference, order, k) => {
                let inside = pose.frame(*reference).linear.transpose();
                order.from_mat3(inside * pose.segment(*segment).linear)[*k]
            }
        }
    }
}

/// A control of a law, where it is one that can be read from a pose.
fn control(model: &Model, input: Signal) -> Option<(Control, Reading)> {
    let (id, k) = match input {
        Signal::Coordinate(id) => return Some((Control::Coordinate(id), Reading::Coordinate(id))),
        Signal::Output(id, k) => (id, k as usize),
        Signal::Segment(_) => return None,
    };
    let angles = model.components().get(id.index())?;
    let Law::Angles(Angles { names: AngleNames::Euler(order), mirrored: None }) = angles.law else {
        return None;
    };
    let Some(Signal::Output(from, _)) = angles.inputs.first() else { return None };
    let relative = model.components().get(from.index())?;
    let Law::RelativeOrientation(_) = relative.law else { return None };
    let mut segments = relative.inputs.iter().filter_map(|input| match input {
        Signal::Segment(id) => Some(*id),
        _ => None,
    });
    let segment = segments.next()?;
    Some((Control::Angle(id, k), Reading::Angle(segment, segments.next(), order, k)))
}

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
    pub controls: Vec<(Control, f64)>,
    /// The first of them that is outside its bounds, by its number, and by how much; `None` where only their combination is new.
    pub beyond: Option<(usize, f64)>,
}

/// Collects where laws are used.
pub(super) struct Learned<'m> {
    model: &'m Model,
    laws: Vec<(ComponentId, Vec<(Control, Reading)>)>,
    pub(super) found: Vec<Extrapolated>,
}

impl<'m> Learned<'m> {
    /// Of laws with a region whose controls are coordinates, or angles of segments in others.
    pub(super) fn new(model: &'m Model) -> Self {
        let laws = model.component_ids().filter_map(|id| {
            let component = &model.components()[id.index()];
            let Law::Correlate(Correlate { region: Some(_), .. }) = component.law else {
                return None;
            };
            let controls = component.inputs.iter().map(|input| control(model, *input));
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
                controls.iter().map(|(_, reading)| reading.value(self.model, pose)).collect();
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
                controls: controls.iter().map(|(control, _)| *control).zip(values).collect(),
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
            let shown = |(control, value): &(Control, f64)| {
                format!("`{}` {}", control.name(model), amount(control.kind(model), *value))
            };
            let controls: Vec<String> = one.controls.iter().map(shown).collect();
            let why = match one.beyond.and_then(|(k, by)| Some((one.controls.get(k)?, by))) {
                Some(((control, _), by)) => format!(
                    "`{}` is {} beyond where it was",
                    control.name(model),
                    amount(control.kind(model), by)
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
