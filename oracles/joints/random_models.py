#!/usr/bin/env python3
"""Random OpenSim models, and where OpenSim puts their bodies.

    pip install opensim numpy
    python random_models.py OUT_DIR N SEED [--reverse-all] [--pack FILE COUNT]

Every model is stated as XML, loaded by OpenSim, printed by it and loaded again; the printed file is kept and the
answers are those of the printed file. For each there are three poses, with couplers met by OpenSim's own functions:
OUT_DIR/random_0000.osim and OUT_DIR/random_0000.json with

    model     the file
    kinds     motion type of each coordinate as OpenSim has it: 1 rotation, 2 translation, 3 other
    coupled   coordinates that follow others
    poses     pose {coordinate: radians or metres}, segments {body: 16 numbers by rows (12 when packed)}, markers {name: place in ground}

Bodies that OpenSim may have doubled to open a loop are left out, with their markers. A coordinate goes by its name where that
is unique, else by joint/name. Models that OpenSim refuses are counted by reason and left out. `--reverse-all` also states
ellipsoid, scapulothoracic and constant curvature joints backwards, which OpenSim survives only partly. `--pack` writes the
first COUNT models and their answers into one compact JSON file.
"""
import json
import os
import re
import sys
from collections import Counter

import numpy as np
import opensim as osim

JOINTS = ["WeldJoint", "PinJoint", "SliderJoint", "UniversalJoint", "BallJoint", "GimbalJoint", "PlanarJoint", "FreeJoint",
          "CustomJoint", "CustomJoint", "CustomJoint", "EllipsoidJoint", "ScapulothoracicJoint", "ConstantCurvatureJoint"]
COORDINATES = {"WeldJoint": 0, "PinJoint": 1, "SliderJoint": 1, "UniversalJoint": 2, "BallJoint": 3, "GimbalJoint": 3,
               "PlanarJoint": 3, "FreeJoint": 6, "EllipsoidJoint": 3, "ScapulothoracicJoint": 4, "ConstantCurvatureJoint": 3}
REVERSIBLE = [j for j in COORDINATES if j not in ("EllipsoidJoint", "ScapulothoracicJoint", "ConstantCurvatureJoint")]
LAWS_REVERSED = "--reverse-all" in sys.argv


def numbers(values):
    """As multiples of 1/256, which have few digits and lose none of them in print."""
    return " ".join(f"{round(float(v) * 256) / 256:g}" if v == round(v) else repr(round(float(v) * 256) / 256)
                    for v in np.atleast_1d(values))


def tag(name, text):
    return f"<{name}>{text}</{name}>"


