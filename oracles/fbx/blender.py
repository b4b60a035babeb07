"""Places of the joints of FBX files in Blender: python blender.py DATA > blender.json, with bpy; DATA contains models/fbx.

Blender's importer is written in Python and shares nothing with ufbx. For each file six frames of its first action: times in
seconds from its first frame, and for each bone the place of its head in metres, y up.
"""
import json
import os
import sys

import bpy
from io_scene_fbx import import_fbx

# The importer of 5.0.1 fails at lights where Cycles is absent.
import_fbx.blen_read_light = lambda *rest: bpy.data.lights.new("light", "POINT")


def answer(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.fbx(filepath=path, use_anim=True, ignore_leaf_bones=False, automatic_bone_orientation=False)
    rig = next(o for o in bpy.data.objects if o.type == "ARMATURE")
    scene = bpy.context.scene
    rate = scene.render.fps / scene.render.fps_base
    action = rig.animation_data.action
    first, last = action.frame_range
    frames = []
    for part in range(6):
        frame = round(first + (last - first) * part / 5)
        scene.frame_set(frame)
        joints = {}
        for bone in rig.pose.bones:
            x, y, z = rig.matrix_world @ bone.head
            joints[bone.name] = [round(v, 8) for v in (x, z, -y)]
        # Blender begins at frame 1 what begins at time 0.
        frames.append({"time": (frame - first) / rate, "joints": joints})
    return {"action": action.name, "first": first, "last": last, "rate": rate, "frames": frames}


folder = os.path.join(sys.argv[1], "models", "fbx")
real = os.dup(1)
os.dup2(2, 1)
answers = {name: answer(os.path.join(folder, name)) for name in sorted(os.listdir(folder)) if name.endswith(".fbx")}
os.write(real, (json.dumps(answers, separators=(",", ":")) + "\n").encode())
