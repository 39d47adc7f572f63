"""What a task is: a scene, a start, an action, an outcome. One world or many are run by `TaskEnv` and `BatchEnv`."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from ..._scene import Scene
from ..._simulation import Simulation

Memory = dict[str, float]
"""Numbers of an episode that are not in the simulation, such as a tilt."""
FRAMES_PER_SECOND = 20.0


class Task:
    """A task acts between frames alone, by edits: its worlds are stepped on all processors.

    Attributes:
        name: in messages. actions: numbers of an action, each from -1 to 1. horizon: frames of an episode.
        highest: largest size of each number of the state. settling: frames to come to rest, once.
        view: the part of the scene that grids and probes see: lower left and upper right corner [m].
    """

    name: ClassVar[str]
    actions: ClassVar[int] = 1
    horizon: ClassVar[int] = 200
    highest: ClassVar[tuple[float, ...]]
    settling: ClassVar[int] = 60
    view: ClassVar[tuple[tuple[float, float], tuple[float, float]]]

    def scene(self) -> Scene:
        """The scene, before parameters of a world are set."""
        raise NotImplementedError

    def settle(self, sim: Simulation) -> None:
        """Brings a new simulation to where episodes start from."""
        sim.step(self.settling)

    def begin(self, sim: Simulation, random: np.random.Generator) -> Memory:
        """Varies the start of an episode; returns its memory."""
        raise NotImplementedError

    def act(self, sim: Simulation, memory: Memory, action: npt.NDArray[np.float32]) -> None:
        """Does what the action says, before a frame."""
        raise NotImplementedError

    def outcome(
        self, sim: Simulation, memory: Memory, action: npt.NDArray[np.float32]
    ) -> tuple[float, bool, dict[str, Any]]:
        """Reward, whether the episode has ended, and further numbers, after a frame."""
        raise NotImplementedError

    def state(self, sim: Simulation, memory: Memory) -> list[float]:
        """The numbers to look at."""
        raise NotImplementedError

    def info(self, sim: Simulation, memory: Memory) -> dict[str, Any]:
        """Further numbers at the start."""
        return {}
