"""Tasks in one world and in many."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium")
env_checker = pytest.importorskip("gymnasium.utils.env_checker")
vector = pytest.importorskip("gymnasium.vector")

import unipbd as up  # noqa: E402
import unipbd.envs  # noqa: E402, F401
from unipbd.envs import BatchEnv, TaskEnv  # noqa: E402

IDS = {"balance": "unipbd/Balance-v0", "pour": "unipbd/Pour-v0", "stir": "unipbd/Stir-v0", "boat": "unipbd/HoldBoat-v0"}
MODES = ["state", "grid", "points", "probes"]


def actions(env: Any, count: int, seed: int = 0) -> Any:
    random = np.random.default_rng(seed)
    return random.uniform(-1, 1, (count, *env.action_space.shape)).astype(np.float32)


@pytest.mark.parametrize(("task", "mode"), [*((task, "state") for task in IDS), *(("pour", mode) for mode in MODES[1:])])
def test_a_task_passes_the_check_of_gymnasium_without_a_warning(task: str, mode: str) -> None:
    env = gymnasium.make(IDS[task], render_mode="rgb_array", observation=mode).unwrapped
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env_checker.check_env(env, skip_render_check=False)


@pytest.mark.parametrize("autoreset", list(vector.AutoresetMode))
@pytest.mark.parametrize("task", ["balance", "pour"])
def test_many_worlds_are_bit_for_bit_single_ones(task: str, autoreset: Any) -> None:
    """The same as the vector of Gymnasium over single environments, in every mode of resetting."""
    horizon = 12

    def single() -> Any:
        return gymnasium.wrappers.TimeLimit(TaskEnv(task), horizon)

    theirs = vector.SyncVectorEnv([single] * 3, autoreset_mode=autoreset)
    ours = BatchEnv(task, 3, autoreset_mode=autoreset, max_episode_steps=horizon, threads=2)
    assert ours.observation_space == theirs.observation_space and ours.action_space == theirs.action_space
    assert ours.metadata["autoreset_mode"] == autoreset
    compare(theirs.reset(seed=5), ours.reset(seed=5))
    over = 0
    for action in actions(ours, 30):
        expected, found = theirs.step(action), ours.step(action)
        compare(expected, found)
        ended = found[2] | found[3]
        over += int(ended.sum())
        if autoreset is vector.AutoresetMode.DISABLED and ended.any():
            with pytest.raises(RuntimeError, match="reset them"):
                ours.step(action)
            options = {"reset_mask": ended}
            compare(theirs.reset(options=dict(options)), ours.reset(options=options))
    assert over >= 3


def compare(expected: tuple[Any, ...], found: tuple[Any, ...]) -> None:
    for one, other in zip(expected[:-1], found[:-1], strict=True):
        np.testing.assert_array_equal(one, other)
        assert np.asarray(one).dtype == np.asarray(other).dtype
    assert set(expected[-1]) == set(found[-1])
    for key in expected[-1]:
        if key not in ("final_obs", "final_info"):
            np.testing.assert_array_equal(expected[-1][key], found[-1][key])
    for one, other in zip(expected[-1].get("final_obs", ()), found[-1].get("final_obs", ()), strict=True):
        assert one is None and other is None or np.array_equal(one, other)


def test_wrappers_of_gymnasium_take_a_batch_as_they_take_their_own() -> None:
    """Statistics of episodes, flat and normalized observations, normalized rewards, infos as a list."""

    def wrapped(envs: Any) -> Any:
        wrappers = gymnasium.wrappers.vector
        envs = wrappers.RecordEpisodeStatistics(envs)
        envs = wrappers.NormalizeObservation(wrappers.FlattenObservation(envs))
        return wrappers.DictInfoToList(wrappers.NormalizeReward(wrappers.RescaleAction(envs, -2.0, 2.0)))

    def single() -> Any:
        return gymnasium.wrappers.TimeLimit(TaskEnv("pour", observation="grid"), 6)

    theirs = wrapped(vector.SyncVectorEnv([single] * 2))
    ours = wrapped(BatchEnv("pour", 2, observation="grid", max_episode_steps=6))
    np.testing.assert_array_equal(theirs.reset(seed=3)[0], ours.reset(seed=3)[0])
    lengths = []
    for action in actions(ours, 16):
        expected, found = theirs.step(action), ours.step(action)
        for one, other in zip(expected[:-1], found[:-1], strict=True):
            np.testing.assert_array_equal(one, other)
        lengths += [info["episode"]["l"] for info in found[-1] if "episode" in info]
    assert lengths and set(lengths) == {6}


def test_make_vec_makes_them_and_seeds_repeat() -> None:
    def play(seed: Any) -> Any:
        envs = gymnasium.make_vec(IDS["stir"], num_envs=2, vectorization_mode="vector_entry_point")
        seen = [envs.reset(seed=seed)[0]]
        return np.stack([*seen, *(envs.step(action)[0] for action in actions(envs, 5))])

    first = play(3)
    np.testing.assert_array_equal(first, play([3, 4]))
    np.testing.assert_array_equal(first[:, 1], play([9, 4])[:, 1])
    assert not np.array_equal(first[:, 0], play([9, 4])[:, 0])


def test_worlds_have_parameters_of_their_own_and_keep_to_their_action() -> None:
    envs = BatchEnv("pour", 3, parameters={"gravity": [[0.0, -9.81], [0.0, -3.0], [0.0, -9.81]]})
    envs.reset(seed=[1, 1, 1])
    for _ in range(12):
        seen, *_ = envs.step(np.array([[0.5], [0.5], [0.5]], dtype=np.float32))
    np.testing.assert_array_equal(seen[0], seen[2])
    assert not np.allclose(seen[0], seen[1])
    assert [round(-world.scene.gravity[1], 2) for world in envs.batch] == [9.81, 3.0, 9.81]
    with pytest.raises(ValueError, match="2 values for 3 worlds"):
        BatchEnv("pour", 3, parameters={"spacing": [0.06, 0.07]})
    with pytest.raises(ValueError, match="number of particles"):
        BatchEnv("pour", 2, observation="points", parameters={"block.0.max.1": [0.6, 0.48]})


def test_grids_points_and_probes_show_the_particles() -> None:
    shown = {mode: TaskEnv("pour", observation=mode, shape=(7, 5)) for mode in MODES}
    seen = {mode: env.reset(seed=1)[0] for mode, env in shown.items()}
    sim = shown["grid"].simulation
    assert seen["grid"].shape == (3, 5, 7) and seen["points"].shape == (len(sim), 4) and seen["probes"].shape == (35, 3)
    cell = 2.1 * 1.5 / 35
    assert seen["grid"][0].sum() * cell == pytest.approx(len(sim) * 0.06**2, rel=1e-5)
    assert seen["grid"][0, 0, 0] == pytest.approx(1.0, abs=0.2) and seen["grid"][0, 4].max() == 0.0
    inside = seen["probes"][:, 0].reshape(5, 7)
    assert inside[0, 1] == pytest.approx(1.0, abs=0.15) and inside[4].max() == 0.0
    mean = sim.velocities.mean(axis=0)
    np.testing.assert_allclose(seen["grid"][1:, 0, 0], mean, atol=1e-3)
    np.testing.assert_allclose(seen["points"][:, 2:], sim.velocities)


def test_a_world_that_diverges_ends_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    envs = BatchEnv("pour", 3)
    envs.reset(seed=0)
    still, begin = np.zeros((3, 1), dtype=np.float32), envs.batch.begin

    def diverge() -> None:
        raise up.SolverError("the speed is not finite")

    monkeypatch.setattr(envs.batch, "begin", lambda number: diverge if number == 1 else begin(number))
    _, rewards, ended, late, infos = envs.step(still)
    assert ended.tolist() == [False, True, False] and not late.any() and rewards[1] == 0.0
    assert infos["diverged"].tolist() == [False, True, False]
    monkeypatch.setattr(envs.batch, "begin", begin)
    seen, _, ended, _, _ = envs.step(still)
    assert not ended.any() and seen[1].any() and envs._steps.tolist() == [2, 0, 2]


def test_an_action_that_fails_leaves_no_world_under_way(monkeypatch: pytest.MonkeyPatch) -> None:
    envs = BatchEnv("pour", 3, threads=2)
    envs.reset(seed=0)
    act = envs.task.act

    def fail(sim: Any, memory: Any, action: Any) -> None:
        if sim is envs.batch[2]:
            raise KeyError("no such lever")
        act(sim, memory, action)

    monkeypatch.setattr(envs.task, "act", fail)
    with pytest.raises(KeyError, match="lever"):
        envs.step(np.zeros((3, 1), dtype=np.float32))
    monkeypatch.setattr(envs.task, "act", act)
    envs.reset(seed=0)
    seen, *_ = envs.step(np.zeros((3, 1), dtype=np.float32))
    np.testing.assert_array_equal(seen[0], fresh_step("pour"))


def fresh_step(task: str) -> Any:
    """What a single environment shows after a first step without action."""
    env = TaskEnv(task)
    env.reset(seed=0)
    return env.step(np.zeros(env.action_space.shape, dtype=np.float32))[0]


def test_pictures_and_wrong_arguments() -> None:
    envs = BatchEnv("stir", 2, render_mode="rgb_array")
    envs.reset(seed=0)
    pictures = envs.render()
    assert pictures is not None and len(pictures) == 2 and pictures[0].dtype == np.uint8
    assert BatchEnv("stir", 1).render() is None
    for wrong, message in (({"task": "bake"}, "there are balance"), ({"render_mode": "human"}, "rgb_array"),
                           ({"observation": "smell"}, "state, grid"), ({"autoreset_mode": "never"}, "never")):
        with pytest.raises(ValueError, match=message):
            BatchEnv(**{"task": "pour", **wrong})
    with pytest.raises(ValueError, match=r"\(2, 2\)"):
        envs.step(np.zeros((2, 1), dtype=np.float32))
    with pytest.raises(TypeError, match="array of bool"):
        envs.reset(options={"reset_mask": [True, False]})
    with pytest.raises(ValueError, match="3 seeds for 2"):
        envs.reset(seed=[1, 2, 3])


def test_tasks_reward_what_they_ask_for() -> None:
    def play(task: str, rule: Any, steps: int) -> float:
        env = gymnasium.make(IDS[task])
        seen, _ = env.reset(seed=2)
        total = 0.0
        for step in range(steps):
            seen, reward, ended, late, _ = env.step(np.clip(rule(seen, step), -1, 1).astype(np.float32))
            total += float(reward)
            if ended or late:
                break
        return total

    def still(seen: Any, step: int) -> Any:
        return np.zeros(1)

    assert play("balance", lambda s, _: [-4 * s[0] - s[1]], 100) > play("balance", still, 100) + 30
    assert play("pour", lambda s, _: [5 * ((0.0 if s[1] > 0.85 else 1.39) - s[0])], 100) > 5
    assert play("boat", lambda s, _: [-3 * s[0] - 2 * s[1]], 120) > play("boat", still, 120) + 5
    round_and_round = play("stir", lambda s, t: [np.sin(t / 3), np.cos(t / 5)], 60)
    assert round_and_round > play("stir", lambda s, t: np.zeros(2), 60) + 1


def test_a_batch_steps_some_worlds_alone() -> None:
    scene = up.Scene.from_dict({"spacing": 0.1, "liquid": [{"name": "w"}], "block": [
        {"material": "w", "min": [0, 0], "max": [0.5, 0.5]}], "tank": [{"min": [0, 0], "max": [1, 1]}]})
    batch = up.Batch(scene, n=3)
    batch.step(2, worlds=[2, -3])
    assert [world.frame for world in batch] == [2, 0, 2]
    with pytest.raises(IndexError):
        batch.step(worlds=[3])
