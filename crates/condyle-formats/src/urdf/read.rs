//! Robot descriptions to models.

use crate::xml::{Element, XmlDocument};
use condyle_diagnostics::{Diagnostic, Error, Read, Severity, Warnings, nearest};
use condyle_math::function::Function;
use condyle_math::{Affine, EulerOrder, Vec3};
use condyle_model::{
    CoordinateId, CoordinateKind, Model, ModelBuilder, Range, SegmentId, Signal, UpAxis,
};
use std::collections::{HashMap, HashSet};

/// A bound of this size or more is none: some writers put one where the format wants a number.
const NO_BOUND: f64 = 1e9;
/// The most links: far beyond any robot, and far below what would take minutes to pose.
const MOST_LINKS: usize = 10_000;
/// The most pairs of a link and a joint on its way to the root.
const MOST_DIRECTIONS: usize = 4_000_000;

/// Reads a robot description.
///
/// # Errors
/// What is wrong, with its line: not XML, no `<robot>`, numbers that are none, links in a circle.
///
/// ```
/// let text = r#"<robot name="arm"><link name="base"/><link name="tip"/>
///   <joint name="elbow" type="revolute"><parent link="base"/><child link="tip"/>
///     <origin xyz="0 0 0.3"/><axis xyz="0 1 0"/><limit lower="0" upper="2.5"/></joint></robot>"#;
/// let model = condyle_formats::urdf::from_bytes(text.as_bytes())?.value;
/// assert_eq!(model.coordinates()[0].range.upper, Some(2.5));
/// # Ok::<(), condyle_formats::Error>(())
/// ```
pub fn from_bytes(bytes: &[u8]) -> Result<Read<Model>, Error> {
    let document = XmlDocument::from_bytes(bytes)?;
    let mut warnings = Warnings::default();
    warnings.extend(document.warnings);
    let root = document.value.root();
    if !root.is("robot") {
        let error = root.error("urdf/no-robot", format!("{} is no <robot>", root.describe()));
        return Err(error.with_help("give a robot description, not a world or a macro"));
    }
    if root.descendants().any(|e| e.name().starts_with("xacro:") || e.name().starts_with("xacro__"))
    {
        let error = root.error("urdf/xacro", "the file holds macros that are not expanded");
        return Err(error.with_help("expand it first, for example with `xacro FILE > robot.urdf`"));
    }
    let mut reader = Reader {
        robot: root,
        builder: ModelBuilder::new(root.attribute("name").unwrap_or("robot")),
        warnings,
        links: HashMap::new(),
        names: vec![],
        joints: HashMap::new(),
        mimics: vec![],
    };
    reader.builder.up(UpAxis::Z);
    reader.links()?;
    reader.joints()?;
    reader.mimics();
    reader.roots()?;
    reader.said();
    let place = root.place();
    let built = reader.builder.build_with_warnings().map_err(|error| {
        let errors = error.into_diagnostics().into_iter().filter(|f| f.severity == Severity::Error);
        let located = errors.map(|error| error.at(place)).take(50).collect();
        let unsaid = || Error::new("urdf/model", "the robot cannot be built").at(place);
        Error::of(located).unwrap_or_else(unsaid).contradiction()
    })?;
    reader.warnings.extend(built.warnings);
    Ok(Read { value: built.value, warnings: reader.warnings.finish() })
}

struct Reader<'d> {
    robot: Element<'d>,
    builder: ModelBuilder,
    warnings: Warnings,
    links: HashMap<&'d str, SegmentId>,
    /// The links in the order of their segments, each with the joint that moves it.
    names: Vec<(&'d str, Option<(&'d str, SegmentId)>)>,
    /// The coordinate of each joint of one number.
    joints: HashMap<&'d str, CoordinateId>,
    mimics: Vec<(CoordinateId, Element<'d>)>,
}

impl<'d> Reader<'d> {
    fn warn(&mut self, code: &'static str, at: Element<'_>, message: String, help: &str) {
        let said = Diagnostic::warning(code, message).at(at.place()).with_help(help);
        self.warnings.push(said);
    }

    fn links(&mut self) -> Result<(), Error> {
        for element in self.robot.children_named("link") {
            let name = element.require_attribute("name")?;
            if self.links.contains_key(name) {
                let message = format!("a second link is named `{name}`");
                self.warn("urdf/duplicate-link", element, message, "the first one is used");
                continue;
            }
            self.link(element, name)?;
        }
        Ok(())
    }

