"""Processes: fork and spawn."""

from __future__ import annotations

import multiprocessing
import sys
import warnings

import pytest
from conftest import pool

import unipbd as up


def large() -> up.Scene:
    """Enough particles that threads are used."""
    scene = pool()
    scene.spacing = 0.012
    scene.solver.substeps = 2
    scene.solver.settle_substeps = 1
    return scene


def run(scene: up.Scene) -> int:
    sim = scene.build(seed=1, threads=2)
    sim.step(2)
    return sim.state_hash()


def go_on(sim: up.Simulation) -> int:
    sim.step(2)
    return sim.state_hash()


METHODS = [method for method in ("fork", "spawn") if method in multiprocessing.get_all_start_methods()]


@pytest.mark.parametrize("method", METHODS)
def test_simulations_run_in_other_processes(method: str) -> None:
    scene = large()
    sim = scene.build(seed=1, threads=2)
    sim.step(2)  # makes the threads of this process before it is forked
    expected = sim.state_hash()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # Python warns of forks of threaded processes
        with multiprocessing.get_context(method).Pool(2) as workers:
            assert workers.map_async(run, [scene, scene]).get(60) == [expected, expected]
            ahead = workers.map_async(go_on, [sim]).get(60)
    assert ahead == [go_on(sim)]


@pytest.mark.skipif("fork" not in METHODS, reason="no fork")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_simulation_made_before_a_fork_goes_on_after_it() -> None:
    sim = large().build(seed=1, threads=2)
    batch = up.Batch(pool(), n=3, threads=2)
    sim.step(1)
    batch.step(1)
    context = multiprocessing.get_context("fork")
    results = context.SimpleQueue()

    def child() -> None:
        sim.step(2)
        batch.step(2)
        results.put((sim.state_hash(), batch.state_hashes()))

    process = context.Process(target=child)
    process.start()
    process.join(60)
    assert process.exitcode == 0, "the child is stuck or has failed"
    sim.step(2)
    batch.step(2)
    assert results.get() == (sim.state_hash(), batch.state_hashes())


if __name__ == "__main__":
    sys.exit(run(large()) & 1)
