//! A model file of OpenSim made as large as a person, as a setup of its scale tool asks: factors from
//! distances between markers, markers placed where they were recorded. The file comes back as itself.
//!
//! A factor is the mean over the pairs of a measurement of
//!
//! ```text
//! mean over the frames of |a - b|  /  |a - b| of the model in its default pose
//! ```
//!
//! What the factors do to the file is in [`condyle_formats::opensim::scale`].

use crate::tracking::{
    CoordinateRequest, CoordinateTarget, CoordinateValue, FrameStatus, Job, Request, Rules,
    Scratch, Targets, Tracker, Wanted,
};
use condyle_diagnostics::{Diagnostic, Error, listed};
use condyle_formats::opensim::scale::{
    self, Factors, MarkerPlace, Report, fixed_markers, with_markers_at, without_markers,
};
use condyle_formats::opensim::scale_setup::{Placer, ScaleSetup, Scaler, Source};
use condyle_formats::opensim::setup::CoordinateTarget as Task;
use condyle_math::Vec3;
use condyle_model::{Mode, Model, Pose, Program};
use condyle_motion::{Recording, Table};
use std::ops::Range;

pub use condyle_formats::opensim::scale::Rules as ScaleRules;

/// What a model file is scaled by.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// The setup; files that it names are not opened.
    pub setup: &'a ScaleSetup,
    /// How its parts are scaled.
    pub rules: &'a ScaleRules,
    /// The recording that sizes are measured in; needed where the setup measures.
    pub measured: Option<&'a Recording>,
    /// The recording that markers are placed in; needed where the setup places.
    pub stands: Option<&'a Recording>,
    /// Values for coordinates that follow a file.
    pub coordinates: Option<&'a Table>,
}

/// A model file of a person, and how it came about.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The model file.
    pub text: String,
    /// The factors of bodies.
    pub factors: Factors,
    /// What was measured.
    pub measurements: Vec<Measured>,
    /// What was scaled and what was not.
    pub report: Report,
    /// The placing of markers, where it was asked for.
    pub placed: Option<Placed>,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
}

/// One measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Its name.
    pub name: String,
    /// The factor; `None` of one that could not be used.
    pub factor: Option<f64>,
    /// For each pair its markers, the mean distance in the recording, and that in the model (metres).
    pub pairs: Vec<([String; 2], [f64; 2])>,
}

/// How markers were placed.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The scaled model in its text, before markers were moved.
    pub model: Model,
    /// The pose: the stored numbers of all coordinates.
    pub posture: Vec<f64>,
    /// Its time (seconds): the first that was averaged.
    pub time: f64,
    /// How the search for it ended.
    pub status: FrameStatus,
    /// Root mean square over the markers used, before any was moved (metres).
    pub rms: f64,
    /// What became of each marker that was recorded.
    pub markers: Vec<PlacedMarker>,
    /// Markers of the model that were not recorded.
    pub unseen: Vec<String>,
}

/// What became of a marker.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedMarker {
    /// Its name.
    pub name: String,
    /// Whether it is fixed in the file, so that it stayed.
    pub fixed: bool,
    /// How far it was from its recorded place (metres).
    pub error: f64,
}

impl Placed {
    /// Root mean square over the fixed markers (metres); `None` without any.
    pub fn rms_fixed(&self) -> Option<f64> {
        let fixed: Vec<f64> =
            self.markers.iter().filter(|m| m.fixed).map(|m| m.error * m.error).collect();
        (!fixed.is_empty()).then(|| (fixed.iter().sum::<f64>() / fixed.len() as f64).sqrt())
    }
}

