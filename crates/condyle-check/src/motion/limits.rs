//! Limits of several numbers together, frame by frame: cones, ellipses, half-spaces, bounds that a driver
//! sets, and gaps of contacts.

use crate::{amount, finding, length, rounded};
use condyle_diagnostics::{Diagnostic, Severity};
use condyle_model::component::{Component, FieldLimit, Law, PortType, Signal};
use condyle_model::evaluate::Bound;
use condyle_model::limit::Limit;
use condyle_model::limit::field::State;
use condyle_model::model::ComponentId;
use condyle_model::{CoordinateKind, Model, Pose, Program};

/// A number outside a limit by less than this is rounding in a file: 0.01 degrees, 0.01 mm.
const ROUNDING: [f64; 2] = [0.01 * std::f64::consts::PI / 180.0, 1e-5];

/// A gap of a contact that does not bound it is said from here on: 0.1 mm.
const APART: f64 = 1e-4;

/// A number that a limit bounds: what it is called, as it is, and the nearest that is valid.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearest {
    /// The coordinate by its key, or the component that computes it.
    pub name: String,
    /// What it measures.
    pub kind: CoordinateKind,
    /// The value in the motion; four of an orientation.
    pub value: Vec<f64>,
    /// The nearest valid value.
    pub valid: Vec<f64>,
}

/// A limit that some frames break.
#[derive(Clone, Debug, PartialEq)]
pub struct Broken {
    /// The component that limits.
    pub component: ComponentId,
    /// In how many frames.
    pub frames: usize,
    /// First and last frame of every run.
    pub runs: Vec<[usize; 2]>,
    /// The frame that is farthest out, counted from 0.
    pub frame: usize,
    /// Its time in seconds.
    pub time: f64,
    /// How far outside, in radians or metres.
    pub by: f64,
    /// Whether that is an angle or a length.
    pub kind: CoordinateKind,
    /// What it bounds, and the nearest that is valid; of a contact nothing.
    pub nearest: Vec<Nearest>,
    /// Of a contact the signed distances of its points from the surface in metres.
    pub gaps: Option<[f64; 2]>,
}

/// Collects what the frames of a motion break.
pub(super) struct Watch<'m> {
    model: &'m Model,
    bounds: Vec<Bound>,
    contacts: Vec<ComponentId>,
    pub(super) broken: Vec<Broken>,
    /// What is in holes of learned limits: possible for all that is known.
    pub(super) unknown: Vec<Broken>,
}

impl<'m> Watch<'m> {
    pub(super) fn new(model: &'m Model, program: &Program) -> Self {
        let contact =
            |id: &ComponentId| matches!(model.components()[id.index()].law, Law::Contact(_));
        let bounds = program.bounds().iter().filter(|bound| !contact(&bound.component));
        let (bounds, contacts) = (bounds.cloned().collect(), program.contacts().collect());
        Self { model, bounds, contacts, broken: vec![], unknown: vec![] }
    }

    /// Looks at a pose that was evaluated with its limits off.
    pub(super) fn frame(&mut self, frame: usize, time: f64, pose: &Pose) {
        for at in 0..self.bounds.len() {
            let bound = &self.bounds[at];
            let component = &self.model.components()[bound.component.index()];
            let numbers: Vec<f64> = pose.bounded(bound).collect();
            let kind = limited_kind(self.model, component);
            let Some((by, valid)) = outside(component, &numbers) else {
                if let Some((by, valid)) = unseen(component, &numbers) {
                    let nearest = || named(self.model, component, &numbers, &valid);
                    add(&mut self.unknown, bound.component, (frame, time), by, kind, None, nearest);
                }
                continue;
            };
            if by <= ROUNDING[usize::from(kind != CoordinateKind::Rotation)] {
                continue;
            }
            let nearest = || named(self.model, component, &numbers, &valid);
            let id = bound.component;
            add(&mut self.broken, id, (frame, time), by, kind, None, nearest);
        }
        for (number, &id) in self.contacts.iter().enumerate() {
            let Law::Contact(law) = &self.model.components()[id.index()].law else { continue };
            let Some(report) = pose.contact(number) else { continue };
            let most = report.gaps.iter().fold(0.0f64, |most, gap| most.max(gap.abs()));
            let by = match law.most_gap {
                Some(allowed) => most - allowed,
                None => most,
            };
            let visible = if law.most_gap.is_some() { ROUNDING[1] } else { APART };
            if by > visible {
                let kind = CoordinateKind::Translation;
                let gaps = Some(report.gaps);
                add(&mut self.broken, id, (frame, time), by, kind, gaps, Vec::new);
            }
        }
    }

