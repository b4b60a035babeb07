"""Scales models by OpenSim's ScaleTool and by condyle, and compares what comes out, part by part.

    python oracles/scale/sweep.py CONDYLE MODEL.osim... > sweep.json

Every body gets unequal factors by hand (manualScale), the mass becomes 60 kg. condyle's file is opened
and written again by OpenSim, so that both are files of one version; then their XML trees are compared
number by number, and the places of all bodies at 20 postures. Needs OpenSim 4.6 for Python.
"""

import json
import os
import random
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET

import opensim

opensim.Logger.setLevelString("Off")
MASS, POSES, TIGHT = 60.0, 20, 1e-6


def factors(index):
    three = (1.02 + 0.003 * ((index * 7) % 11), 0.9 + 0.007 * ((index * 5) % 7), 1.1 + 0.008 * ((index * 3) % 5))
    return tuple(round(value, 4) for value in three)


def setup_text(model, names):
    scales = "".join(
        f"<Scale><scales>{x} {y} {z}</scales><segment>{name}</segment><apply>true</apply></Scale>\n"
        for name, (x, y, z) in ((name, factors(i)) for i, name in enumerate(names))
    )
    return f"""<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="40000"><ScaleTool name="swept"><mass>{MASS}</mass>
<GenericModelMaker><model_file>{model}</model_file></GenericModelMaker>
<ModelScaler><scaling_order>manualScale</scaling_order><ScaleSet><objects>
{scales}</objects></ScaleSet></ModelScaler>
<MarkerPlacer><apply>false</apply></MarkerPlacer></ScaleTool></OpenSimDocument>
"""


def by_opensim(path, out):
    model = opensim.Model(path)
    model.initSystem()
    names = [model.getBodySet().get(i).getName() for i in range(model.getBodySet().getSize())]
    scaler = opensim.ModelScaler()
    scaler.setApply(True)
    order = opensim.ArrayStr()
    order.append("manualScale")
    scaler.setScalingOrder(order)
    for index, name in enumerate(names):
        scale = opensim.Scale()
        scale.setSegmentName(name)
        scale.setScaleFactors(opensim.Vec3(*factors(index)))
        scale.setApply(True)
        scaler.getScaleSet().cloneAndAppend(scale)
    scaler.setOutputModelFileName(out)
    if os.path.exists(out):
        os.remove(out)
    scaler.processModel(model, "/", MASS)
    return names


def tree(path):
    text = open(path, errors="replace").read()
    return plain(ET.fromstring(re.sub(r"(</?\w+)::", r"\1__", text)))


def plain(node):
    """Without multipliers of 1, and without numbers that are all 0, which are defaults."""
    for parent in list(node.iter()):
        for index, child in enumerate(list(parent)):
            if child.tag == "MultiplierFunction" and float(child.findtext("scale") or 1) == 1.0:
                inner = child.find("function")
                if inner is not None and len(inner) == 1:
                    parent[index] = inner[0]
        for child in list(parent):
            values = numbers(child.text or "") if len(child) == 0 else None
            if values and not any(values):
                parent.remove(child)
    return node


def numbers(text):
    try:
        return [float(word) for word in text.split()]
    except ValueError:
        return None


def differences(a, b, path, found):
    children = list(a), list(b)
    if not children[0] and not children[1]:
        texts = (a.text or "").strip(), (b.text or "").strip()
        if texts[0] == texts[1]:
            return
        lists = numbers(texts[0]), numbers(texts[1])
        if lists[0] is None or lists[1] is None or len(lists[0]) != len(lists[1]):
            found.append((path, None, texts))
            return
        # To the size of the whole list: a zero among others is as good as its neighbours.
        size = max(abs(x) for x in lists[0] + lists[1])
        worst = max(abs(x - y) for x, y in zip(*lists)) / size if size else 0.0
        if worst > TIGHT:
            found.append((path, worst, texts))
        return
    keys = [[c.tag for c in side] for side in children]
    if keys[0] != keys[1]:
        found.append((path, None, (str(keys[0])[:300], str(keys[1])[:300])))
        return
    for x, y in zip(*children):
        name = f"[{x.get('name')}]" if x.get("name") else ""
        differences(x, y, f"{path}/{x.tag}{name}", found)


