"""Joint positions of ASF/AMC takes by a few lines of numpy, and beside the BVH of one of them.

    python evaluate.py DATA positions.json      positions of all takes of the test data in some frames
    python evaluate.py DATA --compare           a table: 01_03 as AMC and as the published BVH

Written from the format's definition alone: a bone turns by C R C^-1 about its beginning, C from `axis`, R from
the take, both with the first token first about fixed axes. No part of condyle is used. Lengths are in the units
of the file.
"""

import json
import sys
from pathlib import Path

import numpy as np


def about(axis, degrees):
    a = np.radians(degrees)
    c, s = np.cos(a), np.sin(a)
    x, y, z = np.eye(3)[axis]
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + s * k + (1 - c) * k @ k


def extrinsic(angles, order):
    turn = np.eye(3)
    for letter, angle in zip(order, angles):
        turn = about("xyz".index(letter.lower()), angle) @ turn
    return turn


def asf(path):
    bones, hierarchy, section, bone = {}, [], "", None
    for line in open(path):
        words = line.split("#")[0].replace("(", " ").replace(")", " ").replace(",", " ").split()
        if not words:
            continue
        if words[0][0] == ":":
            section = words[0][1:]
        elif section == "root" and words[0] == "order":
            bones["root"] = {"dof": [w.lower() for w in words[1:]], "c": np.eye(3), "end": np.zeros(3)}
        elif section == "bonedata":
            if words[0] == "begin":
                bone = {"dof": [], "c": np.eye(3)}
            elif words[0] == "name":
                bones[words[1]] = bone
            elif words[0] == "direction":
                bone["end"] = np.array(words[1:4], float)
            elif words[0] == "length":
                bone["end"] = bone["end"] * float(words[1])
            elif words[0] == "axis":
                bone["c"] = extrinsic([float(w) for w in words[1:4]], words[4])
            elif words[0] == "dof":
                bone["dof"] = [w.lower() for w in words[1:]]
        elif section == "hierarchy" and words[0] not in ("begin", "end"):
            hierarchy += [(words[0], child) for child in words[1:]]
    return bones, hierarchy


def amc(path):
    frames = []
    for line in open(path):
        words = line.split()
        if not words or words[0][0] in ":#":
            continue
        if len(words) == 1:
            frames.append({})
        else:
            frames[-1][words[0]] = [float(w) for w in words[1:]]
    return frames


def pose(bones, hierarchy, frame):
    """The beginning of every bone, and the ends of those that nothing hangs on."""
    turns, begins, ends = {}, {}, {}
    for parent, name in [(None, "root")] + hierarchy:
        bone, values = bones[name], frame.get(name, [])
        turn, step = np.eye(3), np.zeros(3)
        for token, value in zip(bone["dof"], values):
            if token[0] == "r":
                turn = about("xyz".index(token[1]), value) @ turn
            elif token[0] == "t":
                step["xyz".index(token[1])] = value
        base = turns[parent] if parent else np.eye(3)
        begins[name] = (ends[parent] if parent else np.zeros(3)) + base @ bone["c"] @ step
        turns[name] = base @ bone["c"] @ turn @ bone["c"].T
        ends[name] = begins[name] + turns[name] @ bone["end"]
    last = {n for n in bones} - {p for p, _ in hierarchy}
    return begins, {n + "_end": ends[n] for n in last}, turns


def bvh(path):
    """Joints with parent, offset and channels, end sites, and rows."""
    words = iter(open(path).read().split())
    joints, stack, end = [], [], False
    for word in words:
        if word in ("ROOT", "JOINT"):
            joints.append({"name": next(words), "parent": stack[-1] if stack else None, "ends": []})
            stack.append(len(joints) - 1)
            next(words)
        elif word == "End":
            next(words), next(words)
            end = True
        elif word == "OFFSET":
            at = np.array([float(next(words)) for _ in range(3)])
            if end:
                joints[stack[-1]]["ends"].append(at)
            else:
                joints[stack[-1]]["offset"] = at
        elif word == "CHANNELS":
            joints[stack[-1]]["channels"] = [next(words) for _ in range(int(next(words)))]
        elif word == "}":
            if end:
                end = False
            else:
                stack.pop()
        elif word == "MOTION":
            break
    rest = list(words)
    count = int(rest[1])
    rows = np.array(rest[5:], float).reshape(count, -1)
    return joints, rows