class Generator:
    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)
        self.coordinates = []       # every coordinate name, in order
        self.couplers = []

    def chance(self, p):
        return self.rng.random() < p

    def pick(self, items):
        return items[self.rng.integers(len(items))]

    def normal(self, n=None, scale=1.0):
        return self.rng.normal(size=n) * scale

    def knots(self, least):
        n = int(self.rng.integers(least, 9))
        x = np.cumsum(self.rng.uniform(0.05, 0.6, n)) - self.rng.uniform(0.3, 1.5)
        return tag("x", numbers(x)) + tag("y", numbers(self.normal(n, 0.5)))

    def function(self, arity, depth=0):
        if arity == 0:
            return f"<Constant>{tag('value', numbers(self.normal(scale=0.3)))}</Constant>"
        kinds = ["LinearFunction", "MultiplierFunction"]
        kinds += ["SimmSpline", "PolynomialFunction", "PiecewiseLinearFunction", "Unit"] if arity == 1 else []
        kinds += ["MultivariatePolynomialFunction"] * (2 if arity > 1 else 1)
        kind = self.pick(kinds)
        if kind == "Unit":          # a coordinate as it is, or nearly
            slope = self.pick([1.0, 1.0, -1.0])
            body = tag("coefficients", numbers([slope, self.pick([0.0, 0.0, 0.3])]))
            return f"<LinearFunction>{body}</LinearFunction>"
        if kind == "MultiplierFunction":
            if depth > 2:
                return self.function(arity, 3)
            inner = self.function(arity, depth + 1)
            return f"<{kind}><function>{inner}</function>{tag('scale', numbers(self.normal(scale=0.8)))}</{kind}>"
        if kind in ("SimmSpline", "PiecewiseLinearFunction"):
            return f"<{kind}>{self.knots(2 if kind == 'SimmSpline' else 1)}</{kind}>"
        if kind == "MultivariatePolynomialFunction":
            order = int(self.rng.integers(1, 4))
            count = 1
            for k in range(1, order + 1):
                count = count * (arity + k) // k
            body = tag("coefficients", numbers(self.normal(count, 0.4)))
            return f"<{kind}>{body}{tag('dimension', arity)}{tag('order', order)}</{kind}>"
        count = arity + 1 if kind == "LinearFunction" else int(self.rng.integers(1, 6))
        return f"<{kind}>{tag('coefficients', numbers(self.normal(count, 0.5)))}</{kind}>"

    def coordinate_name(self, taken):
        again = [c for c in self.coordinates if c not in taken]
        name = self.pick(again) if again and self.chance(0.06) else f"q{len(self.coordinates)}"
        self.coordinates.append(name)
        return name

    def coordinate(self, name):
        default = float(self.normal(scale=0.2))
        lower, upper = default - self.rng.uniform(0.1, 2), default + self.rng.uniform(0.1, 2)
        body = tag("default_value", numbers(default)) + tag("range", numbers([lower, upper]))
        body += tag("clamped", str(self.chance(0.4)).lower()) + tag("locked", str(self.chance(0.1)).lower())
        return f'<Coordinate name="{name}">{body}</Coordinate>'

    def spatial_transform(self, names):
        """Six axes, none parallel to another of its three; every coordinate drives at least one."""
        axes = [[] for _ in range(6)]
        for axis in axes:
            if self.chance(0.6):
                count = min(len(names), self.pick([1, 1, 1, 2, 3]))
                axis.extend(self.rng.permutation(names)[:count])
        for name in names:
            if not any(name in axis for axis in axes):
                axes[self.rng.integers(6)] = [name]
        tags = []
        oblique = self.chance(0.8)
        for i, drivers in enumerate(axes):
            direction = self.normal(3) if oblique else np.eye(3)[i % 3] * self.pick([1, -1])
            name = f"{'rotation' if i < 3 else 'translation'}{i % 3 + 1}"
            body = tag("coordinates", " ".join(drivers)) + tag("axis", numbers(direction))
            if drivers or self.chance(0.5):
                body += self.function(len(drivers)).join(["<function>", "</function>"])
            tags.append(f'<TransformAxis name="{name}">{body}</TransformAxis>')
        order = self.rng.permutation(6) if self.chance(0.3) else range(6)
        return tag("SpatialTransform", "".join(tags[i] for i in order))

    def offset(self, name, parent):
        body = tag("socket_parent", parent) + tag("translation", numbers(self.normal(3, 0.3)))
        body += tag("orientation", numbers(self.normal(3, 0.8)))
        return f'<PhysicalOffsetFrame name="{name}">{body}</PhysicalOffsetFrame>'

    def end(self, body, joint, which, frames, parts):
        """A frame for one end of a joint: the body, a frame of the joint, one in the body, or a frame of a frame."""
        base = "/ground" if body == "ground" else f"/bodyset/{body}"
        how = self.pick(["body", "own", "own", "own of own", "part", "own of part"])
        if body == "ground" and "part" in how:
            how = "own"
        if how == "body":
            return base
        if "part" in how:
            name = f"{body}_part_{len(parts[body])}"
            parts[body].append(self.offset(name, base))
            base = f"{base}/{name}"
            if how == "part":
                return base
        if how == "own of own":
            frames.append(self.offset(f"{which}_inner", base))
            base = f"/jointset/{joint}/{which}_inner"
        frames.append(self.offset(f"{which}_offset", base))
        return f"{which}_offset"

    def joint(self, name, kind, parent, child, parts):
        frames, taken = [], []
        p, c = self.end(parent, name, "parent", frames, parts), self.end(child, name, "child", frames, parts)
        count = COORDINATES.get(kind, int(self.rng.integers(1, 5)))
        for _ in range(count):
            taken.append(self.coordinate_name(taken))
        body = tag("socket_parent_frame", p) + tag("socket_child_frame", c)
        body += tag("coordinates", "".join(self.coordinate(n) for n in taken)) if taken else ""
        body += tag("frames", "".join(frames)) if frames else ""
        radii = numbers(self.rng.uniform(0.05, 0.5, 3))
        if kind == "CustomJoint":
            body += self.spatial_transform(taken)
        elif kind == "EllipsoidJoint":
            body += tag("radii_x_y_z", radii)
        elif kind == "ScapulothoracicJoint":
            body += tag("thoracic_ellipsoid_radii_x_y_z", radii)
            body += tag("scapula_winging_axis_origin", numbers(self.normal(2, 0.1)))
            body += tag("scapula_winging_axis_direction", numbers(self.normal()))
        elif kind == "ConstantCurvatureJoint":
            body += tag("neutral_angle_x_z_y", numbers(self.normal(3, 0.1)))
            body += tag("length", numbers(self.rng.uniform(0.1, 1)))
        return f'<{kind} name="{name}">{body}</{kind}>'

    def coupler(self, index, free):
        """The last of some unique coordinates follows the others, earlier ones first: never a circle."""
        count = self.pick([1, 1, 2, 3])
        if len(free) <= count:
            return ""
        chosen = sorted(self.rng.choice(len(free), count + 1, replace=False))
        drivers, follower = [free[i] for i in chosen[:-1]], free[chosen[-1]]
        if follower in self.couplers:
            return ""
        self.couplers.append(follower)
        body = tag("coupled_coordinates_function", self.function(count))
        body += tag("independent_coordinate_names", " ".join(drivers)) + tag("dependent_coordinate_name", follower)
        body += tag("scale_factor", numbers(self.pick([1.0, float(self.normal())])))
        return f'<CoordinateCouplerConstraint name="coupler_{index}">{body}</CoordinateCouplerConstraint>'

    def constraint(self, index, bodies):
        a, b = self.rng.choice(bodies, 2, replace=False)
        kind = self.pick(["PointConstraint", "ConstantDistanceConstraint", "WeldConstraint"])
        if kind == "WeldConstraint":
            body = tag("socket_frame1", f"/bodyset/{a}") + tag("socket_frame2", f"/bodyset/{b}")
        else:
            body = tag("socket_body_1", f"/bodyset/{a}") + tag("socket_body_2", f"/bodyset/{b}")
            body += tag("location_body_1", numbers(self.normal(3))) + tag("location_body_2", numbers(self.normal(3)))
            body += tag("constant_distance", "0.7") if kind.startswith("Constant") else ""
        return f'<{kind} name="constraint_{index}">{body}</{kind}>'

    def model(self):
        bodies = [f"b{i}" for i in range(int(self.rng.integers(3, 11)))]
        parts = {name: [] for name in bodies}
        joints = []
        for i, child in enumerate(bodies):
            parent, kind = self.pick(["ground", *bodies[:i]]), self.pick(JOINTS)
            name = self.pick(["j{}", "joint_{}", "{}_to_parent"]).format(child)
            swap = self.chance(0.15) and (kind in [*REVERSIBLE, "CustomJoint"] or LAWS_REVERSED)
            ends = (child, parent) if swap else (parent, child)
            joints.append(self.joint(name, kind, *ends, parts))
        if self.chance(0.15):       # a second way between two bodies
            a, b = self.rng.choice(bodies, 2, replace=False)
            joints.append(self.joint("loop", self.pick(["WeldJoint", "BallJoint", "PinJoint", "FreeJoint"]), a, b, parts))
        unique = [name for name, count in Counter(self.coordinates).items() if count == 1]
        constraints = [self.coupler(i, unique) for i in range(self.pick([0, 1, 2, 3, 5]))]
        constraints += [self.constraint(i, bodies) for i in range(self.pick([0, 0, 0, 1, 2]))]
        markers = []
        text = "".join(joints) + "".join("".join(p) for p in parts.values())
        own = [(j, f) for j in re.findall(r'<\w+Joint name="(\w+)"', "".join(joints))
               for f in re.findall(r'PhysicalOffsetFrame name="(\w+)"', next(x for x in joints if f'name="{j}"' in x))]
        for i in range(int(self.rng.integers(1, 6))):
            places = ["/ground", *(f"/bodyset/{b}" for b in bodies), *(f"/jointset/{j}/{f}" for j, f in own)]
            places += [f"/bodyset/{b}/{f}" for b in bodies for f in re.findall(r'Frame name="(\w+)"', "".join(parts[b]))]
            body = tag("socket_parent_frame", self.pick(places)) + tag("location", numbers(self.normal(3, 0.2)))
            markers.append(f'<Marker name="m{i}">{body}</Marker>')
        mass = tag("mass", "1") + tag("mass_center", "0 0 0") + tag("inertia", "1 1 1 0 0 0")

        def body(name):
            components = tag("components", "".join(parts[name])) if parts[name] else ""
            return f'<Body name="{name}">{components}{mass}</Body>'

        def objects(name, items):
            return tag(name, tag("objects", "".join(items)))

        shuffled = self.rng.permutation
        text = objects("BodySet", (body(b) for b in shuffled(bodies))) + objects("JointSet", shuffled(joints))
        text += objects("ConstraintSet", constraints) + objects("MarkerSet", markers)
        return f'<OpenSimDocument Version="40500"><Model name="random">{text}</Model></OpenSimDocument>'


