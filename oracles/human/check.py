"""Compares the shipped human with sources that had no part in building it, as a Markdown page.

python oracles/human/check.py CONDYLE_BINARY > docs/human-check.md
"""

import os
import sys
import tempfile

import arms
import legs
import shoulder
import trunk
from body import HERE, MODELS, Body

HUMAN = os.path.join(MODELS, "human.toml")

TEXT = """# The human against independent sources

`human` (a man of 1.75 m) and the same model with `stature = 1.62`, `woman = 1`, measured through the command
`condyle` and compared with published numbers. This page is printed by `python oracles/human/check.py CONDYLE >
docs/human-check.md`.

The numbers wanted in the first table had no part in building the model: no number in its texts was taken from them or
chosen toward them, even if a comment there mentions one beside a number from elsewhere. Some of these sources gave
the model *other* numbers: ANSUR II (men and women have columns of their own), msk-STAPLE the hip, Rajagopal et al.
and Saul et al. some axes and places of an arm, the Dutch arm model the arch of the palm and the thumb, Seth et al.
the joints of the clavicle. The second table has numbers that were used, or toward which one was chosen; it only shows
that the model does what its texts say.

*Recalled*: the number is known to stand in the source but was not looked up. The allowance is the standard deviation
of the source where it gives one, else a spread between sources or some 10 %. Fails are written as they are; the notes
at the end say what is known about them.

In the first table {passes} of {count} rows pass and {fails} fail.

## Independent check

{independent}

## Consistency

{used_passes} of {used_count} rows pass.

{used}

## Notes on the fails

{notes}"""


def table(rows):
    lines = ["| region | quantity | ours | wanted | source | |", "| --- | --- | ---: | ---: | --- | --- |"]
    for region, quantity, unit, ours, target, source, passes, _ in rows:
        space = "" if unit in ("", "°") else " "
        mark = "pass" if passes else "**fail**"
        lines.append(f"| {region} | {quantity} | {ours}{space}{unit} | {target} | {source} | {mark} |")
    return "\n".join(lines)


def main(condyle):
    with tempfile.TemporaryDirectory() as folder:
        text = os.path.join(folder, "woman.toml")
        with open(text, "w") as file:
            file.write(f'condyle = 1\nkind = "model"\nname = "woman"\ninclude = ["{HUMAN}"]\n')
            file.write("[constants]\nstature = 1.62\nwoman = 1\n")
        man, woman = Body(condyle, HUMAN, folder), Body(condyle, text, folder)
        rows = [row for region in (trunk, shoulder, arms, legs) for row in region.rows(man, woman)]
    independent = [row for row in rows if not row[-1]]
    used = [row for row in rows if row[-1]]
    passes = sum(row[-2] for row in independent)
    with open(os.path.join(HERE, "notes.md"), encoding="utf-8") as file:
        notes = file.read()
    print(
        TEXT.format(
            passes=passes,
            count=len(independent),
            fails=len(independent) - passes,
            independent=table(independent),
            used_passes=sum(row[-2] for row in used),
            used_count=len(used),
            used=table(used),
            notes=notes.strip(),
        )
    )


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    sys.stdout.reconfigure(encoding="utf-8")
    main(sys.argv[1])
