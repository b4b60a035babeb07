#!/usr/bin/env python3
"""An evaluator of resolved models that shares nothing with condyle but docs/exchange.md.

    python3 examples/evaluator.py MODEL.json POSES.json

reads a model as `condyle convert` writes it and a conformance file (`cargo run --release --example
conformance -- MODEL N FOLDER` makes both), poses the model by itself, and prints the largest
difference of any entry of any transform, and of any effective coordinate. It ends with 1 where one is
above 1e-12. It needs NumPy only.
"""

import json
import sys
from math import atan2, cos, hypot, pi, sin, sqrt

import numpy as np

MOST = 1e9
TAU = 2 * pi
UNITS = np.eye(3)


def norm(v):
    return sqrt(v @ v)


def unit(v):
    return v / norm(v)


def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def clamp(x):
    """Numbers stay within ±1e9, and NaN becomes 1e9."""
    return min(max(x, -MOST), MOST) if x == x else MOST


def turn(axis, angle):
    """The rotation about an axis of length 1 (Rodrigues)."""
    x, y, z = axis
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + sin(angle) * skew + (1 - cos(angle)) * (skew @ skew)


def rigid(rotation=None, place=None):
    frame = np.eye(4)
    if rotation is not None:
        frame[:3, :3] = rotation
    if place is not None:
        frame[:3, 3] = place
    return frame


def frame_of(rows):
    return np.vstack([np.array(rows, float), [0, 0, 0, 1]])


def inverse(frame):
    back = frame[:3, :3].T
    return rigid(back, -back @ frame[:3, 3])


def matrix_of(q):
    """The rotation of a quaternion x, y, z, w of any length; of length 0 the identity."""
    x, y, z, w = q
    square = x * x + y * y + z * z + w * w
    if square < 1e-300:
        return np.eye(3)
    v = np.array([x, y, z])
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 / square * (w * skew + np.outer(v, v) - (v @ v) * np.eye(3))


