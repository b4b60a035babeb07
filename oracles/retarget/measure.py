"""How far the limbs of two recordings of one motion point apart, and how far standing feet slide.

    python measure.py SOURCE TARGET [--source-unit M] [--target-unit M] [--json]

SOURCE and TARGET are each a .bvh, a .trc, or ASF:AMC (two paths with a colon between); lengths of .bvh are in
units of M metres (0.01 without it), those of .asf are converted by the file's own. The readers here, and all that is
computed, share nothing with the project: joint angles become places by the formats' own rules, and limbs are lines
between places. Limbs are known by the names of joints in NAMES; the trunk is the line from between the hips to between the
shoulders, `neck` that to the neck. One turn about the vertical axis between the two
recordings is fitted over all limbs and frames and printed: facings differ by quarter turns.

A foot stands where ankle or ball is less than 3 cm above the lowest of the recording and slower than 0.15 m/s, for 0.1 s at
least, in SOURCE; it slides by the largest distance along the ground from where the stand began.
"""
import argparse
import json
import re

import numpy as np

INCH = 0.0254
# For each kind of names: hip, knee, ankle, ball, shoulder, elbow, wrist of a side, and the neck.
def sided(*names):
    return {side: [name.format(**s) for name in names] for side, s in
            (("l", dict(s="l", S="L", Side="Left")), ("r", dict(s="r", S="R", Side="Right")))}
NAMES = {
    "human": (sided("hip_center_{s}", "knee_center_{s}", "ankle_center_{s}", "{S}TOE", "shoulder_center_{s}",
                    "elbow_center_{s}", "wrist_center_{s}"), "vc7"),
    "cmu-asf": (sided("{s}femur", "{s}tibia", "{s}foot", "{s}toes", "{s}humerus", "{s}radius", "{s}hand"), "lowerneck"),
    "cmu-bvh": (sided("{Side}UpLeg", "{Side}Leg", "{Side}Foot", "{Side}ToeBase", "{Side}Arm", "{Side}ForeArm",
                      "{Side}FingerBase"), "Neck"),
    "mixamo": (sided("{Side}UpLeg", "{Side}Leg", "{Side}Foot", "{Side}ToeBase", "{Side}Arm", "{Side}ForeArm", "{Side}Hand"),
               "Neck"),
    "biovision": (sided("{Side}Hip", "{Side}Knee", "{Side}Ankle", "{Side}Toe", "{Side}Shoulder", "{Side}Elbow",
                        "{Side}Wrist"), "Neck"),
}
LIMBS = {"upper arm": (4, 5), "forearm": (5, 6), "thigh": (0, 1), "shank": (1, 2), "foot": (2, 3)}


