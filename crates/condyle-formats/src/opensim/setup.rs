//! Setup files of OpenSim's inverse kinematics tool.
//!
//! Paths in a setup are relative to its own folder; they are returned as written, and `Unassigned`
//! or blank means none. The task set may be inside the setup or in a file of its own; then
//! [`IkTasks::File`] names it and [`read_tasks`] reads it.
//!
//! Before version 2.4 the tool was called `IKTool`; some of these keep the marker file, the time range
//! and the output of each trial in an `IKTrialSet`, of which the first trial is read, as OpenSim does.
//! A time range that is absent, blank, `Unassigned`, `-Inf Inf` or the old default `-1 -1` stands for
//! all of the recording, and so does a set without marker tasks for all markers.

use crate::xml::{Element, XmlDocument};
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings, nearest};

/// The settings of an inverse kinematics run.
#[derive(Debug, Clone, PartialEq)]
pub struct IkSetup {
    /// The tool's name; may be empty.
    pub name: String,
    /// The model, as written.
    pub model_file: Option<String>,
    /// The marker recording, as written.
    pub marker_file: Option<String>,
    /// The motion that tasks with [`CoordinateTarget::FromFile`] follow, as written.
    pub coordinate_file: Option<String>,
    /// The file for the result, as written.
    pub output_motion_file: Option<String>,
    /// First and last time to solve, in seconds, either of which may be infinite; `None` for all of
    /// the recording.
    pub time_range: Option<[f64; 2]>,
    /// The weight of constraint errors; infinite, the default, if constraints must hold exactly.
    pub constraint_weight: f64,
    /// The requested accuracy; 1e-5 by default.
    pub accuracy: f64,
    /// What to follow, and how strongly.
    pub tasks: IkTasks,
}

/// Where a setup's tasks are.
#[derive(Debug, Clone, PartialEq)]
pub enum IkTasks {
    /// In the setup itself; empty if it has none.
    Inline(IkTaskSet),
    /// In a file of their own, to be read by [`read_tasks`]; the path as written.
    File(String),
}

/// What to follow, and how strongly.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IkTaskSet {
    /// Markers; no two of one name. None at all stands for every marker with weight 1.
    pub markers: Vec<MarkerTask>,
    /// Coordinates; no two of one name.
    pub coordinates: Vec<CoordinateTask>,
}

/// Bring a model's marker to its recorded position.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkerTask {
    /// The marker's name in model and recording.
    pub name: String,
    /// Whether the task is on.
    pub apply: bool,
    /// The weight of the squared distance; not negative.
    pub weight: f64,
}

/// Bring a coordinate to a value.
#[derive(Debug, Clone, PartialEq)]
pub struct CoordinateTask {
    /// The coordinate's name in the model.
    pub name: String,
    /// Whether the task is on.
    pub apply: bool,
    /// The weight of the squared difference; not negative.
    pub weight: f64,
    /// The value to reach.
    pub target: CoordinateTarget,
}

/// The value a coordinate is brought to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CoordinateTarget {
    /// The coordinate's default in the model.
    Default,
    /// A fixed value in radians or metres.
    Manual(f64),
    /// The value at each time in the setup's coordinate file.
    FromFile,
}

/// Reads a setup.
///
/// # Errors
///
/// Those of [`XmlDocument::parse`] and of its numbers; `setup/not-ik` if there is no inverse
/// kinematics tool, `setup/time-range`, `setup/weight`, `setup/value-type`.
///
/// ```
/// use condyle_formats::opensim::setup;
/// let text = r#"<OpenSimDocument Version="40000"><InverseKinematicsTool>
///     <model_file>arm.osim</model_file> <coordinate_file>Unassigned</coordinate_file>
///     <constraint_weight>20</constraint_weight>
///     <IKTaskSet file="tasks.xml"/>
/// </InverseKinematicsTool></OpenSimDocument>"#;
/// let setup = setup::read(text)?.value;
/// assert_eq!(setup.model_file.as_deref(), Some("arm.osim"));
/// assert_eq!(setup.coordinate_file, None);
/// assert_eq!(setup.constraint_weight, 20.0);
/// assert_eq!(setup.tasks, setup::IkTasks::File("tasks.xml".into()));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(text: &str) -> Result<Read<IkSetup>, Error> {
    from_document(XmlDocument::parse(text)?)
}

