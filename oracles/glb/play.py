"""Whether Blender plays a glTF file with its joints where the formulas of `evaluate.py` have them.

    python play.py FILE.glb...         python being one that has bpy and numpy

For each animation of each file, at every key of it (at most 40 of them): the largest distance of the head of a bone in Blender
from the place of its joint.
"""
import os
import sys

import bpy
import numpy as np

from evaluate import accessor, load, places


def played(path):
    data = open(path, "rb").read()
    root, buffers = load(data, os.path.dirname(path) or ".")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path)
    scene = bpy.context.scene
    rig = next(o for o in bpy.data.objects if o.type == "ARMATURE")
    rate = scene.render.fps / scene.render.fps_base
    for index, animation in enumerate(root["animations"]):
        # The action itself: strips of Blender begin at frame 1.
        tracks = {t.name: t.strips[0] for t in rig.animation_data.nla_tracks}
        strip = tracks.get(animation.get("name")) or list(tracks.values())[index]
        for track in rig.animation_data.nla_tracks:
            track.mute = True
        rig.animation_data.action = strip.action
        rig.animation_data.action_slot = strip.action_slot
        clocks = [accessor(root, buffers, s["input"])[:, 0] for s in animation["samplers"]]
        keys = np.unique(np.concatenate(clocks))
        keys = keys[:: max(1, len(keys) // 40)]
        far, joints = 0.0, 0
        for t in keys:
            frame = t * rate
            scene.frame_set(int(frame), subframe=frame - int(frame))
            expected = places(root, buffers, index, float(t))
            for name, place in expected.items():
                bone = rig.pose.bones.get(name)
                if bone is None:
                    continue
                x, y, z = rig.matrix_world @ bone.head
                far = max(far, float(np.linalg.norm(np.array([x, z, -y]) - place)))
                joints += 1
        print(f"{os.path.basename(path)} {animation.get('name', index + 1)}: {len(keys)} keys, {joints} places, largest distance {far:.2e} m")


for path in sys.argv[1:]:
    played(path)
