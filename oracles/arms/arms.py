"""The arms of `condyle learn compare` by OpenSim: its own inverse kinematics on the trials that were left out, and poses.

    OPENSIM_PYTHON=... python arms/arms.py CONDYLE DATA FOLDER > arms/answers.json

CONDYLE is the command, DATA the folder that contains `knee/`, FOLDER takes the files. `learn compare`
calibrates the knee, learns and writes the model of every arm for every part of every trial as `.osim`. OpenSim's
InverseKinematicsTool (accuracy 1e-8, every marker of weight 1) then tracks exactly the frames that were left out, and its own marker errors
are kept: the mean over frames of `marker_error_RMS`, the largest `marker_error_max`. Frames in which a segment shows fewer than
three of its markers are left out of both. It starts
from the standing posture, which in another laboratory frame is turned by half a turn from the sprint, and ends with `hinge`,
`planar` and `learned` turned over: their errors are kept as they are.

Beside that every arm of the first part is posed 100 times at random by OpenSim (couplers met by its assembler) and by `condyle fk`
of the same arm as a document; the largest distance of a body's origin, or of a point 0.4 m from it, is `pose_difference_m`. Ten poses are
kept with the transforms of the shank that OpenSim has.

This file is run twice: by any Python, and by that of OPENSIM_PYTHON, which has `opensim` and numpy.
"""

import json
import math
import os
import random
import subprocess
import sys

# Name, standing trial, trials, options, which question is asked of OpenSim, how many seconds of each trial.
PEOPLE = [
    ("sprint", "SprintCalib.trc", ["SprintMotion.trc"],
     ["--parent", "thigh_r=R.GT,R.Knee.Lat,R.Knee.Med", "--child", "shank_r=R.TTA,R.Fibula,R.Ankle.Med,R.Ankle.Lat",
      "--origin", "R.GT", "--medial", "R.Knee.Med", "--lateral", "R.Knee.Lat"], "same motion", None),
]
POSES = 100
KEPT = 10


def random_poses(joint):
    draw = random.Random(5)
    poses = []
    for _ in range(POSES):
        pose = {f"thigh_r_t{axis}": draw.uniform(-1, 1) for axis in "xyz"}
        pose |= {f"thigh_r_r{axis}": draw.uniform(-0.7, 0.7) for axis in "xyz"}
        pose |= {f"{joint}_flexion": draw.uniform(-2.2, 0.2), f"{joint}_adduction": draw.uniform(-0.2, 0.2),
                 f"{joint}_rotation": draw.uniform(-0.4, 0.4)}
        pose |= {f"{joint}_t{axis}": draw.uniform(-0.03, 0.03) for axis in "xyz"}
        poses.append(pose)
    return poses


def transform(columns):
    return [float(x) for x in columns]


def by_opensim(task):
    """In the Python of OpenSim: marker errors of runs, transforms of poses."""
    import opensim as osim
    osim.Logger.setLevelString("error")
    answers = {"runs": [], "poses": []}
    for run in task["runs"]:
        model = osim.Model(run["model"])
        model.initSystem()
        tool = osim.InverseKinematicsTool()
        tool.setModel(model)
        tool.setMarkerDataFileName(run["trial"])
        tool.setStartTime(run["times"][0])
        tool.setEndTime(run["times"][1])
        tool.setOutputMotionFileName(os.path.join(task["folder"], "ik.mot"))
        tool.setResultsDir(task["folder"])
        tool.set_report_errors(True)
        tool.set_accuracy(1e-8)
        tool.setName("arm")
        tasks = tool.upd_IKTaskSet()
        for marker in run["markers"]:
            one = osim.IKMarkerTask()
            one.setName(marker)
            one.setApply(True)
            one.setWeight(1.0)
            tasks.cloneAndAppend(one)
        tool.run()
        table = osim.TimeSeriesTable(os.path.join(task["folder"], "arm_ik_marker_errors.sto"))
        times = list(table.getIndependentColumn())
        rms = table.getDependentColumn("marker_error_RMS").to_numpy()
        most = table.getDependentColumn("marker_error_max").to_numpy()
        answers["runs"].append([[float(a), float(b), float(c)] for a, b, c in zip(times, rms, most)])
    for model_path, joint in task["posed"]:
        model = osim.Model(model_path)
        state = model.initSystem()
        rows = []
        for pose in task["poses"][joint]:
            for name, value in pose.items():
                coordinate = model.getCoordinateSet().get(name)
                if coordinate.get_locked() or coordinate.isDependent(state):
                    continue
                if name.startswith(f"{joint}_t"):
                    value += coordinate.getDefaultValue()
                coordinate.setValue(state, value, False)
            model.assemble(state)
            model.realizePosition(state)
            found = model.getBodySet().get("shank_r").getTransformInGround(state)
            r, p = found.R(), found.p()
            rows.append([r.get(i, j) if j < 3 else p.get(i) for i in range(3) for j in range(4)])
        answers["poses"].append(rows)
    return answers


