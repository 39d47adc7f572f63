"""A running world is changed and asked."""

from __future__ import annotations

import numpy as np
import pytest

import unipbd as up


@pytest.fixture
def yard() -> up.Simulation:
    """Two boxes on a floor, one on the other."""
    scene = up.Scene(spacing=0.05)
    scene.add("half_plane", name="ground", point=(0, 0), normal=(0, 1))
    scene.add_body("low", at=(0, 0.2), size=(0.4, 0.4), user_data=7)
    scene.add_body("high", at=(0, 0.6), size=(0.4, 0.4))
    return scene.build(seed=1)


def settle(sim: up.Simulation, seconds: float = 1.5) -> None:
    sim.step(round(seconds * 60))


def test_bodies_come_go_and_change(yard: up.Simulation) -> None:
    settle(yard)
    assert yard.bodies["low"].asleep and yard.bodies["low"].user_data == 7
    with yard.edit() as edit:
        edit.add_body("ball", at=(0, 1.2), radius=0.1, density=500)
        edit.remove_body("low")
        edit.bodies["high"].set(mass=20, friction=0.1, restitution=0.5, gravity_factor=0.5)
    assert yard.body_names == ["high", "ball"] == list(yard.bodies)
    assert yard.bodies["high"].mass == 20 and not yard.bodies["high"].asleep
    settle(yard, 3.0)
    assert yard.bodies["high"].position[1] == pytest.approx(0.2, abs=0.01)
    assert yard.bodies["ball"].position[1] < 0.6
    with yard.edit() as edit:
        edit.bodies["ball"].position = (3, 4)
        edit.bodies["ball"].angle = 0.5
        edit.bodies["high"].push((10, 0))
    np.testing.assert_allclose(yard.body_poses[1], (3, 4, 0.5))
    assert yard.body_velocities[0, 0] == pytest.approx(0.5)


def test_gravity_joints_and_motors_change(yard: up.Simulation) -> None:
    with yard.edit() as edit:
        edit.gravity = (0, 0)
        edit.add_body("wheel", at=(2, 1), radius=0.3)
        edit.add_joint("hinge", "wheel", (2, 1), name="axle", motor_speed_deg=90)
    assert yard.gravity == (0, 0) and yard.joints[0].kind == "hinge"
    yard.step(30)
    assert yard.bodies["wheel"].angular_velocity == pytest.approx(np.pi / 2)
    with yard.edit() as edit:
        edit.set_motor("axle", -1.0, limit=1e6)
    yard.step(30)
    assert yard.bodies["wheel"].angular_velocity == pytest.approx(-1.0)
    with yard.edit() as edit:
        edit.remove_joint("axle")
        edit.gravity = (0, -5)
    yard.step(30)
    assert yard.joints[0].removed and yard.bodies["wheel"].velocity[1] == pytest.approx(-2.5, rel=1e-6)


def test_an_edit_of_bodies_applies_wholly_or_not_at_all(yard: up.Simulation) -> None:
    before = yard.state_hash()
    for wrong, expected in [
        ({"name": "low", "at": (5, 1), "radius": 0.1}, "already"),
        ({"name": "x", "at": (5, 1)}, "no shape"),
        ({"name": "x", "at": (5, 1), "radius": -1}, "greater than 0"),
        ({"name": "x", "at": (5, 1), "radius": 1, "colour": "red"}, "colour"),
    ]:
        with pytest.raises(up.EditError, match=expected), yard.edit() as edit:
            edit.gravity = (1, 1)
            edit.remove_body("high")
            edit.add_body(**wrong)
        assert yard.state_hash() == before and yard.gravity == (0, -9.81)
    with pytest.raises(up.EditError, match="mass"), yard.edit() as edit:
        edit.bodies["low"].set(mass=-1)
    with pytest.raises(up.EditError, match="weight"), yard.edit() as edit:
        edit.bodies["low"].set(weight=1)
    with pytest.raises(up.EditError, match="nobody"), yard.edit() as edit:
        edit.remove_body("nobody")
    assert yard.state_hash() == before


