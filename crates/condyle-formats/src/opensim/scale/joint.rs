//! Joints: their frames in old files, the lengths of their surfaces, the functions of their
//! translations, and their coordinates that are lengths.

use super::{Scaling, name_of, reach, written};
use crate::opensim::model::frame::Frames;
use crate::opensim::model::function::is_function;
use crate::opensim::model::joint::axes;
use crate::opensim::model::{Base, triple};
use crate::xml::Element;
use crate::xml::edit::escaped;
use condyle_diagnostics::{Diagnostic, Error};
use condyle_math::{EulerOrder, Growth, Mat3, Vec3};

/// The first version whose joints state their ends as frames.
const FRAMES_IN_JOINTS: u32 = 30505;

impl<'d> Scaling<'d, '_, '_> {
    pub(super) fn joint(&mut self, joint: Element<'d>) -> Result<(), Error> {
        let Some(([parent, child], turn)) = self.ends(joint)? else { return Ok(()) };
        let (parent, child) = (self.factor(parent), self.factor(child));
        // OpenSim takes the parent's axes for those of the joint, however its frame is turned.
        let turn = if self.rules.as_opensim { Mat3::IDENTITY } else { turn };
        let inside = Growth::along_axes(parent.to_array()).within(turn);
        let radii = Vec3::from([Vec3::X, Vec3::Y, Vec3::Z].map(|axis| inside.length(axis)));
        let new = Frames::socket(joint, "parent_frame").is_some();
        if !new || self.version < FRAMES_IN_JOINTS {
            let mut ends = self.triple(joint, "location_in_parent", parent)?;
            ends |= self.triple(joint, "location_in_child", child)?;
            ends |= self.triple(joint, "location", child)?;
            if ends {
                self.report.count("joint frames");
            }
        }
        match joint.name() {
            "EllipsoidJoint" => {
                self.triple(joint, "radii_x_y_z", radii)?;
                self.report.count("ellipsoids of joints");
            }
            "ScapulothoracicJoint" => {
                self.triple(joint, "thoracic_ellipsoid_radii_x_y_z", radii)?;
                if let Some([x, y]) = joint.child_numbers::<2>("scapula_winging_axis_origin")?
                    && let Some(origin) = joint.child("scapula_winging_axis_origin")
                {
                    self.edits.set_text(origin, &written(&[x * child.x, y * child.y]));
                }
                self.report.count("ellipsoids of joints");
            }
            "ConstantCurvatureJoint" => {
                self.number(joint, "length", child.y)?;
                self.report.count("lengths of bent columns");
            }
            "CustomJoint" => self.custom(joint, &inside)?,
            "SliderJoint" => self.sliding(joint, &inside, &[(0, Vec3::X)]),
            "PlanarJoint" => self.sliding(joint, &inside, &[(1, Vec3::X), (2, Vec3::Y)]),
            "FreeJoint" => {
                self.sliding(joint, &inside, &[(3, Vec3::X), (4, Vec3::Y), (5, Vec3::Z)]);
            }
            "PinJoint" | "UniversalJoint" | "BallJoint" | "GimbalJoint" | "WeldJoint" => {}
            _ => self.report.leave(name_of(joint), "its kind is not known"),
        }
        self.coordinates(joint)
    }

    /// What a joint connects, and how its frame is turned in the parent; none of one that stands where OpenSim looks for no joint.
    fn ends(&self, joint: Element<'d>) -> Result<Option<([Base; 2], Mat3)>, Error> {
        let Ok(parent) = Frames::reference(joint, &["parent_frame", "parent_body"]) else {
            return Ok(None);
        };
        let (parent, frame) = self.frames.resolve(joint, parent)?;
        // Old files state the turn in the joint.
        let own = joint.child("orientation_in_parent").is_some() && self.version < FRAMES_IN_JOINTS;
        let own = if own { triple(joint, "orientation_in_parent")? } else { Vec3::ZERO };
        let turn = frame.linear * EulerOrder::XYZ.to_mat3(own.to_array());
        let holder = joint.parent().filter(|holder| holder.is("Joint"));
        if let Some(body) = holder.and_then(|holder| holder.parent())
            && let Some((child, _)) = self.frames.at(body)?
        {
            return Ok(Some(([parent, child], turn)));
        }
        let child = self.frames.of_part(joint, &["child_frame", "child_body"])?.0;
        Ok(Some(([parent, child], turn)))
    }

