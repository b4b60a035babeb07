//! Frames by name and path, each resolved to a segment and a fixed transform in it.

use super::{Base, triple};
use crate::xml::Element;
use condyle_diagnostics::{Error, nearest};
use condyle_math::{Affine, EulerOrder, Mat3, Vec3};
use condyle_model::ModelBuilder;
use std::collections::HashMap;

/// How many bodies, and how many coordinates, a model may have: an order of magnitude beyond any
/// realistic model, and far below a number that would take minutes to pose.
const MOST_BODIES: usize = 10_000;
/// How many joints, frames, markers and constraints together.
const MOST_PARTS: usize = 100_000;
/// How many frames may be fixed in each other in a chain.
const LONGEST_CHAIN: usize = 256;

/// Counts the parts in a file, so that a damaged or malicious one is rejected early.
#[derive(Default)]
struct Parts {
    bodies: usize,
    coordinates: usize,
    others: usize,
}

impl Parts {
    fn count(&mut self, element: Element<'_>) -> Result<(), Error> {
        let name = element.name();
        let (count, most) = match name {
            "Body" => (&mut self.bodies, MOST_BODIES),
            "Coordinate" => (&mut self.coordinates, MOST_BODIES),
            "PhysicalOffsetFrame"
            | "OffsetFrame"
            | "Station"
            | "StationDefinedFrame"
            | "Marker" => (&mut self.others, MOST_PARTS),
            _ if name.ends_with("Joint") || name.ends_with("Constraint") => {
                (&mut self.others, MOST_PARTS)
            }
            _ => return Ok(()),
        };
        *count += 1;
        if *count > most {
            return Err(element
                .error("osim/size", format!("{} exceeds the number allowed", element.describe()))
                .with_help(format!("a model may have {most} of its kind; is the file damaged?")));
        }
        Ok(())
    }
}

/// The names under which a station or a marker states its frame.
pub(in crate::opensim) const POINT_FRAME: &[&str] = &["parent_frame", "reference_frame", "body"];

/// Every frame and station of a model file.
pub(in crate::opensim) struct Frames<'d> {
    items: Vec<Item<'d>>,
    by_path: HashMap<String, usize>,
    by_name: HashMap<&'d str, Vec<usize>>,
    by_element: HashMap<u32, usize>,
}

struct Item<'d> {
    element: Element<'d>,
    path: String,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Base(Base),
    /// A frame fixed in another.
    Offset,
    /// A point of a frame.
    Station,
    /// A frame defined by four stations.
    StationDefined,
}

/// What a reference should lead to, where names alone leave a choice.
#[derive(Clone, Copy, PartialEq)]
enum Wanted {
    Frame,
    Point,
}

/// Whether an element stands among the defaults of a file, which are no parts of the model.
pub(in crate::opensim) fn is_default(element: Element<'_>) -> bool {
    std::iter::successors(element.parent(), |e| e.parent()).any(|e| e.is("defaults"))
}

/// The path of a component: the names on the way from the model, sets without a name by default.
pub(in crate::opensim) fn path(element: Element<'_>) -> String {
    let mut names: Vec<String> = vec![];
    let mut here = Some(element);
    while let Some(e) = here
        && !matches!(e.name(), "Model" | "OpenSimDocument")
    {
        match e.attribute("name").filter(|name| !name.is_empty()) {
            Some(name) => names.push(name.to_owned()),
            None if e.name().ends_with("Set") => names.push(e.name().to_lowercase()),
            None if !matches!(e.name(), "objects" | "frames" | "components") => {
                names.push(e.name().to_lowercase());
            }
            None => {}
        }
        here = e.parent();
    }
    names.reverse();
    format!("/{}", names.join("/"))
}

