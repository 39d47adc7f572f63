"""Whatever is given: an exception of Python, never a panic of Rust, and the simulation stays usable."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from conftest import pool
from hypothesis import given
from hypothesis import strategies as st
from unipbd import _tables

import unipbd as up

CLEAR = (up.UnipbdError, ValueError, TypeError, KeyError, AttributeError, OverflowError)

numbers = st.one_of(
    st.sampled_from([0, -1, 1, 2, 3, 0.5, 1e-9, 1e9, 1e38, 1e300, -1e300, math.nan, math.inf, 10**30, 2**63, True]),
    st.floats(-10, 10),
)
values = st.recursive(
    st.one_of(numbers, st.sampled_from(["water", "", "x\0y", "top", "kinematic", None])),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.sampled_from(["a", "min", "time"]), inner, max_size=2)),
    max_leaves=6,
)


def keys() -> list[tuple[str, ...]]:
    """Keys of scenes, also of their tables."""
    found: list[tuple[str, ...]] = []
    for key, node in _tables.schema()["properties"].items():
        resolved = _tables.resolve(node)
        inner = _tables.resolve(resolved.get("items", resolved)).get("properties", {})
        found += [(key, "items" if "items" in resolved else "", name) for name in inner] or [(key,)]
    return found


def filled() -> dict[str, Any]:
    """A scene with at least one table of many kinds."""
    scene = pool()
    scene.add_gas("air")
    scene.add_smoke("smoke")
    scene.add_body("raft", at=(1.5, 0.2), size=(0.3, 0.2))
    scene.add_body("buoy", at=(1.5, 1.2), radius=0.15)
    scene.add_joint("rope", "raft", at=(1.5, 0.2), other="buoy", other_at=(1.5, 1.2))
    scene.add_emitter("air", position=(1.5, 2.0), width=0.3, speed=1.0)
    scene.add_particles("water", [(1.3, 2.5)])
    return scene.to_dict()


@given(key=st.sampled_from(keys()), value=values)
def test_any_value_of_any_key_makes_a_scene_or_a_clear_error(key: tuple[str, ...], value: Any) -> None:
    description = filled()
    if len(key) == 1:
        description[key[0]] = value
    elif key[1]:
        description.setdefault(key[0], [{}])[0][key[2]] = value
    else:
        description.setdefault(key[0], {})[key[2]] = value
    try:
        scene = up.Scene.from_dict(description)
        if scene.estimate()["particles_at_peak"] > 20_000 or scene.estimate()["substeps"] > 300:
            return
        sim = scene.build(threads=1)
        if len(sim) < 20_000:
            sim.step()
            sim.diagnostics()
            sim.state_hash()
    except CLEAR as error:
        assert str(error)


@given(data=st.data())
def test_any_argument_of_any_call_is_used_or_refused(data: st.DataObject) -> None:
    scene = up.Scene.from_dict(filled())
    sim = scene.build(threads=1)
    calls: dict[str, Any] = {
        "step": lambda v: sim.step(v if not isinstance(v, (int, float)) or abs(v) < 3 else -1),
        "run": lambda v: [frame.time for frame in sim.run(until=sim.time + 0.03, fps=v)],
        "material": lambda v: sim.material(v),
        "restore": lambda v: sim.restore(v),
        "threads": lambda v: setattr(sim, "threads", v if v in (1, 2) else 0),
        "render": lambda v: sim.render(width=v if not isinstance(v, (int, float)) or abs(v) < 400 else -1),
        "view": lambda v: sim.render(width=64, view=v),
        "remove_hook": lambda v: sim.remove_hook(v),
        "on_substep": lambda v: sim.on_substep(v),
        "group": lambda v: sim.add_group("none", v),
        "from_toml": lambda v: up.Scene.from_toml(v),
        "state": lambda v: up.State.from_bytes(v),
        "seed": lambda v: scene.build(seed=v, threads=1),
        "batch": lambda v: up.Batch(scene, n=v if v in (0, 1, 2) else None, seeds=v),
    }
    name = data.draw(st.sampled_from(sorted(calls)))
    value = data.draw(values)
    try:
        calls[name](value)
    except CLEAR as error:
        assert str(error)
    sim.step()
    assert np.isfinite(sim.positions).all()


@given(data=st.data())
def test_any_wish_of_a_hook_is_carried_out_or_refused(data: st.DataObject) -> None:
    sim = up.Scene.from_dict(filled()).build(threads=1)
    wishes: dict[str, Any] = {
        "accelerate": lambda s, v: s.add_acceleration(v),
        "set": lambda s, v: s.set_velocities([0], v),
        "ids": lambda s, v: s.set_velocities(v, (0, 0)),
        "push": lambda s, v: s.bodies["raft"].push(v),
        "turn": lambda s, v: s.bodies["raft"].push(torque=v),
        "drive": lambda s, v: s.bodies["buoy"].drive(v),
        "spin": lambda s, v: s.bodies["buoy"].drive((0, 0), v),
    }
    wish = wishes[data.draw(st.sampled_from(sorted(wishes)))]
    value = data.draw(st.one_of(values, st.tuples(numbers, numbers)))
    hook = sim.on_substep(lambda s: wish(s, value))
    try:
        sim.step(2)
    except CLEAR as error:
        assert str(error)
    except up.SolverError as error:
        assert error.stage
    sim.remove_hook(hook)
    sim.diagnostics()
    sim.state().to_bytes()
    try:
        sim.step()
    except up.SolverError:
        pass


@pytest.mark.parametrize("wrong", [np.zeros((3, 2)), np.full((100, 2), np.inf), np.zeros(100), "no", 3.0, [None]])
def test_a_wrong_displacement_of_a_group_is_a_clear_error(sim: up.Simulation, wrong: Any) -> None:
    answer = wrong
    sim.add_group("wrong", lambda p: answer)
    with pytest.raises((ValueError, TypeError)):
        sim.step()
    answer = None
    sim.step()
    assert np.isfinite(sim.positions).all()
