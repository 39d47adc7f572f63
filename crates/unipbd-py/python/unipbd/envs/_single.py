"""One world with a task."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from .._errors import SolverError
from .._paths import assign
from .._scene import Scene
from .._simulation import Simulation
from ._observation import Observation, Vector
from ._starts import settled
from .tasks import TASKS, Task

METADATA: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 20}


class TaskEnv(gymnasium.Env[Vector, Vector]):
    """A task as a Gymnasium environment: ``gymnasium.make("unipbd/Stir-v0")``.

    `observation` is ``"state"``, ``"grid"``, ``"points"`` or ``"probes"``; grids and probes have `shape` columns and
    rows. `parameters` sets keys of the scene by their paths, such as ``{"liquid.water.density": 900.0}``. Episodes repeat
    bit for bit with the same seed and actions.
    """

    metadata = METADATA

    def __init__(
        self,
        task: str,
        render_mode: str | None = None,
        observation: str = "state",
        shape: tuple[int, int] = (16, 12),
        parameters: Mapping[str, Any] | None = None,
    ) -> None:
        self.render_mode = checked_render_mode(render_mode)
        self.task = named(task)
        scene = scene_of(self.task, parameters or {})
        self.simulation = Simulation(scene, seed=0, threads=1)
        self._start = settled(self.task, scene)
        self._look = Observation(self.task, observation, shape, self.simulation)
        self.action_space = spaces.Box(-1.0, 1.0, (self.task.actions,), np.float32)
        self.observation_space = cast("spaces.Space[Vector]", self._look.space)
        self._memory: dict[str, float] = {}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Vector, dict[str, Any]]:
        """Starts anew from the settled start, varied at random."""
        super().reset(seed=seed)
        self.simulation.restore(self._start)
        self._memory = self.task.begin(self.simulation, self.np_random)
        return self._look.of(self.simulation, self._memory), self.task.info(self.simulation, self._memory)

    def step(self, action: Vector) -> tuple[Vector, float, bool, bool, dict[str, Any]]:
        """One frame with this action. A world that diverges ends its episode, with ``diverged`` in the info."""
        action = np.clip(np.asarray(action, dtype=np.float32), -1.0, 1.0)
        self.task.act(self.simulation, self._memory, action)
        try:
            self.simulation.step()
        except SolverError:
            return np.zeros(self._look.space.shape, np.float32), 0.0, True, False, {"diverged": True}
        reward, ended, info = self.task.outcome(self.simulation, self._memory, action)
        return self._look.of(self.simulation, self._memory), float(reward), bool(ended), False, info

    def render(self) -> npt.NDArray[np.uint8] | None:
        """The present frame, uint8, shape (height, width, 3), with ``render_mode="rgb_array"``."""
        return self.simulation.render(width=320) if self.render_mode == "rgb_array" else None


def named(task: str) -> Task:
    """The task of this name."""
    if task not in TASKS:
        raise ValueError(f"there is no task {task!r}; there are {', '.join(TASKS)}")
    return TASKS[task]()


def scene_of(task: Task, parameters: Mapping[str, Any]) -> Scene:
    """The scene of a task with these values."""
    data = task.scene().to_dict()
    for path, value in parameters.items():
        assign(data, path, value, path)
    return Scene.from_dict(data)


def checked_render_mode(render_mode: str | None) -> str | None:
    """A render mode that there is."""
    if render_mode not in (None, *METADATA["render_modes"]):
        raise ValueError(f"render_mode is None or 'rgb_array', not {render_mode!r}")
    return render_mode
