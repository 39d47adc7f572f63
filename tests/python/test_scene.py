"""Scene descriptions."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import SCENES, pool

import unipbd as up


def test_every_scene_of_the_project_is_read_and_written_back_the_same() -> None:
    paths = sorted(SCENES.glob("*.toml"))
    assert paths
    for path in paths:
        scene = up.Scene.load(path)
        assert up.Scene.from_toml(scene.to_toml()) == scene
        assert up.Scene.from_dict(scene.to_dict()) == scene


def test_the_description_is_read_and_edited_by_attribute() -> None:
    scene = up.Scene.load(SCENES / "open_gas.toml")
    assert scene.gas[0].name == "air"
    scene.materials["air"].density = 2.5
    scene.emitter[0].smoke.per_particle = 2
    scene.emitters["nozzle"].speed = 0.9
    scene.solver.substeps = 3
    scene.gravity = np.array([0.0, -1.62])
    scene.gas[0].keep_radius = None
    again = up.Scene.from_toml(scene.to_toml())
    assert again.gas[0].density == 2.5 and again.gas[0].keep_radius is None
    assert again.emitter[0].smoke.per_particle == 2 and again.emitter[0].speed == 0.9
    assert again.solver.substeps == 3 and again.gravity == (0.0, -1.62)
    assert "density" in dir(again.gas[0]) and "rest density" in again.gas[0].describe().lower()


def test_a_misspelt_key_is_noticed_where_it_is_written(scene: up.Scene) -> None:
    with pytest.raises(AttributeError, match="did you mean 'surface_tension'"):
        scene.materials["water"].surfac_tension = 0.1
    with pytest.raises(AttributeError, match="did you mean 'spacing'"):
        scene.spacng = 0.1
    with pytest.raises(AttributeError):
        scene.add_liquid("oil", densty=800.0)
    with pytest.raises(KeyError, match="there is 'water'"):
        scene.materials["wine"]
    with pytest.raises(AttributeError, match="write `xsph` or `kinematic_viscosity`"):
        scene.materials["water"].viscosity = 0.1
    assert scene == pool()


def test_all_problems_of_a_scene_come_at_once_with_keys_and_hints(scene: up.Scene) -> None:
    scene.materials["water"].density = -1.0
    scene.block[0].material = "watr"
    scene.add("tank", min=(0, 0))
    with pytest.raises(up.SceneError) as caught:
        scene.build()
    error = caught.value
    assert isinstance(error, ValueError) and isinstance(error, up.UnipbdError)
    keys = {problem.key for problem in error.problems}
    assert any("density" in key for key in keys) and any("tank[1]" in key for key in keys), keys
    assert error.path is None and error.line is None
    copied = pickle.loads(pickle.dumps(error))
    assert str(copied) == str(error) and copied.problems == error.problems


def test_a_fault_in_a_file_names_its_line_and_column(tmp_path: Path) -> None:
    path = tmp_path / "faulty.toml"
    path.write_text('spacing = 0.1\n[[liquid]]\nname = "water"\ndensty = 3.0\n[[block]]\nmaterial = "water"\n')
    with pytest.raises(up.SceneError) as caught:
        up.Scene.load(path)
    assert (caught.value.path, caught.value.line, caught.value.column) == (str(path), 4, 1)
    assert "density" in (caught.value.hint or "")
    with pytest.raises(FileNotFoundError):
        up.Scene.load(tmp_path / "missing.toml")


@pytest.mark.parametrize("value", [float("nan"), float("inf"), "wide", [1, 2, 3], {"a": 1}, 10**30, object()])
def test_nonsense_is_a_clear_error(scene: up.Scene, value: object) -> None:
    with pytest.raises((up.SceneError, TypeError, ValueError)):
        scene.spacing = value
        scene.build()


def test_particles_are_placed_by_arrays(scene: up.Scene) -> None:
    xy = np.array([[1.5, 2.0], [1.6, 2.2]])
    scene.add_particles("water", positions=xy, velocities=(1.0, 0.0))
    scene.add_particles("water", positions=[(1.5, 2.5)])
    assert up.Scene.from_toml(scene.to_toml()).points[0].positions == ([1.5, 2.0], [1.6, 2.2])
    scene.solver.settle_substeps = 0
    sim = scene.build()
    assert len(sim) == 103
    np.testing.assert_allclose(sim.positions[100:], [[1.5, 2.0], [1.6, 2.2], [1.5, 2.5]], rtol=1e-6)
    np.testing.assert_allclose(sim.velocities[100:], [[1, 0], [1, 0], [0, 0]])
    for wrong in ([1.0, 2.0], np.zeros((3, 3)), [["a", "b"]], np.zeros((2, 2), dtype=complex)):
        with pytest.raises(ValueError):
            scene.add_particles("water", positions=wrong)
    with pytest.raises(ValueError, match="do not fit"):
        scene.add_particles("water", positions=xy, velocities=np.zeros((3, 2)))


def test_scenes_are_copied_compared_and_pickled(scene: up.Scene) -> None:
    other = copy.deepcopy(scene)
    assert other == scene and pickle.loads(pickle.dumps(scene)) == scene
    other.solver.substeps = 4
    assert other != scene
    assert scene.estimate()["particles_at_start"] == 100
    assert "1 liquid" in repr(scene)


def test_building_takes_the_scene_as_it_is_then(scene: up.Scene) -> None:
    sim = scene.build()
    scene.materials["water"].density = 5.0
    assert sim.material("water").density == 1000.0
    assert scene.build().material("water").density == 5.0
