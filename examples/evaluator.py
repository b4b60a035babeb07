#!/usr/bin/env python3
"""An evaluator of resolved models that shares nothing with condyle but docs/exchange.md.

    python3 examples/evaluator.py MODEL.json POSES.json

reads a model as `condyle convert MODEL MODEL.json` writes it and a conformance file (`cargo run --release
--example conformance -- MODEL N FOLDER` makes both), poses the model by itself, and prints the largest
difference of any entry of a transform, and of any effective coordinate, relative where an entry is above 1.
It ends with 1 where one is above 1e-12. It needs NumPy only.
"""

import json, sys
from math import atan2, copysign, cos, hypot, pi, sin, sqrt
import numpy as np

MOST, TAU, ONE = 1e9, 2 * pi, np.eye(3)
LIMITS = ("depend", "cone", "ellipse", "half_space", "field")

def norm(v): return sqrt(v @ v)
def unit(v): return v / norm(v)
def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
def skew(v): return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
def clip(x, low, high): return min(max(x, low), high)
def clamp(x):
    """Numbers stay within ±1e9, and NaN becomes 1e9."""
    return clip(float(x), -MOST, MOST) if x == x else MOST
def turn(axis, angle):
    """The rotation about an axis of length 1 (Rodrigues)."""
    k = skew(axis)
    return ONE + sin(angle) * k + (1 - cos(angle)) * (k @ k)
def rigid(linear=None, place=None):
    frame = np.eye(4)
    frame[:3, :3] = ONE if linear is None else linear
    frame[:3, 3] = 0 if place is None else place
    return frame
def frame_of(rows): return np.vstack([np.array(rows, float), [0, 0, 0, 1]])
def inverse(frame): return rigid(frame[:3, :3].T, -frame[:3, :3].T @ frame[:3, 3])
def matrix_of(q):
    """The rotation of a quaternion x, y, z, w of any length; of length 0 the identity."""
    v, w, square = np.array(q[:3]), q[3], np.dot(q, q)
    return ONE if square < 1e-300 else ONE + 2 / square * (w * skew(v) + np.outer(v, v) - (v @ v) * ONE)
def quaternion_of(m):
    """x, y, z, w with w ≥ 0: the eigenvector of the largest eigenvalue (Bar-Itzhack 2000)."""
    k = np.zeros((4, 4))
    k[:3, :3] = m + m.T - np.trace(m) * ONE
    k[3, :3] = k[:3, 3] = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]
    k[3, 3] = np.trace(m)
    q = np.linalg.eigh(k)[1][:, 3]
    return -q if q[3] < 0 else q
def logarithm(rotation):
    """The rotation vector, of length at most π."""
    q = quaternion_of(rotation)
    sine = norm(q[:3])
    return q[:3] * (2 * atan2(sine, q[3]) / sine if sine > 0 else 2.0)
def power(rotation, exponent):
    vector = logarithm(rotation) * exponent
    return turn(unit(vector), norm(vector)) if norm(vector) > 0 else ONE
class Spline:
    """The cubic spline with third derivatives at its ends as through the four outermost knots."""
    def __init__(self, spec):
        self.x, self.y = x, y = np.array(spec["knots"], float).T
        n = len(x)
        self.m = np.zeros(n)
        if n < 3:
            return
        system, right, h, chord = np.zeros((n, n)), np.zeros(n), np.diff(x), np.diff(y) / np.diff(x)
        for i in range(1, n - 1):
            system[i, i - 1:i + 2] = h[i - 1] / 6, (h[i - 1] + h[i]) / 3, h[i] / 6
            right[i] = chord[i] - chord[i - 1]
        for row, left, first in [(0, 0, 0), (n - 1, n - 2, n - 4)]:
            system[row, left:left + 2] = -1 / h[left], 1 / h[left]
            four = x[first:first + 4] if n > 3 else []
            # The third divided difference.
            right[row] = 6 * sum(y[first + i] / np.prod(np.delete(u - four, i)) for i, u in enumerate(four))
        self.m = np.linalg.solve(system, right)
    def at(self, u):
        """Value and three derivatives; at a knot those to its right."""
        x, y, m, n = self.x, self.y, self.m, len(self.x)
        if n == 1:
            return np.array([y[0], 0, 0, 0])
        inside = x[0] <= u < x[-1]
        edge = u if inside else x[0] if u < x[0] else x[-1]
        i = clip(int(np.searchsorted(x, edge, side="right")) - 1, 0, n - 2)
        h, t = x[i + 1] - x[i], edge - x[i]
        slope, third = (y[i + 1] - y[i]) / h - h * (2 * m[i] + m[i + 1]) / 6, (m[i + 1] - m[i]) / h
        value = y[i] + t * (slope + t * (m[i] / 2 + t * third / 6))
        slope += t * (m[i] + t * third / 2)
        return np.array([value, slope, m[i] + t * third, third] if inside
                        else [value + slope * (u - edge), slope, 0, 0])
