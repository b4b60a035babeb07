//! The inputs and parameters of components.

use super::{Writer, frame, function, key, knots, line, number, numbers, several_of, text, vector};
use crate::document::limit;
use crate::document::region::region_lines;
use condyle_math::function::SimmSpline;
use condyle_math::{Quat, Vec3};
use condyle_model::component::{
    Along, AngleNames, Arity, Centre, Component, Contact, Curve, Custom, FieldLimit, JointCone,
    Law, SurfaceAxis, Swinging,
};
use condyle_model::limit::{ConePoint, Projection};
use std::fmt::Write;

/// The names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

impl Writer<'_> {
    pub(super) fn component(&mut self, component: &Component) {
        let set = component.joint_set.index();
        for (port, signals) in component.by_port() {
            let names: Vec<String> =
                signals.iter().map(|&signal| self.port(Some(set), signal)).collect();
            let name = port.name;
            if !port.is_list() {
                names.iter().for_each(|one| line!(self, "{name} = {one}"));
            } else if port.arity == Arity::List || !names.is_empty() {
                line!(self, "{name} = [{}]", names.join(", "));
            }
        }
        match &component.law {
            Law::Map(c) => match &c.functions[..] {
                [one] => line!(self, "function = {}", function(one)),
                list => {
                    let list: Vec<String> = list.iter().map(function).collect();
                    line!(self, "functions = [{}]", list.join(", "));
                }
            },
            Law::Combine(c) => line!(self, "function = {}", several_of(&c.function)),
            Law::Correlate(c) => {
                line!(self, "function = {}", several_of(&c.function));
                if let Some(region) = &c.region {
                    line!(self, "region = {{ {} }}", region_lines(region).join(", "));
                }
            }
            Law::Depend(c) => {
                for (side, f) in [("lower", &c.lower), ("upper", &c.upper)] {
                    if let Some(f) = f {
                        line!(self, "{side} = {}", function(f));
                    }
                }
            }
            Law::Pivot(c) => {
                line!(self, "axis = {}", vector(c.axis()));
                match c.centre() {
                    Centre::Intervals(list) => {
                        let one = |(to, at): &(f64, Vec3)| match to.is_finite() {
                            true => format!("{{ to = {}, at = {} }}", number(*to), vector(*at)),
                            false => format!("{{ at = {} }}", vector(*at)),
                        };
                        let list: Vec<String> = list.iter().map(one).collect();
                        line!(self, "centres = [{}]", list.join(", "));
                    }
                    Centre::Path(splines) => self.path(splines),
                }
            }
            Law::Compensate(c) => line!(self, "weight = {}", number(c.weight)),
            Law::Rotate(c) => line!(self, "axis = {}", vector(c.axis)),
            Law::Translate(c) => line!(self, "axis = {}", vector(c.axis)),
            Law::Place(c) => {
                for part in frame(c.child_in_parent) {
                    line!(self, "{part}");
                }
            }
            Law::Ellipsoid(c) => {
                line!(self, "radii = {}", vector(c.radii));
                if c.axis == SurfaceAxis::Normal {
                    line!(self, "surface_axis = \"normal\"");
                }
            }
            Law::ConstantCurvature(c) => {
                line!(self, "neutral = {}", numbers(&c.neutral));
                line!(self, "length = {}", number(c.length));
            }
            Law::Ball(_) | Law::Product(_) => {}
            Law::Cone(c) => self.cone(c),
            Law::Ellipse(c) => {
                line!(self, "centre = {}", numbers(&c.centre()));
                line!(self, "half_axes = {}", numbers(&c.half_axes()));
                line!(self, "tilt = {}", number(c.tilt()));
            }
            Law::HalfSpace(c) => {
                line!(self, "normal = {}", numbers(c.normal()));
                line!(self, "bound = {}", number(c.bound()));
            }
            Law::Field(c) => self.field(component, c),
            Law::RelativeOrientation(_) => {}
            Law::RelativePosition(c) => {
                line!(self, "point = {}", vector(c.point));
                let along: Vec<String> = c.along.iter().map(|&along| vector(along)).collect();
                line!(self, "along = [{}]", along.join(", "));
            }
            Law::Angles(c) => {
                match c.names {
                    AngleNames::Euler(order) => line!(self, "order = \"{order}\""),
                    AngleNames::SwingTwist(axis) => line!(self, "twist = \"{}\"", AXES[axis % 3]),
                }
                if let Some(at) = c.mirrored {
                    line!(self, "mirrored = \"{}\"", AXES[at.axis()]);
                }
            }
            Law::Contact(c) => self.contact(c),
            Law::Scale(c) => {
                if let Some(axis) = c.along.axis() {
                    line!(self, "axis = {}", vector(axis));
                }
                if matches!(c.along, Along::Volume(_)) {
                    line!(self, "volume = true");
                }
            }
            Law::Shear(c) => {
                line!(self, "along = {}", vector(c.along));
                line!(self, "across = {}", vector(c.across));
            }
            Law::Curve(c) => self.curve(c),
            Law::Custom(c) => self.custom(c),
        }
    }

    /// A learned limit with all that it was learned from.
    fn field(&mut self, component: &Component, field: &FieldLimit) {
        for (key, axes) in [
            ("in_reference", field.in_reference),
            ("in_segment", field.in_segment),
            ("driver_in_reference", field.driver_in_reference),
            ("driver_in_segment", field.driver_in_segment),
        ] {
            if axes != Quat::IDENTITY {
                line!(self, "{key} = {}", numbers(&axes.to_array()));
            }
        }
        if let Some(at) = field.mirrored {
            line!(self, "mirrored = \"{}\"", AXES[at.axis()]);
        }
        if field.strict {
            line!(self, "holes = \"closed\"");
        }
        let index = self.model.components().iter().position(|c| std::ptr::eq(c, component));
        let name = index.and_then(|index| self.components.get(index)).unwrap_or(&component.name);
        let (set, name) = (key(&self.set(component.joint_set.index())), key(name));
        let table = format!("joint_set.{set}.component.{name}.field.limit");
        line!(self, "\n[{table}]");
        limit::named_keys(&mut self.out, &field.limit, &format!("{table}."));
    }

    fn path(&mut self, splines: &[SimmSpline; 3]) {
        let list = splines.each_ref().map(|s| knots(&mut s.knots()));
        line!(self, "path = [{}]", list.join(", "));
    }

    fn curve(&mut self, curve: &Curve) {
        self.path(&curve.path);
        if let Some(heading) = curve.heading {
            line!(self, "forward = {}", vector(heading.forward));
            line!(self, "up = {}", vector(heading.up));
        }
    }

    fn custom(&mut self, custom: &Custom) {
        line!(self, "law = {}", text(&custom.law));
        let one = |(name, list): (&String, &Vec<f64>)| format!("{} = {}", key(name), numbers(list));
        let all: Vec<String> = custom.parameters.iter().map(one).collect();
        if !all.is_empty() {
            line!(self, "parameters = {{ {} }}", all.join(", "));
        }
    }

    fn cone(&mut self, JointCone { of, cone }: &JointCone) {
        let axes: &[Vec3] = match of {
            Swinging::Angles(axes) => axes,
            Swinging::Directions(axes) => axes,
            Swinging::Orientation => &[],
        };
        if !axes.is_empty() {
            let axes: Vec<String> = axes.iter().map(|axis| vector(*axis)).collect();
            line!(self, "axes = [{}]", axes.join(", "));
        }
        line!(self, "rest = {}", vector(cone.rest()));
        if let Some(bounds) = cone.twist_at_rest() {
            line!(self, "twist = {}", numbers(&bounds));
        }
        line!(self, "subdivisions = {}", cone.subdivisions());
        if cone.projection() == Projection::TowardRest {
            line!(self, "projection = \"toward_rest\"");
        }
        line!(self, "points = [");
        for ConePoint { direction, twist } in cone.points() {
            let twist = twist.map_or(String::new(), |t| format!(", twist = {}", numbers(&t)));
            line!(self, "    {{ direction = {}{twist} }},", vector(*direction));
        }
        line!(self, "]");
    }

    fn contact(&mut self, contact: &Contact) {
        for part in frame(contact.law.ellipsoid_in_surface()) {
            line!(self, "{part}");
        }
        line!(self, "radii = {}", vector(contact.law.radii()));
        line!(self, "axis = {}", vector(contact.law.axis()));
        if let Some(gap) = contact.most_gap {
            line!(self, "most_gap = {}", number(gap));
        }
        line!(self, "pairs = [");
        for pair in contact.law.pairs() {
            let (first, second) = (vector(pair.first), vector(pair.second));
            let at = numbers(&pair.at);
            line!(self, "    {{ first = {first}, second = {second}, at = {at} }},");
        }
        line!(self, "]");
    }
}
