#!/usr/bin/env python3
"""Least values of the marker inverse kinematics objective, found by scipy over OpenSim's forward kinematics.

    pip install opensim numpy scipy
    python minima.py DATA OUT.json [--frames 6] [--starts 20] [--only TEXT]

DATA is the folder that holds `ik/`, `knee/` and `shoulder/`. For each case of a model, a trial and perhaps a setup:

1. OpenSim's InverseKinematicsTool solves all frames at accuracy 1e-5 and 1e-8; F is evaluated on its answers as written.
2. On a few frames, evenly spread, first and last included, F is minimised from many starts.

    F = (sum_m w_m |e_m|^2) / (sum_m w_m)  +  sum_c w_c (q_c - t_c)^2        [+ weight |loop error|^2]

The sums run over the markers with positive weight that the model has and the frame shows. Free: coordinates that are
neither locked (these stay at their default) nor driven by a CoordinateCouplerConstraint (these are its function of the
others, exactly, and are not bounded). Bounds: the range of coordinates whose `clamped` is true. Loops (whatever
constraint is left) hold exactly by an augmented Lagrangian where the constraint weight is infinite and are the term in
brackets where it is finite (OpenSim's tool holds them exactly all the same; no case below has a loop and a finite weight).

Each start runs scipy's trust-region reflective method (Jacobian by forward differences, tolerances 1e-12), then
dogbox from there (central differences), which puts active bounds exactly on the bound. Starts: OpenSim's answer at 1e-8
and at 1e-5, the default pose, and random ones: near OpenSim's answer (0.3 and 1 rad, a tenth of it in metres) or, for
coordinates with bounds, anywhere within the range. The seed is fixed.

`best_F` is the least F of all starts, `near_F` the one reached from OpenSim's answer at 1e-8: the minimum of its basin. Where
`best_F` is lower by more than 1e-6, `best_differs_from_near` shows by how much which coordinate (over 1 degree or 1 cm):
without bounds the least F may be no human pose (gait10dof: the knee a whole turn away, its splines extrapolated).
A coordinate that moves no marker keeps the value its start gave it: compare F, not coordinates. Were OpenSim's F below
the least one listed, its answer would break a bound or a coupling (`opensim_bound_excess`, `opensim_coupling_error`).

Where a bound is active OpenSim stays a little inside of it, the more so the coarser the accuracy (an interior-point method):
that puts its F 2 to 7 % above the least at 1e-5 in the opencap4 cases, 2e-5 to 9e-5 of it at 1e-8; on a frame tried at 1e-12 it is gone.
"""
import argparse, contextlib, json, os, re, sys, tempfile, time
import xml.etree.ElementTree as ET
import numpy as np
import opensim as osim
import scipy
from scipy.optimize import least_squares

osim.Logger.setLevelString("Off")

CASES = [  # model, trial, setup or task set, constraint weight (None: of the setup, else infinite)
    ("ik/core_subject01/subject01_simbody.osim", "ik/core_subject01/subject01_synthetic_marker_data.trc",
     "ik/core_subject01/gait2354_IK_Tasks_uniform.xml", 10.0),
    ("ik/core_subject01/subject01_simbody.osim", "ik/core_subject01/subject01_synthetic_marker_data.trc",
     "ik/core_subject01/gait2354_IK_Tasks.xml", 10.0),
    ("ik/arm26/arm26.osim", "ik/arm26/arm26_elbow_flex.trc", "ik/arm26/arm26_Setup_InverseKinematics.xml", None),
    ("ik/core_abdbonepin/subject1_abdbonepin.osim", "shoulder/bonepin/abdbonepin.trc",
     "ik/core_abdbonepin/setup_ik_abdbonepin.xml", None),
    ("ik/gait10dof/subject01.osim", "ik/gait10dof/subject01_walk.trc", "ik/gait10dof/walk_Setup_IK.xml", None),
    ("knee/opencap4/manually_scaled.osim", "knee/opencap4/squats1.trc", None, None),
    ("knee/opencap4/manually_scaled.osim", "knee/opencap4/walking1.trc", None, None),
    ("knee/opencap4/manually_scaled.osim", "knee/opencap4/static1.trc", None, None),
    ("ik/lai_subject6/LaiArnoldModified2017_scaled.osim", "ik/lai_subject6/walking1.trc", None, None),
    ("knee/lenhart/lenhart2015.osim", "knee/lenhart/overground_17.trc", None, None),
]


