"""Opens a written .usda with usd-core, validates it and compares its joints with what a model says.

    python usd.py FILE.usda      (FILE.usda.json beside it, from the example `written`)

Prints one line of JSON: the largest difference in mm and degrees over all frames (`true`), that of the rest pose from
the bind transforms (`rest`), and what the validators find (`errors`).
"""

import json
import sys

import numpy as np
from pxr import Usd, UsdGeom, UsdSkel

try:
    from pxr import UsdValidation
except ImportError:
    UsdValidation = None


def difference(a, b):
    turn = a[:, :3].T @ b[:, :3]
    angle = np.degrees(2 * np.arcsin(min(1.0, np.linalg.norm(turn - np.eye(3)) / np.sqrt(8))))
    return 1e3 * np.linalg.norm(a[:, 3] - b[:, 3]), angle


def rows(matrix):
    return np.array(matrix).T[:3]


def main(path):
    with open(path + ".json") as file:
        answer = json.load(file)
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
    bind = [rows(m) for m in query.GetJointWorldBindTransforms()]
    rest = [rows(m) for m in query.ComputeJointSkelTransforms(0, True)]
    at_rest = np.max([difference(a, b) for a, b in zip(bind, rest)], axis=0).tolist()
    worst = [0.0, 0.0]
    for frame, pose in enumerate(answer["poses"]):
        found = [rows(m) for m in query.ComputeJointSkelTransforms(frame)]
        for name, transform in zip(names, found):
            mm, degrees = difference(np.reshape(pose["true"][name], (3, 4)), transform)
            worst = [max(worst[0], mm), max(worst[1], degrees)]
    print(json.dumps({"true": worst, "rest": at_rest, "errors": errors, "up": UsdGeom.GetStageUpAxis(stage), "joints": len(names), "poses": len(answer["poses"])}))


if __name__ == "__main__":
    main(sys.argv[1])