/// An absolute path: `reference` as seen from the component at `context`.
fn absolute(context: &str, reference: &str) -> String {
    let mut parts: Vec<&str> =
        if reference.starts_with('/') { vec![] } else { context.split('/').collect() };
    for part in reference.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop();
            }
            name => parts.push(name),
        }
    }
    format!("/{}", parts.into_iter().filter(|p| !p.is_empty()).collect::<Vec<_>>().join("/"))
}

impl<'d> Frames<'d> {
    /// Collects all frames and makes a segment of each body.
    pub(in crate::opensim) fn collect(
        model: Element<'d>,
        builder: &mut ModelBuilder,
    ) -> Result<Self, Error> {
        let mut frames = Self {
            items: vec![],
            by_path: HashMap::new(),
            by_name: HashMap::new(),
            by_element: HashMap::new(),
        };
        let mut has_ground = false;
        let mut parts = Parts::default();
        for element in model.descendants() {
            parts.count(element)?;
            if is_default(element) {
                continue;
            }
            let name = element.attribute("name").unwrap_or_default();
            let kind = match element.name() {
                "Ground" => Kind::Base(None),
                "Body" if name == "ground" => Kind::Base(None),
                "Body" => {
                    let known = frames.by_name.get(name).into_iter().flatten();
                    if known.clone().any(|&i| matches!(frames.items[i].kind, Kind::Base(Some(_)))) {
                        return Err(element
                            .error("osim/duplicate-body", format!("two bodies are named `{name}`"))
                            .with_help("give each body a name of its own"));
                    }
                    Kind::Base(Some(builder.segment(name, None)))
                }
                "PhysicalOffsetFrame" | "OffsetFrame" => Kind::Offset,
                // A marker is a station too.
                "Station" | "Marker" => Kind::Station,
                "StationDefinedFrame" => Kind::StationDefined,
                _ => continue,
            };
            has_ground |= kind == Kind::Base(None);
            frames.add(element, name, path(element), kind);
        }
        if !has_ground {
            frames.add(model, "ground", "/ground".to_owned(), Kind::Base(None));
        }
        Ok(frames)
    }

    fn add(&mut self, element: Element<'d>, name: &'d str, path: String, kind: Kind) {
        let index = self.items.len();
        self.by_path.entry(path.clone()).or_insert(index);
        if kind == Kind::Base(None) {
            self.by_path.entry("/ground".to_owned()).or_insert(index);
        }
        let name = if kind == Kind::Base(None) { "ground" } else { name };
        self.by_name.entry(name).or_default().push(index);
        self.by_element.insert(element.number(), index);
        self.items.push(Item { element, path, kind });
    }

