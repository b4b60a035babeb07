//! Parts that are fixed in bodies: frames, points, geometry, surfaces that muscles wrap, contacts,
//! springs, points of constraints.

use super::{Scaling, name_of, reach, written};
use crate::opensim::model::frame::POINT_FRAME;
use crate::opensim::model::function::is_function;
use crate::opensim::model::triple;
use crate::xml::Element;
use condyle_diagnostics::Error;
use condyle_math::{EulerOrder, Growth, Mat3, Vec3};

/// Forces and controls that hold no length.
const NO_LENGTHS: [&str; 14] = [
    "CoordinateActuator",
    "ElasticFoundationForce",
    "ExternalForce",
    "FunctionBasedBushingForce",
    "HuntCrossleyForce",
    "HuntCrossleyForce__ContactParameters",
    "PathActuator",
    "PrescribedForce",
    "SmoothSphereHalfSpaceForce",
    "Smith2018ArticularContactForce",
    "TorqueActuator",
    "ActivationCoordinateActuator",
    "ClutchedPathSpring",
    "ExpressionBasedBushingForce",
];

impl<'d> Scaling<'d, '_, '_> {
    pub(super) fn part(&mut self, part: Element<'d>) -> Result<(), Error> {
        let class = part.name();
        if part.parent().is_some_and(|e| e.is("attached_geometry")) {
            return self.geometry(part);
        }
        match class {
            "PhysicalOffsetFrame" | "OffsetFrame" => {
                if let Some((base, _)) = self.frames.at(part)?
                    && self.triple(part, "translation", self.factor(base))?
                {
                    self.report.count("offset frames");
                }
            }
            "Marker" => self.point(part, "location", POINT_FRAME, "markers")?,
            "Station" => self.point(part, "location", POINT_FRAME, "stations")?,
            "PathPoint" | "ConditionalPathPoint" | "MusclePoint" | "MuscleViaPoint" => {
                self.point(part, "location", POINT_FRAME, "path points")?;
            }
            "MovingPathPoint" | "MovingMusclePoint" => self.moving(part)?,
            "WrapCylinder" | "WrapEllipsoid" | "WrapSphere" | "WrapTorus" => self.wrap(part)?,
            "VisibleObject" if part.parent().is_some_and(|e| e.is("Body")) => {
                if let Some(factor) = self.around(part)? {
                    self.appearance(part, factor)?;
                }
                self.stands(part, Mat3::IDENTITY)?;
            }
            "DisplayGeometry" => self.displayed(part)?,
            "CoordinateCouplerConstraint" => self.coupler(part)?,
            "WeldConstraint" => {
                // Since version 4 its ends are offset frames, which OpenSim makes of old files too.
                let pairs: [(&str, &[&str]); 2] = [
                    ("location_body_1", &["body_1", "frame1"]),
                    ("location_body_2", &["body_2", "frame2"]),
                ];
                for (property, frames) in pairs {
                    if part.child_text(property).is_some() {
                        self.point(part, property, frames, "ends of welds")?;
                    }
                }
            }
            _ if class.starts_with("Wrap")
                && !class.ends_with("Set")
                && part.child("translation").is_some() =>
            {
                self.report.leave(name_of(part), "its kind of surface is not known");
            }
            _ if class.ends_with("Constraint") && part.child("wrap_object").is_none() => {
                self.constraint(part)?;
            }
            _ if class.contains("Contact") && class != "ContactGeometrySet" => {
                self.contact(part)?;
            }
            _ => self.force(part)?,
        }
        Ok(())
    }

    /// A point of a frame.
    fn point(
        &mut self,
        part: Element<'d>,
        property: &str,
        frames: &[&str],
        kind: &'static str,
    ) -> Result<(), Error> {
        let (base, _) = self.frames.of_part(part, frames)?;
        if self.triple(part, property, self.factor(base))? {
            self.report.count(kind);
        }
        Ok(())
    }

    /// A point of a path whose place are functions.
    fn moving(&mut self, part: Element<'d>) -> Result<(), Error> {
        let (base, _) = self.frames.of_part(part, POINT_FRAME)?;
        let factors = self.factor(base).to_array();
        self.report.count("moving path points");
        for ((new, old), factor) in super::length::MOVING.iter().zip(factors) {
            let holder = part.child(new).or_else(|| part.child(old));
            let function = holder.and_then(|e| e.children().find(|f| is_function(*f)));
            if let Some(function) = function {
                self.multiply(function, factor)?;
            }
        }
        Ok(())
    }

