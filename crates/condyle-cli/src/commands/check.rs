//! `condyle check`: inconsistencies of a model, and where a motion violates it.

use super::{Angles, Outcome};
use crate::failure::{Failure, warn_about};
use crate::output::{self, columns};
use clap::Args;

use condyle::check::motion::{Broken, MotionCheck};
use condyle::formats::document::Document;
use condyle::formats::{Content, ContentKind, Format, Id};
use condyle::open::{Cause, OpenError};
use condyle::{
    CoordinateKind, Diagnostic, Law, Model, Read, Severity, Subject, Table, check, open,
};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Check {
    /// The model: a file, or the name of a shipped one.
    model: PathBuf,
    /// A motion (by default the one that the model's file holds) whose columns are named after coordinates, or poses (.json) as `fk` takes them.
    motion: Option<PathBuf>,
    /// The unit of angles in a motion that does not state it; without it, it is guessed by their size.
    #[arg(long, value_enum)]
    angles: Option<Angles>,
    /// One JSON document on standard output, in radians and metres.
    #[arg(long)]
    json: bool,
}

impl Check {
    pub(crate) fn run(self) -> Result<Outcome, Failure> {
        let read = match open::content(&self.model, Some(ContentKind::Model)) {
            Ok(read) => read,
            Err(error) => return self.contradictory(error),
        };
        let mut own = None;
        let document = match read.value {
            Content::Document(document) => document,
            Content::Model(model) => Document::of(model),
            Content::Animation(found) => {
                let table = found.motion.to_table(&found.model, "motion");
                own = Some(table).filter(|table| table.rows() > 0);
                Document::of(found.model)
            }
            _ => return Err(Failure::new("the file holds no model")),
        };
        let model = &document.model;
        let mut findings = check::check(model, &read.warnings);
        findings.iter_mut().for_each(|finding| document.locate(finding));
        let mut motion = None;
        if let Some(path) = &self.motion {
            let (table, separate) = match poses(path, model)? {
                Some(poses) => (poses, true),
                None => (self.table(path, model)?, false),
            };
            let mut checked = check::motion::check(model, &table.value);
            if separate {
                // Poses do not follow each other in time.
                checked.forget_jumps();
            }
            checked.findings.splice(0..0, table.warnings);
            motion = Some(checked);
        }
        if let (Some(table), None) = (&own, &motion) {
            motion = Some(check::motion::check(model, table));
        }
        if self.json {
            if let Some(motion) = &motion {
                findings.extend(motion.findings.iter().cloned());
            }
            let broken = findings.iter().any(check::counts);
            output::print_json(&json!({
                "model": model.name(),
                "findings": findings.iter().map(finding_json).collect::<Vec<_>>(),
                "motion": motion.as_ref().map(|motion| motion_json(model, motion)),
            }))?;
            return Ok(outcome(broken));
        }
        let mut text = head(&self.model.display().to_string(), &findings);
        grouped(&mut text, &findings);
        let mut broken = findings.iter().any(check::counts);
        if let Some(motion) = &motion {
            let path = self.motion.as_ref().unwrap_or(&self.model);
            text.push('\n');
            motion_text(&mut text, &path.display().to_string(), model, motion);
            broken |= !motion.holds();
        }
        output::print(text.as_bytes())?;
        Ok(outcome(broken))
    }

    /// A motion as a table, its angles in a unit that is known or guessed.
    fn table(&self, path: &Path, model: &Model) -> Result<Read<Table>, Failure> {
        let mut table = open::table(path)?;
        let settled = open::settled(model, &mut table.value, self.angles.map(Into::into));
        let guessed = settled.map_err(|error| {
            let cause = Cause::Content { error, text: None };
            Failure::from(OpenError { path: path.to_owned(), cause })
        })?;
        // A guess of the unit is no fault of the motion.
        warn_about(path, &guessed);
        Ok(table)
    }

    /// A file that could be read, but whose model contradicts itself, is a finding; any other error
    /// is unusable input.
    fn contradictory(&self, error: OpenError) -> Result<Outcome, Failure> {
        let findings = match &error.cause {
            Cause::Content { error, text: None } if error.is_contradiction() => error.to_vec(),
            _ => return Err(error.into()),
        };
        if self.json {
            output::print_json(&json!({
                "model": Value::Null,
                "findings": findings.iter().map(finding_json).collect::<Vec<_>>(),
                "motion": Value::Null,
            }))?;
        } else {
            let mut text = head(&self.model.display().to_string(), &findings);
            grouped(&mut text, &findings);
            output::print(text.as_bytes())?;
        }
        Ok(Outcome::DoesNotHold)
    }
}

