"""A Gymnasium environment: pour water from one half of a vessel into the other by tilting it.

The vessel is tilted by turning gravity, as one feels it who tilts with the vessel.

    pip install "unipbd[gym]"
    python pour.py
"""

from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium import spaces

import unipbd as up

COLUMNS = 12
STEEPEST = np.radians(50.0)
FASTEST = np.radians(180.0)
GRAVITY = 9.81

Observation = npt.NDArray[np.float32]


class Pour(gymnasium.Env[Observation, npt.NDArray[np.float32]]):
    """Pour everything over the wall to the right, then set the vessel upright.

    Action: how fast to tilt, -1 to 1 (of 180 degrees per second, positive towards the right).
    Observation: tilt, share of the water on the right, mean velocity, depth in twelve columns.
    Reward: what was poured since the last step, less a little for tilt.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 20}

    def __init__(self, render_mode: str | None = None, seconds: float = 4.0) -> None:
        self.render_mode = render_mode
        self.action_space = spaces.Box(-1.0, 1.0, (1,), np.float32)
        self.observation_space = spaces.Box(-np.inf, np.inf, (4 + COLUMNS,), np.float32)
        scene = up.Scene(name="Pour", spacing=0.06, fps=20)
        scene.add_liquid("water")
        scene.add_block("water", min=(0, 0), max=(0.9, 0.6))
        scene.add_tank(min=(0, 0), max=(2.1, 2))
        scene.add_obstacle(min=(0.96, 0), max=(1.14, 0.72))
        self._sim = scene.build(seed=0, threads=1)
        self._sim.on_substep(self._tilt)
        self._start = self._sim.state()
        self._limit = round(seconds * scene.fps)
        self._angle = 0.0
        self._target = 0.0
        self._poured = 0.0

    def _tilt(self, substep: up.Substep) -> None:
        g = GRAVITY
        substep.add_acceleration((g * np.sin(self._angle), g * (1.0 - np.cos(self._angle))))

    def _observe(self) -> Observation:
        x, y = self._sim.positions.T
        self._share = float(np.mean(x > 1.05))
        depth, _ = np.histogram(x, bins=COLUMNS, range=(0.0, 2.1))
        mean = self._sim.velocities.mean(axis=0)
        return np.concatenate([[self._angle, self._share], mean, depth / len(x)]).astype(np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        super().reset(seed=seed)
        self._sim.restore(self._start)
        with self._sim.edit() as edit:
            edit.velocities[:] = self.np_random.uniform(-0.1, 0.1, 2)
        self._angle = 0.0
        observation = self._observe()
        self._poured = self._share
        return observation, {}

    def step(
        self, action: npt.NDArray[np.float32]
    ) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        rate = float(np.clip(action[0], -1.0, 1.0)) * FASTEST
        self._angle = float(np.clip(self._angle + rate * self._sim.frame_time, -STEEPEST, STEEPEST))
        self._sim.step()
        observation = self._observe()
        reward = (self._share - self._poured) - 0.002 * abs(self._angle)
        self._poured = self._share
        done = self._share > 0.9 and abs(self._angle) < 0.1
        return observation, reward, done, self._sim.frame >= self._limit, {"poured": self._share}

    def render(self) -> npt.NDArray[np.uint8] | None:  # type: ignore[override]
        return self._sim.render(width=320) if self.render_mode == "rgb_array" else None


def main() -> None:
    from gymnasium.utils.env_checker import check_env

    check_env(Pour(render_mode="rgb_array"), skip_render_check=False)
    env = Pour()
    env.reset(seed=1)
    total = 0.0
    ended = False
    while not ended:
        # Tilt to the right until most is over, then set upright.
        wanted = 0.0 if env._share > 0.6 else STEEPEST
        action = np.array([np.clip(5.0 * (wanted - env._angle), -1.0, 1.0)], dtype=np.float32)
        _, reward, done, truncated, info = env.step(action)
        total += reward
        ended = done or truncated
    print(f"poured {info['poured']:.0%}, return {total:.2f}")
    assert info["poured"] > 0.5


if __name__ == "__main__":
    main()