    fn wrap(&mut self, surface: Element<'d>) -> Result<(), Error> {
        let Some(factors) = self.around(surface)? else { return Ok(()) };
        self.triple(surface, "translation", factors)?;
        self.report.count("surfaces that muscles wrap");
        let turn = EulerOrder::XYZ.to_mat3(triple(surface, "xyz_body_rotation")?.to_array());
        let by = Growth::along_axes(factors.to_array());
        let local = [turn.x, turn.y, turn.z].map(|axis| reach(axis, &by));
        let across = 0.5 * (local[0] + local[1]);
        match surface.name() {
            "WrapCylinder" => {
                self.number(surface, "radius", across)?;
                self.number(surface, "length", local[2])?;
            }
            "WrapTorus" => {
                self.number(surface, "inner_radius", across)?;
                self.number(surface, "outer_radius", across)?;
            }
            "WrapSphere" => {
                self.number(surface, "radius", mean(factors))?;
            }
            _ => {
                self.triple(surface, "dimensions", local.into())?;
            }
        }
        Ok(())
    }

    /// Geometry that is attached to a frame, since version 4.
    fn geometry(&mut self, geometry: Element<'d>) -> Result<(), Error> {
        if geometry.is("FrameGeometry") {
            return Ok(());
        }
        match self.around(geometry)? {
            Some(factors) => self.appearance(geometry, factors),
            None => Ok(()),
        }
    }

    /// Geometry of a body before version 4: where it stands in what the body shows.
    fn displayed(&mut self, geometry: Element<'d>) -> Result<(), Error> {
        let mut around = std::iter::successors(geometry.parent(), |e| e.parent());
        let Some(visible) = around.find(|e| e.is("VisibleObject")) else { return Ok(()) };
        if !visible.parent().is_some_and(|e| e.is("Body")) {
            return Ok(());
        }
        let turn = match visible.child_numbers::<6>("transform")? {
            Some([a, b, c, ..]) => EulerOrder::XYZ.to_mat3([a, b, c]),
            None => Mat3::IDENTITY,
        };
        self.stands(geometry, turn)
    }

    /// The place in a `transform` of three angles and three lengths, inside a turned frame of a body.
    fn stands(&mut self, part: Element<'d>, turn: Mat3) -> Result<(), Error> {
        let Some([a, b, c, x, y, z]) = part.child_numbers::<6>("transform")? else {
            return Ok(());
        };
        let (Some(f), Some(child)) = (self.around(part)?, part.child("transform")) else {
            return Ok(());
        };
        let place = Vec3::new(x, y, z);
        if place != Vec3::ZERO && f != Vec3::new(1.0, 1.0, 1.0) {
            let [x, y, z] = (turn.transpose() * (turn * place).times(f)).to_array();
            self.edits.set_text(child, &written(&[a, b, c, x, y, z]));
        }
        Ok(())
    }

    fn appearance(&mut self, geometry: Element<'d>, factors: Vec3) -> Result<(), Error> {
        self.report.count("geometries");
        let ones = Vec3::new(1.0, 1.0, 1.0);
        if !self.triple(geometry, "scale_factors", factors)? && factors != ones {
            let three = written(&factors.to_array());
            match geometry.child("scale_factors") {
                Some(blank) => self.edits.set_text(blank, &three),
                None => {
                    let xml = format!("<scale_factors>{three}</scale_factors>");
                    self.edits.prepend(geometry, &xml);
                }
            }
        }
        Ok(())
    }

    /// A point that OpenSim leaves; answers whether there is one that was changed.
    fn left_point(
        &mut self,
        part: Element<'d>,
        property: &str,
        frames: &[&str],
    ) -> Result<bool, Error> {
        if part.child_text(property).is_none() {
            return Ok(false);
        }
        let Ok((base, _)) = self.frames.of_part(part, frames) else {
            let message = "the body of its point is not known";
            self.report.leave(name_of(part), message);
            return Ok(false);
        };
        let factors = self.factor(base);
        Ok(self.triple(part, property, factors)? && factors != Vec3::new(1.0, 1.0, 1.0))
    }

    fn constraint(&mut self, constraint: Element<'d>) -> Result<(), Error> {
        let pairs: [(&str, &[&str]); 5] = [
            ("location_body_1", &["body_1", "frame1"]),
            ("location_body_2", &["body_2", "frame2"]),
            ("point_on_line", &["line_body"]),
            ("point_on_follower", &["follower_body"]),
            ("rolling_surface_location", &["rolling_body"]),
        ];
        self.points_left(constraint, &pairs, "points of a constraint")
    }

