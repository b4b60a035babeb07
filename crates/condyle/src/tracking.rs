//! A recording in, a motion out.

use crate::matching::match_markers;
use condyle_diagnostics::Diagnostic;
use condyle_formats::opensim::setup::{CoordinateTarget, IkSetup, IkTasks};
use condyle_model::{CoordinateId, Model};
use condyle_motion::{BLANK, Motion, Recording, Table};
use condyle_track::robust::{self, Corrected};
use condyle_track::sequence;
use condyle_track::{
    FrameAnswer, FrameStatus, MarkerTarget, Recorded, Rules, Scratch, Targets, Tracker, Wanted,
};
use std::collections::HashMap;
use std::fmt;
use std::time::Instant;

/// How a recording is tracked.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Weights by marker name; `None` gives every marker that model and recording share weight 1.
    pub marker_weights: Option<HashMap<String, f64>>,
    /// Coordinate targets by coordinate name: weight, and the value or where it comes from.
    pub coordinates: Vec<(String, f64, CoordinateTarget)>,
    /// The motion that targets "from file" are taken from.
    pub coordinate_file: Option<Table>,
    /// First and last time, in seconds.
    pub time_range: Option<[f64; 2]>,
    /// Weight of loop errors; infinite closes loops exactly.
    pub closure_weight: f64,
    /// Hold coordinates to their enforced ranges.
    pub limits: bool,
    /// Find swapped labels, and weigh markers down that are far off.
    pub robust: bool,
    /// Threads; `None` for as many as there are cores.
    pub threads: Option<usize>,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            marker_weights: None,
            coordinates: vec![],
            coordinate_file: None,
            time_range: None,
            closure_weight: f64::INFINITY,
            limits: true,
            robust: false,
            threads: None,
        }
    }
}

impl Plan {
    /// What a setup of OpenSim asks for.
    pub fn from_setup(setup: &IkSetup) -> Self {
        let mut plan = Self {
            time_range: setup.time_range,
            closure_weight: setup.constraint_weight,
            ..Self::default()
        };
        if let IkTasks::Inline(tasks) = &setup.tasks {
            let on = tasks.markers.iter().filter(|t| t.apply);
            plan.marker_weights = Some(on.map(|t| (t.name.clone(), t.weight)).collect());
            let on = tasks.coordinates.iter().filter(|t| t.apply && t.weight > 0.0);
            plan.coordinates = on.map(|t| (t.name.clone(), t.weight, t.target)).collect();
        }
        plan
    }
}

/// Why nothing could be tracked.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TrackError {
    /// Model and recording have no marker in common.
    NoCommonMarkers {
        /// Some of the model's markers.
        model: Vec<String>,
        /// Some of the recording's labels.
        recording: Vec<String>,
    },
    /// No frame lies in the time range.
    NoFrames {
        /// What was asked for and what there is.
        message: String,
    },
}

impl fmt::Display for TrackError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoCommonMarkers { model, recording } if model.is_empty() => write!(
                f,
                "the model has no markers (the recording's are {}, …): add a marker set to the model",
                recording.join(", ")
            ),
            Self::NoCommonMarkers { model, recording } => write!(
                f,
                "model and recording share no marker with a positive weight: the model has {}, …; \
                 the recording has {}, …",
                model.join(", "),
                recording.join(", ")
            ),
            Self::NoFrames { message } => f.write_str(message),
        }
    }
}

impl std::error::Error for TrackError {}

/// A tracked recording.
#[derive(Clone, Debug)]
pub struct Tracking {
    /// The coordinates of every frame.
    pub motion: Motion,
    /// What came out of every frame, in order.
    pub answers: Vec<FrameAnswer>,
    /// Names of the markers used, in the order of each answer's errors.
    pub markers: Vec<String>,
    /// For each marker used, its position among the recording's labels.
    pub labels: Vec<usize>,
    /// The recording's frames that were tracked.
    pub frames: std::ops::Range<usize>,
    /// Seconds spent solving.
    pub seconds: f64,
    /// What was odd.
    pub warnings: Vec<Diagnostic>,
    /// Labels that were found exchanged, by frame range (robust tracking only).
    pub swaps: Vec<Swap>,
}