def bvh_pose(joints, row):
    at, turns, places, ends = 0, [], [], {}
    for joint in joints:
        step, turn = joint["offset"].copy(), np.eye(3)
        for channel in joint["channels"]:
            axis = "XYZ".index(channel[0])
            if channel.endswith("position"):
                step[axis] = row[at]
            else:
                turn = turn @ about(axis, row[at])
            at += 1
        base, origin = (turns[joint["parent"]], places[joint["parent"]]) if joint["parent"] is not None else (np.eye(3), np.zeros(3))
        places.append(origin + base @ step)
        turns.append(base @ turn)
        for end in joint["ends"]:
            ends[joint["name"] + "_end"] = places[-1] + turns[-1] @ end
    return {j["name"]: p for j, p in zip(joints, places)}, ends


# A bone of the ASF file, and the joint of the BVH file that begins there.
SAME = {
    "root": "Hips", "lhipjoint": "LHipJoint", "lfemur": "LeftUpLeg", "ltibia": "LeftLeg", "lfoot": "LeftFoot",
    "ltoes": "LeftToeBase", "rhipjoint": "RHipJoint", "rfemur": "RightUpLeg", "rtibia": "RightLeg",
    "rfoot": "RightFoot", "rtoes": "RightToeBase", "lowerback": "LowerBack", "upperback": "Spine",
    "thorax": "Spine1", "lowerneck": "Neck", "upperneck": "Neck1", "head": "Head", "lclavicle": "LeftShoulder",
    "lhumerus": "LeftArm", "lradius": "LeftForeArm", "lwrist": "LeftHand", "lhand": "LeftFingerBase",
    "lfingers": "LFingers", "lthumb": "LThumb", "rclavicle": "RightShoulder", "rhumerus": "RightArm",
    "rradius": "RightForeArm", "rwrist": "RightHand", "rhand": "RightFingerBase", "rfingers": "RFingers",
    "rthumb": "RThumb",
}


# Bones that the BVH file has without their length: what hangs on them has an OFFSET of zero there.
WITHOUT_LENGTH = ["thorax", "lwrist", "rwrist"]


def compare(data):
    bones, hierarchy = asf(data / "shoulder/cmu01/01.asf")
    short = {n: {**b, "end": np.zeros(3)} if n in WITHOUT_LENGTH else b for n, b in bones.items()}
    frames = amc(data / "shoulder/cmu01/01_03.amc")
    joints, rows = bvh(data / "mocap/bvh/cmu_01_03.bvh")
    pairs = list(SAME.items()) + [(a + "_end", b + "_end") for a, b in SAME.items()]
    far = {}
    for k, frame in enumerate(frames):
        both = [pose(own, hierarchy, frame)[:2] for own in (bones, short)]
        places, sites = bvh_pose(joints, rows[k + 1])
        other = {**places, **sites}
        for name, joint in pairs:
            if joint in other and name in {**both[0][0], **both[0][1]}:
                far.setdefault(name, []).append(
                    [np.linalg.norm({**begins, **tips}[name] - other[joint]) for begins, tips in both]
                )
    print(f"{len(frames)} frames of the AMC file, {len(rows)} of the BVH file, whose first is left out.")
    print("Lengths:", ", ".join(f"{n} {np.linalg.norm(bones[n]['end']):.5f}" for n in WITHOUT_LENGTH))
    print("\n| bone | joint | mean | largest | largest without these lengths |")
    print("| --- | --- | --- | --- | --- |")
    for name, rows in far.items():
        mean, most = np.mean(rows, axis=0), np.max(rows, axis=0)
        joint = dict(pairs)[name]
        print(f"| {name} | {joint} | {mean[0]:.6f} | {most[0]:.6f} | {most[1]:.6f} |")


def main():
    data = Path(sys.argv[1])
    if sys.argv[2] == "--compare":
        return compare(data)
    answers = {}
    for take in sorted(data.rglob("*.amc")):
        bones, hierarchy = asf(next(take.parent.glob(take.name.split("_")[0] + ".asf")))
        frames = amc(take)
        picked = sorted({round(i * (len(frames) - 1) / 3) for i in range(4)})
        answer = {"frames": picked, "joints": {}}
        for k in picked:
            begins, tips, _ = pose(bones, hierarchy, frames[k])
            for name, place in {**begins, **tips}.items():
                answer["joints"].setdefault(name, []).append([float(f"{x:.13g}") for x in place])
        answers[str(take.relative_to(data))] = answer
    text = json.dumps({"files": answers}, separators=(",", ":"))
    Path(sys.argv[2]).write_text(text.replace("]],", "]],\n") + "\n")


main()