    /// What was found, as findings.
    pub(super) fn say(&self) -> impl Iterator<Item = Diagnostic> + '_ {
        let unknown = self.unknown.iter().map(|unknown| not_seen(self.model, unknown));
        self.broken.iter().map(|broken| said(self.model, broken)).chain(unknown)
    }
}

/// Adds one frame to what is known of a limit.
fn add(
    known: &mut Vec<Broken>,
    component: ComponentId,
    (frame, time): (usize, f64),
    by: f64,
    kind: CoordinateKind,
    gaps: Option<[f64; 2]>,
    nearest: impl FnOnce() -> Vec<Nearest>,
) {
    let Some(own) = known.iter_mut().find(|broken| broken.component == component) else {
        let (runs, nearest) = (vec![[frame; 2]], nearest());
        known.push(Broken { component, frames: 1, runs, frame, time, by, kind, nearest, gaps });
        return;
    };
    own.frames += 1;
    match own.runs.last_mut() {
        Some(run) if run[1] + 1 == frame => run[1] = frame,
        _ => own.runs.push([frame; 2]),
    }
    if by > own.by {
        (own.frame, own.time, own.by, own.gaps) = (frame, time, by, gaps);
        own.nearest = nearest();
    }
}

/// How far outside its limit the numbers of a component are, and the nearest that are valid.
fn outside(component: &Component, numbers: &[f64]) -> Option<(f64, Vec<f64>)> {
    if let Law::Depend(depend) = &component.law {
        let &[passive, driver] = numbers else { return None };
        let bound = |f: &Option<condyle_math::function::Function>, or: f64| {
            f.as_ref().map_or(or, |f| f.value_and_slope(driver).0)
        };
        let (lower, upper) =
            (bound(&depend.lower, f64::NEG_INFINITY), bound(&depend.upper, f64::INFINITY));
        // Where the bounds cross, the upper one holds.
        let valid = passive.max(lower).min(upper);
        return Some(((passive - valid).abs(), vec![valid]));
    }
    let limit = component.law.limit()?;
    let valid = limit.legal(numbers)?;
    Some((limit.beyond(numbers), valid[..numbers.len().min(valid.len())].to_vec()))
}

/// Of an orientation in a hole of a learned limit: how far it is from what was seen, and the nearest that was.
fn unseen(component: &Component, numbers: &[f64]) -> Option<(f64, Vec<f64>)> {
    let Law::Field(law) = &component.law else { return None };
    if law.state(numbers) != State::Unknown {
        return None;
    }
    // Where nothing is known of what a limit depends on there is no way to what is.
    if law.limit.dependence().is_some() {
        return Some((0.0, numbers.to_vec()));
    }
    let strict = FieldLimit { strict: true, ..law.clone() };
    Some((strict.beyond(numbers), strict.legal(numbers)?.to_vec()))
}

fn not_seen(model: &Model, unknown: &Broken) -> Diagnostic {
    let component = &model.components()[unknown.component.index()];
    let near = |near: &Nearest| shown(near.kind, &near.valid);
    finding(
        Severity::Note,
        "motion/unknown",
        [model.component_subject(component)],
        format!(
            "field `{}` knows nothing of {} frames; most in frame {} ({} s), {} from what was seen",
            component.name,
            unknown.frames,
            unknown.frame,
            rounded(unknown.time, 4),
            amount(unknown.kind, unknown.by),
        ),
        format!(
            "no violation: nobody was recorded there; the nearest that was is {}",
            unknown.nearest.iter().map(near).collect::<Vec<_>>().join(", ")
        ),
    )
}

/// Where a learned limit is from, in brackets.
fn source(component: &Component) -> String {
    match &component.law {
        Law::Field(law) if !law.limit.about().source.is_empty() => {
            format!(" ({})", law.limit.about().source)
        }
        _ => String::new(),
    }
}

/// Whether what a component limits is an angle or a length.
fn limited_kind(model: &Model, component: &Component) -> CoordinateKind {
    if matches!(component.law, Law::Cone(_) | Law::Field(_)) {
        return CoordinateKind::Rotation;
    }
    let first = component.inputs.first();
    first.map_or(CoordinateKind::Other, |&signal| signal_kind(model, signal))
}