/// Two labels that stand for each other's marker over some frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Swap {
    /// The two labels.
    pub labels: [String; 2],
    /// Frames of the recording, from 0.
    pub frames: std::ops::Range<usize>,
}

/// Tracks a recording; `progress` hears how many frames of how many are done.
///
/// # Errors
/// [`TrackError`] if there is nothing to track. Frames that cannot be solved are marked in their
/// answer, never an error.
pub fn track(
    model: &Model,
    recording: &Recording,
    plan: &Plan,
    progress: &mut (dyn FnMut(usize, usize) + Send),
) -> Result<Tracking, TrackError> {
    let (matches, mut warnings) = match_markers(model, &recording.labels);
    let mut tasks = Targets::default();
    let mut labels = vec![];
    let mut markers = vec![];
    for found in matches {
        let name = &model.markers()[found.marker].name;
        let weight = match &plan.marker_weights {
            None => 1.0,
            Some(weights) => weights.get(name).copied().unwrap_or(0.0),
        };
        if weight > 0.0 {
            tasks.markers.push(MarkerTarget { marker: found.marker, weight });
            labels.push(found.label);
            markers.push(name.clone());
        }
    }
    if let Some(weights) = &plan.marker_weights {
        note_unused_tasks(weights, &markers, &mut warnings);
    }
    if tasks.markers.is_empty() {
        let some = |names: Vec<String>| names.into_iter().take(4).collect();
        return Err(TrackError::NoCommonMarkers {
            model: some(model.markers().iter().map(|m| m.name.clone()).collect()),
            recording: some(recording.labels.clone()),
        });
    }
    let frames = frames_in(recording, plan.time_range)?;
    add_coordinate_tasks(model, recording, plan, &frames, &mut tasks, &mut warnings);
    tasks.closure_weight = plan.closure_weight.is_finite().then_some(plan.closure_weight);
    let rules = Rules { limits: plan.limits, robust: plan.robust, ..Rules::default() };
    let tracker = Tracker::new(model.clone(), tasks, rules);
    let mut job = Job { tracker, recording, labels, frames, progress };
    let start = Instant::now();
    let (answers, swaps) = job.run(plan.threads, plan.robust);
    let seconds = start.elapsed().as_secs_f64();
    let motion = Motion {
        times: recording.times[job.frames.clone()].to_vec(),
        frames: answers.iter().map(|a| a.coordinates.clone()).collect(),
    };
    let Job { labels, frames, .. } = job;
    Ok(Tracking { motion, answers, markers, labels, frames, seconds, warnings, swaps })
}

fn note_unused_tasks(
    weights: &HashMap<String, f64>,
    markers: &[String],
    warnings: &mut Vec<Diagnostic>,
) {
    let mut unused: Vec<&String> = weights
        .iter()
        .filter(|(name, weight)| **weight > 0.0 && !markers.contains(name))
        .map(|(name, _)| name)
        .collect();
    unused.sort();
    if !unused.is_empty() {
        let list: Vec<String> = unused.iter().map(|n| format!("`{n}`")).collect();
        let message =
            format!("tasks for markers that model or recording lack: {}", list.join(", "));
        warnings.push(Diagnostic::warning("track/unused-task", message));
    }
}

fn frames_in(
    recording: &Recording,
    range: Option<[f64; 2]>,
) -> Result<std::ops::Range<usize>, TrackError> {
    let times = &recording.times;
    let Some([first, last]) = range else { return Ok(0..times.len()) };
    // A little slack: ranges are written with fewer digits than times.
    let slack = 1e-6;
    let start = times.partition_point(|&t| t < first - slack);
    let end = times.partition_point(|&t| t <= last + slack);
    if start < end {
        return Ok(start..end);
    }
    let ends = (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(0.0));
    Err(TrackError::NoFrames {
        message: format!(
            "no frame lies between {first} and {last} s: the recording runs from {} to {} s",
            ends.0, ends.1
        ),
    })
}