/// Poses as a motion, or `None` for a file of another format.
fn poses(path: &Path, model: &Model) -> Result<Option<Read<Table>>, Failure> {
    if Format::of_ending(&open::ending(path)).is_none_or(|format| format.id != Id::Poses) {
        return Ok(None);
    }
    let Read { value: poses, warnings } = open::poses(path, model)?;
    Ok(Some(Read { value: poses.motion.to_table(model, "poses"), warnings }))
}

fn outcome(broken: bool) -> Outcome {
    if broken { Outcome::DoesNotHold } else { Outcome::Done }
}

fn count(findings: &[Diagnostic], severity: Severity) -> String {
    let n = findings.iter().filter(|f| f.severity == severity).count();
    format!("{n} {}{}", severity.name(), if n == 1 { "" } else { "s" })
}

fn head(name: &str, findings: &[Diagnostic]) -> String {
    if findings.is_empty() {
        return format!("{name}: no findings\n");
    }
    let counts = [Severity::Error, Severity::Warning, Severity::Note];
    format!("{name}: {}\n", counts.map(|severity| count(findings, severity)).join(", "))
}

/// Findings grouped by rule; a help that several findings share is printed once.
fn grouped(text: &mut String, findings: &[Diagnostic]) {
    let mut rules: Vec<(Severity, &str)> = vec![];
    for finding in findings {
        let rule = (finding.severity, finding.code);
        if !rules.contains(&rule) {
            rules.push(rule);
        }
    }
    for (severity, code) in rules {
        let _ = writeln!(text, "\n{} {code}", severity.name());
        let mut own: Vec<&Diagnostic> =
            findings.iter().filter(|f| (f.severity, f.code) == (severity, code)).collect();
        own.sort_by_key(|f| own_order(findings, &f.help));
        for same in own.chunk_by(|a, b| a.help == b.help) {
            // Long lists of similar findings are cut short.
            let shown = if same.len() > MOST_ALIKE + 1 { MOST_ALIKE } else { same.len() };
            for finding in &same[..shown] {
                let _ = writeln!(text, "  {}", placed(finding));
            }
            if shown < same.len() {
                let _ = writeln!(text, "  and {} more (--json lists all)", same.len() - shown);
            }
            if !same[0].help.is_empty() {
                let _ = writeln!(text, "    -> {}", same[0].help);
            }
        }
    }
}

/// How many findings of one kind are written out.
const MOST_ALIKE: usize = 8;

/// The first finding with this help, so that findings which share it are grouped.
fn own_order(findings: &[Diagnostic], help: &str) -> Option<usize> {
    findings.iter().position(|f| f.help == help)
}

/// The message, after its place in the file if it has one.
fn placed(finding: &Diagnostic) -> String {
    let place = finding.place.map_or(String::new(), |place| format!("{place}: "));
    format!("{place}{}", finding.message)
}

fn finding_json(finding: &Diagnostic) -> Value {
    json!({
        "severity": finding.severity.name(),
        "code": finding.code,
        "message": placed(finding),
        "subjects": finding.subjects.iter().map(Subject::name).collect::<Vec<_>>(),
        "help": finding.help,
    })
}

fn motion_json(model: &Model, motion: &MotionCheck) -> Value {
    let keys: Vec<String> = model.coordinate_ids().map(|id| model.coordinate_key(id)).collect();
    let key = |id: condyle::CoordinateId| &keys[id.index()];
    let mut outside = vec![None; keys.len()];
    for o in &motion.outside {
        outside[o.coordinate.index()] = Some(o);
    }
    let outside = |id: condyle::CoordinateId| outside[id.index()];
    let violation = |v: &check::motion::Violation| {
        json!({
            "coordinate": key(v.coordinate),
            "frame": v.frame,
            "time": v.time,
            "value": v.value,
            "limit": v.limit,
            "by": v.by,
            "nearest": v.nearest,
            "enforced": outside(v.coordinate).is_some_and(|o| o.enforced),
            "source": outside(v.coordinate).map(|o| &o.source),
        })
    };
    json!({
        "frames": motion.frames,
        "violations": motion.violations.iter().map(violation).collect::<Vec<_>>(),
        "coordinates": motion.outside.iter().map(|o| json!({
            "coordinate": key(o.coordinate),
            "frames": o.frames,
            "runs": o.runs,
            "worst": violation(&o.worst),
        })).collect::<Vec<_>>(),
        "coupled": motion.disagreements.iter().map(|d| json!({
            "coordinate": key(d.coordinate),
            "frames": d.frames,
            "frame": d.frame,
            "time": d.time,
            "value": d.value,
            "expected": d.expected,
        })).collect::<Vec<_>>(),
        "limits": motion.broken.iter().map(|b| limit(model, b)).collect::<Vec<_>>(),
        "unseen": motion.unseen.iter().map(|b| limit(model, b)).collect::<Vec<_>>(),
        "extrapolated": motion.extrapolated.iter().map(|e| json!({
            "law": model.components()[e.component.index()].name,
            "frames": e.frames,
            "runs": e.runs,
            "frame": e.frame,
            "time": e.time,
            "distance": e.distance,
            "controls": e.controls.iter().map(|(control, value)| (control.name(model), json!(value)))
                .collect::<serde_json::Map<String, Value>>(),
        })).collect::<Vec<_>>(),
        "loops": motion.open_loops.iter().map(|o| json!({
            "name": o.name,
            "frames": o.frames,
            "frame": o.frame,
            "time": o.time,
            "metres": o.metres,
            "radians": o.radians,
        })).collect::<Vec<_>>(),
        "jumps": motion.jumps.iter().map(|j| json!({
            "coordinate": key(j.coordinate),
            "frame": j.frame,
            "time": j.time,
            "by": j.by,
            "turned": j.turned,
            "wrap": j.wrap,
        })).collect::<Vec<_>>(),
        "missing": motion.missing.iter().map(|&id| key(id)).collect::<Vec<_>>(),
        "unknown": motion.unknown,
        "blank": motion.blank,
    })
}

