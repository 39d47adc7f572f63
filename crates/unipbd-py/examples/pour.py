"""A Gymnasium environment: pour water over a wall by tilting the vessel, with a simple rule.

    pip install "unipbd[gym]"
    python pour.py
"""

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.utils.env_checker import check_env

import unipbd.envs

STEEPEST = np.radians(80.0)


def rule(observation: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Tilt to the right until most is over, then set upright."""
    tilt, poured = observation[:2]
    wanted = 0.0 if poured > 0.85 else STEEPEST
    return np.array([np.clip(5.0 * (wanted - tilt), -1.0, 1.0)], dtype=np.float32)


def main() -> None:
    env = gymnasium.make("unipbd/Pour-v0", render_mode="rgb_array")
    assert isinstance(env.unwrapped, unipbd.envs.TaskEnv)
    check_env(env.unwrapped, skip_render_check=False)
    observation, _ = env.reset(seed=1)
    total, ended, frames = 0.0, False, 0
    while not ended:
        observation, reward, terminated, truncated, info = env.step(rule(observation))
        total += float(reward)
        ended = terminated or truncated
        frames += 1
    print(f"poured {info['poured']:.0%} in {frames / 20:.1f} s, return {total:.2f}")
    assert info["poured"] > 0.7


if __name__ == "__main__":
    main()
