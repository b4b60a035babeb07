//! A law as a driver script for Blender: the engine evaluates it when a bone turns (Pronost et al. 2010, 4.2).

use super::Ready;
use super::expressions::{expression, identifier};
use condyle_learn::transfer::Driver;
use condyle_math::Vec3;
use condyle_model::{Model, UpAxis};
use std::fmt::Write;

/// A script for Blender that lets a bone of an armature travel by a law when it turns. It finds the landmarks, the frames and the two rotations
/// itself from the armature's rest pose, so that it does not matter how Blender's importer turns bones.
///
/// # Errors
/// What is wrong with a law of splines, or an order in which the first axis is the last, as a message.
pub fn blender_driver(ready: &Ready, model: &Model) -> Result<String, String> {
    let t = &ready.transfer;
    let segment = model.segment(ready.standing.segment);
    let child = &segment.name;
    let Some(parent) = segment.parent.map(|id| &model.segment(id).name) else {
        return Err(format!("`{child}` has no parent bone"));
    };
    let [i, j, k] = t.order.axes();
    if i == k {
        return Err("a driver needs an order of three different axes".to_owned());
    }
    if t.turned.iter().any(Option::is_some) {
        return Err("angles that follow others are not written as a driver".to_owned());
    }
    let names: Vec<String> = t
        .drivers
        .iter()
        .zip(&t.controls)
        .map(|(driver, control)| match driver {
            Driver::Angle(k) => identifier(&t.angles[*k]),
            Driver::Coordinate(_) => identifier(control),
        })
        .collect();
    let others: Vec<(&String, &String)> = t
        .drivers
        .iter()
        .zip(&names)
        .filter_map(|(driver, name)| match driver {
            Driver::Coordinate(coordinate) => Some((coordinate, name)),
            Driver::Angle(_) => None,
        })
        .collect();
    // Blender's world has z up, and its importers turn y to it.
    let world = |point: Vec3| {
        let p = ready.standing.parent * point;
        let [x, y, z] = match model.up() {
            UpAxis::Z => [p.x, p.y, p.z],
            UpAxis::Y => [p.x, -p.z, p.y],
        };
        format!("({x:?}, {y:?}, {z:?})")
    };
    let [origin, medial, lateral] = ready.standing.landmarks.points().map(world);
    let to_law = t.to_law[0] * t.frame.linear;
    let row =
        |r: usize| format!("({:?}, {:?}, {:?})", to_law.at(r, 0), to_law.at(r, 1), to_law.at(r, 2));
    let left = if ready.standing.landmarks.left { "True" } else { "False" };
    let mut out = String::new();
    let _ = write!(
        out,
        r#"# A learned law as drivers: bone {child} travels when it turns.
# Run it in Blender with the armature selected, or set ARMATURE. Metres and radians.
# After a file is opened again it has to run again: keep it as a text of the file and tick Register.
import bpy
from math import asin, atan2
from mathutils import Matrix, Quaternion, Vector

ARMATURE = None  # the name of the armature; the active object, or the first that has the bones
PARENT, CHILD = {parent:?}, {child:?}
# Landmarks in Blender's world while the armature rests.
ORIGIN, MEDIAL, LATERAL = Vector({origin}), Vector({medial}), Vector({lateral})
LEFT = {left}
# From the landmarks' axes into those of the law.
TO_LAW = Matrix(({}, {}, {}))
FIXED = Vector(({:?}, {:?}, {:?}))


def law_centre({}):
    """The joint's centre in the landmarks' axes."""
"#,
        row(0),
        row(1),
        row(2),
        t.fixed.x,
        t.fixed.y,
        t.fixed.z,
        {
            let mut all: Vec<String> = t.angles.iter().map(|name| identifier(name)).collect();
            all.extend(others.iter().map(|(_, name)| (*name).clone()));
            all.join(", ")
        },
    );
    let mut sum = vec!["FIXED".to_owned()];
    for (number, slide) in t.slides.iter().enumerate() {
        let law = expression(&slide.law, &names)?;
        let _ = writeln!(out, "    slide_{number} = {law}  # {}", slide.name);
        let v = slide.along;
        sum.push(format!("slide_{number} * Vector(({:?}, {:?}, {:?}))", v.x, v.y, v.z));
    }
    let parity = if (i + 1) % 3 == j { 1.0 } else { -1.0 };
    let extra: String = others.iter().map(|(_, name)| format!(", {name}")).collect();
    let _ = write!(
        out,
        r#"    return {sum}


def find_armature():
    if ARMATURE:
        return bpy.data.objects[ARMATURE]
    has = lambda o: o is not None and o.type == "ARMATURE" and PARENT in o.data.bones and CHILD in o.data.bones
    active = bpy.context.view_layer.objects.active
    return active if has(active) else next(o for o in bpy.data.objects if has(o))


armature = find_armature()
bpy.context.view_layer.objects.active = armature
# A bone between the two carries the travel: a bone cannot follow its own rotation without going in circles.
LAW = CHILD + "_law"
bpy.ops.object.mode_set(mode="EDIT")
bones = armature.data.edit_bones
if LAW not in bones:
    between = bones.new(LAW)
    between.length = bones[CHILD].length
    between.matrix = bones[CHILD].matrix
    between.use_deform = False
    between.parent = bones[PARENT]
    bones[CHILD].use_connect = False
    bones[CHILD].parent = between
bpy.ops.object.mode_set(mode="OBJECT")

unit = armature.matrix_world.median_scale
rest_parent = armature.data.bones[PARENT].matrix_local
rest_child = armature.data.bones[CHILD].matrix_local
rest = rest_parent.inverted() @ rest_child
turn = rest.to_3x3()
inside = (armature.matrix_world @ rest_parent).inverted()
origin, medial, lateral = (inside @ p for p in (ORIGIN, MEDIAL, LATERAL))
z = ((medial - lateral) if LEFT else (lateral - medial)).normalized()
y = origin - (medial + lateral) / 2
y = (y - z * z.dot(y)).normalized()
axes = Matrix((y.cross(z), y, z)).transposed()
a = TO_LAW @ axes.transposed()


def angles(quaternion):
    """The angles of the law for the rotation of the bone."""
    r = a @ turn @ quaternion.normalized().to_matrix() @ turn.transposed() @ a.transposed()
    middle = max(-1.0, min(1.0, {parity:?} * r[{i}][{k}]))
    return (atan2(-{parity:?} * r[{j}][{k}], r[{k}][{k}]), asin(middle), atan2(-{parity:?} * r[{i}][{j}], r[{i}][{i}]))


def location(axis, qw, qx, qy, qz{extra}):
    centre = law_centre(*angles(Quaternion((qw, qx, qy, qz))){extra})
    place = origin + axes @ centre / unit
    return (turn.transposed() @ (place - rest.translation))[axis]


name = "law_{function}"
bpy.app.driver_namespace[name] = location
armature.pose.bones[CHILD].rotation_mode = "QUATERNION"
bone = armature.pose.bones[LAW]
for axis in range(3):
    bone.driver_remove("location", axis)
    driver = bone.driver_add("location", axis).driver
    driver.type = "SCRIPTED"
    variables = [("qwxyz"[0] + "wxyz"[n], 'pose.bones["%s"].rotation_quaternion[%d]' % (CHILD, n)) for n in range(4)]
"#,
        sum = sum.join(" + "),
        function = identifier(child),
    );
    for (coordinate, name) in &others {
        // A coordinate of another joint is a property of the armature, to be driven or keyed.
        let _ = writeln!(out, "    armature[{coordinate:?}] = armature.get({coordinate:?}, 0.0)");
        let _ = writeln!(out, "    variables.append(({name:?}, '[\"{coordinate}\"]'))");
    }
    let _ = write!(
        out,
        r#"    for variable, path in variables:
        made = driver.variables.new()
        made.name = variable
        made.targets[0].id = armature
        made.targets[0].data_path = path
    driver.expression = "%s(%d, %s)" % (name, axis, ", ".join(variable for variable, _ in variables))
"#
    );
    Ok(out)
}
