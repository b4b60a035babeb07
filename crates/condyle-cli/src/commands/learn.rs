//! `condyle learn`: models from recordings: limits of joints, and laws that couple coordinates.

mod compare;
mod coupling;
mod joint;
mod study;

mod given;

pub(super) use given::{bins_json, bins_text};

use super::{Angles, Outcome, ZerosArgument, zeros};
use crate::failure::{Failure, warn_about, warned};
use crate::output;
use clap::{Args, Subcommand, ValueEnum};
use condyle::formats::document::limit;
use condyle::learn::limits::herda2003::{LearnedSpheres, Options};
use condyle::learn::limits::{LeftOut, Settings, percentile};
use condyle::learning::{self, How, HowGiven, LearnedFrom, Take, Wanted, Wished};
use condyle::math::Quat;
use condyle::open::{self, Cause, OpenError};
use condyle::{encode, limits};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Learn {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Learn which rotations of a joint are possible, from recordings of people.
    Limits(Box<Limits>),
    /// Learn how coordinates follow others, from trials.
    Coupling(Box<coupling::Coupling>),
    /// Compare a learned joint with others on trials that are left out.
    Compare(Box<compare::Compare>),
    /// Make a model with a free joint from a standing trial.
    Joint(Box<joint::Joint>),
    /// Remake the study of Pronost et al. 2010 with virtual people whose knees are known.
    Study(study::Study),
}

/// How a limit is learned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Method {
    /// The closing of the cloud of rotations by empty balls, with a signed distance.
    Closing,
    /// Spheres in the vector part of quaternions, as Herda et al. 2003 have them: for comparison.
    Herda2003,
}

/// Learn which rotations of a joint are possible, from recordings of people.
///
/// Markers need --recipe, a motion of a model --model and --joint, a skeleton with its motion (.bvh, .amc, .glb) --joint, inertial
/// sensors (.sto) --joint and --reference, a table of qx,qy,qz,qw nothing.
#[derive(Debug, Args)]
struct Limits {
    /// Recordings; each is a take. How far the limit goes beyond them follows from takes that are left out.
    #[arg(required = true, value_name = "RECORDING")]
    recordings: Vec<PathBuf>,
    /// Which markers give the axes of a segment: a document of `kind = "recipe"`, or a shipped one such as
    /// `shoulder-isb` or `hip`.
    #[arg(long, value_name = "R.toml", conflicts_with_all = ["model", "joint", "reference"])]
    recipe: Option<PathBuf>,
    /// The model whose coordinates a motion holds: a file, or the name of a shipped one.
    #[arg(long, value_name = "M", requires = "joint")]
    model: Option<PathBuf>,
    /// The segment whose rotation is learned, or a joint that moves one; of inertial recordings a sensor.
    #[arg(long, value_name = "J")]
    joint: Option<String>,
    /// The segment in which it is seen; without it, its parent.
    #[arg(long, value_name = "SEGMENT")]
    reference: Option<String>,
    /// What the limit depends on: a coordinate, or a segment (or joint) whose rotation it is; of a table a column, of
    /// inertial recordings a sensor.
    #[arg(long, value_name = "JOINT|COORDINATE", conflicts_with = "method")]
    given: Option<String>,
    /// The segment in which that rotation is seen; without it, its parent.
    #[arg(long, value_name = "SEGMENT", requires = "given")]
    given_reference: Option<String>,
    /// Which markers give that rotation: a second recipe.
    #[arg(long, value_name = "R.toml", requires = "recipe")]
    given_recipe: Option<PathBuf>,
    /// By how much a boundary may move with what it depends on, in degrees per degree; 0.5 without it.
    #[arg(long, value_name = "RATIO", value_parser = slope)]
    slope: Option<f64>,
    /// The method.
    #[arg(long, value_enum, default_value = "closing")]
    method: Method,
    /// How far the limit goes beyond what was recorded, in degrees; without it, takes that are left out tell.
    #[arg(long, value_name = "DEG", value_parser = angle)]
    offset: Option<f64>,
    /// The share of the rotations of left-out takes that the limit must hold, as far as 15 degrees beyond the others do; without it, 0.95.
    #[arg(long, value_name = "SHARE", value_parser = share, conflicts_with = "offset")]
    cover: Option<f64>,
    /// The least angle between two rotations that are kept, in degrees; without it, 2 along the curves of recordings, and 0 of
    /// rotations that are independent of each other.
    #[arg(long, value_name = "DEG", value_parser = angle)]
    spacing: Option<f64>,
    /// Whose markers are meant, where the labels of several people begin with their names: `Anna:RFHD`.
    #[arg(long, value_name = "NAME")]
    subject: Option<String>,
    /// What a marker at exactly 0 0 0 is; without it, it is missing where it is elsewhere in other frames.
    #[arg(long, value_enum)]
    zeros: Option<ZerosArgument>,
    /// The unit of angles in motions that do not state it; without it, it is guessed by their size.
    #[arg(long, value_enum)]
    angles: Option<Angles>,
    /// The limit, a document of `kind = "limit"`; `-` is standard output.
    #[arg(short, long, value_name = "L.toml")]
    output: PathBuf,
    /// What became of the recordings and what takes tell that were left out, in JSON.
    #[arg(long, value_name = "R.json")]
    report: Option<PathBuf>,
    /// The boundary as a surface (.glb) in quaternion space: a turn by θ about u is at u·sin(θ/2).
    #[arg(long, value_name = "M.glb")]
    mesh: Option<PathBuf>,
}

