//! A model file made as large as a person: every length of an `.osim` multiplied by the factors of its
//! body, in the text as it stands. What is no length, and what is not understood, stays letter for letter.
//!
//! Rules are those of OpenSim 4.6, taken from what it does. With `f` the factors of the body that
//! carries a part along its axes x, y, z (1 for the ground):
//!
//! | part | what becomes of it |
//! | --- | --- |
//! | mass centres, offset frames, joint frames, markers, stations, path points | each number times that of its axis in `f`, also in frames that are turned |
//! | moving path points, translations of custom joints | their functions are multiplied, by the factor of the axis; a translation along a by \|a\|·f |
//! | translations that are a coordinate unchanged | stay: their coordinate is in metres |
//! | meshes and other geometry | `scale_factors` times `f` |
//! | wrap cylinders, tori | radii by the mean of the local factors of x and y, length by that of z |
//! | wrap ellipsoids, spheres | each axis by its local factor; a radius by the mean of `f` |
//! | ellipsoids of joints | by `f` of the parent; a hinge of the scapula by that of the child |
//! | arcs of constant curvature | by y of the child |
//! | masses | by the product of `f`, unless masses are kept; then all by one number to the mass wanted |
//! | inertias | by s² and mass where factors are equal, else as those of a cylinder |
//! | optimal fibre, tendon slack, resting and slack lengths | by the ratio of the lengths of the path in the default pose |
//! | couplers of a coordinate in metres | their `scale_factor` |
//!
//! A local factor is the length of `f` times the local axis. Unless [`Rules::as_opensim`] is set, some
//! things that OpenSim leaves are scaled too and listed in the report ([`Report::beyond`]): points of
//! constraints, contacts and springs, defaults and ranges of coordinates in metres, lengths of muscles
//! with a rigid tendon. And a translation along an oblique axis `a` runs along `f`·a afterwards, by its
//! length, which is what the same bone does when it is stretched; OpenSim keeps the axis and multiplies
//! by |a|·f, which is more than 1 even where nothing is scaled.

mod body;
mod joint;
mod length;
mod part;
mod placed;
mod report;

pub use placed::{MarkerPlace, fixed_markers, with_marker_set, with_markers_at, without_markers};
pub use report::{Left, Report, ScaledBody};

use super::model::frame::{Frames, is_default};
use super::model::{self, Base, triple};
use crate::Include;
use crate::xml::edit::Edits;
use crate::xml::{Element, XmlDocument, text_of};
use condyle_diagnostics::{Diagnostic, Error, Read, Warnings, nearest};
use condyle_math::{Growth, Vec3};
use condyle_model::{Model, ModelBuilder};
use std::collections::{BTreeMap, HashMap, HashSet};

/// The factors of bodies along their axes x, y, z; a body that is not named keeps its size.
pub type Factors = BTreeMap<String, [f64; 3]>;

/// How a model is scaled.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rules {
    /// Leave what OpenSim leaves, and stretch oblique translations as it does.
    pub as_opensim: bool,
    /// The mass of all bodies together afterwards (kilograms); without it, masses follow the volumes.
    pub mass: Option<f64>,
    /// Keep the shares of the bodies in the mass.
    pub preserve_mass: bool,
}

/// A scaled model file.
#[derive(Clone, Debug)]
pub struct Scaled {
    /// The file.
    pub text: String,
    /// What was scaled and what was not.
    pub report: Report,
}

/// The text of a model file with all its sets inside and in UTF-8, as [`scale`] takes it.
///
/// # Errors
/// Where the file is not XML, no model, or a set that it names cannot be had.
pub fn whole(bytes: &[u8], include: &mut Include<'_>) -> Result<Read<String>, Error> {
    let Read { value: text, mut warnings } = text_of(bytes)?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let read = model::include::put_into_text(text, include)?;
    warnings.extend(read.warnings);
    Ok(Read { value: in_utf_8(read.value), warnings })
}

/// The text with a declaration that says how it is written from now on.
fn in_utf_8(mut text: String) -> String {
    let Some(end) = text.starts_with("<?xml").then(|| text.find("?>")).flatten() else {
        return text;
    };
    let head = text.get(..end).unwrap_or_default();
    let Some(at) = head.find("encoding=").map(|at| at + "encoding=".len()) else { return text };
    let Some(quote @ ('"' | '\'')) = head.get(at..).and_then(|rest| rest.chars().next()) else {
        return text;
    };
    let Some(length) = head.get(at + 1..).and_then(|rest| rest.find(quote)) else { return text };
    let named = at + 1..at + 1 + length;
    if !head.get(named.clone()).is_some_and(|name| name.eq_ignore_ascii_case("utf-8")) {
        text.replace_range(named, "UTF-8");
    }
    text
}

