//! Resolves names, and builds the checked model.

use super::Origin;
use super::draft::{ConditionDraft, Draft, Holder, MarkerDraft, PlaceDraft, ShapeDraft};
use super::mirror::escaped;
use crate::document::texts::{Name, Spot, Texts};
use condyle_diagnostics::{Diagnostic, Read, Severity, Subject, did_you_mean, nearest};
use condyle_math::Vec3;
use condyle_model::component::{PortType, Product};
use condyle_model::model::{AXIS_LENGTH, ComponentId, Condition, JointSetId};
use condyle_model::{
    Closure, CoordinateId, CoordinateKind, Law, Model, ModelBuilder, PostureTerm, SegmentId, Shape,
    Signal,
};
use std::collections::{HashMap, HashSet};

/// How many factors of products, and how many derivatives, a compiled model may have.
const MOST_FACTORS: u64 = 1 << 20;
const MOST_DERIVATIVES: u64 = 1 << 24;

/// What a name in a joint set stands for.
#[derive(Clone, Copy)]
struct Meaning {
    source: Signal,
    port: PortType,
    outputs: usize,
}

/// Builds the model, with the place of each of its parts; `None` after an error.
pub(super) fn build(draft: Draft, texts: &mut Texts) -> Option<(Model, HashMap<Subject, Origin>)> {
    let mut resolver = Resolver {
        texts,
        builder: ModelBuilder::new(draft.name.as_deref().unwrap_or("model")),
        segments: HashMap::new(),
        sets: HashMap::new(),
        names: HashMap::new(),
        broken: HashSet::new(),
        places: HashMap::new(),
    };
    resolver.all(draft);
    let Resolver { texts, builder, places, .. } = resolver;
    if texts.failed() {
        return None;
    }
    match builder.build_with_warnings() {
        Ok(Read { value: model, warnings }) => {
            for warning in warnings.into_iter().filter(|w| w.code != AXIS_LENGTH).take(100) {
                let (spot, said) = located(texts, &places, warning);
                texts.warn(spot, said);
            }
            let whole = Spot::default();
            if factors(&model) > MOST_FACTORS {
                let message = "products of products have too many factors";
                let help = format!("a model may have at most {MOST_FACTORS}");
                texts.error(whole, "model/size", message, help);
                return None;
            }
            let parts =
                model.segments().len() + model.components().len() + model.coordinates().len();
            if (parts as u64).saturating_mul(model.tangent_len() as u64) > MOST_DERIVATIVES {
                let message = format!(
                    "the model is too large: {parts} parts with {} coordinates",
                    model.coordinates().len()
                );
                let help = "split it into several models";
                texts.error(whole, "model/size", message, help);
                return None;
            }
            let origin = |(subject, spot)| {
                let (place, included) = texts.origin(spot);
                (subject, Origin { place, included })
            };
            let places = places.into_iter().map(origin).collect();
            Some((model, places))
        }
        Err(findings) => {
            let errors = findings.into_diagnostics();
            for error in errors.into_iter().filter(|e| e.severity == Severity::Error).take(100) {
                let (spot, said) = located(texts, &places, error);
                texts.push(spot, said);
            }
            None
        }
    }
}

/// A diagnostic of the builder, placed at the table of its first subject.
fn located(
    texts: &Texts,
    places: &HashMap<Subject, Spot>,
    found: Diagnostic,
) -> (Spot, Diagnostic) {
    let spot = found.subjects.first().and_then(|subject| places.get(subject)).copied();
    let spot = spot.unwrap_or_default();
    let said = texts.said(spot, found.severity, found.code, found.message);
    (spot, said.about_all(found.subjects).with_help(found.help))
}

