//! One recording on its way through a tracker.

use super::jump::Judged;
use super::{Faulty, Request, Swap, Tracking, UnusedMarkers, Variant, Verdict, posture, verdict};
use crate::matching::{Match, match_markers};
use condyle_diagnostics::{Diagnostic, Error};
use condyle_model::Model;
use condyle_motion::Recording;
use condyle_track::robust::{self, Corrected, Repairs};
use condyle_track::{
    Answers, FrameAnswer, MarkerTarget, Recorded, Rules, Run, Scratch, Targets, Tracker, Trust,
    sequence,
};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Mutex};

/// The solver's tolerance for frames whose unit is wrong.
const ROUGHLY: f64 = 1e-2;

/// A recording whose markers are matched to a model, ready to be solved.
#[derive(Clone, Debug)]
pub struct Job<'a> {
    tracker: Arc<Tracker>,
    rules: Rules,
    recording: &'a Recording,
    pub(super) markers: Vec<String>,
    pub(super) labels: Vec<usize>,
    frames: Range<usize>,
    pub(super) warnings: Vec<Diagnostic>,
    threads: Option<usize>,
    robust: bool,
    max_rms: f64,
    left_out: LeftOut,
}

/// A position that is less sure counts as not seen.
pub(crate) const LEAST_CONFIDENCE: f64 = 0.05;

/// How many chunks are judged before their trust is put together.
const JUDGED: usize = 1024;

/// Markers that both sides have and that are not used all the same.
#[derive(Clone, Debug, Default)]
struct LeftOut {
    /// Labels that no frame shows.
    never_seen: Vec<String>,
    /// Markers of the model of weight 0.
    without_weight: Vec<String>,
}

impl<'a> Job<'a> {
    /// Matches a recording to a model, and prepares what is asked.
    ///
    /// # Errors
    /// Those of [`match_markers`]; `track/no-common-markers` if model and recording have no marker of positive weight in common,
    /// `track/no-frames` if no frame lies in the time range, `track/weight`, `track/posture` and
    /// `track/unknown-marker` if the request asks for what cannot be.
    pub fn new(
        model: impl Into<Arc<Model>>,
        recording: &'a Recording,
        request: &Request,
    ) -> Result<Self, Error> {
        let model = model.into();
        request.check()?;
        let weights = request.weights_of(&model)?;
        let mut warnings = vec![];
        let renamed = request.renamed(&model, &recording.labels, &mut warnings);
        let (matches, guesses) = match_markers(&model, &renamed, request.subject.as_deref())?;
        warnings.extend(guesses);
        if let Some(weights) = &request.marker_weights {
            let names = |found: &Match| model.markers()[found.marker].name.clone();
            warnings.extend(unused_tasks(weights, &matches.iter().map(names).collect::<Vec<_>>()));
        }
        let (mut weighed, light): (Vec<Match>, Vec<Match>) =
            matches.into_iter().partition(|found| weights[found.marker] > 0.0);
        if weighed.is_empty() {
            return Err(no_common_markers(&model, recording));
        }
        let frames = frames_in(recording, request.time_range, &mut warnings)?;
        let (seen, hidden): (Vec<Match>, Vec<Match>) =
            weighed.iter().copied().partition(|found| is_seen(recording, &frames, found.label));
        // Where no marker is ever seen, every frame says so.
        let mut left_out = LeftOut::default();
        if !seen.is_empty() {
            let label = |found: &Match| recording.labels[found.label].clone();
            left_out.never_seen = hidden.iter().map(label).collect();
            weighed = seen;
        }
        let name = |found: &Match| model.markers()[found.marker].name.clone();
        left_out.without_weight = light.iter().map(name).collect();
        let target =
            |found: &Match| MarkerTarget { marker: found.marker, weight: weights[found.marker] };
        let mut targets =
            Targets { markers: weighed.iter().map(target).collect(), ..Targets::default() };
        let markers = weighed.iter().map(name).collect();
        let labels: Vec<usize> = weighed.iter().map(|found| found.label).collect();
        if recording.confidences.is_some() {
            let of_frame = |frame| labels.iter().map(move |&label| factor(recording, frame, label));
            targets.marker_factors = frames.clone().flat_map(of_frame).collect();
        }
        let times = &recording.times[frames.clone()];
        request.add_coordinates(&model, times, &mut targets, &mut warnings);
        posture::add(&model, &mut targets.postures);
        let weight = request.closure_weight;
        targets.closure_weight = weight.is_finite().then_some(weight);
        let (threads, robust) = (request.threads, request.robust);
        let rules = Rules { limits: request.limits, ..Rules::default() };
        let tracker = Arc::new(Tracker::new(model, targets, rules));
        let max_rms = request.max_rms;
        Ok(Self {
            tracker,
            rules,
            recording,
            markers,
            labels,
            frames,
            warnings,
            threads,
            robust,
            max_rms,
            left_out,
        })
    }