/// An angle in degrees, 0 to 57, in radians.
fn angle(text: &str) -> Result<f64, String> {
    let degrees = text.parse().ok().filter(|d: &f64| (0.0..=57.0).contains(d));
    degrees.map(f64::to_radians).ok_or_else(|| "give degrees, from 0 to 57".to_owned())
}

fn share(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share: &f64| (0.5..=1.0).contains(share));
    share.ok_or_else(|| "give a share, from 0.5 to 1".to_owned())
}

/// A slope from 0 to 10.
fn slope(text: &str) -> Result<f64, String> {
    let slope = text.parse().ok().filter(|slope: &f64| (0.0..=10.0).contains(slope));
    slope.ok_or_else(|| "give a number from 0 to 10".to_owned())
}

impl Learn {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        match self.what {
            What::Limits(limits) => limits.run(),
            What::Coupling(coupling) => coupling.run(),
            What::Compare(compare) => compare.run(),
            What::Joint(joint) => joint.run(),
            What::Study(study) => study.run(),
        }
    }
}

impl Limits {
    fn run(self) -> Result<Outcome, Failure> {
        let to_screen = self.output == Path::new("-");
        if !to_screen && open::ending(&self.output) != "toml" {
            let path = self.output.display();
            let message = format!("{path}: a limit is written as a document: end it in .toml");
            return Err(Failure::new(message));
        }
        if to_screen && self.report.as_deref() == Some(Path::new("-")) {
            let message = "-o - and --report - both want standard output: give one of them";
            return Err(Failure::new(message));
        }
        let inputs: Vec<&Path> = self
            .recordings
            .iter()
            .chain(&self.recipe)
            .chain(&self.given_recipe)
            .chain(&self.model)
            .map(PathBuf::as_path)
            .collect();
        let outputs: Vec<&Path> = std::iter::once(&self.output)
            .chain(&self.report)
            .chain(&self.mesh)
            .map(PathBuf::as_path)
            .collect();
        output::check_distinct(&inputs, &outputs)?;
        let wanted = self.wanted()?;
        let mut takes = vec![];
        for path in &self.recordings {
            takes.push(warned(path, learning::take(path, &wanted)?));
        }
        let name = self.output.file_stem().unwrap_or_default().to_string_lossy();
        let name = if to_screen { "" } else { name.as_ref() };
        let how = How {
            spacing: self.spacing,
            offset: self.offset,
            cover: self.cover,
            settings: Settings::default(),
        };
        let started = std::time::Instant::now();
        let (document, text, report) = match self.method {
            Method::Closing if wanted.given.is_some() => {
                let by = HowGiven { slope: self.slope, step: None };
                let learned = self.told(learning::learn_given(&takes, &how, &by, name))?;
                warn_about(&self.recordings[0], &learned.warnings);
                let seconds = started.elapsed().as_secs_f64();
                if self.mesh.is_some() {
                    let field = learned.limit.field();
                    self.drawn(&|q| field.distance(q), name)?;
                }
                let report = given::report(&takes, &learned, seconds);
                (limit::write(&learned.limit), given::text(&takes, &learned), report)
            }
            Method::Closing => {
                let learned = self.told(learning::learn(&takes, &how, name))?;
                warn_about(&self.recordings[0], &learned.warnings);
                let seconds = started.elapsed().as_secs_f64();
                let report = closing_report(&takes, &learned, seconds);
                let field = learned.limit.field();
                self.drawn(&|q| field.distance(q), name)?;
                (limit::write(&learned.limit), closing_text(&takes, &learned), report)
            }
            Method::Herda2003 => {
                let (spheres, warnings) =
                    self.told(learning::spheres(&takes, &how, Options::default(), name))?;
                warn_about(&self.recordings[0], &warnings);
                let seconds = started.elapsed().as_secs_f64();
                let report = spheres_report(&takes, &spheres, seconds);
                self.drawn(&|q| spheres.limit.value(q) - 1.0, name)?;
                (limit::write_spheres(&spheres), spheres_text(&takes, &spheres), report)
            }
        };
        output::write(&self.output, document.as_bytes())?;
        if let Some(path) = &self.report {
            output::write(path, format!("{report:#}\n").as_bytes())?;
        }
        if !to_screen && self.report.as_deref() != Some(Path::new("-")) {
            output::print(text.as_bytes())?;
        }
        Ok(Outcome::Done)
    }

