"""World positions of the joints of glTF files at given times: formulas of the specification in numpy, no code of this project.

    python evaluate.py DATA > evaluate.json        DATA is the folder that contains models/gltf

For each file, and each of its animations (null: where the nodes stand), five times from the first key to the last and one in the
middle of the first two keys; for each the names of the joints with their places in metres. Names are those of the file, or
`node_` and the number of a node without one. Cubic and step samplers are in `made()`, a file that this script makes itself,
since the sample that has them comes without its buffer: its bytes are in the answer, too.
"""
import base64
import json
import os
import struct
import sys

import numpy as np

TYPES = {5120: ("<i1", 127), 5121: ("<u1", 255), 5122: ("<i2", 32767), 5123: ("<u2", 65535), 5125: ("<u4", 1), 5126: ("<f4", 1)}
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def load(data, folder):
    binary = None
    if data[:4] == b"glTF":
        size = struct.unpack_from("<I", data, 12)[0]
        text, rest = data[20:20 + size], data[20 + size:]
        if rest:
            binary = rest[8:8 + struct.unpack_from("<I", rest)[0]]
    else:
        text = data
    root = json.loads(text)
    buffers = []
    for buffer in root.get("buffers", []):
        uri = buffer.get("uri")
        if uri is None:
            buffers.append(binary)
        elif uri.startswith("data:"):
            buffers.append(base64.b64decode(uri.split(",", 1)[1]))
        else:
            buffers.append(open(os.path.join(folder, uri), "rb").read())
    return root, buffers


def elements(root, buffers, view, offset, code, width, count):
    kind, most = TYPES[code]
    size = np.dtype(kind).itemsize * width
    view = root["bufferViews"][view]
    start = view.get("byteOffset", 0) + offset
    stride = view.get("byteStride", size)
    data = buffers[view["buffer"]]
    rows = [np.frombuffer(data, kind, width, start + stride * i) for i in range(count)]
    return np.array(rows, float).reshape(count, width), most


def accessor(root, buffers, index):
    a = root["accessors"][index]
    width, count, code = WIDTH[a["type"]], a["count"], a["componentType"]
    most = TYPES[code][1]
    if "bufferView" in a:
        values, most = elements(root, buffers, a["bufferView"], a.get("byteOffset", 0), code, width, count)
    else:
        values = np.zeros((count, width))
    if "sparse" in a:
        s = a["sparse"]
        where, _ = elements(root, buffers, s["indices"]["bufferView"], s["indices"].get("byteOffset", 0),
                            s["indices"]["componentType"], 1, s["count"])
        new, _ = elements(root, buffers, s["values"]["bufferView"], s["values"].get("byteOffset", 0), code, width, s["count"])
        values[where[:, 0].astype(int)] = new
    return np.maximum(values / most, -1) if a.get("normalized") else values


def unit(q):
    return q / np.linalg.norm(q)


def sample(times, values, path, mode, t):
    rotation = path == "rotation"
    cubic = mode == "CUBICSPLINE"
    keys = values[1::3] if cubic else values
    if t <= times[0] or t >= times[-1]:
        p = keys[0] if t <= times[0] else keys[-1]
        return unit(p) if rotation else p
    k = int(np.searchsorted(times, t, "right")) - 1
    if mode == "STEP":
        return unit(keys[k]) if rotation else keys[k]
    d = times[k + 1] - times[k]
    u = (t - times[k]) / d
    a, b = keys[k], keys[k + 1]
    if cubic:
        p = ((2 * u**3 - 3 * u**2 + 1) * a + d * (u**3 - 2 * u**2 + u) * values[3 * k + 2]
             + (3 * u**2 - 2 * u**3) * b + d * (u**3 - u**2) * values[3 * k + 3])
        return unit(p) if rotation else p
    if not rotation:
        return a + u * (b - a)
    a, b = unit(a), unit(b)
    cosine = a @ b
    if cosine < 0:
        b, cosine = -b, -cosine
    angle = np.arccos(min(cosine, 1.0))
    if angle < 1e-6:
        return unit(a + u * (b - a))
    return (np.sin((1 - u) * angle) * a + np.sin(u * angle) * b) / np.sin(angle)


