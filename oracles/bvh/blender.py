"""World positions of all joints of BVH files as Blender has them.

    python blender.py DATA positions.json

needs `pip install bpy` (5.0.1). DATA is the folder of test data. Each file is imported without scale and with
its own axes, and the heads of all bones are written for twelve frames, in the units of the file. Blender
computes in single precision.
"""

import json
import sys
from pathlib import Path

import bpy


def positions(path, count=12):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_anim.bvh(
        filepath=str(path), global_scale=1.0, axis_forward="Y", axis_up="Z",
        use_fps_scale=False, rotate_mode="NATIVE", update_scene_fps=False, update_scene_duration=True,
    )
    figure = bpy.context.object
    last = int(figure.animation_data.action.frame_range[1])
    frames = sorted({round(i * (last - 1) / (count - 1)) for i in range(count)})
    answer = {"frames": frames, "joints": {}}
    for frame in frames:
        bpy.context.scene.frame_set(frame + 1)
        bpy.context.view_layer.update()
        for bone in figure.pose.bones:
            head = figure.matrix_world @ bone.head
            row = [float(f"{x:.8g}") for x in head]
            answer["joints"].setdefault(bone.name, []).append(row)
    return answer


def main():
    data, out = Path(sys.argv[1]), Path(sys.argv[2])
    answers = {"blender": bpy.app.version_string, "files": {}}
    for path in sorted(data.rglob("*.bvh")):
        answers["files"][str(path.relative_to(data))] = positions(path)
    # A file of this project with every order, and positions anywhere. (Blender refuses joints with fewer than
    # three rotations.)
    answers["files"]["mixed.bvh"] = positions(Path(__file__).with_name("mixed.bvh"))
    text = json.dumps(answers, separators=(",", ":"))
    out.write_text(text.replace('"joints"', '\n"joints"').replace("]],", "]],\n") + "\n")


main()