    /// All bodies: their element, name and segment.
    pub(in crate::opensim) fn bodies(&self) -> impl Iterator<Item = (Element<'d>, Base)> + '_ {
        self.items.iter().filter_map(|item| match item.kind {
            Kind::Base(Some(id)) => Some((item.element, Some(id))),
            _ => None,
        })
    }

    /// The text of a socket in any of its historical spellings.
    pub(in crate::opensim) fn socket(owner: Element<'d>, name: &str) -> Option<Element<'d>> {
        [format!("socket_{name}"), format!("socket_{name}_connectee_name")]
            .iter()
            .find_map(|tag| owner.child(tag))
            .or_else(|| owner.child("connectors").and_then(|c| find_connector(c, name)))
            .filter(|e| !e.text().is_empty())
    }

    /// What a part of the model is fixed in, under the first of these names that it has: a socket
    /// since version 3.05, a connector or the name of a body before.
    pub(in crate::opensim) fn reference(
        owner: Element<'d>,
        names: &[&str],
    ) -> Result<Element<'d>, Error> {
        let plain = |name: &&str| owner.child(name).filter(|e| !e.text().is_empty());
        let socket = |name: &&str| Self::socket(owner, name);
        names.iter().find_map(socket).or_else(|| names.iter().find_map(plain)).ok_or_else(|| {
            let message =
                format!("{} does not name the frame that it is attached to", owner.describe());
            let socket = names.first().copied().unwrap_or_default();
            owner
                .error("osim/no-frame", message)
                .with_help(format!("add <socket_{socket}> with the path of a frame"))
        })
    }

    /// The frame that a part of the model is fixed in.
    pub(in crate::opensim) fn of_part(
        &self,
        owner: Element<'d>,
        names: &[&str],
    ) -> Result<(Base, Affine), Error> {
        self.resolve(owner, Self::reference(owner, names)?)
    }

    /// The place of a station or a marker.
    pub(in crate::opensim) fn point(&self, station: Element<'d>) -> Result<(Base, Vec3), Error> {
        let (base, frame) = self.of_part(station, POINT_FRAME)?;
        Ok((base, frame * triple(station, "location")?))
    }

    /// The frame that the text of `reference` names, resolved relative to the component `owner`.
    pub(in crate::opensim) fn resolve(
        &self,
        owner: Element<'d>,
        reference: Element<'d>,
    ) -> Result<(Base, Affine), Error> {
        self.placed(self.look_up(owner, reference, Wanted::Frame)?, reference)
    }

    /// The frame that an element states itself: a body, the ground or an offset; none of another.
    pub(in crate::opensim) fn at(
        &self,
        element: Element<'d>,
    ) -> Result<Option<(Base, Affine)>, Error> {
        let index = self.by_element.get(&element.number());
        index.map(|&index| self.placed(index, element)).transpose()
    }

    /// Where a frame is, from its body.
    fn placed(&self, index: usize, reference: Element<'d>) -> Result<(Base, Affine), Error> {
        let mut index = index;
        let mut transform = Affine::IDENTITY;
        for _ in 0..=self.items.len().min(LONGEST_CHAIN) {
            let item = &self.items[index];
            let element = item.element;
            let local = match item.kind {
                Kind::Base(base) => return Ok((base, transform)),
                Kind::Offset => {
                    let angles = triple(element, "orientation")?.to_array();
                    let turn = EulerOrder::XYZ.to_mat3(angles);
                    Affine::new(turn, triple(element, "translation")?)
                }
                Kind::Station => Affine::from_translation(triple(element, "location")?),
                Kind::StationDefined => {
                    let (base, frame) = self.station_defined(element)?;
                    return Ok((base, frame * transform));
                }
            };
            transform = local * transform;
            let names = if item.kind == Kind::Station { POINT_FRAME } else { &["parent"] };
            index = self.look_up(element, Self::reference(element, names)?, Wanted::Frame)?;
        }
        Err(reference
            .error(
                "osim/frame-cycle",
                format!("frame `{}` is not attached to a body", reference.text()),
            )
            .with_help("is it its own ancestor? attach one of its ancestors to a body"))
    }

    fn look_up(
        &self,
        owner: Element<'d>,
        reference: Element<'d>,
        wanted: Wanted,
    ) -> Result<usize, Error> {
        let text = reference.text();
        if let Some(&index) = self.by_path.get(&absolute(&path(owner), text)) {
            return Ok(index);
        }
        // Files of the 4.0 betas give bare names or paths through a differently named set.
        let name = text.rsplit('/').next().unwrap_or(text);
        let named = self.by_name.get(name).map(Vec::as_slice).unwrap_or_default();
        let likely = |&i: &usize| match (self.items[i].kind, wanted) {
            (Kind::Station, Wanted::Point) | (Kind::Base(_), Wanted::Frame) => 0,
            (Kind::Base(_) | Kind::Offset | Kind::StationDefined, _) => 1,
            (Kind::Station, Wanted::Frame) => 2,
        };
        if let Some(&index) = named.iter().min_by_key(|i| likely(i)) {
            return Ok(index);
        }
        let known = self.items.iter().map(|item| item.path.as_str());
        let names = self.by_name.keys().copied();
        let help = match nearest(text, known.chain(names)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "name a body or a frame of this model".to_owned(),
        };
        Err(reference
            .error("osim/unknown-frame", format!("{} names no frame: `{text}`", owner.describe()))
            .with_help(help))
    }

    /// A frame defined by stations: its first named axis runs from a to b, the second is normal to
    /// the plane of a, b and c.
    fn station_defined(&self, element: Element<'d>) -> Result<(Base, Affine), Error> {
        let station = |socket: &str| -> Result<(Base, Vec3), Error> {
            let reference = Self::reference(element, &[socket])?;
            let item = &self.items[self.look_up(element, reference, Wanted::Point)?];
            if item.kind != Kind::Station {
                return Err(reference
                    .error(
                        "osim/unknown-frame",
                        format!("`{}` is neither a station nor a marker", reference.text()),
                    )
                    .with_help("name a <Station> or a <Marker>"));
            }
            let parent = Self::reference(item.element, POINT_FRAME)?;
            let (base, frame) = self.resolve_offset(item.element, parent)?;
            Ok((base, frame * triple(item.element, "location")?))
        };
        let (base, a) = station("point_a")?;
        let [(b_base, b), (c_base, c), (o_base, origin)] =
            [station("point_b")?, station("point_c")?, station("origin_point")?];
        if [b_base, c_base, o_base] != [base; 3] {
            return Err(element.error(
                "osim/station-frame",
                format!("the stations of {} lie in different bodies", element.describe()),
            ));
        }
        let along = (b - a).normalized();
        let normal = (b - a).cross(c - a).normalized();
        let axis = |tag: &str, default: &str| -> Result<(usize, f64), Error> {
            let text = element.child_text(tag).unwrap_or(default);
            let sign = if text.starts_with('-') { -1.0 } else { 1.0 };
            match text.trim_start_matches(['+', '-']) {
                "x" => Ok((0, sign)),
                "y" => Ok((1, sign)),
                "z" => Ok((2, sign)),
                _ => Err(element.error("osim/station-frame", format!("`{text}` names no axis"))),
            }
        };
        let (first, first_sign) = axis("ab_axis", "+x")?;
        let (second, second_sign) = axis("ab_x_ac_axis", "+y")?;
        if first == second || !(along.is_finite() && normal.is_finite()) {
            return Err(element
                .error(
                    "osim/station-frame",
                    format!("{} does not determine its axes", element.describe()),
                )
                .with_help(
                    "give three stations that do not lie on one line, and two different axes",
                ));
        }
        let mut columns = [Vec3::ZERO; 3];
        columns[first] = along * first_sign;
        columns[second] = normal * second_sign;
        let third = 3 - first - second;
        columns[third] = columns[(third + 1) % 3].cross(columns[(third + 2) % 3]);
        let turn = Mat3::from_columns(columns[0], columns[1], columns[2]);
        Ok((base, Affine::new(turn, origin)))
    }

    /// As [`Frames::resolve`] for the frame of a station, which must not lead through another
    /// frame defined by stations, so that the search is finite.
    fn resolve_offset(
        &self,
        owner: Element<'d>,
        reference: Element<'d>,
    ) -> Result<(Base, Affine), Error> {
        let mut index = self.look_up(owner, reference, Wanted::Frame)?;
        let mut steps = 0;
        while self.items[index].kind == Kind::Offset && steps <= self.items.len() {
            let element = self.items[index].element;
            let Some(parent) = Self::socket(element, "parent") else { break };
            index = self.look_up(element, parent, Wanted::Frame)?;
            steps += 1;
        }
        if self.items[index].kind == Kind::StationDefined {
            return Err(reference.error(
                "osim/station-frame",
                format!(
                    "a station of `{}` is fixed in another station-defined frame",
                    owner.describe()
                ),
            ));
        }
        self.resolve(owner, reference)
    }
}

fn find_connector<'d>(connectors: Element<'d>, name: &str) -> Option<Element<'d>> {
    connectors
        .children()
        .find(|c| c.attribute("name") == Some(name))
        .and_then(|c| c.child("connectee_name"))
}
