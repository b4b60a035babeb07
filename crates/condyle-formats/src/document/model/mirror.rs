//! The mirrored side of a body. D is the reflection: diag(1, 1, -1) for a plane z, and so on.
//!
//! Coordinates keep their values: for equal values on both sides, the transform of the mirrored side
//! is D·T·D of the written one. A point p becomes D·p, a frame D·T·D, the axis of a slide D·a, the axis
//! of a turn -D·a (it is a pseudovector). Only an orientation changes its value, since it *is* a
//! rotation: (v, w) on one side is (-D·v, w) on the other.
//!
//! A component whose formula singles out an axis is mirrored by the same component and others:
//!
//! - an ellipsoid mirrored at x or y has two of its angles negated; at z, which reverses its pole,
//!   D·Rx(a)·Ry(b)·Rz(c)·D = Rx(π-a)·Ry(b)·Rz(-c)·Rx(π);
//! - a column has its angles negated; its rest direction y cannot be mirrored at y.
//!
//! A cone's directions become D·d, the axes of its angles -D·a, and its bounds of twist \[-hi, -lo\]:
//! D·R(r, τ)·D = R(D·r, -τ). Factors and amounts of scales and shears keep their values with D·a. The
//! mirror image of a custom law is not known, so that such a component cannot be mirrored.

use super::blueprint::{Blueprint, Held};
use super::draft::{
    ClosureDraft, ComponentDraft, ConditionDraft, CoordinateDraft, Draft, Holder, MarkerDraft,
    OutputDraft, PostureDraft, SegmentDraft,
};
use crate::document::texts::{Name, Texts};
use condyle_math::function::{Function, SimmSpline};
use condyle_math::{Affine, Mat3, Vec3};
use condyle_model::CoordinateKind;
use condyle_model::component::{Along, Centre, ContactPair, Gliding, Heading};
use condyle_model::limit::{Cone, ConePoint};
use std::collections::HashSet;
use std::f64::consts::PI;

pub(super) struct Mirror {
    /// The axis normal to the plane.
    pub(super) axis: usize,
    /// How the names of the written side end, and those of the mirrored side.
    pub(super) from: String,
    pub(super) to: String,
}

