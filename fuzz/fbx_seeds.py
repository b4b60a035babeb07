#!/usr/bin/env python3
"""Writes the seeds of the target `fbx`: one small skeleton with an animation, as text and in both binary forms.

    fuzz/fbx_seeds.py [FOLDER]

Two limbs, the lower one with pre-rotation, a pivot and another order of rotation; its rotation about x has three keys.
"""

import struct
import sys
import zlib
from pathlib import Path

SECOND = 46186158000


def node(name, values=(), children=()):
    return name, list(values), list(children)


def prop(name, kind, label, flag, *values):
    return node("P", [name, kind, label, flag, *values])


class Long(int):
    """A number of 64 bits."""


def tree(version):
    def model(id_, name, kind, properties):
        return node("Model", [Long(id_), ("Model", name), kind],
                    [node("Version", [232]), node("Properties70", [], properties)])

    vector = ["Vector3D", "Vector", ""]
    lower = [
        prop("RotationActive", "bool", "", "", 1),
        prop("RotationOrder", "enum", "", "", 4),
        prop("PreRotation", *vector, 0.0, 0.0, 30.0),
        prop("RotationPivot", *vector, 0.0, 1.0, 0.0),
        prop("InheritType", "enum", "", "", 2),
        prop("Lcl Translation", "Lcl Translation", "", "A", 0.0, 40.0, 0.0),
        prop("Lcl Rotation", "Lcl Rotation", "", "A", 10.0, 0.0, 0.0),
        prop("Lcl Scaling", "Lcl Scaling", "", "A", 1.0, 1.5, 1.0),
    ]
    keys = [0, SECOND // 2, SECOND]
    curve = node("AnimationCurve", [Long(40), ("AnimCurve", ""), ""], [
        node("Default", [0.0]), node("KeyVer", [4009]),
        node("KeyTime", [[Long(key) for key in keys]]),
        node("KeyValueFloat", [("floats", [0.0, 45.0, 10.0])]),
        node("KeyAttrFlags", [[24836]]), node("KeyAttrDataFloat", [("floats", [0.0, 0.0, 9.4e-39, 0.0])]),
        node("KeyAttrRefCount", [[3]]),
    ])
    objects = [
        node("NodeAttribute", [Long(10), ("NodeAttribute", "upper"), "LimbNode"], [node("TypeFlags", ["Skeleton"])]),
        node("NodeAttribute", [Long(11), ("NodeAttribute", "lower"), "LimbNode"], [node("TypeFlags", ["Skeleton"])]),
        model(20, "upper", "LimbNode", [prop("Lcl Translation", "Lcl Translation", "", "A", 0.0, 90.0, 0.0)]),
        model(21, "lower", "LimbNode", lower),
        node("AnimationStack", [Long(30), ("AnimStack", "bend"), ""], [node("Properties70", [], [
            prop("LocalStart", "KTime", "Time", "", Long(0)), prop("LocalStop", "KTime", "Time", "", Long(SECOND))])]),
        node("AnimationLayer", [Long(31), ("AnimLayer", "base"), ""]),
        node("AnimationCurveNode", [Long(32), ("AnimCurveNode", "R"), ""],
             [node("Properties70", [], [prop("d|X", "Number", "", "A", 0.0)])]),
        curve,
    ]
    links = [["OO", 20, 0], ["OO", 10, 20], ["OO", 21, 20], ["OO", 11, 21], ["OO", 31, 30], ["OO", 32, 31],
             ["OP", 32, 21, "Lcl Rotation"], ["OP", 40, 32, "d|X"]]
    axes = [("UpAxis", 2), ("UpAxisSign", 1), ("FrontAxis", 1), ("FrontAxisSign", -1), ("CoordAxis", 0),
            ("CoordAxisSign", 1), ("TimeMode", 6)]
    return [
        node("FBXHeaderExtension", [], [node("FBXHeaderVersion", [1003]), node("FBXVersion", [version])]),
        node("GlobalSettings", [], [node("Version", [1000]), node("Properties70", [],
             [prop(name, "int", "Integer", "", value) for name, value in axes]
             + [prop("UnitScaleFactor", "double", "Number", "", 1.0)])]),
        node("Definitions", [], [node("Version", [100]), node("Count", [8])]),
        node("Objects", [], objects),
        node("Connections", [], [node("C", [kind, *map(Long, ids[:2]), *ids[2:]]) for kind, *ids in links]),
    ]


def text(nodes, depth=0):
    lines = []
    for name, values, children in nodes:
        indent = "\t" * depth
        if values and isinstance(values[0], list) or values and isinstance(values[0], tuple) and values[0][0] == "floats":
            numbers = values[0] if isinstance(values[0], list) else values[0][1]
            lines.append(f"{indent}{name}: *{len(numbers)} {{")
            lines.append(f"{indent}\ta: {','.join(map(str, numbers))}")
            lines.append(indent + "}")
            continue
        def one(value):
            if isinstance(value, tuple):
                return f'"{value[0]}::{value[1]}"'
            return f'"{value}"' if isinstance(value, str) else repr(value + 0)
        said = ", ".join(one(value) for value in values)
        if children:
            lines.append(f"{indent}{name}: {said} {{")
            lines.extend(text(children, depth + 1))
            lines.append(indent + "}")
        else:
            lines.append(f"{indent}{name}: {said}")
    return lines


def packed(value):
    """A value of a binary node."""
    if isinstance(value, tuple) and value[0] == "floats":
        data = struct.pack(f"<{len(value[1])}f", *value[1])
        return b"f" + struct.pack("<III", len(value[1]), 0, len(data)) + data
    if isinstance(value, list):
        kind, code = (b"l", "q") if isinstance(value[0], Long) else (b"i", "i")
        data = zlib.compress(struct.pack(f"<{len(value)}{code}", *value))
        return kind + struct.pack("<III", len(value), 1, len(data)) + data
    if isinstance(value, tuple):
        value = value[1] + "\0\1" + value[0]
    if isinstance(value, str):
        return b"S" + struct.pack("<I", len(value)) + value.encode()
    if isinstance(value, float):
        return b"D" + struct.pack("<d", value)
    return b"L" + struct.pack("<q", value) if isinstance(value, Long) else b"I" + struct.pack("<i", value)


def binary(version):
    word = "<Q" if version >= 7500 else "<I"
    width = struct.calcsize(word)
    empty = bytes(3 * width + 1)

    def written(nodes, start):
        out = b""
        for name, values, children in nodes:
            body = b"".join(packed(value) for value in values)
            head = 3 * width + 1 + len(name)
            inner = written(children, start + len(out) + head + len(body)) + empty if children else b""
            end = start + len(out) + head + len(body) + len(inner)
            numbers = b"".join(struct.pack(word, n) for n in (end, len(values), len(body)))
            out += numbers + bytes([len(name)]) + name.encode() + body + inner
        return out

    head = b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", version)
    return head + written(tree(version), len(head)) + empty


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "seeds" / "fbx"
    folder.mkdir(parents=True, exist_ok=True)
    said = "; FBX 7.4.0 project file\n" + "\n".join(text(tree(7400))) + "\n"
    (folder / "limb.fbx").write_text(said)
    (folder / "limb_7400.fbx").write_bytes(binary(7400))
    (folder / "limb_7500.fbx").write_bytes(binary(7500))


main()
