//! Setups of OpenSim's scale tool.
//!
//! Paths in a setup are relative to its own folder; they are returned as written, and `Unassigned` or
//! blank means none. Sets may be files of their own. A step whose `apply` is off is left out; so is a
//! measurement. Files of every version since 1.6 are read: the older ones name the marker set by an
//! element, `<MarkerSet file="markers.xml"/>`, or hold it.

use super::model::include::put_into_text;
use super::setup::{IkTaskSet, assigned, task_set, time_range};
use crate::Include;
use crate::xml::{Element, XmlDocument, text_of};
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings};

/// The settings of a scaling.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaleSetup {
    /// The tool's name; may be empty.
    pub name: String,
    /// The mass of the person (kilograms).
    pub mass: Option<f64>,
    /// The height as written, in millimetres by OpenSim's word; nothing follows from it.
    pub height: Option<f64>,
    /// The age in years; nothing follows from it.
    pub age: Option<f64>,
    /// The model, as written.
    pub model_file: Option<String>,
    /// Markers that are put into the model first.
    pub markers: MarkerSource,
    /// How factors are found, where the model is to be scaled.
    pub scaler: Option<Scaler>,
    /// How markers are placed, where they are to be.
    pub placer: Option<Placer>,
}

/// Where a marker set is.
#[derive(Clone, Debug, PartialEq)]
pub enum MarkerSource {
    /// In the model alone.
    Model,
    /// In a file of its own; the path as written.
    File(String),
    /// In the setup: the text of the set.
    Inline(String),
}

/// How the factors of bodies are found.
#[derive(Clone, Debug, PartialEq)]
pub struct Scaler {
    /// Sources of factors, later ones replacing earlier ones.
    pub order: Vec<Source>,
    /// Distances that give factors.
    pub measurements: Vec<Measurement>,
    /// Factors given by hand, for bodies.
    pub factors: Vec<(String, [f64; 3])>,
    /// The recording of the person standing, as written.
    pub marker_file: Option<String>,
    /// First and last time that is used (seconds); `None` for all of it.
    pub time_range: Option<[f64; 2]>,
    /// Keep the shares of the bodies in the mass.
    pub preserve_mass: bool,
    /// The file for the scaled model, as written.
    pub output_model_file: Option<String>,
    /// The file for the factors, as written.
    pub output_scale_file: Option<String>,
}

/// Where factors come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// [`Scaler::measurements`].
    Measurements,
    /// [`Scaler::factors`].
    Manual,
}

/// Distances between markers that give one factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Its name; may be empty.
    pub name: String,
    /// Pairs of markers.
    pub pairs: Vec<[String; 2]>,
    /// The bodies that take the factor, and along which of their axes.
    pub bodies: Vec<(String, [bool; 3])>,
}

/// How markers are placed.
#[derive(Clone, Debug, PartialEq)]
pub struct Placer {
    /// What the pose of the person follows.
    pub tasks: IkTaskSet,
    /// The recording of the person standing, as written.
    pub marker_file: Option<String>,
    /// Values of coordinates in that pose, as written.
    pub coordinate_file: Option<String>,
    /// First and last time that is averaged (seconds); `None` for all of it.
    pub time_range: Option<[f64; 2]>,
    /// The most that a marker may move in that time (metres); `None` for any.
    pub max_marker_movement: Option<f64>,
    /// Put markers that are not fixed where they were recorded.
    pub move_markers: bool,
    /// The file for the model, as written.
    pub output_model_file: Option<String>,
    /// The file for the pose, as written.
    pub output_motion_file: Option<String>,
    /// The file for the markers, as written.
    pub output_marker_file: Option<String>,
}