fn signal_kind(model: &Model, signal: Signal) -> CoordinateKind {
    let mut signal = signal;
    for _ in 0..model.components().len() + 1 {
        let Signal::Output(id, output) = signal else { break };
        let component = &model.components()[id.index()];
        match &component.law {
            Law::RelativePosition(_) => return CoordinateKind::Translation,
            Law::Angles(_) => return CoordinateKind::Rotation,
            law if law.bounds() => match component.inputs.get(output as usize) {
                Some(&passed) => signal = passed,
                None => break,
            },
            // What is computed of angles is mostly an angle.
            _ => match component.values().next() {
                Some(read) => signal = read,
                None => break,
            },
        }
    }
    match signal {
        Signal::Coordinate(id) => match model.coordinate(id).kind {
            CoordinateKind::Orientation => CoordinateKind::Rotation,
            kind => kind,
        },
        _ => CoordinateKind::Other,
    }
}

/// The numbers of a limit by name.
fn named(model: &Model, component: &Component, numbers: &[f64], valid: &[f64]) -> Vec<Nearest> {
    let name = |signal: Signal| match signal {
        Signal::Coordinate(id) => model.coordinate_key(id),
        Signal::Output(id, output) => {
            let from = &model.components()[id.index()];
            match from.law.outputs().1 {
                1 => from.name.clone(),
                _ => format!("{}.{}", from.name, output + 1),
            }
        }
        Signal::Segment(id) => model.segment(id).name.clone(),
    };
    let one_orientation = component.law.outputs().0 == PortType::Orientation;
    let width = if one_orientation { 4 } else { 1 };
    let pairs = numbers.chunks(width).zip(valid.chunks(width));
    component
        .inputs
        .iter()
        .take(component.law.outputs().1)
        .zip(pairs)
        .map(|(&signal, (value, valid))| {
            let kind = if one_orientation {
                CoordinateKind::Orientation
            } else {
                signal_kind(model, signal)
            };
            Nearest { name: name(signal), kind, value: value.to_vec(), valid: valid.to_vec() }
        })
        .collect()
}

/// Numbers as people read them; a quaternion as it is.
fn shown(kind: CoordinateKind, numbers: &[f64]) -> String {
    match numbers {
        [one] => amount(kind, *one),
        all => format!("[{}]", all.iter().map(|x| rounded(*x, 4)).collect::<Vec<_>>().join(", ")),
    }
}

fn said(model: &Model, broken: &Broken) -> Diagnostic {
    let component = &model.components()[broken.component.index()];
    let (name, kind) = (&component.name, component.law.kind().name);
    let frames =
        if broken.frames == 1 { "1 frame".to_owned() } else { format!("{} frames", broken.frames) };
    let at = format!("most in frame {} ({} s)", broken.frame, rounded(broken.time, 4));
    let about = [model.component_subject(component)];
    if let (Some(gaps), Law::Contact(law)) = (broken.gaps, &component.law) {
        let [first, second] = gaps.map(|gap| {
            let side = if gap > 0.0 { "outside" } else { "inside" };
            format!("{} {side}", length(gap.abs()))
        });
        let (severity, more) = match law.most_gap {
            Some(allowed) => (
                Severity::Error,
                format!("{} more than the {} that it allows", length(broken.by), length(allowed)),
            ),
            None => (Severity::Warning, "it does not reach the surface there".to_owned()),
        };
        return finding(
            severity,
            "motion/contact-gap",
            about,
            format!(
                "the points of contact `{name}` leave its ellipsoid in {frames}; {at}: {first} and {second}, {more}"
            ),
            "a gap moves nothing: the pose itself has to change",
        );
    }
    let values: Vec<String> = broken
        .nearest
        .iter()
        .map(|near| format!("`{}` {}", near.name, shown(near.kind, &near.value)))
        .collect();
    let valid: Vec<String> = broken
        .nearest
        .iter()
        .map(|near| format!("`{}` {}", near.name, shown(near.kind, &near.valid)))
        .collect();
    finding(
        Severity::Error,
        "motion/outside-limit",
        about,
        format!(
            "{kind} `{name}`{} is broken in {frames}; {at}, by {}: {}",
            source(component),
            amount(broken.kind, broken.by),
            values.join(", ")
        ),
        format!("nearest valid: {}", valid.join(", ")),
    )
}
