"""The shipped human of one stature and sex, posed by the condyle command, and the rows of the check."""

import json
import os
import subprocess
import tomllib

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
MODELS = os.path.normpath(os.path.join(HERE, "../../crates/condyle/models"))


def tables(name):
    """The tables of one of the model's texts as they are written."""
    with open(os.path.join(MODELS, name), "rb") as file:
        return tomllib.load(file)


class Body:
    """Coordinates, landmarks and poses of a model. Lengths are in mm and angles in degrees."""

    def __init__(self, condyle, text, folder):
        """`text` is the file of the model; `folder` takes what is written on the way."""
        self.condyle, self.text, self.folder = condyle, text, folder
        info = json.loads(run(condyle, "info", text, "--json"))
        self.coordinates = {c["name"]: c for c in info["coordinates"]}
        self.markers = {m["name"]: (m["segment"], np.array([*m["point"], 1.0])) for m in info["markers"]}
        self.rest = self.pose()

    def poses(self, poses, limits="off"):
        """One `Pose` for each dictionary of coordinates in degrees; the others at their defaults."""
        path = os.path.join(self.folder, "poses.json")
        with open(path, "w") as file:
            json.dump([{name: np.radians(value) for name, value in pose.items()} for pose in poses], file)
        answer = json.loads(run(self.condyle, "fk", self.text, "--pose", path, "--limits", limits))
        return [Pose(self, frame["segments"]) for frame in answer["frames"]]

    def pose(self, limits="off", **coordinates):
        return self.poses([coordinates], limits)[0]

    def solve(self, landmark, target, free):
        """The pose with a landmark as near to a target (TOML) as it gets, within ranges; only right coordinates
        whose names begin with one of `free` move."""
        goals, answer = (os.path.join(self.folder, name) for name in ("goals.toml", "answer.json"))
        hold = [c for c in self.coordinates if not (c.startswith(free) and c.endswith("_r"))]
        with open(goals, "w") as file:
            file.write(f'condyle = 1\nkind = "goals"\nhold = {json.dumps(hold)}\n')
            file.write(f'[point.goal]\npoint = "{landmark}"\nat = {target}\n')
        run(self.condyle, "pose", self.text, goals, "-o", answer)
        return Pose(
            self, json.loads(run(self.condyle, "fk", self.text, "--pose", answer))["frames"][0]["segments"]
        )

    def axis(self, segment, **pose):
        """The axis of a segment's turn from rest, in the world."""
        r = self.pose(**pose).axes(segment) @ self.rest.axes(segment).T
        a = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
        return a / np.linalg.norm(a)

    def typical(self, name):
        """What people reach on average, (least, most) in degrees."""
        return np.degrees(self.coordinates[name]["typical"])

    def range(self, name):
        return np.degrees(self.coordinates[name]["range"])


class Pose:
    """Transforms of all segments; x forward, y up, z right."""

    def __init__(self, body, segments):
        self.body = body
        self.segments = {name: np.array(t).reshape(4, 4) for name, t in segments.items()}

    def at(self, landmark):
        """A landmark's place, mm."""
        segment, point = self.body.markers[landmark]
        return self.segments[segment].dot(point)[:3] * 1e3

    def point(self, segment, point=(0, 0, 0)):
        """The place of a point, mm, of a segment, mm."""
        return self.segments[segment].dot([*(np.array(point) / 1e3), 1])[:3] * 1e3

    def axes(self, segment):
        return self.segments[segment][:3, :3]

    def tilt(self, segment):
        """Of a segment's y axis in the sagittal plane, degrees, positive backward."""
        r = self.axes(segment)
        return np.degrees(np.arctan2(r[1, 0], r[0, 0]))

    def distance(self, a, b):
        return np.linalg.norm(self.at(a) - self.at(b))


def run(*command):
    answer = subprocess.run(command, capture_output=True, text=True)
    if answer.returncode:
        raise SystemExit(answer.stderr)
    return answer.stdout


class Table:
    """Rows of one region. A row whose source had a part in building the model is `used`."""

    def __init__(self, region):
        self.region, self.rows = region, []

    def near(self, quantity, unit, ours, theirs, allowed, source, used=False, digits=1):
        """Passes within `allowed` of `theirs`."""
        target = f"{theirs:g} ± {allowed:g}"
        self.add(
            quantity, unit, ours, abs(round(ours, digits) - theirs) <= allowed, target, source, used, digits
        )

    def between(self, quantity, unit, ours, least, most, source, used=False, digits=1):
        target = f"{least:g} to {most:g}"
        self.add(quantity, unit, ours, least <= round(ours, digits) <= most, target, source, used, digits)

    def add(self, quantity, unit, ours, passes, target, source, used, digits):
        ours = f"{round(float(ours), digits) + 0.0:.{digits}f}"
        self.rows.append((self.region, quantity, unit, ours, target, source, bool(passes), used))


def angles_yxz(r):
    """Degrees of a rotation about y, then x, then z."""
    return np.degrees(
        [np.arctan2(r[0, 2], r[2, 2]), np.arcsin(np.clip(-r[1, 2], -1, 1)), np.arctan2(r[1, 0], r[1, 1])]
    )


def angle(a, b):
    """Between two lines, degrees, at most 90."""
    return np.degrees(np.arccos(abs(np.dot(a, b)) / np.linalg.norm(a) / np.linalg.norm(b)))