/// The tool's element, bare or in its document.
pub(super) fn tool_of(root: Element<'_>) -> Option<Element<'_>> {
    std::iter::once(root).chain(root.children()).find(|e| e.is("ScaleTool"))
}

/// Reads a setup; sets that are files of their own are asked of `include`.
///
/// # Errors
/// Where the file is not XML or a number is none; `setup/not-scaling` if it holds no `<ScaleTool>`,
/// `setup/marker-pair`, `setup/axes`, `setup/order`, `setup/time-range`, `setup/weight`.
///
/// ```
/// use condyle_formats::opensim::scale_setup;
/// let text = br#"<OpenSimDocument Version="40000"><ScaleTool name="me"><mass>72</mass><ModelScaler>
///   <scaling_order>measurements</scaling_order>
///   <MeasurementSet><objects><Measurement name="thigh"><MarkerPairSet><objects>
///     <MarkerPair><markers>RHIP RKNE</markers></MarkerPair></objects></MarkerPairSet>
///     <BodyScaleSet><objects><BodyScale name="femur_r"><axes>X Y</axes></BodyScale></objects>
///   </BodyScaleSet></Measurement></objects></MeasurementSet>
/// </ModelScaler></ScaleTool></OpenSimDocument>"#;
/// let setup = scale_setup::read(text, &mut |_| Err("none".into()))?.value;
/// let thigh = &setup.scaler.unwrap().measurements[0];
/// assert_eq!(thigh.bodies, [("femur_r".to_owned(), [true, true, false])]);
/// assert_eq!(setup.mass, Some(72.0));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn read(bytes: &[u8], include: &mut Include<'_>) -> Result<Read<ScaleSetup>, Error> {
    let Read { value: text, warnings: said } = text_of(bytes)?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let mut warnings = Warnings::default();
    warnings.extend(said);
    let whole = put_into_text(text, include)?;
    let document = XmlDocument::parse(&whole.value)?.value;
    warnings.extend(whole.warnings);
    let root = document.root();
    let Some(tool) = tool_of(root) else {
        let found = root.children().next().unwrap_or(root);
        let message = format!("there is no <ScaleTool>, only <{}>", found.name());
        return Err(found
            .error("setup/not-scaling", message)
            .with_help("give a setup of OpenSim's scaling"));
    };
    let maker = tool.child("GenericModelMaker");
    let known = |name: &str| Ok::<_, Error>(tool.child_f64(name)?.filter(|x| *x > 0.0));
    let inline = maker.and_then(|e| e.child("MarkerSet"));
    let inline = inline.filter(|set| set.descendants().any(|e| e.is("Marker")));
    let markers = match (maker.and_then(|e| file(e, "marker_set_file")), inline) {
        (Some(path), _) => MarkerSource::File(path),
        (None, Some(set)) => {
            MarkerSource::Inline(whole.value.get(set.span()).unwrap_or_default().to_owned())
        }
        (None, None) => MarkerSource::Model,
    };
    let applied = |name: &str| -> Result<Option<Element<'_>>, Error> {
        let Some(step) = tool.child(name) else { return Ok(None) };
        Ok(step.child_bool("apply")?.unwrap_or(true).then_some(step))
    };
    let setup = ScaleSetup {
        name: tool.attribute("name").unwrap_or_default().to_owned(),
        mass: known("mass")?,
        height: known("height")?,
        age: known("age")?,
        model_file: maker.and_then(|e| file(e, "model_file")),
        markers,
        scaler: applied("ModelScaler")?.map(|step| scaler(step, &mut warnings)).transpose()?,
        placer: applied("MarkerPlacer")?.map(|step| placer(step, &mut warnings)).transpose()?,
    };
    Ok(Read { value: setup, warnings: warnings.finish() })
}

fn file(owner: Element<'_>, name: &str) -> Option<String> {
    owner.child(name).map(Element::text).and_then(assigned)
}

/// The objects of a set.
fn objects<'d>(owner: Element<'d>, set: &str, class: &'d str) -> Vec<Element<'d>> {
    let set = owner.child(set).map(|set| set.child("objects").unwrap_or(set));
    set.into_iter().flat_map(|set| set.children_named(class)).collect()
}

