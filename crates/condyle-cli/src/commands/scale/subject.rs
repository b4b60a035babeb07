//! A model scaled by a setup of OpenSim's scale tool: an .osim comes back as itself, another model as a document.

use super::Scale;
use crate::commands::{Outcome, zeros};
use crate::failure::{Failure, warn_about, warned};
use crate::output;
use crate::screen::say;
use condyle::formats::document;
use condyle::formats::opensim::scale::{Report, ScaledBody};
use condyle::formats::opensim::scale_setup::{MarkerSource, ScaleSetup};
use condyle::open;
use condyle::subject::{self, Asked, Placed, ScaleRules, Subject, SubjectModel};
use condyle::{Recording, Table};
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

pub(super) fn run(command: &Scale, setup_path: &Path) -> Result<Outcome, Failure> {
    let to_screen = command.output == Path::new("-");
    let own_file = open::ending(&command.model) == "osim";
    let ending = if own_file { "osim" } else { "toml" };
    if !to_screen && open::ending(&command.output) != ending {
        let path = command.output.display();
        let why = match own_file {
            true => "with a setup the scaled .osim is the model's own file",
            false => "a scaled model that is no .osim is written as a document",
        };
        return Err(Failure::new(format!("{path}: {why}: end it in .{ending}")));
    }
    if !own_file && (command.mass.is_some() || command.preserve_mass || command.as_opensim) {
        return Err(Failure::new(
            "--mass, --preserve-mass and --as-opensim are for an .osim: other models have no masses",
        ));
    }
    if to_screen && command.json {
        return Err(Failure::new("--json and -o - both want standard output: give one of them"));
    }
    if command.keep_markers || command.subject.is_some() {
        return Err(Failure::new(
            "--keep-markers and --subject are for scaling without a setup: say it in the setup, \
             <fixed> of a marker, <move_model_markers> of the placer",
        ));
    }
    let setup: ScaleSetup = warned(setup_path, open::scale_setup(setup_path)?);
    let named = |name: &Option<String>| match (&command.trial, name) {
        (Some(trial), _) => Some(trial.clone()),
        (None, Some(name)) => Some(open::beside(setup_path, name)),
        (None, None) => None,
    };
    let measures = setup.scaler.as_ref().filter(|s| !s.measurements.is_empty());
    let measured = measures.and_then(|scaler| named(&scaler.marker_file));
    let stands = setup.placer.as_ref().and_then(|placer| named(&placer.marker_file));
    let values = setup.placer.as_ref().and_then(|placer| placer.coordinate_file.as_ref());
    let values = values.map(|name| open::beside(setup_path, name));
    let set = match &setup.markers {
        MarkerSource::File(name) => Some(open::beside(setup_path, name)),
        _ => None,
    };
    let mut inputs: Vec<&Path> = vec![&command.model, setup_path];
    inputs.extend([&measured, &stands, &values, &set].into_iter().flatten().map(PathBuf::as_path));
    let mut outputs: Vec<&Path> = vec![&command.output];
    outputs.extend(command.report.as_deref());
    output::check_distinct(&inputs, &outputs)?;
    let recording = |path: &Option<PathBuf>| -> Result<Option<Recording>, Failure> {
        let Some(path) = path else { return Ok(None) };
        Ok(Some(warned(path, open::recording_with(path, zeros(command.zeros))?)))
    };
    let measured_in = recording(&measured)?;
    let stands_in = if stands == measured { None } else { recording(&stands)? };
    let stands_in =
        stands_in.as_ref().or(if stands == measured { measured_in.as_ref() } else { None });
    let table: Option<Table> = match &values {
        Some(path) => Some(warned(path, open::table(path)?)),
        None => None,
    };
    let rules = ScaleRules {
        as_opensim: command.as_opensim,
        mass: command.mass,
        preserve_mass: command.preserve_mass,
    };
    let asked = Asked {
        setup: &setup,
        rules: &rules,
        measured: measured_in.as_ref(),
        stands: stands_in,
        coordinates: table.as_ref(),
    };
    let done = if own_file {
        let mut text = warned(&command.model, open::osim_text(&command.model)?);
        if let Some(set) = &set {
            text = warned(set, open::osim_with_markers(&text, set)?);
        } else if let MarkerSource::Inline(set) = &setup.markers {
            let read = condyle::formats::opensim::scale::with_marker_set(&text, set.as_bytes());
            text = warned(setup_path, read?);
        }
        subject::scale(&text, &asked)
    } else {
        if !matches!(setup.markers, MarkerSource::Model) {
            let message = "the setup's markers are not taken: those of the model are used";
            say(&format!("warning: {}: {message}", setup_path.display()));
        }
        let model = warned(&command.model, open::model(&command.model)?);
        subject::scale_model(&model, &asked).map(in_text)
    };
    let done =
        done.map_err(|error| Failure::new(format!("{}: {error}", command.model.display())))?;
    warn_about(&command.model, &done.warnings);
    output::write(&command.output, done.text.as_bytes())?;
    let report = report(command, setup_path, &done);
    if let Some(path) = &command.report {
        let text = match open::ending(path).as_str() {
            "md" => markdown(command, &done),
            _ => format!("{report:#}\n"),
        };
        output::write(path, text.as_bytes())?;
    }
    if command.json {
        output::print_json(&report)?;
    } else if !to_screen {
        output::print(said(&done).as_bytes())?;
    }
    let solved = done.placed.as_ref().is_none_or(|placed| placed.status.is_solved());
    Ok(if solved { Outcome::Done } else { Outcome::DoesNotHold })
}

