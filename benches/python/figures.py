"""What the Python package costs over the core: copies of columns, calls, batches.

    python benches/python/figures.py [--json figures.json] [--check]

With --check, exits with 1 where a figure misses its bound.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path

import unipbd as up

BOUNDS = {"positions_of_100k_ms": 1.0, "step_call_over_core_us": 5.0}


def best(work: Callable[[], object], repeats: int = 7) -> float:
    """Shortest time of several runs [s]."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return min(times)


def pool(spacing: float, size: float) -> up.Scene:
    scene = up.Scene(spacing=spacing)
    scene.add_liquid("water")
    scene.add_block("water", min=(0, 0), max=(size, size))
    scene.add_tank(min=(0, 0), max=(2 * size, 2 * size))
    scene.solver.settle_substeps = 1
    return scene


def getters() -> dict[str, float]:
    """Each column of a hundred thousand particles [ms], the first getter after a step and later ones."""
    sim = pool(0.01, 3.17).build(threads=1)
    sim.step()
    begin = time.perf_counter()
    first = sim.positions
    cold = time.perf_counter() - begin
    assert len(first) >= 100_000
    figures = {"first_positions_of_100k_after_a_step_ms": 1e3 * cold}
    for name in ("positions", "velocities", "ids", "phases"):
        figures[f"{name}_of_100k_ms"] = 1e3 * best(lambda name=name: getattr(sim, name), 30)  # type: ignore[misc]
    return figures


def calls() -> dict[str, float]:
    """One call of step() against one frame within a long call [us]: two free points, one substep."""
    scene = up.Scene()
    scene.add_solid("points")
    scene.add_particles("points", [(0, 0), (1, 0)])
    scene.solver.substeps = 1
    sim = scene.build(threads=1)
    count = 20_000

    def single() -> None:
        for _ in range(count):
            sim.step()

    within = best(lambda: sim.step(count)) / count
    return {"step_call_over_core_us": 1e6 * (best(single) / count - within), "core_frame_us": 1e6 * within}


def batches() -> dict[str, float]:
    """Particle frames per second of 64 small worlds: in a batch, and one after the other."""
    scene = pool(0.05, 1.0)
    scene.solver.substeps = 4
    batch = up.Batch(scene, n=64)
    worlds = [scene.build(seed=seed, threads=1) for seed in range(64)]
    frames = 5
    together = best(lambda: batch.step(frames), 3)
    alone = best(lambda: [world.step(frames) for world in worlds], 3)
    assert batch.state_hashes() == [world.state_hash() for world in worlds], "a world in a batch is what it is alone"
    work = int(batch.counts.sum()) * frames
    return {
        "batch_threads": batch.threads,
        "batch_particle_frames_per_s": work / together,
        "batch_speedup": alone / together,
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    figures = getters() | calls() | batches()
    for name, value in figures.items():
        bound = f"   (below {BOUNDS[name]:g})" if name in BOUNDS else ""
        print(f"{name:44s} {value:12.4g}{bound}")
    if arguments.json:
        arguments.json.write_text(json.dumps(figures, indent=2) + "\n")
    missed = [name for name, bound in BOUNDS.items() if figures[name] > bound]
    return int(arguments.check and bool(missed))


if __name__ == "__main__":
    raise SystemExit(main())
