"""One trajectory: drawn, run, refused or kept."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .._errors import SceneError, SolverError, UnipbdError
from .._scene import Scene
from .._simulation import Simulation, _call
from .._state import State
from .._walls import bounds, wall_particles
from .._work import write
from . import _fields
from ._draw import Crowded, Drawer
from ._recipe import Recipe
from ._types import kinds_of, outlined_bodies, samples_of

COLUMNS = (
    "time kinetic_energy potential_energy momentum_x momentum_y density_error_max density_error_mean speed_max substeps"
).split()
"""Diagnostics that are kept for every stored frame."""
CHECKPOINT = 500
"""Stored frames between two states that a killed run goes on from."""


class Refused(Exception):
    """A run that the filter of the recipe does not let pass."""


def run_trajectory(
    recipe: Recipe, index: int, folder: Path, threads: int = 1, within: Callable[[float], None] | None = None
) -> dict[str, Any]:
    """Makes the trajectory in `folder`/NUMBER and returns its record. What is there is left as it is, a run that was
    killed goes on from its last state. `within` is told the part that is done, after every stored frame."""
    done = folder / f"{index:05d}"
    if (done / "record.json").exists():
        return read_record(done)
    drawer = Drawer(recipe)
    refused: list[str] = []
    for attempt in range(recipe.attempts):
        try:
            return _Run(recipe, drawer, index, attempt, folder, threads, within).make(done, refused)
        except (Crowded, Refused, SolverError, SceneError) as reason:
            kind = {Crowded: "crowded: ", SolverError: "diverged: ", SceneError: "scene: "}.get(type(reason), "")
            refused.append(f"{kind}{reason}")
    raise UnipbdError(f"trajectory {index}: all {recipe.attempts} draws were refused, the last one: {refused[-1]}")


def first_simulation(recipe: Recipe) -> tuple[Simulation, list[Callable[[Any], None]]]:
    """The start of the first trajectory that can be drawn, and its hooks."""
    drawer = Drawer(recipe)
    reason: Exception = Crowded("nothing was drawn")
    for attempt in range(recipe.attempts):
        try:
            data, seed = drawer.draw(0, attempt)
            sim = Simulation(Scene.from_dict(data), seed=seed, threads=1)
        except (Crowded, SceneError) as error:
            reason = error
            continue
        _fields.stir(sim, recipe.start, seed)
        force = _fields.force(recipe.force)
        return sim, [] if force is None else [_call(force)]
    raise UnipbdError(f"none of the first {recipe.attempts} draws makes a scene, the last one because: {reason}")


def read_record(folder: Path) -> dict[str, Any]:
    """The record of a trajectory that is done."""
    record: dict[str, Any] = json.loads((folder / "record.json").read_text(encoding="utf-8"))
    return record


class _Run:
    """One draw of a trajectory."""

    def __init__(
        self, recipe: Recipe, drawer: Drawer, index: int, attempt: int, folder: Path, threads: int,
        within: Callable[[float], None] | None,
    ) -> None:
        self.recipe, self.index, self.attempt = recipe, index, attempt
        self.data, self.seed = drawer.draw(index, attempt)
        self.scene = Scene.from_dict(self.data)
        self.place = folder / f"{index:05d}.{attempt}.part"
        self.threads, self.within = threads, within

    def make(self, done: Path, refused: list[str]) -> dict[str, Any]:
        """Runs it and puts it in its place, all at once."""
        self.sim = Simulation(self.scene, seed=self.seed, threads=self.threads)
        self.kept = np.flatnonzero(self.sim.phases != 2)
        if not len(self.kept):
            raise UnipbdError("the scene has no particles to store")
        self.kinds = kinds_of(self.sim)[self.kept]
        self.outlined = outlined_bodies(self.sim)
        self.outlined_kinds = [
            self.sim.bodies[name].kind for name in self.outlined for _ in range(len(self.sim.bodies[name].samples))
        ]
        walls = self.recipe.walls
        self.walls = wall_particles(self.scene, int(walls["layers"]), float(walls["reach"]))
        self.count = len(self.sim)
        self.hooks: list[Callable[[Any], None]] = []
        force = _fields.force(self.recipe.force)
        if force is not None:
            self.hooks = [_call(force)]
        try:
            self._run()
        except BaseException as error:
            if not isinstance(error, KeyboardInterrupt):
                shutil.rmtree(self.place, ignore_errors=True)
            raise
        record = self._record(refused)
        write(self.place / "record.json", json.dumps(record, indent=1, sort_keys=True))
        (self.place / "state.bin").unlink(missing_ok=True)
        shutil.rmtree(done, ignore_errors=True)
        os.replace(self.place, done)
        return record

    # -- running -------------------------------------------------------------------------------

    def _run(self) -> None:
        frames = self.recipe.frames + 1
        shape = (frames, len(self.kept) + len(self.walls.positions) + len(self.outlined_kinds), 2)
        first = self._resume(shape)
        if not first:
            self.place.mkdir(parents=True, exist_ok=True)
            self.positions: npt.NDArray[np.float32] = _memory(self.place / "position.npy", "w+", np.float32, shape)
            self.numbers: npt.NDArray[np.float64] = _memory(
                self.place / "diagnostics.npy", "w+", np.float64, (frames, len(COLUMNS)))
            self._start()
        for number in range(first, frames):
            if number:
                self._advance(self.recipe.stride)
            self._store(number)
            if number and number % CHECKPOINT == 0:
                self._checkpoint(number)
            if self.within is not None:
                self.within((number + 1) / frames)
        self.positions.flush()  # type: ignore[attr-defined]
        self.numbers.flush()  # type: ignore[attr-defined]

    def _start(self) -> None:
        _fields.stir(self.sim, self.recipe.start, self.seed)
        if self.recipe.warm_up > 0.0:
            self._advance(max(1, round(self.recipe.warm_up / self.sim.frame_time)))
        self.hash_of_start = self.sim.state_hash()

    def _advance(self, frames: int) -> None:
        self.sim._native.step(frames, self.hooks)
        for time, severity, message in self.sim._native.take_events():
            ignored = any(part in message for part in self.recipe.filter["ignore"])
            if severity == "warning" and self.recipe.filter["warnings"] and not ignored:
                raise Refused(f"warning: {message} at {time:.3f} s")

    def _store(self, number: int) -> None:
        if len(self.sim) != self.count:
            raise UnipbdError(
                f"particles come and go ({self.count} at the start, {len(self.sim)} at {self.sim.time:.3f} s): the "
                "formats hold as many in every frame; leave out emitters, sinks and lifetimes")
        x = self.sim.positions[self.kept]
        self.positions[number, : len(x)] = x
        elapsed = number * self.recipe.stride * self.sim.frame_time
        end = len(x) + len(self.walls.positions)
        self.positions[number, len(x) : end] = self.walls.at(elapsed, bool(self.recipe.walls["wrap"]))
        for name in self.outlined:
            places = samples_of(self.sim.bodies[name])
            self.positions[number, end : end + len(places)] = places
            end += len(places)
        seen = self.sim.diagnostics()
        seen["momentum_x"], seen["momentum_y"] = seen["momentum"]
        self.numbers[number] = [float(seen[name]) for name in COLUMNS]
        self._filter(number, x)

    def _filter(self, number: int, x: npt.NDArray[np.float32]) -> None:
        rules = self.recipe.filter
        row = dict(zip(COLUMNS, self.numbers[number], strict=True))
        if not np.isfinite(x).all():
            raise Refused("diverged: a position is not finite")
        for rule, name in (("compression", "density_error_max"), ("speed", "speed_max")):
            if rules[rule] is not None and row[name] > float(rules[rule]):
                raise Refused(f"{rule}: {name} {row[name]:.3g} is above {rules[rule]:g} at {row['time']:.3f} s")
        if rules["energy_growth"] is not None:
            energy = self.numbers[[0, number], 1:3].sum(axis=1)
            scale = max(abs(self.numbers[0, 1:3]).sum(), 1e-12)
            if energy[1] - energy[0] > float(rules["energy_growth"]) * scale:
                part = (energy[1] - energy[0]) / scale
                raise Refused(f"energy_growth: the energy grew by {part:.3g} of itself at {row['time']:.3f} s")
        if rules["contained"] and not self._inside(x):
            raise Refused(f"contained: particles left the walls at {row['time']:.3f} s")

    def _inside(self, x: npt.NDArray[np.float32]) -> bool:
        """Whether all particles are in the room of the walls: open sides let them out."""
        if not len(self.walls.positions):
            return True
        box = np.array(bounds(self.scene, self.walls))
        margin = 2.0 * float(self.scene.spacing)
        opened = [side for tank in self.data.get("tank", []) for side in tank.get("open", [])]
        low = np.array([side in opened for side in ("left", "bottom")])
        high = np.array([side in opened for side in ("right", "top")])
        return bool(((x >= box[:, 0] - margin) | low).all() and ((x <= box[:, 1] + margin) | high).all())

    # -- going on ------------------------------------------------------------------------------

    def _checkpoint(self, number: int) -> None:
        self.positions.flush()  # type: ignore[attr-defined]
        self.numbers.flush()  # type: ignore[attr-defined]
        kept = {"frame": number, "start": f"{self.hash_of_start:016x}", "recipe": self.recipe.digest()}
        state = self.sim.state().to_bytes()
        data = json.dumps(kept).encode("utf-8")
        write(self.place / "state.bin", len(data).to_bytes(4, "little") + data + state)

    def _resume(self, shape: tuple[int, int, int]) -> int:
        """The stored frame to go on with; 0 where there is nothing to go on from."""
        try:
            saved = (self.place / "state.bin").read_bytes()
            length = int.from_bytes(saved[:4], "little")
            kept = json.loads(saved[4 : 4 + length])
            if kept["recipe"] != self.recipe.digest():
                return 0
            self.positions = _memory(self.place / "position.npy", "r+", np.float32, shape)
            self.numbers = _memory(self.place / "diagnostics.npy", "r+", np.float64, (shape[0], len(COLUMNS)))
            self.sim.restore(State.from_bytes(saved[4 + length :]))
        except (OSError, ValueError, KeyError):
            return 0
        self.hash_of_start = int(kept["start"], 16)
        return int(kept["frame"]) + 1

    # -- the record ----------------------------------------------------------------------------

    def _record(self, refused: list[str]) -> dict[str, Any]:
        material = self.sim.material_indices[self.kept]
        names = list(self.sim.materials)
        moving = self.walls
        return {
            "index": self.index,
            "attempt": self.attempt,
            "refused": refused,
            "seed": self.seed,
            "scene": self.scene.to_dict(),
            "particles": len(self.kept),
            "wall_particles": len(moving.positions) + len(self.outlined_kinds),
            "materials": names,
            "material_of_particle": _runs(material.tolist()),
            "kinds": _runs(
                self.kinds.tolist()
                + np.where(moving.types == 2, "sliding wall", "wall").tolist()
                + self.outlined_kinds
            ),
            "bounds": bounds(self.scene, self.walls),
            "frame_time": self.sim.frame_time * self.recipe.stride,
            "state_hash_first": f"{self.hash_of_start:016x}",
            "state_hash_last": f"{self.sim.state_hash():016x}",
        }


def _runs(values: list[Any]) -> list[list[Any]]:
    """Equal neighbours as [value, count]."""
    runs: list[list[Any]] = []
    for value in values:
        if runs and runs[-1][0] == value:
            runs[-1][1] += 1
        else:
            runs.append([value, 1])
    return runs


def spread(runs: list[list[Any]]) -> list[Any]:
    """What `_runs` made short."""
    return [value for value, count in runs for _ in range(count)]


def _memory(path: Path, mode: str, dtype: type, shape: tuple[int, ...]) -> Any:
    """An array in a file, of this shape."""
    if mode == "w+":
        return np.lib.format.open_memmap(path, mode="w+", dtype=dtype, shape=shape)
    array = np.lib.format.open_memmap(path, mode="r+")
    if array.shape != shape or array.dtype != np.dtype(dtype):
        raise ValueError("another shape")
    return array