def load_model(path, folder):
    """The model without what has no part in kinematics (forces, contact), which may need plug-ins."""
    tree = ET.parse(path); model = tree.getroot().find("Model")
    for tag in ("ForceSet", "ContactGeometrySet", "ControllerSet", "ProbeSet"):
        for e in model.findall(tag): model.remove(e)
    copy = os.path.join(folder, os.path.basename(path)); tree.write(copy)
    return copy


def parse(path):
    """The root element; what follows its end (OpenSim ignores it, gait2354_IK_Tasks.xml has a stray closing tag) is cut."""
    try: return ET.parse(path).getroot()
    except ET.ParseError:
        text = open(path).read(); name = re.search(r"<(\w+)", text).group(1); end = f"</{name}>"
        return ET.fromstring(text[:text.index(end) + len(end)])


@contextlib.contextmanager
def quiet():
    """The tool prints a summary of the model to the standard output whatever the log level."""
    sys.stdout.flush(); saved, null = os.dup(1), os.open(os.devnull, os.O_WRONLY); os.dup2(null, 1)
    try: yield
    finally: os.dup2(saved, 1); os.close(saved); os.close(null)


class Case:
    def __init__(self, data, model, trial, setup, constraint_weight, folder):
        self.path, self.trial_path = os.path.join(data, model), os.path.join(data, trial)
        self.setup_path = os.path.join(data, setup) if setup else None
        self.note = None
        try: osim.Model(self.path)
        except RuntimeError:
            self.path = load_model(self.path, folder)
            self.note = "model loaded without its forces, contact geometry and controllers (plug-in classes)"
        self.model = osim.Model(self.path); self.state = self.model.initSystem()
        cs = self.model.getCoordinateSet()
        self.coords = [cs.get(i) for i in range(cs.getSize())]; self.names = [c.getName() for c in self.coords]
        self.angle = np.array([c.getMotionType() == 1 for c in self.coords])
        self.default = np.array([c.getDefaultValue() for c in self.coords])
        self.low = np.array([c.getRangeMin() if c.getDefaultClamped() else -np.inf for c in self.coords])
        self.high = np.array([c.getRangeMax() if c.getDefaultClamped() else np.inf for c in self.coords])
        locked = np.array([c.getDefaultLocked() for c in self.coords])
        for c in self.coords: c.setClamped(self.state, False); c.setLocked(self.state, False)
        self.slot = self.find_slots()
        self.couplers, dependent = self.find_couplers(), set()
        for d, *_ in self.couplers: dependent.add(d)
        self.low[list(dependent)], self.high[list(dependent)] = -np.inf, np.inf
        self.free = [i for i in range(len(self.coords)) if not locked[i] and i not in dependent]
        self.nfull = self.state.getNQ()

        table = osim.TimeSeriesTableVec3(self.trial_path); labels = list(table.getColumnLabels())
        self.times = np.array(table.getIndependentColumn())
        unit = {"mm": 1e-3, "cm": 1e-2}.get(table.getTableMetaDataAsString("Units").strip().lower(), 1.0)
        markers = self.model.getMarkerSet(); known = {markers.get(i).getName() for i in range(markers.getSize())}
        weights, self.tasks, self.window, weight = {n: 1.0 for n in labels if n in known}, {}, None, "Inf"
        if setup:
            root, weights = parse(self.setup_path), {}
            text = lambda t, tag, default: (t.findtext(tag) or default).strip()
            for t in root.iter("IKMarkerTask"):
                n, w = t.get("name"), float(text(t, "weight", "1"))
                if text(t, "apply", "true").lower() == "true" and w > 0 and n in known and n in labels: weights[n] = w
            for t in root.iter("IKCoordinateTask"):
                if text(t, "apply", "true").lower() == "true" and float(text(t, "weight", "0")) > 0:
                    i = self.names.index(t.get("name"))
                    kind = text(t, "value_type", "default_value")
                    assert kind in ("default_value", "manual_value"), kind
                    target = self.default[i] if kind == "default_value" else float(text(t, "value", "0").split()[0])
                    self.tasks[i] = (target, float(text(t, "weight", "1")))
            weight = text(root, ".//constraint_weight", "Inf")
            if root.findtext(".//time_range"): self.window = [float(x) for x in root.findtext(".//time_range").split()]
        self.constraint_weight = constraint_weight if constraint_weight is not None else float(weight)
        self.used = list(weights); self.w = np.array([weights[n] for n in self.used])
        self.marks = [markers.get(n) for n in self.used]
        columns = [labels.index(n) for n in self.used]
        self.targets = np.full((len(self.times), len(self.used), 3), np.nan)
        for r in range(len(self.times)):
            row = table.getRowAtIndex(r)
            for k, c in enumerate(columns): self.targets[r, k] = row[c].to_numpy() * unit

    def find_slots(self):
        """Which of Simbody's q each coordinate is (they are in another order, and ball joints leave gaps)."""
        before, slot = self.state.getQ().to_numpy().copy(), []
        for c in self.coords:
            v = c.getValue(self.state); c.setValue(self.state, v + 0.0625, False)
            moved = np.flatnonzero(self.state.getQ().to_numpy() != before); assert len(moved) == 1
            slot.append(moved[0]); c.setValue(self.state, v, False)
        return np.array(slot)

    def find_couplers(self):
        out, cs = [], self.model.getConstraintSet()
        for i in range(cs.getSize()):
            c = osim.CoordinateCouplerConstraint.safeDownCast(cs.get(i))
            if c is None or not cs.get(i).get_isEnforced(): continue
            drivers = c.getIndependentCoordinateNames()
            drivers = [self.names.index(drivers.get(k)) for k in range(drivers.getSize())]
            out.append((self.names.index(c.getDependentCoordinateName()), drivers, c.getFunction().clone(), osim.PropertyHelper.getValueDouble(c.getPropertyByName("scale_factor"))))
        done, order = {d for d, *_ in out}, []          # a coupler may drive another: drivers first
        while out:
            ready = [c for c in out if not any(d in done for d in c[1])]; assert ready, "cyclic couplers"
            order += ready; out = [c for c in out if c not in ready]; done -= {c[0] for c in ready}
        return order

    def couple(self, q):
        for d, drivers, f, scale in self.couplers:
            q[d] = scale * f.calcValue(osim.Vector.createFromMat(np.array([q[i] for i in drivers])))
        return q

    def pose(self, q):
        full = np.zeros(self.nfull); full[self.slot] = q
        self.state.setQ(osim.Vector.createFromMat(full)); self.model.realizePosition(self.state)
        return np.array([m.getLocationInGround(self.state).to_numpy() for m in self.marks])

    def loop_errors(self):
        e = self.state.getQErr()
        return np.array([e.get(i) for i in range(e.size())])

    def residuals(self, q, frame):
        """Square roots of the terms of F at full coordinates q, and the loop errors."""
        seen = np.isfinite(self.targets[frame]).all(1); w = self.w[seen]
        r = [((self.pose(q) - self.targets[frame])[seen] * np.sqrt(w / w.sum())[:, None]).ravel()]
        r.append(np.array([np.sqrt(k) * (q[i] - t) for i, (t, k) in self.tasks.items()]))
        return np.concatenate(r), self.loop_errors()

    def objective(self, q, frame):
        r, loops = self.residuals(q, frame); f = r @ r
        return f + self.constraint_weight * (loops @ loops) if np.isfinite(self.constraint_weight) else f

    def minimise(self, start, frame):
        lo, hi = self.low[self.free], self.high[self.free]
        q0 = self.default.copy(); exact = np.isinf(self.constraint_weight)
        base, shift = np.empty(0), 0.0

        def full(x):
            q = q0.copy(); q[self.free] = x
            return self.couple(q)

        def fun(x):
            r, c = self.residuals(full(x), frame)
            return np.concatenate([r, np.sqrt(penalty) * (c + shift)]) if len(c) > len(self.couplers) else r

        def forward(x):
            f0 = fun(x); j = np.empty((len(f0), len(x)))
            for k in range(len(x)):
                h = 1e-7 * (-1 if x[k] + 1e-7 > hi[k] else 1); y = x.copy(); y[k] += h; j[:, k] = (fun(y) - f0) / h
            return j

        def central(x):
            j = np.empty((len(fun(x)), len(x)))
            for k in range(len(x)):
                a, b = x.copy(), x.copy(); a[k] += 1e-5; b[k] -= 1e-5; j[:, k] = (fun(a) - fun(b)) / 2e-5
            return j

        tight = dict(ftol=1e-12, xtol=1e-12, gtol=1e-12)
        penalty = 100.0 if exact else self.constraint_weight
        room = 1e-9 * np.where(np.isfinite(hi - lo), hi - lo, 0.0)
        x = np.clip(start[self.free], lo + room, hi - room)
        for sweep in range(12):
            if sweep < 2: x = least_squares(fun, x, forward, (lo, hi), "trf", x_scale="jac", max_nfev=300, **tight).x
            x = least_squares(fun, np.clip(x, lo, hi), central, (lo, hi), "dogbox", max_nfev=100, **tight).x
            c = self.residuals(full(x), frame)[1]
            if not exact or len(c) == len(self.couplers) or np.abs(c).max() < 1e-11: break
            shift = shift + c
        return full(x), np.abs(c).max() if len(c) else 0.0

    def opensim(self, accuracy, folder):
        """Coordinates of all frames as the tool writes them, and the frames' indices in the trial."""
        tool = None
        if self.setup_path:
            try: tool = osim.InverseKinematicsTool(self.setup_path, False); assert tool.get_IKTaskSet().getSize()
            except (RuntimeError, AssertionError): tool = None
        if tool is None:
            tool = osim.InverseKinematicsTool()
            if self.setup_path: tool.set_IKTaskSet(osim.IKTaskSet(self.setup_path))
            else:
                tasks = osim.IKTaskSet()
                for n in self.used:
                    t = osim.IKMarkerTask(); t.setName(n); t.setApply(True); t.setWeight(1.0); tasks.cloneAndAppend(t)
                tool.set_IKTaskSet(tasks)
            tool.setStartTime(self.times[0]); tool.setEndTime(self.times[-1])
            tool.set_constraint_weight(self.constraint_weight)
        model = osim.Model(self.path); model.initSystem(); tool.setModel(model)
        tool.setMarkerDataFileName(self.trial_path); tool.set_accuracy(accuracy); tool.set_report_errors(False)
        out = os.path.join(folder, "ik.mot"); tool.setOutputMotionFileName(out); tool.setResultsDir(folder)
        with quiet(): begin = time.process_time(); tool.run(); seconds = time.process_time() - begin
        table = osim.TimeSeriesTable(out); matrix = table.getMatrix().to_numpy(); t = np.array(table.getIndependentColumn())
        labels = [c.split("/")[-2] if c.endswith("/value") else c for c in table.getColumnLabels()]
        degrees = table.getTableMetaDataAsString("inDegrees").strip().lower() == "yes"
        q = np.tile(self.default, (len(t), 1))             # degrees for Rotational only: Coupled ones stay in radians
        for i, n in enumerate(self.names):
            if n in labels: q[:, i] = matrix[:, labels.index(n)] * (np.pi / 180 if degrees and self.angle[i] else 1.0)
        return q, np.array([int(np.argmin(np.abs(self.times - x))) for x in t]), len(t) / seconds

    def starts(self, fine, coarse, count, rng):
        free = np.array(self.free); size = np.where(self.angle, 1.0, 0.1)[free]
        lo, hi = self.low[free], self.high[free]; boxed = np.isfinite(hi - lo)
        out = [fine, coarse, self.default.copy()]
        for k in range(count - 3):
            q = fine.copy(); x = q[free] + rng.normal(0, 0.3 if k % 3 == 0 else 1.0, len(free)) * size
            if k % 3 == 2: x = np.where(boxed, rng.uniform(np.where(boxed, lo, 0), np.where(boxed, hi, 1)), x)
            q[free] = np.clip(x, lo, hi); out.append(q)
        return out[:count]