def rows(transform):
    r, p = transform.R(), transform.p()
    return [float(x) for i in range(3) for x in (r.get(i, 0), r.get(i, 1), r.get(i, 2), p.get(i))] + [0.0, 0.0, 0.0, 1.0]


def keyed_coordinates(model):
    """Every coordinate with the key that condyle gives it."""
    found, joints = [], model.getJointSet()
    for j in range(joints.getSize()):
        joint = joints.get(j)
        for i in range(joint.numCoordinates()):
            found.append((joint.getName(), joint.get_coordinates(i)))
    count = Counter(c.getName() for _, c in found)
    return {c.getName() if count[c.getName()] == 1 else f"{j}/{c.getName()}": c for j, c in found}


def enforced_couplers(model):
    constraints = model.getConstraintSet()
    for i in range(constraints.getSize()):
        coupler = osim.CoordinateCouplerConstraint.safeDownCast(constraints.get(i))
        if coupler and coupler.get_isEnforced():
            names = coupler.getIndependentCoordinateNames()
            drivers = [names.get(k) for k in range(names.getSize())]
            yield coupler, drivers


def meet_couplers(model, pose, bare):
    """Sets what follows; chains are settled by going over all as often as there are couplers."""
    couplers = list(enforced_couplers(model))
    for _ in couplers:
        for coupler, drivers in couplers:
            at = osim.Vector(len(drivers), 0.0)
            for k, name in enumerate(drivers):
                at.set(k, pose[bare[name]])
            scale = osim.PropertyHelper.getValueDouble(coupler.getPropertyByName("scale_factor"))
            value = scale * coupler.getFunction().calcValue(at)
            pose[bare[coupler.getDependentCoordinateName()]] = value
    return [bare[c.getDependentCoordinateName()] for c, _ in couplers]


