//! Lengths of paths in one posture, and what follows from them: fibres, tendons and ligaments grow as
//! their path does.
//!
//! A path is measured along straight lines between its points; whether such a line meets a surface that
//! the muscle wraps is told.

use super::{Report, Rules, name_of, written};
use crate::opensim::model::frame::{Frames, POINT_FRAME, is_default};
use crate::opensim::model::function::{self, AnyFunction};
use crate::opensim::model::triple;
use crate::xml::Element;
use crate::xml::edit::Edits;
use condyle_diagnostics::Error;
use condyle_math::{Affine, EulerOrder, Vec3};
use condyle_model::{Mode, Model, Pose, Program};
use std::collections::HashMap;

/// The functions of a moving point along x, y, z: their names since version 2, and before.
pub(super) const MOVING: [(&str, &str); 3] =
    [("x_location", "XAttachment"), ("y_location", "YAttachment"), ("z_location", "ZAttachment")];
/// What grows as the path does.
const RESTING: [&str; 4] =
    ["optimal_fiber_length", "tendon_slack_length", "resting_length", "slack_length"];
/// How far outside its range a coordinate may be for a conditional point to count (radians).
const TOLERANCE: f64 = 1e-5;

/// Something whose rest length follows from a distance.
pub(super) struct Path<'d> {
    owner: Element<'d>,
    /// In metres.
    length: f64,
    /// Whether a straight line of it meets a surface that it wraps.
    wraps: bool,
    /// What is stated of it as a length.
    properties: &'static [&'static str],
    /// Whether OpenSim scales it.
    known: bool,
}

/// Whether an element is a muscle, a ligament or another force along a path.
pub(super) fn has_path(element: Element<'_>) -> bool {
    element.children().any(|e| e.is("GeometryPath") || e.is("MusclePointSet"))
}

/// All paths of a model in the order of the file.
pub(super) fn measure<'d>(
    element: Element<'d>,
    frames: &Frames<'d>,
    model: &Model,
    posture: &mut dyn FnMut(&Model) -> Vec<f64>,
) -> Result<Vec<Path<'d>>, Error> {
    let program = Program::compile(model);
    let mut pose = Pose::new(&program);
    let evaluated = program.evaluate(&posture(model), Mode::Open, &mut pose);
    evaluated.map_err(|error| element.error("scale/posture", error.to_string()))?;
    let known: HashMap<&str, Affine> =
        model.segment_ids().map(|id| (model.segment(id).name.as_str(), pose.segment(id))).collect();
    let bodies = frames.bodies().map(|(e, _)| {
        let name = e.attribute("name").unwrap_or_default();
        known.get(name).copied().unwrap_or(Affine::IDENTITY)
    });
    let mut posed =
        Posed { frames, model, pose: &pose, bodies: bodies.collect(), surfaces: HashMap::new() };
    let parts: Vec<Element<'d>> = element.descendants().filter(|e| !is_default(*e)).collect();
    for part in parts.iter().filter(|e| e.name().starts_with("Wrap")) {
        if let (Some(name), Some(surface)) = (part.attribute("name"), posed.surface(*part)?) {
            posed.surfaces.entry(name).or_insert(surface);
        }
    }
    let mut paths = vec![];
    for owner in parts {
        if has_path(owner) {
            let (length, wraps) = posed.path(owner)?;
            let known = !owner.is("RigidTendonMuscle");
            paths.push(Path { owner, length, wraps, properties: &RESTING, known });
            continue;
        }
        let (ends, properties): (_, &[&str]) = match owner.name() {
            "ConstantDistanceConstraint" => (
                [("location_body_1", "body_1"), ("location_body_2", "body_2")],
                &["constant_distance"],
            ),
            "PointToPointSpring" => ([("point1", "body1"), ("point2", "body2")], &["rest_length"]),
            _ => continue,
        };
        let mut points = vec![];
        for (property, frame) in ends {
            let Ok((base, place)) = frames.of_part(owner, &[frame]) else { continue };
            points.push(posed.world(base) * (place * triple(owner, property)?));
        }
        if let [a, b] = points[..] {
            let length = (a - b).norm();
            paths.push(Path { owner, length, wraps: false, properties, known: false });
        }
    }
    Ok(paths)
}

