"""Hooks and constraint groups written in Python."""

from __future__ import annotations

import inspect
import textwrap

import numpy as np
import pytest

import unipbd as up


def free_points(positions: object, **values: object) -> up.Scene:
    scene = up.Scene(gravity=(0, 0), spacing=0.1)
    scene.add_solid("beads")
    scene.add_particles("beads", positions, **values)  # type: ignore[arg-type]
    scene.solver.substeps = 40
    return scene


def test_a_central_force_keeps_a_bead_on_its_circle() -> None:
    sim = free_points([(1.0, 0.0)], velocities=(0.0, 3.0)).build()
    sim.on_substep(lambda s: s.add_acceleration(-9.0 * s.positions))
    sim.step(60)
    angle = 3.0 * sim.time
    np.testing.assert_allclose(sim.positions[0], (np.cos(angle), np.sin(angle)), atol=0.03)


def test_a_hook_sees_arrays_in_the_order_of_ids(plume: up.Scene) -> None:
    sim = plume.build(seed=1)
    sim.step(20)
    seen: list[tuple[float, int]] = []

    @sim.on_substep
    def look(s: up.Substep) -> None:
        assert np.all(np.diff(s.ids.astype(np.int64)) > 0)
        n = len(s.ids)
        assert s.positions.shape == s.velocities.shape == (n, 2)
        assert s.phases.shape == s.material_indices.shape == (n,)
        seen.append((s.time, s.step))

    first = sim.substeps
    sim.step(3)
    assert [step for _, step in seen] == list(range(first, sim.substeps))
    assert len({time for time, _ in seen}) == len(seen)
    sim.remove_hook(look)
    sim.step()
    assert seen[-1][1] < sim.substeps - 1


def test_an_exception_in_a_hook_comes_out_as_itself_and_the_run_goes_on(sim: up.Simulation) -> None:
    class Mine(Exception):
        pass

    calls = 0

    def fails_once(s: up.Substep) -> None:
        nonlocal calls
        calls += 1
        if calls == 5:
            raise Mine("enough")

    expected = sim.copy()
    expected.step(10)
    sim.on_substep(fails_once)
    with pytest.raises(Mine, match="enough"):
        sim.step(10)
    state = sim.state()
    sim.restore(state)
    while sim.frame < 10:
        sim.step()
    assert sim.state_hash() == expected.state_hash()


@pytest.mark.parametrize("wrong", [np.zeros((3, 2)), np.full((100, 2), np.nan), "up", np.zeros(3), None, 1e300])
def test_a_wrong_acceleration_is_a_clear_error(sim: up.Simulation, wrong: object) -> None:
    sim.on_substep(lambda s: s.add_acceleration(wrong))  # type: ignore[arg-type]
    with pytest.raises((ValueError, TypeError)):
        sim.step()
    sim._hooks.clear()
    sim.step()
    assert np.isfinite(sim.positions).all()


def test_the_simulation_is_busy_within_its_own_hook(sim: up.Simulation) -> None:
    sim.on_substep(lambda s: sim.step())
    with pytest.raises(up.BusyError):
        sim.step()


def test_a_substep_kept_for_later_says_that_it_is_over(sim: up.Simulation) -> None:
    kept: list[up.Substep] = []
    sim.on_substep(kept.append)
    sim.step()
    with pytest.raises(up.UnipbdError, match="over"):
        kept[0].add_acceleration((1, 0))
    assert kept[0].positions.shape == (100, 2)


def test_hooks_move_kinematic_particles() -> None:
    sim = free_points([(0.0, 0.0), (5.0, 5.0)], motion="kinematic").build()
    sim.on_substep(lambda s: s.set_velocities([1], (np.cos(s.time), 0.0)))
    sim.step(60)
    np.testing.assert_allclose(sim.positions, [(0, 0), (5 + np.sin(1.0), 5)], atol=0.02)


