"""Pour water over a wall by tilting its vessel."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..._scene import Scene
from ..._simulation import Simulation
from .._cells import Cells
from ._task import FRAMES_PER_SECOND, Memory, Task

COLUMNS = 12
STEEPEST = float(np.radians(80.0))
"""Largest tilt [rad]."""
FASTEST = float(np.radians(180.0))
"""Largest rate of tilt [rad/s]."""
WIDTH, WALL = 2.1, 1.05
CELLS = Cells((0.0, -100.0), (WIDTH, 100.0), (COLUMNS, 1))


class PourTask(Task):
    """Pour water over the wall to the right, then set the vessel upright.

    The vessel is tilted by turning gravity, as one feels it who tilts with the vessel.

    Action: how fast to tilt (of 180 degrees per second, positive to the right). State: tilt [rad], share of the water on
    the right, mean velocity [m/s], and the share of the water in each of twelve columns. Reward: ten times the share that
    was poured in the frame, less a hundredth of the tilt over its largest. The episode ends when four fifths are poured
    and the vessel is upright.
    """

    name = "pour"
    horizon = 100
    highest = (1.5, 1.0, 10.0, 10.0, *COLUMNS * (1.0,))
    settling = 20
    view = ((0.0, 0.0), (WIDTH, 1.5))

    def scene(self) -> Scene:
        scene = Scene(name="Pour", spacing=0.06, fps=FRAMES_PER_SECOND)
        scene.add_liquid("water")
        scene.add_block("water", min=(0, 0), max=(0.9, 0.6))
        scene.add_tank(min=(0, 0), max=(WIDTH, 2))
        scene.add_obstacle(min=(0.96, 0), max=(1.14, 0.72))
        return scene

    def begin(self, sim: Simulation, random: np.random.Generator) -> Memory:
        with sim.edit() as edit:
            edit.velocities[:] = random.uniform(-0.1, 0.1, 2)
        return {"tilt": 0.0, "poured": self._share(sim), "gravity": float(np.hypot(*sim.gravity))}

    def _share(self, sim: Simulation) -> float:
        return float(np.count_nonzero(sim.positions[:, 0] > WALL)) / len(sim)

    def act(self, sim: Simulation, memory: Memory, action: npt.NDArray[np.float32]) -> None:
        turned = memory["tilt"] + float(action[0]) * FASTEST * sim.frame_time
        tilt = memory["tilt"] = float(np.clip(turned, -STEEPEST, STEEPEST))
        with sim.edit() as edit:
            edit.gravity = (memory["gravity"] * np.sin(tilt), -memory["gravity"] * np.cos(tilt))

    def outcome(
        self, sim: Simulation, memory: Memory, action: npt.NDArray[np.float32]
    ) -> tuple[float, bool, dict[str, Any]]:
        poured, before = self._share(sim), memory["poured"]
        memory["poured"] = poured
        reward = 10.0 * (poured - before) - 0.01 * abs(memory["tilt"]) / STEEPEST
        return reward, poured > 0.8 and abs(memory["tilt"]) < 0.1, {"poured": poured}

    def state(self, sim: Simulation, memory: Memory) -> list[float]:
        x = sim.positions
        columns = CELLS.sums(CELLS.numbers(x)) / len(x)
        return [memory["tilt"], memory["poured"], *(sim.velocities.sum(axis=0) / len(x)).tolist(), *columns.tolist()]

    def info(self, sim: Simulation, memory: Memory) -> dict[str, Any]:
        return {"poured": memory["poured"]}