/// Multiplies rest lengths by what their paths have grown.
pub(super) fn follow(
    before: &[Path<'_>],
    after: &[Path<'_>],
    rules: &Rules,
    edits: &mut Edits<'_>,
    report: &mut Report,
) -> Result<(), Error> {
    for (old, new) in before.iter().zip(after) {
        let owner = new.owner;
        let ratio = new.length / old.length;
        let stated = || new.properties.iter().filter(|name| owner.child_text(name).is_some());
        if stated().next().is_none() {
            continue;
        }
        if !new.known && rules.as_opensim {
            report.leave(name_of(owner), "OpenSim leaves its lengths");
            continue;
        }
        if !(ratio.is_finite() && old.length > 0.0) {
            report.leave(name_of(owner), "its path has no length");
            continue;
        }
        for name in stated() {
            if let (Some(value), Some(child)) = (owner.child_f64(name)?, owner.child(name))
                && ratio != 1.0
            {
                edits.set_text(child, &written(&[value * ratio]));
            }
        }
        if new.known {
            report.count("muscles and ligaments");
        } else if ratio != 1.0 {
            report.beyond.push(("rest length", name_of(owner)));
        }
        if old.wraps || new.wraps {
            report.wrapping.push(owner.attribute("name").unwrap_or(owner.name()).to_owned());
        }
    }
    Ok(())
}

/// A model in one posture.
struct Posed<'d, 'm> {
    frames: &'m Frames<'d>,
    model: &'m Model,
    pose: &'m Pose,
    bodies: Vec<Affine>,
    surfaces: HashMap<&'d str, Surface>,
}

/// A surface that muscles wrap.
#[derive(Clone, Copy, Debug)]
struct Surface {
    in_world: Affine,
    shape: Shape,
    /// Whether a path has to pass on one side, so that it may wrap without being met.
    one_sided: bool,
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    /// Around z.
    Cylinder {
        radius: f64,
    },
    Ellipsoid {
        radii: Vec3,
    },
    /// One that muscles wrap in ways that are not told apart.
    Other,
}

impl<'d> Posed<'d, '_> {
    fn world(&self, base: crate::opensim::model::Base) -> Affine {
        let place = base.and_then(|id| self.bodies.get(id.index()).copied());
        place.unwrap_or(Affine::IDENTITY)
    }

    fn surface(&self, part: Element<'d>) -> Result<Option<Surface>, Error> {
        let number = |name: &str| part.child_f64(name).map(|x| x.unwrap_or(0.0));
        let shape = match part.name() {
            "WrapCylinder" => Shape::Cylinder { radius: number("radius")? },
            "WrapSphere" => {
                let radius = number("radius")?;
                Shape::Ellipsoid { radii: Vec3::new(radius, radius, radius) }
            }
            "WrapEllipsoid" => Shape::Ellipsoid { radii: triple(part, "dimensions")? },
            "WrapTorus" => Shape::Other,
            _ => return Ok(None),
        };
        let mut here = part.parent();
        while let Some(element) = here {
            if let Some((base, frame)) = self.frames.at(element)? {
                let turn = triple(part, "xyz_body_rotation")?.to_array();
                let own = Affine::new(EulerOrder::XYZ.to_mat3(turn), triple(part, "translation")?);
                let side = part.child_text("quadrant").unwrap_or("all");
                let one_sided = !matches!(side, "all" | "Unassigned");
                let in_world = self.world(base) * frame * own;
                return Ok(Some(Surface { in_world, shape, one_sided }));
            }
            here = element.parent();
        }
        Ok(None)
    }

    /// The length of a path, and whether it meets a surface that it wraps.
    fn path(&self, owner: Element<'d>) -> Result<(f64, bool), Error> {
        let path = owner.children().find(|e| e.is("GeometryPath"));
        let holder = path.unwrap_or(owner);
        let within = |names: [&str; 2]| {
            let set = names.into_iter().find_map(|name| holder.child(name));
            set.map(|set| set.child("objects").unwrap_or(set))
        };
        let mut points = vec![];
        for point in within(["PathPointSet", "MusclePointSet"]).iter().flat_map(|s| s.children()) {
            points.extend(self.point(point)?);
        }
        let pairs = || points.iter().zip(points.iter().skip(1));
        let length = pairs().map(|(a, b)| (*a - *b).norm()).sum();
        let mut wraps = false;
        for wrap in within(["PathWrapSet", "MuscleWrapSet"]).iter().flat_map(|s| s.children()) {
            let surface = wrap.child_text("wrap_object").and_then(|name| self.surfaces.get(name));
            wraps |= surface.is_some_and(|surface| pairs().any(|(a, b)| surface.meets(*a, *b)));
        }
        Ok((length, wraps))
    }

    /// Where a point of a path is; none of one that does not count in this posture.
    fn point(&self, point: Element<'d>) -> Result<Option<Vec3>, Error> {
        let is_point = [
            "PathPoint",
            "ConditionalPathPoint",
            "MovingPathPoint",
            "MusclePoint",
            "MuscleViaPoint",
            "MovingMusclePoint",
        ];
        if !is_point.contains(&point.name()) {
            return Ok(None);
        }
        if matches!(point.name(), "ConditionalPathPoint" | "MuscleViaPoint")
            && let Some([low, high]) = point.child_numbers::<2>("range")?
            && let Some(value) = self.value(point, &["coordinate", "coordinates"])
            && !(low - TOLERANCE..=high + TOLERANCE).contains(&value)
        {
            return Ok(None);
        }
        let (base, frame) = self.frames.of_part(point, POINT_FRAME)?;
        let mut local = triple(point, "location")?.to_array();
        if matches!(point.name(), "MovingPathPoint" | "MovingMusclePoint") {
            for (axis, (new, old)) in MOVING.iter().enumerate() {
                let Some(holder) = point.child(new).or_else(|| point.child(old)) else { continue };
                let name = format!("{}_coordinate", ["x", "y", "z"][axis]);
                let at = self.value(point, &[&name]).unwrap_or(0.0);
                if let Some(AnyFunction::One(function)) = function::inside(holder)? {
                    local[axis] = function.value_and_slope(at).0;
                }
            }
        }
        Ok(Some(self.world(base) * (frame * Vec3::from(local))))
    }

    /// The value of the coordinate that a part names.
    fn value(&self, part: Element<'d>, names: &[&str]) -> Option<f64> {
        let socket = names.iter().find_map(|name| Frames::socket(part, name));
        let plain = || names.iter().find_map(|name| part.child(name));
        let path = socket.or_else(plain)?.text();
        let mut words = path.rsplit('/');
        let name = words.next()?;
        let joint = words.next().unwrap_or_default();
        let exact = self.model.find_coordinate(&format!("{joint}/{name}"));
        let id = exact.or_else(|_| self.model.find_coordinate(name)).ok()?;
        self.pose.coordinate(self.model, id).first().copied()
    }
}

impl Surface {
    /// Whether the line between two places enters the surface, or may be led around it.
    fn meets(&self, a: Vec3, b: Vec3) -> bool {
        if self.one_sided {
            return true;
        }
        let back = self.in_world.rigid_inverse();
        let (a, b) = (back * a, back * b);
        match self.shape {
            Shape::Other => true,
            // Its ends are left out of account: OpenSim wraps a little beyond them.
            Shape::Cylinder { radius } => {
                let flat = |p: Vec3| Vec3::new(p.x, p.y, 0.0);
                nearest(flat(a), flat(b)).norm() < radius
            }
            Shape::Ellipsoid { radii } => {
                let unit = |p: Vec3| Vec3::new(p.x / radii.x, p.y / radii.y, p.z / radii.z);
                nearest(unit(a), unit(b)).norm() < 1.0
            }
        }
    }
}

/// The place on the line between two points that is nearest to the origin.
fn nearest(a: Vec3, b: Vec3) -> Vec3 {
    let along = b - a;
    let squared = along.norm_squared();
    let share = if squared > 0.0 { (-a.dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
    a + along * share
}
