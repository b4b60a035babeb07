"""Laws of coordinates by NumPy and SciPy, the slow and obvious way.

    python coupling/regression.py > coupling/regression.json

Three small data sets are made here and written down with their answers: coefficients by numpy.linalg.lstsq, intervals by the
sandwich of Bell & McCaffrey 2002 (CR2) with the matrices written out in full (I - H of every trial and its inverse square
root, Satterthwaite's degrees of freedom from the N x G matrix of that paper), t quantiles of scipy.stats, every trial left
out by a fit of the other rows, ridge by the normal equations, partial R2 by a fit without a control, the condition number
of the columns scaled to length 1. Nothing is shared with condyle. Needs numpy and scipy.
"""
import json
import numpy as np
from scipy import stats, linalg


def with_constant(x):
    return np.c_[np.ones(len(x)), x]


def cr2(x, y, trials):
    n, p = x.shape
    inverse = np.linalg.inv(x.T @ x)
    b = inverse @ x.T @ y
    e = y - x @ b
    full = np.eye(n) - x @ inverse @ x.T
    meat, columns = np.zeros((p, p)), []
    for g in np.unique(trials):
        own = trials == g
        values, vectors = np.linalg.eigh(full[np.ix_(own, own)])
        root = vectors @ np.diag(1 / np.sqrt(values)) @ vectors.T
        score = x[own].T @ root @ e[own]
        meat += np.outer(score, score)
        columns.append(full[:, own] @ root @ x[own] @ inverse)
    variance = inverse @ meat @ inverse
    freedom = []
    for k in range(p):
        g = np.array([c[:, k] for c in columns]).T
        values = np.linalg.eigvalsh(g.T @ g)
        freedom.append(values.sum() ** 2 / (values**2).sum())
    freedom, error = np.array(freedom), np.sqrt(np.diag(variance))
    wide = stats.t.ppf(0.975, freedom) * error
    return b, np.c_[b - wide, b + wide], freedom


def left_out(x, y, trials):
    error = np.zeros(len(y))
    for g in np.unique(trials):
        own = trials == g
        b = np.linalg.lstsq(x[~own], y[~own], rcond=None)[0]
        error[own] = y[own] - x[own] @ b
    return float(np.sqrt(np.mean(error**2)))


def powers(a, b):
    """All products up to order 2, the exponent of the last varying fastest, without the constant."""
    return np.c_[b, b**2, a, a * b, a**2]


def answer(name, terms, controls, y, trials, basis, dependence):
    x = with_constant(terms)
    b, ends, freedom = cr2(x, y, trials)
    e = y - x @ b
    about = terms - terms.mean(0)
    scaled = about / np.linalg.norm(about, axis=0)
    partial = []
    for k in range(controls.shape[1]):
        kept = with_constant(terms[:, [not d[k] for d in dependence]])
        r = y - kept @ np.linalg.lstsq(kept, y, rcond=None)[0]
        partial.append(float(1 - e @ e / (r @ r)))
    squares = (about**2).sum(0)
    shrunk = linalg.solve(about.T @ about + 0.05 * np.diag(squares), about.T @ (y - y.mean()))
    return dict(
        name=name, basis=basis, controls=controls.tolist(), y=y.tolist(), trials=trials.tolist(),
        coefficients=b.tolist(), ci95=ends.tolist(), freedom=freedom.tolist(),
        r2=float(1 - e @ e / ((y - y.mean()) ** 2).sum()), rmse=float(np.sqrt(np.mean(e**2))),
        left_out_rmse=left_out(x, y, trials), partial_r2=partial,
        condition=float(np.linalg.cond(scaled)), ridge_0_05=shrunk.tolist(),
    )


def data(seed, sizes):
    rng = np.random.default_rng(seed)
    trials = np.repeat(np.arange(len(sizes)), sizes)
    controls, y = [], []
    for size in sizes:
        t = np.linspace(0, 6, size) + rng.uniform(0, 6)
        a = 0.6 + 0.5 * np.sin(t) + 0.1 * rng.normal()
        b = 0.1 * np.cos(1.3 * t) + 0.05 * rng.normal()
        controls.append(np.c_[a, b])
        y.append(-0.4 + 0.03 * a - 0.02 * b + 0.005 * a * b + 0.002 * rng.normal() + 0.002 * rng.normal(size=size))
    return np.round(np.concatenate(controls), 6), np.round(np.concatenate(y), 6), trials


if __name__ == "__main__":
    answers = []
    for seed, sizes in [(1, [12, 9, 15, 10, 11]), (2, [20, 5, 8, 16, 9, 13, 7])]:
        controls, y, trials = data(seed, sizes)
        one = [[True, False], [False, True]]
        answers.append(answer(f"linear {seed}", controls, controls, y, trials, "linear", one))
        two = [[False, True], [False, True], [True, False], [True, True], [True, False]]
        terms = powers(controls[:, 0], controls[:, 1])
        answers.append(answer(f"squares {seed}", terms, controls, y, trials, "polynomial:2", two))
    quantiles = [[p, f, float(stats.t.ppf(p, f))] for p in (0.9, 0.975, 0.9995) for f in (0.7, 1, 2.5, 9, 41.3, 1e4)]
    print(json.dumps(dict(answers=answers, t=quantiles)))