def test_a_constraint_group_in_python_holds_a_pendulum() -> None:
    scene = free_points([(1.0, 0.0)])
    scene.gravity = (0.0, -9.81)
    sim = scene.build()

    def ring(p: up.Projection) -> object:
        length = np.linalg.norm(p.positions, axis=1, keepdims=True)
        return (1.0 - length) * p.positions / length

    sim.add_group("ring", ring)  # type: ignore[arg-type]
    assert sim.stages[1:3] == ["begin_groups", "project"]
    lowest = 0.0
    for _ in range(120):
        sim.step()
        assert abs(np.linalg.norm(sim.positions[0]) - 1.0) < 1e-4
        lowest = min(lowest, float(sim.positions[0, 1]))
    assert lowest < -0.98
    height_gone = sim.energy / (10.0 * 9.81)  # of a mass of 1000 kg/m^2 times (0.1 m)^2
    assert -0.05 < height_gone < 0.01


def test_the_rod_of_the_documentation_holds_its_length_and_the_momentum() -> None:
    doc = inspect.getdoc(up.Simulation.add_group) or ""
    code = textwrap.dedent(doc.split("3 and 4::", 1)[1]).replace("[3, 4]", "[0, 2]")
    scene = free_points([(0.0, 0.0), (3.0, 3.0), (0.5, 0.0)], velocities=[(0, 1), (0, 0), (0, -2)])
    sim = scene.build()
    exec(code, {"np": np, "sim": sim})
    farthest = 0.0
    for _ in range(60):
        sim.step()
        apart = np.linalg.norm(sim.positions[0] - sim.positions[2])
        assert apart == pytest.approx(0.5, abs=2e-3)
        farthest = max(farthest, float(sim.positions[0, 0]))
    assert farthest > 0.45, "it turns"
    np.testing.assert_allclose(sim.velocities[[0, 2]].sum(axis=0), (0.0, -1.0), atol=1e-3)
    np.testing.assert_array_equal(sim.positions[1], (3.0, 3.0))


def test_an_exception_in_a_group_comes_out_as_itself(sim: up.Simulation) -> None:
    broken = True

    def project(p: up.Projection) -> np.ndarray | None:
        if broken:
            raise ZeroDivisionError("in the group")
        return None

    sim.add_group("broken", project)
    with pytest.raises(ZeroDivisionError, match="in the group"):
        sim.step()
    broken = False
    frame = sim.frame
    sim.step(2)
    assert sim.frame == frame + 2


@pytest.mark.parametrize("wrong", [1e30, -1e30, 3e15])
def test_an_absurd_acceleration_names_the_hook_and_the_value(wrong: float, sim: up.Simulation) -> None:
    def whirl(substep: up.Substep) -> None:
        substep.add_acceleration((wrong, 0.0))

    sim.on_substep(whirl)
    before = sim.state_hash()
    with pytest.raises(ValueError, match=r"the hook .*whirl accelerates particles by \(-?(1e30|3e15), 0e0\) m/s\^2.*limit"):
        sim.step(1)
    assert sim.state_hash() == before
    sim.remove_hook(whirl)
    sim.step(1)


def test_hooks_that_together_accelerate_absurdly_are_stopped_too(scene: up.Scene) -> None:
    scene.solver.substeps = 100
    sim = scene.build(threads=1)
    for _ in range(4):
        sim.on_substep(lambda substep: substep.add_acceleration((1e10, 0.0)))
    with pytest.raises(up.SolverError, match="a hook accelerates particle 0"):
        sim.step(1)


def test_an_absurd_displacement_names_the_group_and_the_value(sim: up.Simulation) -> None:
    sim.add_group("pull", lambda projection: np.full((len(projection.ids), 2), 1e30))
    with pytest.raises(ValueError, match=r'the group "pull" moves row 0 by \(1e30, 1e30\) m; the limit is'):
        sim.step(1)
