"""Synthetic poses of SMPL, SMPL-H and SMPL-X with synthetic bodies, and where their joints are, by NumPy and SciPy.

    python evaluate.py > answers.json          positions of all joints, y up
    python evaluate.py --files FOLDER          the same poses and bodies as numpy.savez writes them

No number comes from a published body: corners, weights and poses are sines, so that a reader's test can make the same
files itself. Positions are those of the usual formula: with J the places of joints at rest,

    J = J_regressor (v_template + shapedirs betas)
    G(0) = [R(0) | J(0) + trans],  G(j) = G(parent) [R(j) | J(j) - J(parent)],  R = exp(pose)

and then turned so that y is up. Needs numpy and scipy.
"""

import json
import sys
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

CORNERS, FRAMES, SHAPES = 120, 3, 10
TRUNK = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19]


def fingers(first):
    """Parents of five fingers of three joints on each wrist."""
    return [
        wrist if number == 0 else first + 15 * hand + 3 * finger + number - 1
        for hand, wrist in enumerate((20, 21))
        for finger in range(5)
        for number in range(3)
    ]


TREES = {
    "smpl": TRUNK + [20, 21],
    "smplh": TRUNK + fingers(22),
    "smplx": TRUNK + [15, 15, 15] + fingers(25),
}


def body(tree):
    parents = TREES[tree]
    i = np.arange(CORNERS)
    v_template = np.stack(
        [0.9 * np.sin(1.1 * i), 1.2 * np.cos(0.7 * i + 0.3), 0.5 * np.sin(2.3 * i + 1)], 1
    )
    axis, beta = np.arange(3), np.arange(SHAPES)
    shapedirs = 0.02 * np.sin(i[:, None, None] + 2 * axis[None, :, None] + 3 * beta)
    regressor = np.zeros((len(parents), CORNERS))
    for joint in range(len(parents)):
        for corner, weight in ((7 * joint + 1, 0.5), (11 * joint + 5, 0.3), (13 * joint + 2, 0.2)):
            regressor[joint, corner % CORNERS] += weight
    kintree = np.array([parents, range(len(parents))]).astype(np.uint32)
    return dict(
        v_template=v_template, shapedirs=shapedirs, J_regressor=regressor, kintree_table=kintree
    )


def poses(tree):
    joints = len(TREES[tree])
    t, k = np.arange(FRAMES)[:, None], np.arange(3 * joints)[None, :]
    pose = 0.6 * np.sin(0.9 * t + 0.37 * k)
    # Upright: along z as in AMASS, but SMPL's along y and SMPL-X's against y, as in a camera's view.
    lean = {"smpl": 0.0, "smplh": np.pi / 2, "smplx": np.pi}[tree]
    t = t[:, 0]
    pose[:, :3] = np.stack([lean + 0.1 * np.sin(t), 0.05 * np.cos(t), 0.1 * np.sin(2.0 * t)], 1)
    trans = np.stack([0.1 * t, -0.2 * t, 0.9 + 0.01 * t], 1)
    return pose, trans, 0.5 * np.cos(np.arange(SHAPES))


def answer(tree):
    model, (pose, trans, betas) = body(tree), poses(tree)
    at_rest = model["J_regressor"] @ (model["v_template"] + model["shapedirs"] @ betas)
    parents = TREES[tree]
    back = {"smpl": 0.0, "smplh": -np.pi / 2, "smplx": np.pi}[tree]
    upright = Rotation.from_rotvec([back, 0, 0])
    frames = []
    for vectors, place in zip(pose, trans):
        turns, places = [], []
        for joint, parent in enumerate(parents):
            own = Rotation.from_rotvec(vectors[3 * joint : 3 * joint + 3])
            if parent < 0:
                turns.append(own)
                places.append(at_rest[0] + place)
            else:
                turns.append(turns[parent] * own)
                step = at_rest[joint] - at_rest[parent]
                places.append(places[parent] + turns[parent].apply(step))
        frames.append([[round(float(x), 12) for x in upright.apply(p)] for p in places])
    return frames


def files(folder):
    """What NumPy writes, in the layouts that are about."""
    folder.mkdir(parents=True, exist_ok=True)
    pose, trans, betas = poses("smplh")
    np.savez(
        folder / "amass_smplh.npz",
        poses=pose, trans=trans, betas=np.pad(betas, (0, 6)), gender=np.array("male"),
        mocap_framerate=np.array(120.0), dmpls=np.zeros((FRAMES, 8)),
    )  # fmt: skip
    pose, trans, betas = poses("smplx")
    np.savez_compressed(
        folder / "amass_smplx.npz",
        root_orient=pose[:, :3], pose_body=pose[:, 3:66], pose_jaw=pose[:, 66:69],
        pose_eye=pose[:, 69:75], pose_hand=pose[:, 75:], trans=trans, betas=betas, poses=pose,
        gender="neutral", mocap_frame_rate=np.float64(60), surface_model_type="smplx",
    )  # fmt: skip
    np.savez_compressed(
        folder / "parts.npz",
        global_orient=pose[:, :3].astype(">f4"), body_pose=np.asfortranarray(pose[:, 3:66]),
        jaw_pose=pose[:, 66:69], leye_pose=pose[:, 69:72], reye_pose=pose[:, 72:75],
        left_hand_pose=pose[:, 75:120], right_hand_pose=pose[:, 120:], transl=trans, betas=betas[None],
    )  # fmt: skip
    pose, trans, betas = poses("smpl")
    np.savez(folder / "smpl.npz", poses=pose.astype(np.float32), trans=trans, betas=betas)
    matrices = Rotation.from_rotvec(pose.reshape(-1, 3)).as_matrix().reshape(FRAMES, -1, 3, 3)
    np.savez_compressed(
        folder / "matrices.npz", global_orient=matrices[:, :1], body_pose=matrices[:, 1:], transl=trans
    )
    small = {key: value for key, value in body("smpl").items()}
    np.savez_compressed(folder / "body.npz", **small)
    from scipy import sparse

    columns = sparse.csc_matrix(small.pop("J_regressor"))
    small.update(
        J_regressor_data=columns.data, J_regressor_indices=columns.indices,
        J_regressor_indptr=columns.indptr, J_regressor_format="csc",
    )  # fmt: skip
    np.savez_compressed(folder / "sparse_body.npz", **small)
    # To be refused: a dictionary that is pickled.
    np.savez(folder / "pickled.npz", poses=np.array({"poses": 1}, dtype=object))


if __name__ == "__main__":
    if "--files" in sys.argv:
        files(Path(sys.argv[-1]))
    else:
        print(json.dumps({tree: answer(tree) for tree in TREES}))