def lines(knots):  # a knot belongs to the interval to its right; the outer intervals go on
    x, y = np.array(knots, float).T
    def at(u):
        i = clip(int(np.searchsorted(x, u, side="right")) - 1, 0, max(len(x) - 2, 0))
        if len(x) == 1 or x[i + 1] == x[i]:
            return y[i] if len(x) == 1 or u < x[i] else y[i + 1]
        return y[i] + (y[i + 1] - y[i]) / (x[i + 1] - x[i]) * (u - x[i])
    return at
def function(f):
    """A function of one number."""
    curve = {
        "constant": lambda: lambda x: f["value"],
        "linear": lambda: lambda x: f["slope"] * x + f["intercept"],
        "polynomial": lambda: lambda x: np.polynomial.polynomial.polyval(x, f["coefficients"] or [0.0]),
        "piecewise_linear": lambda: lines(f["knots"]),
        "simm_spline": lambda: lambda x, spline=Spline(f): spline.at(x)[0],
    }[f["kind"]]()
    return lambda x: clamp(f.get("factor", 1.0) * curve(x))
def powers(dimension, order):
    """All exponents with a sum of at most `order`, the last one varying fastest."""
    if dimension == 0:
        yield ()
    for first in range(order + 1 if dimension else 0):
        yield from ((first,) + rest for rest in powers(dimension - 1, order - first))
def function_of_several(f):
    if f["kind"] == "linear":
        return lambda x: clamp(f["intercept"] + np.dot(f["slopes"], x))
    terms = [(c, p) for c, p in zip(f["coefficients"], powers(f["dimension"], f["order"])) if c != 0]
    return lambda x: clamp(sum(c * np.prod(np.power(x, p)) for c, p in terms))