impl Mirror {
    /// Adds everything of the other side that is not written.
    pub(super) fn complete(&self, draft: &mut Draft, texts: &mut Texts) {
        let written = |names: &mut dyn Iterator<Item = &Name>| -> HashSet<String> {
            names.map(|n| n.text.clone()).collect()
        };
        let sets = written(&mut draft.sets.iter());
        let segments = written(&mut draft.segments.iter().map(|s| &s.name));
        let markers = written(&mut draft.markers.iter().map(|m| &m.name));
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
                in_parent: self.frame(s.in_parent),
                in_itself: self.frame(s.in_itself),
            },
        );
        add(
            &mut draft.coordinates,
            |c| new_set(&c.set),
            |c| {
                let mut default = c.default;
                if c.kind == CoordinateKind::Orientation {
                    let [x, y, z, w] = c.default;
                    let v = self.turning(Vec3::new(x, y, z));
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
            |m| MarkerDraft {
                name: self.renamed(&m.name),
                segment: self.holder(&m.segment),
                point: self.point(m.point),
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

    fn holder(&self, holder: &Holder) -> Holder {
        holder.as_ref().map(|n| self.renamed(n))
    }

    fn point(&self, p: Vec3) -> Vec3 {
        let mut p = p.to_array();
        p[self.axis] = -p[self.axis];
        Vec3::from(p)
    }

    fn turning(&self, axis: Vec3) -> Vec3 {
        -self.point(axis)
    }

    fn frame(&self, frame: Affine) -> Affine {
        // D·M·D changes the sign of entries that mix the reversed axis with another.
        let column =
            |c: usize, v: Vec3| if c == self.axis { -self.point(v) } else { self.point(v) };
        let m = frame.linear;
        let linear = Mat3::from_columns(column(0, m.x), column(1, m.y), column(2, m.z));
        Affine::new(linear, self.point(frame.translation))
    }

    fn centre(&self, centre: &Centre) -> Centre {
        match centre {
            Centre::Intervals(list) => {
                Centre::Intervals(list.iter().map(|(to, at)| (*to, self.point(*at))).collect())
            }
            Centre::Path(splines) => Centre::Path(self.path(splines)),
        }
    }

    fn path(&self, splines: &[SimmSpline; 3]) -> Box<[SimmSpline; 3]> {
        let mut splines = Box::new(splines.clone());
        let (x, y) = splines[self.axis].knots().map(|(x, y)| (x, -y)).unzip();
        if let Ok(reversed) = SimmSpline::new(x, y) {
            splines[self.axis] = reversed;
        }
        splines
    }

    /// The mirrored cone; `None` if rounding makes it invalid.
    fn cone(&self, cone: &Cone) -> Option<Cone> {
        let twist = |bounds: Option<[f64; 2]>| bounds.map(|[low, high]| [-high, -low]);
        let point =
            |p: &ConePoint| ConePoint { direction: self.point(p.direction), twist: twist(p.twist) };
        let points = cone.points().iter().map(point).collect();
        let (rest, at_rest) = (self.point(cone.rest()), twist(cone.twist_at_rest()));
        Cone::new(rest, at_rest, points, cone.subdivisions(), cone.projection()).ok()
    }

    fn held(&self, held: &Held) -> Held {
        match held {
            Held::Three(axes) => Held::Three(axes.map(|a| self.turning(a))),
            Held::Two(axes) => Held::Two(axes.map(|a| self.turning(a))),
            Held::Orientation => Held::Orientation,
        }
    }

    fn gliding(&self, gliding: &Gliding) -> Option<Gliding> {
        let pair = |p: &ContactPair| ContactPair {
            first: self.point(p.first),
            second: self.point(p.second),
            at: p.at,
        };
        let pairs = gliding.pairs().iter().map(pair).collect();
        let pose = self.frame(gliding.ellipsoid_in_surface());
        Gliding::new(pose, gliding.radii(), self.turning(gliding.axis()), pairs).ok()
    }

    fn condition(&self, condition: &ConditionDraft) -> ConditionDraft {
        let points = |at: &[(Holder, Vec3); 2]| {
            at.each_ref().map(|(holder, p)| (self.holder(holder), self.point(*p)))
        };
        match condition {
            ConditionDraft::Points(at) => ConditionDraft::Points(points(at)),
            ConditionDraft::Distance(at, d) => ConditionDraft::Distance(points(at), *d),
            ConditionDraft::Frames(at) => ConditionDraft::Frames(
                at.each_ref().map(|(holder, f)| (self.holder(holder), self.frame(*f))),
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
        let mut ports: Vec<Name> = component.ports.iter().map(|p| self.port(p)).collect();
        let part =
            |what: &str| Name { text: format!("{}_mirror_{what}", name.text), spot: name.spot };
        // Replaces the input x at a port by slope·x + intercept.
        let mut through = |port: &mut Name, what: &str, slope: f64, intercept: f64| {
            let between = part(what);
            made.push(ComponentDraft {
                set: set.clone(),
                name: between.clone(),
                blueprint: Blueprint::Map(vec![Function::linear(slope, intercept)]),
                ports: vec![port.clone()],
            });
            *port = Name { text: escaped(&between.text), spot: between.spot };
        };
        let mut refuse = |what: &str, help: &str| {
            let message = format!("{what} `{}` cannot be mirrored", component.name.text);
            texts.error(component.name.spot, "model/mirror", message, help);
            None
        };
        let blueprint = match &component.blueprint {
            Blueprint::Scale(along) => Blueprint::Scale(match along {
                Along::Everywhere => Along::Everywhere,
                Along::Axis(axis) => Along::Axis(self.point(*axis)),
                Along::Volume(axis) => Along::Volume(self.point(*axis)),
            }),
            Blueprint::Shear { along, across } => {
                Blueprint::Shear { along: self.point(*along), across: self.point(*across) }
            }
            Blueprint::Curve { path, heading } => {
                let heading = heading.map(|Heading { forward, up }| Heading {
                    forward: self.point(forward),
                    up: self.point(up),
                });
                Blueprint::Curve { path: self.path(path), heading }
            }
            Blueprint::Cone(held, cone) => match self.cone(cone) {
                Some(cone) => Blueprint::Cone(self.held(held), cone),
                None => return refuse("the cone", "write both sides"),
            },
            Blueprint::Contact { segment, surface, before, gliding } => match self.gliding(gliding)
            {
                Some(gliding) => {
                    let (segment, surface) = (self.renamed(segment), self.renamed(surface));
                    Blueprint::Contact { segment, surface, before: *before, gliding }
                }
                None => return refuse("the contact", "write both sides"),
            },
            Blueprint::Custom(custom) => {
                let help = format!(
                    "the mirror image of law `{}` is not known: write both sides",
                    custom.law
                );
                return refuse("the custom component", &help);
            }
            Blueprint::Rotate(axis) => Blueprint::Rotate(self.turning(*axis)),
            Blueprint::Pivot(axis, centre) => {
                Blueprint::Pivot(self.turning(*axis), self.centre(centre))
            }
            Blueprint::Compensate { segment, ancestors, weight } => Blueprint::Compensate {
                segment: self.renamed(segment),
                ancestors: ancestors.iter().map(|a| self.renamed(a)).collect(),
                weight: *weight,
            },
            Blueprint::Translate(axis) => Blueprint::Translate(self.point(*axis)),
            Blueprint::Place(frame) => Blueprint::Place(self.frame(*frame)),
            Blueprint::Ellipsoid(radii, axis) if ports.len() == 3 => {
                // Slopes and intercepts of the three angles.
                let [x, y, z] = match self.axis {
                    0 => [(1.0, 0.0), (-1.0, 0.0), (-1.0, 0.0)],
                    1 => [(-1.0, 0.0), (1.0, 0.0), (-1.0, 0.0)],
                    _ => [(-1.0, PI), (1.0, 0.0), (-1.0, 0.0)],
                };
                let whats = ["about_x", "about_y", "about_z"];
                for ((port, what), (slope, intercept)) in ports.iter_mut().zip(whats).zip([x, y, z])
                {
                    if (slope, intercept) != (1.0, 0.0) {
                        through(port, what, slope, intercept);
                    }
                }
                if self.axis == 2 {
                    let (surface, half) = (part("surface"), part("half_turn"));
                    let blueprint = Blueprint::Ellipsoid(*radii, *axis);
                    let set = set.clone();
                    let name = surface.clone();
                    made.push(ComponentDraft { set: set.clone(), name, blueprint, ports });
                    let turn =
                        Affine::from_rotation(Mat3::from_columns(Vec3::X, -Vec3::Y, -Vec3::Z));
                    let blueprint = Blueprint::Place(turn);
                    let name = half.clone();
                    made.push(ComponentDraft { set, name, blueprint, ports: vec![] });
                    ports = [surface, half]
                        .map(|n| Name { text: escaped(&n.text), spot: n.spot })
                        .to_vec();
                    Blueprint::Product
                } else {
                    Blueprint::Ellipsoid(*radii, *axis)
                }
            }
            Blueprint::ConstantCurvature { neutral, length } if ports.len() == 3 => {
                // In the order x, z, y; a turn about an axis keeps its sign if that axis is reversed.
                let signs = match self.axis {
                    0 => [1.0, -1.0, -1.0],
                    2 => [-1.0, 1.0, -1.0],
                    _ => {
                        let help = "its rest direction is y: write both sides, or turn its frame";
                        return refuse("the column", help);
                    }
                };
                let whats = ["about_x", "about_z", "about_y"];
                for ((port, what), sign) in ports.iter_mut().zip(whats).zip(signs) {
                    if sign < 0.0 {
                        through(port, what, sign, 0.0);
                    }
                }
                let neutral = std::array::from_fn(|i| signs[i] * neutral[i]);
                Blueprint::ConstantCurvature { neutral, length: *length }
            }
            other => other.clone(),
        };
        made.push(ComponentDraft { set, name, blueprint, ports });
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
