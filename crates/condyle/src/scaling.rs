//! A model made as large as a person, from one recording of that person standing still.
//!
//! With the size groups of the model ([`SizeGroup`](condyle_model::model::SizeGroup)) and a factor for
//! each, and one for everything that is in no group,
//!
//! ```text
//! minimise  Σₘ |eₘ|²/σ²  +  Σ_g (ln s_g - ln s)²/τ²  +  n P/σ²
//! ```
//!
//! where eₘ is the distance of marker m of the scaled model, in the posture that comes nearest, from
//! its place in the recording; s_g the factor of a group and s that of the body. A landmark is found to
//! 10 to 20 mm (σ = 15 mm), and bones differ from the body by some percent (τ = 8 %), so that a group
//! without markers follows the body and one with many follows them. Factors are held to 0.5 to 2. P is
//! what the model says of its posture
//! ([`PostureTerm`](condyle_model::model::PostureTerm)), which tracking adds to the mean over n markers.
//!
//! A marker that stays farther off than 2σ is no landmark, or not the one that the model means: those
//! on the middle of a thigh stand anywhere. It counts by (2σ/|e|)² of another, found in a few rounds.
//!
//! The posture is solved inside, for every set of factors; outside are Gauss-Newton steps in the
//! logarithms of the factors, with central differences. Nothing is random, nothing remembered.
//!
//! A marker's place in the recording is its median over the frames in which it is seen. Afterwards the
//! markers of the model are moved to where they were seen: the places of a document are those of a
//! generic body, while a person's are those of the skin on that day.
//!
//! Confidences of keypoints weigh as in tracking: a frame in the median by c², a marker by the mean of c² over its
//! frames, as half as sure means twice the σ; below 0.05 a point is not seen. Markers that weigh less than a quarter stay
//! where the scaled model has them.

use crate::matching::match_markers;
use crate::tracking::{LEAST_CONFIDENCE, posture};
use condyle_diagnostics::{Diagnostic, Error, listed};
use condyle_math::Vec3;
use condyle_model::component::Law;
use condyle_model::{Mode, Model, Pose, SegmentId};
use condyle_motion::Recording;
use condyle_track::{FrameAnswer, FrameStatus, MarkerTarget, Rules, Scratch, Targets, Tracker};
use std::fmt;

/// Factors stay within one half and two.
pub const FACTORS: [f64; 2] = [0.5, 2.0];
/// A marker whose distance from its median goes beyond this (metres) does not stand still.
const STILL: f64 = 0.02;
/// The same for points of an estimator of poses, which differ by some centimetres from frame to frame.
const STILL_ESTIMATE: f64 = 0.06;
/// A marker of less weight is not moved to where it was seen: less than half as sure as one that is sure.
const MOVED: f64 = 0.25;
/// A marker that is moved farther than this (metres) is worth a look.
const FAR: f64 = 0.04;
/// The fewest markers that a size is found from.
const FEWEST: usize = 3;
/// Step of the differences, in the logarithm of a factor.
const STEP: f64 = 1e-3;
/// First guesses of a posture about which nothing is known.
const GUESSES: usize = 8;
/// Beyond so many spreads a marker counts less.
const TRUSTED: f64 = 2.0;
/// Most rounds in which markers are weighed.
const ROUNDS: usize = 8;
/// Most steps in the factors.
const ITERATIONS: usize = 20;

/// What is assumed of markers and bones while a model is scaled.
#[derive(Clone, Debug, PartialEq)]
pub struct Assumptions {
    /// Whose markers are meant, where the labels of several people differ by a prefix.
    pub subject: Option<String>,
    /// Leave markers where the scaled model has them.
    pub keep_markers: bool,
    /// How well a landmark is known, as a standard deviation in metres.
    pub marker_spread: f64,
    /// How far groups differ from the body, as a standard deviation of the factor's logarithm.
    pub group_spread: f64,
}

impl Default for Assumptions {
    fn default() -> Self {
        Self { subject: None, keep_markers: false, marker_spread: 0.015, group_spread: 0.08 }
    }
}

