//! The inputs and parameters of components.

use super::{Writer, frame, function, key, knots, line, number, numbers, several_of, text, vector};
use condyle_math::Vec3;
use condyle_math::function::SimmSpline;
use condyle_model::SegmentId;
use condyle_model::component::{
    Along, Centre, Component, Contact, Curve, Custom, JointCone, SurfaceAxis, Swinging,
};
use condyle_model::limit::{ConePoint, Projection};
use std::fmt::Write;

/// The port that takes a list of names.
fn list_port(component: &Component) -> Option<&'static str> {
    match component {
        Component::Combine(_) | Component::Custom(_) => Some("inputs"),
        Component::Product(_) => Some("factors"),
        Component::Contact(_) => Some("drivers"),
        Component::Cone(JointCone { of: Swinging::Orientation(_), .. }) => None,
        Component::Cone(_) => Some("angles"),
        _ => None,
    }
}

impl Writer<'_> {
    pub(super) fn component(&mut self, set: usize, component: &Component) {
        let several = list_port(component);
        let mut listed = vec![];
        for (port, _, source) in component.inputs() {
            let name = self.port(Some(set), source);
            if several == Some(port) {
                listed.push(name);
            } else {
                line!(self, "{port} = {name}");
            }
        }
        if let Some(port) = several {
            line!(self, "{port} = [{}]", listed.join(", "));
        }
        match component {
            Component::Map(c) => match &c.functions[..] {
                [one] => line!(self, "function = {}", function(one)),
                list => {
                    let list: Vec<String> = list.iter().map(function).collect();
                    line!(self, "functions = [{}]", list.join(", "));
                }
            },
            Component::Combine(c) => line!(self, "function = {}", several_of(&c.function)),
            Component::Depend(c) => {
                for (side, f) in [("lower", &c.lower), ("upper", &c.upper)] {
                    if let Some(f) = f {
                        line!(self, "{side} = {}", function(f));
                    }
                }
            }
            Component::Pivot(c) => {
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
            Component::Compensate(c) => {
                let name = |id: SegmentId| text(&self.model.segment(id).name);
                let segment = name(c.segment);
                let ancestors: Vec<String> = c.ancestors.iter().map(|id| name(*id)).collect();
                line!(self, "segment = {segment}");
                line!(self, "ancestors = [{}]", ancestors.join(", "));
                line!(self, "weight = {}", number(c.weight));
            }
            Component::Rotate(c) => line!(self, "axis = {}", vector(c.axis)),
            Component::Translate(c) => line!(self, "axis = {}", vector(c.axis)),
            Component::Place(c) => {
                for part in frame(c.child_in_parent) {
                    line!(self, "{part}");
                }
            }
            Component::Ellipsoid(c) => {
                line!(self, "radii = {}", vector(c.radii));
                if c.axis == SurfaceAxis::Normal {
                    line!(self, "surface_axis = \"normal\"");
                }
            }
            Component::ConstantCurvature(c) => {
                line!(self, "neutral = {}", numbers(&c.neutral));
                line!(self, "length = {}", number(c.length));
            }
            Component::Ball(_) | Component::Product(_) => {}
            Component::Cone(c) => self.cone(c),
            Component::Contact(c) => self.contact(c),
            Component::Scale(c) => {
                if let Some(axis) = c.along.axis() {
                    line!(self, "axis = {}", vector(axis));
                }
                if matches!(c.along, Along::Volume(_)) {
                    line!(self, "volume = true");
                }
            }
            Component::Shear(c) => {
                line!(self, "along = {}", vector(c.along));
                line!(self, "across = {}", vector(c.across));
            }
            Component::Curve(c) => self.curve(c),
            Component::Custom(c) => self.custom(c),
        }
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
            Swinging::Angles(_, axes) => axes,
            Swinging::Directions(_, axes) => axes,
            Swinging::Orientation(_) => &[],
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
        for (key, id) in [("segment", contact.segment), ("surface", contact.surface)] {
            let name = text(&self.model.segment(id).name);
            line!(self, "{key} = {name}");
        }
        for part in frame(contact.law.ellipsoid_in_surface()) {
            line!(self, "{part}");
        }
        line!(self, "radii = {}", vector(contact.law.radii()));
        line!(self, "axis = {}", vector(contact.law.axis()));
        line!(self, "pairs = [");
        for pair in contact.law.pairs() {
            let (first, second) = (vector(pair.first), vector(pair.second));
            let at = numbers(&pair.at);
            line!(self, "    {{ first = {first}, second = {second}, at = {at} }},");
        }
        line!(self, "]");
    }
}
