"""Corners of skinned meshes at the first key of the first animation, by NumPy from the specification of glTF 2.0:
python glb/skin.py DATA > glb/skin.json, DATA being the folder that contains models/gltf.

A corner is at the sum of w W B p: weights, places of joints in the scene, inverse bind matrices. Every 97th corner is kept.
"""
import base64
import json
import sys

import numpy as np

KINDS = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def numbers(file, index):
    accessor = file["accessors"][index]
    view = file["bufferViews"][accessor["bufferView"]]
    data = base64.b64decode(file["buffers"][view["buffer"]]["uri"].split(",")[1])
    kind, width = np.dtype(KINDS[accessor["componentType"]]), WIDTHS[accessor["type"]]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stride = view.get("byteStride", kind.itemsize * width)
    rows = [np.frombuffer(data, kind, width, start + stride * i) for i in range(accessor["count"])]
    return np.array(rows, dtype=float)


def matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"]).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", [0, 0, 0, 1])) / np.linalg.norm(node.get("rotation", [0, 0, 0, 1]))
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    local = np.eye(4)
    local[:3, :3] = turn * np.array(node.get("scale", [1, 1, 1]))
    local[:3, 3] = node.get("translation", [0, 0, 0])
    return local


def corners(path):
    file = json.load(open(path))
    nodes = [dict(node) for node in file["nodes"]]
    animation = file["animations"][0]
    for channel in animation["channels"]:
        node = nodes[channel["target"]["node"]]
        if "matrix" in node:
            # Such nodes are not animated by the specification; their parts are replaced one by one here.
            m = np.array(node.pop("matrix")).reshape(4, 4).T
            assert np.allclose(m[:3, :3], np.eye(3)), "only places are taken apart"
            node["translation"] = list(m[:3, 3])
        node[channel["target"]["path"]] = list(numbers(file, animation["samplers"][channel["sampler"]]["output"])[0])
    parent = {child: index for index, node in enumerate(nodes) for child in node.get("children", [])}

    def world(index):
        local = matrix(nodes[index])
        return world(parent[index]) @ local if index in parent else local

    out = []
    for node in nodes:
        if "skin" not in node:
            continue
        skin = file["skins"][node["skin"]]
        back = numbers(file, skin["inverseBindMatrices"])
        moves = np.array([world(j) @ back[i].reshape(4, 4).T for i, j in enumerate(skin["joints"])])
        for primitive in file["meshes"][node["mesh"]]["primitives"]:
            at = primitive["attributes"]
            p = numbers(file, at["POSITION"])
            joints, weights = numbers(file, at["JOINTS_0"]).astype(int), numbers(file, at["WEIGHTS_0"])
            weights = weights / weights.sum(axis=1, keepdims=True)
            p = np.c_[p, np.ones(len(p))]
            blended = np.einsum("cj,cjab->cab", weights, moves[joints])
            out += list(np.einsum("cab,cb->ca", blended, p)[::97, :3])
    return [[round(float(x), 7) for x in corner] for corner in out]


DATA = sys.argv[1]
print(json.dumps({name: corners(f"{DATA}/models/gltf/{name}") for name in ["cesium_man.gltf", "rigged_simple.gltf"]}))
