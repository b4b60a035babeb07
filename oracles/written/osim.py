"""Loads a written .osim in OpenSim and compares its bodies with what the writer says.

    python osim.py FILE.osim      (FILE.osim.json beside it, from the example `written`)

Prints one line of JSON: the largest difference in mm and degrees from what the file says (`said`), from the
model (`true`), and of the couplers' functions from the values that were written (`coupler`).
"""

import json
import sys

import numpy as np
import opensim as osim


def difference(a, b):
    turn = a[:, :3].T @ b[:, :3]
    angle = np.degrees(2 * np.arcsin(min(1.0, np.linalg.norm(turn - np.eye(3)) / np.sqrt(8))))
    return 1e3 * np.linalg.norm(a[:, 3] - b[:, 3]), angle


def main(path):
    osim.Logger.setLevelString("Error")
    with open(path + ".json") as file:
        answer = json.load(file)
    model = osim.Model(path)
    state = model.initSystem()
    coordinates = {c.getName(): c for c in model.getComponentsList() if c.getConcreteClassName() == "Coordinate"}
    coordinates = {n: osim.Coordinate.safeDownCast(c) for n, c in coordinates.items()}
    missing = set(answer["poses"][0]["joints"]) ^ set(coordinates)
    assert not missing, missing
    bodies = model.getBodySet()
    couplers = []
    constraints = model.getConstraintSet()
    for i in range(constraints.getSize()):
        coupler = osim.CoordinateCouplerConstraint.safeDownCast(constraints.get(i))
        if coupler is not None:
            names = coupler.getIndependentCoordinateNames()
            names = [names.get(k) for k in range(names.getSize())]
            couplers.append((coupler.getDependentCoordinateName(), names, coupler.getFunction()))
    worst = {"said": [0.0, 0.0], "true": [0.0, 0.0]}
    coupled = 0.0
    for pose in answer["poses"]:
        joints = pose["joints"]
        for dependent, names, function in couplers:
            vector = osim.Vector(len(names), 0.0)
            for k, name in enumerate(names):
                vector.set(k, joints[name])
            coupled = max(coupled, abs(function.calcValue(vector) - joints[dependent]))
        values = model.getStateVariableNames()
        for name, value in joints.items():
            coordinate = coordinates[name]
            if coordinate.getLocked(state):
                coordinate.setLocked(state, False)
            if coordinate.getClamped(state):
                coordinate.setClamped(state, False)
            coordinate.setValue(state, value, False)
        model.realizePosition(state)
        for name, rows in pose["said"].items():
            transform = bodies.get(name).getTransformInGround(state)
            r, p = transform.R(), transform.p()
            found = np.array([[r.get(i, j) for j in range(3)] + [p.get(i)] for i in range(3)])
            for kind in worst:
                mm, degrees = difference(np.reshape(pose[kind][name], (3, 4)), found)
                worst[kind] = [max(worst[kind][0], mm), max(worst[kind][1], degrees)]
    print(json.dumps({**worst, "coupler": coupled, "poses": len(answer["poses"]), "couplers": len(couplers), "bodies": bodies.getSize()}))


if __name__ == "__main__":
    main(sys.argv[1])
