//! `condyle constrain`: the legal motion nearest to a given one.

mod report;

use super::track::places::{Kind, folders, must_end, stem};
use super::track::{done, hashed, pretty};
use super::{Angles, Outcome};
use crate::digest::{Digest, of_file};
use crate::failure::{Failure, warn_about, warned};
use crate::motion_format;
use crate::output::{self, Output};
use crate::progress::frames_bar;
use crate::screen::say;
use clap::Args;
use condyle::constraining::{Fate, Repair, carried_over, put_back};
use condyle::formats::{Content, ContentKind, Format, Id, document};
use condyle::open::{Cause, OpenError};
use condyle::{Animation, Model, Motion, Table, encode, open};
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The legal motion nearest to a given one, and what limits it broke.
///
/// A frame that keeps all limits stays as it is, to the bit; another one becomes its nearest legal pose. Where that would
/// jump from one side of a limit to another, the frames around are led over.
#[derive(Debug, Args)]
pub(crate) struct Constrain {
    /// The model whose limits hold: a file, or the name of a shipped one.
    ///
    /// A document that includes `skeleton` puts limits on the joints of whatever skeleton a motion has.
    model: PathBuf,
    /// Motions (.mot, .sto, .csv) whose columns are named after coordinates, or skeletons with their motion (.bvh, .amc,
    /// .glb, .gltf, .fbx).
    #[arg(required = true)]
    motions: Vec<PathBuf>,
    /// The legal motion, in the format of its ending, or a folder (required with several motions), in which each has the
    /// format of its file and a report beside it. Without it nothing is written but the report.
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// What was broken and changed: .json, or .csv with a row for each limit that a motion broke.
    #[arg(long, value_name = "R.json|R.csv")]
    report: Option<PathBuf>,
    /// Move also orientations of which learned limits do not know whether they are possible.
    #[arg(long)]
    strict: bool,
    /// Skip motions whose results were made before from the same files by the same request.
    #[arg(long)]
    resume: bool,
    /// The unit of angles in a motion that does not state it; without it, it is guessed by their size.
    #[arg(long, value_enum)]
    angles: Option<Angles>,
    /// The report as one JSON document on standard output.
    #[arg(long)]
    json: bool,
}

/// Where the results of one motion go.
#[derive(Clone, Debug, Default)]
struct Places {
    motion: Option<PathBuf>,
    /// The report beside it, by which a later run knows that it is done.
    report: Option<PathBuf>,
}

/// A motion with the model whose limits hold for it.
struct Loaded {
    model: Model,
    motion: Motion,
    from: From,
}

/// What a motion was read from.
enum From {
    Table(Table),
    /// A file with its own skeleton.
    Skeleton(Model),
}

