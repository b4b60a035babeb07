//! Reading: a builder is fed part by part.

mod form;
mod law;
mod value;

use super::{HEAD, VERSION};
use crate::text::utf8;
use crate::{Error, Place, Read};
use condyle_math::Vec3;
use condyle_model::component::Registry;
use condyle_model::model::{ComponentId, Condition, Facing};
use condyle_model::{
    Closure, CoordinateId, CoordinateKind, JointSetId, Model, ModelBuilder, PostureTerm, Range,
    SegmentId, Signal, UpAxis,
};
use serde_json::Value;
use std::collections::HashMap;
use value::At;

/// The largest size of a parsed object without its values, in bytes: a node of a map.
const OBJECT: usize = 700;

/// The size of a parsed value, in bytes.
const VALUE: usize = 40;

/// Reads a resolved model. Keys that are not known are passed over; so is `order`, which follows from
/// the rest.
///
/// # Errors
/// `exchange/syntax` if it is no JSON, `exchange/version` for another version, `exchange/value` with the
/// place of what is wrong, and what [`ModelBuilder::build`] finds.
///
/// ```
/// use condyle_formats::exchange;
/// let wrong = br#"{"condyle_model": 1, "name": "arm", "segments": [{"nam": "ulna"}]}"#;
/// let error = exchange::read(wrong).unwrap_err();
/// assert_eq!(error.to_string(), "segments[0]: `name` is missing (give it)");
/// ```
pub fn read(bytes: &[u8]) -> Result<Read<Model>, Error> {
    read_with(bytes, &Registry::default())
}

/// Reads a resolved model whose components of kind `custom` name these laws.
///
/// # Errors
/// As [`read`], and laws that are not registered, or not with these parameters.
pub fn read_with(bytes: &[u8], laws: &Registry) -> Result<Read<Model>, Error> {
    let text = utf8(bytes)?;
    let many = |byte: u8| text.bytes().filter(|b| *b == byte).count();
    let needed = many(b'{') * OBJECT + (many(b',') + many(b'[')) * VALUE;
    if needed > 8 * bytes.len() + (48 << 20) {
        let message = "the file holds too many objects for its size";
        return Err(Error::new("exchange/size", message).with_help("it is no model"));
    }
    let value: Value = serde_json::from_str(text).map_err(|error| {
        Error::new("exchange/syntax", error.to_string()).at(Place::at(error.line(), error.column()))
    })?;
    let top = At::top(&value);
    let version = top.key(HEAD)?;
    if version.number()? != VERSION as f64 {
        let message = "unknown version of resolved models";
        let help = format!("write `\"{HEAD}\": {VERSION}`, or use a newer version of condyle");
        return Err(Error::new("exchange/version", message).with_help(help));
    }
    let name = top.perhaps("name").map_or(Ok(""), |name| name.text())?;
    let mut reader = Reader::new(name, laws);
    reader.all(&top)?;
    reader.builder.build_with_warnings()
}

struct Reader<'l> {
    builder: ModelBuilder,
    laws: &'l Registry,
    segments: HashMap<String, SegmentId>,
    sets: HashMap<String, JointSetId>,
    coordinates: HashMap<String, CoordinateId>,
    components: HashMap<String, ComponentId>,
}

impl<'l> Reader<'l> {
    fn new(name: &str, laws: &'l Registry) -> Self {
        Self {
            builder: ModelBuilder::new(name),
            laws,
            segments: HashMap::new(),
            sets: HashMap::new(),
            coordinates: HashMap::new(),
            components: HashMap::new(),
        }
    }