/// Scales a model file whose sets are inside
/// ([`whole`](condyle_formats::opensim::scale::whole)), and places its markers.
///
/// # Errors
/// Where the model cannot be read, or a recording that is needed is not given or shows no frame in
/// the time asked for; `scale/movement` where a marker moves more than the setup allows; what
/// [`Job::new`] finds wrong.
pub fn scale(text: &str, asked: &Asked<'_>) -> Result<Subject, Error> {
    let mut warnings = vec![];
    let read = scale::model_of(text)?;
    warnings.extend(read.warnings);
    let model = read.value;
    let (mut factors, mut measurements) = (Factors::new(), vec![]);
    let mut rules = asked.rules.clone();
    let mut scaled = None;
    if let Some(scaler) = &asked.setup.scaler {
        (factors, measurements) = factors_of(&model, scaler, asked.measured, &mut warnings)?;
        rules.mass = rules.mass.or(asked.setup.mass);
        rules.preserve_mass |= scaler.preserve_mass;
        let mut open = 0.0f64;
        let mut posture = |model: &Model| {
            let (posture, error) = standing(model);
            open = open.max(error);
            posture
        };
        let read = scale::scale(text, &factors, &rules, &mut posture)?;
        if open > OPEN {
            let message = format!("loops of the model stay open by {:.1} mm", 1e3 * open);
            let said = Diagnostic::warning("scale/loop", message);
            warnings.push(said.with_help("lengths of muscles are measured in such a pose"));
        }
        for said in read.warnings {
            if !warnings.contains(&said) {
                warnings.push(said);
            }
        }
        scaled = Some(read.value);
    }
    let (mut text, report) = match scaled {
        Some(scaled) => (scaled.text, scaled.report),
        None => (text.to_owned(), Report::default()),
    };
    let mut placed = None;
    if let Some(placer) = &asked.setup.placer {
        let (moved, found) = place(text, placer, asked, &rules, &mut warnings)?;
        text = moved;
        placed = Some(found);
    }
    Ok(Subject { text, factors, measurements, report, placed, warnings })
}

/// A model that is no file of OpenSim, of a person.
#[derive(Clone, Debug)]
pub struct SubjectModel {
    /// The model.
    pub model: Model,
    /// The factors of segments.
    pub factors: Factors,
    /// What was measured.
    pub measurements: Vec<Measured>,
    /// The placing of markers, where it was asked for.
    pub placed: Option<Placed>,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
}

/// Scales a model of any format by the same setups ([`Model::scaled_along`]), and places its markers.
///
/// Bodies are segments by name; a mass is left, as a model has none. No marker is fixed.
///
/// # Errors
/// As [`scale()`].
pub fn scale_model(model: &Model, asked: &Asked<'_>) -> Result<SubjectModel, Error> {
    let mut warnings = vec![];
    let (mut factors, mut measurements) = (Factors::new(), vec![]);
    let mut scaled = model.clone();
    if let Some(scaler) = &asked.setup.scaler {
        (factors, measurements) = factors_of(model, scaler, asked.measured, &mut warnings)?;
        let mut rows = vec![[1.0; 3]; model.segments().len()];
        for (name, &own) in &factors {
            match model.find_segment(name) {
                Ok(id) => rows[id.index()] = own,
                Err(error) => {
                    let message = format!("factors of `{name}` are not used: {error}");
                    warnings.push(Diagnostic::warning("scale/unknown-body", message));
                }
            }
        }
        scaled = model.scaled_along(&rows);
    }
    let mut placed = None;
    if let Some(placer) = &asked.setup.placer {
        let (found, moved) = stand(scaled, &[], placer, asked, &mut warnings)?;
        let in_body = |name: &str| moved.iter().find(|place| place.name == name);
        let points: Vec<Option<Vec3>> = found
            .model
            .markers()
            .iter()
            .map(|marker| in_body(&marker.name).map(|place| place.in_body.into()))
            .collect();
        scaled = found.model.with_markers_at(&points);
        placed = Some(found);
    }
    Ok(SubjectModel { model: scaled, factors, measurements, placed, warnings })
}

/// How much a loop counts against coordinates that leave their defaults: by so much that it is closed to
/// a thousandth of a millimetre.
const CLOSED: f64 = 1e9;

/// A loop that is open by more than this (metres or radians) is said to be.
const OPEN: f64 = 1e-5;

