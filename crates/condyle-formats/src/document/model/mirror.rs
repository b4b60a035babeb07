//! The mirrored side of a body. D is the reflection: diag(1, 1, -1) for a plane z, and so on.
//!
//! Coordinates keep their values: for equal values on both sides, the transform of the mirrored side
//! is D·T·D of the written one. A point p becomes D·p, a frame D·T·D, the axis of a slide D·a, the axis
//! of a turn -D·a (it is a pseudovector). Only an orientation changes its value, since it *is* a
//! rotation: (v, w) on one side is (-D·v, w) on the other.
//!
//! What becomes of a law is its own matter ([`Law::mirror`]): most are mirrored by the same law with
//! other directions, some need other values at their ports or a transform after them, which are
//! components of their own here. The mirror image of a custom law is not known, so that such a component
//! cannot be mirrored.

use super::draft::{
    ClosureDraft, ComponentDraft, ConditionDraft, CoordinateDraft, Draft, Holder, MarkerDraft,
    OutputDraft, PlaceDraft, PostureDraft, SegmentDraft, ShapeDraft,
};
use crate::document::texts::{Name, Spot, Texts};
use condyle_diagnostics::{Severity, listed};
use condyle_math::Vec3;
use condyle_math::function::Function;
use condyle_model::component::{Map, Mirrored, Place, PortType, Product, Reflection};
use condyle_model::{CoordinateKind, Law};
use std::collections::HashSet;

pub(super) struct Mirror {
    pub(super) reflection: Reflection,
    /// How the names of the written side end, and those of the mirrored side.
    pub(super) from: String,
    pub(super) to: String,
    /// The place of the mirror in the text.
    pub(super) spot: Spot,
}

impl Mirror {
    /// Adds everything of the other side that is not written.
    pub(super) fn complete(&self, draft: &mut Draft, texts: &mut Texts) {
        self.question(draft, texts);
        let written = |names: &mut dyn Iterator<Item = &Name>| -> HashSet<String> {
            names.map(|n| n.text.clone()).collect()
        };
        let sets = written(&mut draft.sets.iter());
        let segments = written(&mut draft.segments.iter().map(|s| &s.name));
        let markers = written(&mut draft.markers.iter().map(|m| &m.name));
        let shapes = written(&mut draft.shapes.iter().map(|s| &s.name));
        let closures = written(&mut draft.closures.iter().map(|c| &c.name));
        let postures = written(&mut draft.postures.iter().map(|p| &p.name));
        let news = |known: &HashSet<String>, name: &str| {
            self.other(name).is_some_and(|other| !known.contains(&other))
        };

        let new_set = |set: &str| news(&sets, set);
        add(
            &mut draft.segments,
            |s| news(&segments, &s.name.text),
            |s| SegmentDraft {
                name: self.renamed(&s.name),
                parent: s.parent.as_ref().map(|p| self.renamed(p)),
                in_parent: self.reflection.frame(s.in_parent),
                in_itself: self.reflection.frame(s.in_itself),
            },
        );
        add(
            &mut draft.coordinates,
            |c| new_set(&c.set),
            |c| {
                let mut default = c.default;
                if c.kind == CoordinateKind::Orientation {
                    let [x, y, z, w] = c.default;
                    let v = self.reflection.turning(Vec3::new(x, y, z));
                    default = [v.x, v.y, v.z, w];
                }
                CoordinateDraft {
                    set: self.name(&c.set),
                    name: self.renamed(&c.name),
                    default,
                    follows: c.follows.as_ref().map(|p| self.port(p)),
                    ..c.clone()
                }
            },
        );
        let mut made = vec![];
        for component in draft.components.iter().filter(|c| new_set(&c.set)) {
            if self.component(component, texts, &mut made).is_none() {
                let name = self.name(&component.name.text);
                draft.broken.insert((self.name(&component.set), name));
            }
        }
        draft.components.extend(made);
        let broken = draft.broken.iter().filter(|(set, _)| new_set(set));
        let broken: Vec<_> = broken.map(|(set, name)| (self.name(set), self.name(name))).collect();
        draft.broken.extend(broken);
        add(
            &mut draft.outputs,
            |o| new_set(&o.set),
            |o| OutputDraft {
                set: self.name(&o.set),
                segment: self.renamed(&o.segment),
                ports: o.ports.iter().map(|p| self.port(p)).collect(),
                listed: o.listed,
            },
        );
        add(&mut draft.sets, |s| new_set(&s.text), |s| self.renamed(s));
        add(
            &mut draft.markers,
            |m| news(&markers, &m.name.text),
            |m| MarkerDraft { name: self.renamed(&m.name), place: self.place(&m.place) },
        );
        add(
            &mut draft.shapes,
            |s| news(&shapes, &s.name.text),
            |s| ShapeDraft {
                name: self.renamed(&s.name),
                segment: self.renamed(&s.segment),
                form: s.form.mirrored(&|p| self.reflection.point(p)),
                finish: s.finish,
                until: s.until.as_ref().map(|place| self.place(place)),
            },
        );
        add(
            &mut draft.closures,
            |c| news(&closures, &c.name.text),
            |c| ClosureDraft {
                name: self.renamed(&c.name),
                condition: self.condition(&c.condition),
            },
        );
        add(
            &mut draft.postures,
            |p| news(&postures, &p.name.text),
            |p| PostureDraft {
                name: self.renamed(&p.name),
                sum: p.sum.iter().map(|(name, factor)| (self.port(name), *factor)).collect(),
                ..p.clone()
            },
        );
    }