def quaternion_of(rotation):
    """x, y, z, w with w ≥ 0: the eigenvector of the largest eigenvalue (Bar-Itzhack 2000)."""
    m = rotation
    k = np.array([
        [m[0, 0] - m[1, 1] - m[2, 2], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
        [m[0, 1] + m[1, 0], m[1, 1] - m[0, 0] - m[2, 2], m[1, 2] + m[2, 1], m[0, 2] - m[2, 0]],
        [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
        [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m[0, 0] + m[1, 1] + m[2, 2]],
    ])
    q = np.linalg.eigh(k)[1][:, 3]
    return -q if q[3] < 0 else q


def logarithm(rotation):
    """The rotation vector, of length at most π."""
    q = quaternion_of(rotation)
    sine = norm(q[:3])
    return q[:3] * (2 * atan2(sine, q[3]) / sine if sine > 0 else 2.0)


def power(rotation, exponent):
    vector = logarithm(rotation) * exponent
    angle = norm(vector)
    return turn(vector / angle, angle) if angle > 0 else np.eye(3)


# Functions

class Spline:
    """The cubic spline whose third derivatives at the ends are those of the cubics through the four
    outermost knots; straight beyond its knots."""

    def __init__(self, knots):
        self.x, self.y = np.array(knots, float).T
        x, y, n = self.x, self.y, len(self.x)
        self.second = np.zeros(n)
        if n < 3:
            return
        system, right = np.zeros((n, n)), np.zeros(n)
        h, chord = np.diff(x), np.diff(y) / np.diff(x)
        for i in range(1, n - 1):
            system[i, i - 1:i + 2] = h[i - 1] / 6, (h[i - 1] + h[i]) / 3, h[i] / 6
            right[i] = chord[i] - chord[i - 1]
        for row, left, first in [(0, 0, 0), (n - 1, n - 2, n - 4)]:
            system[row, left:left + 2] = -1 / h[left], 1 / h[left]
            if n > 3:
                divided = y[first:first + 4]
                for order in range(1, 4):
                    divided = np.diff(divided) / (x[first + order:first + 4] - x[first:first + 4 - order])
                right[row] = 6 * divided[0]
        self.second = np.linalg.solve(system, right)

    def derivatives(self, at):
        """Value and three derivatives; at a knot those to its right."""
        x, y, m = self.x, self.y, self.second
        n = len(x)
        if n == 1:
            return np.array([y[0], 0, 0, 0])
        i = min(max(int(np.searchsorted(x, at, side="right")) - 1, 0), n - 2)
        inside = x[0] <= at < x[-1]
        if not inside:
            i, edge = (0, x[0]) if at < x[0] else (n - 2, x[-1])
        h, t = x[i + 1] - x[i], (at if inside else edge) - x[i]
        slope = (y[i + 1] - y[i]) / h - h * (2 * m[i] + m[i + 1]) / 6
        third = (m[i + 1] - m[i]) / h
        value = [y[i] + t * (slope + t * (m[i] / 2 + t * third / 6)),
                 slope + t * (m[i] + t * third / 2), m[i] + t * third, third]
        if not inside:
            value = [value[0] + value[1] * (at - edge), value[1], 0, 0]
        return np.array(value)


def function(spec):
    """A function of one number."""
    factor, kind = spec.get("factor", 1.0), spec["kind"]
    if kind == "constant":
        curve = lambda x: spec["value"]
    elif kind == "linear":
        curve = lambda x: spec["slope"] * x + spec["intercept"]
    elif kind == "polynomial":
        coefficients = np.array(spec["coefficients"] or [0.0], float)
        curve = lambda x: np.polynomial.polynomial.polyval(x, coefficients)
    elif kind == "simm_spline":
        spline = Spline(spec["knots"])
        curve = lambda x: spline.derivatives(x)[0]
    elif kind == "piecewise_linear":
        knots = np.array(spec["knots"], float)
        curve = lambda x: lines(knots[:, 0], knots[:, 1], x)
    else:
        raise ValueError(f"unknown function {kind}")
    return lambda x: clamp(float(factor * curve(x)))


def lines(x, y, at):
    if len(x) == 1:
        return y[0]
    # A knot belongs to the interval to its right; the outer intervals go on.
    i = min(max(int(np.searchsorted(x, at, side="right")) - 1, 0), len(x) - 2)
    width = x[i + 1] - x[i]
    if width == 0:
        return y[i] if at < x[i] else y[i + 1]
    return y[i] + (y[i + 1] - y[i]) / width * (at - x[i])


def powers(dimension, order):
    """All exponents with a sum of at most `order`, the last one varying fastest."""
    if dimension == 0:
        yield ()
        return
    for first in range(order + 1):
        for rest in powers(dimension - 1, order - first):
            yield (first,) + rest


def function_of_several(spec):
    if spec["kind"] == "linear":
        slopes = np.array(spec["slopes"], float)
        return lambda x: clamp(float(spec["intercept"] + slopes @ x))
    # Missing coefficients, which end the list, are 0.
    terms = [(c, np.array(p)) for c, p in zip(spec["coefficients"], powers(spec["dimension"], spec["order"]))
             if c != 0]
    return lambda x: clamp(float(sum(c * np.prod(np.asarray(x) ** p) for c, p in terms)))


# Limits

class Cone:
    """The legal directions and twists of a ball joint."""

    def __init__(self, p):
        self.of, self.axes = p["of"], [np.array(a, float) for a in p["axes"]]
        self.rest = unit(np.array(p["rest"], float))
        self.nearest = p["projection"] == "nearest"
        self.twist = p["twist_at_rest"] and np.array(p["twist_at_rest"], float)
        corners = [unit(np.array(q["direction"], float)) for q in p["points"]]
        bounds = [np.array(q["twist"] or p["twist_at_rest"] or [0, 0], float) for q in p["points"]]
        r = self.rest
        following = corners[1:] + corners[:1]
        turned = sum(atan2(r @ cross(a, b), a @ b - (r @ a) * (r @ b)) for a, b in zip(corners, following))
        if turned < 0:
            corners, bounds = corners[::-1], bounds[::-1]
        # The chart in which points are refined: angle from rest and azimuth.
        second = unit(cross(r, corners[0]))
        self.first, self.second = cross(second, r), second
        for _ in range(p["subdivisions"]):
            corners, bounds = self.refined(corners, bounds)
        self.corners = np.array(corners)
        self.bounds = np.array(bounds)
        self.azimuths = np.array([0] + [self.azimuth(c) for c in corners[1:]])
        self.ends = np.roll(self.corners, -1, axis=0)
        normals = np.cross(self.corners, self.ends)
        self.normals = normals / np.linalg.norm(normals, axis=1)[:, None]

    def azimuth(self, v):
        return atan2(v @ self.second, v @ self.first) % TAU

    def refined(self, corners, bounds):
        flat = []
        for c in corners:
            x, y = c @ self.first, c @ self.second
            sine = hypot(x, y)
            flat.append(np.array([x, y]) * (atan2(sine, c @ self.rest) / sine))
        finer, twists, n = [], [], len(corners)
        for i in range(n):
            a, b, c, d = flat[i - 1], flat[i], flat[(i + 1) % n], flat[(i + 2) % n]
            x, y = 9 / 16 * (b + c) - 1 / 16 * (a + d)
            angle = hypot(x, y)
            out = (self.first * x + self.second * y) / angle
            finer += [corners[i], unit(self.rest * cos(angle) + out * sin(angle))]
            twists += [bounds[i], (bounds[i] + bounds[(i + 1) % n]) / 2]
        return finer, twists

    def wedge(self, v):
        if hypot(v @ self.first, v @ self.second) == 0:
            return 0
        return max(int(np.searchsorted(self.azimuths, self.azimuth(v), side="right")) - 1, 0)

    def contains(self, v):
        return v @ self.normals[self.wedge(v)] >= 0

    def project(self, v):
        """A direction outside, moved to the boundary."""
        out = v - self.rest * (v @ self.rest)
        if not self.nearest and norm(out) >= 1e-12:
            out, n = unit(out), self.normals[self.wedge(v)]
            return unit(out * (n @ self.rest) - self.rest * (n @ out))
        sines = self.normals @ v
        feet = v - self.normals * sines[:, None]
        before = np.einsum("ij,ij->i", feet, np.cross(self.normals, self.corners))
        after = np.einsum("ij,ij->i", feet, np.cross(self.ends, self.normals))
        far = np.where((before >= 0) & (after >= 0), np.arcsin(np.minimum(abs(sines), 1)), np.inf)
        arc = int(np.argmin(far))
        chords = np.linalg.norm(self.corners - v, axis=1)
        corner = int(np.argmin(chords))
        if far[arc] <= 2 * np.arcsin(min(chords[corner] / 2, 1)):
            return unit(feet[arc])
        return self.corners[corner]

    def twist_bounds(self, v):
        r, i = self.rest, self.wedge(v)
        out = v - r * (v @ r)
        sine = norm(out)
        if sine < 1e-9:
            return self.twist if v @ r > 0 else self.bounds[i]
        e, n = out / sine, self.normals[i]
        around = cross(r, e)
        alpha, beta = around @ self.ends[i], -around @ self.corners[i]
        t = min(max(beta / (alpha + beta), 0), 1)
        rho = min(atan2(sine, v @ r) / atan2(n @ r, -n @ e), 1)
        edge = (1 - t) * self.bounds[i] + t * self.bounds[(i + 1) % len(self.bounds)]
        share = rho * rho * (3 - 2 * rho)
        return (1 - share) * self.twist + share * edge

    def legal_rotation(self, rotation):
        """The legal rotation, or None where the given one is legal."""
        r = self.rest
        v = unit(rotation @ r)
        inside = self.contains(v)
        q = quaternion_of(rotation)
        twist = 2 * atan2(q[:3] @ r, q[3]) if 1 + v @ r >= 1e-14 else 0.0
        direction = v if inside else self.project(v)
        held = False
        if self.twist is not None:
            low, high = self.twist_bounds(direction)
            half = (high - low) / 2
            off = twist - (low + high) / 2
            off -= TAU * np.ceil((off - pi) / TAU)
            if min(off + half, half - off) < -1e-10:
                held, twist = True, low if off + half < 0 else high
        if inside and not held:
            return None
        axis = cross(r, direction)
        sine = norm(axis)
        swing = turn(axis / sine, atan2(sine, r @ direction)) if sine > 1e-12 else np.eye(3)
        return swing @ turn(r, twist)

    def product(self, numbers, count=None):
        rotation = np.eye(3)
        for axis, angle in list(zip(self.axes, numbers))[:count]:
            rotation = rotation @ turn(axis, angle)
        return rotation

    def legal(self, asked):
        if self.of == "orientation":
            legal = self.legal_rotation(matrix_of(asked))
            return asked if legal is None else quaternion_of(legal)
        rotation = self.product(asked)
        if self.of == "directions":
            v = unit(rotation @ self.rest)
            return asked if self.contains(v) else self.angles(self.project(v), None, asked)
        legal = self.legal_rotation(rotation)
        return asked if legal is None else self.angles(legal @ self.axes[2], legal, asked)

    def angles(self, w, rotation, asked):
        """The angles that turn the third axis to w, and give the rotation where there is one."""
        a, b, c = self.axes + ([self.rest] if len(self.axes) == 2 else [])
        if max(abs(a @ b), abs(c @ b)) > 1e-6:
            return self.oblique(w, rotation, asked)
        beside = cross(a, b)
        lead = atan2(b @ cross(a, c), a @ c)
        along, up, side = w @ a, w @ b, w @ beside
        sine = hypot(up, side)

        def near(angle, wanted):
            """The nearest of the angles that differ by whole turns; of two at half a turn that nearer to
            0, of ±π the positive one."""
            turns = [angle + k * TAU for k in range(int((wanted - angle) // TAU) - 1, int((wanted - angle) // TAU) + 3)]
            least = min(abs(x - wanted) for x in turns)
            best = [x for x in turns if abs(x - wanted) < least + 2e-9]
            smallest = min(map(abs, best))
            return max(x for x in best if abs(x) < smallest + 1e-9)

        def solve(sign):
            first = atan2(sign * up, -sign * side) if sine > 1e-9 else asked[0]
            second = atan2(sign * sine, along) - lead
            found = [near(first, asked[0]), near(second, asked[1])]
            if rotation is not None:
                left = (turn(a, first) @ turn(b, second)).T @ rotation @ b
                found.append(near(atan2(c @ cross(b, left), b @ left), asked[2]))
            return found

        side_of_lock = sin(lead) if abs(sin(lead)) > 1e-6 else sin(asked[1] + lead)
        if abs(side_of_lock) > 1e-6:
            return solve(1.0 if side_of_lock > 0 else -1.0)
        far = lambda found: sum((x - y) ** 2 for x, y in zip(found, asked))
        return min(solve(1.0), solve(-1.0), key=far)

    def allowed(self, angles):
        """Whether angles are legal to 1e-9."""
        rotation = self.product(angles)
        v = unit(rotation @ self.rest)
        if not self.contains(v) and norm(v - self.project(v)) > 1e-9:
            return False
        if self.twist is None or self.of == "directions":
            return True
        q = quaternion_of(rotation)
        low, high = self.twist_bounds(v)
        off = 2 * atan2(q[:3] @ self.rest, q[3]) - (low + high) / 2
        off -= TAU * np.ceil((off - pi) / TAU)
        return (high - low) / 2 - abs(off) >= -1e-9

    def oblique(self, w, rotation, asked):
        angles = np.array(asked, float)
        n = len(angles)
        for _ in range(50):
            turned = self.product(angles)
            moving = np.array([self.product(angles, k) @ self.axes[k] for k in range(n)])
            at = turned @ self.rest
            if rotation is not None:
                left = logarithm(rotation @ turned.T)
            else:
                about = cross(at, w)
                left = about * (atan2(norm(about), at @ w) / max(norm(about), 1e-300))
                moving = moving - np.outer(moving @ at, at)
            if norm(left) < 1e-14:
                break
            step = np.linalg.solve(moving @ moving.T + 1e-9 * np.eye(n), moving @ left)
            angles += np.clip(step, -0.5, 0.5)
        if self.allowed(angles):
            return list(angles)
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if self.allowed(angles * middle) else (low, middle)
        return list(angles * low)


def ellipse(p, asked):
    """Two numbers, moved to the nearest point of an ellipse where they are outside."""
    centre, radii = np.array(p["centre"], float), np.array(p["half_axes"], float)
    s, c = sin(p["tilt"]), cos(p["tilt"])
    tilt = np.array([[c, -s], [s, c]])
    own = tilt.T @ (np.array(asked) - centre)
    if ((own / radii) ** 2).sum() <= 1 + 1e-12:
        return asked
    # x = r²p/(t + r²) with the largest root t of Σ (r·p/(t + r²))² = 1; outside it is positive.
    square, z = radii ** 2, (radii * own) ** 2
    poly = np.polysub(np.polymul([1, 2 * square[0], square[0] ** 2], [1, 2 * square[1], square[1] ** 2]),
                      np.polyadd(z[0] * np.array([1, 2 * square[1], square[1] ** 2]),
                                 z[1] * np.array([1, 2 * square[0], square[0] ** 2])))
    t = max(np.roots(poly).real)
    for _ in range(20):
        value, slope = (z / (t + square) ** 2).sum() - 1, -2 * (z / (t + square) ** 3).sum()
        t -= value / slope
    return list(centre + tilt @ (square * own / (t + square)))


# Transforms

def pivot_place(p, angle):
    """The origin of a frame that turns about an axis whose centre moves: from 0 outwards."""
    axis = np.array(p["axis"], float)
    centre = p["centre"]
    if centre["kind"] == "intervals":
        tops = [np.inf if i["to"] is None else i["to"] for i in centre["intervals"]]
        tops[-1] = np.inf
        ends = tops[:-1]
        places = [np.array(i["at"], float) for i in centre["intervals"]]
        derivatives = lambda at: (places[int(np.searchsorted(tops, at))],) + (np.zeros(3),) * 3
    else:
        splines = p.setdefault("_splines", [Spline(s["knots"]) for s in centre["path"]])
        ends = sorted({x for s in splines for x in s.x})
        derivatives = lambda at: np.array([s.derivatives(at) for s in splines]).T
    sign = 1.0 if angle >= 0 else -1.0
    stops = sorted(e * sign for e in ends if 0 < e * sign < angle * sign) + [angle * sign]
    place, here = np.zeros(3), 0.0
    across = lambda v: v - axis * (axis @ v)
    for stop in stops:
        stop *= sign
        middle = (here + stop) / 2
        c, d1, d2, d3 = derivatives(middle)

        def particular(at):
            h = at - middle
            value = c + h * (d1 + h * (d2 / 2 + h * d3 / 6))
            first, second = d1 + h * (d2 + h * d3 / 2), d2 + h * d3
            return across(value) - cross(axis, first) - across(second) + cross(axis, d3)

        place = particular(stop) + turn(axis, stop - here) @ (place - particular(here))
        here = stop
    return place


def heading(h, tangent):
    forward, up = unit(np.array(h["forward"], float)), unit(np.array(h["up"], float))

    def across(v):
        return unit(cross(v, UNITS[0] if abs(v[0]) < 0.6 * norm(v) else UNITS[1]))

    def or_else(v, other):
        return unit(v) if norm(v) >= 1e-12 else other

    own = or_else(up - forward * (up @ forward), across(forward))
    t = or_else(tangent, forward)
    n = or_else(up - t * (up @ t), across(t))
    return np.array([t, n, cross(t, n)]).T @ np.array([forward, own, cross(forward, own)])


def wave(k, x):
    return k[0] + k[1] * cos(x) + k[2] * sin(x) + k[3] * cos(2 * x) + k[4] * sin(2 * x)


def slope(k):
    return np.array([0, k[2], -k[1], 2 * k[4], -2 * k[3]])


def zeros(k):
    """The zeros of A + B cos x + C sin x + D cos 2x + E sin 2x: between its extrema, whose angles are
    among those of the roots of its derivative as a polynomial of exp(ix)."""
    d = slope(k)
    roots = np.roots([d[3] - 1j * d[4], d[1] - 1j * d[2], 2 * d[0], d[1] + 1j * d[2], d[3] + 1j * d[4]])
    stops = sorted(np.angle(roots))
    found = []
    for low, high in zip(stops, stops[1:] + [stops[0] + TAU] if stops else []):
        below = wave(k, low) < 0
        if (wave(k, high) < 0) == below:
            continue
        for _ in range(80):
            middle = (low + high) / 2
            low, high = (middle, high) if (wave(k, middle) < 0) == below else (low, middle)
        found.append((low + high) / 2)
    return found


def touch(pose, radii, axis, point):
    """The angle about an axis through the origin that puts a point on the ellipsoid."""
    along = axis * (axis @ point)
    m = (pose[:3, :3] @ along + pose[:3, 3]) / radii
    u, w = pose[:3, :3] @ (point - along) / radii, pose[:3, :3] @ cross(axis, point) / radii
    k = np.array([m @ m - 1 + (u @ u + w @ w) / 2, 2 * m @ u, 2 * m @ w, (u @ u - w @ w) / 2, u @ w])
    scale = max(abs(k[1:]))
    if scale <= 1e-15 * abs(k[0]):
        return 0.0
    angles, d = zeros(k), slope(k)
    if not angles:
        extrema = zeros(d)
        least = min(abs(wave(k, x)) for x in extrema)
        angles = [x for x in extrema if abs(wave(k, x)) <= least + 1e-13 * scale]
        k, d = d, slope(d)
    angle = max(angles, key=cos)
    for _ in range(2):
        steep = wave(d, angle)
        if abs(steep) > 1e-6 * scale:
            angle -= wave(k, angle) / steep
    return angle


def contact_points(pairs, drivers):
    at = np.array([pair["at"] for pair in pairs], float)
    drivers = np.array((list(drivers) + [0.0, 0.0])[:2])
    low, span = at.min(axis=0), np.ptp(at, axis=0)

    def smooth(x):
        u = np.clip(np.where(span > 0, (x - low) / np.where(span > 0, span, 1), 0), 0, 1)
        return u * u * (3 - 2 * u)

    squares = ((smooth(drivers) - smooth(at)) ** 2).sum(axis=1)
    weights = np.array([np.prod(np.delete(squares, i)) for i in range(len(pairs))])
    weights = weights / weights.sum()
    return [weights @ np.array([pair[key] for pair in pairs], float) for key in ("first", "second")]


def euler(rotation, order):
    i, j, k = ("xyz".index(c) for c in order)
    proper = i == k
    k = 3 - i - j
    e = 1.0 if (j - i) % 3 == 1 else -1.0
    m = rotation
    length = hypot(m[i, j], m[i, k]) if proper else hypot(m[i, i], m[i, j])
    middle = atan2(length, m[i, i]) if proper else atan2(e * m[i, k], length)
    if length < 1e-9:
        return [atan2(e * m[k, j], m[j, j]), middle, 0.0]
    if proper:
        return [atan2(m[j, i], -e * m[k, i]), middle, atan2(m[i, j], e * m[i, k])]
    return [atan2(-e * m[j, k], m[k, k]), middle, atan2(-e * m[i, j], m[i, i])]


class Model:
    def __init__(self, data):
        if data.get("condyle_model") != 1:
            raise ValueError("this is no resolved model of version 1")
        self.data = data
        self.segments = {s["name"]: s for s in data["segments"]}
        for s in data["segments"]:
            s["_in_parent"] = frame_of(s["joint_in_parent"])
            s["_back"] = inverse(frame_of(s["joint_in_segment"]))
        self.coordinates = {c["path"]: c for c in data["coordinates"]}
        self.components = {c["path"]: c for c in data["components"]}
        self.number = {c["path"]: i for i, c in enumerate(data["components"])}
        for c in data["components"]:
            p = c["parameters"]
            if c["kind"] == "cone":
                c["_cone"] = Cone(p)
            c["_functions"] = [function(f) for f in p.get("functions", [])]
            c["_bounds"] = [p.get(side) and function(p[side]) for side in ("lower", "upper")]
            if c["kind"] == "combine":
                c["_several"] = function_of_several(p["function"])
            if c["kind"] == "curve":
                c["_path"] = [Spline(s["knots"]) for s in p["path"]]
        self.find_measured()
        self.find_written_back()

    # What a limit acts on

    LIMITS = ("depend", "cone", "ellipse", "half_space")

    def values(self, component):
        """The signals at the ports of a component that are no segments, in the order of ports."""
        order = {"depend": ["passive", "driver"], "ellipse": ["first", "second"]}
        inputs = component["inputs"]
        for port in order.get(component["kind"], inputs):
            signals = inputs[port] if isinstance(inputs[port], list) else [inputs[port]]
            yield from (s for s in signals if "segment" not in s)

    def path_to(self, name):
        path = []
        while name is not None:
            path.insert(0, name)
            name = self.segments[name]["parent"]
        return path

    def find_measured(self):
        self.measured = set()
        is_measured = lambda s: s is not None and s.get("coordinate", s.get("component")) in self.measured
        for item in self.data["order"]["values"]:
            if "coordinate" in item:
                if is_measured(self.coordinates[item["coordinate"]]["follows"]):
                    self.measured.add(item["coordinate"])
                continue
            c = self.components[item["component"]]
            if c["kind"].startswith("relative_") or any(map(is_measured, self.values(c))):
                self.measured.add(c["path"])

    def find_written_back(self):
        """The output that is the effective value of each coordinate that a limit holds."""
        used = set()
        stack = [s["motion"] for s in self.data["segments"]]
        stack += [c["follows"] for c in self.data["coordinates"]]
        stack += [{"component": c["path"]} for c in self.data["components"]
                  if c["kind"] in self.LIMITS and c["path"] in self.measured]
        while stack:
            signal = stack.pop()
            if signal and "component" in signal and signal["component"] not in used:
                used.add(signal["component"])
                c = self.components[signal["component"]]
                stack += self.values(c)
                stack += [self.segments[name]["motion"] for name in self.between(c)]
        self.written, origin = {}, {}
        for item in self.data["order"]["values"]:
            path = item.get("component")
            c = self.components.get(path)
            if c is None or path not in used or path in self.measured or c["kind"] not in self.LIMITS:
                continue
            held = list(self.values(c))[:1] if c["kind"] == "depend" else list(self.values(c))
            for k, signal in enumerate(held):
                if "coordinate" in signal:
                    start = (signal["coordinate"], 0)
                else:
                    start = origin.get((signal["component"], signal["output"]))
                if start is None or self.coordinates[start[0]]["follows"] is not None:
                    continue
                coordinate, depth = start
                origin[path, k] = (coordinate, depth + 1)
                rank = (depth + 1, self.number[path])
                if coordinate not in self.written or rank >= self.written[coordinate][0]:
                    self.written[coordinate] = (rank, path, k)

    def between(self, component):
        """The segments whose motions a component reads, those above the places at its ports left out."""
        inputs, kind = component["inputs"], component["kind"]
        one = lambda port: inputs[port]["segment"] if port in inputs else None
        above = lambda name: self.path_to(self.segments[name]["parent"])
        if kind == "compensate":
            paths = [above(one("segment"))] + [above(s["segment"]) for s in inputs["ancestors"]]
        elif kind == "contact":
            paths = [above(one("segment")), self.path_to(one("surface"))]
        elif kind.startswith("relative_"):
            paths = [self.path_to(one("segment")), self.path_to(one("reference"))]
        else:
            return []
        common = 0
        while all(len(p) > common and p[common] == paths[0][common] for p in paths):
            common += 1
        return list(dict.fromkeys(name for p in paths for name in p[common:]))

    # One pose

    def evaluate(self, requested, posed):
        """The transforms of all segments in the world, and the effective coordinates."""
        self.posed, self.value, self.outputs = posed, {}, {}
        for path, c in self.coordinates.items():
            if c["kind"] == "orientation":
                self.value[path] = [clamp(x) for x in requested[path]]
                continue
            x = clamp(requested[path])
            if posed and c["clamped"] and c["follows"] is None:
                low, high = c["range"]
                x = x if low is None else max(x, low)
                x = x if high is None else min(x, high)
            self.value[path] = x
        for item in self.data["order"]["values"]:
            if "coordinate" in item:
                self.value[item["coordinate"]] = self.read(self.coordinates[item["coordinate"]]["follows"])
            else:
                c = self.components[item["component"]]
                self.outputs[c["path"]] = getattr(self, c["kind"])(c, c["parameters"], c["inputs"])
        world = {}
        for name in self.data["order"]["segments"]:
            parent = self.segments[name]["parent"]
            world[name] = (np.eye(4) if parent is None else world[parent]) @ self.joint(name)
        effective = dict(self.value)
        for coordinate, (_, path, k) in self.written.items():
            effective[coordinate] = self.outputs[path][k]
        return world, effective

    def read(self, signal):
        if "coordinate" in signal:
            return self.value[signal["coordinate"]]
        return self.outputs[signal["component"]][signal["output"]]

    def motion(self, name):
        motion = self.segments[name]["motion"]
        return np.eye(4) if motion is None else self.read(motion)

    def joint(self, name):
        segment = self.segments[name]
        return segment["_in_parent"] @ self.motion(name) @ segment["_back"]

    def through(self, names):
        frame = np.eye(4)
        for name in names:
            frame = frame @ self.joint(name)
        return frame

    def relative(self, inputs):
        """A segment in another: through the joints below the last segment that both hang from."""
        reference = inputs["reference"]["segment"] if "reference" in inputs else None
        to, of = self.path_to(inputs["segment"]["segment"]), self.path_to(reference)
        common = sum(1 for _ in iter(lambda s=iter(zip(to, of)): len(set(next(s, (0, 1)))) == 1, False))
        return inverse(self.through(of[common:])) @ self.through(to[common:])

    # Components: numbers

    def map(self, c, p, inputs):
        return [f(self.read(inputs["input"])) for f in c["_functions"]]

    def combine(self, c, p, inputs):
        return [c["_several"]([self.read(s) for s in inputs["inputs"]])]

    def depend(self, c, p, inputs):
        x, driver = self.read(inputs["passive"]), self.read(inputs["driver"])
        if self.posed and c["path"] not in self.measured:
            low, high = c["_bounds"]
            x = max(x, low(driver)) if low else x
            x = min(x, high(driver)) if high else x
        return [x]

    def limited(self, c, asked, legal):
        moves = self.posed and c["path"] not in self.measured
        return list(legal(asked) if moves else asked)

    def cone(self, c, p, inputs):
        if p["of"] == "orientation":
            return [self.limited(c, self.read(inputs["orientation"]), c["_cone"].legal)]
        return self.limited(c, [self.read(s) for s in inputs["angles"]], c["_cone"].legal)

    def ellipse(self, c, p, inputs):
        asked = [self.read(inputs[port]) for port in ("first", "second")]
        return self.limited(c, asked, lambda asked: ellipse(p, asked))

    def half_space(self, c, p, inputs):
        def legal(asked):
            n, x = np.array(p["normal"], float), np.array(asked)
            inside = (p["bound"] - n @ x) / norm(n)
            return asked if inside >= -1e-15 * (1 + max(abs(x))) else x + inside * unit(n)
        return self.limited(c, [self.read(s) for s in inputs["inputs"]], legal)

    def relative_orientation(self, c, p, inputs):
        return [quaternion_of(self.relative(inputs)[:3, :3])]

    def relative_position(self, c, p, inputs):
        at = self.relative(inputs) @ np.append(p["point"], 1)
        return [clamp(at[:3] @ np.array(n)) for n in p["along"]]

    def angles(self, c, p, inputs):
        rotation = matrix_of(self.read(inputs["orientation"]))
        if p["mirrored"]:
            mirror = np.eye(3) - 2 * np.diag(UNITS["xyz".index(p["mirrored"])])
            rotation = mirror @ rotation @ mirror
        if p["angles"] == "euler":
            return euler(rotation, p["order"])
        i = "xyz".index(p["axis"])
        q = quaternion_of(rotation)
        twist = 2 * atan2(q[i], q[3]) if hypot(q[i], q[3]) >= 1e-12 else 0.0
        swing = logarithm(rotation @ turn(UNITS[i], twist).T)
        return [twist, swing[(i + 1) % 3], swing[(i + 2) % 3]]

    # Components: transforms

    def rotate(self, c, p, inputs):
        return [rigid(turn(np.array(p["axis"]), self.read(inputs["angle"])))]

    def translate(self, c, p, inputs):
        return [rigid(place=np.array(p["axis"]) * self.read(inputs["distance"]))]

    def pivot(self, c, p, inputs):
        angle = self.read(inputs["angle"])
        return [rigid(turn(np.array(p["axis"]), angle), pivot_place(p, angle))]

    def ball(self, c, p, inputs):
        return [rigid(matrix_of(self.read(inputs["orientation"])))]

    def place(self, c, p, inputs):
        return [frame_of(p["child_in_parent"])]

    def product(self, c, p, inputs):
        frame = np.eye(4)
        for factor in inputs["factors"]:
            frame = frame @ self.read(factor)
        return [frame]

    def scale(self, c, p, inputs):
        s = min(max(self.read(inputs["factor"]), 1e-6), 1e6)
        if p["along"] == "everywhere":
            return [rigid(s * np.eye(3))]
        line = np.outer(p["axis"], p["axis"])
        return [rigid(s * line + (1 if p["along"] == "axis" else s ** -0.5) * (np.eye(3) - line))]

    def shear(self, c, p, inputs):
        amount = min(max(self.read(inputs["amount"]), -1e6), 1e6)
        return [rigid(np.eye(3) + amount * np.outer(p["along"], p["across"]))]

    def curve(self, c, p, inputs):
        u = self.read(inputs["parameter"])
        at = np.array([s.derivatives(u) for s in c["_path"]])
        return [rigid(p["heading"] and heading(p["heading"], at[:, 1]), at[:, 0])]

    def ellipsoid(self, c, p, inputs):
        x, y, z = (self.read(inputs[port]) for port in ("about_x", "about_y", "about_z"))
        rotation = turn(UNITS[0], x) @ turn(UNITS[1], y) @ turn(UNITS[2], z)
        radii = np.array(p["radii"], float)
        place = radii * rotation[:, 2]
        if p["surface_axis"] == "normal":
            place = radii * place / norm(place)
        return [rigid(rotation, place)]

    def constant_curvature(self, c, p, inputs):
        asked = [self.read(inputs[port]) for port in ("about_x", "about_z", "about_y")]
        most = pi / 2 - 0.01
        x, z, y = (min(max(a + n, -most), most) for a, n in zip(asked, p["neutral"]))
        rotation = turn(UNITS[0], x) @ turn(UNITS[2], z) @ turn(UNITS[1], y)
        tip = rotation[:, 1]
        sine = hypot(tip[0], tip[2])
        if not 0.001 <= sine <= 0.999:
            return [rigid(rotation, p["length"] * tip)]
        theta = np.arcsin(sine)
        out = (1 - cos(theta)) / sine
        return [rigid(rotation, p["length"] / theta * np.array([out * tip[0], sine, out * tip[2]]))]

    def compensate(self, c, p, inputs):
        named = {s["segment"] for s in inputs["ancestors"]}
        whole, less = np.eye(3), np.eye(3)
        for name in self.between(c):
            segment, motion = self.segments[name], self.motion(name)[:3, :3]
            left = power(motion, 1 - p["weight"]) if name in named else motion
            before, after = segment["_in_parent"][:3, :3], segment["_back"][:3, :3]
            whole, less = whole @ before @ motion @ after, less @ before @ left @ after
        joint = self.segments[inputs["segment"]["segment"]]["_in_parent"][:3, :3]
        return [rigid(joint.T @ whole.T @ less @ joint)]

    def contact(self, c, p, inputs):
        name, surface = inputs["segment"]["segment"], inputs["surface"]["segment"]
        segment = self.segments[name]
        way = self.path_to(segment["parent"])[len(self.path_to(surface)):]
        pose = inverse(frame_of(p["ellipsoid_in_surface"])) @ self.through(way) @ segment["_in_parent"]
        if "before" in inputs:
            pose = pose @ self.read(inputs["before"])
        drivers = [self.read(s) for s in inputs.get("drivers", [])]
        # Points and axis are given in the segment, and used in its joint frame.
        into = segment["_back"]
        points = [into[:3, :3] @ q + into[:3, 3] for q in contact_points(p["pairs"], drivers)]
        axis, radii = into[:3, :3] @ np.array(p["axis"], float), np.array(p["radii"], float)
        first = turn(axis, touch(pose, radii, axis, points[0]))
        if norm(points[0]) < 1e-9:
            return [rigid(first)]
        axis = unit(points[0])
        return [rigid(first @ turn(axis, touch(pose @ rigid(first), radii, axis, points[1])))]


def apart(one, other):
    """The largest difference; of orientations, q and -q are equal, of any length."""
    one, other = np.array(one, float), np.array(other, float)
    if one.shape == (4,):
        one, other = matrix_of(one), matrix_of(other)
    return float(abs(one - other).max())


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        model = Model(json.load(file))
    with open(sys.argv[2], encoding="utf-8") as file:
        record = json.load(file)
    worst = {"transforms": (0.0, ""), "coordinates": (0.0, "")}
    for number, pose in enumerate(record["poses"]):
        world, effective = model.evaluate(pose["requested"], pose["mode"] == "posed")
        place = f"pose {number}, {pose['mode']}"
        for name, rows in pose["segments"].items():
            found = (apart(world[name][:3], rows), f"{place}, {name}")
            worst["transforms"] = max(worst["transforms"], found)
        for name, value in pose["effective"].items():
            found = (apart(effective[name], value), f"{place}, {name}")
            worst["coordinates"] = max(worst["coordinates"], found)
    name = model.data["name"]
    for what, (difference, where) in worst.items():
        print(f"{name}: {len(record['poses'])} poses, {what} differ by at most {difference:.2e} ({where})")
    return 0 if max(difference for difference, _ in worst.values()) <= 1e-12 else 1


if __name__ == "__main__":
    sys.exit(main())
