"""Loads a written MJCF file in MuJoCo and compares its bodies with what the writer says.

    python mjcf.py FILE.mjcf      (FILE.mjcf.json beside it, from the example `written`)

All joint values are given. Prints one line of JSON: the largest difference in mm and degrees from what the file says
(`said`) and from the model (`true`), and the largest violation of the equalities at these values (`equality`).
"""

import json
import sys

import mujoco
import numpy as np


def difference(a, b):
    turn = a[:, :3].T @ b[:, :3]
    angle = np.degrees(2 * np.arcsin(min(1.0, np.linalg.norm(turn - np.eye(3)) / np.sqrt(8))))
    return 1e3 * np.linalg.norm(a[:, 3] - b[:, 3]), angle


def main(path):
    with open(path + ".json") as file:
        answer = json.load(file)
    with open(path) as file:
        model = mujoco.MjModel.from_xml_string(file.read())
    data = mujoco.MjData(model)
    base = np.vstack([np.reshape(answer["base"], (3, 4)), [0, 0, 0, 1]])
    worst = {"said": [0.0, 0.0], "true": [0.0, 0.0]}
    violated = 0.0
    address = {model.joint(i).name: model.jnt_qposadr[i] for i in range(model.njnt)}
    given = answer["poses"][0]
    missing = (set(given["joints"]) | set(given["balls"])) ^ set(address)
    assert not missing, missing
    for pose in answer["poses"]:
        for name, value in pose["joints"].items():
            data.qpos[address[name]] = value
        for name, (x, y, z, w) in pose["balls"].items():
            at = address[name]
            data.qpos[at:at + 4] = w, x, y, z
        mujoco.mj_fwdPosition(model, data)
        equal = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
        if np.any(equal):
            violated = max(violated, np.abs(data.efc_pos[equal]).max())
        for name in pose["said"]:
            body = data.body(name)
            found = np.hstack([body.xmat.reshape(3, 3), body.xpos.reshape(3, 1)])
            for kind in worst:
                wanted = base @ np.vstack([np.reshape(pose[kind][name], (3, 4)), [0, 0, 0, 1]])
                mm, degrees = difference(wanted[:3], found)
                worst[kind] = [max(worst[kind][0], mm), max(worst[kind][1], degrees)]
    print(json.dumps({**worst, "equality": violated, "poses": len(answer["poses"]), "equalities": model.neq, "joints": model.njnt, "bodies": len(given["said"])}))


if __name__ == "__main__":
    main(sys.argv[1])
