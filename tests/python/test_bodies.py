"""Rigid bodies by name."""

from __future__ import annotations

import numpy as np
import pytest

import unipbd as up


@pytest.fixture
def pond() -> up.Scene:
    """A raft that is dropped a little onto a pool."""
    scene = up.Scene(spacing=0.06)
    scene.add_liquid("water")
    scene.add_block("water", min=(0, 0), max=(2.4, 0.6))
    scene.add_tank(min=(0, 0), max=(2.4, 2))
    outline = [(-0.3, -0.1), (0.3, -0.1), (0.3, 0.1), (-0.3, 0.1)]
    scene.add_body("raft", outline=outline, density=400, at=(1.2, 0.75))
    return scene


def test_a_raft_floats_on_the_force_of_the_fluid(pond: up.Scene) -> None:
    sim = pond.build(seed=1)
    raft = sim.bodies["raft"]
    assert raft.kind == "dynamic" and raft.mass == pytest.approx(400 * 0.6 * 0.2)
    np.testing.assert_allclose(raft.position, (1.2, 0.75), atol=1e-9)
    assert raft.outline.shape == (4, 2)
    lifts = []
    for frame in sim.run(until=4.0):
        if frame.time > 3.0:
            lifts.append(raft.fluid_force[1])
    assert np.mean(lifts) == pytest.approx(raft.mass * 9.81, rel=0.1)
    assert 0.5 < raft.position[1] < 0.75 and abs(raft.angle) < 0.3
    assert raft.velocity.shape == raft.contact_force.shape == (2,)
    assert np.isfinite([raft.angular_velocity, raft.fluid_torque, raft.contact_torque, raft.inertia]).all()
    assert sim.diagnostics()["counts"]["rigid"] == np.count_nonzero(sim.phases == up.RIGID) > 20
    with pytest.raises(KeyError):
        sim.bodies["boat"]


def test_bodies_are_pushed_in_an_edit(pond: up.Scene) -> None:
    sim = pond.build(seed=1)
    sim.step(5)
    with sim.edit() as e:
        e.velocities[:] = 0
        e.bodies["raft"].velocity = (0.5, 0.0)
        e.bodies["raft"].angular_velocity = -1.0
    assert sim.bodies["raft"].velocity.tolist() == [0.5, 0.0]
    assert sim.bodies["raft"].angular_velocity == -1.0
    sample = sim.ids[sim.phases == up.RIGID][0]
    hash_before = sim.state_hash()
    for fault in ("velocity", "sample"):
        with pytest.raises(up.EditError), sim.edit() as e:
            if fault == "velocity":
                e.bodies["raft"].velocity = (np.nan, 0)
            else:
                e.remove([sample])
    assert sim.state_hash() == hash_before


def test_states_and_logs_hold_bodies(pond: up.Scene, tmp_path) -> None:  # type: ignore[no-untyped-def]
    sim = pond.build(seed=1)
    with sim.record(tmp_path / "run.mcap"):
        sim.step(20)
    saved, place = sim.state(), sim.bodies["raft"].position
    frames = list(up.read_log(tmp_path / "run.mcap"))
    np.testing.assert_allclose(frames[-1].bodies["raft"]["position"], place, atol=1e-6)
    sim.step(20)
    expected = sim.state_hash()
    other = sim.copy()
    other.restore(up.State.from_bytes(saved.to_bytes()))
    np.testing.assert_array_equal(other.bodies["raft"].position, place)
    other.step(20)
    assert other.state_hash() == expected


def test_kinematic_bodies_follow_their_script(pond: up.Scene) -> None:
    pond.bodies["raft"].kind = "kinematic"
    pond.bodies["raft"].motion = {"velocity": [0.25, 0.0]}
    sim = pond.build(seed=1)
    sim.step(60)
    np.testing.assert_allclose(sim.bodies["raft"].position, (1.45, 0.75), atol=1e-6)