/// A scaled model and how it came about.
#[derive(Clone, Debug)]
pub struct Scaled {
    /// The model.
    pub model: Model,
    /// The factor of the body: of everything that is in no group.
    pub body: Factor,
    /// The factor of each size group of the model, in their order.
    pub groups: Vec<Factor>,
    /// The markers that were used.
    pub markers: Vec<MarkerFit>,
    /// Markers of the model that were not used.
    pub unused: Vec<String>,
    /// Root mean square over the markers used (metres), of the model as it was.
    pub rms_before: f64,
    /// The same of the scaled model, before its markers were moved.
    pub rms_after: f64,
    /// The posture: the stored numbers of all coordinates.
    pub posture: Vec<f64>,
    /// How the search for the posture ended.
    pub status: FrameStatus,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
}

/// How much something has grown.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// The name of the group, or `body`.
    pub name: String,
    /// The factor.
    pub factor: f64,
    /// How well it is known: the standard deviation of its logarithm, given the markers and the
    /// spreads that were assumed.
    pub spread: f64,
    /// The longest stretch from a joint to the next, or to a marker, in a segment that takes this
    /// factor (metres, before); 0 where there is none.
    pub length: f64,
}

/// What became of a marker.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkerFit {
    /// Its name in the model.
    pub name: String,
    /// Its distance in the scaled model from where it was seen, before it was moved (metres).
    pub error: f64,
    /// How far it was moved in its segment (metres); 0 for one that was left.
    pub moved: f64,
}

/// Why a model could not be scaled.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ScaleError {
    /// It is not known whose markers are meant.
    Subject(Error),
    /// Too few markers that the model has were seen standing still.
    TooFewMarkers {
        /// Those that can be used.
        usable: Vec<String>,
        /// Those that move too much.
        moving: Vec<String>,
        /// Some of the model's markers.
        model: Vec<String>,
        /// Some of the recording's labels.
        recording: Vec<String>,
    },
}

impl fmt::Display for ScaleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (usable, moving, model, recording) = match self {
            Self::Subject(error) => return error.fmt(f),
            Self::TooFewMarkers { usable, moving, model, recording } => {
                (usable, moving, model, recording)
            }
        };
        let list = |names: &[String]| names.join(", ");
        if model.is_empty() {
            return write!(
                f,
                "the model has no markers (the recording's are {}, …): add them to the model",
                list(recording)
            );
        }
        if usable.is_empty() && moving.is_empty() {
            return write!(
                f,
                "model and recording share no marker that is seen: the model has {}, …; the \
                 recording has {}, …",
                list(model),
                list(recording)
            );
        }
        write!(f, "{FEWEST} markers are the fewest, ")?;
        match usable.len() {
            0 => f.write_str("and none can be used")?,
            n => write!(f, "and {n} can be used ({})", list(usable))?,
        }
        if !moving.is_empty() {
            write!(f, "; these do not stand still: {}", list(moving))?;
        }
        f.write_str("; give a trial of a person who stands still, with more of the model's markers")
    }
}

impl std::error::Error for ScaleError {}

