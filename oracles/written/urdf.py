"""Loads a .urdf in Pinocchio and compares its links with what a model says.

    python urdf.py FILE.urdf [ANSWER.json]     (FILE.urdf.json by default, from the example `written`)

All joint values are given. Prints one line of JSON: the largest difference in mm and degrees from what the file says
(`said`) and from the model (`true`), and of mimics from the values that were written (`mimic`).
"""

import json
import sys
import xml.etree.ElementTree as tree

import numpy as np
import pinocchio as pin


def difference(a, b):
    turn = a[:, :3].T @ b[:, :3]
    angle = np.degrees(2 * np.arcsin(min(1.0, np.linalg.norm(turn - np.eye(3)) / np.sqrt(8))))
    return 1e3 * np.linalg.norm(a[:, 3] - b[:, 3]), angle


def main(path, answer):
    with open(answer) as file:
        answer = json.load(file)
    model = pin.buildModelFromUrdf(path)
    data = model.createData()
    robot = tree.parse(path).getroot()
    mimics = []
    for joint in robot.iter("joint"):
        for mimic in joint.iter("mimic"):
            factor, offset = float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0))
            mimics.append((joint.get("name"), mimic.get("joint"), factor, offset))
    base = np.vstack([np.reshape(answer["base"], (3, 4)), [0, 0, 0, 1]])
    worst = {"said": [0.0, 0.0], "true": [0.0, 0.0]}
    coupled = 0.0
    used = set()
    for pose in answer["poses"]:
        joints = {**pose["joints"]}
        q = pin.neutral(model)
        for name in model.names[1:]:
            joint = model.joints[model.getJointId(name)]
            at = joint.idx_q
            if joint.nq == 7:
                place = [joints.pop(f"{name}_{axis}", 0.0) for axis in "xyz"]
                turn = pose["balls"].get(name)
                if turn is None:
                    from scipy.spatial.transform import Rotation
                    angles = [joints.pop(f"{name}_rotation_{axis}") for axis in "xyz"]
                    turn = Rotation.from_euler("XYZ", angles).as_quat()
                q[at:at + 7] = [*place, *turn]
                continue
            value = joints.pop(name)
            if joint.nq == 2:
                q[at:at + 2] = np.cos(value), np.sin(value)
            else:
                q[at] = value
        for name, leader, factor, offset in mimics:
            given = pose["joints"]
            coupled = max(coupled, abs(factor * given[leader] + offset - given[name]))
        pin.framesForwardKinematics(model, data, q)
        for name in pose["said"]:
            if not model.existFrame(name, pin.FrameType.BODY):
                raise SystemExit(f"no link {name}")
            found = data.oMf[model.getFrameId(name, pin.FrameType.BODY)].homogeneous[:3]
            for kind in worst:
                wanted = base @ np.vstack([np.reshape(pose[kind][name], (3, 4)), [0, 0, 0, 1]])
                mm, degrees = difference(wanted[:3], found)
                worst[kind] = [max(worst[kind][0], mm), max(worst[kind][1], degrees)]
        used.update(joints)
    print(json.dumps({**worst, "mimic": coupled, "poses": len(answer["poses"]), "mimics": len(mimics), "links": len(answer["poses"][0]["said"]), "unused": sorted(used)[:5]}))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else sys.argv[1] + ".json")
