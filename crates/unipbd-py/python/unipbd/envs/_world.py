"""What the environments have in common: a simulation that goes back to its start."""

from __future__ import annotations

from typing import Any, TypeAlias

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from .._scene import Scene
from .._simulation import Simulation

Vector: TypeAlias = npt.NDArray[np.float32]


class World(gymnasium.Env[Vector, Vector]):
    """One action from -1 to 1 per frame, a vector of numbers to look at, a picture."""

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 20}

    def __init__(self, scene: Scene, highest: npt.ArrayLike, render_mode: str | None) -> None:
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise ValueError(f"render_mode is None or 'rgb_array', not {render_mode!r}")
        high = np.asarray(highest, dtype=np.float32)
        self.render_mode = render_mode
        self.action_space = spaces.Box(-1.0, 1.0, (1,), np.float32)
        self.observation_space = spaces.Box(-high, high, dtype=np.float32)
        self.simulation: Simulation = scene.build(seed=0, threads=1)
        self._high = high
        self._start = self.simulation.state()

    def _within(self, observation: npt.ArrayLike) -> Vector:
        """What lies in the observation space."""
        return np.clip(np.asarray(observation, dtype=np.float32), -self._high, self._high)

    def render(self) -> npt.NDArray[np.uint8] | None:
        """The present frame, uint8, shape (height, width, 3), with ``render_mode="rgb_array"``."""
        return self.simulation.render(width=320) if self.render_mode == "rgb_array" else None
