"""Many worlds with a task, stepped together."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
from gymnasium import spaces
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from .._batch import Batch
from .._errors import SolverError
from ._observation import Observation, Vector
from ._single import METADATA, checked_render_mode, named, scene_of
from ._starts import settled
from .tasks import Memory

Flags = npt.NDArray[np.bool_]
Frames: TypeAlias = dict[int, Callable[[], None]]
"""What waits for the frame of each world."""


class BatchEnv(VectorEnv[Vector, Vector, npt.NDArray[Any]]):
    """A task in many worlds at once, on all processors::

        envs = gymnasium.make_vec("unipbd/Stir-v0", num_envs=16, vectorization_mode="vector_entry_point")

    Each world is bit for bit what `TaskEnv` with its seed is. Worlds that ended are reset by themselves in the next
    step, in the same one or not at all (`autoreset_mode`); ``options={"reset_mask": mask}`` of `reset` resets some.

    `parameters` sets keys of the scenes: one value for all, or a list with one for each world, by the path of the key.
    `threads` never change results.
    """

    metadata = METADATA

    def __init__(
        self,
        task: str,
        num_envs: int = 1,
        render_mode: str | None = None,
        observation: str = "state",
        shape: tuple[int, int] = (16, 12),
        parameters: Mapping[str, Any] | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        max_episode_steps: int | None = None,
        threads: int | None = None,
    ) -> None:
        self.render_mode = checked_render_mode(render_mode)
        self.task = named(task)
        self.num_envs = num_envs
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {**METADATA, "autoreset_mode": self.autoreset_mode}
        self.horizon = self.task.horizon if max_episode_steps is None else max_episode_steps
        scenes = [scene_of(self.task, values) for values in _by_world(parameters or {}, num_envs)]
        self.batch = Batch(scenes, seeds=[0] * num_envs, threads=threads)
        self._starts = [settled(self.task, scene) for scene in scenes]
        self._looks = [Observation(self.task, observation, shape, sim) for sim in self.batch]
        if len({look.space.shape for look in self._looks}) > 1:
            raise ValueError("the worlds differ in the number of particles: points can not be stacked")
        self.single_action_space = spaces.Box(-1.0, 1.0, (self.task.actions,), np.float32)
        self.single_observation_space = self._looks[0].space
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._memories: list[Memory] = [{} for _ in range(num_envs)]
        self._random: list[np.random.Generator | None] = [None] * num_envs
        self._steps = np.zeros(num_envs, dtype=np.int64)
        self._over = np.zeros(num_envs, dtype=bool)
        self._seen = np.zeros((num_envs, *self.single_observation_space.shape), dtype=np.float32)

    # -- resetting -----------------------------------------------------------------------------

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Vector, dict[str, Any]]:
        """Starts all worlds anew, or those of ``options["reset_mask"]``. `seed` is the seed of the first world, the
        others have the next ones, or one for each."""
        seeds = _seeds(seed, self.num_envs)
        mask = self._mask(options)
        infos: dict[str, Any] = {}
        for number in np.flatnonzero(mask):
            if seeds[number] is not None:
                self._random[number] = seeding.np_random(seeds[number])[0]
            infos = self._add_info(infos, self._begin(int(number)), int(number))
        return self._seen.copy(), infos

    def _mask(self, options: dict[str, Any] | None) -> Flags:
        mask = (options or {}).get("reset_mask")
        if mask is None:
            return np.ones(self.num_envs, dtype=bool)
        if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
            raise TypeError("reset_mask must be an array of bool")
        if mask.shape != (self.num_envs,) or not mask.any():
            raise ValueError(f"reset_mask must have shape ({self.num_envs},) and reset at least one world")
        return mask

    def _begin(self, number: int) -> dict[str, Any]:
        """Starts a world anew; its info."""
        world = self.batch[number]
        random = self._random[number]
        if random is None:
            random = self._random[number] = seeding.np_random()[0]
        world.restore(self._starts[number])
        self._memories[number] = self.task.begin(world, random)
        self._steps[number], self._over[number] = 0, False
        self._seen[number] = self._looks[number].of(world, self._memories[number])
        return self.task.info(world, self._memories[number])

    # -- stepping ------------------------------------------------------------------------------

    def step(
        self, actions: Vector
    ) -> tuple[Vector, npt.NDArray[Any], npt.NDArray[Any], npt.NDArray[Any], dict[str, Any]]:
        """One frame of all worlds."""
        actions = np.clip(np.asarray(actions, dtype=np.float32), -1.0, 1.0)
        if actions.shape != (self.num_envs, self.task.actions):
            raise ValueError(f"actions must have shape ({self.num_envs}, {self.task.actions}), not {actions.shape}")
        if self.autoreset_mode is AutoresetMode.DISABLED and self._over.any():
            stopped = np.flatnonzero(self._over).tolist()
            raise RuntimeError(f"worlds {stopped} have ended: reset them with options={{'reset_mask': mask}}")
        anew = self._over.copy()
        running = np.flatnonzero(~anew).tolist()
        frames = self._begin_frames(running, actions)
        rewards = np.zeros(self.num_envs)
        ended, late = np.zeros(self.num_envs, dtype=bool), np.zeros(self.num_envs, dtype=bool)
        infos: dict[str, Any] = {}
        try:
            for number in range(self.num_envs):
                if anew[number]:
                    info = self._begin(number)
                else:
                    info, rewards[number], ended[number] = self._judge(number, actions[number], frames.pop(number))
                    late[number] = self._steps[number] >= self.horizon
                    if (ended[number] or late[number]) and self.autoreset_mode is AutoresetMode.SAME_STEP:
                        last = {"final_obs": self._seen[number].copy(), "final_info": info}
                        infos = self._add_info(infos, last, number)
                        info = self._begin(number)
                infos = self._add_info(infos, info, number)
        finally:
            _wait_for(frames)
        if self.autoreset_mode is not AutoresetMode.SAME_STEP:
            self._over = ended | late
        return self._seen.copy(), rewards, ended, late, infos

    def _begin_frames(self, running: list[int], actions: Vector) -> Frames:
        """Acts in each of these worlds and starts its frame: while some are stepped others are acted in, and looked at."""
        frames: Frames = {}
        try:
            for number in running:
                self.task.act(self.batch[number], self._memories[number], actions[number])
                frames[number] = self.batch.begin(number)
        except BaseException:
            _wait_for(frames)
            raise
        return frames

    def _judge(self, number: int, action: Vector, frame: Callable[[], None]) -> tuple[dict[str, Any], float, bool]:
        self._steps[number] += 1
        try:
            frame()
        except SolverError:
            self._seen[number] = 0.0
            return {"diverged": True}, 0.0, True
        world, memory = self.batch[number], self._memories[number]
        reward, ended, info = self.task.outcome(world, memory, action)
        self._seen[number] = self._looks[number].of(world, memory)
        return info, float(reward), bool(ended)

    def render(self) -> tuple[npt.NDArray[np.uint8], ...] | None:
        """The present frame of every world, with ``render_mode="rgb_array"``."""
        return tuple(world.render(width=320) for world in self.batch) if self.render_mode == "rgb_array" else None


def _wait_for(frames: Frames) -> None:
    """Waits for frames that an exception left under way."""
    for frame in frames.values():
        with contextlib.suppress(SolverError):
            frame()


def _seeds(seed: int | Sequence[int | None] | None, count: int) -> list[int | None]:
    if seed is None:
        return [None] * count
    if isinstance(seed, (int, np.integer)):
        return [int(seed) + number for number in range(count)]
    if len(seed) != count:
        raise ValueError(f"there are {len(seed)} seeds for {count} worlds")
    return list(seed)


def _by_world(parameters: Mapping[str, Any], count: int) -> list[dict[str, Any]]:
    """The values of each world: a list or array has one for each."""
    worlds: list[dict[str, Any]] = [{} for _ in range(count)]
    for path, values in parameters.items():
        own = isinstance(values, (list, np.ndarray))
        if own and len(values) != count:
            raise ValueError(f"{path}: there are {len(values)} values for {count} worlds")
        for number, world in enumerate(worlds):
            world[path] = values[number] if own else values
    return worlds
