"""What Blender does with the driver that `condyle transfer --blender` writes: where a bone is in 20 poses.

    python blender.py figure > figure.toml       the figure as a document of condyle, its bones rolled at random
    condyle transfer law.toml --onto figure.toml --landmarks landmarks.toml -o carried.toml --blender driver.py
    python blender.py answers driver.py > answers.json

Needs `bpy`. The armature is built from heads, tails and rolls; nothing of condyle but the driver is used.
"""

import json
import math
import random
import sys

import bpy
from mathutils import Matrix, Quaternion, Vector

HIP, KNEE, ANKLE = Vector((0.1, 0.02, 0.9)), Vector((0.12, -0.01, 0.49)), Vector((0.11, 0.03, 0.08))


def armature():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    data = bpy.data.armatures.new("figure")
    made = bpy.data.objects.new("figure", data)
    bpy.context.collection.objects.link(made)
    bpy.context.view_layer.objects.active = made
    bpy.ops.object.mode_set(mode="EDIT")
    thigh = data.edit_bones.new("thigh")
    thigh.head, thigh.tail, thigh.roll = HIP, KNEE, 0.7
    shank = data.edit_bones.new("shank")
    shank.head, shank.tail, shank.roll = KNEE, ANKLE, -1.9
    shank.parent, shank.use_connect = thigh, True
    bpy.ops.object.mode_set(mode="OBJECT")
    return made


def rows(matrix):
    return [[float(x) for x in row] for row in matrix]


def figure(made):
    # Blender's z is up; condyle's y.
    turned = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))
    thigh = turned @ made.data.bones["thigh"].matrix_local
    shank = made.data.bones["thigh"].matrix_local.inverted() @ made.data.bones["shank"].matrix_local
    print('condyle = 1\nkind = "model"\nname = "figure"\n')
    for name, parent, matrix in (("thigh", None, thigh), ("shank", "thigh", shank)):
        # Blender has single precision: the matrix is made a rotation.
        linear = matrix.to_3x3()
        x = linear.col[0].normalized()
        print(f"[segment.{name}]")
        if parent:
            print(f'parent = "{parent}"')
        x, y = [list(map(float, linear.col[i])) for i in (0, 1)]
        size = math.sqrt(sum(a * a for a in x))
        x = [a / size for a in x]
        dot = sum(a * b for a, b in zip(x, y))
        y = [b - dot * a for a, b in zip(x, y)]
        size = math.sqrt(sum(a * a for a in y))
        y = [a / size for a in y]
        z = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]
        print(f"at = {[float(v) for v in matrix.translation]}")
        print(f"matrix = {[[x[i], y[i], z[i]] for i in range(3)]}\n")
    print('[joint.hip]\nsegment = "thigh"\ntype = "hinge"\naxis = [1, 0, 0]\ncoordinates = ["hip_flexion"]\n')
    print('[joint.knee]\nsegment = "shank"\ntype = "ball"')


def answers(made, driver):
    exec(compile(open(driver).read(), driver, "exec"), {"__name__": "driver"})
    dice = random.Random(4)
    poses = []
    for _ in range(20):
        angle = lambda most: dice.uniform(-most, most)
        turn = Quaternion((1, 0, 0), angle(1.2)) @ Quaternion((0, 1, 0), angle(0.4)) @ Quaternion((0, 0, 1), angle(0.6))
        hip = angle(1.0)
        made.pose.bones["shank"].rotation_quaternion = turn
        made["hip_flexion"] = hip
        made.update_tag()
        bpy.context.view_layer.update()
        seen = made.evaluated_get(bpy.context.evaluated_depsgraph_get())
        inside = seen.pose.bones["thigh"].matrix.inverted() @ seen.pose.bones["shank"].matrix
        poses.append({"quaternion": [turn.x, turn.y, turn.z, turn.w], "hip": hip, "shank_in_thigh": rows(inside)})
    json.dump({"blender": bpy.app.version_string, "poses": poses}, sys.stdout, indent=1)


if __name__ == "__main__":
    if sys.argv[1] == "figure":
        figure(armature())
    else:
        answers(armature(), sys.argv[2])