/// A model that is no file of OpenSim, as its document.
fn in_text(done: SubjectModel) -> Subject {
    let bodies = done.factors.iter().map(|(name, &factors)| ScaledBody {
        name: name.clone(),
        factors,
        mass: None,
    });
    Subject {
        text: document::write(&done.model),
        report: Report { bodies: bodies.collect(), ..Report::default() },
        factors: done.factors,
        measurements: done.measurements,
        placed: done.placed,
        warnings: done.warnings,
    }
}

fn report(command: &Scale, setup: &Path, done: &Subject) -> Value {
    let [before, after] = done.report.mass();
    let bodies: Map<String, Value> = done
        .report
        .bodies
        .iter()
        .map(|body| {
            let entry = json!({
                "factors": body.factors,
                "mass_before_kg": body.mass.map(|m| m[0]),
                "mass_after_kg": body.mass.map(|m| m[1]),
            });
            (body.name.clone(), entry)
        })
        .collect();
    let measurements: Vec<Value> = done
        .measurements
        .iter()
        .map(|found| {
            let pairs = found.pairs.iter().map(|(markers, [seen, model])| {
                json!({ "markers": markers, "recorded_m": seen, "model_m": model })
            });
            json!({
                "name": found.name,
                "factor": found.factor,
                "pairs": pairs.collect::<Vec<_>>(),
            })
        })
        .collect();
    let beyond = done.report.beyond.iter();
    let left = done.report.left.iter();
    json!({
        "model": command.model.to_string_lossy(),
        "setup": setup.to_string_lossy(),
        "as_opensim": command.as_opensim,
        "mass_before_kg": before,
        "mass_after_kg": after,
        "bodies": bodies,
        "measurements": measurements,
        "scaled": done.report.scaled,
        "scaled_beyond_opensim":
            beyond.map(|(what, which)| json!({ "what": what, "which": which })).collect::<Vec<_>>(),
        "left": left.map(|l| json!({ "part": l.part, "why": l.why })).collect::<Vec<_>>(),
        "wrapping": done.report.wrapping,
        "placed": done.placed.as_ref().map(placed_json),
    })
}

