"""Saved states, copies and pickles."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import unipbd as up


def test_a_restored_run_goes_on_bit_for_bit(plume: up.Scene) -> None:
    sim = plume.build(seed=3)
    sim.step(40)
    saved = sim.state()
    sim.step(20)
    expected = sim.state_hash()
    sim.restore(saved)
    assert sim.time == saved.time and sim.frame == 40 == saved.frame
    sim.step(20)
    assert sim.state_hash() == expected
    fresh = plume.build(seed=3)
    fresh.restore(pickle.loads(pickle.dumps(saved)))
    fresh.step(20)
    assert fresh.state_hash() == expected


@pytest.mark.parametrize("how", ["deepcopy", "copy", "pickle"])
def test_copies_are_independent_and_go_on_the_same(plume: up.Scene, how: str) -> None:
    sim = plume.build(seed=3)
    sim.step(30)
    clone = {"deepcopy": copy.deepcopy, "copy": copy.copy, "pickle": lambda s: pickle.loads(pickle.dumps(s))}[how](sim)
    assert clone.state_hash() == sim.state_hash()
    assert (clone.seed, clone.threads, clone.scene) == (sim.seed, sim.threads, sim.scene)
    clone.step(10)
    assert sim.frame == 30
    sim.step(10)
    assert clone.state_hash() == sim.state_hash()


def test_files_are_saved_and_loaded(sim: up.Simulation, tmp_path: Path) -> None:
    path = tmp_path / "moment.state"
    sim.step(5)
    sim.save(path)
    saved, before = sim.state(), sim.state_hash()
    sim.step(5)
    sim.load(path)
    assert sim.state_hash() == before
    assert up.State.load(path) == saved
    assert list(tmp_path.iterdir()) == [path]
    assert "100 particles" in repr(sim.state())


def test_foreign_and_damaged_files_are_refused(sim: up.Simulation, scene: up.Scene, tmp_path: Path) -> None:
    path = tmp_path / "moment.state"
    path.write_bytes(b"not a state at all")
    with pytest.raises(up.StateError, match="not a saved state"):
        sim.load(path)
    data = bytearray(sim.state().to_bytes())
    data[len(data) // 2] ^= 1
    with pytest.raises(up.StateError, match="damaged"):
        up.State.from_bytes(bytes(data))
    data[8] = 200
    with pytest.raises(up.StateError, match="version 200"):
        up.State.from_bytes(bytes(data))
    scene.materials["water"].density = 7.0
    with pytest.raises(up.StateError, match="density 7"):
        sim.restore(scene.build(seed=7).state())
    with pytest.raises(TypeError):
        sim.restore(3)  # type: ignore[arg-type]
    with pytest.raises(FileNotFoundError):
        sim.load(tmp_path / "missing.state")


@given(data=st.binary(max_size=300))
def test_arbitrary_bytes_are_refused(data: bytes) -> None:
    for candidate in (data, b"unipbd\0S\x01\0\0\0" + data):
        with pytest.raises(up.StateError):
            up.State.from_bytes(candidate)


def test_states_outlive_their_simulation(sim: up.Simulation, scene: up.Scene) -> None:
    sim.step(3)
    saved, positions = sim.state(), sim.positions
    del sim
    other = scene.build(seed=7)
    other.restore(saved)
    np.testing.assert_array_equal(other.positions, positions)
