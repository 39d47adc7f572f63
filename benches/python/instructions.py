"""Counts the instructions of a frame by the part of the library they belong to (valgrind's callgrind).

    python benches/python/instructions.py [SCENE ...]

Two runs of different length are subtracted, so that reading the scene and building it do not count. What a scene does
not use must not run: the share of parts that it has no need of is printed, and the exit code is 1 above 1 %.
"""

import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "target/release/unipbd"
SOURCE = "crates/unipbd-core/src/"
FRAMES = (12, 24)
LIMIT = 0.01

# Parts of the library, by the files they stand in.
PARTS = {
    "bodies and contacts": r"^(bodies|rigid|shapes|constraints/(contact|shape_matching))",
    "gas and smoke": r"^effects/(smoke|drag|wind|confinement|baroclinic|conduction|heating)|^sources",
    "other groups and effects": r"^legacy|^constraints/(adhesion|distance|rope)|^effects/(cohesion|quadratic|shear)",
    "sleep": r"^(sleep|step/sleep)",
    "diagnostics": r"^(observe|step/diagnose|expect)",
    "row index, edits, states": r"^(rows|edit|state|bytes)",
}

# What each scene has no need of.
UNUSED = {
    "scenes/dam_break.toml": list(PARTS),
    "scenes/open_gas.toml": ["bodies and contacts", "other groups and effects", "sleep", "diagnostics"],
    "scenes/rigid_pile.toml": ["gas and smoke", "other groups and effects", "sleep"],
}


def count(scene: str, frames: int) -> "Counter[str]":
    """Instructions by source file."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        scene_options = ["--fps", "60", "--duration", str(frames / 60)]
        run = [str(PROGRAM), str(ROOT / scene), "--no-record", "--threads", "1", "--json", *scene_options]
        grind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}"]
        subprocess.run(grind + run, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        annotate = ["callgrind_annotate", "--threshold=100", "--auto=no", str(out)]
        text = subprocess.run(annotate, check=True, capture_output=True, text=True).stdout
    counts: Counter[str] = Counter()
    for line in text.splitlines():
        found = re.match(r"^\s*([\d,]+) \([ \d.]+%\)\s+(\S+?):", line)
        if found:
            counts[found[2].rpartition(SOURCE)[2]] += int(found[1].replace(",", ""))
    return counts


def main() -> int:
    """Prints a table for each scene."""
    if not shutil.which("valgrind"):
        print("valgrind is not installed", file=sys.stderr)
        return 2
    subprocess.run(["cargo", "build", "--quiet", "--release", "-p", "unipbd-cli"], cwd=ROOT, check=True)
    worst = 0.0
    for scene in sys.argv[1:] or UNUSED:
        short, long = (count(scene, frames) for frames in FRAMES)
        long.subtract(short)
        total = sum(long.values())
        print(f"{scene}: {total / (FRAMES[1] - FRAMES[0]):,.0f} instructions a frame")
        for part, pattern in PARTS.items():
            share = sum(n for file, n in long.items() if re.search(pattern, file)) / total
            unused = part in UNUSED.get(scene, [])
            print(f"  {part:<26} {100 * share:7.3f} %{'  (not used)' if unused else ''}")
            worst = max(worst, share if unused else 0.0)
    print(f"largest share of a part that a scene does not use: {100 * worst:.3f} % (bar {100 * LIMIT:.0f} %)")
    return int(worst > LIMIT)


if __name__ == "__main__":
    sys.exit(main())
