"""Pour water over a wall by tilting its vessel."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._scene import Scene
from .._substep import Substep
from ._world import Vector, World

COLUMNS = 12
STEEPEST = float(np.radians(80.0))
"""Largest tilt [rad]."""
FASTEST = float(np.radians(180.0))
"""Largest rate of tilt [rad/s]."""
GRAVITY = 9.81
WIDTH, WALL = 2.1, 1.05


def _scene() -> Scene:
    scene = Scene(name="Pour", spacing=0.06, fps=20)
    scene.add_liquid("water")
    scene.add_block("water", min=(0, 0), max=(0.9, 0.6))
    scene.add_tank(min=(0, 0), max=(WIDTH, 2))
    scene.add_obstacle(min=(0.96, 0), max=(1.14, 0.72))
    return scene


class Pour(World):
    """Pour water over the wall to the right, then set the vessel upright.

    The vessel is tilted by turning gravity, as one feels it who tilts with the vessel.

    Action, shape (1,): how fast to tilt, -1 to 1 (of 180 degrees per second, positive to the right).
    Observation, shape (16,): tilt [rad], share of the water on the right, mean velocity [m/s], and
    the share of the water in each of twelve columns.
    Reward: ten times the share that was poured since the last frame, less a hundredth of the tilt
    over its largest. The episode ends when four fifths are poured and the vessel is upright. 20
    frames per second.
    """

    def __init__(self, render_mode: str | None = None) -> None:
        super().__init__(_scene(), [1.5, 1.0, 10.0, 10.0] + COLUMNS * [1.0], render_mode)
        self._tilt = 0.0
        self._poured = 0.0
        self.simulation.on_substep(self._lean)

    def _lean(self, substep: Substep) -> None:
        turned = (GRAVITY * np.sin(self._tilt), GRAVITY * (1.0 - np.cos(self._tilt)))
        substep.add_acceleration(turned)

    def _share(self) -> float:
        return float(np.mean(self.simulation.positions[:, 0] > WALL))

    def _observe(self) -> Vector:
        x = self.simulation.positions[:, 0]
        columns, _ = np.histogram(x, bins=COLUMNS, range=(0.0, WIDTH))
        mean = self.simulation.velocities.mean(axis=0)
        return self._within(np.concatenate([[self._tilt, self._poured], mean, columns / len(x)]))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Vector, dict[str, Any]]:
        """Starts anew, all water on the left, with a random sway."""
        super().reset(seed=seed)
        self.simulation.restore(self._start)
        with self.simulation.edit() as edit:
            edit.velocities[:] = self.np_random.uniform(-0.1, 0.1, 2)
        self._tilt = 0.0
        self._poured = self._share()
        return self._observe(), {"poured": self._poured}

    def step(self, action: Vector) -> tuple[Vector, float, bool, bool, dict[str, Any]]:
        """One frame of tilting at this rate."""
        rate = float(np.clip(action[0], -1.0, 1.0)) * FASTEST
        self._tilt = float(np.clip(self._tilt + rate * self.simulation.frame_time, -STEEPEST, STEEPEST))
        self.simulation.step()
        poured, before = self._share(), self._poured
        self._poured = poured
        reward = 10.0 * (poured - before) - 0.01 * abs(self._tilt) / STEEPEST
        done = poured > 0.8 and abs(self._tilt) < 0.1
        return self._observe(), reward, done, False, {"poured": poured}