    /// Says where the mirror does nothing, or not what is likely meant.
    fn question(&self, draft: &Draft, texts: &mut Texts) {
        let named = draft.segments.iter().map(|s| &s.name).chain(&draft.sets);
        let named = named.chain(draft.markers.iter().map(|m| &m.name));
        let names: Vec<&Name> = named.collect();
        let mut warn = |spot, code, message: String, help: String| {
            let said = texts.said(spot, Severity::Warning, code, message).with_help(help);
            texts.warn(spot, said);
        };
        if !names.iter().any(|name| name.text.ends_with(&self.from)) {
            let lower = |text: &str| text.to_lowercase();
            let likely = names.iter().find(|name| lower(&name.text).ends_with(&lower(&self.from)));
            let back = names.iter().find(|name| name.text.ends_with(&self.to));
            let help = match (likely, back) {
                (Some(name), _) => {
                    let end = name.text.len() - self.from.len();
                    let end = name.text.get(end..).unwrap_or(&name.text);
                    format!("`{}` ends with `{end}`: did you mean from = \"{end}\"?", name.text)
                }
                (None, Some(name)) => {
                    format!("`{}` ends with `{}`: exchange `from` and `to`", name.text, self.to)
                }
                (None, None) => {
                    "give the ending of the names of the written side, or omit the mirror"
                        .to_owned()
                }
            };
            let message = format!("the mirror does nothing: no name ends with `{}`", self.from);
            warn(self.spot, "model/mirror", message, help);
        }
        // Both sides have a coordinate of that name, so that no motion can name one of them alone. The names
        // in a joint set that is written out are its own.
        for set in draft.sets.iter().filter(|set| draft.plain.contains(&set.text)) {
            let Some(other) = self.other(&set.text) else { continue };
            if draft.sets.iter().any(|s| s.text == other) {
                continue;
            }
            let own = draft.coordinates.iter().filter(|c| c.set == set.text);
            let alike: Vec<&Name> =
                own.map(|c| &c.name).filter(|name| self.other(&name.text).is_none()).collect();
            let Some(first) = alike.first() else { continue };
            let message = format!(
                "{} of `{}` {} the same name on both sides, as `{other}` is its mirror image",
                listed(alike.iter().map(|name| &name.text)),
                set.text,
                if alike.len() == 1 { "has" } else { "have" },
            );
            let help = format!(
                "end the name with the side, such as `{}{}`; motions can then name it alone",
                first.text, self.from
            );
            warn(first.spot, "model/mirror-names", message, help);
        }
    }

    fn other(&self, name: &str) -> Option<String> {
        name.strip_suffix(&self.from).map(|stem| format!("{stem}{}", self.to))
    }

    fn name(&self, name: &str) -> String {
        self.other(name).unwrap_or_else(|| name.to_owned())
    }

    fn renamed(&self, name: &Name) -> Name {
        Name { text: self.name(&name.text), spot: name.spot }
    }

