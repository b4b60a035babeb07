"""One person: OpenSim's ScaleTool and `condyle scale --as-opensim` by the same setup, then what follows.

    python oracles/scale/subject.py CONDYLE SHARED > oracles/scale/subject.json

The model is SHARED/knee/opencap4/manually_scaled.osim with the translation axes of its right knee turned by
0.6435 rad about z (no public model has oblique ones), first made another size by OpenSim with the factors of
sweep.py, so that there is something to scale; the trial is static1.trc. Measurements give unequal
factors of thighs, shanks and trunk, the pelvis has some by hand. A marker set fixes nine markers.
Afterwards InverseDynamicsTool runs on condyle's model and condyle's motion of walking1.trc. Needs OpenSim
4.6 for Python.
"""

import json
import os
import random
import re
import subprocess
import sys
import tempfile

import opensim
from sweep import by_opensim

opensim.Logger.setLevelString("Off")
FIXED = ["r.ASIS", "L.ASIS", "r.PSIS", "L.PSIS", "r_knee", "r_ankle", "L_knee", "L_ankle", "C7"]
RANGE = (0.5, 2.0)


def write_inputs(folder, shared):
    text = open(f"{shared}/knee/opencap4/manually_scaled.osim").read()
    start = text.index('<CustomJoint name="walker_knee_r">')
    end = text.index("</CustomJoint>", start)
    knee = text[start:end]
    for axis, turned in (("translation1", "0.8 0.6 0"), ("translation2", "-0.6 0.8 0")):
        knee = re.sub(rf'(<TransformAxis name="{axis}">.*?<axis>)[^<]*(</axis>)', rf"\g<1>{turned}\g<2>", knee, flags=re.S)
    text = text[:start] + knee + text[end:]
    open(f"{folder}/first.osim", "w").write(text)
    by_opensim(f"{folder}/first.osim", f"{folder}/generic.osim")
    text = open(f"{folder}/generic.osim").read()
    markers = text[text.index("<MarkerSet") : text.index("</MarkerSet>") + len("</MarkerSet>")]

    def fix(match):
        name = re.search(r'name="([^"]*)"', match[0])[1]
        body = re.sub(r"<fixed>[^<]*</fixed>", "", match[0])
        return body.replace("</Marker>", f"<fixed>{str(name in FIXED).lower()}</fixed></Marker>")

    markers = re.sub(r"<Marker .*?</Marker>", fix, markers, flags=re.S)
    open(f"{folder}/markers.xml", "w").write(f'<?xml version="1.0" encoding="UTF-8" ?>\n<OpenSimDocument Version="40000">{markers}</OpenSimDocument>')
    names = re.findall(r'<Marker name="([^"]*)"', markers)
    trial = os.path.relpath(f"{shared}/knee/opencap4/static1.trc", folder)
    pair = lambda a, b: f"<MarkerPair><markers> {a} {b}</markers></MarkerPair>"

    def measurement(name, pairs, bodies):
        scales = "".join(f'<BodyScale name="{b}"><axes> {axes}</axes></BodyScale>' for b, axes in bodies)
        return f"""<Measurement name="{name}"><apply>true</apply><MarkerPairSet><objects>{"".join(pair(*p) for p in pairs)}</objects></MarkerPairSet>
<BodyScaleSet><objects>{scales}</objects></BodyScaleSet></Measurement>"""

    measurements = "\n".join([
        measurement("thigh", [("R_HJC", "r_knee"), ("L_HJC", "L_knee"), ("r.ASIS", "r_knee")], [("femur_r", "Y"), ("femur_l", "Y")]),
        measurement("knee width", [("r_knee", "r_mknee"), ("L_knee", "L_mknee")], [("femur_r", "X Z"), ("femur_l", "X Z"), ("tibia_r", "X Z"), ("tibia_l", "X Z")]),
        measurement("shank", [("r_knee", "r_ankle"), ("L_knee", "L_ankle")], [("tibia_r", "Y"), ("tibia_l", "Y")]),
        measurement("trunk", [("C7", "r.PSIS"), ("C7", "L.PSIS")], [("torso", "Y")]),
        measurement("shoulders", [("R_Shoulder", "L_Shoulder")], [("torso", "X Z")]),
    ])
    tasks = "".join(
        f'<IKMarkerTask name="{n}"><apply>true</apply><weight>{10 if n in FIXED else 1}</weight></IKMarkerTask>' for n in names
    )
    open(f"{folder}/scale.xml", "w").write(f"""<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="40000"><ScaleTool name="subject4"><mass>72.5</mass><height>-1</height><age>-1</age>
<GenericModelMaker><model_file>generic.osim</model_file><marker_set_file>markers.xml</marker_set_file></GenericModelMaker>
<ModelScaler><apply>true</apply><scaling_order> measurements manualScale</scaling_order>
<MeasurementSet><objects>{measurements}</objects></MeasurementSet>
<ScaleSet><objects><Scale><scales> 0.97 1.08 0.92</scales><segment>pelvis</segment><apply>true</apply></Scale></objects></ScaleSet>
<marker_file>{trial}</marker_file><time_range>{RANGE[0]} {RANGE[1]}</time_range>
<preserve_mass_distribution>false</preserve_mass_distribution>
<output_model_file>scaled.osim</output_model_file><output_scale_file>factors.xml</output_scale_file></ModelScaler>
<MarkerPlacer><apply>true</apply><IKTaskSet><objects>{tasks}
<IKCoordinateTask name="subtalar_angle_r"><apply>true</apply><weight>0.01</weight><value_type>manual_value</value_type><value>0</value></IKCoordinateTask>
</objects></IKTaskSet><marker_file>{trial}</marker_file><time_range>{RANGE[0]} {RANGE[1]}</time_range>
<output_model_file>placed.osim</output_model_file><output_motion_file>pose.mot</output_motion_file>
<max_marker_movement>-1</max_marker_movement></MarkerPlacer></ScaleTool></OpenSimDocument>
""")
    return names