    /// The tracker, which a [`Stream`](super::Stream) can share.
    pub fn tracker(&self) -> &Arc<Tracker> {
        &self.tracker
    }

    /// Tracks all frames; with a robust request, faults are found and the frames that they touch tracked
    /// again. `progress` is called with the number of frames that are done and their total, the last time
    /// when all are solved; what follows is how far they can be trusted.
    ///
    /// Frames that cannot be solved are marked in their answer. Where the markers are ten times as far apart
    /// as those of a body, or more, or that much nearer, the frames are solved roughly first; if another
    /// unit explains it, that is the answer, with a warning.
    pub fn run(&self, progress: &mut (dyn FnMut(usize, usize) + Send)) -> Tracking {
        let tracker = &self.tracker;
        if verdict::power_of_unit(tracker, self.recording, self.frames.clone(), &self.labels) != 0 {
            let rules = Rules { tolerance: ROUGHLY, ..self.rules };
            let rough = Tracker::new(Arc::clone(tracker.model()), tracker.targets().clone(), rules);
            let rough = Self { tracker: Arc::new(rough), rules, robust: false, ..self.clone() };
            let mut tracking = rough.solved(progress);
            if let Some(Variant::Scaled(_)) = tracking.verdict.remedy {
                let message = "the unit is wrong, so the frames were solved roughly";
                tracking.warnings.push(Diagnostic::warning("track/rough", message));
                return tracking;
            }
        }
        self.solved(progress)
    }

    fn solved(&self, mut progress: &mut (dyn FnMut(usize, usize) + Send)) -> Tracking {
        let first = self.frames.start;
        // What is hardly sure is not seen: it would only mislead where nothing is known yet.
        let recorded_at =
            |frame, label| self.recording.confidence(frame, label) >= LEAST_CONFIDENCE;
        let recorded = |frame: usize, seen: &mut Vec<Option<[f64; 3]>>| {
            let row = self.recording.frame(first + frame);
            seen.clear();
            seen.extend(self.labels.iter().map(|&label| {
                row.get(label)?.position().filter(|_| recorded_at(first + frame, label))
            }));
        };
        let repairs = if self.robust {
            Repairs::of_origin(&self.tracker, &recorded, self.frames.len())
        } else {
            Repairs::default()
        };
        let mut answers =
            self.pass(&Corrected { recorded: &recorded, repairs: &repairs }, &mut progress);
        let (mut swaps, mut faulty) = (vec![], vec![]);
        let repairs = if self.robust {
            let mut unpacked: Vec<FrameAnswer> = answers.iter().collect();
            let repairs = self.repaired(&recorded, repairs, &mut unpacked, &mut progress);
            answers = Answers::from(&unpacked[..]);
            repairs
        } else {
            repairs
        };
        if self.robust {
            let (exchanged, found) = robust::describe(&recorded, &repairs, self.frames.len());
            let name = |marker: usize| self.recording.labels[self.labels[marker]].clone();
            let frames = |range: Range<usize>| first + range.start..first + range.end;
            swaps.extend(exchanged.into_iter().map(|e| Swap {
                labels: e.cycle.into_iter().map(name).collect(),
                frames: frames(e.frames),
            }));
            faulty.extend(found.into_iter().map(|f| Faulty {
                label: name(f.marker),
                frames: frames(f.frames),
                fault: f.fault,
            }));
        }
        progress(answers.len(), answers.len());
        let corrected = Corrected { recorded: &recorded, repairs: &repairs };
        let trust = self.trust(&corrected, &answers);
        let label = |&label: &usize| &*self.recording.labels[label];
        let judged = Judged {
            tracker: &self.tracker,
            recorded: &corrected,
            answers: &answers,
            trust: &trust,
            labels: self.labels.iter().map(label).collect(),
            swaps: &swaps,
            faulty: &faulty,
            first,
        };
        let jumps = judged.jumps();
        let times = self.recording.times[self.frames.clone()].to_vec();
        let (markers, labels) = (self.markers.clone(), self.labels.clone());
        let (frames, mut warnings) = (self.frames.clone(), self.warnings.clone());
        warnings.extend(self.robust.then(|| few_frames(frames.len())).flatten());
        let model = self.tracker.model();
        let LeftOut { never_seen, without_weight } = self.left_out.clone();
        let unused = UnusedMarkers {
            never_seen,
            without_weight,
            ..UnusedMarkers::of(model, &self.recording.labels, &markers, &labels)
        };
        let verdict = Verdict::PLAUSIBLE;
        let mut tracking = Tracking {
            times,
            answers,
            markers,
            labels,
            frames,
            warnings,
            swaps,
            faulty,
            unused,
            trust,
            unmoved: self.tracker.unmoved().collect(),
            jumps,
            verdict,
        };
        let (verdict, odd) =
            verdict::judge(&self.tracker, self.rules, self.recording, &tracking, self.max_rms);
        tracking.verdict = verdict;
        tracking.warnings.extend(odd);
        tracking
    }

