"""Counts the instructions of a frame (valgrind's callgrind), by scene and by part of the library.

    python benches/python/instructions.py [--check | --write] [SCENE ...]

Two runs of different length are subtracted, so that reading the scene and building it do not count. A function of the
standard library, or of the helpers that all parts share, counts for the part that calls it. What a scene does not use
must not run: the share of such parts is printed, and the exit code is 1 above 1 %.

With --check it is 1 too where a frame takes 5 % more instructions than benches/instructions.json says; --write renews
that file. Counts do not depend on the machine, as valgrind shows AVX2 everywhere, but on the compiler.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from datetime import datetime, timezone
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "target/release/unipbd"
TABLE = ROOT / "benches/instructions.json"
FRAMES = (12, 24)
UNUSED_LIMIT = 0.01
GROWTH_LIMIT = 1.05

# Parts of the library, by the modules they stand in.
PARTS = {
    "bodies and contacts": r"rigid|coupling|shapes|constraints::shape_matching",
    "gas and smoke": r"effects::(smoke|drag|wind|confinement|baroclinic|conduction|heating)|sources",
    "other groups and effects": r"legacy|constraints::(surface_tension|viscosity|distance|rope)",
    "sleep": r"sleep|step::sleep",
    "diagnostics": r"observe|step::diagnose|expect",
    "row index, edits, states": r"rows|edit|state|bytes",
}
# Modules that work for whoever calls them.
SHARED = r"parallel|math"
MODULE = re.compile(r"unipbd_core::([a-z_]\w*(?:::[a-z_]\w*)*)")

# The scenes of the table: options, and the parts that they have no need of.
SCENES = {
    "liquid": ("dam_break", [], list(PARTS)),
    "grid": ("large_dam_break", ["--set", "spacing=0.05"], list(PARTS)),
    "gas": ("open_gas", [], ["bodies and contacts", "other groups and effects", "sleep", "diagnostics"]),
    "bodies": ("rigid_pile", [], ["gas and smoke", "other groups and effects", "sleep", "diagnostics"]),
    "soft": ("soft_bodies", [], ["gas and smoke", "sleep", "diagnostics"]),
    "everything": ("everything", [], ["sleep", "diagnostics"]),
}


class Profile:
    """Instructions of each function itself, and of the calls between them."""

    def __init__(self, text: str) -> None:
        self.own: Counter[str] = Counter()
        self.callers: defaultdict[str, Counter[str]] = defaultdict(Counter)
        function = callee = ""
        called = False
        for line in text.splitlines():
            if line.startswith("fn="):
                function = line[3:]
            elif line.startswith("cfn="):
                callee = line[4:]
            elif line.startswith("calls="):
                called = True
            elif line[:1].isdigit():
                cost = int(line.split()[-1])
                if called:
                    self.callers[callee][function] += cost
                else:
                    self.own[function] += cost
                called = False

    def by_module(self) -> Counter[str]:
        """Instructions by module; a function without one is charged to its callers, by what their calls cost."""
        charged: Counter[str] = Counter()
        left = {function: float(cost) for function, cost in self.own.items()}
        for _ in range(50):
            passed: defaultdict[str, float] = defaultdict(float)
            for function, cost in left.items():
                callers = {} if module(function) else self.callers[function]
                total = sum(callers.values())
                if not total:
                    charged[module(function)] += cost  # type: ignore[assignment]
                for caller, weight in callers.items():
                    passed[caller] += cost * weight / total
            left = {function: cost for function, cost in passed.items() if cost > 0.5}
        charged[""] += sum(left.values())  # type: ignore[assignment]
        return charged


def module(function: str) -> str:
    """The module of the library that a function belongs to; none for those that are shared or not its own."""
    found = MODULE.search(function)
    return found[1] if found and not re.match(rf"({SHARED})\b", found[1]) else ""


def count(scene: str, options: list[str], frames: int) -> Counter[str]:
    """Instructions by module."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        length = ["--fps", "60", "--duration", str(frames / 60)]
        run = [str(PROGRAM), str(ROOT / f"scenes/{scene}.toml"), "-q", "--no-record", "--threads", "1"]
        grind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--compress-strings=no"]
        subprocess.run(
            [*grind, "--compress-pos=no", *run, *length, *options],
            check=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        return Profile(out.read_text()).by_module()


def measure(name: str) -> tuple[int, dict[str, float]]:
    """Instructions of a frame of a scene, and the share of each part."""
    scene, options, _ = SCENES[name]
    short, long = (count(scene, options, frames) for frames in FRAMES)
    long.subtract(short)
    total = sum(long.values())
    share = {
        part: sum(n for of, n in long.items() if re.match(rf"({pattern})\b", of)) / total
        for part, pattern in PARTS.items()
    }
    return round(total / (FRAMES[1] - FRAMES[0])), share


def show(name: str, frame: int, share: dict[str, float]) -> float:
    """Prints a scene; the largest share of a part that it does not use."""
    scene, options, unused = SCENES[name]
    print(f"{name} ({' '.join([scene, *options])}): {frame:,} instructions a frame")
    for part, value in share.items():
        print(f"  {part:<26} {100 * value:7.3f} %{'  (not used)' if part in unused else ''}")
    return max((share[part] for part in unused), default=0.0)


def output(*command: str) -> str:
    """What a program prints."""
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()


def grown(frames: dict[str, int]) -> list[str]:
    """The scenes that take more instructions than the table allows."""
    table = json.loads(TABLE.read_text())
    compiler = output("rustc", "--version")
    if table["compiler"] != compiler:
        print(f"the table is of {table['compiler']}, this is {compiler}: counts may differ for that reason alone")
    lines = []
    for name, frame in frames.items():
        ratio = frame / table["instructions_per_frame"][name]
        print(f"{name}: {ratio:.3f} of the table")
        if ratio > GROWTH_LIMIT:
            lines.append(f"{name} takes {frame:,} instructions a frame, {100 * (ratio - 1):.1f} % more than the table says")
    return lines


def write(frames: dict[str, int]) -> None:
    """Renews the table."""
    table = {
        "command": "python benches/python/instructions.py --write",
        "date": datetime.now(timezone.utc).date().isoformat(),
        "commit": output("git", "rev-parse", "--short=7", "HEAD"),
        "compiler": output("rustc", "--version"),
        "instructions_per_frame": frames,
    }
    TABLE.write_text(json.dumps(table, indent=2) + "\n")


def main() -> int:
    """Measures, prints, and compares or writes."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"one of {', '.join(SCENES)}; all by default")
    parser.add_argument("--check", action="store_true", help="compare with the table")
    parser.add_argument("--write", action="store_true", help="renew the table, from all scenes")
    arguments = parser.parse_args()
    unknown = set(arguments.scenes) - set(SCENES)
    if unknown or (arguments.write and arguments.scenes):
        parser.error(f"there is no scene {', '.join(unknown)}" if unknown else "--write takes all scenes")
    if arguments.check and not TABLE.exists():
        parser.error(f"there is no {TABLE.relative_to(ROOT)} to compare with: make it by --write")
    if not shutil.which("valgrind"):
        print("valgrind is not installed", file=sys.stderr)
        return 2
    subprocess.run(["cargo", "build", "--quiet", "--release", "-p", "unipbd-cli"], cwd=ROOT, check=True)
    frames, worst = {}, 0.0
    for name in arguments.scenes or SCENES:
        frames[name], share = measure(name)
        worst = max(worst, show(name, frames[name], share))
    print(f"largest share of a part that a scene does not use: {100 * worst:.3f} % (bar {100 * UNUSED_LIMIT:.0f} %)")
    if arguments.write:
        write(frames)
    failures = grown(frames) if arguments.check else []
    failures.extend(["a scene runs what it does not use"] * (worst > UNUSED_LIMIT))
    for failure in failures:
        print(failure, file=sys.stderr)
    return int(bool(failures))


if __name__ == "__main__":
    sys.exit(main())