/// The number of factors of all products, expanded.
fn factors(model: &Model) -> u64 {
    let count = model.components().len();
    let index = |source: Signal| match source {
        Signal::Output(id, _) => Some(id.index()),
        Signal::Coordinate(_) | Signal::Segment(_) => None,
    };
    let parts: Vec<Vec<usize>> = model
        .components()
        .iter()
        .map(|c| match c.law {
            Law::Product(_) => c.values().filter_map(index).collect(),
            _ => vec![],
        })
        .collect();
    let mut size: Vec<Option<u64>> = vec![None; count];
    for start in 0..count {
        let mut stack = vec![start];
        while let Some(&top) = stack.last() {
            if size[top].is_some() {
                stack.pop();
                continue;
            }
            let open: Vec<usize> =
                parts[top].iter().copied().filter(|p| size[*p].is_none()).collect();
            if open.is_empty() {
                let sum = parts[top].iter().filter_map(|p| size[*p]);
                size[top] = Some(sum.fold(1u64, u64::saturating_add));
                stack.pop();
            } else {
                stack.extend(open);
            }
        }
    }
    let whole = |motion| index(motion).and_then(|i: usize| size[i]).unwrap_or(0);
    let moved = model.segments().iter().filter_map(|s| s.motion).map(whole);
    moved.chain(size.iter().map(|s| s.unwrap_or(0))).fold(0u64, u64::saturating_add)
}

struct Resolver<'s> {
    texts: &'s mut Texts,
    builder: ModelBuilder,
    segments: HashMap<String, SegmentId>,
    sets: HashMap<String, JointSetId>,
    names: HashMap<(String, String), Meaning>,
    /// As in [`Draft`].
    broken: HashSet<(String, String)>,
    /// The place of each subject's table.
    places: HashMap<Subject, Spot>,
}