class Cone:
    """The legal directions and twists of a ball joint."""
    def __init__(self, p):
        self.of, self.axes = p["of"], [np.array(a, float) for a in p["axes"]]
        self.rest = r = unit(np.array(p["rest"], float))
        self.nearest, self.twist = p["projection"] == "nearest", p["twist_at_rest"]
        corners = [unit(np.array(q["direction"], float)) for q in p["points"]]
        self.at_rest = np.array(self.twist or [0, 0], float)
        bounds = [np.array(q["twist"] or self.at_rest, float) for q in p["points"]]
        pairs = zip(corners, corners[1:] + corners[:1])
        if sum(atan2(r @ cross(a, b), a @ b - (r @ a) * (r @ b)) for a, b in pairs) < 0:
            corners, bounds = corners[::-1], bounds[::-1]
        self.second = unit(cross(r, corners[0]))
        self.first = cross(self.second, r)
        for _ in range(p["subdivisions"]):
            corners, bounds = self.refined(corners, bounds)
        self.corners, self.bounds = np.array(corners), np.array(bounds)
        self.azimuths = np.array([0] + [self.azimuth(c) for c in corners[1:]])
        self.ends = np.roll(self.corners, -1, axis=0)
        self.normals = np.array([unit(cross(a, b)) for a, b in zip(self.corners, self.ends)])
    def azimuth(self, v): return atan2(v @ self.second, v @ self.first) % TAU
    def refined(self, corners, bounds):
        """Twice as many corners, in the chart of angle from rest and azimuth."""
        flat, finer, twists, n = [], [], [], len(corners)
        for c in corners:
            out = np.array([c @ self.first, c @ self.second])
            flat.append(unit(out) * atan2(norm(out), c @ self.rest))
        for i in range(n):
            a, b, c, d = (flat[(i + k) % n] for k in (-1, 0, 1, 2))
            x, y = 9 / 16 * (b + c) - 1 / 16 * (a + d)
            angle = hypot(x, y)
            out = (self.first * x + self.second * y) / angle
            finer += [corners[i], unit(self.rest * cos(angle) + out * sin(angle))]
            twists += [bounds[i], (bounds[i] + bounds[(i + 1) % n]) / 2]
        return finer, twists
    def wedge(self, v):
        at = self.azimuth(v) if hypot(v @ self.first, v @ self.second) > 0 else 0
        return max(int(np.searchsorted(self.azimuths, at, side="right")) - 1, 0)
    def contains(self, v, depth=0.0): return v @ self.normals[self.wedge(v)] >= depth
    def project(self, v):
        """A direction outside, moved to the boundary and as little inside as matters."""
        r, out = self.rest, v - self.rest * (v @ self.rest)
        if not self.nearest and norm(out) >= 1e-12:
            out, n = unit(out), self.normals[self.wedge(v)]
            point, inward = unit(out * (n @ r) - r * (n @ out)), r
        else:
            sines = self.normals @ v
            feet = v - self.normals * sines[:, None]
            before = np.einsum("ij,ij->i", feet, np.cross(self.normals, self.corners))
            after = np.einsum("ij,ij->i", feet, np.cross(self.ends, self.normals))
            far = np.where((before >= 0) & (after >= 0), np.arcsin(np.minimum(abs(sines), 1)), np.inf)
            chords = np.linalg.norm(self.corners - v, axis=1)
            arc, corner = int(np.argmin(far)), int(np.argmin(chords))
            point, inward = unit(feet[arc]), self.normals[arc]
            if far[arc] > 2 * np.arcsin(min(chords[corner] / 2, 1)):
                point, inward = self.corners[corner], unit(self.normals[corner] + self.normals[corner - 1])
        for step in 1e-13 * 4.0 ** np.arange(20):
            for toward in (inward, unit(r - point * (r @ point))):
                if self.contains(unit(point + toward * step), 1e-14):
                    return unit(point + toward * step)
        return r
    def outside(self, rotation, v):
        """The bounds of twist, the twist, and by how much it is above the lower and below the upper."""
        r, i, q = self.rest, self.wedge(v), quaternion_of(rotation)
        twist = 2 * atan2(q[:3] @ r, q[3]) if 1 + unit(rotation @ r) @ r >= 1e-14 else 0.0
        out = v - r * (v @ r)
        bounds = self.at_rest if v @ r > 0 else self.bounds[i]
        if norm(out) >= 1e-9:
            e, n = unit(out), self.normals[i]
            around = cross(r, e)
            alpha, beta = around @ self.ends[i], -around @ self.corners[i]
            t = clip(beta / (alpha + beta), 0, 1)
            rho = min(atan2(norm(out), v @ r) / atan2(n @ r, -n @ e), 1)
            edge = (1 - t) * self.bounds[i] + t * self.bounds[(i + 1) % len(self.bounds)]
            share = rho * rho * (3 - 2 * rho)
            bounds = (1 - share) * self.at_rest + share * edge
        half, off = (bounds[1] - bounds[0]) / 2, twist - (bounds[0] + bounds[1]) / 2
        off -= TAU * np.ceil((off - pi) / TAU)
        return bounds, twist, off + half, half - off
    def legal_rotation(self, rotation):
        """The legal rotation, or None where the given one is legal."""
        r, v = self.rest, unit(rotation @ self.rest)
        inside, held = self.contains(v), False
        direction = v if inside else self.project(v)
        bounds, twist, above, below = self.outside(rotation, direction)
        if self.twist and min(above, below) < -1e-10:
            held, twist = True, bounds[0] if above < 0 else bounds[1]
        if inside and not held:
            return None
        axis = cross(r, direction)
        swing = turn(unit(axis), atan2(norm(axis), r @ direction)) if norm(axis) > 1e-12 else ONE
        return swing @ turn(r, twist)
    def product(self, angles):
        rotation = ONE
        for axis, angle in zip(self.axes, angles):
            rotation = rotation @ turn(axis, angle)
        return rotation
    def legal(self, asked):
        rotation = matrix_of(asked) if self.of == "orientation" else self.product(asked)
        if self.of == "directions":
            v = unit(rotation @ self.rest)
            return asked if self.contains(v) else self.angles(self.project(v), None, asked)
        legal = self.legal_rotation(rotation)
        if legal is None or self.of == "orientation":
            return asked if legal is None else quaternion_of(legal)
        return self.angles(legal @ self.axes[2], legal, asked)
    def angles(self, w, rotation, asked):
        """The angles that turn the third axis to w, and give the rotation where there is one."""
        a, b, c = self.axes + ([self.rest] if len(self.axes) == 2 else [])
        if max(abs(a @ b), abs(c @ b)) > 1e-6:
            return self.oblique(w, rotation, asked)
        lead = atan2(b @ cross(a, c), a @ c)
        along, up, side, sine = w @ a, w @ b, w @ cross(a, b), hypot(w @ b, w @ cross(a, b))
        def solve(sign):
            first = atan2(sign * up, -sign * side) if sine > 1e-9 else asked[0]
            found = [first, atan2(sign * sine, along) - lead]
            if rotation is not None:
                left = (turn(a, first) @ turn(b, found[1])).T @ rotation @ b
                found.append(atan2(c @ cross(b, left), b @ left))
            return [near(*pair) for pair in zip(found, asked)]
        lock = sin(lead) if abs(sin(lead)) > 1e-6 else sin(asked[1] + lead)
        both = [solve(copysign(1, lock))] if abs(lock) > 1e-6 else [solve(1), solve(-1)]
        return min(both, key=lambda found: sum((x - y) ** 2 for x, y in zip(found, asked)))
    def allowed(self, angles):
        """Whether angles are legal to 1e-9."""
        rotation = self.product(angles)
        v = unit(rotation @ self.rest)
        inside = self.contains(v) or norm(v - self.project(v)) <= 1e-9
        return inside and (not self.twist or self.of != "angles" or min(self.outside(rotation, v)[2:]) >= -1e-9)
    def oblique(self, w, rotation, asked):
        angles, n = np.array(asked, float), len(asked)
        for _ in range(50):
            turned = self.product(angles)
            moving = np.array([self.product(angles[:k]) @ self.axes[k] for k in range(n)])
            if rotation is not None:
                left = logarithm(rotation @ turned.T)
            else:
                at = turned @ self.rest
                about = cross(at, w)
                left = about * (atan2(norm(about), at @ w) / max(norm(about), 1e-300))
                moving = moving - np.outer(moving @ at, at)
            if norm(left) < 1e-14:
                break
            step = np.linalg.solve(moving @ moving.T + 1e-9 * np.eye(n), moving @ left)
            angles += np.clip(step, -0.5, 0.5)
        low, high = (1.0, 1.0) if self.allowed(angles) else (0.0, 1.0)
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if self.allowed(angles * middle) else (low, middle)
        return list(angles * low)