    fn link(&mut self, at: Element<'_>, name: &'d str) -> Result<SegmentId, Error> {
        if self.names.len() == MOST_LINKS {
            return Err(at
                .error("urdf/size", format!("there are more than {MOST_LINKS} links"))
                .with_help("is the file damaged?"));
        }
        let id = self.builder.segment(name, None);
        self.links.insert(name, id);
        self.names.push((name, None));
        Ok(id)
    }

    /// The link that a joint names; one that is not there is added.
    fn end(&mut self, joint: Element<'d>, word: &str) -> Result<SegmentId, Error> {
        let element = joint.require(word)?;
        let name = element.require_attribute("link")?;
        if let Some(&id) = self.links.get(name) {
            return Ok(id);
        }
        let message = format!("{} names the link `{name}`, which is not there", joint.describe());
        let near = nearest(name, self.links.keys().copied());
        let help = match near {
            Some(near) => format!("it is added; did you mean `{near}`?"),
            None => "it is added".to_owned(),
        };
        self.warn("urdf/unknown-link", element, message, &help);
        self.link(element, name)
    }

    fn joints(&mut self) -> Result<(), Error> {
        let mut seen: HashSet<String> = HashSet::new();
        for joint in self.robot.children_named("joint") {
            // Transmissions and simulators have elements of that name that move nothing.
            if joint.child("parent").is_none() && joint.child("child").is_none() {
                let message = format!("{} has neither parent nor child", joint.describe());
                self.warn("urdf/joint-ends", joint, message, "it is left out");
                continue;
            }
            let stated = joint.require_attribute("name")?;
            let mut name = stated.to_owned();
            let mut number = 2usize;
            while !seen.insert(name.clone()) {
                name = format!("{stated}_{number}");
                number += 1;
            }
            if name != stated {
                let message = format!("a second joint is named `{stated}`");
                self.warn("urdf/duplicate-joint", joint, message, &format!("it becomes `{name}`"));
            }
            self.joint(joint, stated, &name)?;
        }
        Ok(())
    }

    fn joint(&mut self, joint: Element<'d>, stated: &'d str, name: &str) -> Result<(), Error> {
        let (parent, child) = (self.end(joint, "parent")?, self.end(joint, "child")?);
        let entry = self.names.get(child.index()).copied();
        if let Some((link, Some((before, _)))) = entry {
            let message =
                format!("{} moves the link `{link}`, which `{before}` moves", joint.describe());
            self.warn(
                "urdf/two-parents",
                joint,
                message,
                "the first joint is used: loops are not said by URDF",
            );
            return Ok(());
        }
        if parent == child {
            return Err(joint
                .error("urdf/circle", format!("{} joins a link to itself", joint.describe()))
                .with_help("name two links"));
        }
        if let Some(entry) = self.names.get_mut(child.index()) {
            entry.1 = Some((stated, parent));
        }
        self.builder.set_parent(child, Some(parent));
        let origin = origin(joint)?;
        self.builder.place_joint_frames(child, origin, Affine::IDENTITY);
        let kind = joint.attribute("type").unwrap_or("");
        if kind == "fixed" {
            return Ok(());
        }
        let set = self.builder.joint_set(name);
        match kind {
            "revolute" | "continuous" | "prismatic" => {
                let slides = kind == "prismatic";
                let axis = self.axis(joint)?;
                let sort =
                    if slides { CoordinateKind::Translation } else { CoordinateKind::Rotation };
                let id = self.builder.coordinate(set, name, sort);
                let motion = match slides {
                    true => self.builder.translate(set, "slide", id, axis),
                    false => self.builder.rotate(set, "turn", id, axis),
                };
                self.builder.output(set, child, motion);
                self.joints.entry(stated).or_insert(id);
                if let Some(range) = self.range(joint, kind)? {
                    self.builder.coordinate_mut(id).range = range;
                }
                if let Some(mimic) = joint.child("mimic") {
                    self.mimics.push((id, mimic));
                }
            }
            "planar" => {
                let axis = self.axis(joint)?.normalized();
                let (first, second) = across(axis);
                let mut factors = vec![];
                for (word, along) in [("x", first), ("y", second)] {
                    let id = self.builder.coordinate(
                        set,
                        &format!("{name}_{word}"),
                        CoordinateKind::Translation,
                    );
                    factors.push(self.builder.translate(set, word, id, along));
                }
                let turn =
                    self.builder.coordinate(set, &format!("{name}_turn"), CoordinateKind::Rotation);
                factors.push(self.builder.rotate(set, "turn", turn, axis));
                let motion = self.builder.product(set, "motion", factors);
                self.builder.output(set, child, motion);
            }
            "floating" => {
                let mut factors = vec![];
                for (word, along) in [("x", Vec3::X), ("y", Vec3::Y), ("z", Vec3::Z)] {
                    let id = self.builder.coordinate(
                        set,
                        &format!("{name}_{word}"),
                        CoordinateKind::Translation,
                    );
                    factors.push(self.builder.translate(set, word, id, along));
                }
                let turn = format!("{name}_rotation");
                let turn = self.builder.coordinate(set, &turn, CoordinateKind::Orientation);
                factors.push(self.builder.ball(set, "rotation", turn));
                let motion = self.builder.product(set, "motion", factors);
                self.builder.output(set, child, motion);
            }
            other => {
                return Err(joint
                    .error(
                        "urdf/joint-type",
                        format!("{} has the type `{other}`", joint.describe()),
                    )
                    .with_help(
                        "known are fixed, revolute, continuous, prismatic, planar and floating",
                    ));
            }
        }
        Ok(())
    }

