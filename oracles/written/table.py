"""Writes shipped models in four formats, asks the programs that read them, keeps their answers and makes the table.

    OPENSIM_PYTHON=... PINOCCHIO_PYTHON=... MUJOCO_PYTHON=... USD_PYTHON=... \\
        python table.py WRITTEN FOLDER [FORMAT...] > ../../docs/written-models.md

WRITTEN is the example `written` of the facade (`cargo build -p condyle --example written`), FOLDER takes the files.
The variables name Pythons that have `opensim`, `pin`, `mujoco` and `usd-core`; all need numpy. The answers go to
`opensim.json`, `pinocchio.json`, `mujoco.json` and `usd.json` beside this script. Needs nothing but Python itself. With formats, only
those are asked anew.
"""

import json
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
MODELS = ["arms", "human", "knee", "knee-pronost2010", "knee-three-rotations", "legs", "octopus", "shoulder", "shoulder-shao2003", "spine",
          "spine-shao2003"]
# Format, program, variable, script, name of the answers.
PEERS = [("osim", "OpenSim", "OPENSIM_PYTHON", "osim.py", "opensim"),
         ("urdf", "Pinocchio", "PINOCCHIO_PYTHON", "urdf.py", "pinocchio"),
         ("mjcf", "MuJoCo", "MUJOCO_PYTHON", "mjcf.py", "mujoco"),
         ("usda", "usd-core", "USD_PYTHON", "usd.py", "usd")]
POSES = 100


def asked(written, folder, formats):
    """The answers of all programs, by format and model."""
    answers = {}
    for form, _, variable, script, name in PEERS:
        if formats and form not in formats:
            with open(os.path.join(HERE, name + ".json")) as file:
                answers[form] = json.load(file)
            continue
        answers[form] = {}
        for model in MODELS:
            path = os.path.join(folder, f"{model}.{form}")
            subprocess.run([written, model, form, path, str(POSES)], check=True)
            with open(path + ".json") as file:
                answer = json.load(file)
            keep = 2 if len(answer["poses"][0]["true"]) > 40 else 4
            python = os.environ[variable]
            run = subprocess.run([python, os.path.join(HERE, script), path, str(keep)], check=True, stdout=subprocess.PIPE)
            result = json.loads(run.stdout.decode().strip().splitlines()[-1])
            result["remarks"] = answer["remarks"]
            answers[form][model] = result
            print(form, model, result["follows"], result["all_given"], file=sys.stderr)
        with open(os.path.join(HERE, name + ".json"), "w") as file:
            keys = answers[form][MODELS[0]]
            lines = []
            for model, result in answers[form].items():
                parts = [f" {json.dumps(k)}: {json.dumps(result[k], separators=(',', ':'))}" for k in keys if k != "kept"]
                rows = ",\n  ".join(json.dumps(row, separators=(",", ":")) for row in result["kept"])
                lines.append(f"{json.dumps(model)}: {{\n" + ",\n".join(parts) + f",\n \"kept\": [\n  {rows}]}}")
            file.write("{\n" + ",\n".join(lines) + "\n}\n")
    return answers


def number(x):
    return "0" if x < 1e-5 else f"{x:.1g}" if x < 1e-3 else f"{x:.3f}" if x < 10 else f"{x:.0f}"


def pair(largest):
    return f"{number(largest[0])} mm, {number(largest[1])}°"


def stretch(largest):
    return f", stretch {largest[2]:.2g} %" if largest[2] > 0.01 else ""


def not_said(result):
    """What is not said, in few words, from the remarks that `convert` prints."""
    words = []
    for code, message in result["remarks"]:
        first = re.match(r"(\d+) ", message)
        if code == "plain/not-said" and "largest error" in message:
            what, error = message.split(" is fitted")[0], message.split("largest error ")[1]
            words.append(f"not said: {what} ({error})")
        elif code.endswith("/not-said"):
            words.append(f"{first.group(1)} joints that others drive are free" if first else message)
        elif code == "plain/fitted" and first:
            worst = message.split("largest error ")[1].split(":")[0]
            words.append(f"{first.group(1)} couplings fitted ({worst})")
        elif code == "plain/fitted":
            what, error = message.split(" is fitted")[0], message.split("largest error ")[1]
            words.append(f"fitted: {what} ({error})")
        elif code == "plain/limits-dropped":
            words.append(f"{first.group(1)} limits other than ranges dropped")
        elif code == "plain/deformed-dropped":
            words.append("stretches dropped")
        elif code.endswith("/dropped"):
            words.append(message.replace("URDF has no place for ", "dropped: "))
        elif code == "usd/scale":
            words.append("scales in half precision")
        elif code == "usd/shear":
            words.append("shears dropped")
    return "; ".join(words) or "–"