/// Scales a model to the person of a static trial.
///
/// # Errors
/// [`ScaleError`] where fewer than three markers of the model are seen standing still.
///
/// ```
/// use condyle::scaling::{Assumptions, fit};
/// use condyle::{ModelBuilder, formats::{LengthUnit, Recording}, math::Vec3};
///
/// let mut b = ModelBuilder::new("ruler");
/// let ruler = b.segment("ruler", None);
/// for (name, x) in [("a", 0.1), ("b", 0.2), ("c", 0.4)] {
///     b.marker(name, Some(ruler), Vec3::new(x, 0.0, 0.0));
/// }
/// let model = b.build().unwrap();
/// // Half as long again.
/// let recording = Recording {
///     labels: vec!["a".into(), "b".into(), "c".into()],
///     rate: 100.0,
///     times: vec![0.0],
///     positions: [0.15, 0.3, 0.6].map(|x| [x, 0.0, 0.0].into()).to_vec(),
///     units: LengthUnit::Metre,
///     ..Recording::default()
/// };
/// let scaled = fit(&model, &recording, &Assumptions::default()).unwrap();
/// assert!((scaled.body.factor - 1.5).abs() < 1e-6);
/// ```
pub fn fit(
    model: &Model,
    recording: &Recording,
    assumed: &Assumptions,
) -> Result<Scaled, ScaleError> {
    let mut warnings = vec![];
    let standing = Standing::find(model, recording, assumed, &mut warnings)?;
    if model.size_groups().is_empty() {
        let said = Diagnostic::warning("scale/no-groups", "the model names no size groups");
        warnings
            .push(said.with_help("one factor is found for the whole body; add tables [size.…]"));
    }
    if model.components().iter().any(|c| matches!(c.law, Law::Custom(_))) {
        let said = Diagnostic::warning("scale/custom", "laws of kind `custom` keep their lengths");
        warnings
            .push(said.with_help("only their author knows which of their parameters are lengths"));
    }
    let mut search = Search::new(model, &standing, assumed);
    let before = search.first(&vec![0.0; search.len()]);
    let rms_before = before.answer.rms();
    // The body as a whole first: a posture found at the wrong size may be a wrong one.
    let whole = search.descend(before, true);
    let again = search.first(&whole.logs);
    let mut best = search.descend(if again.cost < whole.cost { again } else { whole }, false);
    let again = search.first(&best.logs);
    if again.cost < best.cost * (1.0 - 1e-9) {
        best = search.descend(again, false);
    }
    for _ in 0..ROUNDS {
        if !search.weigh(&best.answer) {
            break;
        }
        let start = search.at(&best.logs, Some(&best.answer.coordinates));
        best = search.descend(start, false);
    }
    let spreads = search.spreads(&best);
    let scaled = search.model_at(&best.logs);
    let (model_out, markers) = placed(&scaled, &standing, &best, assumed, &mut warnings);
    let lengths = lengths(model);
    let factor = |i: usize| Factor {
        name: i.checked_sub(1).map_or("body", |g| &model.size_groups()[g].name).to_owned(),
        factor: best.logs[i].exp(),
        spread: spreads[i],
        length: lengths[i],
    };
    let body = factor(0);
    let groups: Vec<Factor> = (1..search.len()).map(factor).collect();
    for factor in std::iter::once(&body).chain(&groups) {
        let [least, most] = FACTORS;
        if factor.factor < least * (1.0 + 1e-6) || factor.factor > most * (1.0 - 1e-6) {
            let message =
                format!("the factor of `{}` is at its bound {:.2}", factor.name, factor.factor);
            let said = Diagnostic::warning("scale/bound", message);
            warnings.push(said.with_help("is the unit of the recording right?"));
        }
    }
    if !best.answer.status.is_solved() {
        let message =
            format!("the posture may not be the best one ({})", best.answer.status.name());
        warnings.push(Diagnostic::warning("scale/posture", message));
    }
    let used = |name: &String| markers.iter().any(|m| m.name == *name);
    let names = model.markers().iter().map(|m| m.name.clone());
    Ok(Scaled {
        unused: names.filter(|name| !used(name)).collect(),
        model: model_out,
        body,
        groups,
        rms_before,
        rms_after: best.answer.rms(),
        posture: best.answer.coordinates,
        status: best.answer.status,
        markers,
        warnings,
    })
}

/// Where the markers stand.
struct Standing {
    /// Positions among the model's markers.
    markers: Vec<usize>,
    /// Where each of them was seen.
    places: Vec<Option<[f64; 3]>>,
    /// How sure each of them is: the mean of the squares of its confidences; 1 without any.
    sure: Vec<f64>,
}

