"""Curves of coverage against volume, and the histograms of Herda et al. 2003, on real recordings: what docs/pictures/limits-*.png draw.

    python curves.py CONDYLE FOLDER > curves.json

CONDYLE and FOLDER as for real.py, whose recordings, boxes and cones these are. Needs Python 3.11, numpy and ezc3d.

- coverage: the share of held-out frames that are called valid, volume: the share of all rotations. The closing (learned with offset 0)
  goes outward by degrees, the spheres are taken at other levels of F than 1, the ranges of angles go outward by degrees, the cone is scaled.
- radii: the distances from the centroid of the samples in the cell of L x L solid angles that holds most (L = 7), of the training cloud.
- values: F of the spheres at the frames of the training subject and of another.
"""
import json, sys, tomllib
arguments = sys.argv[1:3]
sys.argv = [sys.argv[0], *arguments, "nothing"]
import numpy as np
import real

DEGREES = np.concatenate([np.arange(0, 20, 1.25), np.arange(20, 61, 5)])


def spheres_of(path):
    said = tomllib.load(open(path, "rb"))["spheres"]
    assert said["placement"] == "centred"
    return np.array(said["reference"]), np.array(said["each"]), said["stickiness"]


def points(q, reference):
    """The vector part of reference⁻¹·q, of the sign with which its real part is not negative."""
    back = np.broadcast_to(reference * [-1, -1, -1, 1], q.shape)
    r = real.product(back, q)
    return np.where(r[:, 3:] < 0, -1, 1) * r[:, :3]


def field(q, spheres):
    reference, each, k = spheres
    p = points(q, reference)
    total = np.zeros(len(p))
    for x, y, z, e in each:
        r = np.linalg.norm(p - [x, y, z], axis=1)
        total += np.where(r <= e, -k * (r - e) + 1, np.where(r <= e + 2 / k, 0.25 * (k * (r - e) - 2) ** 2, 0))
    return total


class Wider(real.Box):
    def at(self, q, degrees):
        a, by = real.angles(q, self.order), np.radians(degrees)
        return np.all([(a[:, n] - s + by) % (2 * np.pi) <= min(l + 2 * by, 2 * np.pi) for n, (s, l) in enumerate(self.ranges)], 0)


def curve(pairs):
    """Pairs of arrays (held-out, even) of each step; the mean over folds."""
    return [[float(np.mean([e.mean() for _, e in step])), float(sum(h.sum() for h, _ in step) / sum(len(h) for h, _ in step))] for step in pairs]


def curves(folds, bone):
    found = {name: [[] for _ in DEGREES] for name in ("closing", "herda2003", "Euler ranges", "circular cone")}
    for train, test in folds:
        bare, _ = real.learn(train, "--offset", "0")
        held, even = np.split(real.query(bare, np.vstack([test, real.EVEN]))[1], [len(test)])
        spheres = spheres_of(real.learn(train, "--method", "herda2003")[0])
        box, cone = Wider(np.vstack(train)), real.Cone(np.vstack(train), bone)
        f_held, f_even = field(test, spheres), field(real.EVEN, spheres)
        for step, degrees in enumerate(DEGREES):
            found["closing"][step].append((held >= -degrees, even >= -degrees))
            # From F = 2 in the middle of the spheres to where their influence ends.
            level = 2.0 * (1 - step / (len(DEGREES) - 1)) ** 2 + 1e-9
            found["herda2003"][step].append((f_held >= level, f_even >= level))
            by = degrees - 20
            found["Euler ranges"][step].append((box.at(test, by), box.at(real.EVEN, by)))
            scale = 0.2 + 1.2 * step / (len(DEGREES) - 1)
            found["circular cone"][step].append((cone(test, scale), cone(real.EVEN, scale)))
    return {name: curve(steps) for name, steps in found.items()}


def histograms(train, other):
    spheres = spheres_of(real.learn(train, "--method", "herda2003")[0])
    cloud = np.vstack(train)
    p = points(cloud, spheres[0])
    off = p - p.mean(0)
    rho = np.linalg.norm(off, axis=1)
    longitude = ((np.arctan2(off[:, 1], off[:, 0]) + np.pi) / (2 * np.pi) * 7).astype(int).clip(0, 6)
    latitude = (np.arccos(np.clip(off[:, 2] / rho, -1, 1)) / np.pi * 7).astype(int).clip(0, 6)
    cell = longitude * 7 + latitude
    fullest = np.bincount(cell, minlength=49).argmax()
    radii = rho[cell == fullest]
    edges = np.linspace(0, 0.9, 31)
    levels = np.linspace(0, 3, 31)
    share = lambda values: (np.histogram(np.clip(values, 0, 2.9999), levels)[0] / len(values)).tolist()
    own, others = field(cloud, spheres), field(np.vstack(other), spheres)
    return {
        "radii": {"edges": edges.tolist(), "counts": np.histogram(radii, edges)[0].tolist(), "largest": float(radii.max())},
        "values": {"edges": levels.tolist(), "training": share(own), "other": share(others),
                   "training_inside": float((own >= 1).mean()), "other_inside": float((others >= 1).mean())},
    }


one = [real.amc("01", n, "rhumerus", "thorax") for n in ("03", "09", "12", "13")]
two = [real.amc("02", n, "rhumerus", "thorax") for n in ("05", "10")]
bone = np.array([-1.0, 0, 0])
left = [([t for i, t in enumerate(one) if i != out], one[out]) for out in range(4)]
rounded = lambda value: ({k: rounded(v) for k, v in value.items()} if isinstance(value, dict)
                         else [rounded(v) for v in value] if isinstance(value, list)
                         else round(value, 5) if isinstance(value, float) else value)
print(json.dumps(rounded({
    "coverage": {
        "takes of 01 left out": curves(left, bone),
        "from 01 to 02": curves([(one, np.vstack(two))], bone),
        "from 02 to 01": curves([(two, np.vstack(one))], bone),
    },
    "histograms": histograms(one, two),
})))