fn add_coordinate_tasks(
    model: &Model,
    recording: &Recording,
    plan: &Plan,
    frames: &std::ops::Range<usize>,
    tasks: &mut Targets,
    warnings: &mut Vec<Diagnostic>,
) {
    let file = plan.coordinate_file.as_ref().map(|table| {
        let (motion, said) = Motion::from_table(model, table);
        warnings.extend(said.into_iter().filter(|d| d.code == BLANK));
        (motion, table)
    });
    for (name, weight, target) in &plan.coordinates {
        let id = match model.find_coordinate(name) {
            Ok(id) => id,
            Err(error) => {
                let said = Diagnostic::warning("track/unknown-coordinate", format!("{error}"));
                warnings.push(said.with_help("the task is ignored"));
                continue;
            }
        };
        let target = match (target, &file) {
            (CoordinateTarget::Default, _) => Wanted::Constant(model.coordinate(id).default[0]),
            (CoordinateTarget::Manual(value), _) => Wanted::Constant(*value),
            (CoordinateTarget::FromFile, Some((motion, table))) if table.column(name).is_some() => {
                let times = recording.times[frames.clone()].iter();
                let value = |&t| motion.at(model, t).map_or(f64::NAN, |q| model.value(&q, id));
                Wanted::PerFrame(times.map(value).collect())
            }
            (CoordinateTarget::FromFile, _) => {
                let message = format!("no coordinate file gives values for `{name}`");
                let said = Diagnostic::warning("track/no-coordinate-file", message);
                warnings.push(said.with_help("the task is ignored"));
                continue;
            }
        };
        tasks.coordinates.push(condyle_track::CoordinateTarget {
            coordinate: id,
            weight: *weight,
            wanted: target,
        });
    }
}

/// One recording on its way through the tracker.
struct Job<'a> {
    tracker: Tracker,
    recording: &'a Recording,
    labels: Vec<usize>,
    frames: std::ops::Range<usize>,
    progress: &'a mut (dyn FnMut(usize, usize) + Send),
}

/// The recording's markers in the order of the tasks.
struct Ordered<'a> {
    recording: &'a Recording,
    labels: &'a [usize],
    first: usize,
}

impl Recorded for Ordered<'_> {
    fn positions(&self, frame: usize, seen: &mut Vec<Option<[f64; 3]>>) {
        let row = self.recording.frame(self.first + frame);
        seen.clear();
        seen.extend(
            self.labels.iter().map(|&label| row.get(label).and_then(|seen| seen.position())),
        );
    }
}

impl Job<'_> {
    /// Tracks all frames; with robust options, once more with exchanged labels put right.
    fn run(&mut self, threads: Option<usize>, robust: bool) -> (Vec<FrameAnswer>, Vec<Swap>) {
        let labels = std::mem::take(&mut self.labels);
        let recorded =
            Ordered { recording: self.recording, labels: &labels, first: self.frames.start };
        let mut answers = self.pass(threads, &recorded);
        let mut swaps = vec![];
        if robust {
            let mut scratch = Scratch::new(&self.tracker);
            let exchanged =
                robust::find_exchanged(&self.tracker, &mut scratch, &recorded, &answers);
            if !exchanged.is_empty() {
                let corrected = Corrected { recorded: &recorded, exchanged: &exchanged };
                answers = self.pass(threads, &corrected);
            }
            let name = |task: usize| self.recording.labels[labels[task]].clone();
            let first = self.frames.start;
            swaps.extend(exchanged.iter().map(|e| Swap {
                labels: e.markers.map(name),
                frames: first + e.frames.start..first + e.frames.end,
            }));
        }
        self.labels = labels;
        (answers, swaps)
    }

    fn pass(&mut self, threads: Option<usize>, recorded: &dyn Recorded) -> Vec<FrameAnswer> {
        let total = self.frames.len();
        let chunks = sequence::cut(total);
        let tracker = &self.tracker;
        let mut scratch = Scratch::new(tracker);
        let keys = sequence::keys(tracker, &mut scratch, recorded, &chunks);
        let progress = std::sync::Mutex::new((0usize, &mut self.progress));
        let solve = |index: usize, scratch: &mut Scratch| {
            let chunk = &chunks[index];
            let answers =
                sequence::solve_chunk(tracker, scratch, recorded, chunk, &keys[index], total);
            if let Ok(mut told) = progress.lock() {
                told.0 += chunk.frames.len();
                let done = told.0;
                (told.1)(done, total);
            }
            answers
        };
        let answers = in_parallel(threads, chunks.len(), || Scratch::new(tracker), solve);
        sequence::stitch(tracker, &mut scratch, recorded, &chunks, answers)
    }
}

