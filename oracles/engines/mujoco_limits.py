"""What MuJoCo makes of the numbers of `condyle limits engine`, for 10 000 rotations.

    python mujoco_limits.py TABLE.json > mujoco.json

TABLE.json is what `condyle limits engine L.toml -o TABLE.json` wrote, of any limit. Needs mujoco, numpy and scipy.

- `mujoco ball`, `mujoco hinges`: a body with the joints of the table is turned as each rotation says (the body's orientation, as
  MuJoCo has it, is compared with the rotation), and is out where MuJoCo itself makes a row for a joint's limit.
- the other laws: MuJoCo tells how a site in the child with `frame_in_child` is turned in a site of the reference with
  `frame_in_reference`. That is parted into swing and twist, and the law's formula asked, here again by themselves.

The answers are a bit for each rotation, 1 where it is in, most significant first, in hexadecimal. Rotations are the even ones of
Alexa 2022, with 0.55 of their angle, before which stands the middle of the law.
"""
import json, sys
import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

COUNT = 10_000
table = json.load(open(sys.argv[1]))


def spiral(n):
    s = np.arange(n) + 0.5
    a, b = 2 * np.pi * s / np.sqrt(2), 2 * np.pi * s / 1.5337511687552043
    r, R = np.sqrt(s / n), np.sqrt(1 - s / n)
    return np.stack([r * np.sin(a), r * np.cos(a), R * np.sin(b), R * np.cos(b)], 1)


near = Rotation.from_rotvec(0.55 * Rotation.from_quat(spiral(COUNT)).as_rotvec())
text = lambda numbers: " ".join(repr(float(x)) for x in numbers)
first = lambda q: [q[3], *q[:3]]


def bits(answers):
    return np.packbits(np.array(answers, bool)).tobytes().hex()


def model(entry):
    """The reference is the world; the child turns in it."""
    settings = entry["settings"]
    if "joint" in settings:
        quat = settings["body quat"]
        joints = "".join(
            f'<joint type="{j["type"]}" limited="true" range="{text(j["range"])}"'
            + (f' axis="{text(j["axis"])}"' if "axis" in j else "") + "/>"
            for j in settings["joint"])
    else:
        quat, joints = [1, 0, 0, 0], '<joint type="ball"/>'
    return mujoco.MjModel.from_xml_string(f"""
        <mujoco><compiler angle="radian"/><option gravity="0 0 0"/><worldbody>
          <site name="reference" quat="{text(first(entry['frame_in_reference']))}"/>
          <body quat="{text(quat)}">{joints}<geom size="0.1" contype="0" conaffinity="0"/>
            <site name="child" quat="{text(first(entry['frame_in_child']))}"/></body>
        </worldbody><sensor>
          <framequat objtype="site" objname="child" reftype="site" refname="reference"/>
        </sensor></mujoco>""")


def in_law(entry, c):
    """The formulas of the engines, of a rotation w x y z in the constraint's frames."""
    w, x, y, z = c
    a, b = np.radians([entry["swing_y_deg"], entry["swing_z_deg"]])
    twist = np.radians(entry["twist_deg"][1])
    turn = Rotation.from_quat([x, 0, 0, w])
    sx, sy, sz, sw = (Rotation.from_quat([x, y, z, w]) * turn.inv()).as_quat()
    assert abs(sx) < 1e-12
    if sw < 0:
        sy, sz, sw = -sy, -sz, -sw
    if abs(turn.as_rotvec()[0]) > twist:
        return False
    law = entry["law"]
    if law == "jolt cone":
        return (sy / np.sin(a / 2)) ** 2 + (sz / np.sin(b / 2)) ** 2 <= 1
    if law == "jolt pyramid":
        return abs(2 * np.arctan2(sy, sw)) <= a and abs(2 * np.arctan2(sz, sw)) <= b
    u, v = 4 * np.arctan2(sy, 1 + sw), 4 * np.arctan2(sz, 1 + sw)
    if law == "physx cone":
        return (u / a) ** 2 + (v / b) ** 2 <= 1
    if law == "physx pyramid":
        return abs(u) <= a and abs(v) <= b
    assert law == "cone"
    _, u, v = Rotation.from_quat([0, sy, sz, sw]).as_rotvec()
    return (u / a) ** 2 + (v / b) ** 2 <= 1


def answers(entry):
    entry.setdefault("settings", {})
    m = model(entry)
    d = mujoco.MjData(m)
    rotations = Rotation.from_quat(entry["middle"]) * near
    body = Rotation.from_quat(np.roll(m.body_quat[1], -1))
    local = body.inv() * rotations
    frame = Rotation.from_quat(entry["frame_in_child"])
    found, worst = [], 0.0
    for k in range(COUNT):
        if m.nq == 4:
            d.qpos[:] = np.roll(local[k].as_quat(), 1)
        else:
            # The hinges' axes are y, z, x of the frame: three angles of local = frame·Ry·Rz·Rx·frame⁻¹.
            d.qpos[:] = (frame.inv() * local[k] * frame).as_euler("YZX")
        mujoco.mj_forward(m, d)
        turned = Rotation.from_quat(np.roll(d.xquat[1], -1))
        worst = max(worst, (turned.inv() * rotations[k]).magnitude())
        if "joint" in entry["settings"]:
            found.append(not np.any(d.efc_type == mujoco.mjtConstraint.mjCNSTR_LIMIT_JOINT))
        else:
            found.append(bool(in_law(entry, d.sensordata)))
    assert worst < 1e-7, worst
    kept = {k: entry[k] for k in ("law", "middle", "frame_in_child", "frame_in_reference", "swing_y_deg", "swing_z_deg", "settings")}
    return {**kept, "twist_deg": entry.get("twist_deg", [-180, 180]), "in": int(sum(found)), "bits": bits(found)}


entries = [answers(entry) for entry in [table["cone_twist"], *table["engines"]]]
print(json.dumps({"mujoco": mujoco.__version__, "rotations": COUNT, "laws": entries}, indent=1))