digits = lambda x, n: float(f"{x:.{n}g}")


def run(data, case, frames, starts):
    model, trial, setup, constraint_weight = case
    with tempfile.TemporaryDirectory() as folder:
        c = Case(data, model, trial, setup, constraint_weight, folder)
        whole, answers = {}, {}
        for name in ("1e-5", "1e-8"):
            q, index, speed = c.opensim(float(name), folder); answers[name] = q
            f = np.array([c.objective(x, r) for x, r in zip(q, index)])
            whole[name] = {"mean_F": digits(f.mean(), 8), "frames_per_second": digits(speed, 3)}
        pick = np.unique(np.linspace(0, len(index) - 1, min(frames, len(index))).round().astype(int))
        entries = []
        for p in pick:
            frame = int(index[p]); rng = np.random.default_rng(20250 + frame)
            found = []
            for s in c.starts(answers["1e-8"][p], answers["1e-5"][p], starts, rng):
                q, loop = c.minimise(s, frame); found.append((c.objective(q, frame), loop, q))
            near = found[0]; found.sort(key=lambda x: x[0]); valid = [x for x in found if x[1] < 1e-8 or np.isfinite(c.constraint_weight)]
            best = valid[0]
            e = {"time": float(c.times[frame]), "markers_seen": int(np.isfinite(c.targets[frame]).all(1).sum()), "best_F": digits(best[0], 12)}
            e["near_F"] = digits(near[0], 12)
            for name in ("1e-5", "1e-8"): e["opensim_F_" + name] = digits(c.objective(answers[name][p], frame), 10)
            a = answers["1e-8"][p]
            e["opensim_bound_excess"] = digits(max(0.0, (c.low - a).max(), (a - c.high).max()), 2)
            if c.couplers: e["opensim_coupling_error"] = digits(np.abs(c.couple(a.copy()) - a).max(), 2)
            e["loop_error"] = digits(best[1], 2)
            away = np.abs(best[2] - near[2]); away[c.angle] *= 180 / np.pi; away[~c.angle] *= 100
            if best[0] < near[0] * (1 - 1e-6): e["best_differs_from_near"] = {c.names[i]: digits(best[2][i] - near[2][i], 4) for i in np.flatnonzero(away > 1)}
            e["starts_F"] = [digits(x[0], 6) for x in valid]
            e["best_coordinates"] = [digits(x, 9) for x in best[2]]
            entries.append(e)
            print(f"  t {e['time']:.3f}  best {e['best_F']:.9g}  OpenSim/best {e['opensim_F_1e-5'] / best[0]:.7f} {e['opensim_F_1e-8'] / best[0]:.9f}  "
                  f"starts within 1e-6: {sum(x[0] < best[0] * (1 + 1e-6) for x in valid)} of {starts}", flush=True)
        out = {"model": model, "trial": trial, "setup": setup, "constraint_weight": str(c.constraint_weight), "markers": len(c.used),
               "free_coordinates": len(c.free), "frames": len(index), "opensim": whole,
               "mean_of_frames_listed": {"best_F": digits(np.mean([e["best_F"] for e in entries]), 10),
                                         "near_F": digits(np.mean([e["near_F"] for e in entries]), 10),
                                         **{"opensim_F_" + n: digits(np.mean([e["opensim_F_" + n] for e in entries]), 10) for n in ("1e-5", "1e-8")}},
               "coordinates": c.names, "at": entries}
        if c.note: out["note"] = c.note
        return out


