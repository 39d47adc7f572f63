"""Keep a top-heavy float upright."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..._scene import Scene
from ..._simulation import Simulation
from ._task import FRAMES_PER_SECOND, Memory, Task

TORQUE = 40.0
"""Largest torque [N m]."""
FALLEN = 0.6
"""Angle at which an episode ends [rad]."""
DEPTH, POOL = 0.6, 2.0


class BalanceTask(Task):
    """Keep a top-heavy float upright with a torque, on water that moves.

    Its centre of mass lies above its metacentre: left alone it capsizes within seconds.

    Action: torque (of 40 N m, positive counter-clockwise). State: angle [rad], angular velocity [rad/s], place beside the
    middle of the pool [m] and velocity [m/s], height above the water at rest [m] and velocity [m/s]. Reward: 1 for every
    frame, less the square of the angle over 0.6 rad and a twentieth of the square of the action. The episode ends when
    the float leans by 0.6 rad.
    """

    name = "balance"
    highest = (1.0, 10.0, POOL, 10.0, 1.0, 10.0)
    view = ((0.0, 0.0), (POOL, 1.2))

    def scene(self) -> Scene:
        scene = Scene(name="Balance", spacing=0.06, fps=FRAMES_PER_SECOND)
        scene.add_liquid("water", xsph=0.05)
        scene.add_block("water", min=(0, 0), max=(POOL, DEPTH))
        scene.add_tank(min=(0, 0), max=(POOL, 1.6))
        scene.add_body("float", at=(POOL / 2, DEPTH), size=(0.4, 0.52), density=500.0)
        return scene

    def settle(self, sim: Simulation) -> None:
        body = sim.bodies["float"]
        for _ in range(self.settling):
            self._turn(sim, float(np.clip(-300.0 * body.angle - 40.0 * body.angular_velocity, -200.0, 200.0)))
            sim.step()
        with sim.edit() as edit:
            edit.bodies["float"].velocity = (0.0, 0.0)
            edit.bodies["float"].angular_velocity = 0.0

    def begin(self, sim: Simulation, random: np.random.Generator) -> Memory:
        level = float(sim.bodies["float"].position[1])
        with sim.edit() as edit:
            edit.velocities[:] = (random.uniform(-0.2, 0.2), 0.0)
            edit.bodies["float"].angular_velocity = random.uniform(-0.3, 0.3)
        return {"level": level}

    def _turn(self, sim: Simulation, torque: float) -> None:
        body = sim.bodies["float"]
        with sim.edit() as edit:
            edit.bodies["float"].angular_velocity = body.angular_velocity + torque * sim.frame_time / body.inertia

    def act(self, sim: Simulation, memory: Memory, action: npt.NDArray[np.float32]) -> None:
        self._turn(sim, TORQUE * float(action[0]))

    def outcome(
        self, sim: Simulation, memory: Memory, action: npt.NDArray[np.float32]
    ) -> tuple[float, bool, dict[str, Any]]:
        lean = sim.bodies["float"].angle / FALLEN
        reward = 1.0 - min(lean * lean, 1.0) - 0.05 * float(action[0]) ** 2
        return reward, abs(lean) >= 1.0, {}

    def state(self, sim: Simulation, memory: Memory) -> list[float]:
        body = sim.bodies["float"]
        (x, y), (vx, vy) = body.position, body.velocity
        return [body.angle, body.angular_velocity, x - POOL / 2, vx, y - memory["level"], vy]
