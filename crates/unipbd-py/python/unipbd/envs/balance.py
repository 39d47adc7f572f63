"""Keep a top-heavy float upright."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._scene import Scene
from .._substep import Substep
from ._world import Vector, World

WIDTH, HEIGHT, DENSITY = 0.4, 0.52, 500.0
"""Of the float [m], [m], [kg/m^2]: it floats half immersed, and capsizes when left alone."""
TORQUE = 40.0
"""Largest torque [N m]."""
FALLEN = 0.6
"""Angle at which an episode ends [rad]."""
DEPTH, POOL = 0.6, 2.0


def _scene() -> Scene:
    scene = Scene(name="Balance", spacing=0.06, fps=20)
    scene.add_liquid("water", xsph=0.05)
    scene.add_block("water", min=(0, 0), max=(POOL, DEPTH))
    scene.add_tank(min=(0, 0), max=(POOL, 1.6))
    scene.add_body("float", at=(POOL / 2, DEPTH), size=(WIDTH, HEIGHT), density=DENSITY)
    return scene


class Balance(World):
    """Keep a top-heavy float upright with a torque, on water that moves.

    Its centre of mass lies above its metacentre: left alone it capsizes within seconds. The water
    starts with a random sway.

    Action, shape (1,): torque, -1 to 1 (of 40 N m, positive counter-clockwise).
    Observation, shape (6,): angle [rad], angular velocity [rad/s], place beside the middle of the
    pool [m] and velocity [m/s], height above where it floats at rest [m] and velocity [m/s].
    Reward: 1 for every frame, less the square of the angle over 0.6 rad and a twentieth of the
    square of the action. The episode ends when the float leans by 0.6 rad. 20 frames per second.
    """

    def __init__(self, render_mode: str | None = None) -> None:
        super().__init__(_scene(), [1.0, 10.0, POOL, 10.0, 1.0, 10.0], render_mode)
        self._torque = 0.0
        self.simulation.on_substep(self._turn)
        self._float = self.simulation.bodies["float"]
        self._come_to_rest()
        self._level = float(self._float.position[1])

    def _turn(self, substep: Substep) -> None:
        if self._torque:
            substep.bodies["float"].push(torque=self._torque)

    def _come_to_rest(self) -> None:
        """Lets float and water settle, held upright, and starts from there."""
        for _ in range(60):
            self._torque = float(np.clip(-300.0 * self._float.angle - 40.0 * self._float.angular_velocity, -200, 200))
            self.simulation.step()
        with self.simulation.edit() as edit:
            edit.bodies["float"].velocity = (0.0, 0.0)
            edit.bodies["float"].angular_velocity = 0.0
        self._start = self.simulation.state()

    def _observe(self) -> Vector:
        body = self._float
        (x, y), (vx, vy) = body.position, body.velocity
        seen = [body.angle, body.angular_velocity, x - POOL / 2, vx, y - self._level, vy]
        return self._within(seen)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Vector, dict[str, Any]]:
        """Starts anew with a random sway of the water and a random turn of the float."""
        super().reset(seed=seed)
        self._torque = 0.0
        self.simulation.restore(self._start)
        with self.simulation.edit() as edit:
            edit.velocities[:] = (self.np_random.uniform(-0.2, 0.2), 0.0)
            edit.bodies["float"].angular_velocity = self.np_random.uniform(-0.3, 0.3)
        return self._observe(), {}

    def step(self, action: Vector) -> tuple[Vector, float, bool, bool, dict[str, Any]]:
        """One frame with this torque."""
        torque = float(np.clip(action[0], -1.0, 1.0))
        self._torque = TORQUE * torque
        self.simulation.step()
        lean = self._float.angle / FALLEN
        reward = 1.0 - min(lean * lean, 1.0) - 0.05 * torque * torque
        return self._observe(), reward, abs(lean) >= 1.0, False, {}
