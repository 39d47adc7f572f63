"""Simulations that nothing refers to any more are collected."""

from __future__ import annotations

import gc
import weakref

from conftest import pool


def test_a_simulation_in_the_closure_of_its_own_group_is_collected() -> None:
    sim = pool().build(threads=1)
    sim.add_group("own", lambda projection: None if sim is not None else None)
    sim.on_substep(lambda substep: None if sim is not None else None)
    sim.step(2)
    seen = weakref.ref(sim)
    del sim
    gc.collect()
    assert seen() is None


def test_a_simulation_that_is_in_use_keeps_its_group() -> None:
    calls: list[float] = []
    sim = pool().build(threads=1)
    sim.add_group("own", lambda projection: calls.append(projection.dt))
    gc.collect()
    sim.step(1)
    assert calls
