"""What Blender shows of a GLB of condyle: the largest distance of a corner from where condyle has it.

    python blender.py SCENE.glb POINTS.json [OUT.json]

SCENE.glb is `condyle convert MODEL MOTION SCENE.glb`, POINTS.json what the example `surface_points` prints for the
same model and motion. Blender poses the armature that it read and deforms the mesh by it; corners are compared with
the nearest of condyle's, frame by frame. Needs `pip install bpy==5.0.1 numpy`.
"""

import json
import sys

import bpy
import numpy as np
from mathutils.kdtree import KDTree

scene_path, points_path = sys.argv[1:3]
ours = json.load(open(points_path))

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = 100
bpy.ops.import_scene.gltf(filepath=scene_path)
meshes = [o for o in bpy.data.objects if o.type == "MESH" and any(m.type == "ARMATURE" for m in o.modifiers)]
armatures = [o for o in bpy.data.objects if o.type == "ARMATURE"]
assert len(meshes) == 1 and len(armatures) == 1, (meshes, armatures)

worst, moved = 0.0, 0.0
first = None
scene = bpy.context.scene
for frame, points in enumerate(ours):
    scene.frame_set(frame)
    evaluated = meshes[0].evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    co = np.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", co)
    matrix = np.array(evaluated.matrix_world)
    co = co.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    # Blender has z up: (x, y, z) of glTF is (x, -z, y) there.
    shown = np.column_stack([co[:, 0], co[:, 2], -co[:, 1]])
    tree = KDTree(len(points))
    for i, p in enumerate(points):
        tree.insert(p, i)
    tree.balance()
    worst = max(worst, max(tree.find(p)[2] for p in shown))
    first = shown if first is None else first
    moved = max(moved, float(np.abs(shown - first).max()))

result = {
    "blender": bpy.app.version_string,
    "frames": len(ours),
    "corners": len(ours[0]),
    "bones": len(armatures[0].data.bones),
    "largest_distance_m": round(worst, 9),
    "largest_motion_m": round(moved, 4),
}
print(json.dumps(result))
if len(sys.argv) > 3:
    json.dump(result, open(sys.argv[3], "w"), indent=1)