def base(frame):
    return frame.findBaseFrame().getName()


def perhaps_doubled(model):
    """Where two joints reach one body, OpenSim doubles it and, as long as the loop is open, mostly reports the double where one
    asks for the body. Which of the two is not always to be told from outside: all that may be doubled are not compared."""
    joints = model.getJointSet()
    if joints.getSize() <= model.getBodySet().getSize():
        return set()
    ends = [(base(j.getParentFrame()), base(j.getChildFrame())) for j in (joints.get(i) for i in range(joints.getSize()))]
    count = Counter(name for pair in ends for name in pair)
    return {child for _, child in ends if count[child] > 1}


def answer(path, rng, poses=3, spread=0.7):
    """What OpenSim says of the file at `path`."""
    model = osim.Model(path)
    state = model.initSystem()
    coordinates = keyed_coordinates(model)
    bare = {}
    for key in coordinates:
        bare.setdefault(key.split("/")[-1], key)
    result = {"model": os.path.basename(path), "opensim": osim.GetVersion(), "coupled": [],
              "kinds": {key: c.getMotionType() for key, c in coordinates.items()}, "poses": []}
    bodies, markers, doubled = model.getBodySet(), model.getMarkerSet(), perhaps_doubled(model)
    sound = [b for b in (bodies.get(i) for i in range(bodies.getSize())) if b.getName() not in doubled]
    for _ in range(poses):
        pose = {key: round(float(rng.normal() * spread), 6) for key in coordinates}
        for key, c in coordinates.items():
            if "ConstantCurvature" in c.getJoint().getConcreteClassName():
                pose[key] = float(np.clip(pose[key], -0.9, 0.9))
        result["coupled"] = meet_couplers(model, pose, bare)
        for key, c in coordinates.items():
            c.setLocked(state, False)
            c.setClamped(state, False)
        for key, c in coordinates.items():
            c.setValue(state, pose[key], False)
            if c.getValue(state) != pose[key]:
                raise RuntimeError(f"the value of {key} was not taken")
        model.realizePosition(state)
        segments = {b.getName(): rows(b.getTransformInGround(state)) for b in sound}
        seen = [m for m in (markers.get(i) for i in range(markers.getSize())) if base(m.getParentFrame()) not in doubled]
        places = {m.getName(): m.getLocationInGround(state) for m in seen}
        result["poses"].append({"pose": pose, "segments": segments,
                                "markers": {name: [p.get(k) for k in range(3)] for name, p in places.items()}})
    return result


