"""Loads a written .osim in OpenSim and compares its bodies with the model that was written.

    python osim.py FILE.osim [KEEP]      (FILE.osim.json beside it, from the example `written` of the facade)

Only coordinates that nothing determines are set; all others follow from the file, by the functions of its couplers as
OpenSim evaluates them. Prints one line of JSON: the largest differences in mm, degrees and percent of stretch
(`follows`; `all_given`, where every joint is set from the model, is the same where what is fitted is set, too), bodies
beyond 0.5 mm or 0.1 degrees, how far OpenSim's own assembly is from the couplers' values (`assembled`), and the
bodies at the first KEEP poses (none).
"""

import json
import sys

import numpy as np
import opensim as osim

import common


def main(path, keep):
    osim.Logger.setLevelString("Error")
    answer = common.read(path)
    model = osim.Model(path)
    state = model.initSystem()
    coordinates = {c.getName(): osim.Coordinate.safeDownCast(c) for c in model.getComponentsList()
                   if c.getConcreteClassName() == "Coordinate"}
    missing = set(answer["poses"][0]["joints"]) ^ set(coordinates)
    assert not missing, missing
    couplings = []
    constraints = model.getConstraintSet()
    for i in range(constraints.getSize()):
        coupler = osim.CoordinateCouplerConstraint.safeDownCast(constraints.get(i))
        if coupler is not None:
            names = coupler.getIndependentCoordinateNames()
            names = [names.get(k) for k in range(names.getSize())]
            function = coupler.getFunction()

            def value(inputs, function=function):
                vector = osim.Vector(len(inputs), 0.0)
                for k, x in enumerate(inputs):
                    vector.set(k, x)
                return function.calcValue(vector)

            couplings.append((coupler.getDependentCoordinateName(), names, value))
    locked = {n: c.getDefaultValue() for n, c in coordinates.items() if c.getLocked(state)}
    following = {name for name, *_ in couplings} | set(locked)
    given = [n for n in coordinates if n not in following]
    bodies = model.getBodySet()

    def transforms(state, names):
        model.realizePosition(state)
        found = {}
        for name in names:
            transform = bodies.get(name).getTransformInGround(state)
            r, p = transform.R(), transform.p()
            found[name] = np.array([[r.get(i, j) for j in range(3)] + [p.get(i)] for i in range(3)])
        return found

    def put(state, values):
        for name, value in values.items():
            coordinate = coordinates[name]
            if coordinate.getLocked(state):
                coordinate.setLocked(state, False)
            if coordinate.getClamped(state):
                coordinate.setClamped(state, False)
            coordinate.setValue(state, value, False)

    def place(pose, only):
        values = pose["joints"]
        if only:
            values = common.chain(couplings, {**locked, **{n: values[n] for n in given}})
        put(state, values)
        return transforms(state, pose["true"])

    result = common.run(f"OpenSim {osim.GetVersion()}", answer, given, place, keep)
    # OpenSim's own assembly, from the couplers' values of the pose before.
    assembled = common.Largest()
    for before, pose in zip(answer["poses"], answer["poses"][1:4]):
        wanted = place(pose, True)
        here = model.initSystem()
        start = common.chain(couplings, {**locked, **{n: before["joints"][n] for n in given}})
        put(here, {**start, **{n: pose["joints"][n] for n in given}})
        for name in given:
            coordinates[name].setLocked(here, True)
        try:
            model.assemble(here)
        except RuntimeError as error:
            result["assembled"] = str(error)[:80]
            break
        for name, rows in transforms(here, pose["true"]).items():
            assembled.add(name, rows, wanted[name])
    result.setdefault("assembled", assembled.rounded())
    result.update(couplings=len(couplings), free=0)
    print(json.dumps(result))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 0)
