"""Loads a written MJCF file in MuJoCo and compares its bodies with the model that was written.

    python mjcf.py FILE.mjcf [KEEP]      (FILE.mjcf.json beside it, from the example `written` of the facade)

Once with joints that follow others computed from the equalities and tendons that MuJoCo read, and those that no
equality can couple set from the model (`follows`); once with all joints set (`all_given`). Prints one line of JSON: the
largest differences in mm, degrees and percent of stretch, bodies beyond 0.5 mm or 0.1 degrees, the largest violation
of an equality that MuJoCo computes itself at those values (`equality`) and over 0.5 s of simulation in which the
joints that are set have speeds (`simulated`), radians or metres; and the bodies at the first KEEP poses (none).
"""

import json
import sys

import mujoco
import numpy as np

import common


def main(path, keep):
    answer = common.read(path)
    with open(path) as file:
        model = mujoco.MjModel.from_xml_string(file.read())
    data = mujoco.MjData(model)
    names = [model.joint(i).name for i in range(model.njnt)]
    joints = answer["poses"][0]["joints"]
    assert set(names) == set(joints), set(names) ^ set(joints)
    address = {name: model.jnt_qposadr[i] for i, name in enumerate(names)}
    zero = {name: model.qpos0[address[name]] for name in names}
    couplings = []
    for i in range(model.neq):
        one, two, numbers = model.eq_obj1id[i], model.eq_obj2id[i], model.eq_data[i][:5]
        if model.eq_type[i] == mujoco.mjtEq.mjEQ_JOINT:
            follower, leader = names[one], names[two]

            def value(x, numbers=numbers, follower=follower, leader=leader):
                return zero[follower] + np.polyval(numbers[::-1], x[0] - zero[leader])

            couplings.append((follower, [leader], value))
        elif model.eq_type[i] == mujoco.mjtEq.mjEQ_TENDON:
            first, count = model.tendon_adr[one], model.tendon_num[one]
            parts = [(names[model.wrap_objid[k]], model.wrap_prm[k]) for k in range(first, first + count)]
            (follower, own), others = parts[0], parts[1:]

            def sum_of(x, own=own, others=others, rest=model.tendon_length0[one] + numbers[0]):
                return (rest - sum(c * v for (_, c), v in zip(others, x))) / own

            couplings.append((follower, [n for n, _ in others], sum_of))
    coupled = {name for name, *_ in couplings}
    given = [name for name in names if name not in coupled]
    violated = 0.0

    def equalities():
        rows = data.efc_type[:data.nefc] == mujoco.mjtConstraint.mjCNSTR_EQUALITY
        return float(np.abs(data.efc_pos[:data.nefc][rows]).max()) if np.any(rows) else 0.0

    def place(pose, only):
        nonlocal violated
        values = pose["joints"]
        if only:
            values = common.chain(couplings, {n: values[n] for n in given})
        for name, value in values.items():
            data.qpos[address[name]] = value
        mujoco.mj_fwdPosition(model, data)
        if only:
            violated = max(violated, equalities())
        return {n: np.column_stack([data.body(n).xmat.reshape(3, 3), data.body(n).xpos]) for n in pose["true"]}

    result = common.run(f"MuJoCo {mujoco.__version__}", answer, given, place, keep)
    # What the solver makes of the equalities: without gravity, from the default pose.
    model.opt.gravity[:] = 0
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for name in given:
        data.qvel[model.joint(name).dofadr[0]] = 0.2
    worst = 0.0
    for _ in range(int(0.5 / model.opt.timestep)):
        mujoco.mj_step(model, data)
        worst = max(worst, equalities())
    warned = int(sum(data.warning[i].number for i in range(len(data.warning))))
    result.update(couplings=model.neq, equality=float(f"{violated:.2g}"), simulated=float(f"{worst:.2g}"), warnings=warned)
    print(json.dumps(result))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 0)