    /// Finds faults and tracks what they touch again.
    fn repaired(
        &self,
        recorded: &dyn Recorded,
        mut repairs: Repairs,
        answers: &mut Vec<FrameAnswer>,
        progress: &mut &mut (dyn FnMut(usize, usize) + Send),
    ) -> Repairs {
        let tracker = &*self.tracker;
        let mut scratch = Scratch::new(tracker);
        if robust::exchanged_throughout(tracker, &mut scratch, recorded, &mut repairs, answers) {
            let again = self.pass(&Corrected { recorded, repairs: &repairs }, progress);
            *answers = again.iter().collect();
        }
        robust::find(tracker, &mut scratch, recorded, &mut repairs, answers);
        repairs
    }

    /// How far each coordinate of each answer can be trusted, frame by frame.
    fn trust(&self, recorded: &dyn Recorded, answers: &Answers) -> Vec<Trust> {
        let chunks = sequence::cut(answers.len());
        let tracker = &*self.tracker;
        let judge = |chunk: &sequence::Chunk, scratch: &mut Scratch| -> Vec<Trust> {
            let mut seen = vec![];
            let trust = chunk.frames.clone().flat_map(|frame| {
                recorded.positions(frame, &mut seen);
                tracker.trust(scratch, &seen, frame, &answers.at(frame))
            });
            trust.collect()
        };
        let mut trust = vec![];
        for chunks in chunks.chunks(JUDGED) {
            let judge = |index: usize, scratch: &mut Scratch| judge(&chunks[index], scratch);
            let parts =
                in_parallel(self.threads, chunks.len(), || Scratch::new(tracker), judge).concat();
            if trust.is_empty() {
                let frames: usize = chunks.iter().map(|chunk| chunk.frames.len()).sum();
                trust.reserve_exact(parts.len() / frames.max(1) * answers.len());
            }
            trust.extend(parts);
        }
        trust
    }

    fn pass(
        &self,
        recorded: &dyn Recorded,
        progress: &mut &mut (dyn FnMut(usize, usize) + Send),
    ) -> Answers {
        let total = self.frames.len();
        let chunks = sequence::cut(total);
        let tracker = &*self.tracker;
        let mut scratch = Scratch::new(tracker);
        let keys = sequence::keys(tracker, &mut scratch, recorded, &chunks);
        let progress = Mutex::new((0usize, progress));
        let solve = |index: usize, scratch: &mut Scratch| {
            let chunk = &chunks[index];
            let answers =
                sequence::solve_chunk(tracker, scratch, recorded, chunk, &keys[index], total);
            if let Ok(mut told) = progress.lock() {
                told.0 += chunk.frames.len();
                let done = told.0;
                (told.1)(done, total);
            }
            Run::of(&answers)
        };
        let runs = in_parallel(self.threads, chunks.len(), || Scratch::new(tracker), solve);
        sequence::stitch_runs(tracker, &mut scratch, recorded, &chunks, runs)
    }
}

