"""Opens a written .usda with usd-core, validates it and compares its joints with the model that was written.

    python usd.py FILE.usda [KEEP]      (FILE.usda.json beside it, from the example `written` of the facade)

Prints one line of JSON: the largest differences over all frames in mm, degrees and percent of stretch (`follows`), that
of the rest pose from the bind transforms (`rest`), what the validators find (`errors`), and the joints at the first KEEP
frames (none).
"""

import json
import sys

import numpy as np
from pxr import Usd, UsdGeom, UsdSkel

import common

try:
    from pxr import UsdValidation
except ImportError:
    UsdValidation = None


def rows(matrix):
    return np.array(matrix).T[:3]


def main(path, keep):
    answer = common.read(path)
    stage = Usd.Stage.Open(path)
    errors = []
    if UsdValidation is not None:
        registry = UsdValidation.ValidationRegistry()
        context = UsdValidation.ValidationContext(registry.GetOrLoadAllValidators())
        errors = [e.GetMessage() for e in context.Validate(stage)]
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    root = UsdSkel.Root(stage.GetDefaultPrim())
    cache = UsdSkel.Cache()
    cache.Populate(root, Usd.PrimDefaultPredicate)
    skeleton = next(UsdSkel.Skeleton(p) for p in stage.Traverse() if p.IsA(UsdSkel.Skeleton))
    query = cache.GetSkelQuery(skeleton)
    names = [str(j).split("/")[-1] for j in query.GetJointOrder()]
    rest = common.Largest()
    for name, bind, at_rest in zip(names, query.GetJointWorldBindTransforms(), query.ComputeJointSkelTransforms(0, True)):
        rest.add(name, rows(bind), rows(at_rest))
    frames = {id(pose): frame for frame, pose in enumerate(answer["poses"])}

    def place(pose, _):
        return dict(zip(names, map(rows, query.ComputeJointSkelTransforms(frames[id(pose)]))))

    for pose in answer["poses"]:
        pose["joints"] = {}
    answer["base"] = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
    result = common.run("usd-core " + ".".join(map(str, Usd.GetVersion()[1:])), answer, [], place, keep)
    result.update(rest=rest.rounded(), errors=errors, up=UsdGeom.GetStageUpAxis(stage), couplings=0)
    print(json.dumps(result))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 0)