def test_a_changed_world_is_restored_bit_for_bit(yard: up.Simulation) -> None:
    early = yard.state()
    with yard.edit() as edit:
        edit.add_body("new", at=(0.1, 1.4), size=(0.3, 0.3))
        edit.gravity = (0.5, -8)
    yard.step(20)
    state = up.State.from_bytes(yard.state().to_bytes())
    other = yard.scene.build(seed=1)
    other.restore(state)
    assert other.body_names == ["low", "high", "new"] and other.gravity == (0.5, -8)
    for _ in range(20):
        yard.step()
        other.step()
        assert yard.state_hash() == other.state_hash()
    yard.restore(early)
    assert yard.body_names == ["low", "high"] and yard.gravity == (0, -9.81)


def test_a_world_is_asked(yard: up.Simulation) -> None:
    yard.watch_contacts()
    settle(yard)
    contacts = yard.contacts()
    weight = 160 * 9.81
    ground = sum(point.normal_force for point in contacts if point.wall == 0)
    assert ground == pytest.approx(2 * weight, rel=1e-3) and len(contacts) == 4
    wall = yard.diagnostics()["walls"]["ground"]
    assert wall["contact_force"][1] == pytest.approx(-2 * weight, rel=1e-3) and wall["fluid_force"] == (0, 0)
    pairs = {(pair.body, pair.other, pair.wall): pair.impulse[1] for pair in yard.contact_pairs()}
    assert pairs["low", None, 0] == pytest.approx(2 * weight / 60, rel=1e-3)
    events = yard.take_contact_events()
    assert all(event.began for event in events) and len(events) == 2
    (hit, floor) = yard.ray_cast((0.1, 3), (0.1, -1))[:1] + yard.ray_cast((5, 3), (5, -1))
    assert hit.body == "high" and hit.point[1] == pytest.approx(0.8, abs=1e-3)
    assert floor.wall == 0 and floor.fraction == pytest.approx(0.75)
    assert yard.bodies_at((0.1, 0.3)) == ["low"] and yard.bodies_in((-1, 0.3), (1, 0.5)) == ["low", "high"]
    near = yard.nearest((1.2, 0.2), walls=False)
    assert near is not None and near.body == "low" and near.distance == pytest.approx(1.0, abs=1e-3)
    assert yard.nearest((9, 9), within=0.5, walls=False) is None
    yard.wake()
    assert not any(body.asleep for body in yard.bodies.values())
    settle(yard)
    yard.bodies["high"].wake()
    assert not yard.bodies["low"].asleep, "it wakes with what it slept with"


def test_poses_come_as_arrays_and_between_frames(yard: up.Simulation) -> None:
    with yard.edit() as edit:
        edit.add_body("ball", at=(3, 5), radius=0.1, velocity=(6, 0))
    yard.step(3)
    before, velocities = yard.body_poses, yard.body_velocities
    assert before.shape == velocities.shape == (3, 3) and not before.flags.writeable
    yard.step()
    after = yard.body_poses
    np.testing.assert_allclose(yard.interpolated_poses(0.25), before + 0.25 * (after - before), atol=1e-12)
    assert after[2, 0] - before[2, 0] == pytest.approx(0.1)


def test_a_block_of_water_is_poured_into_a_run() -> None:
    scene = up.Scene(spacing=0.1)
    scene.add_liquid("water")
    scene.add_block("water", min=(0, 0), max=(1, 0.5))
    scene.add_tank(min=(0, 0), max=(1, 3))
    sim = scene.build(seed=1)
    with sim.edit() as edit:
        edit.add_block("water", (0.2, 1.0), (0.8, 1.5), velocities=(0, -1))
    assert len(edit.added) == 30 and sim.diagnostics()["counts"]["liquid"] == 80
    with sim.edit() as edit:
        edit.add_body("box", at=(0.5, 2), size=(0.3, 0.3))
    assert sim.body_names == ["box"] and sim.diagnostics()["counts"]["rigid"] == 9