/// The model that a text holds.
///
/// # Errors
/// As [`model::read`].
pub fn model_of(text: &str) -> Result<Read<Model>, Error> {
    model::read(text.as_bytes())
}

/// Scales a model file, whose sets must be inside ([`whole`]). `posture` gives the values in which paths
/// are measured, before and after: [`Model::defaults`], or these with loops closed.
///
/// # Errors
/// Where the model cannot be read, a factor is not positive, or a number in the file is none.
///
/// ```
/// use condyle_formats::opensim::scale::{Factors, Rules, scale};
/// let text = r#"<OpenSimDocument Version="40000"><Model name="arm">
///   <BodySet><objects><Body name="forearm">
///     <mass>2</mass><mass_center>0 -0.1 0</mass_center><inertia>3 1 3 0 0 0</inertia>
///   </Body></objects></BodySet>
///   <JointSet><objects><PinJoint name="elbow">
///     <socket_parent_frame>/ground</socket_parent_frame>
///     <socket_child_frame>/bodyset/forearm</socket_child_frame>
///   </PinJoint></objects></JointSet><!-- mine --></Model></OpenSimDocument>"#;
/// let factors = Factors::from([("forearm".to_owned(), [1.0, 1.5, 1.0])]);
/// let scaled = scale(text, &factors, &Rules::default(), &mut |m| m.defaults())?.value;
/// assert!(scaled.text.contains("<mass>3</mass>"));
/// assert!(scaled.text.contains("<mass_center>0 -0.15000000000000002 0</mass_center>"));
/// assert!(scaled.text.ends_with("<!-- mine --></Model></OpenSimDocument>"));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn scale(
    text: &str,
    factors: &Factors,
    rules: &Rules,
    posture: &mut dyn FnMut(&Model) -> Vec<f64>,
) -> Result<Read<Scaled>, Error> {
    let mut warnings = Warnings::default();
    check(factors, rules)?;
    let Read { value: document, warnings: said } = XmlDocument::parse(text)?;
    warnings.extend(said);
    let element = element_of(&document)?;
    let before = model::from_element(element, &mut warnings)?;
    let mut scaling = Scaling::new(text, element, factors, rules, &mut warnings)?;
    let lengths_before = length::measure(element, &scaling.frames, &before, posture)?;
    scaling.everything()?;
    let Scaling { edits, mut report, .. } = scaling;
    let text = edits.finish();
    // The lengths of paths are known when all else is scaled.
    let document = XmlDocument::parse(&text)?.value;
    let element = element_of(&document)?;
    let mut unsaid = Warnings::default();
    let after = model::from_element(element, &mut unsaid)?;
    let frames = Frames::collect(element, &mut ModelBuilder::new(""))?;
    let lengths_after = length::measure(element, &frames, &after, posture)?;
    let mut edits = Edits::new(&text);
    length::follow(&lengths_before, &lengths_after, rules, &mut edits, &mut report)?;
    let scaled = Scaled { text: edits.finish(), report };
    Ok(Read { value: scaled, warnings: warnings.finish() })
}

fn element_of(document: &XmlDocument) -> Result<Element<'_>, Error> {
    let root = document.root();
    model::of(root).ok_or_else(|| {
        root.error("osim/no-model", format!("{} holds no <Model>", root.describe()))
            .with_help("give an OpenSim model")
    })
}

fn check(factors: &Factors, rules: &Rules) -> Result<(), Error> {
    let good = |x: f64| x.is_finite() && x > 0.0;
    if let Some((name, three)) = factors.iter().find(|(_, three)| !three.iter().all(|x| good(*x))) {
        let message = format!("the factors {three:?} of `{name}` are not all positive");
        return Err(Error::new("scale/factor", message)
            .with_help("a factor is the new length over the old one, a number above 0"));
    }
    if rules.mass.is_some_and(|mass| !good(mass)) {
        return Err(Error::new("scale/mass", "the mass is not positive")
            .with_help("give it in kilograms, or none"));
    }
    Ok(())
}

/// One model file being scaled.
struct Scaling<'d, 't, 'r> {
    model: Element<'d>,
    frames: Frames<'d>,
    /// Of each body, by its position.
    factors: Vec<Vec3>,
    rules: &'r Rules,
    edits: Edits<'t>,
    report: Report,
    /// The version of the file, such as 30505; the newest if it does not say.
    version: u32,
    /// For coordinates that are lengths: what these are multiplied by.
    lengths: HashMap<String, f64>,
    /// The same for those that OpenSim calls translational.
    translations: HashMap<String, f64>,
    /// Coordinates that are lengths in a body of unequal factors.
    unequal: HashSet<String>,
    warnings: &'r mut Warnings,
}

