"""The table of docs/scaling.md from sweep.json.

    python oracles/scale/table.py oracles/scale/sweep.json
"""

import json
import sys


def main():
    answers = json.load(open(sys.argv[1]))
    print("| model | places (m) | lengths of muscles off by more than 1e-5 | largest | of these not named | other numbers off |")
    print("| --- | --: | --: | --: | --: | --- |")
    rest = []
    for name, entry in answers.items():
        if "places_m" not in entry:
            why = entry.get("condyle") or entry.get("opensim")
            rest.append((name, entry.get("opensim", "").replace("|", "/"), entry.get("condyle", "scaled").replace("|", "/")))
            continue
        lengths = [v["worst"] for k, v in entry["different"].items() if k.split("/")[-1].endswith("_length")]
        others = [f"{k} ({v['count']}, {v['worst']:.0e})" for k, v in entry["different"].items() if not k.endswith("_length") and v["worst"] is not None]
        count, unnamed = entry["lengths off"], len(entry["lengths off, not named"])
        worst = f"{100 * max(lengths):.2f} %" if count else ""
        print(f"| {name} | {entry['places_m']:.1e} | {count or ''} | {worst} | {unnamed or ''} | {', '.join(others)} |")
    print("\n| model | OpenSim | condyle |")
    print("| --- | --- | --- |")
    for name, theirs, ours in rest:
        print(f"| {name} | {theirs} | {ours[:90]} |")


if __name__ == "__main__":
    main()