def matrix(translation, rotation, scale):
    x, y, z, w = unit(np.array(rotation, float))
    r = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                  [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                  [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    m = np.eye(4)
    m[:3, :3] = r * np.array(scale, float)
    m[:3, 3] = translation
    return m


def places(root, buffers, animation, t):
    nodes = root["nodes"]
    parts = [{"translation": n.get("translation", [0, 0, 0]), "rotation": n.get("rotation", [0, 0, 0, 1]),
              "scale": n.get("scale", [1, 1, 1])} for n in nodes]
    moved = set()
    if animation is not None:
        found = root["animations"][animation]
        for c in found["channels"]:
            path, node = c["target"]["path"], c["target"].get("node")
            s = found["samplers"][c["sampler"]]
            if node is None or path == "weights":
                continue
            moved.add(node)
            parts[node][path] = sample(accessor(root, buffers, s["input"])[:, 0], accessor(root, buffers, s["output"]), path,
                                       s.get("interpolation", "LINEAR"), t)
    parent = {c: i for i, n in enumerate(nodes) for c in n.get("children", [])}

    def world(i):
        n, p = nodes[i], parts[i]
        own = np.array(n["matrix"], float).reshape(4, 4).T if "matrix" in n else matrix(**p)
        return world(parent[i]) @ own if i in parent else own

    joints = sorted({j for s in root.get("skins", []) for j in s["joints"]} or moved)
    return {nodes[j].get("name") or f"node_{j}": [round(x, 9) for x in world(j)[:3, 3]] for j in joints}


def answers(name, root, buffers):
    every = []
    for index in list(range(len(root.get("animations", [])))) or [None]:
        if index is None:
            every.append({"file": name, "animation": None, "time": 0.0, "joints": places(root, buffers, None, 0.0)})
            continue
        clocks = [accessor(root, buffers, s["input"])[:, 0] for s in root["animations"][index]["samplers"]]
        keys = np.unique(np.concatenate(clocks))
        times = sorted(set(np.linspace(keys[0], keys[-1], 5)) | {(keys[0] + keys[min(1, len(keys) - 1)]) / 2})
        for t in times:
            every.append({"file": name, "animation": index + 1, "time": float(t), "joints": places(root, buffers, index, float(t))})
    return every


def made():
    """A chain of four joints below a scaled root: cubic rotation, stepped translation, linear scale in bytes, a sparse accessor
    and an interleaved view, all at times of their own."""
    data = bytearray()
    views, accessors = [], []

    def add(array, kind, width, stride=None, **more):
        array = np.asarray(array)
        rows = array.reshape(-1, width)
        start = len(data)
        size = array.dtype.itemsize * width
        for row in rows:
            data.extend(row.tobytes())
            data.extend(b"\x07" * ((stride or size) - size))
        view = {"buffer": 0, "byteOffset": start, "byteLength": len(data) - start}
        if stride:
            view["byteStride"] = stride
        while len(data) % 4:
            data.append(0)
        views.append(view)
        code = {"<f4": 5126, "<i2": 5122, "|u1": 5121, "|i1": 5120}[array.dtype.str]
        accessors.append({"bufferView": len(views) - 1, "componentType": code, "count": len(rows), "type": kind, **more})
        return len(accessors) - 1

    f = lambda x: np.array(x, "<f4")
    slow = add(f([0.5, 1.0, 2.5]), "SCALAR", 1)
    fast = add(f([0.5, 1.3, 1.7, 2.5]), "SCALAR", 1, stride=12)
    rng = np.random.default_rng(3)
    turn = rng.normal(size=(9, 4))
    for key in (1, 4, 7):
        turn[key] /= np.linalg.norm(turn[key])
    cubic = add(f(turn), "VEC4", 4)
    steps = add(f([[0, 1, 0], [0.1, 1, 0], [0.1, 1.2, 0], [0, 1, 0.3]]), "VEC3", 3, stride=20)
    sizes = add(np.array([[255, 128, 64], [128, 255, 255], [200, 200, 90]], "u1"), "VEC3", 3, stride=4, normalized=True)
    quick = rng.normal(size=(4, 4))
    quick /= np.linalg.norm(quick, axis=1, keepdims=True)
    shorts = add(np.round(quick * 32767).astype("<i2"), "VEC4", 4, normalized=True)
    moves = add(f([[1, 0, 0]] * 3), "VEC3", 3)
    where = add(np.array([2], "u1"), "SCALAR", 1)
    new = add(f([[1, 0.5, -0.25]]), "VEC3", 3)
    accessors[moves]["sparse"] = {"count": 1, "indices": {"bufferView": accessors[where]["bufferView"], "componentType": 5121},
                                  "values": {"bufferView": accessors[new]["bufferView"]}}
    channels = [(1, "rotation", slow, cubic, "CUBICSPLINE"), (2, "translation", fast, steps, "STEP"), (2, "scale", slow, sizes, "LINEAR"),
                (3, "rotation", fast, shorts, "LINEAR"), (4, "translation", slow, moves, "LINEAR")]
    root = {
        "asset": {"version": "2.0"},
        "nodes": [{"name": "all", "children": [1], "scale": [0.5, 0.5, 0.5], "rotation": [0.5, 0.5, -0.5, 0.5]},
                  {"name": "a", "children": [2]}, {"name": "b", "children": [3], "translation": [0, 1, 0]},
                  {"name": "a", "children": [4], "translation": [0, 0.8, 0.1]}, {"translation": [1, 0, 0]}],
        "skins": [{"joints": [1, 2, 3, 4]}],
        "animations": [{"samplers": [{"input": i, "output": o, "interpolation": m} for _, _, i, o, m in channels],
                        "channels": [{"sampler": k, "target": {"node": c[0], "path": c[1]}} for k, c in enumerate(channels)]}],
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(bytes(data)).decode()}],
        "bufferViews": views, "accessors": accessors}
    return root, [bytes(data)]


if __name__ == "__main__":
    folder = os.path.join(sys.argv[1], "models", "gltf")
    every = []
    for name in sorted(os.listdir(folder)):
        if name.endswith((".gltf", ".glb")):
            try:
                root, buffers = load(open(os.path.join(folder, name), "rb").read(), folder)
            except FileNotFoundError as lost:
                print(name, "without", lost.filename, file=sys.stderr)
                continue
            every += answers(name, root, buffers)
    root, buffers = made()
    # Two joints have one name: the second is called a#2.
    for answer in answers("made", {**root, "nodes": [{**n, "name": "a#2"} if i == 3 else n for i, n in enumerate(root["nodes"])]}, buffers):
        every.append(answer)
    json.dump({"made": root, "answers": every}, sys.stdout, separators=(",", ":"))
    print()