    /// A custom joint: the functions of its translations.
    fn custom(&mut self, joint: Element<'d>, inside: &Growth) -> Result<(), Error> {
        for (place, element) in axes(joint) {
            let rotation = element.child_bool("is_rotation")?.unwrap_or(place < 3);
            if rotation {
                continue;
            }
            let mut axis = [Vec3::X, Vec3::Y, Vec3::Z][place % 3];
            if element.child_text("axis").is_some() {
                axis = triple(element, "axis")?;
            }
            let holder = element.child("function").unwrap_or(element);
            let function = holder.children().find(|e| is_function(*e));
            let drivers = element.child("coordinates").or_else(|| element.child("coordinate"));
            let driver = drivers.map(Element::text).unwrap_or_default();
            match function {
                None => {
                    // An empty function is the coordinate itself.
                    if element.child("function").is_some() {
                        self.slides(driver, axis, inside);
                    }
                    continue;
                }
                Some(linear) if linear.is("LinearFunction") => {
                    let list = linear.child("coefficients");
                    let list = list.map(Element::f64s).transpose()?.unwrap_or_default();
                    if list == [1.0, 0.0] && !driver.is_empty() {
                        self.slides(driver, axis, inside);
                        continue;
                    }
                    if list == [-1.0, 0.0] {
                        self.translations.insert(driver.to_owned(), reach(axis, inside));
                    }
                }
                Some(_) => {}
            }
            let Some(function) = function else { continue };
            self.report.count("translations of joints");
            if self.rules.as_opensim {
                let each = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| inside.length(axis));
                let factor = axis.to_array().iter().zip(each).map(|(a, f)| a.abs() * f).sum();
                self.multiply(function, factor)?;
                continue;
            }
            let along = inside.point(axis);
            if along.cross(axis).norm() > 1e-12 * along.norm() * axis.norm()
                && let Some(stated) = element.child("axis")
            {
                let turned = along * (axis.norm() / along.norm());
                self.edits.set_text(stated, &written(&turned.to_array()));
                self.report.beyond.push(("turned by unequal factors", axis_of(joint, element)));
            }
            self.multiply(function, reach(axis, inside))?;
        }
        Ok(())
    }

    /// Multiplies a function.
    pub(super) fn multiply(&mut self, function: Element<'d>, factor: f64) -> Result<(), Error> {
        if factor == 1.0 {
            return Ok(());
        }
        if function.is("MultiplierFunction") {
            let before = function.child_f64("scale")?;
            let after = written(&[before.unwrap_or(1.0) * factor]);
            match function.child("scale") {
                Some(scale) => self.edits.set_text(scale, &after),
                None => self.edits.append(function, &format!("<scale>{after}</scale>")),
            }
            return Ok(());
        }
        let name = function.attribute("name").filter(|name| !name.is_empty());
        let name = name.map_or(String::new(), |name| format!(" name=\"{}\"", escaped(name)));
        let before = format!("<MultiplierFunction{name}><function>");
        let after = written(&[factor]);
        let after = format!("</function><scale>{after}</scale></MultiplierFunction>");
        self.edits.wrap(function, &before, &after);
        Ok(())
    }

    /// A coordinate that is a length along an axis.
    fn slides(&mut self, name: &str, axis: Vec3, inside: &Growth) {
        if !name.is_empty() {
            let factor = reach(axis, inside);
            if !inside.is_even() {
                self.unequal.insert(name.to_owned());
            }
            self.lengths.insert(name.to_owned(), factor);
            self.translations.insert(name.to_owned(), factor);
        }
    }

    /// Coordinates of a joint that are lengths, by their positions.
    fn sliding(&mut self, joint: Element<'d>, inside: &Growth, which: &[(usize, Vec3)]) {
        let all = coordinates(joint);
        for &(index, axis) in which {
            let name = all.get(index).and_then(|e| e.attribute("name")).unwrap_or_default();
            self.slides(name, axis, inside);
        }
    }

    /// Defaults and ranges of coordinates that are lengths, which OpenSim leaves.
    fn coordinates(&mut self, joint: Element<'d>) -> Result<(), Error> {
        if self.rules.as_opensim {
            return Ok(());
        }
        for coordinate in coordinates(joint) {
            let name = coordinate.attribute("name").unwrap_or_default();
            let Some(&factor) = self.lengths.get(name).filter(|factor| **factor != 1.0) else {
                continue;
            };
            for default in ["default_value", "initial_value"] {
                self.number(coordinate, default, factor)?;
            }
            if let Some(range) = coordinate.child_numbers::<2>("range")?
                && let Some(child) = coordinate.child("range")
            {
                // What stands for no bound stays.
                let scaled = range.map(|x| if x.abs() < 99_999.0 { x * factor } else { x });
                self.edits.set_text(child, &written(&scaled));
            }
            let what = "default and range of a length";
            self.report.beyond.push((what, name.to_owned()));
        }
        Ok(())
    }

    /// A coupler whose follower is a length.
    pub(super) fn coupler(&mut self, coupler: Element<'d>) -> Result<(), Error> {
        let bare = |name: &str| name.rsplit('/').next().unwrap_or(name).trim().to_owned();
        let known = if self.rules.as_opensim { &self.translations } else { &self.lengths };
        let follower = coupler.child_text("dependent_coordinate_name").unwrap_or_default();
        let factor = known.get(&bare(follower)).copied();
        let leaders = coupler.child_text("independent_coordinate_names").unwrap_or_default();
        let leads = leaders.split_whitespace().any(|name| {
            !self.rules.as_opensim && self.lengths.get(&bare(name)).is_some_and(|f| *f != 1.0)
        });
        if leads {
            let why = "it is a function of a length, which was scaled: check it";
            self.report.leave(name_of(coupler), why);
        }
        let Some(factor) = factor else { return Ok(()) };
        self.report.count("couplers of lengths");
        if self.rules.as_opensim && self.unequal.contains(&bare(follower)) {
            let message = format!("{} makes a length follow", name_of(coupler));
            let help = "its body has unequal factors, with which OpenSim does not scale the model at all; \
                        the length takes that of its axis";
            let said = Diagnostic::warning("scale/coupler", message).at(coupler.place());
            self.warnings.push(said.with_help(help));
        }
        if !self.number(coupler, "scale_factor", factor)? && factor != 1.0 {
            let scale = written(&[factor]);
            match coupler.child("scale_factor") {
                Some(blank) => self.edits.set_text(blank, &scale),
                None => {
                    self.edits.append(coupler, &format!("<scale_factor>{scale}</scale_factor>"));
                }
            }
        }
        Ok(())
    }
}

fn coordinates(joint: Element<'_>) -> Vec<Element<'_>> {
    let list = joint.child("coordinates").or_else(|| {
        let set = joint.child("CoordinateSet")?;
        Some(set.child("objects").unwrap_or(set))
    });
    list.into_iter().flat_map(|list| list.children_named("Coordinate")).collect()
}

fn axis_of(joint: Element<'_>, axis: Element<'_>) -> String {
    format!("{} of {}", axis.attribute("name").unwrap_or("an axis"), name_of(joint))
}
