"""What an agent is shown: the numbers of a task, or the particles as a grid, a point set or probes."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from .._simulation import Simulation
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
    - ``probes``: at points of a regular lattice the filled part and the velocity [m/s] around: shape (P, 3).

    Bodies count as particles.
    """

    def __init__(self, task: Task, mode: str, shape: tuple[int, int], sim: Simulation) -> None:
        if mode not in MODES:
            raise ValueError(f"observation is one of {', '.join(MODES)}, not {mode!r}")
        self.task, self.mode = task, mode
        self.columns, self.rows = shape
        self.low, self.high = (np.array(corner) for corner in task.view)
        self.count = len(sim)
        places = np.stack(np.meshgrid(
            (np.arange(self.columns) + 0.5) / self.columns, (np.arange(self.rows) + 0.5) / self.rows), axis=-1)
        self.probes = self.low + places.reshape(-1, 2) * (self.high - self.low)
        self.space = self._space()

    def _space(self) -> spaces.Box:
        if self.mode == "state":
            high = np.array(self.task.highest, dtype=np.float32)
            return spaces.Box(-high, high, dtype=np.float32)
        shape = {"grid": (3, self.rows, self.columns), "points": (self.count, 4), "probes": (len(self.probes), 3)}
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
        return np.clip(seen, self.space.low, self.space.high).astype(np.float32)

    def _grid(self, sim: Simulation) -> npt.NDArray[np.float64]:
        cell = (self.high - self.low) / (self.columns, self.rows)
        place = np.floor((sim.positions - self.low) / cell).astype(int)
        inside = ((place >= 0) & (place < (self.columns, self.rows))).all(axis=1)
        number = place[inside, 1] * self.columns + place[inside, 0]
        count = np.bincount(number, minlength=self.rows * self.columns).astype(np.float64)
        v = sim.velocities[inside]
        sums = [np.bincount(number, weights=v[:, axis], minlength=len(count)) for axis in range(2)]
        mean = [total / np.maximum(count, 1.0) for total in sums]
        fill = count * sim.spacing**2 / (cell[0] * cell[1])
        return np.stack([fill, *mean]).reshape(3, self.rows, self.columns)

    def _probes(self, sim: Simulation) -> npt.NDArray[np.float64]:
        radius = 2.0 * sim.spacing
        square = ((self.probes[:, None] - sim.positions[None]) ** 2).sum(axis=2) / radius**2
        weight = np.maximum(0.0, 1.0 - square)
        whole = weight.sum(axis=1)
        mean = (weight @ sim.velocities) / np.maximum(whole, 1e-9)[:, None]
        # A full neighbourhood weighs pi/2 (radius/spacing)^2.
        return np.concatenate([whole[:, None] / (0.5 * np.pi * 4.0), mean], axis=1)
