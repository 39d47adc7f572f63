"""Mix two liquids with a paddle."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..._scene import Scene
from ..._simulation import Simulation
from .._cells import Cells
from ._task import FRAMES_PER_SECOND, Memory, Task

WIDTH, DEPTH = 1.2, 0.72
CELLS = Cells((0.0, 0.0), (WIDTH, DEPTH + 0.12), (5, 3))
"""Cells in which the mixture is judged."""
FASTEST = 1.0
"""Largest speed of the paddle [m/s]."""
ROOM = ((0.2, 0.2), (1.0, 0.6))
"""Where the middle of the paddle may go [m]."""


class StirTask(Task):
    """Mix a red and a blue liquid that lie side by side, with a paddle.

    Action: velocity of the paddle (of 1 m/s, right and up). State: place of the paddle over the width, its velocity [m/s],
    how unmixed the liquids are, and the share of red in each of 15 cells, less a half. Reward: ten times what the
    liquids mixed in the frame, less a hundredth of the square of the action. The episode ends when they are mixed to
    nine tenths.
    """

    name = "stir"
    actions = 2
    highest = (1.0, 1.0, 2.0, 2.0, 1.0, *CELLS.count * (1.0,))
    settling = 10
    view = ((0.0, 0.0), (WIDTH, 1.0))

    def scene(self) -> Scene:
        scene = Scene(name="Stir", spacing=0.04, fps=FRAMES_PER_SECOND)
        scene.add_liquid("red", xsph=0.02)
        scene.add_liquid("blue", xsph=0.02)
        scene.add_block("red", min=(0, 0), max=(WIDTH / 2, DEPTH))
        scene.add_block("blue", min=(WIDTH / 2, 0), max=(WIDTH, DEPTH))
        scene.add_tank(min=(0, 0), max=(WIDTH, 1.2))
        scene.add_body("paddle", at=(WIDTH / 2, 0.4), size=(0.08, 0.28), kind="kinematic")
        return scene

    def begin(self, sim: Simulation, random: np.random.Generator) -> Memory:
        with sim.edit() as edit:
            edit.velocities[:] = random.uniform(-0.1, 0.1, 2)
        return {"unmixed": self._unmixed(sim)}

    def _cells(self, sim: Simulation) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Particles and share of red, the first liquid of the scene, in each cell."""
        fluid = sim.phases == 0
        number, red = CELLS.numbers(sim.positions[fluid]), sim.material_indices[fluid] == 0
        both, ours = CELLS.sums(number), CELLS.sums(number[red])
        return both, np.where(both > 0.0, ours / np.maximum(both, 1.0), 0.5)

    def _unmixed(self, sim: Simulation) -> float:
        """Variance of the share of red over that of separate liquids: 1 apart, 0 mixed."""
        count, share = self._cells(sim)
        return float(4.0 * np.dot((share - 0.5) ** 2, count) / count.sum())

    def act(self, sim: Simulation, memory: Memory, action: npt.NDArray[np.float32]) -> None:
        place = sim.bodies["paddle"].position
        goal = np.clip(place + FASTEST * np.asarray(action, dtype=np.float64) * sim.frame_time, *ROOM)
        with sim.edit() as edit:
            edit.bodies["paddle"].velocity = (goal - place) / sim.frame_time

    def outcome(
        self, sim: Simulation, memory: Memory, action: npt.NDArray[np.float32]
    ) -> tuple[float, bool, dict[str, Any]]:
        before, now = memory["unmixed"], self._unmixed(sim)
        memory["unmixed"] = now
        reward = 10.0 * (before - now) - 0.01 * float(np.dot(action, action))
        return reward, now < 0.1, {"unmixed": now}

    def state(self, sim: Simulation, memory: Memory) -> list[float]:
        paddle = sim.bodies["paddle"]
        _, share = self._cells(sim)
        return [*(paddle.position / WIDTH).tolist(), *paddle.velocity.tolist(), memory["unmixed"], *(share - 0.5).tolist()]

    def info(self, sim: Simulation, memory: Memory) -> dict[str, Any]:
        return {"unmixed": memory["unmixed"]}
