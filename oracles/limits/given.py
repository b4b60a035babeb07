"""Limits that depend on another joint, learned from some takes and judged by others: a table of docs/learned-limits.md.

    python given.py CONDYLE FOLDER > given.md

CONDYLE is the command, FOLDER holds shoulder/cmu01 and shoulder/cmu02. Needs numpy. The elbow given the upper arm in the thorax, and
the turn of the forearm (the wrist's own bone in these skeletons) given the elbow. Both are hinges: "share" is that of a full turn, in the
mean over the drivers of the held-out frames.
"""
import functools, json, sys, tempfile
import numpy as np

sys.argv = [*sys.argv[:3], "nothing"]
from real import FOLDER, product, run, to_matrix, tmp, from_matrix


def path(person, name):
    return f"{FOLDER}/shoulder/cmu{person}/{person}_{name}.amc"


def poses(person, name, pairs):
    """Rotations of children in references over a take."""
    text = run("fk", f"{FOLDER}/shoulder/cmu{person}/{person}.asf", "--motion", path(person, name), "--json")
    frames = json.loads(text)["frames"]
    get = lambda s: np.array([f["segments"][s] for f in frames]).reshape(-1, 4, 4)[:, :3, :3]
    return [from_matrix(np.einsum("nji,njk->nik", get(r), get(c))) for c, r in pairs]


def hinge(q):
    """Middle and axis of turns about one axis."""
    mean = np.linalg.eigh(q.T @ q)[1][:, -1]
    r = product(np.broadcast_to(mean * [-1, -1, -1, 1], q.shape), q)
    v = r[:, :3] * np.sign(r[:, 3:])
    return mean, np.linalg.eigh(v.T @ v)[1][:, -1]


def angle(q, middle, axis):
    r = product(np.broadcast_to(middle * [-1, -1, -1, 1], q.shape), q)
    a = 2 * np.arctan2(r[:, :3] @ axis, r[:, 3])
    return (a + np.pi) % (2 * np.pi) - np.pi


def turned(angles, middle, axis):
    half = angles / 2
    step = np.hstack([np.outer(np.sin(half), axis), np.cos(half)[:, None]])
    return product(np.broadcast_to(middle, step.shape), step)


def query(limit, q, driver, head):
    name = tempfile.mktemp(".csv", dir=tmp)
    np.savetxt(name, np.hstack([q, driver]), delimiter=",", header="qx,qy,qz,qw," + head, comments="", fmt="%.9g")
    lines = run("limits", "query", limit, name).splitlines()
    at = lines[0].split(",").index("state")
    cells = [line.split(",") for line in lines[1:]]
    return np.array([c[at] for c in cells]), np.array([float(c[at + 1]) if c[at + 1] else np.nan for c in cells])


AROUND = np.linspace(-np.pi, np.pi, 180, endpoint=False)


def learn(takes, child, reference, given, *more):
    out = tempfile.mktemp(".toml", dir=tmp)
    report = tempfile.mktemp(".json", dir=tmp)
    run("learn", "limits", *takes, "--joint", child, "--reference", reference, "--given", *given, "-o", out, "--report", report, *more)
    return out, json.load(open(report))


def table(title, child, reference, given, head, driver_of, people):
    print(f"\n### {title}\n")
    print("| split | limit | held-out frames valid | unknown | share | offset |\n| --- | --- | --- | --- | --- | --- |")
    for name, folds in people:
        results = {}
        def add(row, covered, unknown, frames, share, offset):
            results.setdefault(row, []).append((covered, unknown, frames, share, offset))
        for train, test in folds:
            took = {t: driver_of(*t) for t in train + test}
            own = np.vstack([took[t][0] for t in train])
            middle, axis = hinge(own)
            asked = np.vstack([took[t][0] for t in test])[::20]
            drivers = np.vstack([took[t][1] for t in test])[::20]
            some = drivers[np.linspace(0, len(drivers) - 1, 30).astype(int)]
            circle = turned(AROUND, middle, axis)
            every = np.repeat(some, len(AROUND), 0), np.tile(circle, (len(some), 1))
            limit, report = learn([path(*t) for t in train], child, reference, given)
            offset = report["given"]["offset_deg"]
            state, distance = query(limit, asked, drivers, head)
            around, far = query(limit, every[1], every[0], head)
            add("given, offset from left-out takes", (state == "valid").sum(), (state == "unknown").sum(), len(state), (far >= 0).mean(), offset)
            for more in (0, 5, 10, 20):
                # The distance of a hinge is that of its angle: another layer is another threshold.
                add(f"given, offset {more}°", (distance >= offset - more).sum(), 0, len(state), (far >= offset - more).mean(), more)
            angles, held = angle(own, middle, axis), angle(asked, middle, axis)
            for low, high in ((0, 100), (1, 99), (5, 95)):
                a, b = np.percentile(angles, [low, high])
                for more in (0, 5) if low == 0 else (0,):
                    wide = np.radians(more)
                    inside = (held >= a - wide) & (held <= b + wide)
                    add(f"range of the angle, {low} to {high} % of the frames, and {more}°", inside.sum(), 0, len(held), (b - a + 2 * wide) / (2 * np.pi), more)
        for row, parts in results.items():
            covered, unknown, frames = (sum(p[k] for p in parts) for k in range(3))
            print(f"| {name} | {row} | {covered / frames:.3f} | {unknown / frames:.3f} | {100 * np.mean([p[3] for p in parts]):.1f} % | {np.mean([p[4] for p in parts]):.1f}° |", flush=True)


one, two = [("01", n) for n in ("03", "09", "12", "13")], [("02", n) for n in ("05", "10")]
PEOPLE = [
    ("01, each take left out", [([t for t in one if t != out], [out]) for out in one]),
    ("01 to 02", [(one, two)]),
    ("02 to 01", [(two, one)]),
]


@functools.cache
def elbow(person, name):
    return poses(person, name, [("rradius", "rhumerus"), ("rhumerus", "thorax")])


@functools.cache
def forearm(person, name):
    turn, bent = poses(person, name, [("rwrist", "rradius"), ("rradius", "rhumerus")])
    rows = [line.split() for line in open(path(person, name)) if line.startswith("rradius ")]
    return turn, np.radians(np.array([[float(r[1])] for r in rows]))[:len(turn)]


table("Right elbow given the upper arm in the thorax", "rradius", "rhumerus", ["rhumerus", "--given-reference", "thorax"], "gx,gy,gz,gw", elbow, PEOPLE)
table("Turn of the right forearm given the elbow", "rwrist", "rradius", ["rradius/rx"], "rradius/rx", forearm, PEOPLE)
