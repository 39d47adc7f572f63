"""A Gymnasium environment that can be learned: a top-heavy float is kept upright on moving water.

A linear policy is found by the cross-entropy method: try some, keep the best, try around them.

    pip install "unipbd[gym]"
    python balance.py
"""

import gymnasium
import numpy as np
import numpy.typing as npt

import unipbd.envs

ROUNDS, TRIED, KEPT, FRAMES = 6, 14, 4, 80

Weights = npt.NDArray[np.float64]
Balance = gymnasium.Env[npt.NDArray[np.float32], npt.NDArray[np.float32]]


def play(env: Balance, weights: Weights, seed: int, frames: int = FRAMES) -> float:
    """Return of an episode in which the torque is linear in the observation."""
    observation, _ = env.reset(seed=seed)
    total = 0.0
    for _ in range(frames):
        action = np.tanh(observation @ weights).astype(np.float32).reshape(1)
        observation, reward, terminated, truncated, _ = env.step(action)
        total += float(reward)
        if terminated or truncated:
            break
    return total


def learn(env: Balance, rng: np.random.Generator) -> Weights:
    """The mean of the best policies of the last round."""
    mean, spread = np.zeros(6), 3.0 * np.ones(6)
    for number in range(ROUNDS):
        tried = mean + spread * rng.normal(size=(TRIED, 6))
        returns = np.array([play(env, weights, seed=number) for weights in tried])
        best = tried[np.argsort(returns)[-KEPT:]]
        mean, spread = best.mean(axis=0), best.std(axis=0) + 0.2
        print(f"round {number}: mean return {returns.mean():5.1f}, best {returns.max():5.1f} of {FRAMES}")
    return mean


def main() -> None:
    env: Balance = gymnasium.make("unipbd/Balance-v0")
    assert isinstance(env.unwrapped, unipbd.envs.TaskEnv)
    weights = learn(env, np.random.default_rng(0))
    # Water that it has not seen.
    idle = np.mean([play(env, np.zeros(6), seed) for seed in range(100, 105)])
    learned = np.mean([play(env, weights, seed) for seed in range(100, 105)])
    print(f"left alone {idle:.1f}, learned {learned:.1f} of {FRAMES}")
    assert learned > idle + 10.0


if __name__ == "__main__":
    main()
