"""What the scripts of this folder share: how far bodies are apart, and what is kept."""

import json

import numpy as np


def parts(rows):
    """A 3 by 4 transform as rotation, stretch after it (in the body's own axes) and place."""
    rows = np.reshape(rows, (3, 4))
    u, sizes, v = np.linalg.svd(rows[:, :3])
    return u @ v, v.T @ np.diag(sizes) @ v, rows[:, 3]


class Largest:
    """The largest differences: mm between origins, degrees between rotations, stretch in percent."""

    def __init__(self):
        self.all = np.zeros(3)
        self.bodies = {}

    def add(self, name, found, wanted):
        (turn, stretch, place), (turn_too, stretch_too, place_too) = parts(found), parts(wanted)
        off = np.linalg.norm(turn - turn_too) / np.sqrt(8)
        angle = np.degrees(2 * np.arcsin(min(1.0, off)))
        here = np.array([1e3 * np.linalg.norm(place - place_too), angle, 100 * np.abs(stretch - stretch_too).max()])
        self.all = np.maximum(self.all, here)
        self.bodies[name] = np.maximum(self.bodies.get(name, np.zeros(3)), here)

    def rounded(self):
        return [float(f"{x:.2g}") for x in self.all]

    def beyond(self, mm=0.5, degrees=0.1):
        """Bodies that are farther off than this."""
        return sorted(n for n, (a, b, _) in self.bodies.items() if a > mm or b > degrees)


def quaternion(turn):
    """x, y, z, w with w >= 0."""
    k = np.array([
        [turn[0, 0] - turn[1, 1] - turn[2, 2], 0, 0, 0],
        [turn[1, 0] + turn[0, 1], turn[1, 1] - turn[0, 0] - turn[2, 2], 0, 0],
        [turn[2, 0] + turn[0, 2], turn[2, 1] + turn[1, 2], turn[2, 2] - turn[0, 0] - turn[1, 1], 0],
        [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1], np.trace(turn)],
    ]) / 3
    q = np.linalg.eigh(k)[1][:, -1]
    return q if q[3] >= 0 else -q


def kept(transforms):
    """Transforms as they are kept: place and quaternion, to a tenth of a micrometre."""
    all_rows = []
    for rows in transforms:
        turn, _, place = parts(rows)
        all_rows.append([round(float(x), 7) + 0.0 for x in [*place, *quaternion(turn)]])
    return all_rows


def back(base, rows):
    """A transform in the file's world as one in the model's."""
    base = np.reshape(base, (3, 4))
    rows = np.reshape(rows, (3, 4))
    turn = base[:, :3].T @ rows[:, :3]
    return np.column_stack([turn, base[:, :3].T @ (rows[:, 3] - base[:, 3])])


def chain(couplings, values):
    """Values with those that follow: (name, names that it reads, function of their values), in any order."""
    values, open_ = dict(values), list(couplings)
    while open_:
        later = []
        for name, reads, function in open_:
            if all(r in values for r in reads):
                values[name] = function([values[r] for r in reads])
            else:
                later.append((name, reads, function))
        assert len(later) < len(open_), f"couplings in a circle: {[name for name, *_ in later]}"
        open_ = later
    return values


def run(peer, answer, given, place, keep):
    """Compares all poses. `given` are the names of joints that are set; `place(pose, only)` answers with the transform
    of every body by name, where only those joints are set, or all of them."""
    base, poses = answer["base"], answer["poses"]
    follows, together = Largest(), Largest()
    bodies = list(poses[0]["true"])
    rows = []
    for number, pose in enumerate(poses):
        found = {n: back(base, m) for n, m in place(pose, True).items()}
        for name, wanted in pose["true"].items():
            follows.add(name, found[name], wanted)
        if number < keep:
            rows.append({
                "stored": pose["stored"],
                "joints": [pose["joints"][n] for n in given],
                "bodies": kept(found[n] for n in bodies),
            })
        if set(given) != set(pose["joints"]):
            found = {n: back(base, m) for n, m in place(pose, False).items()}
        for name, wanted in pose["true"].items():
            together.add(name, found[name], wanted)
    return {
        "peer": peer, "poses": len(poses), "follows": follows.rounded(), "beyond": follows.beyond(),
        "all_given": together.rounded(), "joints": given, "bodies": bodies, "kept": rows,
    }


def read(path):
    with open(path + ".json") as file:
        return json.load(file)
