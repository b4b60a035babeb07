//! `condyle learn compare`: joints compared on trials that no law saw.

mod report;
mod subjects;

use super::coupling::{basis, ridge};
use super::joint::Landmarks;
use crate::commands::{Limits, Outcome, ZerosArgument, zeros};
use crate::failure::{Failure, warn_about, warned};
use crate::output;
use crate::progress::frames_bar;
use clap::Args;
use condyle::formats::{Format, Id, document};
use condyle::learn::arms::Arm;
use condyle::learn::coupling::{Basis, Groups, Settings};
use condyle::learning::arms::{Compared, How, Person, Trial, compare, csv, markdown};
use condyle::learning::{GroupTable, group_table};
use condyle::tracking::Request;
use condyle::{Model, encode, open};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use subjects::Subject;

/// Compare a joint whose centre is learned with a hinge, a planar knee, three rotations about a fixed centre, and a free joint: on
/// trials that are left out.
///
/// The joint is calibrated from the standing trial as `learn joint` does. Each trial is tracked with laws that were learned from others:
/// other trials of the person, others of the same kind of motion (of a single one, blocks of time), motions of other kinds, and other
/// persons, scaled.
#[derive(Debug, Args)]
pub(super) struct Compare {
    /// The standing trial; of several persons --subjects instead.
    #[arg(value_name = "STATIC", required_unless_present = "subjects")]
    standing: Option<PathBuf>,
    /// Trials with markers. Who moves, and how, is read from the names of files: `s1_crouch_30_2.trc` is subject s1, motion crouch.
    #[arg(long, required = true, value_name = "TRIAL", num_args = 1..)]
    trials: Vec<PathBuf>,
    /// Several persons: a CSV with the columns subject and static (a file, found beside the CSV), and where they differ from the options
    /// here parent, child, origin, medial, lateral and side (left or right).
    #[arg(long, value_name = "S.csv", conflicts_with = "standing")]
    subjects: Option<PathBuf>,
    /// Who moves in which trial, and how: a CSV with the columns file, subject, motion and, where there are
    /// varieties, sub_motion.
    #[arg(long, value_name = "GROUPS.csv")]
    groups: Option<PathBuf>,
    #[command(flatten)]
    landmarks: Landmarks,
    /// Terms of the laws: linear, polynomial:2 to polynomial:6, or spline:3 to spline:20.
    #[arg(long, value_name = "BASIS", default_value = "linear", value_parser = basis)]
    basis: Basis,
    /// Shrink coefficients: a term that is perpendicular to the others is multiplied by 1/(1 + R).
    #[arg(long, value_name = "R", default_value = "0", value_parser = ridge)]
    ridge: f64,
    /// Into how many blocks of time a trial is cut that is the only one of its kind.
    #[arg(long, value_name = "N", default_value = "8", value_parser = clap::value_parser!(u16).range(2..=100))]
    blocks: u16,
    /// What a marker at exactly 0 0 0 is; without it, it is missing where it is elsewhere in other frames.
    #[arg(long, value_enum)]
    zeros: Option<ZerosArgument>,
    /// Hold coordinates to their enforced ranges while markers are tracked; on without it.
    #[arg(long, value_enum)]
    limits: Option<Limits>,
    /// Number of solver threads; all cores by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// The tables: Markdown (.md), a line for each trial and arm (.csv), or a folder, which gets both and the report; without it,
    /// Markdown on standard output.
    #[arg(short, long, value_name = "OUT.md|.csv|DIR")]
    output: Option<PathBuf>,
    /// All numbers, in JSON.
    #[arg(long, value_name = "R.json")]
    report: Option<PathBuf>,
    /// The model of every arm that a trial was tracked with, into this folder; the report names them.
    #[arg(long, value_name = "DIR")]
    models: Option<PathBuf>,
    /// The format of those models.
    #[arg(long, value_name = "FORMAT", default_value = "osim", value_parser = ["osim", "toml"], requires = "models")]
    models_as: String,
}

/// What the tables are written as.
enum Target {
    Screen,
    File(PathBuf, bool),
    Folder(PathBuf),
}

