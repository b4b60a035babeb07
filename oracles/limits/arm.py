"""An arm tracked from its shoulder, elbow and wrist alone, with and without a learned limit: the table "An arm from three markers"
of docs/learned-limits.md, after Figure 17 of Herda et al. 2003.

    python arm.py CONDYLE FOLDER [OFFSET] > arm.md

CONDYLE is the command, FOLDER holds shoulder/cmu01 and shoulder/cmu02. Needs numpy. The truth is the recorded motion of the
clavicle, humerus and elbow; the rest of the body stands still. Three markers, at the centres of shoulder, elbow and wrist, get noise of
10 mm about each axis, as reconstructions without skin markers have it. What a twist is and which are impossible is computed
here: impossible is an orientation farther than 30 degrees from all that were recorded of that person.
"""
import json, os, subprocess, sys, tempfile
import numpy as np

CONDYLE, FOLDER = sys.argv[1:3]
OFFSET = sys.argv[3:4]
EVERY = 4  # of 120 frames a second
NOISE = 0.010
tmp = tempfile.mkdtemp()
TAKES = {"01": ["03", "09", "12", "13"], "02": ["05", "10"]}
ARM = {"rclavicle", "rhumerus", "rradius"}


def run(*arguments):
    done = subprocess.run([CONDYLE, *arguments], capture_output=True, text=True)
    if done.returncode > 1:
        raise RuntimeError(" ".join(arguments) + "\n" + done.stderr)
    return done.stdout


def asf(person):
    return f"{FOLDER}/shoulder/cmu{person}/{person}.asf"


def amc(person, take):
    return f"{FOLDER}/shoulder/cmu{person}/{person}_{take}.amc"


def frames(model, motion):
    found = json.loads(run("fk", model, "--motion", motion, "--json"))["frames"]
    return lambda name: np.array([f["segments"][name] for f in found]).reshape(-1, 4, 4)


def still(person, take):
    """The take with every joint but those of the arm at 0, every fourth frame."""
    out, n, kept = [":FULLY-SPECIFIED", ":DEGREES"], 0, False
    for line in open(amc(person, take)):
        cells = line.split()
        if line[0] in "#:":
            continue
        if len(cells) == 1:
            kept = int(cells[0]) % EVERY == 1
            if kept:
                n += 1
                out.append(str(n))
        elif kept:
            out.append(" ".join(cells if cells[0] in ARM else cells[:1] + ["0"] * (len(cells) - 1)))
    path = f"{tmp}/{person}_{take}_still.amc"
    open(path, "w").write("\n".join(out) + "\n")
    return path


def trc(places, path):
    names = list(places)
    count = len(places[names[0]])
    with open(path, "w") as f:
        f.write(f"PathFileType\t4\t(X/Y/Z)\t{os.path.basename(path)}\n")
        f.write("DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n")
        f.write(f"30\t30\t{count}\t{len(names)}\tmm\t30\t1\t{count}\n")
        f.write("Frame#\tTime\t" + "\t\t\t".join(names) + "\n")
        f.write("\t\t" + "\t".join(f"X{i}\tY{i}\tZ{i}" for i in range(1, len(names) + 1)) + "\n\n")
        for n in range(count):
            cells = [f"{1000 * x:.4f}" for name in names for x in places[name][n]]
            f.write(f"{n + 1}\t{n / 30:.6f}\t" + "\t".join(cells) + "\n")


def model(person, name, more):
    """The skeleton of a person of which only the right arm moves, without ranges at the shoulder unless `more` says so."""
    keys = {c["key"]: c for c in json.loads(run("info", asf(person), "--json"))["coordinates"]}
    lines = ["condyle = 1", 'kind = "model"', 'angles = "deg"', f'include = ["{asf(person)}"]']
    for key, c in keys.items():
        joint, coordinate = c["joint_set"], c["name"]
        if joint not in ARM:
            lines.append(f"joint_set.{joint}.coordinate.{coordinate}.locked = true")
        elif joint != "rhumerus" or "ranges" in more:
            # Ranges of this format are not kept in tracking unless they are written again.
            low, high = np.degrees(c["range"])
            lines.append(f"joint_set.{joint}.coordinate.{coordinate}.range = [{low:.6f}, {high:.6f}]")
    if "limit" in more:
        lines += ["[joint_set.limits.component.recorded.field]", 'segment = "rhumerus"', 'reference = "thorax"',
                  f'file = "{more["limit"]}"']
    path = f"{tmp}/{name}.toml"
    open(path, "w").write("\n".join(lines) + "\n")
    return path


def learn(takes, name):
    path = f"{tmp}/{name}.toml"
    more = ["--offset", *OFFSET] if OFFSET else []
    run("learn", "limits", *(amc(p, t) for p, t in takes), "--joint", "rhumerus", "--reference", "thorax", "-o", path, *more)
    return path


