"""Batches of worlds."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import unipbd as up


def test_each_world_is_bit_for_bit_what_it_is_alone(plume: up.Scene) -> None:
    batch = up.Batch(plume, n=5, seeds=[3, 1, 4, 1, 5], threads=2)
    batch.step(25)
    for seed, world in zip([3, 1, 4, 1, 5], batch, strict=True):
        alone = plume.build(seed=seed)
        alone.step(25)
        assert world.state_hash() == alone.state_hash()
    assert batch[1].state_hash() == batch[3].state_hash() != batch[0].state_hash()
    assert isinstance(batch.positions, list) or batch.positions.ndim == 3


def test_worlds_have_parameters_of_their_own(scene: up.Scene) -> None:
    def deepen(one: up.Scene, number: int) -> None:
        one.block[0].max = (1, 0.5 + 0.5 * number)

    batch = up.Batch(scene, n=3, change=deepen)
    assert batch.counts.tolist() == [50, 100, 150]
    assert [array.shape for array in batch.positions] == [(50, 2), (100, 2), (150, 2)]
    batch.step(5)
    np.testing.assert_allclose(batch.times, 5 / 60)
    assert [world.seed for world in batch] == [0, 1, 2]


def test_worlds_of_one_size_are_stacked(scene: up.Scene) -> None:
    batch = up.Batch(scene, n=4)
    assert batch.positions.shape == batch.velocities.shape == (4, 100, 2)
    assert batch.stack("ids").shape == (4, 100)
    assert len(batch.state_hashes()) == len(batch) == 4
    assert "4 worlds" in repr(batch)


def test_a_world_that_diverges_is_named_and_stops_no_other(scene: up.Scene) -> None:
    def let_fly(one: up.Scene, number: int) -> None:
        if number == 1:
            one.tank.clear()
            one.gravity = (0.0, -1e9)

    batch = up.Batch(scene, n=3, change=let_fly)
    with pytest.raises(up.SolverError) as caught:
        batch.step(3)
    assert caught.value.world == 1
    assert [batch[0].frame, batch[2].frame] == [3, 3]


def test_a_frame_of_one_world_goes_on_beside_others(scene: up.Scene) -> None:
    def let_fly(one: up.Scene, number: int) -> None:
        if number == 1:
            one.tank.clear()
            one.gravity = (0.0, -1e9)

    batch, alone = up.Batch(scene, n=3, threads=2, change=let_fly), scene.build(seed=scene.seed + 2)
    batch[2].on_substep(lambda substep: None)
    ends = [batch.begin(number) for number in range(3)]
    ends[0]()
    with pytest.raises(up.SolverError):
        ends[1]()
    ends[2]()
    alone.step()
    assert [batch[0].frame, batch[2].frame] == [1, 1] and batch[2].state_hash() == alone.state_hash()


def test_hooks_work_in_single_worlds(scene: up.Scene) -> None:
    batch = up.Batch(scene, n=2, seeds=[1, 1])
    batch[0].on_substep(lambda s: s.add_acceleration((0.0, 9.81)))
    batch.step(30)
    assert batch[0].frame == batch[1].frame == 30
    assert batch[0].positions[:, 1].mean() > batch[1].positions[:, 1].mean()


def test_numbers_that_do_not_fit_are_refused(scene: up.Scene) -> None:
    with pytest.raises(ValueError, match="2 seeds for 3"):
        up.Batch(scene, n=3, seeds=[1, 2])
    with pytest.raises(ValueError):
        up.Batch([], n=0)
    with pytest.raises(ValueError):
        up.Batch(scene, n=2).step(-1)
    assert len(up.Batch([scene, scene])) == 2


def test_worlds_with_hooks_are_stepped_though_another_diverges(scene: up.Scene) -> None:
    def let_fly(one: up.Scene, number: int) -> None:
        if number == 0:
            one.tank.clear()
            one.gravity = (0.0, -1e9)

    batch = up.Batch(scene, n=3, change=let_fly)
    batch[2].on_substep(lambda s: s.add_acceleration((0.0, 1.0)))
    with pytest.raises(up.SolverError) as caught:
        batch.step(3)
    assert caught.value.world == 0 and [batch[1].frame, batch[2].frame] == [3, 3]
    assert pickle.loads(pickle.dumps(caught.value)).world == 0


@pytest.mark.parametrize("how", [copy.deepcopy, lambda batch: pickle.loads(pickle.dumps(batch))])
def test_batches_are_copied(scene: up.Scene, how: Any) -> None:
    batch = up.Batch(scene, n=3, threads=2)
    batch.step(5)
    clone = how(batch)
    clone.step(5)
    assert clone.threads == 2 and set(batch.times) == {5 / 60}
    batch.step(5)
    assert clone.state_hashes() == batch.state_hashes()


@given(seeds=st.lists(st.integers(0, 2**63 - 1), min_size=1, max_size=4), threads=st.integers(1, 3))
def test_any_seeds_and_threads_give_each_world_what_it_gets_alone(seeds: list[int], threads: int) -> None:
    scene = up.Scene(spacing=0.06)
    scene.add_gas("air")
    scene.add_emitter("air", name="jet", position=(0, 0), width=0.3, speed=1.0)
    batch = up.Batch(scene, n=len(seeds), seeds=seeds, threads=threads)
    batch.step(8)
    alone = [scene.build(seed=seed, threads=1) for seed in seeds]
    for world in alone:
        world.step(8)
    assert batch.state_hashes() == [world.state_hash() for world in alone]