    fn all(&mut self, top: &At<'_>) -> Result<(), Error> {
        let mut axis = UpAxis::Y;
        if let Some(up) = top.perhaps("up") {
            axis = up.word(&[("y", UpAxis::Y), ("z", UpAxis::Z)])?;
            self.builder.up(axis);
        }
        if let Some(facing) = top.perhaps("facing") {
            let own = Facing::ALL.map(|f| (f.name_in(axis), f));
            // Those of a world with y up are known, too.
            let other = Facing::ALL.map(|f| (f.name(), f));
            self.builder.facing(facing.word(&[own, other].concat())?);
        }
        let segments = top.all("segments")?;
        for at in &segments {
            let name = at.key("name")?;
            let id = self.builder.segment(name.text()?, None);
            let frames =
                [at.key("joint_in_parent")?.frame()?, at.key("joint_in_segment")?.frame()?];
            self.builder.place_joint_frames(id, frames[0], frames[1]);
            once(&mut self.segments, &name, id)?;
        }
        for set in top.all("joint_sets")? {
            let id = self.builder.joint_set(set.text()?);
            once(&mut self.sets, &set, id)?;
        }
        let coordinates = top.all("coordinates")?;
        for at in &coordinates {
            self.coordinate(at)?;
        }
        let components = top.all("components")?;
        for at in &components {
            let set = find(&self.sets, &at.key("joint_set")?)?;
            let law = law::law(at, self.laws)?;
            let made = self.builder.component(set, at.key("name")?.text()?, law, vec![]);
            if let Signal::Output(id, _) = made {
                once(&mut self.components, &at.key("path")?, id)?;
            }
        }
        // All are there: now they are connected.
        for at in &segments {
            let id = find(&self.segments, &at.key("name")?)?;
            if let Some(parent) = at.perhaps("parent") {
                let parent = find(&self.segments, &parent)?;
                self.builder.set_parent(id, Some(parent));
            }
            if let Some(motion) = at.perhaps("motion") {
                let set = find(&self.sets, &at.key("joint_set")?)?;
                let motion = self.signal(&motion)?;
                self.builder.output(set, id, motion);
            }
        }
        for at in &coordinates {
            if let Some(leader) = at.perhaps("follows") {
                let id = find(&self.coordinates, &at.key("path")?)?;
                let leader = self.signal(&leader)?;
                self.builder.follow(id, leader);
            }
        }
        for at in &components {
            self.connect(at)?;
        }
        for at in top.all("markers")? {
            let segment = self.holder(&at)?;
            let (name, point) = (at.key("name")?.text()?, at.key("point")?.vector()?);
            match at.perhaps("like") {
                Some(like) => self.builder.marker_like(name, like.text()?, segment, point),
                None => self.builder.marker(name, segment, point),
            }
        }
        for at in top.all("closures")? {
            let name = at.key("name")?.text()?.to_owned();
            let condition = self.condition(&at)?;
            self.builder.closure(Closure { name, condition });
        }
        for at in top.all("postures")? {
            self.posture(&at)?;
        }
        for at in top.all("sizes")? {
            let segments = at.key("segments")?.list()?;
            let segments: Result<Vec<_>, _> =
                segments.iter().map(|s| find(&self.segments, s)).collect();
            self.builder.size_group(at.key("name")?.text()?, segments?);
        }
        for at in top.all("shapes")? {
            let shape = form::shape(&at, &self.segments)?;
            self.builder.shape(shape);
        }
        Ok(())
    }

    fn coordinate(&mut self, at: &At<'_>) -> Result<(), Error> {
        use CoordinateKind::{Orientation, Other, Rotation, Scale, Translation};
        let set = find(&self.sets, &at.key("joint_set")?)?;
        let kinds = [Rotation, Translation, Scale, Other, Orientation].map(|k| (k.name(), k));
        let kind = at.key("kind")?.word(&kinds)?;
        let id = self.builder.coordinate(set, at.key("name")?.text()?, kind);
        once(&mut self.coordinates, &at.key("path")?, id)?;
        let made = self.builder.coordinate_mut(id);
        if let Some(default) = at.perhaps("default") {
            match kind {
                Orientation => made.default = default.some()?,
                _ => made.default[0] = default.number()?,
            }
        }
        if let Some(range) = at.perhaps("range") {
            let ends = range.two()?.map(|end| (!end.is_null()).then(|| end.number()).transpose());
            let [lower, upper] = ends;
            let (lower, upper) = (lower?, upper?);
            let held = lower.is_some() || upper.is_some();
            let enforced = at.perhaps("clamped").map_or(Ok(held), |clamped| clamped.flag())?;
            made.range = Range { lower, upper, enforced };
        }
        made.typical = at.perhaps("typical").map(|typical| typical.some()).transpose()?;
        made.locked = at.perhaps("locked").map_or(Ok(false), |locked| locked.flag())?;
        let text = |key: &str| at.perhaps(key).map(|t| t.text().map(str::to_owned)).transpose();
        made.drives = text("drives")?;
        made.source = text("source")?;
        Ok(())
    }

