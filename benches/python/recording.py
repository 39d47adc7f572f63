"""What recording costs: a dam break of 20,000 particles with and without its log of 60 frames per second, in turn.

    python benches/python/recording.py [PARTICLES [SECONDS [ROUNDS]]]
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "target/release/unipbd"
SCENE = """
name = "recording"
spacing = {spacing}
fps = 60
duration = {seconds}
[[liquid]]
name = "water"
xsph = 0.01
[[block]]
material = "water"
min = [0.0, 0.0]
max = [1.0, 2.0]
[[tank]]
min = [0.0, 0.0]
max = [3.2, 4.0]
"""


def wall_time(scene: Path, *options: str) -> float:
    """Seconds of a run."""
    command = [str(PROGRAM), str(scene), "--json", *options]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return float(json.loads(done.stdout.splitlines()[-1])["wall_time"])


def main() -> None:
    """Prints the least times and their ratio."""
    particles, seconds, rounds = (float(text) for text in (sys.argv[1:] + ["20000", "0.5", "5"][len(sys.argv) - 1 :]))
    subprocess.run(["cargo", "build", "--quiet", "--release", "-p", "unipbd-cli"], cwd=ROOT, check=True)
    without, recorded = [], []
    with tempfile.TemporaryDirectory() as folder:
        scene, log = Path(folder) / "scene.toml", Path(folder) / "log.mcap"
        scene.write_text(SCENE.format(spacing=(2.0 / particles) ** 0.5, seconds=seconds))
        for _ in range(int(rounds)):
            without.append(wall_time(scene, "--no-record"))
            recorded.append(wall_time(scene, "--output", str(log), "--force"))
        size = log.stat().st_size
    frames = 60 * seconds
    print(f"{particles:.0f} particles, {frames:.0f} frames, {size / frames / 1000:.0f} kB each")
    print(f"without a log {min(without):.3f} s, with one {min(recorded):.3f} s: {100 * (min(recorded) / min(without) - 1):+.1f} %")


if __name__ == "__main__":
    main()