def recorded(shared):
    """The mean of each marker over the time range (metres)."""
    lines = open(f"{shared}/knee/opencap4/static1.trc").read().split("\n")
    labels = lines[3].split("\t")[2::3]
    sums, count = {}, 0
    for line in lines[5:]:
        cells = line.split("\t")
        if len(cells) < 3 or not RANGE[0] - 1e-9 <= float(cells[1]) <= RANGE[1] + 1e-9:
            continue
        count += 1
        for i, label in enumerate(labels):
            row = [float(c) for c in cells[2 + 3 * i : 5 + 3 * i]]
            sums[label] = [a + b for a, b in zip(sums.get(label, [0, 0, 0]), row)]
    return {label: [x / count for x in row] for label, row in sums.items()}


def load(path):
    model = opensim.Model(path)
    return model, model.initSystem()


def coordinates(model):
    names = model.getCoordinateSet()
    return [names.get(i) for i in range(names.getSize())]


def marker_errors(model, state, values, seen):
    for coordinate in coordinates(model):
        if coordinate.getName() in values and not coordinate.getLocked(state):
            coordinate.setValue(state, values[coordinate.getName()], False)
    model.assemble(state)
    model.realizePosition(state)
    markers = model.getMarkerSet()
    errors = {}
    for i in range(markers.getSize()):
        marker = markers.get(i)
        if marker.getName() in seen:
            at = marker.getLocationInGround(state)
            errors[marker.getName()] = sum((at[k] - seen[marker.getName()][k]) ** 2 for k in range(3)) ** 0.5
    return errors


def rms(values):
    values = list(values)
    return (sum(v * v for v in values) / len(values)) ** 0.5