def write(path, pairs, starts):
    head = {"what": "least values of the marker objective over OpenSim's forward kinematics; made by minima.py",
            "opensim": osim.GetVersionAndDate(), "scipy": scipy.__version__, "numpy": np.__version__, "starts": starts,
            "units": "metres, radians; frames_per_second of the tool's run, CPU time, on the machine that made this"}
    with open(path, "w") as f:
        f.write(json.dumps(head)[:-1] + ', "pairs": [\n')
        for k, p in enumerate(pairs):
            at = p["at"]; p = {x: y for x, y in p.items() if x != "at"}
            f.write(json.dumps(p)[:-1] + ', "at": [\n  ' + ",\n  ".join(json.dumps(e) for e in at) + "]}" + (",\n" if k + 1 < len(pairs) else "\n"))
        f.write("]}\n")


if __name__ == "__main__":
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("data"); ap.add_argument("out"); ap.add_argument("--frames", type=int, default=6)
    ap.add_argument("--starts", type=int, default=20); ap.add_argument("--only", default="")
    a = ap.parse_args(); pairs = []
    for case in CASES:
        if a.only and a.only not in " ".join(map(str, case)): continue
        print(" + ".join(str(x) for x in case[:3]), flush=True); begin = time.time()
        try: pairs.append(run(os.path.abspath(a.data), case, a.frames, a.starts))
        except Exception as error: print("  skipped:", repr(error)[:600]); continue
        print(f"  all frames: {pairs[-1]['opensim']}  ({time.time() - begin:.0f} s)", flush=True); write(a.out, pairs, a.starts)