/// Runs `work` for every index, on threads where the feature allows, in any order; the answers
/// are in order.
fn in_parallel<T: Send, S>(
    threads: Option<usize>,
    count: usize,
    scratch: impl Fn() -> S + Sync + Send,
    work: impl Fn(usize, &mut S) -> T + Sync + Send,
) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        if threads != Some(1)
            && let Ok(pool) =
                rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build()
        {
            return pool.install(|| {
                let indices = (0..count).into_par_iter().with_max_len(1);
                indices.map_init(scratch, |scratch, index| work(index, scratch)).collect()
            });
        }
    }
    let _ = threads;
    let mut scratch = scratch();
    (0..count).map(|index| work(index, &mut scratch)).collect()
}

/// Numbers about a whole tracking.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Frames tracked.
    pub frames: usize,
    /// Seconds spent solving.
    pub seconds: f64,
    /// Frames per second of solving.
    pub frames_per_second: f64,
    /// Markers with a positive weight.
    pub markers_used: usize,
    /// Mean over frames of the RMS over markers, in metres.
    pub rms: f64,
    /// Largest marker error of all frames, in metres.
    pub max: f64,
    /// Mean of F.
    pub objective: f64,
    /// Mean of Σ w |e|².
    pub objective_markers: f64,
    /// Frames whose answer is not to be trusted: position and reason.
    pub failed: Vec<(usize, FrameStatus)>,
}

impl Tracking {
    /// Sums the tracking up.
    pub fn summary(&self) -> Summary {
        let n = self.answers.len();
        let mean = |f: &dyn Fn(&FrameAnswer) -> f64| {
            self.answers.iter().map(f).sum::<f64>() / n.max(1) as f64
        };
        Summary {
            frames: n,
            seconds: self.seconds,
            frames_per_second: n as f64 / self.seconds.max(1e-9),
            markers_used: self.markers.len(),
            rms: mean(&FrameAnswer::rms),
            max: self.answers.iter().map(FrameAnswer::max).fold(0.0, f64::max),
            objective: mean(&|a| a.objective),
            objective_markers: mean(&|a| a.weighted_squares),
            failed: self
                .answers
                .iter()
                .enumerate()
                .filter(|(_, a)| !a.status.is_solved())
                .map(|(i, a)| (self.frames.start + i, a.status))
                .collect(),
        }
    }

    /// Coordinates that touch a bound of their enforced range, with the number of frames in which
    /// they do.
    pub fn at_limits(&self, model: &Model) -> Vec<(CoordinateId, usize)> {
        let touches = |id: CoordinateId| {
            let (lower, upper) = model.coordinate(id).range.bounds();
            let place = model.stored_range(id).start;
            let frames = self.motion.frames.iter();
            frames.filter(|f| f[place] <= lower || f[place] >= upper).count()
        };
        let free = model.coordinate_ids().filter(|&id| model.coordinate(id).follows.is_none());
        free.map(|id| (id, touches(id))).filter(|(_, frames)| *frames > 0).collect()
    }

    /// For each marker used, the RMS and the largest of its errors over the frames that saw it.
    pub fn marker_errors(&self) -> Vec<(f64, f64)> {
        (0..self.markers.len())
            .map(|m| {
                let seen =
                    self.answers.iter().map(|a| a.marker_errors[m]).filter(|e| e.is_finite());
                let (sum, max, n) =
                    seen.fold((0.0, 0.0, 0), |(s, m, n), e| (s + e * e, f64::max(m, e), n + 1));
                ((sum / f64::from(n.max(1))).sqrt(), max)
            })
            .collect()
    }
}
