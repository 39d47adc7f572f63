"""Hold a boat in waves."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..._scene import Scene
from ..._simulation import Simulation
from ._task import FRAMES_PER_SECOND, Memory, Task

LENGTH, DEPTH = 4.0, 0.5
PLACE = 2.2
"""Where the boat is to be held [m]."""
THRUST = 60.0
"""Largest thrust [N]."""
LOST = 1.2
"""Way from its place at which an episode ends [m]."""


class BoatTask(Task):
    """Hold a boat at its place in waves, with a screw that pushes forwards and backwards.

    A paddle at the left end makes waves, of a phase and strength of its own in every episode, that drive the boat off.

    Action: thrust (of 60 N, positive to the right). State: place beside where it is to be [m], velocity [m/s], angle [rad],
    angular velocity [rad/s], height above the water at rest [m] and velocity [m/s], velocity of the paddle [m/s]. Reward: 1
    for every frame, less the square of the way over 0.4 m, at most 1, and a twentieth of the square of the action. The
    episode ends when the boat is 1.2 m away, or has capsized.
    """

    name = "boat"
    highest = (LENGTH, 10.0, 3.2, 10.0, 1.0, 10.0, 2.0)
    settling = 60
    view = ((0.0, 0.0), (LENGTH, 1.2))

    def scene(self) -> Scene:
        scene = Scene(name="Boat", spacing=0.06, fps=FRAMES_PER_SECOND)
        scene.add_liquid("water", xsph=0.02)
        scene.add_block("water", min=(0.18, 0), max=(LENGTH, DEPTH))
        scene.add_tank(min=(-0.6, 0), max=(LENGTH, 1.6))
        hull = [[-0.3, 0.12], [-0.2, -0.12], [0.2, -0.12], [0.3, 0.12]]
        scene.add_body("boat", at=(PLACE, DEPTH + 0.02), outline=hull, density=400.0)
        scene.add_body("paddle", at=(0.04, 0.55), size=(0.24, 1.1), kind="kinematic")
        return scene

    def begin(self, sim: Simulation, random: np.random.Generator) -> Memory:
        x, y = (float(part) for part in sim.bodies["boat"].position)
        with sim.edit() as edit:
            edit.bodies["boat"].velocity = (random.uniform(-0.2, 0.2), 0.0)
        return {"level": y, "start": sim.time, "phase": random.uniform(0.0, 2.0 * np.pi), "paddle": 0.0,
                "strength": random.uniform(0.25, 0.45), "frequency": random.uniform(0.8, 1.1)}

    def act(self, sim: Simulation, memory: Memory, action: npt.NDArray[np.float32]) -> None:
        t = sim.time - memory["start"]
        wave = np.sin(2.0 * np.pi * memory["frequency"] * t + memory["phase"]) * min(t, 1.0)
        # It never drifts off: its mean place is where it began.
        back = 0.04 - float(sim.bodies["paddle"].position[0])
        memory["paddle"] = float(np.clip(memory["strength"] * wave + 0.5 * back, -1.0, 1.0))
        with sim.edit() as edit:
            edit.bodies["paddle"].velocity = (memory["paddle"], 0.0)
            edit.bodies["boat"].push((THRUST * float(action[0]) * sim.frame_time, 0.0))

    def outcome(
        self, sim: Simulation, memory: Memory, action: npt.NDArray[np.float32]
    ) -> tuple[float, bool, dict[str, Any]]:
        boat = sim.bodies["boat"]
        way = float(boat.position[0]) - PLACE
        reward = 1.0 - min((way / 0.4) ** 2, 1.0) - 0.05 * float(action[0]) ** 2
        return reward, abs(way) > LOST or abs(boat.angle) > 1.2, {"way": way}

    def state(self, sim: Simulation, memory: Memory) -> list[float]:
        boat = sim.bodies["boat"]
        (x, y), (vx, vy) = boat.position, boat.velocity
        return [x - PLACE, vx, boat.angle, boat.angular_velocity, y - memory["level"], vy, memory["paddle"]]

    def info(self, sim: Simulation, memory: Memory) -> dict[str, Any]:
        return {"way": float(sim.bodies["boat"].position[0]) - PLACE}
