"""What a live server costs a run that nobody watches.

    python3 benches/python/live.py [SCENE] [--pairs N] [--command UNIPBD]

Runs a scene with and without `--live`, in turn, on one thread, and prints the ratio of processor times of each pair and
their median. Build the command first: `cargo build --release -p unipbd-cli`.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def seconds(command: list[str]) -> float:
    """Processor time of a command, user and system [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (after.ru_utime - before.ru_utime) + (after.ru_stime - before.ru_stime)


def main() -> None:
    parser = argparse.ArgumentParser(description="What a live server costs a run that nobody watches.")
    parser.add_argument("scene", nargs="?", default=str(ROOT / "scenes" / "dam_break.toml"))
    parser.add_argument("--pairs", type=int, default=9)
    parser.add_argument("--command", default=str(ROOT / "target" / "release" / "unipbd"))
    arguments = parser.parse_args()
    plain = [arguments.command, "run", arguments.scene, "--no-record", "--threads", "1"]
    live = [*plain, "--live", "127.0.0.1:0", "--speed", "0"]
    ratios = []
    for pair in range(arguments.pairs):
        # Each is first in turn: what drifts falls on both.
        order = [plain, live] if pair % 2 == 0 else [live, plain]
        times = {len(command): seconds(command) for command in order}
        ratios.append(times[len(live)] / times[len(plain)])
        print(f"{times[len(plain)]:.3f} s, live {times[len(live)]:.3f} s: ratio {ratios[-1]:.4f}", flush=True)
    print(f"median {statistics.median(ratios):.4f}, {min(ratios):.4f} to {max(ratios):.4f}")


if __name__ == "__main__":
    main()