    /// A name at a port: each of its parts.
    fn port(&self, port: &Name) -> Name {
        let parts: Vec<String> = port.text.split('.').map(|part| self.name(part)).collect();
        Name { text: parts.join("."), spot: port.spot }
    }

    fn place(&self, place: &PlaceDraft) -> PlaceDraft {
        match place {
            PlaceDraft::Point(holder, p) => {
                PlaceDraft::Point(self.holder(holder), self.reflection.point(*p))
            }
            PlaceDraft::Marker(like, p) => {
                PlaceDraft::Marker(self.renamed(like), self.reflection.point(*p))
            }
        }
    }

    fn holder(&self, holder: &Holder) -> Holder {
        holder.as_ref().map(|n| self.renamed(n))
    }

    fn condition(&self, condition: &ConditionDraft) -> ConditionDraft {
        let points = |at: &[(Holder, Vec3); 2]| {
            at.each_ref().map(|(holder, p)| (self.holder(holder), self.reflection.point(*p)))
        };
        match condition {
            ConditionDraft::Points(at) => ConditionDraft::Points(points(at)),
            ConditionDraft::Distance(at, d) => ConditionDraft::Distance(points(at), *d),
            ConditionDraft::Frames(at) => ConditionDraft::Frames(
                at.each_ref().map(|(holder, f)| (self.holder(holder), self.reflection.frame(*f))),
            ),
            ConditionDraft::Coupling { follower, driver, function } => ConditionDraft::Coupling {
                follower: self.port(follower),
                driver: self.port(driver),
                function: function.clone(),
            },
        }
    }

    /// Adds the mirrored component to `made`; `None` after an error.
    fn component(
        &self,
        component: &ComponentDraft,
        texts: &mut Texts,
        made: &mut Vec<ComponentDraft>,
    ) -> Option<()> {
        let set = self.name(&component.set);
        let name = self.renamed(&component.name);
        let mut law = component.law.clone();
        let Mirrored { inputs, after } = match law.mirror(self.reflection) {
            Ok(mirrored) => mirrored,
            Err(help) => {
                let (kind, name) = (law.kind().name, &component.name);
                let message = format!("the {kind} component `{}` cannot be mirrored", name.text);
                texts.error(name.spot, "model/mirror", message, help);
                return None;
            }
        };
        let part =
            |what: &str| Name { text: format!("{}_mirror_{what}", name.text), spot: name.spot };
        let at_port = |name: &Name| Name { text: escaped(&name.text), spot: name.spot };
        let draft = |name: Name, law: Law, ports: Vec<Name>| ComponentDraft {
            set: set.clone(),
            name,
            law,
            ports,
        };
        let ports = law.ports_of(component.ports.len()).zip(&component.ports);
        let mut names = vec![];
        for (index, (port, name)) in ports.enumerate() {
            let renamed = match port.takes {
                PortType::Segment | PortType::Joint => self.renamed(name),
                _ => self.port(name),
            };
            match inputs.get(index) {
                Some(&[slope, intercept]) if [slope, intercept] != [1.0, 0.0] => {
                    let between = part(port.name);
                    let map = Map { functions: vec![Function::linear(slope, intercept)] };
                    made.push(draft(between.clone(), Law::Map(map), vec![renamed]));
                    names.push(at_port(&between));
                }
                _ => names.push(renamed),
            }
        }
        let Some(after) = after else {
            made.push(draft(name.clone(), law, names));
            return Some(());
        };
        let (before, fixed) = (part("before"), part("after"));
        let factors = vec![at_port(&before), at_port(&fixed)];
        made.push(draft(before, law, names));
        made.push(draft(fixed, Law::Place(Place { child_in_parent: after }), vec![]));
        made.push(draft(name.clone(), Law::Product(Product), factors));
        Some(())
    }
}

/// Adds what `mirrored` makes of each element that is `new` on the other side.
fn add<T>(list: &mut Vec<T>, new: impl Fn(&T) -> bool, mirrored: impl Fn(&T) -> T) {
    let made: Vec<T> = list.iter().filter(|one| new(one)).map(mirrored).collect();
    list.extend(made);
}

/// A name as written at a port, where dots separate names.
pub(super) fn escaped(name: &str) -> String {
    name.replace('\\', "\\\\").replace('.', "\\.")
}
