"""The knees of `condyle learn study` by OpenSim: its own inverse kinematics on a gait that no law has seen.

    OPENSIM_PYTHON=... python study/study.py CONDYLE FOLDER > study/answers.json

`condyle learn study --quick --subjects 1 --trials` writes the recordings of the first person and every knee as `.osim`; the first gait that no law has seen
is filtered at 6 Hz as the study does (`condyle upkeep --lowpass 6`). OpenSim's InverseKinematicsTool (accuracy 1e-8, every marker of weight 1)
tracks it with each knee; kept is the mean over frames of its `marker_error_RMS` in millimetres, which is what Table 3 has as mm a frame, and the largest
`marker_error_max`.

This file is run twice: by any Python, and by that of OPENSIM_PYTHON, which has `opensim`.
"""

import json
import os
import subprocess
import sys

MARKERS = ["RGT", "RLFE", "RMFE", "RTT", "RFH", "RMEDMAL", "RLATMAL"]


def by_opensim(folder):
    import opensim as osim

    osim.Logger.setLevelString("error")
    answers = {}
    for skin in ["rigid", "moving"]:
        trial = os.path.join(folder, f"{skin}.trc")
        times = osim.TimeSeriesTableVec3(trial).getIndependentColumn()
        start = f"s1_{skin}_gait_"
        for name in sorted(os.listdir(os.path.join(folder, "models"))):
            if not name.startswith(start):
                continue
            tool = osim.InverseKinematicsTool()
            model = osim.Model(os.path.join(folder, "models", name))
            model.initSystem()
            tool.setModel(model)
            tool.setMarkerDataFileName(trial)
            tool.setStartTime(times[0])
            tool.setEndTime(times[-1])
            tool.setOutputMotionFileName(os.path.join(folder, "ik.mot"))
            tool.setResultsDir(folder)
            tool.set_report_errors(True)
            tool.set_accuracy(1e-8)
            tool.setName("knee")
            tasks = tool.upd_IKTaskSet()
            for marker in MARKERS:
                task = osim.IKMarkerTask()
                task.setName(marker)
                task.setApply(True)
                task.setWeight(1.0)
                tasks.cloneAndAppend(task)
            tool.run()
            table = osim.TimeSeriesTable(os.path.join(folder, "knee_ik_marker_errors.sto"))
            rms = table.getDependentColumn("marker_error_RMS").to_numpy()
            most = table.getDependentColumn("marker_error_max").to_numpy()
            knee = name[len(start) : -len(".osim")]
            answers.setdefault(skin, {})[knee] = {
                "rms_mm": 1e3 * float(rms.mean()),
                "max_mm": 1e3 * float(most.max()),
                "frames": len(rms),
            }
            print(skin, knee, answers[skin][knee], file=sys.stderr)
    with open(os.path.join(folder, "answers.json"), "w") as file:
        json.dump(answers, file)


def main():
    condyle, folder = sys.argv[1:3]
    study = [condyle, "learn", "study", "--quick", "--subjects", "1", "--trials", "-o", folder]
    subprocess.run(study, check=True, stdout=sys.stderr)
    for skin in ["rigid", "moving"]:
        trial = os.path.join(folder, "trials", skin, "s1_unseen_gait_1.trc")
        clean = os.path.join(folder, f"{skin}.trc")
        subprocess.run([condyle, "upkeep", trial, clean, "--lowpass", "6"], check=True)
    me = os.path.abspath(__file__)
    subprocess.run([os.environ["OPENSIM_PYTHON"], me, "--opensim", folder], check=True, stdout=sys.stderr)
    with open(os.path.join(folder, "answers.json")) as file:
        print(json.dumps(json.load(file), indent=1))


if __name__ == "__main__":
    if sys.argv[1] == "--opensim":
        by_opensim(sys.argv[2])
    else:
        main()
