"""Limits learned from real recordings, judged by others: the tables "Real recordings" of docs/learned-limits.md.

    python real.py CONDYLE FOLDER [right_arm|hip|...] > real.md

CONDYLE is the command, FOLDER holds shoulder/cmu01, shoulder/cmu02 and hip/right_hip_functional.c3d. Needs numpy and ezc3d.
The rotations of the hip are computed here again, by the text of the recipe. Limits are learned and asked by the command; boxes of
Euler angles and circular cones are made here.
"""
import json, os, subprocess, sys, tempfile
import numpy as np

CONDYLE, FOLDER = sys.argv[1:3]
WHAT = sys.argv[3:] or ["right_arm", "hip"]
rng = np.random.default_rng(14)
tmp = tempfile.mkdtemp()


def run(*arguments):
    done = subprocess.run([CONDYLE, *arguments], capture_output=True, text=True)
    if done.returncode > 1:
        raise RuntimeError(done.stderr)
    return done.stdout


def from_matrix(m):
    """Shepperd's method, x y z w."""
    q = np.empty((len(m), 4))
    t = np.stack([m[:, 0, 0], m[:, 1, 1], m[:, 2, 2], np.trace(m, axis1=1, axis2=2)], 1)
    which = t.argmax(1)
    for n, (r, k) in enumerate(zip(m, which)):
        if k == 3:
            q[n] = [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], 1 + t[n, 3]]
        else:
            i, j, l = k, (k + 1) % 3, (k + 2) % 3
            q[n, i] = 1 + r[i, i] - r[j, j] - r[l, l]
            q[n, j], q[n, l] = r[j, i] + r[i, j], r[l, i] + r[i, l]
            q[n, 3] = r[l, j] - r[j, l]
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def to_matrix(q):
    x, y, z, w = q.T
    return np.stack([
        np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], -1),
        np.stack([2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)], -1),
        np.stack([2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], -1)], -2)


def amc(person, name, child, reference):
    folder = f"{FOLDER}/shoulder/cmu{person}"
    text = run("fk", f"{folder}/{person}.asf", "--motion", f"{folder}/{person}_{name}.amc", "--json")
    frames = json.loads(text)["frames"]
    get = lambda s: np.array([f["segments"][s] for f in frames]).reshape(-1, 4, 4)[:, :3, :3]
    return from_matrix(np.einsum("nji,njk->nik", get(reference), get(child)))


def hip():
    import ezc3d
    c = ezc3d.c3d(f"{FOLDER}/hip/right_hip_functional.c3d")
    labels = c["parameters"]["POINT"]["LABELS"]["value"]
    p = lambda name: c["data"]["points"][:3, labels.index(name)].T
    unit = lambda v: v / np.linalg.norm(v, axis=1, keepdims=True)
    z = unit(p("RASIS") - p("LASIS"))
    x = (p("RASIS") + p("LASIS")) / 2 - (p("RPSIS") + p("LPSIS")) / 2
    x = unit(x - z * (x * z).sum(1, keepdims=True))
    pelvis = np.stack([x, np.cross(z, x), z], -1)
    y = unit(p("RGT") - (p("RLFE") + p("RMFE")) / 2)
    z = p("RLFE") - p("RMFE")
    z = unit(z - y * (y * z).sum(1, keepdims=True))
    femur = np.stack([np.cross(y, z), y, z], -1)
    return from_matrix(np.einsum("nji,njk->nik", pelvis, femur))


def write(q):
    path = tempfile.mktemp(".csv", dir=tmp)
    np.savetxt(path, q, delimiter=",", header="qx,qy,qz,qw", comments="", fmt="%.9g")
    return path


def learn(takes, *more):
    out, report = tempfile.mktemp(".toml", dir=tmp), tempfile.mktemp(".json", dir=tmp)
    run("learn", "limits", *map(write, takes), "-o", out, "--report", report, *more)
    return out, json.load(open(report))


def query(limit, q):
    lines = run("limits", "query", limit, write(q)).splitlines()[1:]
    cells = [line.split(",") for line in lines]
    state = np.array([c[4] for c in cells])
    distance = np.array([float(c[5]) if c[5] else np.nan for c in cells])
    return state, distance