/// Reads a setup from bytes.
///
/// # Errors
///
/// As [`read`].
pub fn from_bytes(bytes: &[u8]) -> Result<Read<IkSetup>, Error> {
    from_document(XmlDocument::from_bytes(bytes)?)
}

/// Reads a task set that has a file of its own: an `<IKTaskSet>`, bare or in an
/// `<OpenSimDocument>`.
///
/// # Errors
///
/// Those of [`XmlDocument::parse`] and of its numbers; `setup/no-tasks` if there is no task set,
/// `setup/weight`, `setup/value-type`.
///
/// ```
/// use condyle_formats::opensim::setup;
/// let text = r#"<IKTaskSet><objects><IKMarkerTask name="RASI"><weight>10</weight>
/// </IKMarkerTask></objects></IKTaskSet>"#;
/// let tasks = setup::read_tasks(text)?.value;
/// assert_eq!((tasks.markers[0].apply, tasks.markers[0].weight), (true, 10.0));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read_tasks(text: &str) -> Result<Read<IkTaskSet>, Error> {
    tasks_from_document(XmlDocument::parse(text)?)
}

/// Reads a task set from bytes.
///
/// # Errors
///
/// As [`read_tasks`].
pub fn tasks_from_bytes(bytes: &[u8]) -> Result<Read<IkTaskSet>, Error> {
    tasks_from_document(XmlDocument::from_bytes(bytes)?)
}

const TOOL: &str = "InverseKinematicsTool";
/// Its name before OpenSim 2.4.
const OLD_TOOL: &str = "IKTool";

/// The properties of a tool; unused ones are listed so that a mistyped name can be recognised.
const PROPERTIES: [&str; 13] = [
    "IKTaskSet",
    "IKTrialSet",
    "accuracy",
    "constraint_weight",
    "coordinate_file",
    "input_directory",
    "marker_file",
    "model_file",
    "output_motion_file",
    "report_errors",
    "report_marker_locations",
    "results_directory",
    "time_range",
];

pub(super) fn from_document(document: Read<XmlDocument>) -> Result<Read<IkSetup>, Error> {
    let mut warnings = Warnings::default();
    warnings.extend(document.warnings);
    let tool = tool(document.value.root(), &mut warnings)?;
    for child in tool.children().filter(|child| !PROPERTIES.contains(&child.name())) {
        if let Some(meant) = nearest(child.name(), PROPERTIES)
            && distance(child.name(), meant) <= 3
        {
            warnings.add("setup/unknown", || {
                Diagnostic::warning("setup/unknown", format!("<{}> is not known", child.name()))
                    .at(child.place())
                    .with_help(format!("it was skipped; did you mean <{meant}>?"))
            });
        }
    }
    if let Some(second) = trials(tool).nth(1) {
        let message = format!("{} holds {} trials", tool.describe(), trials(tool).count());
        warnings.push(
            Diagnostic::warning("setup/trials", message)
                .at(second.place())
                .with_help("the first is read; make a setup of each"),
        );
    }
    let tasks = match property(tool, "IKTaskSet") {
        None => {
            warnings.push(no_marker_tasks(tool));
            IkTasks::Inline(IkTaskSet::default())
        }
        Some(set) => match set.attribute("file").and_then(assigned) {
            Some(file) => IkTasks::File(file),
            None => IkTasks::Inline(task_set(set, &mut warnings)?),
        },
    };
    let setup = IkSetup {
        name: tool.attribute("name").unwrap_or_default().to_owned(),
        model_file: file(tool, "model_file"),
        marker_file: file(tool, "marker_file"),
        coordinate_file: file(tool, "coordinate_file"),
        output_motion_file: file(tool, "output_motion_file"),
        time_range: time_range(tool)?,
        constraint_weight: weight(tool, "constraint_weight")?.unwrap_or(f64::INFINITY),
        accuracy: match tool.child("accuracy") {
            Some(accuracy) if assigned(accuracy.text()).is_some() => accuracy.f64()?,
            _ => 1e-5,
        },
        tasks,
    };
    Ok(Read { value: setup, warnings: warnings.finish() })
}