impl Constrain {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let places = self.places()?;
        let binding = open::is_binding(&self.model);
        let model = match binding {
            true => None,
            false => {
                let mut model = warned(&self.model, open::model(&self.model)?);
                self.be_strict(&mut model);
                Some(model)
            }
        };
        let made_from = self.digest(model.as_ref());
        let several = self.motions.len() > 1;
        let (mut reports, mut failed, mut odd) = (vec![], vec![], vec![]);
        for (path, places) in self.motions.iter().zip(&places) {
            match self.one(path, places, model.as_ref(), &made_from) {
                Ok(report) => {
                    if report["left"].as_array().is_some_and(|left| !left.is_empty()) {
                        odd.push(path.display().to_string());
                    }
                    reports.push(report);
                }
                Err(failure) if several => {
                    say(&format!("error: {failure}"));
                    let (name, why) = (path.to_string_lossy(), failure.to_string());
                    reports.push(json!({ "motion": name, "error": why }));
                    failed.push(path.display().to_string());
                }
                Err(failure) => return Err(failure),
            }
        }
        if let Some(path) = &self.report {
            let text = match open::ending(path) == "csv" {
                true => report::csv(&reports),
                false if several => pretty(&Value::Array(reports.clone())),
                false => pretty(&reports[0]),
            };
            output::write(path, text.as_bytes())?;
        }
        if self.json {
            output::print_json(&match several {
                true => Value::Array(reports),
                false => reports.remove(0),
            })?;
        }
        let count = self.motions.len();
        if !odd.is_empty() {
            say(&format!(
                "{} of {count} motions have frames without a legal pose: {}",
                odd.len(),
                odd.join(", ")
            ));
        }
        if !failed.is_empty() {
            return Err(Failure::new(format!(
                "{} of {count} motions could not be used: {}",
                failed.len(),
                failed.join(", ")
            )));
        }
        Ok(if odd.is_empty() { Outcome::Done } else { Outcome::DoesNotHold })
    }

    /// With `--strict`, what learned limits do not know is outside.
    fn be_strict(&self, _model: &mut Model) {}

    fn one(
        &self,
        path: &Path,
        places: &Places,
        model: Option<&Model>,
        made_from: &Digest,
    ) -> Result<Value, Failure> {
        let from = places.report.as_ref().and_then(|_| digest_of(made_from, path));
        let results: Vec<(&str, &Path)> =
            places.motion.iter().map(|place| ("motion", place.as_path())).collect();
        if self.resume
            && let Some(from) = &from
            && let Some(report) = done::found(from, places.report.as_deref(), &results)
        {
            say(&format!("note: {}: done before and unchanged, skipped", path.display()));
            return Ok(report);
        }
        let loaded = self.loaded(path, model)?;
        let bar = frames_bar(&path.file_name().unwrap_or_default().to_string_lossy());
        bar.set_length(loaded.motion.frames.len() as u64);
        let repair = Repair::of(&loaded.model, &loaded.motion, &mut |frame| {
            bar.set_position(frame as u64 + 1);
        });
        bar.finish_and_clear();
        let mut written = vec![];
        if let Some(place) = &places.motion {
            let bytes = self.bytes(path, place, &loaded, &repair)?;
            let write = |output: &mut crate::digest::Hashed<Output>| {
                output.write_all(&bytes).map_err(|error| output::not_written(place, error))
            };
            written.push(("motion", hashed(place, write)?));
        }
        let mut report = report::json(path, &loaded.model, &loaded.motion, &repair);
        if !self.is_quiet() {
            output::print(report::text(path, &loaded.model, &repair).as_bytes())?;
        }
        if let Some(place) = &places.report {
            report["resume"] = done::mark(from.as_deref(), &written);
            output::write(place, pretty(&report).as_bytes())?;
        }
        Ok(report)
    }

    fn loaded(&self, path: &Path, model: Option<&Model>) -> Result<Loaded, Failure> {
        if let Some(model) = model {
            open::skeleton_is(&self.model);
            let content = warned(path, open::content(path, None)?);
            return match content {
                Content::Table(mut table) => {
                    let settled = open::settled(model, &mut table, self.angles.map(Into::into));
                    let said = settled.map_err(|error| {
                        let cause = Cause::Content { error, text: None };
                        Failure::from(OpenError { path: path.to_owned(), cause })
                    })?;
                    warn_about(path, &said);
                    let (motion, warnings) = Motion::from_table(model, &table);
                    warn_about(path, &warnings);
                    Ok(Loaded { model: model.clone(), motion, from: From::Table(table) })
                }
                Content::Animation(animation) => {
                    let Animation { model: own, motion } = *animation;
                    let motion = carried_over(&own, &motion, model);
                    Ok(Loaded { model: model.clone(), motion, from: From::Skeleton(own) })
                }
                other => Err(Failure::new(format!(
                    "{}: the file holds {}, not a motion",
                    path.display(),
                    other.kind().name()
                ))),
            };
        }
        let Animation { model: own, motion } = warned(path, open::animation(path)?);
        let mut model = warned(&self.model, open::bound(&self.model, &own)?);
        self.be_strict(&mut model);
        let motion = carried_over(&own, &motion, &model);
        Ok(Loaded { model, motion, from: From::Skeleton(own) })
    }

    /// The legal motion in the format of its place.
    fn bytes(
        &self,
        path: &Path,
        place: &Path,
        loaded: &Loaded,
        repair: &Repair,
    ) -> Result<Vec<u8>, Failure> {
        let format = motion_format::of_motion(place, None)?;
        let legal = &repair.legal.motion;
        let name = stem(path);
        match &loaded.from {
            From::Table(table) if format.writes.contains(&ContentKind::Motion) => {
                let mut table = table.clone();
                put_back(&mut table, &loaded.model, &loaded.motion, legal);
                let remark = format!("{} of {} frames", repair.legal.changed(), legal.frames.len());
                table.header.push(("constrained".to_owned(), remark));
                Ok(encode::table(format, &table)?)
            }
            From::Skeleton(own) => {
                let own_motion = carried_over(&loaded.model, legal, own);
                let is = |id: Id| {
                    Format::of_ending(&open::ending(path)).is_some_and(|format| format.id == id)
                };
                if format.id == Id::Bvh && is(Id::Bvh) {
                    return Ok(open::bvh_with(path, &own_motion)?);
                }
                if format.id == Id::Glb && open::is_gltf(path) {
                    return Ok(warned(path, open::reanimated(path, &own_motion, vec![], &name)?));
                }
                motion_format::encoded(format, own, &own_motion, &name, None, &[])
            }
            From::Table(_) => {
                motion_format::encoded(format, &loaded.model, legal, &name, None, &[])
            }
        }
    }

    /// Whether nothing but results goes to standard output.
    fn is_quiet(&self) -> bool {
        let results = [&self.output, &self.report].into_iter().flatten();
        self.json || results.into_iter().any(|path| output::is_standard(path))
    }

    fn places(&self) -> Result<Vec<Places>, Failure> {
        let several = self.motions.len() > 1;
        if let Some(report) = &self.report
            && open::ending(report) != "csv"
            && !output::is_standard(report)
        {
            must_end(report, "json", "a report")?;
        }
        let kind = self.output.as_deref().map(Kind::of);
        match kind {
            Some(Kind::File | Kind::Stream) if several => {
                return Err(Failure::new("several motions need a folder for -o"));
            }
            None | Some(Kind::Stream) if self.resume => {
                return Err(Failure::new("--resume needs results in files: give -o a folder"));
            }
            _ => {}
        }
        let all = self.motions.iter().zip(folders(&self.motions)).map(|(path, folder)| {
            let Some(output) = &self.output else { return Ok(Places::default()) };
            if kind != Some(Kind::Folder) {
                motion_format::of_motion(output, None)?;
                let report = self.resume.then(|| output.with_extension("report.json"));
                return Ok(Places { motion: Some(output.clone()), report });
            }
            let inside =
                |ending: &str| output.join(&folder).join(format!("{}.{ending}", stem(path)));
            let motion = Some(inside(&written_as(path)));
            Ok(Places { motion, report: Some(inside("report.json")) })
        });
        let places: Vec<Places> = all.collect::<Result<_, Failure>>()?;
        let outputs = places.iter().flat_map(|places| places.motion.iter().chain(&places.report));
        let outputs: Vec<&Path> = outputs.chain(&self.report).map(PathBuf::as_path).collect();
        let inputs = self.motions.iter().chain([&self.model]);
        let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
        output::check_distinct(&inputs, &outputs)?;
        Ok(places)
    }

    /// The part of the digest that all motions share.
    fn digest(&self, model: Option<&Model>) -> Digest {
        let mut digest = Digest::default();
        digest.add("program", env!("CARGO_PKG_VERSION").as_bytes());
        digest.add("model file", of_file(&self.model).unwrap_or_default().as_bytes());
        if let Some(model) = model {
            digest.add("model", document::write(model).as_bytes());
        }
        digest.add("asked", &[u8::from(self.strict), self.angles.map_or(0, |a| 1 + a as u8)]);
        digest
    }
}

/// The digest of all that one result is made from; `None` of a motion that can be read only once.
fn digest_of(run: &Digest, path: &Path) -> Option<String> {
    let mut digest = run.clone();
    digest.add("motion", path.is_file().then(|| of_file(path).ok())??.as_bytes());
    Some(digest.finish())
}

/// The ending with which a motion goes into a folder: its own, where that can be written.
fn written_as(path: &Path) -> String {
    let ending = open::ending(path);
    let format = Format::of_ending(&ending);
    let moves = |format: &&Format| {
        let kinds = [ContentKind::Motion, ContentKind::Scene];
        format.writes.iter().any(|kind| kinds.contains(kind))
    };
    match format {
        Some(format) if moves(&format) => ending,
        Some(format) if format.id == Id::Gltf => "glb".to_owned(),
        Some(format) if format.reads.contains(&ContentKind::Model) => "bvh".to_owned(),
        _ => "mot".to_owned(),
    }
}

/// How many frames have a fate.
fn count(repair: &Repair, fate: Fate) -> usize {
    repair.legal.fates.iter().filter(|own| **own == fate).count()
}