    fn axis(&mut self, joint: Element<'_>) -> Result<Vec3, Error> {
        let Some(element) = joint.child("axis") else { return Ok(Vec3::X) };
        let axis = match element.attribute("xyz") {
            Some(_) => triple(element, "xyz")?,
            None => Vec3::X,
        };
        if axis.norm() > 1e-9 {
            return Ok(axis);
        }
        let message = format!("the axis of {} has no direction", joint.describe());
        self.warn("urdf/axis", element, message, "the x axis is used, which is the default");
        Ok(Vec3::X)
    }

    fn range(&mut self, joint: Element<'_>, kind: &str) -> Result<Option<Range>, Error> {
        let Some(limit) = joint.child("limit") else {
            if kind != "continuous" {
                let message = format!("{} has no <limit>, which its type wants", joint.describe());
                self.warn("urdf/no-limit", joint, message, "it is free");
            }
            return Ok(None);
        };
        if kind == "continuous" {
            return Ok(None);
        }
        let side = |name: &str| -> Result<f64, Error> {
            match limit.attribute(name) {
                Some(text) => number(limit, name, text, true),
                None => Ok(0.0),
            }
        };
        let (mut lower, mut upper) = (side("lower")?, side("upper")?);
        if lower > upper {
            let message = format!("the limits of {} are in the wrong order", joint.describe());
            self.warn("urdf/limit-order", limit, message, "they are exchanged");
            (lower, upper) = (upper, lower);
        }
        let bound = |value: f64| (value.abs() < NO_BOUND).then_some(value);
        let range = Range { lower: bound(lower), upper: bound(upper), enforced: true };
        Ok((range.lower.is_some() || range.upper.is_some()).then_some(range))
    }

    /// Lets joints follow others, without circles.
    fn mimics(&mut self) {
        let mut leaders: HashMap<CoordinateId, CoordinateId> = HashMap::new();
        for (follower, element) in std::mem::take(&mut self.mimics) {
            let name = element.attribute("joint").unwrap_or_default();
            let Some(&leader) = self.joints.get(name) else {
                let message = format!(
                    "{} follows `{name}`, which is no joint of one number",
                    element.describe()
                );
                self.warn("urdf/mimic", element, message, "the joint is free");
                continue;
            };
            let mut here = Some(leader);
            let mut circle = false;
            while let Some(id) = here {
                circle |= id == follower;
                here = leaders.get(&id).copied().filter(|_| !circle);
            }
            if circle {
                let message = format!("{} closes a circle", element.describe());
                self.warn("urdf/mimic", element, message, "the joint is free");
                continue;
            }
            let part = |name: &str, default: f64| match element.attribute(name) {
                Some(text) => number(element, name, text, false),
                None => Ok(default),
            };
            let (slope, offset) = match (part("multiplier", 1.0), part("offset", 0.0)) {
                (Ok(slope), Ok(offset)) => (slope, offset),
                (Err(error), _) | (_, Err(error)) => {
                    self.warnings.extend(
                        error
                            .into_diagnostics()
                            .into_iter()
                            .map(|mut d| {
                                d.severity = Severity::Warning;
                                d
                            })
                            .collect(),
                    );
                    continue;
                }
            };
            let set = self.builder.coordinates()[follower.index()].joint_set;
            let value: Signal =
                self.builder.map(set, "mimic", leader, Function::linear(slope, offset));
            self.builder.follow(follower, value);
            leaders.insert(follower, leader);
        }
    }

