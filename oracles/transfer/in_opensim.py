"""Where OpenSim has the child of a joint that `condyle transfer` put into a model, at random poses, beside where condyle has it.

    python in_opensim.py CONDYLE BEFORE.osim AFTER.osim CHILD PARENT

Prints the largest distance and angle over 100 poses, and what the file had before and has now: muscles, masses, shapes.
"""

import json
import random
import subprocess
import sys
import tempfile

import opensim

opensim.Logger.setLevelString("Error")
condyle, before, after, child, parent = sys.argv[1:]


def parts(path):
    model = opensim.Model(path)
    state = model.initSystem()
    return {
        "muscles": model.getMuscles().getSize(),
        "mass_kg": round(model.getTotalMass(state), 9),
        "shapes": len(list(model.getComponentsList())) and sum(1 for c in model.getComponentsList() if "Mesh" in c.getConcreteClassName()),
        "coordinates": model.getCoordinateSet().getSize(),
        "constraints": model.getConstraintSet().getSize(),
    }


print(json.dumps({"before": parts(before), "after": parts(after)}))
model = opensim.Model(after)
state = model.initSystem()
dice = random.Random(3)
coordinates = [model.getCoordinateSet().get(i) for i in range(model.getCoordinateSet().getSize())]
free = [c for c in coordinates if not c.isConstrained(state)]
poses, seen = [], []
for _ in range(100):
    for c in free:
        if str(c.getMotionType()) == "1" or c.getMotionType() == opensim.Coordinate.Rotational:
            c.setValue(state, dice.uniform(-0.5, 0.5), False)
    model.assemble(state)
    model.realizePosition(state)
    poses.append({c.getName(): c.getValue(state) for c in coordinates})
    bodies = model.getBodySet()
    x = bodies.get(child).findTransformBetween(state, bodies.get(parent))
    r, p = x.R(), x.p()
    seen.append(([[r.get(i, j) for j in range(3)] for i in range(3)], [p.get(i) for i in range(3)]))
with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
    json.dump(poses, file)
    file.flush()
    answer = subprocess.run([condyle, "fk", after, "--pose", file.name, "--json"], capture_output=True, text=True)
frames = json.loads(answer.stdout)["frames"]
worst = [0.0, 0.0]
for frame, (r, p) in zip(frames, seen):
    a, b = frame["segments"][parent], frame["segments"][child]
    ra = [[a[4 * i + j] for j in range(3)] for i in range(3)]
    rb = [[b[4 * i + j] for j in range(3)] for i in range(3)]
    d = [b[4 * i + 3] - a[4 * i + 3] for i in range(3)]
    local = [sum(ra[k][i] * d[k] for k in range(3)) for i in range(3)]
    turned = [[sum(ra[k][i] * rb[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    worst[0] = max(worst[0], max(abs(local[i] - p[i]) for i in range(3)))
    worst[1] = max(worst[1], max(abs(turned[i][j] - r[i][j]) for i in range(3) for j in range(3)))
print(json.dumps({"poses": len(frames), "most_m": worst[0], "most_of_matrix": worst[1]}))
