"""Making a data set: shards, processes, going on, putting the files together."""

from __future__ import annotations

import functools
import json
import os
import platform
import shutil
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import _native
from .._phase import SMOKE
from .._walls import wall_particles
from .._work import claim, processes, run_all, share, write
from . import _gns, _lagrangebench
from ._parts import Parts
from ._recipe import Recipe
from ._trajectory import COLUMNS, first_simulation, run_trajectory

WRITERS: dict[str, Callable[[Parts, Path], Path]] = {
    "lagrangebench": _lagrangebench.write,
    "gns": _gns.write_tfrecords,
    "npz": _gns.write_npz,
}


BETWEEN = 1.0
"""Least time between two messages within a trajectory [s]."""


@dataclass(frozen=True)
class Progress:
    """How far it has come.

    Attributes:
        done, total: trajectories of this shard. part: of the present one, with one process; 0 with several.
        refused: draws that the filter did not let pass.
        elapsed: time since the start [s].
        remaining: estimate of the rest [s], None before the first trajectory.
    """

    done: int
    total: int
    refused: int
    elapsed: float
    remaining: float | None
    part: float = 0.0


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
    place = Path(folder)
    indices = share(recipe.trajectories, shard)
    claim(place, "recipe.json", recipe.to_dict())
    parts = place / "parts"
    if (place / "manifest.json").exists():
        if not keep_parts:
            shutil.rmtree(parts, ignore_errors=True)  # where it was killed at the very end
        return _formats(place)
    parts.mkdir(exist_ok=True)
    _run(recipe, parts, indices, jobs, progress)
    if shard != (1, 1):
        return []
    return assemble(recipe, place, keep_parts)


def assemble(recipe: Recipe, folder: Path, keep_parts: bool = False) -> list[Path]:
    """Puts the parts of all shards together."""
    parts = Parts(recipe, folder / "parts")
    made = [WRITERS[form](parts, folder) for form in recipe.formats]
    _write_diagnostics(parts, folder / "diagnostics.npz")
    text = json.dumps(_manifest(parts, [path.name for path in made]), indent=1, sort_keys=True)
    write(folder / "manifest.json", text)
    if not keep_parts:
        shutil.rmtree(folder / "parts")
    return made


def _formats(folder: Path) -> list[Path]:
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    return [folder / name for name in manifest["folders"]]


def _run(
    recipe: Recipe, parts: Path, indices: list[int], jobs: int | None, progress: Callable[[Progress], object] | None
) -> None:
    wanted = [index for index in indices if not (parts / f"{index:05d}" / "record.json").exists()]
    jobs = processes(jobs, len(wanted))
    # Where there are fewer runs than processors each has several: threads change no result.
    threads = max(1, (os.cpu_count() or 1) // jobs) if len(wanted) == jobs else 1
    watch = _Watch(progress, len(indices), len(wanted))
    # The part of a trajectory that is done is known in this process alone.
    work = functools.partial(_numbered, recipe, parts, threads, watch.within if jobs == 1 else None)
    for record in run_all(work, wanted, jobs):
        watch.finished(len(record["refused"]))


class _Watch:
    """Tells how far the trajectories of a shard have come."""

    def __init__(self, tell: Callable[[Progress], object] | None, total: int, wanted: int) -> None:
        self.tell, self.total = tell, total
        self.done, self.refused = total - wanted, 0
        # Trajectories that were there already; the present one as well, where it goes on from a state.
        self.there, self.begun = float(total - wanted), False
        self.started = self.told = time.monotonic()

    def finished(self, refused: int) -> None:
        """One more is done, after this many draws that were refused."""
        self.done, self.refused, self.begun = self.done + 1, self.refused + refused, False
        self._say(0.0)

    def within(self, part: float) -> None:
        """This part of the present one is done."""
        if not self.begun:
            self.begun, self.there = True, self.there + part
        if time.monotonic() - self.told > BETWEEN:
            self._say(part)

    def _say(self, part: float) -> None:
        self.told = time.monotonic()
        elapsed = self.told - self.started
        new = self.done + part - self.there
        left = elapsed / new * (self.total - self.done - part) if new > 0.0 else None
        if self.tell is not None:
            self.tell(Progress(self.done, self.total, self.refused, elapsed, left, part))


def _numbered(
    recipe: Recipe, parts: Path, threads: int, within: Callable[[float], None] | None, index: int
) -> dict[str, Any]:
    return run_trajectory(recipe, index, parts, threads, within)


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
    versions = {"h5py": _lagrangebench.h5py().__version__} if "lagrangebench" in parts.recipe.formats else {}
    return {
        "unipbd": _native.__version__,
        **versions,
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
        particles: of one trajectory, with those of the walls. bytes: of the positions, before compression, all formats.
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
    walls = wall_particles(sim.scene, int(recipe.walls["layers"]), float(recipe.walls["reach"]))
    particles = int((sim.phases != SMOKE).sum()) + len(walls.positions)
    stored = recipe.trajectories * (recipe.frames + 1) * particles * 8
    return Estimate(particles, stored * len(recipe.formats), per_frame * simulated * recipe.trajectories)
