"""What OpenSim's ScaleTool makes of parts.osim: every number of the scaled file, by the names around it.

    python oracles/scale/answers.py oracles/scale/parts.osim > oracles/scale/parts.json

Needs OpenSim 4.6 for Python. A key is the classes and names of the elements around a number, without
sets and other containers; see `key` below, which tests/opensim_scale.rs has too.
"""

import json
import os
import sys
import tempfile

import opensim
from sweep import by_opensim, factors, tree

opensim.Logger.setLevelString("Off")
CONTAINERS = {"objects", "frames", "components", "function", "SpatialTransform", "attached_geometry", "GeometryPath", "coordinates",
              "OpenSimDocument", "Model"}
# What says nothing about lengths, or is added by OpenSim.
OUTSIDE = {"FrameGeometry", "defaults", "gravity", "credits", "publications", "WrapDoublePendulum"}


def numbers(text):
    try:
        return [float(word) for word in text.split()]
    except ValueError:
        return None


def collect(node, path, found):
    if node.tag in OUTSIDE:
        return
    if node.tag not in CONTAINERS and not node.tag.endswith("Set"):
        name = node.get("name") if not node.tag.endswith(("Function", "Spline")) and node.tag != "Constant" else None
        path = path + [node.tag + (f":{name}" if name else "")]
    if len(node) == 0:
        values = numbers(node.text or "")
        if values:
            found["/".join(path)] = values
    for child in node:
        collect(child, path, found)


def main():
    path = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        before, after = f"{folder}/before.osim", f"{folder}/after.osim"
        model = opensim.Model(path)
        model.initSystem()
        model.printToXML(before)
        names = by_opensim(path, after)
        lists = []
        for file in (before, after):
            found = {}
            collect(tree(file), [], found)
            lists.append(found)
    grown = {k: v for k, v in lists[1].items() if lists[0].get(k) != v}
    same = [k for k, v in lists[0].items() if lists[1].get(k) == v]
    answer = {"mass": 60.0, "factors": {n: factors(i) for i, n in enumerate(names)}, "scaled": grown, "left": same}
    json.dump(answer, sys.stdout, indent=0)
    print()


if __name__ == "__main__":
    main()
