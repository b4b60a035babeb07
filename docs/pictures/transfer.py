"""The pictures and the table of docs/transfer-figures.md: python docs/pictures/transfer.py CONDYLE DATA

CONDYLE is the command, DATA the folder of test data. Each figure gets the knee of examples/transfer/knee.toml; its three landmarks are put into the picture
as markers. The table compares the centre's path that `condyle fk` gives with the paper's formulas, written out here with numpy: from the orientation of the
shank in the thigh the three angles, from these the scaled law.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parent.parent / "examples" / "transfer"


# The law of knee.toml: rows x, y, z; flexion, adduction, rotation, constant. Its landmarks.
LAW = np.array([
    [-0.01600935540803637, 0.08577109548625411, -0.04348802364554816, 0.0003967259436325832],
    [-0.0006524774253673546, 0.013433009823586613, -0.002351428487738753, -0.3942268176727612],
    [0.00505740907212902, -0.0034027060275729198, -0.009647021126090448, -0.04451839046269871],
])
OWN = np.array([[0, 0, 0], [0, -0.3903, -0.1047], [0, -0.3903, 0.0146]])


def axes(points):
    origin, medial, lateral = points
    z = (lateral - medial) / np.linalg.norm(lateral - medial)
    y = origin - (medial + lateral) / 2
    y = y - z * (z @ y)
    y /= np.linalg.norm(y)
    return np.column_stack([np.cross(y, z), y, z])


def compared(thigh, shank, rest, points, holds):
    """The centre's path along x, y, z of the landmarks (metres), and how far it is from the formulas."""
    inside = lambda a, b: np.linalg.inv(a) @ b
    at_zero = inside(rest[0], rest[1])
    q = axes(points)
    a = axes(OWN) @ q.T
    b = at_zero[:3, :3].T @ a.T
    s1 = np.linalg.norm(points[0] - points[2]) / np.linalg.norm(OWN[0] - OWN[2])
    s2 = np.linalg.norm(points[1] - points[2]) / np.linalg.norm(OWN[1] - OWN[2])
    scale = np.array([(s1 + s2) / 2, s1, s2])
    path, far = [], 0.0
    # The joint's place in the shank is the point that is where the law says it while all angles are 0; a joint that holds is at the shank's origin.
    start = at_zero[:3, 3] if holds else points[0] + q @ (scale * LAW[:, 3])
    place = np.linalg.inv(at_zero) @ np.append(start, 1.0)
    shift = q.T @ (start - points[0]) - scale * LAW[:, 3]
    for one, other in zip(thigh, shank):
        t = inside(one, other)
        r = a @ t[:3, :3] @ b
        angles = [np.arctan2(-r[0, 1], r[1, 1]), np.arcsin(np.clip(r[2, 1], -1, 1)), np.arctan2(-r[2, 0], r[2, 2]), 1.0]
        centre = q.T @ ((t @ place)[:3] - points[0])
        far = max(far, float(np.linalg.norm(centre - shift - scale * (LAW @ angles))))
        path.append(centre)
    return np.ptp(np.array(path), axis=0), far


def main(condyle, data):
    def run(*words):
        done = subprocess.run([condyle, *map(str, words)], capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"{words}: {done.stderr}")
        return done.stdout

    def posed(model, thigh, shank, *motion):
        frames = json.loads(run("fk", model, *motion, "--json"))["frames"]
        return [[np.array(f["segments"][name]).reshape(4, 4) for f in frames] for name in (thigh, shank)]

    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        walk, bvh, man = work / "walk.mot", f"{data}/mocap/bvh/walk01.bvh", f"{data}/models/gltf/cesium_man.gltf"
        run("convert", bvh, walk, "--onto", "human")
        run("track", "human", f"{data}/knee/opencap4/squats1.trc", "--time", "3:4.4", "-o", work / "squat.mot")
        for name, path in (("walk01", bvh), ("cesium_man", man)):
            run("convert", path, work / f"{name}.csv")
        ik = f"{data}/knee/opencap4"
        # Name, figure, its leg in the document, the same in motion, view from the side, motions.
        figures = [
            ("human", "human", "femur_r,tibia_r", "side", [walk, work / "squat.mot"]),
            ("opencap4", f"{ik}/manually_scaled.osim", "femur_r,tibia_r", "side", [f"{ik}/walking1_ik.mot", f"{ik}/squats1_ik.mot"]),
            ("cesium_man", man, "node_3,node_4", "front", [work / "cesium_man.csv"]),
            ("walk01", bvh, "RightUpLeg,RightLeg", "side", [work / "walk01.csv"]),
        ]
        for name, figure, at, side, motions in figures:
            made, report = work / f"{name}.toml", work / f"{name}.json"
            run("transfer", EXAMPLES / "knee.toml", "--onto", figure, "--landmarks", EXAMPLES / f"{name}.toml", "-o", made, "--report", report)
            points = json.loads(report.read_text())["landmarks_of_target_m"]
            marked = work / f"{name}-marked.toml"
            text = "\n".join(line for line in made.read_text().splitlines())
            # Only the landmarks, none of the figure's own markers.
            kept, skip = [], False
            for line in text.splitlines():
                if line.startswith("["):
                    skip = line.startswith("[marker")
                if not skip:
                    kept.append(line)
            thigh = at.split(",")[0]
            for word, point in zip(("origin", "medial", "lateral"), points):
                kept += [f"[marker.{word}_landmark]", f'segment = "{thigh}"', f"at = {point}"]
            marked.write_text("\n".join(kept) + "\n")
            around = ["--view", "50,12"] if side == "side" else ["--view", "140,12"]
            run("render", marked, *around, "--at", thigh, "--zoom", "1.3", "--show", "bones,markers", "--size", "260x400", "-o", HERE / f"transfer-{name}-landmarks.png")
            shank = at.split(",")[1]
            numbers = json.loads(report.read_text())
            still = [one[0] for one in posed(made, thigh, shank)]
            holds = "holds = true" in (EXAMPLES / f"{name}.toml").read_text()
            for number, motion in enumerate(motions):
                word = ["gait", "crouch"][number]
                run("render", marked, motion, "--sheet", "5" if (name, word) == ("opencap4", "crouch") else "6", "--view", side, "--at", at, "--zoom", "1.3", "--show", "bones,centres,markers",
                    "--size", "1080x240", "-o", HERE / f"transfer-{name}-{word}.png")
                along, far = compared(*posed(made, thigh, shank, "--motion", motion), still, np.array(points), holds)
                travel = ", ".join(f"{1e3 * x:.1f}" for x in along)
                print(f"| {name} | {numbers['s1']:.3f} | {numbers['s2']:.3f} | {1e3 * numbers['moved_at_rest_m']:.1f} | {word} | {travel} | {far:.0e} |")


main(sys.argv[1], sys.argv[2])