impl Standing {
    fn find(
        model: &Model,
        recording: &Recording,
        assumed: &Assumptions,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self, ScaleError> {
        let subject = assumed.subject.as_deref();
        let matched = match_markers(model, &recording.labels, subject);
        let (matches, said) = matched.map_err(ScaleError::Subject)?;
        warnings.extend(said);
        let mut standing = Self { markers: vec![], places: vec![], sure: vec![] };
        let still = if recording.confidences.is_some() { STILL_ESTIMATE } else { STILL };
        let (mut usable, mut moving, mut by) = (vec![], vec![], vec![]);
        for found in matches {
            let name = &model.markers()[found.marker].name;
            let weighed = |frame| {
                let place = Vec3::from(recording.position(frame, found.label)?);
                let sure = recording.confidence(frame, found.label);
                (place.is_finite() && sure >= LEAST_CONFIDENCE).then_some((place, sure * sure))
            };
            let seen: Vec<(Vec3, f64)> = (0..recording.frames()).filter_map(weighed).collect();
            let Some(place) = median_place(&seen) else { continue };
            let strays = sway(&seen, place);
            if strays > still {
                by.push(format!("{name} by {:.0} mm", 1e3 * strays));
                moving.push(name.clone());
                continue;
            }
            standing.markers.push(found.marker);
            standing.places.push(Some(place.to_array()));
            let sum: f64 = seen.iter().map(|(_, weight)| weight).sum();
            standing.sure.push(sum / seen.len() as f64);
            usable.push(name.clone());
        }
        if !by.is_empty() {
            let message = format!("{} markers move: {}", by.len(), listed(by));
            let said = Diagnostic::warning("scale/moving", message);
            warnings.push(said.with_help("they are left out: the person should stand still"));
        }
        if usable.len() >= FEWEST {
            return Ok(standing);
        }
        let some = |names: &mut dyn Iterator<Item = &String>| names.take(4).cloned().collect();
        Err(ScaleError::TooFewMarkers {
            usable,
            moving,
            model: some(&mut model.markers().iter().map(|m| &m.name)),
            recording: some(&mut recording.labels.iter()),
        })
    }
}

/// The weighted median of each coordinate; none of nothing.
fn median_place(seen: &[(Vec3, f64)]) -> Option<Vec3> {
    let half = 0.5 * seen.iter().map(|(_, weight)| weight).sum::<f64>();
    let middle = |axis: usize| {
        let mut list: Vec<(f64, f64)> =
            seen.iter().map(|(place, weight)| (place.to_array()[axis], *weight)).collect();
        list.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Half of the weight is reached at one, and passed at that or the next.
        let (mut sum, mut low) = (0.0, None);
        for (value, weight) in &list {
            sum += weight;
            if sum >= half && low.is_none() {
                low = Some(*value);
            }
            if sum > half {
                return Some(0.5 * (low? + value));
            }
        }
        list.last().map(|(value, _)| *value)
    };
    Some(Vec3::new(middle(0)?, middle(1)?, middle(2)?))
}

/// The distance from a place within which 19 of 20 others lie: one frame that is wrong is no motion.
fn sway(seen: &[(Vec3, f64)], place: Vec3) -> f64 {
    let mut far: Vec<f64> = seen.iter().map(|(p, _)| (*p - place).norm()).collect();
    far.sort_by(f64::total_cmp);
    far.get((far.len() * 19).div_ceil(20).saturating_sub(1)).copied().unwrap_or(0.0)
}

/// A set of factors and the posture that goes with it.
struct State {
    /// Logarithms: of the body, then of each group.
    logs: Vec<f64>,
    answer: FrameAnswer,
    residuals: Vec<f64>,
    cost: f64,
}

struct Search<'m> {
    model: &'m Model,
    standing: &'m Standing,
    assumed: &'m Assumptions,
    targets: Targets,
    /// For each segment the position of its factor's logarithm.
    of_segment: Vec<usize>,
}

impl<'m> Search<'m> {
    fn new(model: &'m Model, standing: &'m Standing, assumed: &'m Assumptions) -> Self {
        let of_segment = factors_of_segments(model);
        let all = standing.markers.iter().zip(&standing.sure);
        let markers = all.map(|(&marker, &weight)| MarkerTarget { marker, weight }).collect();
        let targets = Targets { markers, ..Targets::default() };
        Self { model, standing, assumed, targets, of_segment }
    }

    /// Weighs the markers anew; answers whether that changes anything.
    fn weigh(&mut self, answer: &FrameAnswer) -> bool {
        let bound = TRUSTED * self.assumed.marker_spread;
        let mut change = 0.0f64;
        let errors = answer.marker_errors.iter().zip(&self.standing.sure);
        for (target, (&error, &sure)) in self.targets.markers.iter_mut().zip(errors) {
            // What is less sure is also expected farther off: its own bound is wider by as much.
            let error = error * sure.sqrt();
            let weight = sure * if error > bound { (bound / error).powi(2) } else { 1.0 };
            change = change.max((weight - target.weight).abs());
            target.weight = weight;
        }
        change > 1e-3
    }

    fn len(&self) -> usize {
        1 + self.model.size_groups().len()
    }

    fn model_at(&self, logs: &[f64]) -> Model {
        let factors: Vec<f64> = self.of_segment.iter().map(|&i| logs[i].exp()).collect();
        self.model.scaled(&factors)
    }

    /// The posture at these factors, about which nothing is known.
    fn first(&self, logs: &[f64]) -> State {
        self.at(logs, None)
    }

