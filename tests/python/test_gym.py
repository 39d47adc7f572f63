"""Single Gymnasium environments: episodes, copies, what they ask for."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium")

import unipbd.envs  # noqa: E402

IDS = ["unipbd/Balance-v0", "unipbd/Pour-v0"]


def actions(seed: int, count: int) -> Any:
    return np.random.default_rng(seed).uniform(-1, 1, (count, 1)).astype(np.float32)


@pytest.mark.parametrize("name", IDS)
def test_an_episode_repeats_with_its_seed_and_differs_with_another(name: str) -> None:
    def play(seed: int) -> list[Any]:
        env = gymnasium.make(name)
        seen = [env.reset(seed=seed)[0]]
        for action in actions(0, 15):
            observation, reward, *_ = env.step(action)
            seen.append(np.append(observation, reward))
        return seen

    first, again, other = play(3), play(3), play(4)
    for one, two in zip(first, again, strict=True):
        np.testing.assert_array_equal(one, two)
    assert any(not np.array_equal(one, two) for one, two in zip(first, other, strict=True))


@pytest.mark.parametrize("name", IDS)
def test_episodes_do_not_depend_on_those_before(name: str) -> None:
    env = gymnasium.make(name)
    env.reset(seed=3)
    fresh = [env.step(action)[0] for action in actions(1, 8)]
    env.reset(seed=9)
    for action in actions(2, 11):
        env.step(action)
    env.reset(seed=3)
    for action, expected in zip(actions(1, 8), fresh, strict=True):
        np.testing.assert_array_equal(env.step(action)[0], expected)


@pytest.mark.parametrize("how", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_a_copied_environment_goes_on_by_itself(how: Any) -> None:
    env = unipbd.envs.TaskEnv("balance")
    env.reset(seed=1)
    env.step(actions(0, 1)[0])
    clone = how(env)
    push = np.ones(1, dtype=np.float32)
    expected = [env.step(push)[0] for _ in range(5)]
    for observation in expected:
        np.testing.assert_array_equal(clone.step(push)[0], observation)


def test_the_float_capsizes_alone_and_is_kept_upright_by_a_simple_rule() -> None:
    def play(seed: int, rule: Any) -> int:
        env = gymnasium.make("unipbd/Balance-v0")
        observation, _ = env.reset(seed=seed)
        for frame in range(1, 201):
            observation, _, fallen, over, _ = env.step(rule(observation))
            if fallen or over:
                return frame
        return 0

    def hold(seen: Any) -> Any:
        return np.clip([-4.0 * seen[0] - 1.0 * seen[1]], -1, 1).astype(np.float32)

    alone = [play(seed, lambda seen: np.zeros(1, dtype=np.float32)) for seed in range(4)]
    held = [play(seed, hold) for seed in range(4)]
    assert max(alone) < 120, alone
    assert min(held) == 200, held


def test_the_vessel_is_emptied_by_tilting_and_not_without() -> None:
    def play(rule: Any) -> float:
        env = gymnasium.make("unipbd/Pour-v0")
        observation, info = env.reset(seed=0)
        over = False
        while not over:
            observation, _, done, late, info = env.step(rule(observation))
            over = done or late
        return float(info["poured"])

    def tilt(seen: Any) -> Any:
        wanted = 0.0 if seen[1] > 0.85 else 1.39
        return np.clip([5.0 * (wanted - seen[0])], -1, 1).astype(np.float32)

    assert play(lambda seen: np.zeros(1, dtype=np.float32)) < 0.02
    assert play(tilt) > 0.75


def test_wrong_arguments_are_refused() -> None:
    with pytest.raises(ValueError, match="render_mode"):
        unipbd.envs.TaskEnv("pour", render_mode="hologram")


def test_the_package_needs_no_gymnasium_but_says_so_where_it_does() -> None:
    code = "import sys; sys.modules['gymnasium'] = None; import unipbd; import unipbd.envs"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "ImportError" in run.stderr and 'pip install "unipbd[gym]"' in run.stderr