HEAD = """# Written models in the programs that read them

`condyle convert MODEL OUT.osim` writes models for [OpenSim](https://opensim.stanford.edu) 4, `OUT.urdf` for programs of
robotics, `OUT.mjcf` for MuJoCo, `OUT.usda` skeletons with their motion for Universal Scene Description. This page is
made by a script, `oracles/written/table.py`: it writes every shipped model, loads the file in the program named, and
compares all bodies at 100 poses inside the limits with the model itself. Beside it are the answers of those programs at
some of these poses; tests compare the models, and what is written today, with them, and the programs themselves where
they are installed.

- **from the file**: only what nothing drives is set; joints that others drive follow from the file, as the program
  computes them: OpenSim's couplers, Pinocchio's mimics, MuJoCo's equalities and tendons. Joints that the format cannot
  drive are set, too: they are counted as free on the right.
- **all set**: every joint is set to its value in the model.
- Differences are the largest of all bodies and poses, in the world: between origins, and between orientations. 0 is less than
  0.00001. What is fitted is promised to 0.5 mm and 0.1° of a segment in its parent; a part that is not is named as not said.

"""

TAIL = """
## What is exact, what is fitted, what is dropped

- **`.osim`**: every function of one coordinate, every sum and product, compensations, rhythms with several drivers: exact, since
  couplers of OpenSim take functions of several coordinates; what they need on the way is held by coordinates of bodies
  that nothing hangs from. Moving centres and ellipsoids are splines, within 0.02 mm. Contacts are fitted, by
  polynomials of order 4 of where the bone is and of how much each of its pairs of points counts. That fails for
  `shoulder-shao2003`: the contact of that paper jumps from one place of the ribs to another within its limits, as
  no polynomial does, so it is named as not said; everything but the scapula and what hangs on it is exact.
- **`.urdf`**: a joint can mimic one other, by a line. Other couplings are fitted by a line where that is near enough, else
  the joint is free. With all joints set nothing is off but those splines. Pinocchio refuses a mimic of a joint that comes
  after it in the tree, which URDF allows (`knee`, `knee-three-rotations`): there the script multiplies.
- **`.mjcf`**: a joint can follow one other by a polynomial of order 4, or hold a sum. The rest is free. With all joints
  set nothing is off but those splines.
- **`.usda`**: bones without joints: every pose of a motion, in single precision. All limits and couplings are already applied.
- Only `.usda` can stretch a bone: the octopus in the other formats keeps its turns and places.
- Limits other than ranges (cones, ellipses, ranges that depend on other angles) have no place in any of these formats; a pose
  that condyle makes keeps them.

## What else the programs say

- OpenSim's own assembly, started from the pose before, reaches the values of the couplers: the largest difference is in the
  column below. The functions of its couplers are evaluated by OpenSim itself in the table above.
- MuJoCo computes the violation of its equalities at the values that follow from them (rounding), and over half a second of
  simulation without gravity, in which all joints that are set begin with 0.2 rad/s or m/s: its constraints are springs, so
  this is what its solver makes of them with its default stiffness. No model makes it warn of a singular inertia.
- usd-core: rest and bind transforms agree, its validators find nothing.

"""


def page(answers):
    out = [HEAD]
    for form, program, *_ in PEERS:
        peer = answers[form][MODELS[0]]["peer"]
        out.append(f"## `.{form}` in {peer}\n\n")
        if form == "usda":
            out.append("| model | bodies | off | not said |\n| --- | --- | --- | --- |\n")
        else:
            out.append("| model | bodies | couplings | from the file | all set | fitted, free or dropped |\n| --- | --- | --- | --- | --- | --- |\n")
        for model, r in answers[form].items():
            follows = pair(r["follows"]) + stretch(r["follows"])
            together = "" if form == "usda" else f" {pair(r['all_given'])} |"
            couplings = "" if form == "usda" else f" {r['couplings']} |"
            out.append(f"| `{model}` | {len(r['bodies'])} |{couplings} {follows} |{together} {not_said(r)} |\n")
        out.append("\n")
    out.append(TAIL.lstrip("\n"))
    out.append("| model | OpenSim's assembly | MuJoCo's equalities | simulated | warnings |\n| --- | --- | --- | --- | --- |\n")
    for model in MODELS:
        osim, mjcf = answers["osim"][model], answers["mjcf"][model]
        assembled = osim["assembled"] if isinstance(osim["assembled"], str) else pair(osim["assembled"])
        out.append(f"| `{model}` | {assembled} | {mjcf['equality']:.1g} | {mjcf['simulated']:.1g} | {mjcf['warnings']} |\n")
    for model in MODELS:
        assert not answers["usda"][model]["errors"] and max(answers["usda"][model]["rest"]) < 1e-4, model
    return "".join(out)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.stdout.write(page(asked(os.path.abspath(sys.argv[1]), sys.argv[2], sys.argv[3:])))