fn scaler(step: Element<'_>, warnings: &mut Warnings) -> Result<Scaler, Error> {
    let mut order = vec![];
    for word in step.child_text("scaling_order").unwrap_or_default().split_whitespace() {
        order.push(match word.to_ascii_lowercase().as_str() {
            "measurements" => Source::Measurements,
            "manualscale" => Source::Manual,
            _ => {
                let at = step.child("scaling_order").unwrap_or(step);
                return Err(at
                    .error("setup/order", format!("`{word}` is no source of factors"))
                    .with_help("expected `measurements`, `manualScale` or both"));
            }
        });
    }
    let mut measurements = vec![];
    for measurement in objects(step, "MeasurementSet", "Measurement") {
        if measurement.child_bool("apply")?.unwrap_or(true) {
            measurements.push(read_measurement(measurement)?);
        }
    }
    let mut factors = vec![];
    for scale in objects(step, "ScaleSet", "Scale") {
        if !scale.child_bool("apply")?.unwrap_or(true) {
            continue;
        }
        let body = scale.child_text("segment").or_else(|| scale.attribute("name"));
        let three = scale.child_numbers::<3>("scales")?.unwrap_or([1.0; 3]);
        factors.push((body.unwrap_or_default().to_owned(), three));
    }
    let unused = |source: Source, what: &str| {
        let message = format!("{what} are given, but <scaling_order> does not name their source");
        let said = Diagnostic::warning("setup/order", message).at(step.place());
        (!order.contains(&source)).then(|| said.with_help("they are not used, as in OpenSim"))
    };
    if !measurements.is_empty() {
        unused(Source::Measurements, "measurements").into_iter().for_each(|w| warnings.push(w));
    }
    if !factors.is_empty() {
        unused(Source::Manual, "factors").into_iter().for_each(|w| warnings.push(w));
    }
    Ok(Scaler {
        order,
        measurements,
        factors,
        marker_file: file(step, "marker_file"),
        time_range: time_range(step)?,
        preserve_mass: step.child_bool("preserve_mass_distribution")?.unwrap_or(false),
        output_model_file: file(step, "output_model_file"),
        output_scale_file: file(step, "output_scale_file"),
    })
}

fn read_measurement(measurement: Element<'_>) -> Result<Measurement, Error> {
    let mut pairs = vec![];
    for pair in objects(measurement, "MarkerPairSet", "MarkerPair") {
        let markers = pair.child("markers").unwrap_or(pair);
        let names: Vec<String> = markers.text().split_whitespace().map(str::to_owned).collect();
        let count = names.len();
        pairs.push(<[String; 2]>::try_from(names).map_err(|_| {
            markers
                .error("setup/marker-pair", format!("a pair of markers holds {count} names"))
                .with_help("give two names without spaces in them")
        })?);
    }
    let mut bodies = vec![];
    for body in objects(measurement, "BodyScaleSet", "BodyScale") {
        let mut axes = [false; 3];
        for word in body.child_text("axes").unwrap_or_default().split_whitespace() {
            let place = ["x", "y", "z"].iter().position(|axis| word.eq_ignore_ascii_case(axis));
            let Some(place) = place else {
                let at = body.child("axes").unwrap_or(body);
                return Err(at
                    .error("setup/axes", format!("`{word}` is no axis of {}", body.describe()))
                    .with_help("expected some of X Y Z"));
            };
            axes[place] = true;
        }
        bodies.push((body.require_attribute("name")?.to_owned(), axes));
    }
    let name = measurement.attribute("name").unwrap_or_default().to_owned();
    Ok(Measurement { name, pairs, bodies })
}

fn placer(step: Element<'_>, warnings: &mut Warnings) -> Result<Placer, Error> {
    let tasks = match step.child("IKTaskSet") {
        Some(set) => task_set(set, warnings)?,
        None => IkTaskSet::default(),
    };
    Ok(Placer {
        tasks,
        marker_file: file(step, "marker_file"),
        coordinate_file: file(step, "coordinate_file"),
        time_range: time_range(step)?,
        max_marker_movement: step.child_f64("max_marker_movement")?.filter(|most| *most > 0.0),
        move_markers: step.child_bool("move_model_markers")?.unwrap_or(true),
        output_model_file: file(step, "output_model_file"),
        output_motion_file: file(step, "output_motion_file"),
        output_marker_file: file(step, "output_marker_file"),
    })
}