    /// The boundary as a scene, where it is asked for.
    fn drawn(&self, distance: &dyn Fn(Quat) -> f64, name: &str) -> Result<(), Failure> {
        let Some(path) = &self.mesh else { return Ok(()) };
        if open::ending(path) != "glb" {
            let path = path.display();
            return Err(Failure::new(format!(
                "{path}: a surface is written as .glb: end it in that"
            )));
        }
        let mesh = limits::boundary(distance, limits::CELLS);
        let name = if name.is_empty() { "limit" } else { name };
        output::write(path, &encode::surface(mesh, name)?)
    }

    fn wanted(&self) -> Result<Wanted, Failure> {
        let recipe = match &self.recipe {
            Some(path) => {
                let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                Some((name, warned(path, open::recipe(path)?)))
            }
            None => None,
        };
        let given_recipe = match &self.given_recipe {
            Some(path) => {
                let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                Some((name, warned(path, open::recipe(path)?)))
            }
            None => None,
        };
        let given = (self.given.is_some() || given_recipe.is_some()).then(|| Wished {
            name: self.given.clone().unwrap_or_default(),
            reference: self.given_reference.clone(),
            recipe: given_recipe,
        });
        let model = match &self.model {
            Some(path) => {
                let model = warned(path, open::model(path)?);
                Some((model.name().to_owned(), model))
            }
            None => None,
        };
        Ok(Wanted {
            recipe,
            model,
            joint: self.joint.clone(),
            reference: self.reference.clone(),
            subject: self.subject.clone(),
            given,
            zeros: zeros(self.zeros),
            angles: self.angles.map(Into::into),
        })
    }

    /// An error about all recordings, with the path of the first.
    fn told<T>(&self, result: Result<T, condyle::Error>) -> Result<T, Failure> {
        let path = self.recordings.first().cloned().unwrap_or_default();
        result
            .map_err(|error| OpenError { path, cause: Cause::Content { error, text: None } }.into())
    }
}

fn degrees(angle: f64) -> f64 {
    (angle.to_degrees() * 1e4).round() / 1e4
}

fn takes_json(takes: &[Take], counts: &[u32]) -> Value {
    let take = |(index, take): (usize, &Take)| {
        json!({
            "name": take.name,
            "frames": take.found.given(),
            "used": take.found.rotations.len(),
            "missing": take.found.missing,
            "ill_conditioned": take.found.ill_conditioned,
            "unusable": take.found.unusable.len(),
            "samples": counts.get(index).copied().unwrap_or(0),
        })
    };
    takes.iter().enumerate().map(take).collect()
}

/// Thicknesses at which the share of left-out rotations is told, in degrees.
const OFFSETS: [f64; 9] = [0.0, 1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0, 20.0];

fn left_out_json(left: &LeftOut, gap: f64) -> Value {
    let curve = OFFSETS
        .map(|offset| json!({ "offset_deg": offset, "inside": left.held(offset.to_radians()) }));
    json!({
        "parts": left.parts,
        "whole_takes": left.whole_takes,
        "rotations": left.asked,
        "inside_closing": 1.0 - left.outside,
        "inside_with_offset": left.held(gap),
        "nearest_sample_p50_deg": degrees(percentile(&left.nearest, 0.5)),
        "nearest_sample_p95_deg": degrees(percentile(&left.nearest, 0.95)),
        "hole_from_deg": degrees(left.hole),
        "by_offset": curve,
    })
}

