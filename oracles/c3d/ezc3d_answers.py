"""What ezc3d reads from the C3D files beside the repository: counts, rates, checksums of all values, samples.

    python oracles/c3d/ezc3d_answers.py SHARED/data > oracles/c3d/ezc3d.json

`points` is the CRC-32 of all coordinates of points that are seen, as 32-bit floats in Intel's order, frame by frame and point
by point; `missing` that of a byte for each point and frame, 1 where ezc3d gives no number. `analog` is the CRC-32 of all
scaled samples as 64-bit floats, sample by sample. A few values are given as numbers beside them.

Needs `pip install ezc3d numpy`. Known differences are listed in docs/c3d.md and in the test that reads the answers.
"""

import json
import subprocess
import sys
import zlib
from pathlib import Path

import ezc3d
import numpy as np


def number(value):
    return float(value) if np.isfinite(value) else None


def answer(path):
    try:
        trial = ezc3d.c3d(str(path))
        ignored = False
    except Exception as strict:
        try:
            trial = ezc3d.c3d(str(path), ignore_bad_formatting=True)
            ignored = True
        except Exception as error:
            return {"error": str(error).split("\n")[0][:120], "strict": str(strict).split("\n")[0][:120]}
    points = np.asarray(trial["data"]["points"])[:3]
    frames = np.ascontiguousarray(points.transpose(2, 1, 0))
    missing = np.isnan(frames).any(axis=2)
    seen = frames[~missing].astype("<f4") + np.float32(0)  # no negative zeros
    analog = np.asarray(trial["data"]["analogs"])[0]
    samples = np.ascontiguousarray(analog.T.astype("<f8"))
    some = []
    for frame in sorted({0, len(frames) // 3, len(frames) - 1}) if len(frames) else []:
        for point in sorted({0, frames.shape[1] // 2, frames.shape[1] - 1}) if frames.shape[1] else []:
            value = None if missing[frame, point] else [number(np.float32(x)) for x in frames[frame, point]]
            some.append([frame, point, value])
    channel = []
    for sample in sorted({0, len(samples) // 2, len(samples) - 1}) if samples.size else []:
        for index in sorted({0, samples.shape[1] - 1}):
            channel.append([sample, index, number(samples[sample, index])])
    return {
        "bad_formatting_ignored": ignored,
        "frames": int(frames.shape[0]),
        "points": int(frames.shape[1]),
        "first_frame": int(trial["header"]["points"]["first_frame"]) + 1,
        "rate": float(trial["parameters"]["POINT"]["RATE"]["value"][0]) if "RATE" in trial["parameters"]["POINT"] else None,
        "seen": int(seen.shape[0]),
        "points_crc": zlib.crc32(seen.tobytes()),
        "missing_crc": zlib.crc32(missing.astype(np.uint8).tobytes()),
        "channels": int(samples.shape[1]) if samples.ndim == 2 else 0,
        "samples": int(samples.shape[0]) if samples.size else 0,
        "analog_crc": zlib.crc32(samples.tobytes()),
        "some_points": some,
        "some_samples": channel,
    }


def guarded(path):
    """The answer of a process of its own: some files end ezc3d with a fault of memory."""
    done = subprocess.run([sys.executable, __file__, "--one", str(path)], capture_output=True, text=True)
    if done.returncode:
        return {"error": f"the process ends with signal {-done.returncode}"}
    return json.loads(done.stdout)


def main():
    if sys.argv[1] == "--one":
        print(json.dumps(answer(sys.argv[2])))
        return
    root = Path(sys.argv[1])
    files = sorted(p for p in root.rglob("*") if p.suffix.lower() == ".c3d")
    answers = {str(p.relative_to(root)): guarded(p) for p in files}
    text = ",\n".join(f"{json.dumps(k)}: {json.dumps(v)}" for k, v in answers.items())
    print(f'{{"program": "ezc3d {ezc3d.__version__}",\n"files": {{\n{text}\n}}}}')


main()
