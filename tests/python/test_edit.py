"""Edits: arrays in, all or nothing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from conftest import pool
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import unipbd as up


def test_an_edit_sets_removes_and_adds(sim: up.Simulation) -> None:
    sim.step(5)
    with sim.edit() as e:
        e.velocities[sim.ids_of("water")] = 0
        e.velocities[[3, 4]] = [(1, 2), (3, 4)]
        e.positions[5] = (1.5, 2.5)
        e.remove(sim.ids < 2)
        e.add("water", positions=[(1.7, 2.5)], velocities=(0, -1))
    assert e.added.tolist() == [100]
    assert len(sim) == 99 and sim.ids[0] == 2
    np.testing.assert_array_equal(sim.velocities[1:3], [(1, 2), (3, 4)])
    assert not sim.velocities[4:-1].any()
    np.testing.assert_array_equal(sim.positions[3], (1.5, 2.5))
    np.testing.assert_array_equal(sim.velocities[-1], (0, -1))
    sim.step(20)
    assert len(sim) == 99


def test_reading_and_changing_in_place_work_by_id(sim: up.Simulation) -> None:
    sim.step(5)
    before = sim.velocities
    with sim.edit() as e:
        e.velocities[[10, 20]] *= 2
        assert e.velocities[10].shape == (2,)
        e.velocities[:] += (1, 0)
    expected = before + np.array([1, 0], dtype=np.float32)
    expected[[10, 20]] = 2 * before[[10, 20]] + np.array([1, 0], dtype=np.float32)
    np.testing.assert_allclose(sim.velocities, expected, rtol=1e-6)


def test_an_edit_that_changes_nothing_leaves_the_same_bits(sim: up.Simulation) -> None:
    sim.step(7)
    other = sim.copy()
    with sim.edit():
        pass
    sim.step(5)
    other.step(5)
    assert sim.state_hash() == other.state_hash()


FAULTY: dict[str, Any] = {
    "unknown id": lambda e: e.remove([1000]),
    "negative id": lambda e: e.remove([-1]),
    "id of the wrong type": lambda e: e.remove([0.5]),
    "repeated id": lambda e: e.velocities.__setitem__([1, 1], 0),
    "short mask": lambda e: e.remove(np.zeros(5, dtype=bool)),
    "NaN": lambda e: e.velocities.__setitem__(3, (np.nan, 0)),
    "infinite": lambda e: e.positions.__setitem__(3, (np.inf, 0)),
    "too large for single precision": lambda e: e.velocities.__setitem__(3, (1e200, 0)),
    "too far away": lambda e: e.positions.__setitem__(3, (1e9, 0)),
    "wrong shape": lambda e: e.velocities.__setitem__([1, 2], np.zeros((3, 2))),
    "words": lambda e: e.velocities.__setitem__(3, ("a", "b")),
    "complex": lambda e: e.velocities.__setitem__(3, (1j, 0)),
    "unknown material": lambda e: e.add("wine", [(1, 1)]),
    "points of three coordinates": lambda e: e.add("water", [(1, 1, 1)]),
    "NaN point": lambda e: e.add("water", [(np.nan, 1)]),
    "unknown motion": lambda e: e.add("water", [(1, 2)], motion="wild"),
    "temperature without gas": lambda e: e.temperatures.__setitem__(3, 1.0),
    "part of a slice": lambda e: e.velocities.__setitem__(slice(0, 3), 0),
}


@pytest.mark.parametrize("fault", FAULTY, ids=str)
def test_a_faulty_edit_is_an_error_and_nothing_is_half_applied(sim: up.Simulation, fault: str) -> None:
    hash_before = sim.state_hash()
    with pytest.raises(up.EditError) as caught:
        with sim.edit() as e:
            e.velocities[0] = (1, 1)
            FAULTY[fault](e)
    assert isinstance(caught.value, ValueError)
    assert sim.state_hash() == hash_before
    sim.step(2)


def test_an_exception_within_the_block_changes_nothing(sim: up.Simulation) -> None:
    hash_before = sim.state_hash()
    with pytest.raises(RuntimeError, match="mine"):
        with sim.edit() as e:
            e.remove([1])
            raise RuntimeError("mine")
    assert sim.state_hash() == hash_before
    with pytest.raises(up.EditError, match="with block"):
        e.remove([1])


def test_stepping_within_an_edit_is_refused(sim: up.Simulation) -> None:
    with pytest.raises(up.EditError, match="stepped"):
        with sim.edit() as e:
            e.velocities[0] = (1, 1)
            sim.step()


def test_kinematic_particles_go_their_way(sim: up.Simulation) -> None:
    with sim.edit() as e:
        e.make_kinematic([50])
        e.velocities[50] = (0.0, 1.0)
    start = sim.positions[50]
    sim.step(30)
    np.testing.assert_allclose(sim.positions[50], start + (0, 0.5), atol=1e-4)
    with sim.edit() as e:
        e.free([50])
    sim.step(30)
    assert sim.positions[50, 1] < start[1] + 0.7


finite = st.floats(-1e4, 1e4, allow_nan=False)
anything = st.floats(allow_nan=True, allow_infinity=True)


@given(data=st.data())
def test_any_sequence_of_edits_keeps_columns_and_ids_together(data: st.DataObject) -> None:
    sim = pool().build(threads=1)
    expected = {int(i) for i in sim.ids}
    given_ids = 100
    for _ in range(data.draw(st.integers(1, 3))):
        gone = data.draw(st.sets(st.sampled_from(sorted(expected)), max_size=20)) if expected else set()
        count = data.draw(st.integers(0, 5))
        fresh = data.draw(arrays.arrays(np.float64, (count, 2), elements=st.floats(0.1, 1.9)))
        pushed = data.draw(arrays.arrays(np.float64, (2,), elements=st.floats(-3, 3)))
        with sim.edit() as e:
            e.velocities[:] = pushed
            e.remove(np.array(sorted(gone), dtype=np.int64))
            e.add("water", fresh, velocities=pushed)
        expected = (expected - gone) | set(range(given_ids, given_ids + count))
        given_ids += count
        assert sim.ids.tolist() == sorted(expected)
        np.testing.assert_allclose(sim.velocities, np.tile(pushed, (len(sim), 1)), rtol=1e-6, atol=1e-30)
        sim.step(2)
        assert sim.ids.tolist() == sorted(expected)
        assert np.isfinite(sim.positions).all()


@given(
    ids=st.lists(st.integers(-5, 120), max_size=6),
    values=arrays.arrays(
        st.sampled_from([np.float64, np.float32, np.int64, np.bool_, np.complex128]),
        arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=3),
    ),
)
def test_whatever_arrays_are_given_the_answer_is_a_clear_error_or_the_wanted_values(ids: Any, values: Any) -> None:
    sim = pool().build(threads=1)
    hash_before = sim.state_hash()
    try:
        with sim.edit() as e:
            e.velocities[ids] = values
    except up.EditError:
        assert sim.state_hash() == hash_before
    else:
        wanted = np.broadcast_to(values, (len(ids), 2)).astype(np.float32)
        np.testing.assert_array_equal(sim.velocities[ids], wanted)


@given(value=arrays.arrays(np.float64, (3, 2), elements=anything))
def test_numbers_that_are_not_finite_never_enter(value: Any) -> None:
    sim = pool().build(threads=1)
    try:
        with sim.edit() as e:
            e.add("water", value)
    except up.EditError:
        assert len(sim) == 100
    else:
        assert np.isfinite(value).all() and len(sim) == 103
    assert np.isfinite(sim.positions).all()
