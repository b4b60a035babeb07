"""Herda, Urtasun, Fua & Hanson 2003, restated slowly in NumPy and SciPy from the paper's formulas.

Usage: python herda.py > herda.json

A cloud of 300 points is drawn in a bent body; then the outer points of 7 x 7 solid angles (section 4.1), the
energy of equation 6 and the C of equation 7 of given spheres, the minima of E over one and two spheres from
the paper's start, the split into six and into two as `split.rs` states it, and projections by dichotomy
(section 5.1), each with a root finder of SciPy. Nothing is shared with the Rust code: loops over points, E
minimised by L-BFGS-B and then by a trust-region least-squares solver.
"""

import json
import math

import numpy as np
from scipy.optimize import brentq, least_squares, minimize, minimize_scalar

K, L, T, ALPHA2 = 5.0, 7, 0.1, 0.01


def f(r, e):
    if r <= e:
        return -K * r + K * e + 1.0
    if r <= e + 2.0 / K:
        return 0.25 * (K * (r - e) - 2.0) ** 2
    return 0.0


def field(p, spheres):
    return sum(f(math.dist(p, s[:3]), s[3]) for s in spheres)


def slope(p, spheres):
    g = np.zeros(3)
    for s in spheres:
        d = np.array(p) - s[:3]
        r = math.sqrt(d @ d)
        if r <= s[3]:
            g += -K * d / r
        elif r <= s[3] + 2.0 / K:
            g += 0.5 * K * (K * (r - s[3]) - 2.0) * d / r
    return g


def energy(points, centroid, spheres):
    first = sum((field(p, spheres) - 1.0) ** 2 for p in points) / len(points)
    third = sum(sum((s[i] - centroid[i]) ** 2 for i in range(3)) for s in spheres) * ALPHA2 / len(spheres)
    return first + third


def surface(points):
    c = sum(np.array(p) for p in points) / len(points)
    cell, rho = [], []
    for p in points:
        x, y, z = np.array(p) - c
        r = math.sqrt(x * x + y * y + z * z)
        theta, phi = math.acos(z / r), math.atan2(y, x) + math.pi
        i = min(int(theta / math.pi * L), L - 1)
        k = min(int(phi / (2 * math.pi) * L), L - 1)
        cell.append((i, k))
        rho.append(r)
    largest = {}
    for c, r in zip(cell, rho):
        largest[c] = max(r, largest.get(c, 0.0))
    return [j for j in range(len(points)) if (1 - T) * largest[cell[j]] < rho[j] <= largest[cell[j]]]


def misfit(points, spheres):
    answer = []
    for s in spheres:
        near = [p for p in points if math.dist(p, s[:3]) <= s[3] + 2.0 / K]
        answer.append(sum((field(p, spheres) - 1.0) ** 2 for p in near) / len(near))
    return answer


def best(points, centroid, spheres):
    m = len(spheres)

    def total(x):
        return energy(points, centroid, x.reshape(m, 4))

    def residuals(x):
        s = x.reshape(m, 4)
        first = [(field(p, s) - 1.0) / math.sqrt(len(points)) for p in points]
        third = ((s[:, :3] - centroid) * math.sqrt(ALPHA2 / m)).ravel()
        return np.concatenate([first, third])

    bounds = [(None, None)] * 3 + [(0.0, None)]
    x = minimize(total, np.array(spheres, float).ravel(), method="L-BFGS-B", bounds=bounds * m).x
    low = np.tile([-np.inf, -np.inf, -np.inf, 0.0], m)
    done = least_squares(residuals, np.maximum(x, low), jac="3-point", bounds=(low, np.inf), xtol=1e-15, ftol=1e-15, gtol=1e-13)
    return done.x.reshape(m, 4)


def split(points, sphere, parts):
    c, e = np.array(sphere[:3]), sphere[3]
    near = np.array([p for p in points if math.dist(p, c) <= e + 2.0 / K])
    _, vectors = np.linalg.eigh(np.cov(near.T))
    axis = vectors[:, 2]
    spread = max(0.25 * e, 0.05)
    places = np.linspace(-spread, spread, parts)
    cosines = (2 * np.arange(64) + 1) / 64 - 1

    def off(radius):
        total = 0.0
        for u in cosines:
            value = sum(f(math.sqrt(e * e + a * a - 2 * e * a * u), radius) for a in places)
            total += (value - 1.0) ** 2
        return total

    # From the best of a grid, for the integral need not be convex.
    grid = np.linspace(0, e + 2 / K, 400)
    at = grid[np.argmin([off(r) for r in grid])]
    step = grid[1]
    radius = minimize_scalar(off, bounds=(max(0, at - step), at + step), method="bounded", options={"xatol": 1e-14}).x
    if off(0.0) <= off(radius):
        radius = 0.0
    return np.array([[*(c + a * axis), radius] for a in places])


def project(p, spheres):
    if field(p, spheres) >= 1.0:
        return list(p)
    strength = [f(math.dist(p, s[:3]), s[3]) for s in spheres]
    if max(strength) == 0.0:
        return None
    s = spheres[int(np.argmax(strength))]
    d = math.dist(p, s[:3]) - s[3]
    g = slope(p, spheres)
    g /= math.sqrt(g @ g)
    if field(p + d * g, spheres) < 1.0:
        return None
    t = brentq(lambda t: field(p + t * g, spheres) - 1.0, 0.0, d, xtol=1e-14)
    return list(p + t * g)


def main():
    rng = np.random.default_rng(2003)
    points = []
    while len(points) < 300:
        p = rng.uniform(-0.8, 0.8, 3)
        bent = p - np.array([0.0, 0.5 * p[0] ** 2, 0.0])
        if (bent[0] / 0.7) ** 2 + (bent[1] / 0.4) ** 2 + (bent[2] / 0.5) ** 2 < 1.0:
            points.append([round(float(x), 4) for x in p])
    outer = surface(points)
    shell = [points[j] for j in outer]
    centroid = np.mean(shell, axis=0)
    start = [[*centroid, float(np.mean([math.dist(p, centroid) for p in shell]))]]
    given = [[0.1, 0.2, 0.0, 0.3], [-0.35, 0.1, 0.1, 0.2], [0.4, 0.15, -0.1, 0.25], [0.0, -0.05, 0.3, 0.0]]
    queries = [[round(float(x), 4) for x in rng.uniform(-1.0, 1.0, 3)] for _ in range(60)]
    one = best(shell, centroid, start)
    halves = split(shell, one[0], 2)
    two = best(shell, centroid, halves)
    answer = {
        "points": points,
        "surface": outer,
        "start": start[0],
        "given": given,
        "given_energy": energy(shell, centroid, np.array(given)),
        "given_misfits": misfit(shell, given),
        "start_energy": energy(shell, centroid, start),
        "one": one[0].tolist(),
        "one_energy": energy(shell, centroid, one),
        "halves": halves.tolist(),
        "sixths": split(shell, one[0], 6).tolist(),
        "two": two.tolist(),
        "two_energy": energy(shell, centroid, two),
        "queries": queries,
        "values": [field(p, given) for p in queries],
        "projections": [project(np.array(p), np.array(given)) for p in queries],
    }
    print(json.dumps(answer))


main()
