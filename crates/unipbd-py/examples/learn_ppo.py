"""Learns to keep a float upright by PPO of stable-baselines3, in eight worlds that are stepped together.

    pip install "unipbd[gym,plot]" stable-baselines3
    python learn_ppo.py [steps] [curve.png]
"""

import sys
import time
from typing import Any

import numpy as np
import torch  # type: ignore[import-not-found,unused-ignore]
from matplotlib.figure import Figure
from stable_baselines3 import PPO  # type: ignore[import-not-found,unused-ignore]
from stable_baselines3.common.callbacks import BaseCallback  # type: ignore[import-not-found,unused-ignore]
from stable_baselines3.common.vec_env import VecEnv  # type: ignore[import-not-found,unused-ignore]

from unipbd.envs import BatchEnv

WORLDS, FRAMES = 8, 128


class Worlds(VecEnv):  # type: ignore[misc,unused-ignore]
    """The worlds as stable-baselines3 wants them: finished ones start anew in the same step."""

    def __init__(self, envs: BatchEnv) -> None:
        self.envs = envs
        super().__init__(envs.num_envs, envs.single_observation_space, envs.single_action_space)
        self.returns: list[float] = []
        self.lengths: list[int] = []
        self._total, self._length = np.zeros(envs.num_envs), np.zeros(envs.num_envs, dtype=int)

    def reset(self) -> Any:
        return self.envs.reset(seed=1)[0]

    def step_async(self, actions: Any) -> None:
        self._actions = actions

    def step_wait(self) -> Any:
        seen, rewards, ended, late, found = self.envs.step(self._actions)
        done = ended | late
        self._total += rewards
        self._length += 1
        infos: list[dict[str, Any]] = [{} for _ in range(self.envs.num_envs)]
        for world in np.flatnonzero(done):
            infos[world]["terminal_observation"] = found["final_obs"][world]
            infos[world]["TimeLimit.truncated"] = bool(late[world] and not ended[world])
            self.returns.append(float(self._total[world]))
            self.lengths.append(int(self._length[world]))
        self._total[done], self._length[done] = 0.0, 0
        return seen, rewards.astype(np.float32), done, infos

    def close(self) -> None:
        self.envs.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return [getattr(self.envs, attr_name)] * self.envs.num_envs

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        setattr(self.envs, attr_name, value)

    def env_method(self, method_name: str, *arguments: Any, indices: Any = None, **named: Any) -> list[Any]:
        return [getattr(self.envs, method_name)(*arguments, **named)]

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        return [False] * self.envs.num_envs


def evaluate(model: Any, episodes: int) -> float:
    """Mean return on water that it has not seen, without noise."""
    envs = BatchEnv("balance", episodes)
    seen, _ = envs.reset(seed=1000)
    total, running = np.zeros(episodes), np.ones(episodes, dtype=bool)
    while running.any():
        actions, _ = model.predict(seen, deterministic=True)
        seen, rewards, ended, late, _ = envs.step(actions)
        total += np.where(running, rewards, 0.0)
        running &= ~(ended | late)
    return float(total.mean())


def main(steps: str = "30000", picture: str = "") -> None:
    torch.set_num_threads(1)
    worlds = Worlds(BatchEnv("balance", WORLDS, autoreset_mode="SameStep"))
    curve: list[tuple[int, float]] = []
    started = time.monotonic()

    class Curve(BaseCallback):  # type: ignore[misc,unused-ignore]
        def _on_step(self) -> bool:
            return True

        def _on_rollout_end(self) -> None:
            recent = worlds.returns[-20:]
            curve.append((int(self.num_timesteps), float(np.mean(recent)) if recent else 0.0))
            if len(curve) % 10 == 0:
                frames, mean = curve[-1]
                print(f"{frames} frames, {time.monotonic() - started:.0f} s: mean return {mean:.1f}", flush=True)

    model = PPO(
        "MlpPolicy", worlds, n_steps=FRAMES, batch_size=256, n_epochs=8, learning_rate=1e-3, gamma=0.98, seed=0,
        device="cpu", policy_kwargs={"net_arch": [32, 32], "log_std_init": -0.5})
    before = evaluate(model, 8)
    model.learn(int(steps), callback=Curve())
    after = evaluate(model, 8)
    print(f"return before {before:.1f}, after {after:.1f} of 200, {time.monotonic() - started:.0f} s for {steps} frames")
    if picture:
        figure = Figure(figsize=(6.0, 3.4), layout="constrained")
        axes = figure.subplots()
        axes.plot([frames for frames, _ in curve], [mean for _, mean in curve])
        axes.set_xlabel("frames of all worlds")
        axes.set_ylabel("mean return of the last 20 episodes")
        axes.set_ylim(0, 200)
        figure.savefig(picture, dpi=100)


if __name__ == "__main__":
    main(*sys.argv[1:])
