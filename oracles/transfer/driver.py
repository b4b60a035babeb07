# A learned law as drivers: bone shank travels when it turns.
# Run it in Blender with the armature selected, or set ARMATURE. Metres and radians.
# After a file is opened again it has to run again: keep it as a text of the file and tick Register.
import bpy
from math import asin, atan2
from mathutils import Matrix, Quaternion, Vector

ARMATURE = None  # the name of the armature; the active object, or the first that has the bones
PARENT, CHILD = "thigh", "shank"
# Landmarks in Blender's world while the armature rests.
ORIGIN, MEDIAL, LATERAL = Vector((0.17000000149011613, 0.009999999552965162, 0.9199999761581421)), Vector((0.06999998194624157, -0.01999999477476637, 0.500000086043298)), Vector((0.16999998194624158, -0.009999994774766378, 0.480000086043298))
LEFT = False
# From the landmarks' axes into those of the law.
TO_LAW = Matrix(((1.0, 0.0, 5.551115123125783e-17), (0.0, 0.9999999999999999, 1.3877787807814457e-17), (5.551115123125783e-17, 1.3877787807814457e-17, 1.0000000000000002)))
FIXED = Vector((-0.0, -0.0, -0.0))


def law_centre(flexion, adduction, rotation, hip):
    """The joint's centre in the landmarks' axes."""
    slide_0 = 0.0 + 0.002098973615331391 * adduction + 0.008395894461325564 * flexion + (-0.003148460422997086) * rotation + 0.004197947230662782 * hip  # tx
    slide_1 = (-0.44045420088152687) + 0.0010742785387354314 * adduction + (-0.006445671232412589) * flexion + 0.0021485570774708628 * rotation + (-0.0032228356162062946) * hip  # ty
    slide_2 = (-0.05123475382979799) + 0.004098780306383839 * adduction + (-0.0020493901531919195) * flexion + 0.003074085229787879 * rotation + 0.0020493901531919195 * hip  # tz
    return FIXED + slide_0 * Vector((1.0, 0.0, 0.0)) + slide_1 * Vector((0.0, 1.0, 0.0)) + slide_2 * Vector((0.0, 0.0, 1.0))


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
    middle = max(-1.0, min(1.0, 1.0 * r[2][1]))
    return (atan2(-1.0 * r[0][1], r[1][1]), asin(middle), atan2(-1.0 * r[2][0], r[2][2]))


def location(axis, qw, qx, qy, qz, hip):
    centre = law_centre(*angles(Quaternion((qw, qx, qy, qz))), hip)
    place = origin + axes @ centre / unit
    return (turn.transposed() @ (place - rest.translation))[axis]


name = "law_shank"
bpy.app.driver_namespace[name] = location
armature.pose.bones[CHILD].rotation_mode = "QUATERNION"
bone = armature.pose.bones[LAW]
for axis in range(3):
    bone.driver_remove("location", axis)
    driver = bone.driver_add("location", axis).driver
    driver.type = "SCRIPTED"
    variables = [("qwxyz"[0] + "wxyz"[n], 'pose.bones["%s"].rotation_quaternion[%d]' % (CHILD, n)) for n in range(4)]
    armature["hip_flexion"] = armature.get("hip_flexion", 0.0)
    variables.append(("hip", '["hip_flexion"]'))
    for variable, path in variables:
        made = driver.variables.new()
        made.name = variable
        made.targets[0].id = armature
        made.targets[0].data_path = path
    driver.expression = "%s(%d, %s)" % (name, axis, ", ".join(variable for variable, _ in variables))