impl Resolver<'_> {
    fn all(&mut self, draft: Draft) {
        self.builder.up(draft.up);
        self.builder.facing(draft.facing);
        self.broken = draft.broken;
        for s in &draft.segments {
            let id = self.builder.segment(&s.name.text, None);
            self.builder.place_joint_frames(id, s.in_parent, s.in_itself);
            self.places.insert(Subject::Segment(s.name.text.clone()), s.name.spot);
            if self.segments.insert(s.name.text.clone(), id).is_some() {
                self.twice("segment", &s.name);
            }
        }
        for s in &draft.segments {
            if let Some(parent) = &s.parent {
                let id = self.segments[&s.name.text];
                let parent = self.segment(parent);
                self.builder.set_parent(id, parent);
            }
        }
        for set in &draft.sets {
            let id = self.builder.joint_set(&set.text);
            self.places.insert(Subject::JointSet(set.text.clone()), set.spot);
            if self.sets.insert(set.text.clone(), id).is_some() {
                self.twice("joint set", set);
            }
        }
        let mut coordinates = vec![];
        for c in &draft.coordinates {
            let Some(&set) = self.sets.get(&c.set) else { continue };
            let id = self.builder.coordinate(set, &c.name.text, c.kind);
            let made = self.builder.coordinate_mut(id);
            (made.default, made.range, made.locked) = (c.default, c.range, c.locked);
            made.typical = c.typical;
            made.drives.clone_from(&c.drives);
            made.source.clone_from(&c.source);
            let key = format!("{}/{}", c.set, c.name.text);
            for key in [c.name.text.clone(), key] {
                self.places.insert(Subject::Coordinate(key), c.table);
            }
            let port = match c.kind {
                CoordinateKind::Orientation => PortType::Orientation,
                _ => PortType::Scalar,
            };
            let meaning = Meaning { source: id.into(), port, outputs: 1 };
            self.mean(&c.set, &c.name, meaning);
            if let Some([rest, stiffness]) = c.held {
                let name = format!("{}.{}", escaped(&c.set), escaped(&c.name.text));
                self.places.insert(Subject::Posture(name.clone()), c.name.spot);
                let (sum, source) = (vec![(id, 1.0)], c.source.clone());
                self.builder.posture(PostureTerm { name, sum, rest, stiffness, source });
            }
            coordinates.push((id, c.set.clone(), c.follows.clone()));
        }
        // All are added before any is connected: a component may reference one below it.
        let mut components: Vec<(ComponentId, String, Name, Vec<Name>)> = vec![];
        for c in draft.components {
            let Some(&set) = self.sets.get(&c.set) else { continue };
            let (port, outputs) = c.law.outputs();
            let source = self.builder.component(set, &c.name.text, c.law, vec![]);
            let Signal::Output(id, _) = source else { continue };
            self.mean(&c.set, &c.name, Meaning { source, port, outputs });
            self.places.insert(Subject::component(&c.set, &c.name.text), c.name.spot);
            components.push((id, c.set, c.name, c.ports));
        }
        for (id, set, follows) in coordinates {
            if let Some(port) = follows
                && let Some(source) = self.port(&set, &port, PortType::Scalar)
            {
                self.builder.follow(id, source);
            }
        }
        for (id, set, name, ports) in components {
            self.connect(id, &set, &name, &ports);
        }
        self.outputs(&draft.outputs);
        for m in &draft.markers {
            self.places.insert(Subject::Marker(m.name.text.clone()), m.name.spot);
            let (segment, point) = self.place(&m.place, &draft.markers).unwrap_or_default();
            match &m.place {
                PlaceDraft::Marker(like, Vec3::ZERO) => {
                    self.builder.marker_like(&m.name.text, &like.text, segment, point);
                }
                _ => self.builder.marker(&m.name.text, segment, point),
            }
        }
        for s in draft.shapes {
            self.places.insert(Subject::Shape(s.name.text.clone()), s.name.spot);
            let Some(segment) = self.segment(&s.segment) else { continue };
            let until = s.until.and_then(|place| {
                let (segment, point) = self.place(&place, &draft.markers)?;
                Some((segment?, point))
            });
            let ShapeDraft { form, finish, .. } = s;
            self.builder.shape(Shape { name: s.name.text, segment, form, finish, until });
        }
        for c in &draft.closures {
            self.places.insert(Subject::Closure(c.name.text.clone()), c.name.spot);
            if let Some(condition) = self.condition(&c.condition) {
                self.builder.closure(Closure { name: c.name.text.clone(), condition });
            }
        }
        self.postures(&draft.postures);
        self.sizes(&draft.sizes);
    }

    /// Connects the names at the ports of a component.
    fn connect(&mut self, id: ComponentId, set: &str, name: &Name, names: &[Name]) {
        let law = &self.builder.component_mut(id).law;
        if let Some(function) = law.several()
            && function.arity() != names.len()
        {
            let message = format!(
                "component `{}` has {} inputs but its function takes {}",
                name.text,
                names.len(),
                function.arity()
            );
            let help = "give as many inputs as the function has arguments";
            self.texts.error(name.spot, "model/arity", message, help);
            return;
        }
        let ports: Vec<_> = law.ports_of(names.len()).collect();
        let inputs: Vec<Option<Signal>> = ports
            .iter()
            .zip(names)
            .map(|(port, name)| match port.takes {
                PortType::Segment | PortType::Joint => self.segment(name).map(Signal::Segment),
                takes => self.port(set, name, takes),
            })
            .collect();
        if let Some(inputs) = inputs.into_iter().collect() {
            self.builder.component_mut(id).inputs = inputs;
        }
    }

    fn postures(&mut self, postures: &[super::draft::PostureDraft]) {
        for p in postures {
            self.places.insert(Subject::Posture(p.name.text.clone()), p.name.spot);
            // To the end, so that every unknown name is reported.
            let sum: Vec<_> =
                p.sum.iter().map(|(n, a)| Some((self.any_coordinate(n)?, *a))).collect();
            let Some(sum) = sum.into_iter().collect::<Option<Vec<_>>>() else { continue };
            let made = self.builder.coordinates();
            let angles =
                sum.iter().all(|(id, _)| made[id.index()].kind == CoordinateKind::Rotation);
            self.builder.posture(PostureTerm {
                name: p.name.text.clone(),
                sum,
                rest: p.rest * if angles { p.angle_unit } else { 1.0 },
                stiffness: p.stiffness,
                source: p.source.clone(),
            });
        }
    }

    /// A coordinate of any joint set: by its bare name where only one has it, else by `set.name`.
    fn any_coordinate(&mut self, name: &Name) -> Option<CoordinateId> {
        let parts = parts(&name.text);
        let [bare] = &parts[..] else { return self.coordinate(name) };
        let made = self.builder.coordinates();
        let hits: Vec<usize> = (0..made.len()).filter(|&i| made[i].name == *bare).collect();
        if let [index] = hits[..] {
            return self.builder.coordinate_at(index);
        }
        // The coordinates of a joint that could not be read are not known.
        if hits.is_empty() && self.broken.iter().any(|(_, part)| part.is_empty()) {
            return None;
        }
        let (message, help) = if hits.is_empty() {
            let known = made.iter().map(|c| c.name.as_str());
            let otherwise = || "name a coordinate, alone or as `set.name`".to_owned();
            (format!("unknown coordinate `{bare}`"), did_you_mean(bare, known, otherwise))
        } else {
            let mut sets: Vec<&String> =
                self.names.keys().filter(|(_, n)| n == bare).map(|(set, _)| set).collect();
            sets.sort();
            let list: Vec<String> = sets.iter().map(|set| format!("`{set}.{bare}`")).collect();
            let message = format!("{} joint sets have a coordinate `{bare}`", hits.len());
            (message, format!("write {}", list.join(" or ")))
        };
        self.texts.error(name.spot, "model/unknown-name", message, help);
        None
    }

    fn outputs(&mut self, outputs: &[super::draft::OutputDraft]) {
        let mut moved: HashMap<String, String> = HashMap::new();
        for o in outputs {
            let Some(&set) = self.sets.get(&o.set) else { continue };
            let segment = self.segment(&o.segment);
            if let Some(other) = moved.insert(o.segment.text.clone(), o.set.clone()) {
                let message = format!(
                    "segment `{}` is moved by `{other}` and by `{}`",
                    o.segment.text, o.set
                );
                let help = "only one joint set may move a segment";
                self.texts.error(o.segment.spot, "model/duplicate", message, help);
            }
            let factors: Vec<Option<Signal>> =
                o.ports.iter().map(|p| self.port(&o.set, p, PortType::Transform)).collect();
            let Some(factors) = factors.into_iter().collect::<Option<Vec<Signal>>>() else {
                continue;
            };
            let motion = match factors[..] {
                [one] => one,
                _ if !o.listed => continue,
                _ => {
                    let mut name = format!("motion_of_{}", o.segment.text);
                    while self.names.contains_key(&(o.set.clone(), name.clone())) {
                        name.push('_');
                    }
                    let product = Law::Product(Product);
                    let source = self.builder.component(set, &name, product, factors);
                    let meaning = Meaning { source, port: PortType::Transform, outputs: 1 };
                    self.mean(&o.set, &Name { text: name, spot: o.segment.spot }, meaning);
                    source
                }
            };
            if let Some(segment) = segment {
                self.builder.output(set, segment, motion);
            }
        }
    }

    /// Size groups; a segment may be in one of them.
    fn sizes(&mut self, sizes: &[super::draft::SizeDraft]) {
        let mut group_of: HashMap<&str, &str> = HashMap::new();
        for size in sizes {
            let mut segments = vec![];
            for name in &size.segments {
                let Some(id) = self.segment(name) else { continue };
                if let Some(other) = group_of.insert(&name.text, &size.name.text) {
                    let message = match other == size.name.text {
                        true => format!("segment `{}` is listed twice", name.text),
                        false => format!("segment `{}` is also in size group `{other}`", name.text),
                    };
                    let help = "list it once: a segment may be in one group";
                    self.texts.error(name.spot, "model/size-group", message, help);
                }
                segments.push(id);
            }
            self.builder.size_group(&size.name.text, segments);
        }
    }

    fn twice(&mut self, what: &str, name: &Name) {
        let message = format!("there are two {what}s named `{}`", name.text);
        let help = format!("give each {what} a different name");
        self.texts.error(name.spot, "model/duplicate", message, help);
    }

    fn mean(&mut self, set: &str, name: &Name, meaning: Meaning) {
        if self.names.insert((set.to_owned(), name.text.clone()), meaning).is_some() {
            let message = format!("there are two `{}` in joint set `{set}`", name.text);
            let help = "coordinates and components of a joint set need different names";
            self.texts.error(name.spot, "model/duplicate", message, help);
        }
    }

    fn segment(&mut self, name: &Name) -> Option<SegmentId> {
        if let Some(id) = self.segments.get(&name.text) {
            return Some(*id);
        }
        self.texts.error_with(name.spot, "model/unknown-name", || {
            let known = self.segments.keys().map(String::as_str);
            let otherwise = || "name a segment of this model; omit it for the world".to_owned();
            let help = did_you_mean(&name.text, known, otherwise);
            (format!("unknown segment `{}`", name.text), help)
        });
        None
    }

    /// A point with its segment; `None` after an error.
    fn place(
        &mut self,
        place: &PlaceDraft,
        markers: &[MarkerDraft],
    ) -> Option<(Option<SegmentId>, Vec3)> {
        let (like, offset) = match place {
            PlaceDraft::Point(holder, point) => return Some((self.holder(holder), *point)),
            PlaceDraft::Marker(like, offset) => (like, *offset),
        };
        match markers.iter().find(|m| m.name.text == like.text).map(|m| &m.place) {
            Some(PlaceDraft::Point(holder, point)) => Some((self.holder(holder), *point + offset)),
            Some(PlaceDraft::Marker(other, _)) => {
                let message = format!("`{}` is itself another name of a marker", like.text);
                let help =
                    format!("name a marker with a place of its own, such as `{}`", other.text);
                self.texts.error(like.spot, "model/unknown-name", message, help);
                None
            }
            None => {
                let names = markers.iter().map(|m| m.name.text.as_str());
                let otherwise = || "name a marker of this model".to_owned();
                let help = did_you_mean(&like.text, names, otherwise);
                let message = format!("unknown marker `{}`", like.text);
                self.texts.error(like.spot, "model/unknown-name", message, help);
                None
            }
        }
    }

    fn holder(&mut self, holder: &Holder) -> Option<SegmentId> {
        holder.as_ref().and_then(|name| self.segment(name))
    }

    fn condition(&mut self, condition: &ConditionDraft) -> Option<Condition> {
        let mut points = |at: &[(Holder, Vec3); 2]| -> [(Option<SegmentId>, Vec3); 2] {
            at.each_ref().map(|(holder, point)| (self.holder(holder), *point))
        };
        Some(match condition {
            ConditionDraft::Points(at) => Condition::Points { at: points(at) },
            ConditionDraft::Distance(at, distance) => {
                Condition::Distance { at: points(at), distance: *distance }
            }
            ConditionDraft::Frames(at) => Condition::Frames {
                at: at.each_ref().map(|(holder, frame)| (self.holder(holder), *frame)),
            },
            ConditionDraft::Coupling { follower, driver, function } => {
                let follower = self.coordinate(follower);
                let driver = self.coordinate(driver);
                let function = function.clone();
                Condition::Coupling { follower: follower?, driver: driver?, function }
            }
        })
    }

    fn coordinate(&mut self, name: &Name) -> Option<CoordinateId> {
        match self.port("", name, PortType::Scalar)? {
            Signal::Coordinate(id) => Some(id),
            Signal::Output(..) | Signal::Segment(_) => {
                let message = format!("`{}` is a component", name.text);
                self.texts.error(name.spot, "model/port-type", message, "name a coordinate");
                None
            }
        }
    }

    /// Resolves a port: `name` in its own set, or `set.name`, followed by `.N` for one of several
    /// outputs, counted from 1.
    fn port(&mut self, own: &str, port: &Name, wanted: PortType) -> Option<Signal> {
        let parts = parts(&port.text);
        let find =
            |set: &str, name: &str| self.names.get(&(set.to_owned(), name.to_owned())).copied();
        let number = |part: &str| part.parse::<usize>().ok();
        let found = match &parts[..] {
            [name] => find(own, name).map(|m| (m, 1)),
            [first, second] => find(first, second).map(|m| (m, 1)).or_else(|| {
                find(own, first).and_then(|m| number(second).map(|output| (m, output)))
            }),
            [set, name, output] => {
                find(set, name).and_then(|m| number(output).map(|output| (m, output)))
            }
            _ => None,
        };
        let Some((meaning, output)) = found else {
            if !self.is_broken(own, &parts) {
                self.unknown(own, port, &parts);
            }
            return None;
        };
        if output == 0 || output > meaning.outputs {
            let message = format!("`{}` names an output that does not exist", port.text);
            let help = format!("its outputs are numbered from 1 to {}", meaning.outputs);
            self.texts.error(port.spot, "model/unknown-name", message, help);
            return None;
        }
        if meaning.port != wanted {
            let word = |port: PortType| match port {
                PortType::Scalar => "a scalar",
                PortType::Orientation => "an orientation",
                PortType::Transform => "a transform",
                PortType::Segment | PortType::Joint => "a segment",
            };
            let message =
                format!("`{}` is {}, not {}", port.text, word(meaning.port), word(wanted));
            let help = match wanted {
                PortType::Scalar => {
                    "name a scalar coordinate, or a component such as map or combine"
                }
                PortType::Orientation => {
                    "name a coordinate of kind \"orientation\", or a cone of one"
                }
                PortType::Transform => "name a component such as rotate, translate or product",
                PortType::Segment | PortType::Joint => "name a segment",
            };
            self.texts.error(port.spot, "model/port-type", message, help);
            return None;
        }
        Some(match meaning.source {
            Signal::Output(id, _) => Signal::Output(id, output as u32 - 1),
            coordinate => coordinate,
        })
    }

    /// Whether a port names a component that could not be read, which is reported already.
    fn is_broken(&self, own: &str, parts: &[String]) -> bool {
        let has = |set: &str, name: &str| self.broken.contains(&(set.to_owned(), name.to_owned()));
        match parts {
            [name] => has(own, name),
            [first, second] => has(first, second) || has(own, first) || has(first, ""),
            [set, name, _] => has(set, name) || has(set, ""),
            _ => false,
        }
    }

    fn unknown(&mut self, own: &str, port: &Name, parts: &[String]) {
        let (set, name) = match parts {
            [set, name, ..] if self.sets.contains_key(set) => (set.as_str(), name.as_str()),
            [first, ..] => (own, first.as_str()),
            [] => (own, ""),
        };
        self.texts.error_with(port.spot, "model/unknown-name", || {
            let known = self.names.keys().filter(|(s, _)| s == set).map(|(_, n)| n.as_str());
            let elsewhere = || self.names.keys().filter(|(_, n)| n == name).map(|(s, _)| s).min();
            let help = match nearest(name, known) {
                Some(near) if set == own => format!("did you mean `{near}`?"),
                Some(near) => format!("did you mean `{set}.{near}`?"),
                None => match elsewhere() {
                    Some(other) => format!("did you mean `{other}.{name}`?"),
                    None => "name a coordinate or component of this joint set, or `set.name` of \
                             another"
                        .to_owned(),
                },
            };
            (format!("unknown name `{}`", port.text), help)
        });
    }
}

/// The names of a port, separated by dots; a backslash escapes the next character.
fn parts(text: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut letters = text.chars();
    while let Some(letter) = letters.next() {
        let here = parts.len() - 1;
        match letter {
            '.' => parts.push(String::new()),
            '\\' => parts[here].extend(letters.next()),
            _ => parts[here].push(letter),
        }
    }
    parts
}