def main():
    condyle, shared = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    answer = {}
    with tempfile.TemporaryDirectory() as folder:
        names = write_inputs(folder, shared)
        here = os.getcwd()
        os.chdir(folder)
        opensim.ScaleTool(f"{folder}/scale.xml").run()
        run = subprocess.run([condyle, "scale", "generic.osim", "--setup", "scale.xml", "--as-opensim", "-o", "ours.osim", "--json"],
                             capture_output=True, text=True)
        report = json.loads(run.stdout)
        # Factors.
        theirs = dict(re.findall(r"<scales>([^<]*)</scales>\s*(?:<!--[^>]*-->\s*)?<segment>([^<]*)<", open("factors.xml").read()))
        theirs = {segment: [float(x) for x in scales.split()] for scales, segment in theirs.items()} if theirs else {}
        text = open("scaled.osim").read()
        unscaled, unscaled_state = load("generic.osim")
        scaled, scaled_state = load("scaled.osim")
        ours, ours_state = load("ours.osim")
        # The factors file holds six digits: those of the meshes hold all.
        worst = 0.0
        answer["factors"] = {}
        for i in range(scaled.getBodySet().getSize()):
            name = scaled.getBodySet().get(i).getName()
            mine = report["bodies"][name]["factors"]
            grown = []
            for model in (unscaled, scaled):
                geometry = model.getBodySet().get(name).getPropertyByName("attached_geometry")
                body = model.getBodySet().get(name)
                grown.append([body.get_attached_geometry(0).get_scale_factors()[k] for k in range(3)] if geometry.size() else None)
            if grown[0]:
                known = [b / a for a, b in zip(*grown)]
                worst = max(worst, max(abs(a - b) for a, b in zip(known, mine)))
                if mine != [1, 1, 1]:
                    answer["factors"][name] = known
        answer["factors: largest difference"] = worst
        # Masses and inertias.
        mass = inertia = centre = 0.0
        for i in range(scaled.getBodySet().getSize()):
            a, b = scaled.getBodySet().get(i), ours.getBodySet().get(i)
            mass = max(mass, abs(a.getMass() - b.getMass()))
            for k in range(3):
                centre = max(centre, abs(a.getMassCenter()[k] - b.getMassCenter()[k]))
                for part in ("getMoments", "getProducts"):
                    x, y = (getattr(body.getInertia(), part)()[k] for body in (a, b))
                    inertia = max(inertia, abs(x - y))
        answer["mass: largest difference (kg)"] = mass
        answer["mass centre: largest difference (m)"] = centre
        answer["inertia: largest difference (kg m2)"] = inertia
        answer["total mass (kg)"] = [m.getTotalMass(s) for m, s in ((scaled, scaled_state), (ours, ours_state))]
        # Transforms at 20 postures.
        rng = random.Random(4)
        far = turned = 0.0
        for _ in range(20):
            for x, y in zip(coordinates(scaled), coordinates(ours)):
                value = rng.uniform(max(x.getRangeMin(), -1.5), min(x.getRangeMax(), 1.5))
                if not x.getLocked(scaled_state):
                    x.setValue(scaled_state, value, False)
                    y.setValue(ours_state, value, False)
            scaled.realizePosition(scaled_state)
            ours.realizePosition(ours_state)
            for i in range(scaled.getBodySet().getSize()):
                a = scaled.getBodySet().get(i).getTransformInGround(scaled_state)
                b = ours.getBodySet().get(i).getTransformInGround(ours_state)
                far = max(far, max(abs(a.p()[k] - b.p()[k]) for k in range(3)))
                turned = max(turned, max(abs(a.R().get(r, c) - b.R().get(r, c)) for r in range(3) for c in range(3)))
        answer["places of bodies at 20 postures: largest difference (m)"] = far
        answer["rotations: largest difference of an element"] = turned
        # Muscles.
        ratios = []
        for i in range(scaled.getMuscles().getSize()):
            a, b = scaled.getMuscles().get(i), ours.getMuscles().get(i)
            ratios.append((abs(b.getOptimalFiberLength() / a.getOptimalFiberLength() - 1), a.getName() in report["wrapping"]))
        answer["muscles"] = len(ratios)
        answer["muscles equal to 1e-6"] = sum(r < 1e-6 for r, _ in ratios)
        answer["muscles off and not named"] = sum(r >= 1e-6 and not named for r, named in ratios)
        answer["fibre length: largest relative difference"] = max(r for r, _ in ratios)
        # Markers in the placed poses: of the markers of the scaled models, before any was moved.
        seen = recorded(shared)
        lines = open("pose.mot").read().split("\n")
        columns, row = next((lines[i].split("\t"), lines[i + 1].split()) for i in range(len(lines)) if lines[i].startswith("time"))
        their_pose = {c.split("/")[-2]: float(v) for c, v in zip(columns, row) if c.endswith("/value")}
        our_pose = {key.split("/")[-1]: value for key, value in report["placed"]["posture"].items()}
        weights = {n: 10 if n in FIXED else 1 for n in names}
        for who, pose in (("OpenSim", their_pose), ("condyle", our_pose)):
            model, state = load("scaled.osim")
            errors = marker_errors(model, state, pose, seen)
            used = {n: e for n, e in errors.items() if n in weights}
            answer[f"placing by {who}"] = {
                "rms of fixed markers (mm)": 1e3 * rms(errors[n] for n in FIXED),
                "rms (mm)": 1e3 * rms(used.values()),
                "objective of markers (m2)": sum(weights[n] * e * e for n, e in used.items()) / sum(weights[n] for n in used),
            }
        # The files themselves, each in its own pose: all markers that were moved lie where they were seen.
        model, state = load("ours.osim")
        errors = marker_errors(model, state, our_pose, seen)
        answer["moved markers in condyle's file: largest distance (m)"] = max(e for n, e in errors.items() if n not in FIXED)
        answer["fixed markers in condyle's file: rms (mm)"] = 1e3 * rms(errors[n] for n in FIXED)
        # On to inverse dynamics.
        subprocess.run([condyle, "track", "ours.osim", f"{shared}/knee/opencap4/walking1.trc", "-o", "walk.mot"], capture_output=True)
        tool = opensim.InverseDynamicsTool()
        tool.setModelFileName("ours.osim")
        tool.setCoordinatesFileName("walk.mot")
        tool.setLowpassCutoffFrequency(6)
        exclude = opensim.ArrayStr()
        exclude.append("Muscles")
        tool.setExcludedForces(exclude)
        table = opensim.TimeSeriesTable("walk.mot")
        times = table.getIndependentColumn()
        tool.setStartTime(times[0])
        tool.setEndTime(times[-1])
        tool.setResultsDir(folder)
        tool.setOutputGenForceFileName("forces.sto")
        answer["InverseDynamicsTool ran"] = bool(tool.run())
        forces = opensim.TimeSeriesTable("forces.sto")
        finite = all(abs(forces.getRowAtIndex(i)[c]) < 1e6 for i in range(forces.getNumRows()) for c in range(forces.getNumColumns()))
        answer["inverse dynamics"] = {"rows": forces.getNumRows(), "columns": forces.getNumColumns(), "finite": finite}
        labels = list(forces.getColumnLabels())
        knee = labels.index("knee_angle_r_moment")
        answer["inverse dynamics"]["knee moment, largest (N m)"] = max(abs(forces.getRowAtIndex(i)[knee]) for i in range(forces.getNumRows()))
        os.chdir(here)
    json.dump(answer, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