impl<'d, 't, 'r> Scaling<'d, 't, 'r> {
    fn new(
        text: &'t str,
        model: Element<'d>,
        factors: &Factors,
        rules: &'r Rules,
        warnings: &'r mut Warnings,
    ) -> Result<Self, Error> {
        let frames = Frames::collect(model, &mut ModelBuilder::new(""))?;
        let bodies: Vec<&str> =
            frames.bodies().map(|(e, _)| e.attribute("name").unwrap_or_default()).collect();
        for name in factors.keys().filter(|name| *name != "ground") {
            if !bodies.contains(&name.as_str()) {
                let message = format!("the model has no body `{name}`: its factors are not used");
                let said = Diagnostic::warning("scale/unknown-body", message);
                warnings.push(match nearest(name, bodies.iter().copied()) {
                    Some(near) => said.with_help(format!("did you mean `{near}`?")),
                    None => said,
                });
            }
        }
        let of_body = |name: &&str| factors.get(*name).map_or([1.0; 3], |three| *three).into();
        let version = model.parent().and_then(|root| root.attribute("Version"));
        Ok(Self {
            factors: bodies.iter().map(of_body).collect(),
            model,
            frames,
            rules,
            edits: Edits::new(text),
            report: Report::default(),
            version: version.and_then(|v| v.trim().parse().ok()).unwrap_or(u32::MAX),
            lengths: HashMap::new(),
            translations: HashMap::new(),
            unequal: HashSet::new(),
            warnings,
        })
    }

    fn everything(&mut self) -> Result<(), Error> {
        let parts: Vec<Element<'d>> =
            self.model.descendants().filter(|e| !is_default(*e)).collect();
        self.bodies()?;
        // Joints say which coordinates are lengths.
        for joint in parts.iter().filter(|e| model::is_joint(e.name())) {
            self.joint(*joint)?;
        }
        for part in parts {
            self.part(part)?;
        }
        Ok(())
    }

    /// The factors of what a part is fixed in.
    fn factor(&self, base: Base) -> Vec3 {
        let ones = Vec3::new(1.0, 1.0, 1.0);
        base.and_then(|id| self.factors.get(id.index()).copied()).unwrap_or(ones)
    }

    /// The factors of the nearest frame around a part.
    fn around(&self, part: Element<'d>) -> Result<Option<Vec3>, Error> {
        let mut here = part.parent();
        while let Some(element) = here {
            if let Some((base, _)) = self.frames.at(element)? {
                return Ok(Some(self.factor(base)));
            }
            here = element.parent();
        }
        Ok(None)
    }

    /// Multiplies the three numbers of a property; answers whether it has any.
    fn triple(&mut self, owner: Element<'d>, name: &str, factor: Vec3) -> Result<bool, Error> {
        let Some(child) = owner.child(name).filter(|e| !e.text().is_empty()) else {
            return Ok(false);
        };
        let value = triple(owner, name)?;
        if factor != Vec3::new(1.0, 1.0, 1.0) {
            self.edits.set_text(child, &written(&value.times(factor).to_array()));
        }
        Ok(true)
    }

    /// Multiplies the number of a property; answers whether it has one.
    fn number(&mut self, owner: Element<'d>, name: &str, factor: f64) -> Result<bool, Error> {
        let Some(value) = owner.child_f64(name)? else { return Ok(false) };
        if let Some(child) = owner.child(name)
            && factor != 1.0
        {
            self.edits.set_text(child, &written(&[value * factor]));
        }
        Ok(true)
    }
}

/// By how much a length along an axis of any length grows.
fn reach(axis: Vec3, by: &Growth) -> f64 {
    let reach = by.length(axis) / if by.is_even() { 1.0 } else { axis.norm() };
    if reach.is_finite() { reach } else { 1.0 }
}

/// Numbers as a file has them, with all their digits.
fn written(numbers: &[f64]) -> String {
    let words: Vec<String> = numbers.iter().map(f64::to_string).collect();
    words.join(" ")
}

/// What something is called in the report.
fn name_of(element: Element<'_>) -> String {
    match element.attribute("name").filter(|name| !name.is_empty()) {
        Some(name) => format!("{} `{name}`", element.name()),
        None => element.name().to_owned(),
    }
}