def near(angle, wanted):
    """The nearest of the angles that differ by whole turns; of two that nearer to 0, of ±π the positive."""
    turns = [angle + (k + (wanted - angle) // TAU) * TAU for k in (-1, 0, 1, 2)]
    best = [x for x in turns if abs(x - wanted) < min(abs(x - wanted) for x in turns) + 2e-9]
    return max(x for x in best if abs(x) < min(map(abs, best)) + 1e-9)
def ellipse(p, asked):
    """Two numbers, moved to the nearest point of an ellipse where they are outside."""
    centre, square = np.array(p["centre"], float), np.array(p["half_axes"], float) ** 2
    s, c = sin(p["tilt"]), cos(p["tilt"])
    tilt = np.array([[c, -s], [s, c]])
    own = tilt.T @ (np.array(asked) - centre)
    if (own ** 2 / square).sum() <= 1 + 1e-12:
        return asked
    # x = r²p/(t + r²) with the one positive root t of Σ (r·p/(t + r²))² = 1, approached from below.
    z, t = square * own ** 2, 0.0
    for _ in range(200):
        t += ((z / (t + square) ** 2).sum() - 1) / (2 * (z / (t + square) ** 3).sum())
    return list(centre + tilt @ (square * own / (t + square)))
def half_space(p, asked):
    n, x = np.array(p["normal"], float), np.array(asked)
    inside = (p["bound"] - n @ x) / norm(n)
    return asked if inside >= -1e-15 * (1 + max(abs(x))) else list(x + inside * unit(n))
def pivot_place(p, angle):
    """The origin of a frame that turns about an axis whose centre moves: from 0 outwards."""
    axis, centre = np.array(p["axis"], float), p["centre"]
    if centre["kind"] == "intervals":
        ends = [i["to"] for i in centre["intervals"][:-1]]
        places = [np.array(i["at"], float) for i in centre["intervals"]]
        derivatives = lambda at: [places[int(np.searchsorted(ends, at))]] + [np.zeros(3)] * 3
    else:
        ends = sorted({x for s in p["_path"] for x in s.x})
        derivatives = lambda at: np.array([s.at(at) for s in p["_path"]]).T
    sign = copysign(1, angle)
    stops = sorted(e * sign for e in ends if 0 < e * sign < angle * sign) + [angle * sign]
    place, here = np.zeros(3), 0.0
    for stop in (sign * stop for stop in stops):
        middle = (here + stop) / 2
        c, d1, d2, d3 = (v - axis * (axis @ v) for v in derivatives(middle))
        def particular(at):
            h = at - middle
            first, second = d1 + h * (d2 + h * d3 / 2), d2 + h * d3
            value = c + h * (d1 + h * (d2 / 2 + h * d3 / 6))
            return value - cross(axis, first) - second + cross(axis, d3)
        place = particular(stop) + turn(axis, stop - here) @ (place - particular(here))
        here = stop
    return place
def heading(h, tangent):
    forward, up = unit(np.array(h["forward"], float)), unit(np.array(h["up"], float))
    across = lambda v: unit(cross(v, ONE[0] if abs(v[0]) < 0.6 * norm(v) else ONE[1]))
    choose = lambda v, other: unit(v) if norm(v) >= 1e-12 else other
    own = choose(up - forward * (up @ forward), across(forward))
    t = choose(tangent, forward)
    n = choose(up - t * (up @ t), across(t))
    return np.array([t, n, cross(t, n)]).T @ np.array([forward, own, cross(forward, own)])
def wave(k, x): return k[0] + k[1] * cos(x) + k[2] * sin(x) + k[3] * cos(2 * x) + k[4] * sin(2 * x)
def slope(k): return np.array([0, k[2], -k[1], 2 * k[4], -2 * k[3]])
def zeros(k):
    """The zeros of `wave`: between the angles of the roots of its derivative as a polynomial of exp(ix)."""
    _, b, c, d, e = slope(k)
    stops = sorted(np.angle(np.roots([d - 1j * e, b - 1j * c, 0, b + 1j * c, d + 1j * e])))
    found = []
    for low, high in zip(stops, stops[1:] + [x + TAU for x in stops[:1]]):
        below = wave(k, low) < 0
        if (wave(k, high) < 0) != below:
            for _ in range(80):
                middle = (low + high) / 2
                low, high = (middle, high) if (wave(k, middle) < 0) == below else (low, middle)
            found.append((low + high) / 2)
    return found

def touch(pose, radii, axis, point):
    """The rotation about an axis through the origin that puts a point on the ellipsoid."""
    along = axis * (axis @ point)
    m = (pose[:3, :3] @ along + pose[:3, 3]) / radii
    u, w = pose[:3, :3] @ (point - along) / radii, pose[:3, :3] @ cross(axis, point) / radii
    k = np.array([m @ m - 1 + (u @ u + w @ w) / 2, 2 * m @ u, 2 * m @ w, (u @ u - w @ w) / 2, u @ w])
    scale = max(abs(k[1:]))
    if scale <= 1e-15 * abs(k[0]):
        return ONE
    angles, d = zeros(k), slope(k)
    if not angles:
        extrema = zeros(d)
        least = min(abs(wave(k, x)) for x in extrema) + 1e-13 * scale
        angles, k, d = [x for x in extrema if abs(wave(k, x)) <= least], d, slope(d)
    angle = max(angles, key=cos)
    if abs(wave(d, angle)) > 1e-6 * scale:
        angle -= wave(k, angle) / wave(d, angle)
    return turn(axis, angle)
def contact_points(pairs, drivers):
    at, drivers = np.array([pair["at"] for pair in pairs], float), np.array((drivers + [0, 0])[:2], float)
    low, span = at.min(axis=0), np.where(np.ptp(at, axis=0) > 0, np.ptp(at, axis=0), np.inf)
    def smooth(x):
        u = np.clip((x - low) / span, 0, 1)
        return u * u * (3 - 2 * u)
    squares = ((smooth(drivers) - smooth(at)) ** 2).sum(axis=1)
    weights = np.array([np.prod(np.delete(squares, i)) for i in range(len(pairs))])
    return [weights / weights.sum() @ np.array([pair[key] for pair in pairs]) for key in ("first", "second")]
def euler(m, order):
    i, j, last = ("xyz".index(c) for c in order)
    k, e = 3 - i - j, 1.0 if (j - i) % 3 == 1 else -1.0
    length = hypot(m[i, j], m[i, k]) if last == i else hypot(m[i, i], m[i, j])
    middle = atan2(length, m[i, i]) if last == i else atan2(e * m[i, k], length)
    if length < 1e-9:
        return [atan2(e * m[k, j], m[j, j]), middle, 0.0]
    if last == i:
        return [atan2(m[j, i], -e * m[k, i]), middle, atan2(m[i, j], e * m[i, k])]
    return [atan2(-e * m[j, k], m[k, k]), middle, atan2(-e * m[i, j], m[i, i])]

class Model:
    def __init__(self, data):
        assert data.get("condyle_model") == 1, "this is no resolved model of version 1"
        self.data = data
        self.segments = {s["name"]: s for s in data["segments"]}
        self.coordinates = {c["path"]: c for c in data["coordinates"]}
        self.components = {c["path"]: c for c in data["components"]}
        for s in data["segments"]:
            s["_before"], s["_after"] = frame_of(s["joint_in_parent"]), inverse(frame_of(s["joint_in_segment"]))
        for number, c in enumerate(data["components"]):
            p, c["_number"] = c["parameters"], number
            path = p.get("path") or (p["centre"].get("path") if c["kind"] == "pivot" else None)
            p["_path"] = [Spline(s) for s in path or []]
            p["_functions"] = [f and function(f) for f in p.get("functions", [p.get("lower"), p.get("upper")])]
            p["_cone"] = c["kind"] == "cone" and Cone(p)
            p["_several"] = c["kind"] in ("combine", "correlate") and function_of_several(p["function"])
        self.find_measured(), self.find_written_back()
    def values(self, c):
        """The signals at the ports of a component that are no segments, what is limited first."""
        ports = {"depend": ["passive", "driver"], "ellipse": ["first", "second"]}.get(c["kind"], c["inputs"])
        signals = [c["inputs"][port] for port in ports]
        return [s for one in signals for s in (one if isinstance(one, list) else [one]) if "segment" not in s]
    def find_measured(self):
        """What depends on the places of segments: limits do not move it."""
        self.measured = set()
        measured = lambda s: s is not None and s.get("coordinate", s.get("component")) in self.measured
        for item in self.data["order"]["values"]:
            c = self.components.get(item.get("component"))
            if c is None and measured(self.coordinates[item["coordinate"]]["follows"]):
                self.measured.add(item["coordinate"])
            if c and (c["kind"].startswith("relative_") or any(map(measured, self.values(c)))):
                self.measured.add(c["path"])
    def find_written_back(self):
        """The output that is the effective value of each coordinate that a limit holds."""
        used, self.written, origin = set(), {}, {}
        is_limit = lambda path: self.components[path]["kind"] in LIMITS
        open_ = [s["motion"] for s in self.data["segments"]] + [c["follows"] for c in self.data["coordinates"]]
        open_ += [{"component": path} for path in self.components if is_limit(path) and path in self.measured]
        while open_:
            path = (open_.pop() or {}).get("component")
            if path is not None and path not in used:
                used.add(path)
                open_ += self.values(self.components[path])
                open_ += [self.segments[name]["motion"] for name in self.between(self.components[path])]
        for path in (item.get("component") for item in self.data["order"]["values"]):
            if path not in used or path in self.measured or not is_limit(path):
                continue
            c = self.components[path]
            for k, signal in enumerate(self.values(c)):
                start = (signal["coordinate"], 0) if "coordinate" in signal \
                    else origin.get((signal["component"], signal["output"]))
                if not start or self.coordinates[start[0]]["follows"] or (c["kind"], k) == ("depend", 1):
                    continue
                origin[path, k] = start[0], start[1] + 1
                found = (start[1] + 1, c["_number"], k, path)
                self.written[start[0]] = max(self.written.get(start[0], found), found)
    def path_to(self, name): return [] if name is None else self.path_to(self.segments[name]["parent"]) + [name]
    def below(self, *names):
        """The paths to segments, or to the world, below what all share."""
        paths = [self.path_to(name) for name in names]
        common = 0
        while all(len(p) > common and p[common] == paths[0][common] for p in paths):
            common += 1
        return [path[common:] for path in paths]
    def between(self, c):
        """The segments whose motions a component reads."""
        i, above = c["inputs"], lambda signal: self.segments[signal["segment"]]["parent"]
        paths = {
            "compensate": lambda: self.below(above(i["segment"]), *map(above, i["ancestors"])),
            "contact": lambda: self.below(above(i["segment"]), i["surface"]["segment"]),
            "relative": lambda: self.below(i["segment"]["segment"], i.get("reference", {}).get("segment")),
        }.get(c["kind"].split("_")[0], list)()
        return list(dict.fromkeys(name for path in paths for name in path))
    def evaluate(self, requested, posed):
        """The transforms of all segments in the world, and the effective coordinates."""
        self.posed, self.value, self.outputs, world = posed, {}, {}, {}
        for path, c in self.coordinates.items():
            ends = c["range"] if posed and c["clamped"] and c["follows"] is None else (None, None)
            low, high = (MOST * sign if end is None else end for sign, end in zip((-1, 1), ends))
            asked = [clip(clamp(x), low, high) for x in np.atleast_1d(requested[path])]
            self.value[path] = asked if c["kind"] == "orientation" else asked[0]
        for item in self.data["order"]["values"]:
            if "coordinate" in item:
                self.value[item["coordinate"]] = self.read(self.coordinates[item["coordinate"]]["follows"])
                continue
            c = self.components[item["component"]]
            found = getattr(self, c["kind"])(c["parameters"], c["inputs"], c)
            if c["kind"] in LIMITS:
                asked, legal = found
                found = list(legal(asked) if posed and c["path"] not in self.measured else asked)
            self.outputs[c["path"]] = found if isinstance(found, list) else [found]
        for name in self.data["order"]["segments"]:
            parent = self.segments[name]["parent"]
            world[name] = (np.eye(4) if parent is None else world[parent]) @ self.joint(name)
        written = {path: self.outputs[by][k] for path, (_, _, k, by) in self.written.items()}
        return world, {**self.value, **written}
    def read(self, signal):
        if isinstance(signal, list):
            return [self.read(one) for one in signal]
        if "coordinate" in signal:
            return self.value[signal["coordinate"]]
        return self.outputs[signal["component"]][signal["output"]]
    def motion(self, name):
        motion = self.segments[name]["motion"]
        return np.eye(4) if motion is None else self.read(motion)
    def joint(self, name):
        return self.segments[name]["_before"] @ self.motion(name) @ self.segments[name]["_after"]
    def through(self, names):
        frame = np.eye(4)
        for name in names:
            frame = frame @ self.joint(name)
        return frame
    def relative(self, i):
        to, of = self.below(i["segment"]["segment"], i.get("reference", {}).get("segment"))
        return inverse(self.through(of)) @ self.through(to)
    # Numbers; limits give what is asked, and the function that makes it legal.
    def map(self, p, i, c): return [f(self.read(i["input"])) for f in p["_functions"]]
    def combine(self, p, i, c): return p["_several"](self.read(i["inputs"]))
    correlate = combine
    def depend(self, p, i, c):
        (low, high), driver = p["_functions"], self.read(i["driver"])
        def legal(asked):
            x = max(asked[0], low(driver)) if low else asked[0]
            return [min(x, high(driver)) if high else x]
        return [self.read(i["passive"])], legal
    def cone(self, p, i, c):
        if p["of"] == "orientation":
            return [self.read(i["orientation"])], lambda asked: [p["_cone"].legal(asked[0])]
        return self.read(i["angles"]), p["_cone"].legal
    def ellipse(self, p, i, c): return self.read([i["first"], i["second"]]), lambda asked: ellipse(p, asked)
    def half_space(self, p, i, c): return self.read(i["inputs"]), lambda asked: half_space(p, asked)
    def field(self, p, i, c):
        def legal(_): raise NotImplementedError(f"{c['path']}: a learned limit of a coordinate, posed")
        return [self.read(i["orientation"])], legal
    def relative_orientation(self, p, i, c): return [quaternion_of(self.relative(i)[:3, :3])]
    def relative_position(self, p, i, c):
        at = self.relative(i) @ np.append(p["point"], 1)
        return [clamp(at[:3] @ np.array(n)) for n in p["along"]]
    def angles(self, p, i, c):
        rotation = matrix_of(self.read(i["orientation"]))
        if p["mirrored"]:
            mirror = ONE - 2 * np.diag(ONE["xyz".index(p["mirrored"])])
            rotation = mirror @ rotation @ mirror
        if p["angles"] == "euler":
            return euler(rotation, p["order"])
        k, q = "xyz".index(p["axis"]), quaternion_of(rotation)
        twist = 2 * atan2(q[k], q[3]) if hypot(q[k], q[3]) >= 1e-12 else 0.0
        swing = logarithm(rotation @ turn(ONE[k], twist).T)
        return [twist, swing[(k + 1) % 3], swing[(k + 2) % 3]]
    # Transforms.
    def rotate(self, p, i, c): return rigid(turn(np.array(p["axis"]), self.read(i["angle"])))
    def translate(self, p, i, c): return rigid(place=np.array(p["axis"]) * self.read(i["distance"]))
    def pivot(self, p, i, c):
        angle = self.read(i["angle"])
        return rigid(turn(np.array(p["axis"]), angle), pivot_place(p, angle))
    def ball(self, p, i, c): return rigid(matrix_of(self.read(i["orientation"])))
    def place(self, p, i, c): return frame_of(p["child_in_parent"])
    def product(self, p, i, c):
        frame = np.eye(4)
        for factor in self.read(i["factors"]):
            frame = frame @ factor
        return frame
    def scale(self, p, i, c):
        s = clip(self.read(i["factor"]), 1e-6, 1e6)
        line = np.outer(p.get("axis", ONE[0]), p.get("axis", ONE[0]))
        across = {"everywhere": s, "axis": 1, "volume": s ** -0.5}[p["along"]]
        return rigid(s * line + across * (ONE - line))
    def shear(self, p, i, c):
        return rigid(ONE + clip(self.read(i["amount"]), -1e6, 1e6) * np.outer(p["along"], p["across"]))
    def curve(self, p, i, c):
        at = np.array([s.at(self.read(i["parameter"])) for s in p["_path"]])
        return rigid(p["heading"] and heading(p["heading"], at[:, 1]), at[:, 0])
    def ellipsoid(self, p, i, c):
        angles, radii = self.read([i["about_x"], i["about_y"], i["about_z"]]), np.array(p["radii"], float)
        rotation = turn(ONE[0], angles[0]) @ turn(ONE[1], angles[1]) @ turn(ONE[2], angles[2])
        place = radii * rotation[:, 2]
        return rigid(rotation, place if p["surface_axis"] == "opensim" else radii * place / norm(place))
    def constant_curvature(self, p, i, c):
        most, asked = pi / 2 - 0.01, self.read([i["about_x"], i["about_z"], i["about_y"]])
        x, z, y = (clip(a + n, -most, most) for a, n in zip(asked, p["neutral"]))
        rotation = turn(ONE[0], x) @ turn(ONE[2], z) @ turn(ONE[1], y)
        tip, length = rotation[:, 1], p["length"]
        sine = hypot(tip[0], tip[2])
        if not 0.001 <= sine <= 0.999:
            return rigid(rotation, length * tip)
        theta, out = np.arcsin(sine), (1 - sqrt(1 - sine * sine)) / sine
        return rigid(rotation, length / theta * np.array([out * tip[0], sine, out * tip[2]]))
    def compensate(self, p, i, c):
        whole, less, named = ONE, ONE, [s["segment"] for s in i["ancestors"]]
        for name in self.between(c):
            motion = self.motion(name)[:3, :3]
            left = power(motion, 1 - p["weight"]) if name in named else motion
            before, after = (self.segments[name][key][:3, :3] for key in ("_before", "_after"))
            whole, less = whole @ before @ motion @ after, less @ before @ left @ after
        joint = self.segments[i["segment"]["segment"]]["_before"][:3, :3]
        return rigid(joint.T @ whole.T @ less @ joint)
    def contact(self, p, i, c):
        segment = self.segments[i["segment"]["segment"]]
        pose = inverse(frame_of(p["ellipsoid_in_surface"])) @ self.through(self.between(c)) @ segment["_before"]
        pose = pose @ self.read(i["before"]) if "before" in i else pose
        # Points and axis are given in the segment, and used in its joint frame.
        into, radii = segment["_after"], np.array(p["radii"], float)
        points = contact_points(p["pairs"], self.read(i.get("drivers", [])))
        first, second = (into[:3, :3] @ q + into[:3, 3] for q in points)
        theta = touch(pose, radii, into[:3, :3] @ np.array(p["axis"]), first)
        if norm(first) < 1e-9:
            return rigid(theta)
        return rigid(theta @ touch(pose @ rigid(theta), radii, unit(first), second))
def apart(one, other):
    """The largest difference, relative where a number is above 1; orientations by their matrices."""
    one, other = (matrix_of(x) if np.shape(x) == (4,) else np.array(x, float) for x in (one, other))
    return float((abs(one - other) / np.maximum(1, abs(other))).max())
def main():
    assert len(sys.argv) == 3, __doc__
    model, record = (json.load(open(path, encoding="utf-8")) for path in sys.argv[1:])
    model, worst = Model(model), {"transforms": (0.0, 0, ""), "coordinates": (0.0, 0, "")}
    for number, pose in enumerate(record["poses"]):
        world, effective = model.evaluate(pose["requested"], pose["mode"] == "posed")
        world = {name: frame[:3] for name, frame in world.items()}
        for what, found, key in [("transforms", world, "segments"), ("coordinates", effective, "effective")]:
            apart_by = [(apart(found[name], known), number, name) for name, known in pose[key].items()]
            worst[what] = max([worst[what]] + apart_by)
    for what, (off, number, where) in worst.items():
        print(f"{len(record['poses'])} poses: {what} differ by {off:.1e} at most (number {number}, {where})")
    return 0 if max(off for off, *_ in worst.values()) <= 1e-12 else 1
if __name__ == "__main__":
    sys.exit(main())