def quaternions(m):
    """x y z w of rotation matrices, by the largest of four."""
    t = np.stack([1 + m[:, 0, 0] - m[:, 1, 1] - m[:, 2, 2], 1 - m[:, 0, 0] + m[:, 1, 1] - m[:, 2, 2],
                  1 - m[:, 0, 0] - m[:, 1, 1] + m[:, 2, 2], 1 + m[:, 0, 0] + m[:, 1, 1] + m[:, 2, 2]], 1)
    k = np.array([[t[:, 0], m[:, 0, 1] + m[:, 1, 0], m[:, 0, 2] + m[:, 2, 0], m[:, 2, 1] - m[:, 1, 2]],
                  [m[:, 0, 1] + m[:, 1, 0], t[:, 1], m[:, 1, 2] + m[:, 2, 1], m[:, 0, 2] - m[:, 2, 0]],
                  [m[:, 0, 2] + m[:, 2, 0], m[:, 1, 2] + m[:, 2, 1], t[:, 2], m[:, 1, 0] - m[:, 0, 1]],
                  [m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1], t[:, 3]]])
    q = np.stack([k[i, :, n] for n, i in enumerate(t.argmax(1))])
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def relative(get):
    r, h = get("thorax")[:, :3, :3], get("rhumerus")[:, :3, :3]
    return quaternions(np.einsum("nji,njk->nik", r, h))


def nearest(q, samples):
    best = np.zeros(len(q))
    for start in range(0, len(samples), 2000):
        best = np.maximum(best, np.abs(q @ samples[start:start + 2000].T).max(1))
    return np.degrees(2 * np.arccos(np.clip(best, 0, 1)))


def twist(found, true, bone):
    """The turn about the bone between two orientations, once the shortest turn has brought the directions together; degrees."""
    x, y, z, w = true.T * np.array([[-1], [-1], [-1], [1]])
    X, Y, Z, W = found.T
    d = np.stack([w * X + x * W + y * Z - z * Y, w * Y - x * Z + y * W + z * X, w * Z + x * Y - y * X + z * W,
                  w * W - x * X - y * Y - z * Z], 1)
    turn = np.degrees(2 * np.arctan2(d[:, :3] @ bone, d[:, 3]))
    return np.abs((turn + 180) % 360 - 180)


clouds = {p: np.vstack([relative(frames(asf(p), amc(p, t)))[::EVERY] for t in takes]) for p, takes in TAKES.items()}
print("| recording | frames | limit learned from | twist error, median | mean | 95 % | impossible twists | worst frame | elbow error, mm |")
print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
for person, takes in TAKES.items():
    for take in takes:
        motion = still(person, take)
        get = frames(asf(person), motion)
        true = relative(get)
        noise = np.random.default_rng(int(person) * 100 + int(take))
        places = {n: get(n)[:, :3, 3] + noise.normal(size=(len(true), 3)) * NOISE for n in ["rhumerus", "rradius", "rwrist"]}
        file = f"{tmp}/{person}_{take}.trc"
        trc(places, file)
        # The bone's long axis in its own frame: where the elbow is.
        bone = np.einsum("nji,nj->ni", get("rhumerus")[:, :3, :3], get("rradius")[:, :3, 3] - get("rhumerus")[:, :3, 3])[0]
        bone /= np.linalg.norm(bone)
        others = [(p, t) for p in TAKES for t in TAKES[p] if p != person]
        rest = [(person, t) for t in takes if t != take]
        arms = {"none": {}, "Euler ranges of the file": {"ranges": True},
                f"subject {others[0][0]}": {"limit": learn(others, f"other_{person}")},
                f"other takes of {person}": {"limit": learn(rest, f"rest_{person}_{take}")},
                "all other takes of both": {"limit": learn(rest + others, f"all_{person}_{take}")}}
        for n, (name, more) in enumerate(arms.items()):
            out = f"{tmp}/out.csv"
            path = model(person, f"arm_{person}_{take}_{n}", more)
            run("track", path, file, "-o", out, "--limits", "on")
            got = frames(path, out)
            found = relative(got)
            error, far = twist(found, true, bone), nearest(found, clouds[person])
            elbow = np.linalg.norm(got("rradius")[:, :3, 3] - get("rradius")[:, :3, 3], axis=1)
            print(f"| {person}_{take} | {len(true)} | {name} | {np.median(error):.1f}° | {error.mean():.1f}° | {np.percentile(error, 95):.1f}° | "
                  f"{100 * (far > 30).mean():.1f} % | {error.max():.0f}° | {1000 * elbow.mean():.1f} |", flush=True)
