"""What an agent is shown: the numbers of a task, or the particles as a grid, a point set or probes."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from .._simulation import Simulation
from ._cells import Cells
from .tasks import Memory, Task

Vector: TypeAlias = npt.NDArray[np.float32]
MODES = ("state", "grid", "points", "probes")
FASTEST = 20.0
"""Speeds are cut there [m/s]."""


class Observation:
    """Turns a world into an array of one shape.

    - ``state``: the numbers of the task, shape (S,).
    - ``grid``: for each cell of a grid over the view the filled part, and the mean velocity [m/s]: shape (3, rows,
      columns), the lowest row first.
    - ``points``: for each particle its place in the view, 0 to 1 from the lower left, and velocity [m/s]: shape (N, 4).
    - ``probes``: in the middle of each cell, row by row, the filled part and the velocity [m/s] around: shape (P, 3).

    Bodies count as particles.
    """

    def __init__(self, task: Task, mode: str, shape: tuple[int, int], sim: Simulation) -> None:
        if mode not in MODES:
            raise ValueError(f"observation is one of {', '.join(MODES)}, not {mode!r}")
        self.task, self.mode = task, mode
        self.columns, self.rows = shape
        self.low, self.high = (np.array(corner) for corner in task.view)
        self.count = len(sim)
        self.cells = Cells(self.low, self.high, shape)
        self.space = self._space()

    def _space(self) -> spaces.Box:
        if self.mode == "state":
            high = np.array(self.task.highest, dtype=np.float32)
            return spaces.Box(-high, high, dtype=np.float32)
        shape = {"grid": (3, self.rows, self.columns), "points": (self.count, 4), "probes": (self.cells.count, 3)}
        low, high = np.full(shape[self.mode], -FASTEST, np.float32), np.full(shape[self.mode], FASTEST, np.float32)
        first = (0,) if self.mode == "grid" else (..., 0)
        low[first], high[first] = (0.0, 2.0) if self.mode != "points" else (-10.0, 10.0)
        if self.mode == "points":
            low[..., 1], high[..., 1] = -10.0, 10.0
        return spaces.Box(low, high, dtype=np.float32)

    def of(self, sim: Simulation, memory: Memory) -> Vector:
        """The observation now."""
        if self.mode == "state":
            seen = np.asarray(self.task.state(sim, memory), dtype=np.float64)
        elif self.mode == "points":
            seen = np.concatenate([(sim.positions - self.low) / (self.high - self.low), sim.velocities], axis=1)
        else:
            seen = self._grid(sim) if self.mode == "grid" else self._probes(sim)
        return np.minimum(np.maximum(seen, self.space.low), self.space.high, dtype=np.float32, casting="same_kind")

    def _grid(self, sim: Simulation) -> npt.NDArray[np.float64]:
        number, v = self.cells.numbers(sim.positions), sim.velocities
        count = self.cells.sums(number)
        # Empty cells have no velocity.
        share = 1.0 / np.maximum(count, 1.0)
        fill = count * (sim.spacing**2 / float(self.cells.size.prod()))
        seen = np.stack([fill, self.cells.sums(number, v[:, 0]) * share, self.cells.sums(number, v[:, 1]) * share])
        return seen.reshape(3, self.rows, self.columns)

    def _probes(self, sim: Simulation) -> npt.NDArray[np.float64]:
        radius, size = 2.0 * sim.spacing, self.cells.size
        # Where a particle lies in the lattice of the probes, and the first that is near it, along both axes.
        place = (sim.positions - self.low) / size - 0.5
        first = np.ceil(place - radius / size)
        near = [first[:, axis, None] + np.arange(int(2.0 * radius / size[axis]) + 1) for axis in range(2)]
        apart = [((near[axis] - place[:, axis, None]) * (size[axis] / radius)) ** 2 for axis in range(2)]
        weight = np.maximum(0.0, 1.0 - apart[1][:, :, None] - apart[0][:, None, :])
        inside = [(near[axis] >= 0) & (near[axis] < self.cells.shape[axis]) for axis in range(2)]
        number = near[1][:, :, None] * self.columns + near[0][:, None, :]
        number = np.where(inside[1][:, :, None] & inside[0][:, None, :], number, self.cells.count).astype(np.intp).ravel()
        whole = self.cells.sums(number, weight.ravel())
        sums = [self.cells.sums(number, (weight * v[:, None, None]).ravel()) for v in sim.velocities.T]
        mean = np.stack(sums, axis=1) / np.maximum(whole, 1e-9)[:, None]
        # A full neighbourhood weighs pi/2 (radius/spacing)^2.
        return np.concatenate([whole[:, None] / (0.5 * np.pi * 4.0), mean], axis=1)