impl Compare {
    pub(super) fn run(self) -> Result<Outcome, Failure> {
        let target = self.target()?;
        let subjects = self.all_subjects()?;
        let outputs: Vec<PathBuf> = self.outputs(&target);
        let outputs: Vec<&Path> = outputs.iter().map(PathBuf::as_path).collect();
        let standing = subjects.iter().map(|subject| &subject.standing);
        let files = self.groups.iter().chain(&self.subjects).chain(standing);
        let inputs: Vec<&Path> = self.trials.iter().chain(files).map(PathBuf::as_path).collect();
        output::check_distinct(&inputs, &outputs)?;
        let persons = self.persons(&subjects)?;
        output::check_unread(outputs.iter().copied())?;
        let how = How {
            settings: Settings { basis: self.basis, ridge: self.ridge },
            request: Request {
                threads: self.threads.map(usize::from),
                limits: self.limits.is_none_or(|limits| limits == Limits::On),
                ..Request::default()
            },
            blocks: usize::from(self.blocks),
        };
        let bar = frames_bar("compare");
        let read = compare(&persons, &how, &mut |what| bar.set_message(what.to_owned()));
        bar.finish_and_clear();
        let compared = warned(&self.trials[0], read?);
        let models = match &self.models {
            Some(folder) => self.write_models(folder, &persons, &compared)?,
            None => vec![],
        };
        let report = || {
            let report = report::json(&persons, &compared, &models);
            format!("{report:#}\n").into_bytes()
        };
        if let Some(path) = &self.report {
            output::write(path, &report())?;
        }
        let (text, table) = (markdown(&persons, &compared), csv(&persons, &compared));
        match &target {
            Target::Screen if self.report.as_deref().is_some_and(output::is_standard) => {}
            Target::Screen => output::print(text.as_bytes())?,
            Target::File(path, true) => output::write(path, table.as_bytes())?,
            Target::File(path, false) => output::write(path, text.as_bytes())?,
            Target::Folder(folder) => {
                folder_at(folder)?;
                output::write(&folder.join("compare.md"), text.as_bytes())?;
                output::write(&folder.join("compare.csv"), table.as_bytes())?;
                output::write(&folder.join("compare.json"), &report())?;
            }
        }
        Ok(Outcome::Done)
    }

    fn target(&self) -> Result<Target, Failure> {
        let Some(path) = &self.output else { return Ok(Target::Screen) };
        if output::is_standard(path) {
            return Ok(Target::Screen);
        }
        match open::ending(path).as_str() {
            "md" => Ok(Target::File(path.clone(), false)),
            "csv" => Ok(Target::File(path.clone(), true)),
            "" => Ok(Target::Folder(path.clone())),
            _ if path.is_dir() => Ok(Target::Folder(path.clone())),
            ending => {
                let path = path.display();
                let message = format!(
                    "{path}: tables are not written as .{ending}: end it in .md or .csv, or name a folder"
                );
                Err(Failure::new(message))
            }
        }
    }

    fn outputs(&self, target: &Target) -> Vec<PathBuf> {
        let mut all: Vec<PathBuf> = self.report.iter().cloned().collect();
        match target {
            Target::Screen => {}
            Target::File(path, _) => all.push(path.clone()),
            Target::Folder(folder) => {
                let names = ["compare.md", "compare.csv", "compare.json"];
                all.extend(names.map(|name| folder.join(name)));
            }
        }
        all
    }

    fn all_subjects(&self) -> Result<Vec<Subject>, Failure> {
        let joint = &self.landmarks;
        let base = Subject {
            name: String::new(),
            standing: self.standing.clone().unwrap_or_default(),
            parent: joint.parent.clone(),
            child: joint.child.clone(),
            origin: joint.origin.clone(),
            ends: [joint.medial.clone(), joint.lateral.clone()],
            left: joint.left,
        };
        match &self.subjects {
            None => Ok(vec![base]),
            Some(path) => {
                let text = std::fs::read_to_string(path)
                    .map_err(|error| Failure::new(format!("{}: {error}", path.display())))?;
                let folder = path.parent().unwrap_or(Path::new(""));
                subjects::read(&text, folder, &base)
                    .map_err(|said| Failure::new(format!("{}: {said}", path.display())))
            }
        }
    }