def test_kinematic_bodies_are_driven_step_by_step(pond: up.Scene) -> None:
    pond.bodies["raft"].kind = "kinematic"
    sim = pond.build(seed=1)
    for frame in range(60):
        with sim.edit() as e:
            e.bodies["raft"].velocity = (0.5 * np.cos(np.pi * frame / 60), 0.0)
            e.bodies["raft"].angular_velocity = 0.1
        sim.step()
    exact = np.sum(0.5 * np.cos(np.pi * np.arange(60) / 60)) / 60
    np.testing.assert_allclose(sim.bodies["raft"].position, (1.2 + exact, 0.75), atol=1e-9)
    assert sim.bodies["raft"].angle == pytest.approx(0.1)
    clone = sim.copy()
    clone.step(5)
    sim.step(5)
    assert clone.state_hash() == sim.state_hash() and clone.bodies["raft"].angle == pytest.approx(0.1 + 0.1 * 5 / 60)


def test_static_bodies_stay_where_they_are(pond: up.Scene) -> None:
    pond.bodies["raft"].kind = "static"
    sim = pond.build(seed=1)
    with pytest.raises(up.EditError, match="static"), sim.edit() as e:
        e.bodies["raft"].velocity = (1, 0)
    sim.on_substep(lambda s: s.bodies["raft"].drive((1, 0)))
    with pytest.raises(ValueError, match="static"):
        sim.step()


def test_hooks_push_and_drive_bodies() -> None:
    scene = up.Scene(gravity=(0, 0))
    scene.add_body("kite", at=(0, 0), size=(0.4, 0.2), density=10.0)
    scene.add_body("door", at=(3, 0), size=(0.1, 1.0), kind="kinematic")
    sim = scene.build()
    kite, door = sim.bodies["kite"], sim.bodies["door"]
    mass, inertia = kite.mass, kite.inertia

    @sim.on_substep
    def pull(s: up.Substep) -> None:
        seen = s.bodies["kite"]
        assert seen.position.shape == seen.velocity.shape == (2,) and not seen.position.flags.writeable
        seen.push(mass * (np.array([1.0, 0.0]) - 4.0 * seen.position), torque=-4.0 * inertia * (seen.angle - 0.5))
        s.bodies["door"].drive(angular_velocity=1.0)

    sim.step(60)
    exact = 0.25 * (1.0 - np.cos(2.0))
    assert kite.position[0] == pytest.approx(exact, abs=0.02) and kite.position[1] == 0.0
    assert kite.angle == pytest.approx(0.5 * (1.0 - np.cos(2.0)), abs=0.04)
    assert door.angle == pytest.approx(1.0) and door.position.tolist() == [3.0, 0.0]
    sim.on_substep(lambda s: s.bodies["door"].push((1.0, 0.0)))
    with pytest.raises(ValueError, match="door"):
        sim.step()


def test_the_floor_of_a_named_tank_carries_the_water() -> None:
    scene = up.Scene(spacing=0.1)
    scene.add_liquid("water", xsph=0.05)
    scene.add_block("water", min=(0, 0), max=(1, 1))
    scene.add_tank(min=(0, 0), max=(1, 2), name="tank", open=["top"])
    sim = scene.build(seed=1)
    floor = []
    for frame in sim.run(until=3.0):
        if frame.time > 2.0:
            floor.append(sim.wall_forces["tank bottom"][1])
    assert np.mean(floor) == pytest.approx(-1000 * 9.81, rel=0.02)
    assert sim.wall_forces == {name: wall["force"] for name, wall in sim.diagnostics()["walls"].items()}
    assert set(sim.wall_forces) == {"tank left", "tank right", "tank bottom"}


def test_a_rope_hangs_from_its_held_end() -> None:
    scene = up.Scene(spacing=0.1)
    scene.add_solid("cord")
    scene.add_rope("cord", start=(0, 0), end=(1, 0), tethers="all")
    sim = scene.build(seed=1)
    for _ in sim.run(until=2.0):
        pass
    assert len(sim.positions) == 11
    assert np.linalg.norm(sim.positions, axis=1).max() < 1.02
