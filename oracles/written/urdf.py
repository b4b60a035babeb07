"""Loads a written .urdf in Pinocchio and compares its links with the model that was written.

    python urdf.py FILE.urdf [KEEP]     (FILE.urdf.json beside it, from the example `written` of the facade)

Once with mimics, where Pinocchio computes the joints that mimic others, and those that cannot mimic any are set from the
model (`follows`); once with all joints set (`all_given`). Pinocchio 4.1 refuses a mimic of a joint that comes after it in the
tree, though URDF allows it: there the script multiplies (`mimics`). Prints one line of JSON: the largest differences in mm,
degrees and percent of stretch, links beyond 0.5 mm or 0.1 degrees, and the links at the first KEEP poses (none).
"""

import json
import sys
import xml.etree.ElementTree as tree

import numpy as np
import pinocchio as pin

import common


def main(path, keep):
    answer = common.read(path)
    models = {False: pin.buildModelFromUrdf(path, mimic=False)}
    couplings = []
    try:
        models[True] = pin.buildModelFromUrdf(path, mimic=True)
    except ValueError as error:
        assert "not in the kinematic tree" in str(error), error
        models[True] = models[False]
        for joint in tree.parse(path).getroot().iter("joint"):
            for mimic in joint.iter("mimic"):
                factor, offset = float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0))
                couplings.append((joint.get("name"), [mimic.get("joint")], lambda x, f=factor, o=offset: f * x[0] + o))
    datas = {only: model.createData() for only, model in models.items()}
    joints = answer["poses"][0]["joints"]
    all_names = set(list(models[False].names)[1:])
    assert all_names == set(joints), all_names ^ set(joints)
    coupled = {name for name, *_ in couplings} | {name for name in all_names if models[True].joints[models[True].getJointId(name)].nq == 0
               or "mimic" in models[True].joints[models[True].getJointId(name)].shortname().lower()}
    given = [name for name in joints if name not in coupled]

    def place(pose, only):
        model, data = models[only], datas[only]
        q = pin.neutral(model)
        values = pose["joints"]
        if only:
            values = common.chain(couplings, {n: values[n] for n in given})
        for name, value in values.items():
            joint = model.joints[model.getJointId(name)]
            at = joint.idx_q
            if joint.nq == 2:
                q[at:at + 2] = np.cos(value), np.sin(value)
            else:
                q[at] = value
        pin.framesForwardKinematics(model, data, q)
        found = {}
        for name in pose["true"]:
            assert model.existFrame(name, pin.FrameType.BODY), f"no link {name}"
            found[name] = data.oMf[model.getFrameId(name, pin.FrameType.BODY)].homogeneous[:3]
        return found

    result = common.run(f"Pinocchio {pin.__version__}", answer, given, place, keep)
    result.update(couplings=len(coupled), mimics="script" if couplings else "Pinocchio")
    print(json.dumps(result))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 0)