/// The default posture with loops closed as near to it as can be, and how far they stay open (metres or
/// radians).
fn standing(model: &Model) -> (Vec<f64>, f64) {
    let defaults = model.defaults();
    if model.closures().is_empty() {
        return (defaults, 0.0);
    }
    let target = |id| {
        let own = model.stored_range(id);
        let wanted = Wanted::Constant(*defaults.get(own.start)?);
        (own.len() == 1).then_some(CoordinateTarget { coordinate: id, weight: 1.0, wanted })
    };
    let coordinates = model.coordinate_ids().filter_map(target).collect();
    let targets = Targets { coordinates, closure_weight: Some(CLOSED), ..Targets::default() };
    let rules = Rules { tolerance: 1e-12, limits: false };
    let tracker = Tracker::new(model.clone(), targets, rules);
    let answer = tracker.solve_frame(&mut Scratch::new(&tracker), &[], 0, &defaults);
    // Near a loop that cannot be closed, the defaults are as good as any pose.
    let closed = answer.closure_error <= OPEN;
    (if closed { answer.coordinates } else { defaults }, answer.closure_error)
}

/// Where the markers of a model are in its default pose.
fn places(model: &Model) -> Vec<Vec3> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    // The buffers are of this program, so nothing can be refused.
    let _ = program.evaluate(&standing(model).0, Mode::Open, &mut pose);
    model.markers().iter().map(|marker| pose.frame(marker.segment) * marker.point).collect()
}

fn no_recording(what: &str) -> Error {
    Error::new("scale/no-recording", format!("{what}, but there is no recording of the person"))
        .with_help("name it in the setup as <marker_file>, or give it by --static")
}

/// The frames of a recording that lie in a time range.
fn frames_in(recording: &Recording, range: Option<[f64; 2]>) -> Result<Range<usize>, Error> {
    let all = 0..recording.frames();
    let Some([first, last]) = range else { return Ok(all) };
    // As nearly as the frames of a file are apart.
    let near = 1e-6;
    let inside = |&f: &usize| {
        recording.times.get(f).is_some_and(|t| *t >= first - near && *t <= last + near)
    };
    let start = all.clone().find(inside);
    let end = all.rev().find(inside);
    match (start, end) {
        (Some(start), Some(end)) => Ok(start..end + 1),
        _ => {
            Err(Error::new("scale/no-frames", format!("no frame lies from {first} s to {last} s"))
                .with_help("see <time_range> of the setup"))
        }
    }
}

/// The factors that a setup gives, and what was measured for them.
fn factors_of(
    model: &Model,
    scaler: &Scaler,
    recording: Option<&Recording>,
    warnings: &mut Vec<Diagnostic>,
) -> Result<(Factors, Vec<Measured>), Error> {
    let mut factors = Factors::new();
    let mut measured = vec![];
    for source in &scaler.order {
        match source {
            Source::Manual => factors.extend(scaler.factors.iter().cloned()),
            Source::Measurements if scaler.measurements.is_empty() => {}
            Source::Measurements => {
                let recording = recording.ok_or_else(|| no_recording("sizes are measured"))?;
                measured = measure(model, scaler, recording, warnings)?;
                for (measurement, found) in scaler.measurements.iter().zip(&measured) {
                    let Some(factor) = found.factor else { continue };
                    for (body, axes) in &measurement.bodies {
                        let own = factors.entry(body.clone()).or_insert([1.0; 3]);
                        for (own, takes) in own.iter_mut().zip(axes) {
                            if *takes {
                                *own = factor;
                            }
                        }
                    }
                }
            }
        }
    }
    Ok((factors, measured))
}