    fn persons(&self, subjects: &[Subject]) -> Result<Vec<Person>, Failure> {
        let groups = match &self.groups {
            Some(path) => {
                let text = std::fs::read_to_string(path)
                    .map_err(|error| Failure::new(format!("{}: {error}", path.display())))?;
                group_table(&text)
                    .map_err(|error| Failure::new(format!("{}: {error}", path.display())))?
            }
            None => GroupTable::default(),
        };
        let mut persons = vec![];
        for subject in subjects {
            let path = &subject.standing;
            let standing = warned(path, open::recording_with(path, zeros(self.zeros))?);
            persons.push(subject.person(&self.landmarks.name, &standing)?);
        }
        for path in &self.trials {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let full = path.file_name().unwrap_or_default().to_string_lossy();
            let listed = groups.get(&*full).or_else(|| groups.get(&name));
            let groups = listed.cloned().unwrap_or_else(|| Groups::of_name(&name));
            let whose = match subjects {
                [_] if self.subjects.is_none() => Some(0),
                _ => subjects.iter().position(|s| s.name.eq_ignore_ascii_case(&groups.subject)),
            };
            let Some(person) = whose.and_then(|at| persons.get_mut(at)) else {
                let names: Vec<&str> = subjects.iter().map(|s| s.name.as_str()).collect();
                let message = format!(
                    "{}: the trial is of `{}`, who is none of {}: name the subject of each file with --groups",
                    path.display(),
                    groups.subject,
                    names.join(", ")
                );
                return Err(Failure::new(message));
            };
            let recording = warned(path, open::recording_with(path, zeros(self.zeros))?);
            person.trials.push(Trial { name, groups, recording });
        }
        for (person, subject) in persons.iter_mut().zip(subjects) {
            // One person is called what the trials say.
            if person.name.is_empty() {
                let said = person.trials.first().map(|t| t.groups.subject.clone());
                person.name = said.filter(|name| !name.is_empty()).unwrap_or("person".to_owned());
            }
            if person.trials.is_empty() {
                let message = format!("no trial is of `{}`", subject.name);
                let said = condyle::Diagnostic::warning("compare/no-trial", message);
                warn_about(&subject.standing, &[said]);
            }
        }
        Ok(persons)
    }

    /// Writes the model of every part and arm; their files, by comparison, part and arm.
    fn write_models(
        &self,
        folder: &Path,
        persons: &[Person],
        compared: &[Compared],
    ) -> Result<Vec<Vec<Vec<String>>>, Failure> {
        let format = Format::of_ending(&self.models_as).filter(|f| f.id != Id::Document);
        folder_at(folder)?;
        let mut all = vec![];
        let (mut number, mut written) = (0usize, HashSet::new());
        for one in compared {
            let person = &persons[one.person];
            let mut of_parts = vec![];
            for part in &one.parts {
                number += 1;
                let mut names = vec![];
                for arm in Arm::COMPARED {
                    let mut model = person.leg.arm(arm, Some(&part.centre))?;
                    model.set_name(&format!("{}_{}", person.leg.model().name(), arm.name()));
                    let stiff = !arm.is_learned();
                    let name = match stiff {
                        true => {
                            format!("{}-{}.{}", plain(&person.name), arm.name(), self.models_as)
                        }
                        false => format!("{number:03}-{}.{}", arm.name(), self.models_as),
                    };
                    // Those that take nothing from recordings are the same for all trials.
                    if written.insert(name.clone()) {
                        output::write(
                            &folder.join(&name),
                            &bytes_of(&self.trials[0], format, &model)?,
                        )?;
                    }
                    names.push(name);
                }
                of_parts.push(names);
            }
            all.push(of_parts);
        }
        Ok(all)
    }
}

fn bytes_of(path: &Path, format: Option<&Format>, model: &Model) -> Result<Vec<u8>, Failure> {
    match format {
        Some(format) => Ok(warned(path, encode::model(format, model)?)),
        None => Ok(document::write(model).into_bytes()),
    }
}

/// A name that files can have.
fn plain(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_alphanumeric() || c == '-' || c == '_' { c } else { '_' })
        .collect()
}

fn folder_at(path: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(path)
        .map_err(|error| Failure::new(format!("{}: {error}", path.display())))
}