/// A warning about weights of markers that are not tracked.
fn unused_tasks(weights: &HashMap<String, f64>, markers: &[String]) -> Option<Diagnostic> {
    let unused = weights.iter().filter(|(name, weight)| **weight > 0.0 && !markers.contains(name));
    let mut unused: Vec<String> = unused.map(|(name, _)| format!("`{name}`")).collect();
    unused.sort();
    let list = unused.join(", ");
    let message = format!("tasks for markers that are not in both model and recording: {list}");
    (!unused.is_empty()).then(|| Diagnostic::warning("track/unused-task", message))
}

/// A warning about a recording in which faults can hardly be told from constant offsets.
fn few_frames(frames: usize) -> Option<Diagnostic> {
    let message = format!(
        "{frames} frames are too few to know how markers lie on the model: only those off by more than \
         150 mm count as faults"
    );
    let said = || Diagnostic::warning("track/unknown-offsets", message);
    (frames < robust::FEWEST_FRAMES).then(said)
}

/// Whether a label is seen in any of the frames.
fn is_seen(recording: &Recording, frames: &Range<usize>, label: usize) -> bool {
    frames.clone().any(|frame| recording.position(frame, label).is_some())
}

fn no_common_markers(model: &Model, recording: &Recording) -> Error {
    let some = |names: &mut dyn Iterator<Item = &String>| -> String {
        names.take(4).map(String::as_str).collect::<Vec<_>>().join(", ")
    };
    let of_model = some(&mut model.markers().iter().map(|m| &m.name));
    let of_recording = some(&mut recording.labels.iter());
    let message = match model.markers() {
        [] => format!(
            "the model has no markers (the recording's are {of_recording}, …): add a marker set to \
             the model"
        ),
        _ => format!(
            "model and recording share no marker with a positive weight: the model has {of_model}, \
             …; the recording has {of_recording}, …"
        ),
    };
    Error::new("track/no-common-markers", message)
}

fn frames_in(
    recording: &Recording,
    range: Option<[f64; 2]>,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Range<usize>, Error> {
    let times = &recording.times;
    let Some([first, last]) = range else { return Ok(0..times.len()) };
    // A little slack: ranges are written with fewer digits than times.
    let slack = 1e-6;
    let start = times.partition_point(|&t| t < first - slack);
    let end = times.partition_point(|&t| t <= last + slack);
    let [from, to] = [times.first(), times.last()].map(|t| t.copied().unwrap_or(0.0));
    if start >= end {
        let known = match (times.get(start.wrapping_sub(1)), times.get(start)) {
            (Some(before), Some(after)) => {
                format!("the nearest frames are at {before} and {after} s")
            }
            _ => format!("the recording runs from {from} to {to} s"),
        };
        let message = format!("no frame lies between {first} and {last} s: {known}");
        return Err(Error::new("track/no-frames", message));
    }
    let period = 1.5 * (to - from) / (times.len() - 1).max(1) as f64;
    let beyond = |by: f64| by.is_finite() && by > period;
    if beyond(from - first) || beyond(last - to) {
        let message = format!(
            "the times from {first} to {last} s reach beyond the recording, which runs from {from} to \
             {to} s"
        );
        let said = Diagnostic::note("track/time-range", message);
        warnings.push(said.with_help("the frames within are tracked"));
    }
    Ok(start..end)
}

/// The factor on the weight of a marker in a frame: the square of its confidence, so that the error of one that
/// is half as sure is taken to be twice as large.
fn factor(recording: &Recording, frame: usize, label: usize) -> f64 {
    recording.confidence(frame, label).powi(2)
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