    /// The posture at these factors, from one near by if there is one.
    fn at(&self, logs: &[f64], near: Option<&[f64]>) -> State {
        let rules = Rules { tolerance: 1e-12, ..Rules::default() };
        let model = self.model_at(logs);
        let mut targets = self.targets.clone();
        targets.postures = posture::of_model(&model).collect();
        let tracker = Tracker::new(model, targets, rules);
        let mut scratch = Scratch::new(&tracker);
        let places = &self.standing.places;
        let answer = match near {
            Some(start) => tracker.solve_frame(&mut scratch, places, 0, start),
            None => tracker.solve_first(&mut scratch, places, 0, GUESSES),
        };
        let mut pose = Pose::new(tracker.program());
        let mut residuals = vec![];
        // The buffers are of this program, so nothing can be refused.
        let _ = tracker.program().evaluate(&answer.coordinates, Mode::Open, &mut pose);
        for (target, place) in self.targets.markers.iter().zip(places) {
            let marker = &tracker.model().markers()[target.marker];
            let at = marker.segment.map_or(marker.point, |id| pose.segment(id) * marker.point);
            let off = at - place.map_or(at, Vec3::from);
            let scale = target.weight.sqrt() / self.assumed.marker_spread;
            residuals.extend(off.to_array().map(|x| x * scale));
        }
        let weights: f64 = self.targets.markers.iter().map(|target| target.weight).sum();
        for target in &tracker.targets().postures {
            let value = |&(id, factor): &(_, f64)| factor * pose.coordinate(tracker.model(), id)[0];
            let off = target.terms.iter().map(value).sum::<f64>() - target.rest;
            let scale = (target.stiffness * weights).sqrt() / self.assumed.marker_spread;
            residuals.push(off * scale);
        }
        let groups = logs[1..].iter().map(|log| (log - logs[0]) / self.assumed.group_spread);
        residuals.extend(groups);
        let cost = residuals.iter().map(|r| r * r).sum();
        State { logs: logs.to_vec(), answer, residuals, cost }
    }