fn closing_report(takes: &[Take], found: &LearnedFrom, seconds: f64) -> Value {
    let (about, learned, ground) =
        (found.limit.about(), found.limit.learned(), found.limit.ground());
    let hole = |hole: &condyle::learn::limits::field::Hole| {
        json!({
            "centre": hole.centre.to_array(),
            "radius_deg": degrees(hole.radius),
            "share": hole.share,
        })
    };
    json!({
        "method": "closing",
        "child": about.child,
        "reference": about.reference,
        "frames_of": about.frames,
        "takes": takes_json(takes, &ground.takes),
        "frames": takes.iter().map(|take| take.found.given()).sum::<usize>(),
        "rotations": found.gathered.given,
        "samples": ground.samples.len(),
        "thinned_deg": degrees(ground.thinned),
        "independent": found.independent,
        "spacing_deg": degrees(learned.spacing),
        "ball_deg": degrees(learned.radius),
        "offset_deg": degrees(learned.gap),
        "left_out": found.left_out.as_ref().map(|left| left_out_json(left, learned.gap)),
        "valid_share": learned.valid,
        "outer_share": learned.outer,
        "holes": learned.holes.iter().map(hole).collect::<Vec<_>>(),
        "seconds": seconds,
    })
}

fn takes_text(takes: &[Take], counts: &[u32]) -> String {
    let mut rows = vec![
        ["take", "frames", "used", "missing", "ill-conditioned", "unusable", "samples"]
            .map(str::to_owned)
            .to_vec(),
    ];
    rows.extend(takes.iter().enumerate().map(|(index, take)| {
        let found = &take.found;
        vec![
            take.name.clone(),
            found.given().to_string(),
            found.rotations.len().to_string(),
            found.missing.to_string(),
            found.ill_conditioned.to_string(),
            found.unusable.len().to_string(),
            counts.get(index).copied().unwrap_or(0).to_string(),
        ]
    }));
    output::columns(&rows)
}

fn seen(child: &str, reference: Option<&str>) -> String {
    format!("{child} in {}", reference.unwrap_or("the laboratory"))
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 1e2 * share)
}

fn closing_text(takes: &[Take], found: &LearnedFrom) -> String {
    let (about, learned, ground) =
        (found.limit.about(), found.limit.learned(), found.limit.ground());
    let mut text = format!("{}\n", seen(&about.child, about.reference.as_deref()));
    text.push_str(&takes_text(takes, &ground.takes));
    let thinned = match degrees(ground.thinned) {
        0.0 => "independent of each other: all kept".to_owned(),
        angle => format!("none nearer to another than {angle}°"),
    };
    text.push_str(&format!("{} samples, {thinned}\n", ground.samples.len()));
    if let Some(left) = &found.left_out {
        let what = if left.whole_takes { "takes" } else { "blocks of time" };
        text.push_str(&format!(
            "{} {what} left out in turn: {} of their rotations are inside what the others show, {} with {:.1}° beyond it\n",
            left.parts,
            percent(1.0 - left.outside),
            percent(left.held(learned.gap)),
            learned.gap.to_degrees(),
        ));
        text.push_str(&format!(
            "places farther than {:.1}° from all samples are holes\n",
            left.hole.to_degrees()
        ));
    } else {
        text.push_str(&format!(
            "the limit goes {:.1}° beyond the samples, which are {:.1}° apart\n",
            learned.gap.to_degrees(),
            learned.spacing.to_degrees()
        ));
    }
    text.push_str(&format!(
        "valid are {} of all rotations, unknown {} in {} holes\n",
        percent(learned.valid),
        percent(learned.outer - learned.valid),
        learned.holes.len()
    ));
    text
}

fn spheres_report(takes: &[Take], found: &LearnedSpheres, seconds: f64) -> Value {
    let limit = &found.limit;
    let stage = |(spheres, energy): &(usize, f64)| json!({ "spheres": spheres, "energy": energy });
    json!({
        "method": "herda2003",
        "child": found.about.child,
        "reference": found.about.reference,
        "frames_of": found.about.frames,
        "takes": takes_json(takes, &found.takes),
        "frames": takes.iter().map(|take| take.found.given()).sum::<usize>(),
        "samples": found.samples.len(),
        "thinned_deg": degrees(found.thinned),
        "spheres": limit.field.primitives.len(),
        "energy": limit.energy,
        "stages": limit.history.iter().map(stage).collect::<Vec<_>>(),
        "removed": {
            "large": limit.removed.large,
            "far": limit.removed.far,
            "sparse": limit.removed.sparse,
        },
        "valid_share": found.share(),
        "seconds": seconds,
    })
}

fn spheres_text(takes: &[Take], found: &LearnedSpheres) -> String {
    let mut text = format!("{}\n", seen(&found.about.child, found.about.reference.as_deref()));
    text.push_str(&takes_text(takes, &found.takes));
    text.push_str(&format!(
        "{} samples, {} spheres, E = {:.4}; possible are {} of all rotations\n",
        found.samples.len(),
        found.limit.field.primitives.len(),
        found.limit.energy,
        percent(found.share()),
    ));
    text
}