    /// Finds circles of links, and says of several roots.
    fn roots(&mut self) -> Result<(), Error> {
        // The way to the root is as long as there are links, at most.
        let mut depth: Vec<Option<usize>> = vec![None; self.names.len()];
        let mut total = 0usize;
        for start in 0..self.names.len() {
            let mut path = vec![];
            let mut here = Some(start);
            while let Some(link) = here.filter(|&link| depth[link].is_none()) {
                if path.len() > self.names.len() {
                    let name = self.names[link].0;
                    return Err(self
                        .robot
                        .error(
                            "urdf/circle",
                            format!("the links on the way to `{name}` are in a circle"),
                        )
                        .with_help("one link must have no parent"));
                }
                path.push(link);
                here = self.names[link].1.map(|(_, parent)| parent.index());
            }
            let mut above = here.and_then(|link| depth[link]).unwrap_or(0);
            for link in path.into_iter().rev() {
                above += 1;
                depth[link] = Some(above);
                total += above;
            }
        }
        if 6 * total > MOST_DIRECTIONS {
            let message = "the robot has more pairs of a link and a joint than are allowed";
            return Err(self.robot.error("urdf/size", message).with_help("use fewer links"));
        }
        let roots: Vec<&str> =
            self.names.iter().filter(|(_, moved)| moved.is_none()).map(|(name, _)| *name).collect();
        if roots.len() > 1 {
            let message = format!(
                "{} links have no parent: {}",
                roots.len(),
                condyle_diagnostics::listed(&roots)
            );
            self.warn("urdf/roots", self.robot, message, "each stands in the world");
        }
        if roots.is_empty() {
            let error = self.robot.error("urdf/no-link", "the robot has no link");
            return Err(error.with_help("give <link> elements"));
        }
        Ok(())
    }

    fn said(&mut self) {
        let meshes = self.robot.descendants().filter(|e| e.is("mesh")).count();
        if meshes > 0 {
            let noun = if meshes == 1 { "mesh is" } else { "meshes are" };
            let message = format!("{meshes} {noun} not read");
            self.warnings.push(Diagnostic::note("urdf/meshes", message));
        }
    }
}

/// The frame of a joint in its parent.
fn origin(joint: Element<'_>) -> Result<Affine, Error> {
    let Some(element) = joint.child("origin") else { return Ok(Affine::IDENTITY) };
    let place = match element.attribute("xyz") {
        Some(_) => triple(element, "xyz")?,
        None => Vec3::ZERO,
    };
    let Vec3 { x: roll, y: pitch, z: yaw } = match element.attribute("rpy") {
        Some(_) => triple(element, "rpy")?,
        None => Vec3::ZERO,
    };
    Ok(Affine::new(zyx().to_mat3([yaw, pitch, roll]), place))
}

/// Rz·Ry·Rx: yaw, pitch, roll.
pub(super) fn zyx() -> EulerOrder {
    EulerOrder::ALL.into_iter().find(|order| order.axes() == [2, 1, 0]).unwrap_or(EulerOrder::XYZ)
}

/// Two directions across another, right-handed with it: x and y for z.
fn across(axis: Vec3) -> (Vec3, Vec3) {
    let start = if axis.x.abs() < 0.9 { Vec3::X } else { -Vec3::Z };
    let first = (start - axis * start.dot(axis)).normalized();
    (first, axis.cross(first))
}

fn triple(element: Element<'_>, name: &str) -> Result<Vec3, Error> {
    let text = element.attribute(name).unwrap_or_default();
    let separates = |c: char| c.is_whitespace() || c == ',';
    let parts: Vec<&str> = text.split(separates).filter(|part| !part.is_empty()).take(4).collect();
    let [x, y, z] = parts[..] else {
        return Err(element
            .error("urdf/numbers", format!("`{name}` of {} is `{text}`", element.describe()))
            .with_help("give three numbers"));
    };
    Ok(Vec3::new(
        number(element, name, x, false)?,
        number(element, name, y, false)?,
        number(element, name, z, false)?,
    ))
}

fn number(element: Element<'_>, name: &str, text: &str, infinite: bool) -> Result<f64, Error> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() || (infinite && !value.is_nan()) => Ok(value),
        _ => Err(element
            .error("urdf/numbers", format!("`{name}` of {} is `{text}`", element.describe()))
            .with_help("give a finite number")),
    }
}