    /// The directions in which factors may go: all of them together, or each.
    fn directions(&self, together: bool) -> Vec<Vec<f64>> {
        let n = self.len();
        match together {
            true => vec![vec![1.0; n]],
            false => {
                (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect()
            }
        }
    }

    /// The derivative of the residuals along each direction, the posture following.
    fn derivatives(&self, here: &State, directions: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let near = Some(here.answer.coordinates.as_slice());
        let along = |direction: &Vec<f64>| {
            let [ahead, behind] = [STEP, -STEP].map(|step| {
                let logs: Vec<f64> =
                    here.logs.iter().zip(direction).map(|(x, d)| x + step * d).collect();
                self.at(&logs, near).residuals
            });
            ahead.iter().zip(behind).map(|(a, b)| (a - b) / (2.0 * STEP)).collect()
        };
        directions.iter().map(along).collect()
    }

    /// Gauss-Newton steps, halved until they help.
    fn descend(&self, mut here: State, together: bool) -> State {
        let directions = self.directions(together);
        let bounds = FACTORS.map(f64::ln);
        for _ in 0..ITERATIONS {
            let slopes = self.derivatives(&here, &directions);
            let gradient: Vec<f64> =
                slopes.iter().map(|column| dot(column, &here.residuals)).collect();
            let inverse = inverse_of_squares(&slopes);
            let step: Vec<f64> = inverse.iter().map(|row| -dot(row, &gradient)).collect();
            let mut share = 1.0;
            let mut next = None;
            while share > 1e-3 {
                let mut logs = here.logs.clone();
                for (direction, length) in directions.iter().zip(&step) {
                    for (x, d) in logs.iter_mut().zip(direction) {
                        *x += share * length * d;
                    }
                }
                logs.iter_mut().for_each(|x| *x = x.clamp(bounds[0], bounds[1]));
                let there = self.at(&logs, Some(&here.answer.coordinates));
                if there.cost < here.cost {
                    next = Some(there);
                    break;
                }
                share *= 0.5;
            }
            let Some(there) = next else { break };
            let moved = there.logs.iter().zip(&here.logs).map(|(a, b)| (a - b).abs());
            let moved = moved.fold(0.0, f64::max);
            here = there;
            if moved < 1e-8 {
                break;
            }
        }
        here
    }

    /// The standard deviation of each logarithm.
    fn spreads(&self, here: &State) -> Vec<f64> {
        let slopes = self.derivatives(here, &self.directions(false));
        let inverse = inverse_of_squares(&slopes);
        (0..self.len()).map(|i| inverse[i][i].max(0.0).sqrt()).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// (JᵀJ)⁻¹ of the columns of J; what nothing determines is as good as fixed.
fn inverse_of_squares(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = columns.len();
    let mut rows: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            let squares = (0..n).map(|j| dot(&columns[i], &columns[j]));
            squares.chain((0..n).map(|j| f64::from(u8::from(i == j)))).collect()
        })
        .collect();
    let most = (0..n).map(|i| rows[i][i]).fold(0.0, f64::max);
    let ridge = if most > 0.0 { 1e-12 * most } else { 1.0 };
    // Positive definite, so the diagonal is a good pivot.
    (0..n).for_each(|i| rows[i][i] += ridge);
    for pivot in 0..n {
        let scale = 1.0 / rows[pivot][pivot].max(ridge);
        rows[pivot].iter_mut().for_each(|x| *x *= scale);
        let row = rows[pivot].clone();
        for (_, other) in rows.iter_mut().enumerate().filter(|(i, _)| *i != pivot) {
            let share = other[pivot];
            other.iter_mut().zip(&row).for_each(|(x, p)| *x -= share * p);
        }
    }
    rows.into_iter().map(|row| row[n..].to_vec()).collect()
}

/// For each segment the position of its factor: 0 for the body, then the groups.
fn factors_of_segments(model: &Model) -> Vec<usize> {
    let mut of_segment = vec![0; model.segments().len()];
    for (index, group) in model.size_groups().iter().enumerate() {
        group.segments.iter().for_each(|id| of_segment[id.index()] = index + 1);
    }
    of_segment
}

/// For each factor the longest stretch in a segment from its joint to the next, or to a marker.
fn lengths(model: &Model) -> Vec<f64> {
    let of_segment = factors_of_segments(model);
    let mut lengths = [vec![0.0f64; 1 + model.size_groups().len()], vec![]];
    lengths[1] = lengths[0].clone();
    let joint = |id: SegmentId| model.segment(id).joint_in_segment.translation;
    let bones =
        model.segments().iter().filter_map(|s| Some((s.parent?, s.joint_in_parent.translation)));
    let markers = model.markers().iter().filter_map(|m| Some((m.segment?, m.point)));
    let all = bones.map(|b| (0, b)).chain(markers.map(|m| (1, m)));
    for (kind, (segment, point)) in all {
        let known = &mut lengths[kind][of_segment[segment.index()]];
        *known = known.max((point - joint(segment)).norm());
    }
    let [bones, markers] = lengths;
    bones.into_iter().zip(markers).map(|(b, m)| if b > 0.0 { b } else { m }).collect()
}

/// The scaled model with its markers where they were seen, and what that took.
fn placed(
    scaled: &Model,
    standing: &Standing,
    best: &State,
    assumed: &Assumptions,
    warnings: &mut Vec<Diagnostic>,
) -> (Model, Vec<MarkerFit>) {
    let program = condyle_model::Program::compile(scaled);
    let mut pose = Pose::new(&program);
    let _ = program.evaluate(&best.answer.coordinates, Mode::Open, &mut pose);
    let mut points = vec![None; scaled.markers().len()];
    let (mut fits, mut far) = (vec![], vec![]);
    let seen = standing.markers.iter().zip(&standing.places).zip(&best.answer.marker_errors);
    for (((&index, place), &error), &sure) in seen.zip(&standing.sure) {
        let marker = &scaled.markers()[index];
        let mut moved = 0.0;
        if !assumed.keep_markers
            && sure >= MOVED
            && let (Some(id), Some(place)) = (marker.segment, place)
        {
            let segment = pose.segment(id);
            let back = segment.linear.inverse();
            let point = back * (Vec3::from(*place) - segment.translation);
            if point.is_finite() {
                moved = (point - marker.point).norm();
                points[index] = Some(point);
            }
        }
        if moved > FAR {
            far.push((moved, format!("{} by {:.0} mm", marker.name, 1e3 * moved)));
        }
        fits.push(MarkerFit { name: marker.name.clone(), error, moved });
    }
    if !far.is_empty() {
        far.sort_by(|a, b| b.0.total_cmp(&a.0));
        let count = far.len();
        let message =
            format!("{count} markers are moved far: {}", listed(far.iter().map(|f| &f.1)));
        let said = Diagnostic::warning("scale/far", message);
        warnings.push(said.with_help("are they the markers that the model means?"));
    }
    (scaled.with_markers_at(&points), fits)
}
