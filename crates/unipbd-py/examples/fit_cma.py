"""Fits the viscosity and the density of a liquid to a recorded run without derivatives, by `cma` and a batch.

    pip install cma
    python fit_cma.py
"""

import importlib
import tempfile
from pathlib import Path

import numpy as np
from fit_gradient import FRAMES, KEYS, TRUE, Array, record, scene_with, watch

import unipbd as up


def error(candidates: list[Array], measured: Array) -> list[float]:
    """Differences of all candidates, logarithms of the values, from the recorded run: one batch."""
    scenes = [scene_with(dict(zip(KEYS, np.exp(candidate), strict=True))) for candidate in candidates]
    batch = up.Batch(scenes, seeds=[1] * len(scenes))
    rows = [[watch(world) for world in batch]]
    for _ in range(FRAMES):
        batch.step()
        rows.append([watch(world) for world in batch])
    return [float(np.sqrt(np.mean((np.array(row) - measured) ** 2))) for row in zip(*rows, strict=True)]


def main() -> None:
    cma = importlib.import_module("cma")
    with tempfile.TemporaryDirectory() as folder:
        measured = record(Path(folder) / "run.mcap")
    start = np.log(list(KEYS.values()))
    search = cma.CMAEvolutionStrategy(start, 0.4, {"seed": 1, "maxfevals": 160, "ftarget": 2e-4, "verbose": -9, "popsize": 8})
    while not search.stop():
        candidates = search.ask()
        search.tell(candidates, error(candidates, measured))
    values = dict(zip(KEYS, np.exp(search.result.xbest), strict=True))
    words = ", ".join(f"{key} {value:.5g}" for key, value in values.items())
    print(f"{search.result.evaluations} runs, error {search.result.fbest:.2e}: {words}")
    for key, value in values.items():
        assert abs(value / TRUE[key] - 1.0) < 0.05, key


if __name__ == "__main__":
    main()
