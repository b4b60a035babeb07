//! A setup of inverse kinematics: files, time range and tasks.

use crate::output::columns;
use condyle::formats::document::setup::TrackSetup;
use condyle::formats::opensim::setup::{CoordinateTarget, IkSetup, IkTaskSet, IkTasks};
use serde_json::{Value, json};

pub(super) fn tasks_to_json(tasks: &IkTaskSet) -> Value {
    let markers: Vec<Value> = tasks
        .markers
        .iter()
        .map(|task| json!({ "name": task.name, "apply": task.apply, "weight": task.weight }))
        .collect();
    let coordinates: Vec<Value> = tasks
        .coordinates
        .iter()
        .map(|task| {
            let target = match task.target {
                CoordinateTarget::Default => json!("default"),
                CoordinateTarget::Manual(value) => json!(value),
                CoordinateTarget::FromFile => json!("file"),
            };
            json!({
                "name": task.name,
                "apply": task.apply,
                "weight": task.weight,
                "target": target,
            })
        })
        .collect();
    json!({ "kind": "ik_tasks", "marker_tasks": markers, "coordinate_tasks": coordinates })
}

pub(super) fn to_json(setup: &IkSetup) -> Value {
    let mut value = match &setup.tasks {
        IkTasks::Inline(tasks) => tasks_to_json(tasks),
        IkTasks::File(name) => json!({ "task_file": name }),
    };
    value["kind"] = json!("ik_setup");
    value["name"] = json!(setup.name);
    value["model_file"] = json!(setup.model_file);
    value["marker_file"] = json!(setup.marker_file);
    value["coordinate_file"] = json!(setup.coordinate_file);
    value["output_motion_file"] = json!(setup.output_motion_file);
    value["time_range"] = json!(setup.time_range);
    // JSON has no infinity: null means loops that are closed exactly.
    value["constraint_weight"] = json!(setup.constraint_weight);
    value["accuracy"] = json!(setup.accuracy);
    value
}

pub(super) fn tasks_to_text(tasks: &IkTaskSet) -> String {
    format!("tasks of inverse kinematics\n{}", task_lines(tasks))
}

pub(super) fn to_text(setup: &IkSetup) -> String {
    let mut text = format!("setup of inverse kinematics `{}`\n", setup.name);
    let mut rows = vec![];
    let files = [
        ("model", &setup.model_file),
        ("markers", &setup.marker_file),
        ("coordinates", &setup.coordinate_file),
        ("output", &setup.output_motion_file),
    ];
    for (what, file) in files {
        if let Some(file) = file {
            rows.push(vec![what.to_owned(), file.clone()]);
        }
    }
    if let Some([first, last]) = setup.time_range {
        rows.push(vec!["time".to_owned(), format!("from {first} to {last} s")]);
    }
    let weight = if setup.constraint_weight.is_finite() {
        format!("weight {}", setup.constraint_weight)
    } else {
        "closed exactly".to_owned()
    };
    rows.push(vec!["loops".to_owned(), weight]);
    text.push_str(&columns(&rows));
    match &setup.tasks {
        IkTasks::Inline(tasks) => text.push_str(&task_lines(tasks)),
        IkTasks::File(name) => text.push_str(&format!("tasks in {name}\n")),
    }
    text
}

/// A setup that people write.
pub(super) fn written_to_text(setup: &TrackSetup) -> String {
    let pair = |name: &str, value: String| vec![name.to_owned(), value];
    let mut rows = vec![];
    rows.extend(setup.time.map(|[first, last]| pair("time", format!("{first} to {last} s"))));
    rows.extend(setup.names.as_ref().map(|names| pair("names", names.clone())));
    rows.extend(setup.limits.map(|on| pair("limits", on.to_string())));
    rows.extend(setup.robust.map(|on| pair("robust", on.to_string())));
    rows.extend(setup.max_rms.map(|rms| pair("max_rms", format!("{rms} m"))));
    rows.extend(setup.loop_weight.map(|weight| pair("loop_weight", weight.to_string())));
    rows.extend(setup.weights.iter().map(|(name, w)| pair(name, format!("weight {w}"))));
    let sum = |coordinates: &[(String, f64)]| {
        let terms = coordinates.iter().map(|(name, factor)| format!("{factor} {name}"));
        terms.collect::<Vec<_>>().join(" + ")
    };
    let postures = setup.postures.iter();
    rows.extend(postures.map(|p| pair(&sum(&p.coordinates), format!("stiffness {}", p.stiffness))));
    let coordinates = setup.coordinates.iter();
    rows.extend(coordinates.map(|c| pair(&c.name, format!("weight {}", c.weight))));
    format!("a setup of tracking\n{}", columns(&rows))
}

fn task_lines(tasks: &IkTaskSet) -> String {
    let off = |apply: bool| if apply { String::new() } else { "off".to_owned() };
    let mut text = format!("\nmarker tasks ({}): weight\n", tasks.markers.len());
    let rows: Vec<Vec<String>> = tasks
        .markers
        .iter()
        .map(|task| vec![task.name.clone(), task.weight.to_string(), off(task.apply)])
        .collect();
    text.push_str(&columns(&rows));
    text.push_str(&format!("\ncoordinate tasks ({}): weight, target\n", tasks.coordinates.len()));
    let rows: Vec<Vec<String>> = tasks
        .coordinates
        .iter()
        .map(|task| {
            let target = match task.target {
                CoordinateTarget::Default => "the default".to_owned(),
                CoordinateTarget::Manual(value) => value.to_string(),
                CoordinateTarget::FromFile => "from the coordinate file".to_owned(),
            };
            vec![task.name.clone(), task.weight.to_string(), target, off(task.apply)]
        })
        .collect();
    text.push_str(&columns(&rows));
    text
}
