"""Making a data set: shards, processes, going on, putting the files together."""

from __future__ import annotations

import json
import os
import platform
import shutil
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from .. import _native
from .._errors import UnipbdError
from . import _gns, _lagrangebench
from ._parts import Parts
from ._recipe import Recipe
from ._trajectory import COLUMNS, first_simulation, run_trajectory

WRITERS: dict[str, Callable[[Parts, Path], Path]] = {
    "lagrangebench": _lagrangebench.write,
    "gns": _gns.write_tfrecords,
    "npz": _gns.write_npz,
}


@dataclass(frozen=True)
class Progress:
    """How far it has come.

    Attributes:
        done, total: trajectories of this shard.
        refused: draws that the filter did not let pass.
        elapsed: time since the start [s].
        remaining: estimate of the rest [s], None before the first trajectory.
    """

    done: int
    total: int
    refused: int
    elapsed: float
    remaining: float | None


def generate(
    recipe: Recipe | str | os.PathLike[str],
    folder: str | os.PathLike[str],
    shard: tuple[int, int] = (1, 1),
    jobs: int | None = None,
    progress: Callable[[Progress], object] | None = None,
    keep_parts: bool = False,
) -> list[Path]:
    """Makes the data set of a recipe in a folder and returns the folders of its formats.

    What is there is kept: a run that was killed goes on, one that is complete does nothing. `shard` (3, 16) makes
    the third of sixteen shares of the trajectories and no files of a format; once the parts of all shards
    are in the folder, a call without a shard puts them together. Files have the same bytes whatever the shards
    and `jobs` (processes; all processors where left out). With `keep_parts` the parts stay.
    """
    recipe = recipe if isinstance(recipe, Recipe) else Recipe.load(recipe)
    number, of = shard
    if not 1 <= number <= of:
        raise ValueError(f"a shard is a pair such as (3, 16), not {shard}")
    place = Path(folder)
    _claim(recipe, place)
    if (place / "manifest.json").exists():
        return _formats(place)
    parts = place / "parts"
    parts.mkdir(exist_ok=True)
    _run(recipe, parts, list(range(number - 1, recipe.trajectories, of)), jobs, progress)
    if of > 1:
        return []
    return assemble(recipe, place, keep_parts)


def assemble(recipe: Recipe, folder: Path, keep_parts: bool = False) -> list[Path]:
    """Puts the parts of all shards together."""
    parts = Parts(recipe, folder / "parts")
    made = [WRITERS[form](parts, folder) for form in recipe.formats]
    _write_diagnostics(parts, folder / "diagnostics.npz")
    text = json.dumps(_manifest(parts, [path.name for path in made]), indent=1, sort_keys=True)
    part = folder / "manifest.json.part"
    part.write_text(text, encoding="utf-8")
    os.replace(part, folder / "manifest.json")
    if not keep_parts:
        shutil.rmtree(folder / "parts")
    return made


def _claim(recipe: Recipe, folder: Path) -> None:
    """Takes the folder for this recipe; refuses one that holds another."""
    folder.mkdir(parents=True, exist_ok=True)
    path, wanted = folder / "recipe.json", recipe.to_dict()
    if not path.exists():
        part = folder / f"recipe.json.{os.getpid()}"
        part.write_text(json.dumps(wanted, indent=1, sort_keys=True), encoding="utf-8")
        os.replace(part, path)
        return
    there = json.loads(path.read_text(encoding="utf-8"))
    wanted = json.loads(json.dumps(wanted))
    if there != wanted:
        keys = sorted(key for key in {*there, *wanted} if there.get(key) != wanted.get(key))
        differ = ", ".join(keys)
        raise UnipbdError(f"{folder} holds the data set of another recipe: {differ} differ; choose another folder")


def _formats(folder: Path) -> list[Path]:
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    return [folder / name for name in manifest["folders"]]


def _run(
    recipe: Recipe, parts: Path, indices: list[int], jobs: int | None, progress: Callable[[Progress], object] | None
) -> None:
    processors = os.cpu_count() or 1
    wanted = [index for index in indices if not (parts / f"{index:05d}" / "record.json").exists()]
    jobs = max(1, min(jobs or processors, len(wanted)))
    threads = max(1, processors // jobs) if len(wanted) < processors else 1
    started, done, refused = time.monotonic(), len(indices) - len(wanted), 0
    for record in _records(recipe, parts, wanted, jobs, threads):
        done, refused = done + 1, refused + len(record["refused"])
        elapsed = time.monotonic() - started
        left = elapsed / (done - len(indices) + len(wanted)) * (len(indices) - done)
        if progress is not None:
            progress(Progress(done, len(indices), refused, elapsed, left))


def _records(recipe: Recipe, parts: Path, wanted: list[int], jobs: int, threads: int) -> Iterator[dict[str, Any]]:
    """Records in the order in which they get done."""
    if jobs == 1:
        for index in wanted:
            yield run_trajectory(recipe, index, parts, threads)
        return
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        futures = [pool.submit(run_trajectory, recipe, index, parts, threads) for index in wanted]
        try:
            for future in as_completed(futures):
                yield future.result()
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def _write_diagnostics(parts: Parts, path: Path) -> None:
    """Diagnostics of every stored frame, by trajectory: columns by name."""
    numbers = [np.load(parts.folder / f"{index:05d}" / "diagnostics.npy") for index in range(len(parts.records))]
    np.savez_compressed(path, columns=np.array(COLUMNS), values=np.stack(numbers))


def _manifest(parts: Parts, folders: list[str]) -> dict[str, Any]:
    reasons: dict[str, int] = {}
    for record in parts.records:
        for reason in record["refused"]:
            short = reason.split(":")[0]
            reasons[short] = reasons.get(short, 0) + 1
    return {
        "unipbd": _native.__version__,
        "numpy": np.__version__,
        "python": platform.python_version(),
        "recipe": parts.recipe.to_dict(),
        "recipe_digest": parts.recipe.digest(),
        "folders": folders,
        "fluid_types": _fluid_types(parts),
        "splits": {split: [piece.index for piece in parts.split(split)] for split in ("train", "valid", "test")},
        "refused": reasons,
        "trajectories": parts.records,
    }


def _fluid_types(parts: Parts) -> dict[str, list[int]]:
    """Particle types of fluids, by format."""
    found: dict[str, set[int]] = {}
    for piece in parts.all():
        for form, types in piece.types.items():
            found.setdefault(form, set()).update(int(kind) for kind in np.unique(types[piece.fluid]))
    return {form: sorted(types) for form, types in found.items()}


@dataclass(frozen=True)
class Estimate:
    """What a data set would cost.

    Attributes:
        particles: of one trajectory, without walls. bytes: of the positions, before compression, all formats.
        seconds: computing time of one core, from the first frames of the first trajectory.
    """

    particles: int
    bytes: int
    seconds: float


TRIAL = 0.5
"""Time that an estimate runs the first trajectory for [s]."""


def estimate(recipe: Recipe) -> Estimate:
    """Guesses size and time from the beginning of the first trajectory."""
    sim, hooks = first_simulation(recipe)
    started, frames = time.monotonic(), 0
    while frames < 3 or time.monotonic() - started < TRIAL:
        sim._native.step(1, hooks)
        frames += 1
    per_frame = (time.monotonic() - started) / frames
    simulated = recipe.frames * recipe.stride + recipe.warm_up / sim.frame_time
    stored = recipe.trajectories * (recipe.frames + 1) * len(sim) * 8
    return Estimate(len(sim), stored * len(recipe.formats), per_frame * simulated * recipe.trajectories)
