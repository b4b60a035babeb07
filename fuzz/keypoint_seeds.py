#!/usr/bin/env python3
"""Writes the seeds of the target `keypoints`: one person in two frames, in every layout.

    fuzz/keypoint_seeds.py [FOLDER]
"""

import json
import sys
from pathlib import Path

# A standing figure in metres, y up, in the order of COCO-17.
COCO = {
    "nose": (0.1, 1.6), "left_eye": (0.09, 1.63), "right_eye": (0.09, 1.63), "left_ear": (0.02, 1.61),
    "right_ear": (0.02, 1.61), "left_shoulder": (0, 1.42), "right_shoulder": (0, 1.42), "left_elbow": (0, 1.12),
    "right_elbow": (0, 1.12), "left_wrist": (0.02, 0.87), "right_wrist": (0.02, 0.87), "left_hip": (0, 0.92),
    "right_hip": (0, 0.92), "left_knee": (0.01, 0.5), "right_knee": (0.01, 0.5), "left_ankle": (-0.04, 0.08),
    "right_ankle": (-0.04, 0.08),
}


def person(shift=0.0):
    def one(name, x, y):
        side = 0.15 if name.startswith("right") else -0.15 if name.startswith("left") else 0.0
        return [round(x + shift, 3), y, side, 0.5 if "eye" in name else 0.9]
    return {name: one(name, *at) for name, at in COCO.items()}


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "seeds" / "keypoints"
    folder.mkdir(parents=True, exist_ok=True)
    frames = [person(), person(0.02)]

    def write(name, value):
        (folder / name).write_text(value if isinstance(value, str) else json.dumps(value, separators=(",", ":")))

    flat = [[x for p in frame.values() for x in p] for frame in frames]
    write("openpose.json", [{"people": [{"person_id": [-1], "pose_keypoints_3d": list}]} for list in flat])
    write("body25.json", {"people": [{"pose_keypoints_3d": [x for k in range(25) for x in (0.1, 1 - k / 25, 0.2, 0.8)]}]})
    write("halpe26.json", [{"keypoints": [x for k in range(26) for x in (0.1, 1 - k / 26, 0.2, 0.8)], "score": 2.9, "idx": 1}])
    write("mmpose.json", {"meta_info": {"dataset_name": "coco", "keypoint_id2name": {str(i): n for i, n in enumerate(COCO)}},
                          "instance_info": [{"frame_id": i, "instances": [{
                              "keypoints": [p[:3] for p in frame.values()],
                              "keypoint_scores": [p[3] for p in frame.values()]}]} for i, frame in enumerate(frames)]})
    write("named.json", {"fps": 60, "frames": [{"keypoints": frame} for frame in frames]})
    listed = [[{"name": n, "x": p[0], "y": p[1], "z": p[2], "score": p[3]} for n, p in frame.items()] for frame in frames]
    write("listed.json", {"frames": [{"time": i / 30, "keypoints": list} for i, list in enumerate(listed)]})
    write("lines.jsonl", "".join(json.dumps({"keypoints": list(frame.values())}) + "\n" for frame in frames))
    head = ",".join(f"{name}_{axis}" for name in COCO for axis in ("x", "y", "z", "score"))
    rows = [",".join(map(str, [i / 30, *list])) for i, list in enumerate(flat)]
    write("wide.csv", "\n".join(["time," + head, *rows]) + "\n")
    long = [f"{i},{who},{n},{p[0]},{p[1]},{p[2]},{p[3]}" for i, frame in enumerate(frames) for who in (1, 2)
            for n, p in list(frame.items())[who:]]
    write("long.csv", "\n".join(["frame,person,keypoint,x,y,z,confidence", *long]) + "\n")
    numbered = [f"{i};{k};{p[0]};{p[1]};{p[2]}" for i, frame in enumerate(frames) for k, p in enumerate(frame.values())]
    write("numbered.csv", "\n".join(["frame;landmark;x;y;z", *numbered]) + "\n")


main()
