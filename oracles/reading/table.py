"""Times readers of C3D, TRC and MOT side by side, one after the other on one core, and makes the table of the manual.

    C3D_PYTHON=... OPENSIM_PYTHON=... python table.py READING DATA FOLDER > table.md

READING is the bench `reading` (`cargo bench -p condyle-benches --bench reading --no-run` prints where it is), DATA the folder
of test data, FOLDER takes two large files that are made here, a TRC and a MOT of some 60 MB. The variables name Pythons
with `ezc3d`, `sqzc3d` and `pandas`, and with `opensim`; what is not named is skipped, and said to be. The times go to
`answers.json` beside this script. Needs nothing but Python itself.

All run on the core that is named by CORE (1 without it), each for some seconds after a first call that is not counted; the
fastest call and the middle one are kept. Peers read from the path, as that is what they offer; so does condyle where the
table says `from its path`.
"""
import json
import os
import random
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
C3D = "hip/right_hip_functional.c3d"
TRC = "knee/opencap4/squats1.trc"
MOT = "knee/opencap4/squats1_ik.mot"
SECONDS = 4.0
# By ending: program, the variable of its Python, what the table calls it.
PEERS = {
    "c3d": [("sqzc3d", "C3D_PYTHON", "sqzc3d {}, from Python"), ("ezc3d", "C3D_PYTHON", "ezc3d {}, from Python"),
            ("opensim-c3d", "OPENSIM_PYTHON", "OpenSim {}, C3DFileAdapter"),
            ("bytes", None, "reading the bytes of the file, Python {}")],
    "trc": [("pandas", "C3D_PYTHON", "pandas {}, the numbers alone"),
            ("opensim-trc", "OPENSIM_PYTHON", "OpenSim {}, TimeSeriesTableVec3"),
            ("bytes", None, "reading the bytes of the file, Python {}")],
    "mot": [("pandas", "C3D_PYTHON", "pandas {}, the numbers alone"),
            ("opensim-storage", "OPENSIM_PYTHON", "OpenSim {}, Storage"),
            ("opensim-table", "OPENSIM_PYTHON", "OpenSim {}, TimeSeriesTable"),
            ("bytes", None, "reading the bytes of the file, Python {}")],
}
# glibc gives memory back above these: with them it keeps all.
KEPT = "glibc.malloc.trim_threshold=1000000000:glibc.malloc.mmap_threshold=1000000000"


def large_trc(path, markers=60, frames=33000):
    """Markers that swing, in millimetres with five decimals, 100 frames a second."""
    dice = random.Random(1)
    middle = [dice.uniform(-1500, 1500) for _ in range(3 * markers)]
    with open(path, "w") as file:
        file.write(f"PathFileType\t4\t(X/Y/Z)\t{os.path.basename(path)}\n")
        file.write("DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n")
        file.write(f"100\t100\t{frames}\t{markers}\tmm\t100\t1\t{frames}\n")
        file.write("Frame#\tTime\t" + "\t\t\t".join(f"M{i + 1}" for i in range(markers)) + "\t\t\n")
        file.write("\t\t" + "\t".join(f"{axis}{i + 1}" for i in range(markers) for axis in "XYZ") + "\n\n")
        for frame in range(frames):
            row = "\t".join("%.5f" % (m + dice.uniform(-50, 50)) for m in middle)
            file.write(f"{frame + 1}\t{frame / 100:.5f}\t{row}\n")


def large_mot(path, columns=40, rows=100000):
    """Angles in degrees with eight decimals, as OpenSim writes them."""
    dice = random.Random(2)
    with open(path, "w") as file:
        file.write(f"Coordinates\nversion=1\nnRows={rows}\nnColumns={columns + 1}\ninDegrees=yes\n\nendheader\n")
        file.write("time\t" + "\t".join(f"angle_{i + 1}" for i in range(columns)) + "\n")
        for row in range(rows):
            cells = "\t".join("%16.8f" % dice.uniform(-120, 120) for _ in range(columns))
            file.write("%16.8f\t%s\n" % (row / 100, cells))


def ours(reading, files, environment=None):
    run = subprocess.run([reading, "--bench", "--json"] + files, check=True, stdout=subprocess.PIPE,
                         env=dict(os.environ, **(environment or {})))
    return json.loads(run.stdout)


def theirs(path):
    rows = []
    for program, variable, _ in PEERS[path.rsplit(".", 1)[1]]:
        python = os.environ.get(variable) if variable else sys.executable
        if not python:
            print(f"skipped: {program}, as {variable} is not set", file=sys.stderr)
            continue
        run = subprocess.run([python, os.path.join(HERE, "peers.py"), program, path, str(SECONDS)],
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if run.returncode:
            said = (run.stderr.decode().strip().splitlines() or ["no word"])[-1]
            print(f"skipped: {program}: {said}", file=sys.stderr)
            rows.append({"program": program, "skipped": said})
            continue
        rows.append(json.loads(run.stdout.decode().strip().splitlines()[-1]))
        print(program, rows[-1]["best_ms"], file=sys.stderr)
    return rows


def number(x):
    return f"{x:.2f}" if x < 10 else f"{x:.1f}" if x < 100 else f"{x:.0f}"


def row(name, times, size):
    rate = f"{size / times['best_ms'] / 1e3:.0f}"
    return f"| {name} | {number(times['best_ms'])} | {number(times['median_ms'])} | {rate} |"


def main():
    reading, data, folder = sys.argv[1:4]
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {int(os.environ.get("CORE", "1"))})
    big = [os.path.join(folder, name) for name in ("large.trc", "large.mot")]
    for path, make in zip(big, (large_trc, large_mot)):
        if not os.path.exists(path):
            make(path)
    files = [os.path.join(data, name) for name in (C3D, TRC, MOT)] + big
    mine = ours(reading, files)
    kept = [r for r in ours(reading, files[:1], {"GLIBC_TUNABLES": KEPT}) if "new table" in r["what"]]
    answers = []
    lines = []
    for path in files:
        name, size = os.path.basename(path), os.path.getsize(path)
        own = [r for r in mine if r["file"] == name]
        for r in kept:
            if r["file"] == name:
                own.append(dict(r, what=r["what"] + ", the allocator keeping memory"))
        peers = theirs(path)
        answers.append({"file": name, "bytes": size, "condyle": own, "peers": peers})
        lines += ["", f"`{name}`, {size / 1e6:.1f} MB:", "", "| | best, ms | median, ms | MB/s |", "| --- | --- | --- | --- |"]
        lines += [row("condyle, " + r["what"] if "alone" not in r["what"] and "filled" not in r["what"] else r["what"], r, size)
                  for r in own]
        titles = {program: title for program, _, title in PEERS[path.rsplit(".", 1)[1]]}
        lines += [row(titles[r["program"]].format(r["version"]), r, size) for r in peers if "skipped" not in r]
        lines += [f"| {titles[r['program']].format('')} | - | - | {r['skipped']} |" for r in peers if "skipped" in r]
    with open(os.path.join(HERE, "answers.json"), "w") as file:
        rows = [json.dumps(answer, separators=(", ", ": ")).replace("}, {", "},\n  {") for answer in answers]
        file.write("[\n" + ",\n".join(rows) + "\n]\n")
    print("\n".join(lines).strip())


if __name__ == "__main__":
    main()