def nearest(q, samples):
    best = np.zeros(len(q))
    for start in range(0, len(samples), 2000):
        best = np.maximum(best, np.abs(q @ samples[start:start + 2000].T).max(1))
    return np.degrees(2 * np.arccos(np.clip(best, 0, 1)))


def uniform(n):
    q = rng.normal(size=(n, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def product(a, b):
    ax, ay, az, aw = a.T
    bx, by, bz, bw = b.T
    return np.stack([aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
                     aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz], 1)


def away(samples, degrees, count=600):
    """Rotations whose nearest sample of all is so far, to half a degree."""
    kept = []
    for _ in range(40):
        axis = rng.normal(size=(count, 3))
        axis /= np.linalg.norm(axis, axis=1, keepdims=True)
        half = np.radians(degrees) / 2
        step = np.hstack([axis * np.sin(half), np.full((count, 1), np.cos(half))])
        q = product(samples[rng.integers(len(samples), size=count)], step)
        kept.extend(q[nearest(q, samples) > degrees - 0.5])
        if len(kept) >= count:
            break
    return np.array(kept[:count])


ORDERS = [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if i != j and j != k]


def angles(q, order):
    """The three angles of Ri Rj Rk."""
    m, (i, j, k) = to_matrix(q), order
    if i == k:
        l = 3 - i - j
        e = 1 if (j - i) % 3 == 1 else -1
        return np.stack([np.arctan2(m[:, j, i], -e * m[:, l, i]), np.arccos(np.clip(m[:, i, i], -1, 1)),
                         np.arctan2(m[:, i, j], e * m[:, i, l])], 1)
    e = 1 if (j - i) % 3 == 1 else -1
    return np.stack([np.arctan2(-e * m[:, j, k], m[:, k, k]), np.arcsin(np.clip(e * m[:, i, k], -1, 1)),
                     np.arctan2(-e * m[:, i, j], m[:, i, i])], 1)


class Box:
    """Ranges of three angles, in the order of all twelve that holds the least of all rotations."""

    def __init__(self, q):
        even, best = uniform(8000), 2
        for order in ORDERS:
            ranges = []
            for column in angles(q, order).T:
                a = np.sort(column % (2 * np.pi))
                gaps = np.append(np.diff(a), a[0] + 2 * np.pi - a[-1])
                widest = gaps.argmax()
                ranges.append((a[(widest + 1) % len(a)], 2 * np.pi - gaps[widest]))
            self.order, self.ranges = order, ranges
            volume = self(even).mean()
            if volume < best:
                best, chosen = volume, (order, ranges)
        self.order, self.ranges = chosen

    def __call__(self, q):
        a = angles(q, self.order)
        return np.all([(a[:, n] - s) % (2 * np.pi) <= l for n, (s, l) in enumerate(self.ranges)], 0)


class Cone:
    """A circular cone of swing with a symmetric range of twist about the mean rotation."""

    def __init__(self, q, bone):
        mean = np.linalg.eigh(q.T @ q)[1][:, -1]
        self.back, self.bone = mean * [-1, -1, -1, 1], bone
        self.most = np.max(self.parts(q), 0)

    def parts(self, q):
        r = product(np.broadcast_to(self.back, q.shape), q)
        along = r[:, :3] @ self.bone
        twist = (2 * np.arctan2(along, r[:, 3]) + np.pi) % (2 * np.pi) - np.pi
        swing = 2 * np.arccos(np.clip(np.hypot(along, r[:, 3]), 0, 1))
        return np.stack([swing, np.abs(twist)], 1)

    def __call__(self, q, scale):
        return np.all(self.parts(q) <= scale * self.most, 1)


EVEN = uniform(15000)


def row(name, results):
    """Results are of each fold: valid held-out frames, all of them, volume, rejections."""
    covered = sum(r[0] for r in results) / sum(r[1] for r in results)
    volume = np.mean([r[2] for r in results])
    rejected = np.mean([r[3] for r in results], 0)
    print(f"| {name} | {covered:.3f} | {100 * volume:.2f} % | " + " | ".join(f"{x:.2f}" for x in rejected) + " |", flush=True)
    return covered


def judged(valid, test, far):
    """A method asked once about all."""
    parts = [test, EVEN, *far]
    answers = np.split(valid(np.vstack(parts)), np.cumsum([len(p) for p in parts])[:-1])
    return answers[0].sum(), len(test), answers[1].mean(), [1 - a.mean() for a in answers[2:]]


OFFSETS = [0, 2.5, 5, 7.5, 10, 15, 20]


def table(folds, far, bone):
    print("| method | held-out frames valid | volume | rejected at 5° | 10° | 20° | 40° |\n| --- | --- | --- | --- | --- | --- | --- |")
    ours, curve, herda, box, gaps, unknown = [], [[] for _ in OFFSETS], [], [], [], 0
    for train, test in folds:
        limit, report = learn(train)
        gaps.append(f"{report['offset_deg']:.1f}°")
        ours.append(judged(lambda q: query(limit, q)[0] == "valid", test, far))
        unknown += (query(limit, test)[0] == "unknown").sum()
        bare, _ = learn(train, "--offset", "0")
        parts = [test, EVEN, *far]
        # In a hole the distance is to the hole's boundary, and counts as outside as well.
        distance = np.split(query(bare, np.vstack(parts))[1], np.cumsum([len(p) for p in parts])[:-1])
        for offset, results in zip(OFFSETS, curve):
            inside = [d >= -offset for d in distance]
            results.append((inside[0].sum(), len(test), inside[1].mean(), [1 - i.mean() for i in inside[2:]]))
        spheres, _ = learn(train, "--method", "herda2003")
        herda.append(judged(lambda q: query(spheres, q)[0] == "valid", test, far))
        box.append(judged(Box(np.vstack(train)), test, far))
    covered = row(f"**closing, offset from left-out parts** ({', '.join(gaps)})", ours)
    for offset, results in zip(OFFSETS, curve):
        row(f"closing, offset {offset}°", results)
    row("herda2003, centred", herda)
    row("Euler ranges, the best of twelve orders", box)
    cones = [Cone(np.vstack(train), bone) for train, _ in folds]
    held = lambda scale: sum(c(t, scale).sum() for c, (_, t) in zip(cones, folds)) / sum(len(t) for _, t in folds)
    low, high = 0, 3
    for _ in range(30):
        middle = (low + high) / 2
        low, high = (middle, high) if held(middle) < covered else (low, middle)
    row("circular cone and twist at equal coverage", [judged(lambda q: c(q, high), t, far) for c, (_, t) in zip(cones, folds)])
    print(f"\n{100 * unknown / sum(len(t) for _, t in folds):.2f} % of the held-out frames are called unknown.\n", flush=True)


def away_of(takes):
    samples = np.vstack(takes)[::3]
    return [away(samples, d) for d in (5, 10, 20, 40)]


def arm(child, title, bone):
    one = [amc("01", n, child, "thorax") for n in ("03", "09", "12", "13")]
    two = [amc("02", n, child, "thorax") for n in ("05", "10")]
    print(f"\n### {title}\n")
    for name, takes in (("01", one), ("02", two)):
        for index, take in enumerate(takes):
            others = np.vstack([t for i, t in enumerate(takes) if i != index])[::4]
            d = nearest(take[::10], others)
            print(f"- subject {name}, take {index + 1}, {len(take)} frames: the nearest of the other takes is {np.median(d):.1f}° away at the median, {np.percentile(d, 95):.1f}° at 95 %, {d.max():.1f}° at most")
    far = away_of(one + two)
    print("\nOf subject 01 each of four takes is left out in turn:\n")
    table([([t for i, t in enumerate(one) if i != out], one[out]) for out in range(4)], far, bone)
    print("Learned from 01, tested on 02:\n")
    table([(one, np.vstack(two))], far, bone)
    print("Learned from 02, tested on 01:\n")
    table([(two, np.vstack(one))], far, bone)


# The arms of these skeletons point along x at the identity (shared by both; from their .asf files).
if "right_arm" in WHAT:
    arm("rhumerus", "Right upper arm in the thorax (CMU 01 and 02)", np.array([-1.0, 0, 0]))
if "hip" in WHAT:
    q = hip()
    q = q[np.isfinite(q).all(1)]
    print(f"\n### Right thigh in the pelvis (functional trial, {len(q)} frames)\n\nEight blocks of time left out in turn:\n")
    blocks = np.array_split(q, 8)
    far = away_of([q])
    table([([b for i, b in enumerate(blocks) if i != out], blocks[out]) for out in range(8)], far, np.array([0, -1.0, 0]))