/// The tool's element, bare or in its document, by its name or one that differs by two letters.
pub(super) fn tool_of(root: Element<'_>) -> Option<Element<'_>> {
    let candidates = || std::iter::once(root).chain(root.children());
    let misspelt = || candidates().find(|e| distance(e.name(), TOOL) <= 2);
    candidates().find(|e| e.is(TOOL) || e.is(OLD_TOOL)).or_else(misspelt)
}

/// The tool itself, bare or in its document; in OpenSim's own files its name is misspelt.
fn tool<'d>(root: Element<'d>, warnings: &mut Warnings) -> Result<Element<'d>, Error> {
    if let Some(tool) = tool_of(root) {
        if !tool.is(TOOL) && !tool.is(OLD_TOOL) {
            warnings.push(
                Diagnostic::warning("setup/misspelt", format!("<{}> is not known", tool.name()))
                    .at(tool.place())
                    .with_help(format!("read as <{TOOL}>")),
            );
        }
        return Ok(tool);
    }
    let found = root.children().next().unwrap_or(root);
    Err(found
        .error("setup/not-ik", format!("there is no <{TOOL}>, only <{}>", found.name()))
        .with_help("this is not a setup of inverse kinematics"))
}

/// The edit distance of two names; names of elements are short.
fn distance(a: &str, b: &str) -> usize {
    if a.len() > 64 { usize::MAX } else { strsim::levenshtein(a, b) }
}

/// The trials of a tool of old.
fn trials<'d>(tool: Element<'d>) -> impl Iterator<Item = Element<'d>> {
    let set = tool.child("IKTrialSet");
    let list = set.map(|set| set.child("objects").unwrap_or(set));
    list.into_iter().flat_map(|list| list.children()).filter(|e| e.is("IKTrial"))
}

/// A property of the tool, or of its first trial.
fn property<'d>(tool: Element<'d>, name: &str) -> Option<Element<'d>> {
    tool.child(name).or_else(|| trials(tool).next()?.child(name))
}

fn no_marker_tasks(at: Element<'_>) -> Diagnostic {
    Diagnostic::note("setup/no-tasks", format!("{} has no marker tasks", at.describe()))
        .at(at.place())
        .with_help(
            "every marker that model and recording share counts with weight 1, as in OpenSim",
        )
}

/// A path, unless it is blank or `Unassigned`.
pub(super) fn assigned(path: &str) -> Option<String> {
    let path = path.trim();
    (!path.is_empty() && !path.eq_ignore_ascii_case("unassigned")).then(|| path.to_owned())
}

fn file(tool: Element<'_>, name: &str) -> Option<String> {
    property(tool, name).map(Element::text).and_then(assigned)
}

pub(super) fn time_range(tool: Element<'_>) -> Result<Option<[f64; 2]>, Error> {
    let Some(place) = property(tool, "time_range") else { return Ok(None) };
    let mut words = place.text().split_whitespace();
    if words.all(|word| assigned(word).is_none()) {
        return Ok(None);
    }
    let range = place.numbers::<2>()?;
    // What OpenSim wrote where no range was given, before and since version 2.
    if range == [-1.0; 2] || range == [f64::NEG_INFINITY, f64::INFINITY] {
        return Ok(None);
    }
    let [start, end] = range;
    let wrong = |message: String, help: String| {
        Err(place.error("setup/time-range", message).with_help(help))
    };
    if start.is_nan() || end.is_nan() {
        let help = "write the first and the last time in seconds, or `-Inf Inf` for all";
        return wrong(format!("the time range `{}` is not two numbers", place.text()), help.into());
    }
    if start > end {
        let help = format!("write the earlier time first: `{end} {start}`");
        return wrong(format!("the time range `{start} {end}` is reversed"), help);
    }
    Ok(Some(range))
}

/// A child's weight; `None` if there is no such child or it is blank.
fn weight(element: Element<'_>, name: &str) -> Result<Option<f64>, Error> {
    let Some(child) = element.child(name) else { return Ok(None) };
    if assigned(child.text()).is_none() {
        return Ok(None);
    }
    match child.f64()? {
        weight if weight >= 0.0 => Ok(Some(weight)),
        weight => Err(child
            .error(
                "setup/weight",
                format!("the weight {weight} of {} is not valid", element.describe()),
            )
            .with_help("a weight is 0 or more")),
    }
}

