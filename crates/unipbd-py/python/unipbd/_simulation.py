"""Running simulations."""

from __future__ import annotations

import copy
import logging
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy.typing as npt

from . import _native
from ._arrays import Doubles, points
from ._edit import Edit
from ._frame import Frame
from ._live import Live
from ._picture import Drawable
from ._recording import Recording
from ._scene import Scene
from ._state import State
from ._substep import Projection, Substep
from ._threads import thread_count

logger = logging.getLogger("unipbd")

# Frames differ from a time by rounding only.
_SAME_FRAME = 1e-6


class Simulation(Drawable):
    """A running simulation. Made by `Scene.build`.

    The frame is the unit of time: `step` advances by whole frames of ``1 / scene.fps`` seconds, and
    the solver chooses the substeps within. Stepping releases the interpreter's lock; Ctrl-C stops a
    run between two substeps; the next step goes on with the rest of the frame.

    Arrays have one row per particle in ascending order of ids, are copies, and cannot be written
    to. Row i of all arrays taken at the same moment is the same particle; it stays in row i until
    particles are added or removed. Ids are never reused.
    """

    def __init__(
        self,
        scene: Scene,
        seed: int | None = None,
        threads: int | None = None,
        _settled: bool = False,
    ) -> None:
        """Builds the scene; see `Scene.build`."""
        if seed is not None and not 0 <= seed < 2**64:
            raise ValueError(f"seed must be a whole number from 0 to 2^64 - 1, not {seed}")
        self._scene = scene.copy()
        self._native = _native.Solver(self._scene._data, seed, thread_count(threads), _settled)
        self._hooks: list[Callable[[Substep], object]] = []
        self._groups: list[tuple[str, Callable[[Projection], npt.ArrayLike | None]]] = []
        self._recordings: list[Recording] = []

    # -- stepping ------------------------------------------------------------------------------

    def step(self, frames: int = 1) -> None:
        """Advances by this many frames.

        Raises `SolverError` when the simulation diverges. An exception in a hook passes through as
        it is; the simulation then stands between two substeps and can go on.
        """
        if frames < 0:
            raise ValueError(f"frames must not be negative: {frames}")
        hooks = [_call(hook) for hook in self._hooks]
        if not self._recordings:
            self._native.step(frames, hooks)
            self._tell()
            return
        for _ in range(frames):
            self._native.step(1, hooks)
            self._tell()
            for recording in self._recordings:
                recording._after_frame()

    def run(
        self, until: float | None = None, fps: float | None = None, frames: int | None = None
    ) -> Iterator[Frame]:
        """Steps to the time `until` [s] (the scene's duration where left out) and yields a `Frame`
        after every step, `fps` times per simulated second.

        `fps` must divide the frames per second of the scene, which it is where left out. `frames`
        limits the number of frames that are yielded.
        """
        stride = self._stride(fps)
        end = self._scene.duration if until is None else until
        yielded = 0
        while (frames is None or yielded < frames) and self.time < end - _SAME_FRAME * self.frame_time:
            left = (end - self.time) / self.frame_time
            self.step(max(1, min(stride, round(left))))
            yielded += 1
            yield Frame._of(self._native)

    def _stride(self, fps: float | None) -> int:
        """Frames per step of `fps` steps per second."""
        if fps is None:
            return 1
        ratio = 1.0 / (self.frame_time * fps) if fps > 0 else 0.0
        if ratio < 0.5 or abs(ratio - round(ratio)) > 1e-6 * ratio:
            own = 1.0 / self.frame_time
            raise ValueError(
                f"fps must be a whole fraction of the scene's {own:g} frames per second, not {fps:g}; "
                f"set scene.fps before building to have others"
            )
        return round(ratio)

    def _tell(self) -> None:
        for time, severity, message in self._native.take_events():
            level = logging.WARNING if severity == "warning" else logging.INFO
            logger.log(level, "%.3f s: %s", time, message)

    def on_substep(self, hook: Callable[[Substep], object]) -> Callable[[Substep], object]:
        """Calls `hook` at the start of every substep with a `Substep`; also works as a decorator.

        The hook sees all particles as arrays and can add accelerations and set velocities::

            sim.on_substep(lambda s: s.add_acceleration(-9.0 * s.positions))
        """
        if not callable(hook):
            raise TypeError(f"a hook must be callable, not {type(hook).__name__}")
        self._hooks.append(hook)
        return hook

    def remove_hook(self, hook: Callable[[Substep], object]) -> None:
        """No longer calls `hook`. Raises ValueError where it is not known."""
        self._hooks.remove(hook)

    def add_group(self, name: str, project: Callable[[Projection], npt.ArrayLike | None]) -> None:
        """Adds a constraint group of your own behind those of the scene.

        `project` is called in every iteration of every substep with a `Projection` and returns the
        displacements it wants [m], shape (N, 2), or None. Slow next to the built-in groups, but
        nothing is out of reach. A rod of 0.5 m between the particles 3 and 4::

            def rod(p):
                i, j = np.searchsorted(p.ids, [3, 4])
                w, apart = p.inverse_masses, p.positions[i] - p.positions[j]
                length = np.linalg.norm(apart)
                impulse = (length - 0.5) / (w[i] + w[j]) * apart / length
                moves = np.zeros_like(p.positions)
                moves[i], moves[j] = -w[i] * impulse, w[j] * impulse
                return moves

            sim.add_group("rod", rod)
        """
        if not callable(project):
            raise TypeError(f"project must be callable, not {type(project).__name__}")
        self._native.add_group(name, _project(project))
        self._groups.append((name, project))

    @property
    def budget(self) -> float | None:
        """Most time of the clock that a frame should take [s], for games; None, the default, for no limit. To be set.

        By what the frames before took, fewer substeps are made than wanted, but one at least, and where one takes too
        long contacts are swept once. ``diagnostics()["substeps_reason"]`` is ``"budget"`` then, and one warning tells so.
        Where it cuts, results depend on the machine; where it does not, they are the same bits as without."""
        return self._native.budget

    @budget.setter
    def budget(self, seconds: float | None) -> None:
        if seconds is not None and not 0.0 < seconds < 1e6:
            raise ValueError(f"a budget is a positive time in seconds, or None: not {seconds}")
        self._native.set_budget(None if seconds is None else float(seconds))

    # -- changing ------------------------------------------------------------------------------

    def edit(self) -> Edit:
        """Changes particles, bodies, emitters and ropes between two frames, all at once or not at all::

            with sim.edit() as e:
                e.velocities[sim.ids_of("water")] = 0
                e.remove(sim.positions[:, 1] > 2.0)
                e.add("water", positions=xy, velocities=(0, -1))
                e.bodies["raft"].velocity = (0.5, 0)
                e.add_body("ball", at=(1, 3), radius=0.1)
                e.gravity = (0, -1.6)

        See `help(unipbd.Edit)`.
        """
        return Edit(self)

    # -- state ---------------------------------------------------------------------------------

    def state(self) -> State:
        """This moment: everything the simulation goes on from, bit for bit."""
        return State(self._native.save())

    def restore(self, state: State) -> None:
        """Goes back (or on) to a saved moment of this scene and seed; from there the run goes on bit
        for bit as the saved one did. Raises `StateError` for a state of another scene."""
        if not isinstance(state, State):
            raise TypeError(f"a State is wanted, not {type(state).__name__}")
        self._native.restore(state._state)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the state to a file; `load` reads it back."""
        self.state().save(path)

    def load(self, path: str | os.PathLike[str]) -> None:
        """Goes to the state in a file. Raises `StateError` for a damaged or foreign one."""
        self.restore(State.load(path))

    def __getstate__(self) -> dict[str, Any]:
        if self._recordings:
            raise TypeError("a simulation cannot be copied or pickled while it is recorded")
        return {
            "scene": self._scene,
            "seed": self.seed,
            "threads": self.threads,
            "hooks": self._hooks,
            "groups": self._groups,
            "budget": self.budget,
            "state": self.state(),
        }

    def __setstate__(self, saved: dict[str, Any]) -> None:
        Simulation.__init__(self, saved["scene"], saved["seed"], saved["threads"], _settled=True)
        self._hooks = list(saved["hooks"])
        for name, project in saved["groups"]:
            self.add_group(name, project)
        self.budget = saved["budget"]
        self.restore(saved["state"])

    def copy(self) -> Simulation:
        """An independent simulation at the same moment, with the same hooks and groups."""
        return copy.copy(self)

    def __deepcopy__(self, memo: dict[int, Any]) -> Simulation:
        # Hooks may belong to something that is copied along with the simulation.
        clone = type(self).__new__(type(self))
        memo[id(self)] = clone
        clone.__setstate__(copy.deepcopy(self.__getstate__(), memo))
        return clone

    # -- showing -------------------------------------------------------------------------------

    def record(self, path: str | os.PathLike[str], fps: float | None = None, fields: str = "") -> Recording:
        """Records every frame to an MCAP log while the `with` block lasts, the present one first::

            with sim.record("run.mcap", fps=30):
                sim.step(300)

        `fps` must divide the frames per second of the scene. `fields` names columns to record beside
        positions: ``"velocity,density,temperature"`` or ``"all"``. A file that is there is replaced.
        """
        return Recording(self, Path(path), self._stride(fps), fields)

    def live(
        self, address: str = "127.0.0.1:8765", speed: float = 1.0, paused: bool = False, fields: str = ""
    ) -> Live:
        """Lets Lichtblick or Foxglove watch and steer the run while it is stepped::

            with sim.live() as live:
                print(live.url)
                sim.step(600)
                live.hold()    # the last frame, until the viewers have left

        `step` then keeps to `speed` simulated seconds per second, 0 is as fast as it can, and waits while a viewer
        pauses the run. Viewers change gravity and motors as `edit` does. Port 0 takes a free one. `fields` names
        columns as for `record`. Raises OSError where the address cannot be had.
        """
        return Live(self, address, speed, paused, fields)


def _call(hook: Callable[[Substep], object]) -> Callable[[_native.Substep], None]:
    def call(native: _native.Substep) -> None:
        hook(Substep(native))

    call.__qualname__ = getattr(hook, "__qualname__", type(hook).__qualname__)
    return call


def _project(
    project: Callable[[Projection], npt.ArrayLike | None],
) -> Callable[[_native.Projection], Doubles | None]:
    def call(native: _native.Projection) -> Doubles | None:
        wanted = project(Projection(native))
        return None if wanted is None else points(wanted, "displacements", ValueError)

    return call