    fn signal(&self, at: &At<'_>) -> Result<Signal, Error> {
        if let Some(path) = at.perhaps("coordinate") {
            return Ok(find(&self.coordinates, &path)?.into());
        }
        if let Some(name) = at.perhaps("segment") {
            return Ok(find(&self.segments, &name)?.into());
        }
        let id = find(&self.components, &at.key("component")?)?;
        Ok(Signal::Output(id, at.perhaps("output").map_or(Ok(0), |output| output.count())?))
    }

    /// Connects the ports of a component.
    fn connect(&mut self, at: &At<'_>) -> Result<(), Error> {
        let id = find(&self.components, &at.key("path")?)?;
        let ports: Vec<_> = self.builder.component_mut(id).law.ports().collect();
        let inputs = at.key("inputs")?;
        if let Some(key) = inputs.keys().find(|key| ports.iter().all(|port| port.name != *key)) {
            return Err(inputs.unknown(key, ports.iter().map(|port| port.name)));
        }
        let mut signals = vec![];
        for port in ports {
            if port.is_list() {
                for one in inputs.all(port.name)? {
                    signals.push(self.signal(&one)?);
                }
            } else {
                signals.push(self.signal(&inputs.key(port.name)?)?);
            }
        }
        self.builder.component_mut(id).inputs = signals;
        Ok(())
    }

    /// A segment, or the world where none is given.
    fn holder(&self, at: &At<'_>) -> Result<Option<SegmentId>, Error> {
        at.perhaps("segment").map(|name| find(&self.segments, &name)).transpose()
    }

    fn condition(&self, at: &At<'_>) -> Result<Condition, Error> {
        let points = || -> Result<[(Option<SegmentId>, Vec3); 2], Error> {
            let [one, other] = at.key("at")?.two()?;
            let point = |end: &At<'_>| -> Result<_, Error> {
                Ok((self.holder(end)?, end.key("point")?.vector()?))
            };
            Ok([point(&one)?, point(&other)?])
        };
        Ok(match at.key("kind")?.text()? {
            "points" => Condition::Points { at: points()? },
            "distance" => {
                Condition::Distance { at: points()?, distance: at.key("distance")?.number()? }
            }
            "frames" => {
                let [one, other] = at.key("at")?.two()?;
                let frame = |end: &At<'_>| -> Result<_, Error> {
                    Ok((self.holder(end)?, end.key("frame")?.frame()?))
                };
                Condition::Frames { at: [frame(&one)?, frame(&other)?] }
            }
            "coupling" => Condition::Coupling {
                follower: find(&self.coordinates, &at.key("follower")?)?,
                driver: find(&self.coordinates, &at.key("driver")?)?,
                function: at.key("function")?.function()?,
            },
            other => {
                let known = ["points", "distance", "frames", "coupling"];
                return Err(at.unknown(other, known.into_iter()));
            }
        })
    }

    fn posture(&mut self, at: &At<'_>) -> Result<(), Error> {
        let mut sum = vec![];
        for term in at.key("sum")?.list()? {
            let id = find(&self.coordinates, &term.key("coordinate")?)?;
            sum.push((id, term.key("factor")?.number()?));
        }
        self.builder.posture(PostureTerm {
            name: at.key("name")?.text()?.to_owned(),
            sum,
            rest: at.key("rest")?.number()?,
            stiffness: at.key("stiffness")?.number()?,
            source: at.perhaps("source").map(|s| s.text().map(str::to_owned)).transpose()?,
        });
        Ok(())
    }
}

/// What a name stands for.
fn find<T: Copy>(known: &HashMap<String, T>, name: &At<'_>) -> Result<T, Error> {
    let text = name.text()?;
    known.get(text).copied().ok_or_else(|| name.unknown(text, known.keys().map(String::as_str)))
}

/// Adds a name that must be new.
fn once<T>(known: &mut HashMap<String, T>, name: &At<'_>, value: T) -> Result<(), Error> {
    match known.insert(name.text()?.to_owned(), value) {
        None => Ok(()),
        Some(_) => Err(name.error("it is there twice", "give each a name of its own")),
    }
}