fn measure(
    model: &Model,
    scaler: &Scaler,
    recording: &Recording,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Vec<Measured>, Error> {
    let places = places(model);
    let frames = frames_in(recording, scaler.time_range)?;
    let in_model = |name: &String| {
        let index = model.markers().iter().position(|marker| marker.name == *name)?;
        places.get(index).copied()
    };
    let label = |name: &String| recording.labels.iter().position(|label| label == name);
    let mut all = vec![];
    for measurement in &scaler.measurements {
        let mut missing: Vec<String> = vec![];
        let mut pairs = vec![];
        for pair in &measurement.pairs {
            for name in pair {
                if in_model(name).is_none() {
                    missing.push(format!("`{name}` is no marker of the model"));
                }
                if label(name).is_none() {
                    missing.push(format!("`{name}` is not in the recording"));
                }
            }
            let [a, b] = pair;
            let (Some(p), Some(q)) = (in_model(a), in_model(b)) else { continue };
            let (Some(i), Some(j)) = (label(a), label(b)) else { continue };
            let apart = |f: usize| {
                let (p, q) = (recording.position(f, i)?, recording.position(f, j)?);
                Some((Vec3::from(p) - Vec3::from(q)).norm())
            };
            let seen: Vec<f64> = frames.clone().filter_map(apart).collect();
            let mean = seen.iter().sum::<f64>() / seen.len() as f64;
            if !mean.is_finite() {
                missing.push(format!("`{a}` and `{b}` are never seen together"));
            }
            pairs.push((pair.clone(), [mean, (p - q).norm()]));
        }
        let ratios: Vec<f64> = pairs.iter().map(|(_, [seen, model])| seen / model).collect();
        let factor = ratios.iter().sum::<f64>() / ratios.len() as f64;
        let good = missing.is_empty() && factor.is_finite() && factor > 0.0;
        if !good {
            missing.sort();
            missing.dedup();
            let why = match missing.is_empty() {
                true => "its markers are in one place, or it has none".to_owned(),
                false => missing.join(", "),
            };
            let message = format!("measurement `{}` is not used: {why}", measurement.name);
            let said = Diagnostic::warning("scale/measurement", message);
            warnings.push(said.with_help("its bodies keep their size along its axes"));
        }
        all.push(Measured {
            name: measurement.name.clone(),
            factor: good.then_some(factor),
            pairs,
        });
    }
    Ok(all)
}

/// The mean of each marker over some frames: one frame of the same labels.
fn averaged(recording: &Recording, placer: &Placer) -> Result<Recording, Error> {
    let frames = frames_in(recording, placer.time_range)?;
    let mut positions = vec![];
    let mut moving = vec![];
    for (index, label) in recording.labels.iter().enumerate() {
        let seen = frames.clone().filter_map(|f| recording.position(f, index));
        let seen: Vec<Vec3> = seen.map(Vec3::from).collect();
        let sum = seen.iter().fold(Vec3::ZERO, |sum, p| sum + *p);
        let mean = sum * (1.0 / seen.len() as f64);
        // One that is never seen is not a number, which stands for missing.
        positions.push(mean.to_array().into());
        let Some(most) = placer.max_marker_movement else { continue };
        let span = |axis: usize| {
            let values = || seen.iter().map(|p| p.to_array()[axis]);
            values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
        };
        let moved = (0..3).map(span).fold(0.0, f64::max);
        if moved > most {
            moving.push(format!("{label} by {:.0} mm", 1e3 * moved));
        }
    }
    if !moving.is_empty() {
        let message = format!("markers move: {}", listed(moving));
        return Err(Error::new("scale/movement", message)
            .with_help("<max_marker_movement> of the setup allows less; choose a quieter time"));
    }
    Ok(Recording {
        labels: recording.labels.clone(),
        rate: recording.rate,
        times: recording.times.get(frames.start).copied().into_iter().collect(),
        positions,
        units: recording.units,
        ..Recording::default()
    })
}

/// The weighted pose of the scaled model, and its markers moved to where they were recorded.
fn place(
    text: String,
    placer: &Placer,
    asked: &Asked<'_>,
    rules: &ScaleRules,
    warnings: &mut Vec<Diagnostic>,
) -> Result<(String, Placed), Error> {
    let model = scale::model_of(&text)?.value;
    let (placed, moved) = stand(model, &fixed_markers(&text)?, placer, asked, warnings)?;
    let mut text = with_markers_at(&text, &moved)?;
    if rules.as_opensim && !placed.unseen.is_empty() {
        text = without_markers(&text, &placed.unseen)?;
    }
    Ok((text, placed))
}

/// The weighted pose of a scaled model, and where its markers were recorded in their bodies.
fn stand(
    model: Model,
    fixed: &[String],
    placer: &Placer,
    asked: &Asked<'_>,
    warnings: &mut Vec<Diagnostic>,
) -> Result<(Placed, Vec<MarkerPlace>), Error> {
    let recording = asked.stands.ok_or_else(|| no_recording("markers are placed"))?;
    let still = averaged(recording, placer)?;
    let request = request_of(placer, asked.coordinates);
    let job = Job::new(model.clone(), &still, &request)?;
    let tracking = job.run(&mut |_, _| {});
    for said in &tracking.warnings {
        if !warnings.contains(said) {
            warnings.push(said.clone());
        }
    }
    // Markers are placed by this one pose, so it is found more closely than those of motions are.
    let rules_closely = Rules { tolerance: 1e-13, ..Rules::default() };
    let targets = job.tracker().targets().clone();
    let closely = Tracker::new(model.clone(), targets, rules_closely);
    let seen: Vec<Option<[f64; 3]>> =
        tracking.labels.iter().map(|&label| still.position(0, label)).collect();
    let start = tracking.answers.coordinates(0);
    let answer = closely.solve_frame(&mut Scratch::new(&closely), &seen, 0, start);
    let posture = answer.coordinates.clone();
    let program = Program::compile(&model);
    let mut pose = Pose::new(&program);
    let _ = program.evaluate(&posture, Mode::Open, &mut pose);
    let (mut markers, mut unseen, mut moved) = (vec![], vec![], vec![]);
    for marker in model.markers() {
        let label = still.labels.iter().position(|label| *label == marker.name);
        let used = tracking.markers.iter().position(|name| *name == marker.name);
        let label = used.and_then(|at| tracking.labels.get(at).copied()).or(label);
        let Some(seen) = label.and_then(|label| still.position(0, label)) else {
            unseen.push(marker.name.clone());
            continue;
        };
        let frame = pose.frame(marker.segment);
        let seen = Vec3::from(seen);
        let is_fixed = fixed.contains(&marker.name);
        let error = (frame * marker.point - seen).norm();
        markers.push(PlacedMarker { name: marker.name.clone(), fixed: is_fixed, error });
        if placer.move_markers && !is_fixed {
            let in_body = (frame.linear.inverse() * (seen - frame.translation)).to_array();
            moved.push(MarkerPlace { name: marker.name.clone(), in_body });
        }
    }
    let placed = Placed {
        posture,
        time: still.times.first().copied().unwrap_or(0.0),
        status: answer.status,
        rms: answer.rms(),
        markers,
        unseen,
        model,
    };
    Ok((placed, moved))
}

fn request_of(placer: &Placer, values: Option<&Table>) -> Request {
    let mut request = Request { coordinate_values: values.cloned(), ..Request::default() };
    if !placer.tasks.markers.is_empty() {
        let on = placer.tasks.markers.iter().filter(|task| task.apply);
        request.marker_weights = Some(on.map(|task| (task.name.clone(), task.weight)).collect());
    }
    let on = placer.tasks.coordinates.iter().filter(|task| task.apply && task.weight > 0.0);
    let coordinate = |task: &condyle_formats::opensim::setup::CoordinateTask| CoordinateRequest {
        name: task.name.clone(),
        weight: task.weight,
        value: match task.target {
            Task::Default => CoordinateValue::Default,
            Task::Manual(value) => CoordinateValue::Constant(value),
            Task::FromFile => CoordinateValue::PerTime,
        },
    };
    request.coordinates = on.map(coordinate).collect();
    request
}