fn motion_text(text: &mut String, name: &str, model: &Model, motion: &MotionCheck) {
    let _ = writeln!(text, "{name}: {} frames", motion.frames);
    if motion.findings.is_empty() {
        text.push_str("  no findings in any frame\n");
    }
    for enforced in [true, false] {
        let own: Vec<_> = motion.outside.iter().filter(|o| o.enforced == enforced).collect();
        if own.is_empty() {
            continue;
        }
        let (severity, what) =
            if enforced { ("error", "enforced") } else { ("warning", "declared, not enforced") };
        let _ = writeln!(text, "\n{severity} motion/outside-range: limits that are {what}");
        let title =
            ["coordinate", "frames", "in", "worst at", "time", "value", "nearest", "beyond"];
        let mut rows = vec![title.map(str::to_owned).to_vec()];
        rows.extend(own.iter().map(|o| {
            let kind = model.coordinate(o.coordinate).kind;
            let runs: Vec<String> = o.runs.iter().take(3).map(|run| shown_run(*run)).collect();
            let more = o.runs.len() - runs.len();
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            vec![
                model.coordinate_key(o.coordinate),
                o.frames.to_string(),
                format!("{}{more}", runs.join(", ")),
                o.worst.frame.to_string(),
                format!("{:.3} s", o.worst.time),
                amount(kind, o.worst.value),
                amount(kind, o.worst.nearest),
                amount(kind, o.worst.by),
            ]
        }));
        text.push_str(&columns(&rows));
        let mut sources: Vec<&str> = own.iter().map(|o| o.source.as_str()).collect();
        sources.sort_unstable();
        sources.dedup();
        let _ = writeln!(text, "    -> {}", sources.join("; "));
    }
    let rest: Vec<Diagnostic> =
        motion.findings.iter().filter(|f| f.code != "motion/outside-range").cloned().collect();
    grouped(text, &rest);
}

fn shown_run([first, last]: [usize; 2]) -> String {
    if first == last { format!("f{first}") } else { format!("f{first}-{last}") }
}

/// A value with its unit.
fn amount(kind: CoordinateKind, value: f64) -> String {
    match kind {
        CoordinateKind::Rotation | CoordinateKind::Orientation => {
            format!("{:.2}°", value.to_degrees())
        }
        CoordinateKind::Translation => format!("{:.2} mm", 1e3 * value),
        CoordinateKind::Scale | CoordinateKind::Other => format!("{value:.4}"),
    }
}

/// A limit that frames break, or know nothing of.
fn limit(model: &Model, b: &Broken) -> Value {
    let component = &model.components()[b.component.index()];
    let source = match &component.law {
        Law::Field(law) => Some(&law.limit.about().source),
        _ => None,
    };
    json!({
        "limit": component.name,
        "joint_set": model.joint_sets()[component.joint_set.index()].name,
        "kind": component.law.kind().name,
        "source": source,
        "frames": b.frames,
        "runs": b.runs,
        "frame": b.frame,
        "time": b.time,
        "by": b.by,
        "unit": if b.kind == CoordinateKind::Rotation { "rad" } else { "m" },
        "gaps": b.gaps,
        "nearest": b.nearest.iter().map(|near| {
            let one = |numbers: &[f64]| match numbers {
                [number] => json!(number),
                all => json!(all),
            };
            json!({ "name": near.name, "value": one(&near.value), "nearest": one(&near.valid) })
        }).collect::<Vec<_>>(),
    })
}
