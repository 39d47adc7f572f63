"""A running world gets its first body, emitters, ropes, other shapes, and a budget."""

from __future__ import annotations

import copy
import logging
import pickle

import numpy as np
import pytest
from conftest import pool

import unipbd as up


def wet() -> up.Scene:
    scene = pool()
    scene.add_solid("hemp")
    return scene


def furnish(sim: up.Simulation) -> None:
    with sim.edit() as e:
        e.add_body("raft", at=(0.6, 1.4), size=(0.5, 0.2), density=400)
        e.add_body("nail", at=(1.6, 2.8), radius=0.1, kind="static")
        e.add_body("lamp", at=(1.6, 2.0), radius=0.15)
        e.add_rope("hemp", (1.6, 2.7), (1.6, 2.15), from_body="nail", body="lamp", tethers="all")
        e.add_emitter("water", position=(0.3, 2.5), width=0.3, speed=1.0, direction=(1, 0), name="tap")


def test_a_scene_of_water_gets_bodies_ropes_and_emitters() -> None:
    sim = wet().build(seed=7, threads=1)
    sim.step(5)
    assert not sim.bodies and not sim.emitters and not sim.ropes and "contacts" not in sim.stages
    furnish(sim)
    assert sim.body_names == ["raft", "nail", "lamp"] and "contacts" in sim.stages
    assert sim.emitters == [up.Emitter("tap", "water", (0.3, 2.5), 1.0, 0.0, False, False)]
    (rope,) = sim.ropes
    assert not rope.cuts and set(rope.ids) == set(sim.ids_of("hemp").tolist())
    before = len(sim)
    sim.step(30)
    assert len(sim) > before and sim.emitters[0].running
    assert sim.bodies["lamp"].position[1] == pytest.approx(2.0, abs=0.02)
    with sim.edit() as e:
        e.change_emitter("tap", speed=0.5, on=False)
        e.cut_rope(0, piece=2)
        e.bodies["raft"].set(size=(0.7, 0.2))
    assert sim.bodies["raft"].mass == pytest.approx(0.7 * 0.2 * 400)
    assert sim.emitters[0].speed == 0.5 and sim.ropes[0].cuts == [2]
    before = len(sim)
    sim.step(30)
    assert len(sim) == before and not sim.emitters[0].running
    assert sim.bodies["lamp"].position[1] < 1.9
    with sim.edit() as e:
        e.remove_emitter(0)
        e.remove_rope(0)
        e.remove_body("nail")
    assert sim.emitters[0].removed and sim.ropes[0].removed and not len(sim.ids_of("hemp"))
    sim.step(5)


def test_a_furnished_world_is_saved_copied_and_restored_bit_for_bit() -> None:
    sim = wet().build(seed=7, threads=1)
    sim.step(5)
    early = sim.state()
    furnish(sim)
    sim.step(10)
    others = [wet().build(seed=7, threads=2), copy.deepcopy(sim), pickle.loads(pickle.dumps(sim))]
    others[0].restore(up.State.from_bytes(sim.state().to_bytes()))
    for _ in range(5):
        sim.step()
        for other in others:
            other.step()
            assert other.state_hash() == sim.state_hash()
    sim.restore(early)
    assert not sim.bodies and list(sim.materials) == ["water", "hemp"]
    fresh = wet().build(seed=7, threads=1)
    fresh.step(5)
    for _ in range(5):
        sim.step()
        fresh.step()
        assert fresh.state_hash() == sim.state_hash()


def test_what_is_wrong_is_named_and_changes_nothing() -> None:
    sim = wet().build(seed=7, threads=1)
    furnish(sim)
    before = sim.state_hash()
    wrong = [
        (lambda e: e.add_emitter("wine", (0, 2), 0.2, 1.0), "wine"),
        (lambda e: e.add_emitter("water", (0, 2), 0.2, -1.0), "speed"),
        (lambda e: e.add_emitter("water", (0, 2), 0.2, 1.0, colour="red"), "colour"),
        (lambda e: e.change_emitter("pump", on=True), "no emitter 'pump'"),
        (lambda e: e.change_emitter(4, on=True), "no emitter 4"),
        (lambda e: e.add_rope("hemp", (0, 2), (1, 2), body="nobody"), "nobody"),
        (lambda e: e.cut_rope(0, piece=99), "no piece 99"),
        (lambda e: e.remove_rope(2), "no rope 2"),
        (lambda e: e.bodies["raft"].set(radius=-1), "radius"),
        (lambda e: e.bodies["raft"].set(radius=0.1, size=(1, 1)), "one of radius, size and outline"),
        (lambda e: e.bodies["raft"].set(outline=[(0, 0), (1, 1), (1, 0), (0, 1)]), "cross"),
    ]
    for change, expected in wrong:
        with pytest.raises(up.EditError, match=expected), sim.edit() as e:
            e.change_emitter("tap", on=False)
            change(e)
            e.remove_rope(0)
        assert sim.state_hash() == before and not sim.ropes[0].removed


def test_a_recording_goes_on_when_the_first_body_comes(tmp_path: object) -> None:
    path = f"{tmp_path}/run.mcap"
    sim = wet().build(seed=7, threads=1)
    with sim.record(path, fields="all"):
        sim.step(3)
        furnish(sim)
        sim.step(3)
    frames = list(up.read_log(path))
    assert len(frames) == 7 and len(frames[-1].bodies) == 3
    assert sim.render(f"{tmp_path}/frame.png", width=200).shape[1:] == (200, 3)
    assert np.isfinite(frames[-1].positions).all()


def test_a_budget_cuts_substeps_and_says_so_once(caplog: pytest.LogCaptureFixture) -> None:
    scene = pool()
    scene.solver.pressure_grid = "off"
    sim = scene.build(seed=7, threads=1)
    assert sim.budget is None
    sim.step(10)
    assert sim.diagnostics()["substeps"] > 1
    with caplog.at_level(logging.WARNING, logger="unipbd"):
        sim.budget = 1e-9
        sim.step(10)
    assert sim.budget == 1e-9 and copy.copy(sim).budget == 1e-9
    assert (sim.diagnostics()["substeps"], sim.diagnostics()["substeps_reason"]) == (1, "budget")
    assert sum("budget" in record.getMessage() for record in caplog.records) == 1
    for wrong in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="budget"):
            sim.budget = wrong
    sim.budget = None
    sim.step(3)
    assert sim.diagnostics()["substeps_reason"] != "budget"