def turn(axis, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i = "xyz".index(axis.lower())
    j, k = (i + 1) % 3, (i + 2) % 3
    m = np.zeros((len(degrees), 3, 3))
    m[:, i, i] = 1
    m[:, j, j] = m[:, k, k] = c
    m[:, j, k], m[:, k, j] = -s, s
    return m


def read_bvh(path, unit):
    words = open(path).read().split()
    joints, stack, at = [], [], 0
    while words[at] != "MOTION":
        word = words[at]
        if word in ("ROOT", "JOINT", "End"):
            name = words[at + 1] if word != "End" else joints[stack[-1]]["name"] + "_end"
            joints.append(dict(name=name, parent=stack[-1] if stack else None, channels=[]))
            at += 2
        elif word == "{":
            stack.append(len(joints) - 1)
            at += 1
        elif word == "}":
            stack.pop()
            at += 1
        elif word == "OFFSET":
            joints[stack[-1]]["offset"] = np.array(list(map(float, words[at + 1:at + 4])))
            at += 4
        elif word == "CHANNELS":
            count = int(words[at + 1])
            joints[stack[-1]]["channels"] = words[at + 2:at + 2 + count]
            at += 2 + count
        else:
            at += 1
    frames = int(words[at + 2])
    step = float(words[at + 5])
    numbers = np.array(list(map(float, words[at + 6:]))).reshape(frames, -1)
    places, turns, column = [], [], 0
    for joint in joints:
        m = np.tile(np.eye(3), (frames, 1, 1))
        offset = np.tile(joint["offset"], (frames, 1))
        moved = {}
        for channel in joint["channels"]:
            value = numbers[:, column]
            column += 1
            if channel.lower().endswith("position"):
                moved["xyz".index(channel[0].lower())] = value
            else:
                m = m @ turn(channel[0], value)
        for axis, value in moved.items():
            offset[:, axis] = value
        if joint["parent"] is None:
            places.append(offset)
            turns.append(m)
        else:
            p = joint["parent"]
            places.append(places[p] + np.einsum("fij,fj->fi", turns[p], offset))
            turns.append(turns[p] @ m)
    names = [joint["name"].split(":")[-1] for joint in joints]
    return np.arange(frames) * step, {n: p * unit for n, p in zip(names, places)}


def read_trc(path):
    with open(path) as file:
        lines = file.read().split("\n")
    units = {"mm": 1e-3, "m": 1.0, "cm": 1e-2}[lines[2].split("\t")[4].strip()]
    labels = [label for label in lines[3].split("\t")[2:] if label.strip()]
    rows = [line.split("\t") for line in lines[5:] if line.strip()]
    count = 2 + 3 * len(labels)
    table = np.array([[float(cell) if cell.strip() else np.nan for cell in (row + [""] * count)[:count]] for row in rows])
    return table[:, 1], {label: table[:, 2 + 3 * i:5 + 3 * i] * units for i, label in enumerate(labels)}


def extrinsic(order, angles):
    m = np.tile(np.eye(3), (angles.shape[0], 1, 1))
    for axis, column in zip(order.lower(), angles.T):
        m = turn(axis, column) @ m
    return m


def read_amc(asf, amc):
    text = open(asf).read()
    unit = INCH / float(re.search(r"length\s+(\S+)", text).group(1))
    bones = {}
    for block in re.findall(r"begin\s+id(.*?)end", text, re.S):
        get = lambda key: re.search(rf"^\s*{key} (.*)$", block, re.M).group(1).split()
        axis = get("axis")
        frame = extrinsic(axis[3], np.array([list(map(float, axis[:3]))]))[0]
        dof = re.search(r"^\s*dof (.*)$", block, re.M)
        bones[get("name")[0]] = dict(
            line=np.array(list(map(float, get("direction")))) * float(get("length")[0]) * unit, frame=frame,
            dof=dof.group(1).split() if dof else [])
    order = []
    for line in text.split(":hierarchy")[1].splitlines():
        words = line.split()
        for child in words[1:]:
            bones[child]["parent"] = words[0]
            order.append(child)
    frames = []
    for line in open(amc):
        words = line.split()
        if len(words) == 1 and words[0].isdigit():
            frames.append({})
        elif frames:
            frames[-1][words[0]] = list(map(float, words[1:]))
    root = np.array([frame["root"] for frame in frames])
    place, end = {"root": root[:, :3] * unit}, {"root": root[:, :3] * unit}
    turns = {"root": extrinsic("xyz", root[:, 3:])}
    for name in order:
        bone = bones[name]
        own = np.tile(np.eye(3), (len(frames), 1, 1))
        if bone["dof"]:
            own = extrinsic("".join(d[1] for d in bone["dof"]), np.array([frame[name] for frame in frames]))
        parent = bone["parent"]
        turns[name] = turns[parent] @ (bone["frame"] @ own @ bone["frame"].T)
        place[name] = end[parent]
        end[name] = place[name] + turns[name] @ bone["line"]
    return np.arange(len(frames)) / 120, place


def read(path, unit):
    if ":" in path and path.endswith(".amc"):
        return read_amc(*path.split(":", 1))
    return read_trc(path) if path.endswith(".trc") else read_bvh(path, unit)


def body(places):
    """The joints of both sides, and the neck."""
    for kind, (sides, neck) in NAMES.items():
        found = {}
        for side, names in sides.items():
            found[side] = [next((places[n] for n in name.split("|") if n in places), None) for name in names]
        if all(p is not None for side in found.values() for p in side[:6]):
            top = next((places[n] for n in neck.split("|") if n in places), None)
            return kind, found, top
    raise SystemExit("the names of joints are none of " + ", ".join(NAMES))


def lines(figure):
    _, sides, neck = figure
    all_lines = {}
    for side, joints in sides.items():
        for limb, (a, b) in LIMBS.items():
            if joints[a] is not None and joints[b] is not None:
                all_lines[f"{limb} {side}"] = joints[b] - joints[a]
    hips = (sides["l"][0] + sides["r"][0]) / 2
    all_lines["trunk"] = (sides["l"][4] + sides["r"][4]) / 2 - hips
    if neck is not None:
        all_lines["neck"] = neck - hips
    return {k: v / np.linalg.norm(v, axis=1, keepdims=True) for k, v in all_lines.items()}


def stands(points, times):
    low = points[:, 1] < points[:, 1].min() + 0.03
    around = np.minimum(np.arange(len(times)) + 1, len(times) - 1), np.maximum(np.arange(len(times)) - 1, 0)
    speed = np.linalg.norm(points[around[0]] - points[around[1]], axis=1) / (times[around[0]] - times[around[1]])
    still = low & (speed < 0.15)
    edges = np.flatnonzero(np.diff(np.r_[False, still, False].astype(int)))
    return [(a, b) for a, b in zip(edges[::2], edges[1::2]) if times[b - 1] - times[a] >= 0.1]


def slid(points, run):
    part = points[run[0]:run[1], [0, 2]]
    return np.linalg.norm(part - part[0], axis=1).max()


def main():
    parse = argparse.ArgumentParser()
    parse.add_argument("source")
    parse.add_argument("target")
    parse.add_argument("--source-unit", type=float, default=0.01)
    parse.add_argument("--target-unit", type=float, default=0.01)
    parse.add_argument("--json", action="store_true")
    asked = parse.parse_args()
    times, source = read(asked.source, asked.source_unit)
    _, target = read(asked.target, asked.target_unit)
    a, b = body(source), body(target)
    mine, theirs = lines(a), lines(b)
    shared = [name for name in mine if name in theirs]
    count = min(len(times), len(theirs["trunk"]))
    # The turn about y that brings the first to the second: the sum of horizontal products.
    cosine = sine = 0.0
    for name in shared:
        p, q = mine[name][:count], theirs[name][:count]
        cosine += np.nansum(p[:, 0] * q[:, 0] + p[:, 2] * q[:, 2])
        sine += np.nansum(p[:, 2] * q[:, 0] - p[:, 0] * q[:, 2])
    yaw = np.degrees(np.arctan2(sine, cosine))
    facing = round(yaw / 90) * 90
    about = turn("y", np.array([float(facing)]))[0]
    answer = {"source": a[0], "target": b[0], "frames": int(count), "yaw_deg": round(float(yaw), 3), "facing_deg": facing,
              "degrees": {}, "slides_mm": {}}
    for name in shared:
        p, q = mine[name][:count] @ about.T, theirs[name][:count]
        angles = np.degrees(np.arctan2(np.linalg.norm(np.cross(p, q), axis=1), (p * q).sum(axis=1)))
        answer["degrees"][name] = [round(float(np.nanmean(angles)), 3), round(float(np.nanpercentile(angles, 95)), 3)]
    pairs = []
    for side in "lr":
        for joint in (2, 3):
            p, q = a[1][side][joint], b[1][side][joint]
            if p is not None and q is not None:
                pairs += [(slid(p[:count], run), slid(q[:count], run)) for run in stands(p[:count], times[:count])]
    if pairs:
        pairs = np.array(pairs) * 1e3
        answer["slides_mm"] = {
            "stands": len(pairs), "source_median": round(float(np.median(pairs[:, 0])), 2),
            "target_median": round(float(np.median(pairs[:, 1])), 2), "target_most": round(float(pairs[:, 1].max()), 2),
            "most_beyond_source": round(float((pairs[:, 1] - pairs[:, 0]).max()), 2)}
    if asked.json:
        print(json.dumps(answer))
        return
    print(f"{answer['frames']} frames, {a[0]} and {b[0]}; turned by {yaw:.2f} degrees, {facing} taken")
    for name, (mean, most) in answer["degrees"].items():
        print(f"  {name:<12} {mean:6.2f} {most:6.2f}")
    print(" ", answer["slides_mm"])


if __name__ == "__main__":
    main()