/// The task set's element: bare, in its document, or in a setup.
pub(super) fn tasks_of(root: Element<'_>) -> Option<Element<'_>> {
    let set = std::iter::once(root).chain(root.children()).find(|e| e.is("IKTaskSet"));
    set.or_else(|| property(tool_of(root)?, "IKTaskSet"))
}

pub(super) fn tasks_from_document(document: Read<XmlDocument>) -> Result<Read<IkTaskSet>, Error> {
    let mut warnings = Warnings::default();
    warnings.extend(document.warnings);
    let root = document.value.root();
    let Some(set) = tasks_of(root) else {
        return Err(root
            .error("setup/no-tasks", format!("there is no <IKTaskSet> in {}", root.describe()))
            .with_help("this is not a set of inverse kinematics tasks"));
    };
    if set.attribute("file").and_then(assigned).is_some() {
        return Err(set
            .error("setup/no-tasks", "the task set only names another file")
            .with_help("name that file in the setup"));
    }
    let tasks = task_set(set, &mut warnings)?;
    Ok(Read { value: tasks, warnings: warnings.finish() })
}

/// The tasks of a set; of two with the same name the first.
pub(super) fn task_set(set: Element<'_>, warnings: &mut Warnings) -> Result<IkTaskSet, Error> {
    let mut tasks = IkTaskSet::default();
    let mut seen = std::collections::HashSet::new();
    for task in set.child("objects").unwrap_or(set).children() {
        if !task.is("IKMarkerTask") && !task.is("IKCoordinateTask") {
            if !matches!(task.name(), "objects" | "groups" | "defaults") {
                warnings.add("setup/unknown-task", || {
                    Diagnostic::warning(
                        "setup/unknown-task",
                        format!("<{}> is not a task", task.name()),
                    )
                    .at(task.place())
                    .with_help("it was skipped; tasks are IKMarkerTask and IKCoordinateTask")
                });
            }
            continue;
        }
        let name = task.require_attribute("name")?.to_owned();
        let apply = task.child_bool("apply")?.unwrap_or(true);
        let given = weight(task, "weight")?;
        if given.is_none() {
            warnings.add("setup/no-weight", || {
                Diagnostic::warning("setup/no-weight", format!("{} has no weight", task.describe()))
                    .at(task.place())
                    .with_help("it is 0, as in OpenSim")
            });
        }
        let weight = given.unwrap_or(0.0);
        if !weight.is_finite() {
            return Err(task
                .error("setup/weight", format!("the weight of {} is infinite", task.describe()))
                .with_help("write a large number; only constraint_weight may be infinite"));
        }
        if !seen.insert((task.name(), name.clone())) {
            warnings.add("setup/duplicate-task", || {
                Diagnostic::warning("setup/duplicate-task", format!("{} repeats", task.describe()))
                    .at(task.place())
                    .with_help("the first of them is used")
            });
        } else if task.is("IKMarkerTask") {
            tasks.markers.push(MarkerTask { name, apply, weight });
        } else {
            let target = target(task)?;
            tasks.coordinates.push(CoordinateTask { name, apply, weight, target });
        }
    }
    if tasks.markers.is_empty() {
        warnings.push(no_marker_tasks(set));
    }
    Ok(tasks)
}

fn target(task: Element<'_>) -> Result<CoordinateTarget, Error> {
    let kind = task.child_text("value_type").unwrap_or("default_value");
    match kind.to_ascii_lowercase().as_str() {
        "default_value" => Ok(CoordinateTarget::Default),
        "from_file" => Ok(CoordinateTarget::FromFile),
        "manual_value" => {
            let value = task.child_f64("value")?.unwrap_or(0.0);
            if value.is_finite() {
                return Ok(CoordinateTarget::Manual(value));
            }
            Err(task
                .error("setup/value-type", format!("the value of {} is {value}", task.describe()))
                .with_help("expected a finite number"))
        }
        _ => Err(task
            .child("value_type")
            .unwrap_or(task)
            .error("setup/value-type", format!("`{kind}` is not a type of value"))
            .with_help("expected default_value, manual_value or from_file")),
    }
}

#[cfg(test)]
#[path = "setup_tests.rs"]
mod tests;