def compact(text):
    """The file without comments, white space and what says nothing about motion."""
    text = re.sub(r"<!--.*?-->", "", text, flags=re.S)
    for name in ("mass", "mass_center", "inertia", "WrapObjectSet", "attached_geometry", "FrameGeometry", "gravity", "Appearance",
                 "ForceSet", "ControllerSet", "ContactGeometrySet", "ProbeSet", "ComponentSet", "ModelVisualPreferences",
                 "credits", "publications", "length_units", "force_units", "default_speed_value", "prescribed_function",
                 "is_free_to_satisfy_constraints", "fixed", "assembly_accuracy"):
        text = re.sub(rf"<{name}(\s[^>]*)?/>|<{name}(\s[^>]*)?>.*?</{name}>", "", text, flags=re.S)
    text = re.sub(r"<prescribed>false</prescribed>|<groups ?/>|<isEnforced>true</isEnforced>", "", text)
    return re.sub(r">\s+<", "><", re.sub(r"\s+", " ", text)).strip()


def shorter(found):
    """Two poses; transforms and places to 11 decimals, 12 numbers for a transform."""
    poses = [{"pose": p["pose"],
              "segments": {name: [round(x, 11) for x in numbers[:12]] for name, numbers in p["segments"].items()},
              "markers": {name: [round(x, 11) for x in place] for name, place in p["markers"].items()}} for p in found["poses"][:2]]
    return {**found, "poses": poses}


def print_and_answer(out, name, rng):
    path = os.path.join(out, name + ".osim")
    osim.Model(path).printToXML(path + ".printed")
    os.rename(path, os.path.join(out, name + ".stated.xml"))
    os.rename(path + ".printed", path)
    with open(os.path.join(out, name + ".json"), "w") as f:
        json.dump(answer(path, rng), f)


def apart(task):
    """Does the task in a process of its own, as OpenSim crashes on some models; why it failed, or nothing."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            task()
        except RuntimeError as error:
            reason = re.sub(r"'[^']*'|\d[\d.e+-]*", "…", str(error).strip().splitlines()[0])[:90]
            os.write(write, reason.encode())
        except BaseException as error:
            os.write(write, repr(error).encode())
        finally:
            os._exit(0)
    os.close(write)
    with os.fdopen(read) as pipe:
        reason = pipe.read()
    _, status = os.waitpid(child, 0)
    return reason or (f"signal {os.WTERMSIG(status)}" if status else "")


def main():
    out, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    osim.Logger.setLevelString("Off")
    os.makedirs(out, exist_ok=True)
    refused, kept, attempt = Counter(), [], 0
    while len(kept) < count:
        name = f"random_{len(kept):04}"
        path = os.path.join(out, name + ".osim")
        generator = Generator([seed, attempt])
        attempt += 1
        with open(path, "w") as f:
            f.write(generator.model())
        reason = apart(lambda: print_and_answer(out, name, generator.rng))
        if reason:
            refused[reason] += 1
            continue
        with open(os.path.join(out, name + ".json")) as f:
            kept.append((path, json.load(f)))
    print(f"{len(kept)} models, {sum(refused.values())} refused by OpenSim", *refused.most_common(), sep="\n  ")
    if "--pack" in sys.argv:
        at = sys.argv.index("--pack")
        packed = [{**shorter(found), "xml": compact(open(path).read())} for path, found in kept[:int(sys.argv[at + 2])]]
        with open(sys.argv[at + 1], "w") as f:
            json.dump(packed, f, separators=(",", ":"), ensure_ascii=False)


if __name__ == "__main__":
    main()