def main():
    condyle, data, folder = sys.argv[1:4]
    out = {}
    for name, static, trials, options, question, seconds in PEOPLE:
        own = os.path.join(folder, name)
        paths = [os.path.join(data, "knee", trial) for trial in trials]
        reports = {}
        for form in ["osim", "toml"]:
            subprocess.run([condyle, "learn", "compare", os.path.join(data, "knee", static), "--trials", *paths, *options,
                            "-o", os.path.join(own, form), "--models", os.path.join(own, form, "models"), "--models-as", form,
                            "--threads", "1"],
                           check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(own, form, "compare.json")) as file:
                reports[form] = json.load(file)
        for path in paths:
            clean = os.path.join(own, os.path.basename(path))
            subprocess.run([condyle, "convert", path, clean], check=True)
        joint = "knee_r"
        report = reports["osim"]
        markers = [m for group in options[1::2] if "=" in group for m in group.split("=")[1].split(",")]
        sides = [set(group.split("=")[1].split(",")) for group in options[1::2] if "=" in group]
        runs, places = [], []
        for trial in report["trials"]:
            if trial["question"] != question:
                continue
            for part, whole in enumerate(trial["parts"]):
                for arm, model in whole["models"].items():
                    runs.append({"model": os.path.join(own, "osim", "models", model), "times": until(whole["times"], seconds),
                                 "trial": os.path.join(own, trial["trial"] + ".trc"), "markers": markers})
                    places.append((trial["trial"], arm, part))
        first = next(trial for trial in report["trials"] if trial["question"] == question)["parts"][0]["models"]
        other = next(trial for trial in reports["toml"]["trials"] if trial["question"] == question)["parts"][0]["models"]
        task = {"folder": own, "runs": runs, "poses": {joint: random_poses(joint)},
                "posed": [[os.path.join(own, "osim", "models", model), joint] for model in first.values()]}
        with open(os.path.join(own, "task.json"), "w") as file:
            json.dump(task, file)
        subprocess.run([os.environ["OPENSIM_PYTHON"], os.path.abspath(__file__), "--opensim",
                        os.path.join(own, "task.json"), os.path.join(own, "answer.json")], check=True, stdout=sys.stderr)
        with open(os.path.join(own, "answer.json")) as file:
            answer = json.load(file)
        seen = {trial: frames_seen(os.path.join(own, trial + ".trc"), sides) for trial in {place[0] for place in places}}
        errors = {}
        for (trial, arm, _), rows in zip(places, answer["runs"]):
            kept = errors.setdefault(trial, {}).setdefault(arm, [])
            kept += [row for row in rows if round(row[0], 5) in seen[trial]]
        table = {}
        for trial in report["trials"]:
            if trial["question"] == question:
                table[trial["trial"]] = {
                    arm: {"rms_mm": 1e3 * sum(row[1] for row in rows) / len(rows), "max_mm": 1e3 * max(row[2] for row in rows),
                          "frames": len(rows)}
                    for arm, rows in errors[trial["trial"]].items()}
        poses = {}
        for (arm, model), theirs in zip(other.items(), answer["poses"]):
            path = os.path.join(own, "toml", "models", model)
            ours = ours_at(condyle, path, task["poses"][joint], joint, own)
            most = 0.0
            for a, b in zip(ours, theirs):
                for point in [(0, 0, 0, 1), (0.4, 0, 0, 1), (0, 0.4, 0, 1), (0, 0, 0.4, 1)]:
                    apart = [sum((a[4 * i + j] - b[4 * i + j]) * point[j] for j in range(4)) for i in range(3)]
                    most = max(most, math.sqrt(sum(x * x for x in apart)))
            poses[arm] = {"pose_difference_m": most, "kept": theirs[:KEPT]}
        out[name] = {"static": static, "trials": trials, "options": options, "question": question, "seconds": seconds, "errors": table,
                     "asked": random_poses(joint)[:KEPT], "poses": poses}
    print(json.dumps(out, indent=1))


def until(times, seconds):
    """No more than so many seconds."""
    return [times[0], times[1] if seconds is None else min(times[1], times[0] + seconds)]


def frames_seen(path, sides):
    """The times at which both segments show three of their markers."""
    with open(path) as file:
        lines = file.read().splitlines()
    labels = [label for label in lines[3].split("\t")[2:] if label]
    times = set()
    for line in lines[4:]:
        cells = line.split("\t")
        if not cells[0].strip().isdigit():
            continue
        shown = {label for k, label in enumerate(labels)
                 if all(c < len(cells) and cells[c].strip() not in ("", "NaN", "nan") for c in range(2 + 3 * k, 5 + 3 * k))}
        if all(len(side & shown) >= 3 for side in sides):
            times.add(round(float(cells[1]), 5))
    return times


def ours_at(condyle, model, poses, joint, folder):
    """The transforms of the shank by `condyle fk`; what is locked or follows keeps its value."""
    run = subprocess.run([condyle, "info", model, "--json"], check=True, stdout=subprocess.PIPE)
    known = {c["name"]: c for c in json.loads(run.stdout)["coordinates"]}
    asked = []
    for pose in poses:
        values = {}
        for name, value in pose.items():
            coordinate = known[name]
            if coordinate.get("locked") or coordinate.get("follows"):
                continue
            values[name] = value + (coordinate["default"] if name.startswith(f"{joint}_t") else 0)
        asked.append(values)
    path = os.path.join(folder, "poses.json")
    with open(path, "w") as file:
        json.dump(asked, file)
    run = subprocess.run([condyle, "fk", model, "--pose", path, "--json"], check=True, stdout=subprocess.PIPE)
    return [frame["segments"]["shank_r"][:12] for frame in json.loads(run.stdout)["frames"]]


if __name__ == "__main__":
    if sys.argv[1] == "--opensim":
        with open(sys.argv[2]) as file:
            answer = by_opensim(json.load(file))
        with open(sys.argv[3], "w") as file:
            json.dump(answer, file)
    else:
        main()