def places(a, b):
    """The largest distance between origins of bodies, and between rotations, at some postures."""
    models = opensim.Model(a), opensim.Model(b)
    states = [model.initSystem() for model in models]
    sets = [model.getCoordinateSet() for model in models]
    rng = random.Random(1)
    far = turned = 0.0
    for _ in range(POSES):
        for i in range(sets[0].getSize()):
            low, high = sets[0].get(i).getRangeMin(), sets[0].get(i).getRangeMax()
            low, high = max(low, -3.0), min(high, 3.0)
            value = rng.uniform(low, high) if low < high else sets[0].get(i).getDefaultValue()
            for coordinates, state in zip(sets, states):
                if not coordinates.get(i).getLocked(state):
                    coordinates.get(i).setValue(state, value, False)
        for model, state in zip(models, states):
            model.realizePosition(state)
        for i in range(models[0].getBodySet().getSize()):
            one, two = (m.getBodySet().get(i).getTransformInGround(s) for m, s in zip(models, states))
            far = max(far, max(abs(one.p()[k] - two.p()[k]) for k in range(3)))
            turned = max(turned, max(abs(one.R().get(r, c) - two.R().get(r, c)) for r in range(3) for c in range(3)))
    return far, turned


def main():
    condyle, models = os.path.abspath(sys.argv[1]), sys.argv[2:]
    answers = {}
    for path in sorted(models, key=os.path.basename):
        name = os.path.basename(path)[: -len(".osim")]
        entry = answers.setdefault(name, {})
        with tempfile.TemporaryDirectory() as folder:
            theirs, ours, again, setup = (os.path.join(folder, f) for f in ("a.osim", "b.osim", "c.osim", "s.xml"))
            path = os.path.abspath(path)
            try:
                names = by_opensim(path, theirs)
            except Exception as error:
                entry["opensim"] = "does not load: " + str(error).split(": ", 1)[-1].split("\n")[0][:120]
                names = re.findall(r'<Body name="([^"]*)"', open(path, errors="replace").read())
            open(setup, "w").write(setup_text(path, names))
            run = subprocess.run([condyle, "scale", path, "--setup", setup, "--as-opensim", "-o", ours, "--json"],
                                 capture_output=True, text=True)
            if run.returncode == 2:
                entry["condyle"] = run.stderr.strip().split("\n")[-1].replace(path, name)[:200]
                continue
            report = json.loads(run.stdout)
            entry["wrapping"] = len(report["wrapping"])
            try:
                model = opensim.Model(ours)
                model.initSystem()
                model.printToXML(again)
                entry["loads"] = True
            except Exception as error:
                entry["loads"] = str(error).split("\n")[0][:120]
                continue
            if not os.path.exists(theirs):
                entry.setdefault("opensim", "loads, but does not scale it")
                continue
            found = []
            differences(tree(theirs), tree(again), "", found)
            named = [f for f in found if f[0].split("/")[-1].split("[")[0] not in ("Model", "credits", "publications")]
            kinds = {}
            for place, worst, texts in named:
                steps = [step.split("[")[0] for step in place.split("/")]
                kind = kinds.setdefault("/".join(steps[-2:]), [0, 0.0, place, texts])
                kind[0] += 1
                kind[1] = max(kind[1], worst) if worst is not None and kind[1] is not None else None
                if os.environ.get("VERBOSE"):
                    print(name, place, worst, texts, file=sys.stderr)
            entry["different"] = {k: {"count": n, "worst": w} for k, (n, w, _, _) in sorted(kinds.items())}
            # Of old versions OpenSim keeps six digits of the joints, and lengths differ by as little.
            muscles = [f for f in named if (f[1] is None or f[1] > 1e-5) and f[0].split("/")[-1] in ("optimal_fiber_length", "tendon_slack_length", "slack_length", "resting_length")]
            wraps = set(report["wrapping"])
            unnamed = {re.findall(r"\[([^\]]*)\]", f[0])[-1] for f in muscles} - wraps
            entry["lengths off"] = len({re.findall(r"\[([^\]]*)\]", f[0])[-1] for f in muscles})
            entry["lengths off, not named"] = sorted(unnamed)
            entry["places_m"], entry["turned"] = places(theirs, again)
    json.dump(answers, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