fn placed_json(placed: &Placed) -> Value {
    let model = &placed.model;
    let posture: Map<String, Value> = model
        .coordinate_ids()
        .filter(|id| model.stored_range(*id).len() == 1)
        .map(|id| (model.coordinate_key(id), json!(model.value(&placed.posture, id))))
        .collect();
    let markers = placed
        .markers
        .iter()
        .map(|m| json!({ "name": m.name, "fixed": m.fixed, "error_m": m.error }));
    json!({
        "time": placed.time,
        "status": placed.status.name(),
        "rms_m": placed.rms,
        "rms_fixed_m": placed.rms_fixed(),
        "markers": markers.collect::<Vec<_>>(),
        "markers_not_recorded": placed.unseen,
        "posture": posture,
    })
}

fn markdown(command: &Scale, done: &Subject) -> String {
    let mut text = format!("# {}\n\n", command.output.display());
    if !done.measurements.is_empty() {
        text.push_str("| measurement | pair | recorded (m) | model (m) | factor |\n");
        text.push_str("| --- | --- | --: | --: | --: |\n");
        for found in &done.measurements {
            for ([a, b], [seen, model]) in &found.pairs {
                let name = &found.name;
                text.push_str(&format!("| {name} | {a} {b} | {seen:.6} | {model:.6} | |\n"));
            }
            let factor = found.factor.map_or("not used".to_owned(), |f| format!("{f:.6}"));
            text.push_str(&format!("| {} | | | | {factor} |\n", found.name));
        }
        text.push('\n');
    }
    text.push_str(&done.report.markdown());
    if let Some(placed) = &done.placed {
        text.push_str(&format!(
            "\nMarkers in the pose at {} s ({}): {:.1} mm RMS before they were moved.\n\n",
            placed.time,
            placed.status.name(),
            1e3 * placed.rms
        ));
        text.push_str("| marker | off by (mm) | |\n| --- | --: | --- |\n");
        for marker in &placed.markers {
            let fixed = if marker.fixed { "fixed" } else { "" };
            text.push_str(&format!("| {} | {:.1} | {fixed} |\n", marker.name, 1e3 * marker.error));
        }
        if !placed.unseen.is_empty() {
            text.push_str(&format!("\nNot recorded: {}.\n", placed.unseen.join(", ")));
        }
    }
    text
}

/// A few lines for the screen.
fn said(done: &Subject) -> String {
    let report = &done.report;
    let rows = report.bodies.iter().filter(|body| body.factors != [1.0; 3]).map(|body| {
        let [x, y, z] = body.factors.map(|f| format!("{f:.4}"));
        vec![body.name.clone(), x, y, z]
    });
    let mut text = output::columns(&rows.collect::<Vec<_>>());
    let [before, after] = report.mass();
    if before > 0.0 {
        text.push_str(&format!("mass: {before:.2} kg before, {after:.2} kg after\n"));
    }
    let mut list = |title: &str, names: Vec<String>| {
        if !names.is_empty() {
            let few = output::few(names.into_iter());
            text.push_str(&format!("{title}: {few}\n"));
        }
    };
    let beyond = report.beyond.iter().map(|(what, which)| format!("{which} ({what})"));
    list("scaled, though OpenSim leaves them", beyond.collect());
    let left = report.left.iter().map(|left| format!("{} ({})", left.part, left.why));
    list("not scaled", left.collect());
    list("lengths of wrapped paths may be off by some percent", report.wrapping.clone());
    if let Some(placed) = &done.placed {
        text.push_str(&format!(
            "{} markers: {:.1} mm RMS before they were moved\n",
            placed.markers.len(),
            1e3 * placed.rms
        ));
        if let Some(rms) = placed.rms_fixed() {
            text.push_str(&format!("fixed markers: {:.1} mm RMS\n", 1e3 * rms));
        }
        list_unseen(&mut text, placed);
    }
    text
}

fn list_unseen(text: &mut String, placed: &Placed) {
    if !placed.unseen.is_empty() {
        let few = output::few(placed.unseen.iter().cloned());
        text.push_str(&format!("markers of the model not recorded: {few}\n"));
    }
}