    /// Points that OpenSim leaves: scaled and listed, or listed as left.
    fn points_left(
        &mut self,
        part: Element<'d>,
        pairs: &[(&str, &[&str])],
        what: &'static str,
    ) -> Result<(), Error> {
        if !pairs.iter().any(|(property, _)| part.child_text(property).is_some()) {
            return Ok(());
        }
        if self.rules.as_opensim {
            self.report.leave(name_of(part), "OpenSim leaves its points");
            return Ok(());
        }
        let mut changed = false;
        for (property, frames) in pairs {
            changed |= self.left_point(part, property, frames)?;
        }
        if changed {
            self.report.beyond.push((what, name_of(part)));
        }
        Ok(())
    }

    fn contact(&mut self, contact: Element<'d>) -> Result<(), Error> {
        let frames: &[&str] = &["frame", "body_name", "mesh_frame"];
        let Ok((base, _)) = self.frames.of_part(contact, frames) else { return Ok(()) };
        if self.rules.as_opensim {
            self.report.leave(name_of(contact), "OpenSim leaves contacts");
            return Ok(());
        }
        let factors = self.factor(base);
        let mut changed = self.triple(contact, "location", factors)?;
        changed |= self.number(contact, "radius", mean(factors))?;
        changed |= self.triple(contact, "radii", factors)?;
        changed |= self.triple(contact, "scale_factors", factors)?;
        let ones = Vec3::new(1.0, 1.0, 1.0);
        if contact.is("ContactMesh") && factors != ones {
            self.report.leave(name_of(contact), "the mesh file itself is not scaled");
        }
        if changed && factors != ones {
            self.report.beyond.push(("contacts", name_of(contact)));
        }
        Ok(())
    }

    /// Forces between points, and those on coordinates that are lengths.
    fn force(&mut self, force: Element<'d>) -> Result<(), Error> {
        match force.name() {
            "PointToPointSpring" | "ExpressionBasedPointToPointForce" => {
                let pairs: [(&str, &[&str]); 2] =
                    [("point1", &["body1", "body_1"]), ("point2", &["body2", "body_2"])];
                self.points_left(force, &pairs, "points of a spring")
            }
            "PointToPointActuator" => {
                if force.child_bool("points_are_global")?.unwrap_or(false) {
                    return Ok(());
                }
                let pairs: [(&str, &[&str]); 2] = [("pointA", &["bodyA"]), ("pointB", &["bodyB"])];
                self.points_left(force, &pairs, "points of an actuator")
            }
            "PointActuator" => {
                if force.child_bool("point_is_global")?.unwrap_or(false) {
                    return Ok(());
                }
                self.points_left(force, &[("point", &["body"])], "points of an actuator")
            }
            "BushingForce" | "LinearBushingForce" => {
                // Since version 4 it is stated by offset frames, which are scaled as all are.
                let pairs: [(&str, &[&str]); 2] =
                    [("location_body_1", &["body_1"]), ("location_body_2", &["body_2"])];
                for (property, frames) in pairs {
                    if force.child_text(property).is_some() {
                        self.point(force, property, frames, "ends of bushings")?;
                    }
                }
                Ok(())
            }
            "CoordinateLimitForce" => {
                self.on_length(force, &["upper_limit", "lower_limit", "transition"])
            }
            "SpringGeneralizedForce" => self.on_length(force, &["rest_length"]),
            class => {
                let set = force.parent().filter(|e| e.is("objects")).and_then(Element::parent);
                let known = NO_LENGTHS.contains(&class) || super::length::has_path(force);
                if set.is_some_and(|set| set.is("ForceSet")) && !known {
                    self.report.leave(name_of(force), "its kind is not known");
                }
                Ok(())
            }
        }
    }

    fn on_length(&mut self, force: Element<'d>, properties: &[&str]) -> Result<(), Error> {
        let name = force.child_text("coordinate").unwrap_or_default();
        let Some(&factor) = self.lengths.get(name).filter(|factor| **factor != 1.0) else {
            return Ok(());
        };
        if self.rules.as_opensim {
            self.report.leave(name_of(force), "OpenSim leaves the lengths of its coordinate");
            return Ok(());
        }
        for property in properties {
            self.number(force, property, factor)?;
        }
        self.report.beyond.push(("limits of a length", name_of(force)));
        Ok(())
    }
}

fn mean(v: Vec3) -> f64 {
    (v.x + v.y + v.z) / 3.0
}
