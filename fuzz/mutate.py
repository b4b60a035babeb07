#!/usr/bin/env python3
"""Damages files at random and puts them through the command: no panic, no run over 20 s of CPU.

    fuzz/mutate.py CONDYLE FOLDER [RUNS] [SEED]

Every file of FOLDER of a known ending is damaged in one to four places and given to the command that reads
it. A run must end with exit code 0, 1 or 2. Findings are kept in ./findings, with the command beside them.
"""

import os
import random
import resource
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ENDINGS = {".osim", ".xml", ".toml", ".trc", ".mot", ".sto", ".csv", ".json", ".bvh", ".asf", ".skel"}
LARGEST = 400_000
SECONDS = 20
WORDS = [b"nan", b"inf", b"-1e308", b"1e-320", b"0", b"-1", b"99999999999999999999", b"", b"\t", b"\n", b"\0",
         b"<", b">", b"&", b"]]>", b"<!--", b'"', b"[", b"]", b"{", b"}", b"=", b"\xff\xfe", b"\xef\xbb\xbf", b"1,5", b"NA"]


def damage(data: bytes, other: bytes, rng: random.Random) -> bytes:
    data = bytearray(data)
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(data) + 1)
        length = min(len(data) - at, int(rng.expovariate(1 / 20)) + 1)
        match rng.randrange(9):
            case 0 if data:
                data[at % len(data)] ^= 1 << rng.randrange(8)
            case 1:
                del data[at : at + length]
            case 2:
                data[at:at] = data[at : at + length] * rng.randint(1, 30)
            case 3:
                data[at : at + length] = rng.choice(WORDS)
            case 4:
                del data[at:]
            case 5:
                start = rng.randrange(len(other) + 1)
                data[at : at + length] = other[start : start + 200]
            case 6:
                lines = bytes(data).split(b"\n")
                i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
                lines[i], lines[j] = lines[j], lines[i]
                data = bytearray(b"\n".join(lines))
            case 7:
                lines = bytes(data).split(b"\n")
                i = rng.randrange(len(lines))
                lines[i] = lines[i].replace(b"0", rng.choice(WORDS))
                data = bytearray(b"\n".join(lines))
            case _:
                lines = bytes(data).split(b"\n")
                i = rng.randrange(len(lines))
                cells = lines[i].split(b"\t")
                cells[rng.randrange(len(cells))] = rng.choice(WORDS)
                lines[i] = b"\t".join(cells)
                data = bytearray(b"\n".join(lines))
    return bytes(data)


def commands(path: Path, models: list[Path], rng: random.Random) -> list[str]:
    model = str(rng.choice(models)) if rng.random() < 0.5 else "human"
    file = str(path)
    match path.suffix:
        case ".osim" | ".toml":
            return rng.choice([["check", file], ["fk", file], ["info", file, "--json"], ["convert", file, "-", "--to", "toml"]])
        case ".trc":
            return rng.choice([["info", file], ["track", model, file, "-o", os.devnull, "--time", "0:0.05"],
                               ["track", model, file, "-o", os.devnull, "--time", "0:0.02", "--robust"],
                               ["scale", model, "--static", file, "-o", os.devnull]])
        case ".bvh" | ".asf" | ".skel":
            return rng.choice([["info", file], ["check", file], ["fk", file], ["convert", file, "-", "--to", "bvh"]])
        case ".xml":
            return ["info", file]
        case ".json":
            return rng.choice([["fk", model, "--pose", file], ["check", model, file]])
        case _:
            return rng.choice([["info", file], ["check", model, file], ["fk", model, "--motion", file], ["diff", file, file]])


def run(condyle: str, files: list[Path], models: list[Path], folder: Path, seed: int) -> str | None:
    rng = random.Random(seed)
    source = rng.choice(files)
    data = damage(source.read_bytes(), rng.choice(files).read_bytes(), rng)
    path = folder / f"{seed}{source.suffix}"
    path.write_bytes(data)
    arguments = commands(path, models, rng)

    def limits():
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))

    done = subprocess.run([condyle, *arguments], capture_output=True, preexec_fn=limits, timeout=600)
    keep = done.returncode not in (0, 1, 2) or b"panicked" in done.stderr
    finding = None
    if keep:
        kept = Path("findings")
        kept.mkdir(exist_ok=True)
        (kept / path.name).write_bytes(data)
        finding = f"{seed}: exit {done.returncode}: {' '.join(arguments)} (from {source})\n{done.stderr[-600:].decode(errors='replace')}"
        (kept / f"{seed}.txt").write_text(finding)
    path.unlink()
    return finding


def main() -> int:
    condyle, folder = sys.argv[1], Path(sys.argv[2])
    runs = int(sys.argv[3]) if len(sys.argv) > 3 else 1000
    first = int(sys.argv[4]) if len(sys.argv) > 4 else 0
    files = sorted(p for p in folder.rglob("*") if p.suffix in ENDINGS and 0 < p.stat().st_size <= LARGEST)
    models = [p for p in files if p.suffix in (".osim", ".toml")]
    found = 0
    with tempfile.TemporaryDirectory() as scratch, ThreadPoolExecutor(os.cpu_count()) as pool:
        work = (pool.submit(run, condyle, files, models, Path(scratch), first + i) for i in range(runs))
        for count, done in enumerate(list(work)):
            finding = done.result()
            if finding:
                found += 1
                print(finding, flush=True)
            if count % 1000 == 999:
                print(f"{count + 1} runs, {found} findings", flush=True)
    print(f"{runs} runs over {len(files)} files, {found} findings")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
