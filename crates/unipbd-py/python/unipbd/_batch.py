"""Many worlds at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import fixed
from ._errors import SolverError
from ._scene import Scene
from ._simulation import Simulation
from ._threads import thread_count


class Batch(Sequence[Simulation]):
    """Many worlds of one scene, stepped together on all processors.

        batch = up.Batch(scene, n=64, seeds=range(64))
        batch.step(60)
        batch.positions        # (64, N, 2), or a list where the worlds differ in size

    Each world is a `Simulation` of its own, on one thread: ``batch[3].edit()``, ``batch[3].state()``
    work as ever, and each gives bit for bit what it would give alone.
    """

    def __init__(
        self,
        scene: Scene | Sequence[Scene],
        n: int | None = None,
        seeds: Sequence[int] | None = None,
        threads: int | None = None,
        change: Callable[[Scene, int], object] | None = None,
    ) -> None:
        """`n` worlds of a scene, or one world for each of several scenes.

        `seeds` are the seeds of the worlds; left out, the scene's seed plus 0, 1, 2... `change` is
        called with a copy of the scene and the number of each world, to give it parameters of its
        own.
        """
        scenes = [scene] * (1 if n is None else n) if isinstance(scene, Scene) else list(scene)
        if n is not None and n != len(scenes) or not scenes:
            raise ValueError(f"{n} worlds are asked for with {len(scenes)} scenes")
        scenes = [one.copy() for one in scenes]
        if change is not None:
            for number, one in enumerate(scenes):
                change(one, number)
        if seeds is None:
            seeds = [one.seed + number for number, one in enumerate(scenes)]
        if len(seeds) != len(scenes):
            raise ValueError(f"there are {len(seeds)} seeds for {len(scenes)} worlds")
        worlds = zip(scenes, seeds, strict=True)
        self._worlds = [Simulation(one, seed=int(seed), threads=1) for one, seed in worlds]
        self._pool = _native.Pool(thread_count(threads))

    def step(self, frames: int = 1, worlds: Sequence[int] | None = None) -> None:
        """Advances all worlds by this many frames, or those whose indices are `worlds`.

        Raises the first `SolverError`, with the index of its world in `SolverError.world`; the other
        worlds have been stepped all the same. Worlds with hooks or recordings are stepped one by one.
        """
        if frames < 0:
            raise ValueError(f"frames must not be negative: {frames}")
        wanted = range(len(self)) if worlds is None else sorted({range(len(self))[number] for number in worlds})
        errors = [self._step_together(frames, wanted)]
        for number in wanted:
            world = self._worlds[number]
            if _needs_python(world):
                try:
                    world.step(frames)
                except SolverError as error:
                    error.world = number
                    errors.append(error)
        diverged = [error for error in errors if error is not None]
        if diverged:
            raise min(diverged, key=lambda error: error.world or 0)

    def _step_together(self, frames: int, wanted: Sequence[int]) -> SolverError | None:
        """Steps all of these worlds that need nothing from Python; returns the error of the first that diverged."""
        numbers = [number for number in wanted if not _needs_python(self._worlds[number])]
        try:
            self._pool.step([self._worlds[number]._native for number in numbers], frames)
        except SolverError as error:
            error.world = numbers[error.world or 0]
            return error
        finally:
            for number in numbers:
                self._worlds[number]._tell()
        return None

    def begin(self, number: int) -> Callable[[], None]:
        """Starts a frame of one world and returns at once: others can be edited and looked at meanwhile. The world is
        busy until what this returns is called: that waits, and raises the `SolverError` of a world that diverged."""
        world = self._worlds[number]
        if _needs_python(world) or self.threads == 1:
            return world.step
        ticket = self._pool.begin(world._native)

        def finish() -> None:
            try:
                ticket.wait()
            finally:
                world._tell()

        return finish

    @property
    def threads(self) -> int:
        """Most threads in use."""
        return self._pool.threads

    @property
    def times(self) -> npt.NDArray[np.float64]:
        """Simulated time of each world [s], float64, shape (n,)."""
        return fixed(np.array([world.time for world in self._worlds]))

    @property
    def counts(self) -> npt.NDArray[np.int64]:
        """Number of particles of each world, int64, shape (n,)."""
        return fixed(np.array([len(world) for world in self._worlds]))

    def state_hashes(self) -> list[int]:
        """State hash of each world."""
        return [world.state_hash() for world in self._worlds]

    def stack(self, column: str) -> Any:
        """A column such as ``"velocities"`` of all worlds, stacked to (n, N, ...) where they have as
        many particles as each other, a list of arrays otherwise."""
        arrays = [getattr(world, column) for world in self._worlds]
        same = all(array.shape == arrays[0].shape for array in arrays)
        return fixed(np.stack(arrays)) if same else arrays

    @property
    def positions(self) -> Any:
        """Positions [m], float32, shape (n, N, 2), or a list of arrays (N_i, 2)."""
        return self.stack("positions")

    @property
    def velocities(self) -> Any:
        """Velocities [m/s], float32, shape (n, N, 2), or a list of arrays (N_i, 2)."""
        return self.stack("velocities")

    @overload
    def __getitem__(self, index: int) -> Simulation: ...
    @overload
    def __getitem__(self, index: slice) -> list[Simulation]: ...
    def __getitem__(self, index: int | slice) -> Simulation | list[Simulation]:
        return self._worlds[index]

    def __len__(self) -> int:
        return len(self._worlds)

    def __iter__(self) -> Iterator[Simulation]:
        return iter(self._worlds)

    def __getstate__(self) -> dict[str, Any]:
        return {"worlds": self._worlds, "threads": self.threads}

    def __setstate__(self, saved: dict[str, Any]) -> None:
        self._worlds = saved["worlds"]
        self._pool = _native.Pool(saved["threads"])

    def __repr__(self) -> str:
        return f"<unipbd.Batch of {len(self)} worlds, {int(self.counts.sum())} particles>"


def _needs_python(world: Simulation) -> bool:
    return bool(world._hooks or world._groups or world._recordings)
