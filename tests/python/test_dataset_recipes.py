"""Shipped recipes, walls as particles, and the report with its physical checks."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from small_dataset import RECIPES, lagrangebench, small

import unipbd as up
from unipbd import datasets
from unipbd.datasets import _trajectory
from unipbd.datasets._draw import Drawer

pytest.importorskip("h5py")


@pytest.mark.parametrize("path", RECIPES, ids=lambda path: path.stem)
def test_shipped_recipes_make_scenes_that_run(path: Path) -> None:
    recipe = datasets.Recipe.load(path)
    assert recipe == recipe.changed() and recipe.digest() == recipe.changed().digest()
    data, seed = Drawer(recipe).draw(1, 0)
    assert (data, seed) == Drawer(recipe).draw(1, 0) != Drawer(recipe).draw(2, 0)
    made = [_trajectory.first_simulation(recipe.changed(seed=number))[0] for number in range(2)]
    assert all(len(sim) > 1000 for sim in made)


def test_the_sets_of_lagrangebench_have_its_numbers_of_particles() -> None:
    wanted = {"taylor_green": (2500, 0), "reverse_poiseuille": (3200, 0), "lid_driven_cavity": (2500, 208),
              "dam_break": (5000, 740)}
    for name, (fluid, wall) in wanted.items():
        recipe = datasets.Recipe.load(ROOT / "recipes" / f"{name}.toml")
        scene = up.Scene.from_dict(recipe.scene)
        walls = datasets.wall_particles(scene, 1, float(recipe.walls["reach"]))
        assert (scene.estimate()["particles_at_start"], len(walls.positions)) == (fluid, wall)
    assert wanted["lid_driven_cavity"][0] + 208 == 2708


def test_walls_are_where_the_fluid_would_go_on_and_a_lid_goes_round() -> None:
    recipe = datasets.Recipe.load(ROOT / "recipes" / "lid_driven_cavity.toml")
    walls = datasets.wall_particles(up.Scene.from_dict(recipe.scene), 1, 3.0)
    lid = walls.types == 2
    assert lid.sum() == 56 and walls.velocities[lid].tolist() == 56 * [[1.0, 0.0]]
    start, later = walls.at(0.0, True), walls.at(0.3, True)
    np.testing.assert_array_equal(start[~lid], later[~lid])
    np.testing.assert_allclose(later[lid, 0], (start[lid, 0] + 0.3) % 1.12, atol=1e-6)
    np.testing.assert_array_equal(walls.at(0.3, False), start)
    apart = np.linalg.norm(walls.positions[:, None] - walls.positions[None], axis=2) + np.eye(len(lid))
    assert apart.min() == pytest.approx(0.02, rel=1e-6)


def test_walls_are_half_a_spacing_behind_surfaces_that_the_lattice_does_not_meet() -> None:
    scene = up.Scene.from_dict({"spacing": 0.06, "body": [{"radius": 0.1, "position": [1, 1]}], "tank": [{"min": [0, 0], "max": [2.0, 1.5]}],
                                "obstacle": [{"min": [0.5, 0], "max": [0.9, 0.5]}]})
    walls = datasets.wall_particles(scene).positions
    outer = walls[(walls < 0).any(axis=1) | (walls > (2.0, 1.5)).any(axis=1)]
    assert np.ptp(outer[:, 0]) == pytest.approx(2.06) and np.ptp(outer[:, 1]) == pytest.approx(1.56)
    floor = np.sort(outer[outer[:, 1] < 0, 0])
    assert np.diff(floor).max() < 1.1 * 0.06 and np.diff(floor).min() > 0.9 * 0.06 - 1e-9
    inner = walls[(walls > 0).all(axis=1) & (walls < (2, 1.5)).all(axis=1)]
    assert inner[:, 0].min() == pytest.approx(0.53, abs=0.005) and inner[:, 0].max() == pytest.approx(0.87, abs=0.005)


def test_walls_of_a_simulation_are_particles_on_request(sim: up.Simulation) -> None:
    one, two = sim.wall_particles(), sim.wall_particles(layers=2)
    assert len(one) == 2 * (20 + 30) + 4 and len(two) == len(one) + 2 * (22 + 32) + 4
    inside = (one > 0).all(axis=1) & (one < (2, 3)).all(axis=1)
    assert not inside.any() and one.dtype == np.float32
    both = sim.positions_with_walls(2)
    np.testing.assert_array_equal(both, np.concatenate([sim.positions, two]))
    sim.step()
    np.testing.assert_array_equal(sim.positions_with_walls(2)[: len(sim)], sim.positions)


def test_a_report_recomputes_statistics_and_fits_the_viscosity(tmp_path: Path) -> None:
    recipe = datasets.Recipe.load(ROOT / "recipes" / "taylor_green.toml", {
        "scene.spacing": 0.04, "trajectories": 3, "frames": 60, "formats": ["lagrangebench", "gns"]})
    datasets.generate(recipe, tmp_path, jobs=1)
    made = datasets.report(tmp_path)
    figures = {check.name: check for check in made.checks}
    assert figures["fitted viscosity over the true one"].value == pytest.approx(1.0, abs=0.06)
    assert all(check.value < 1e-9 for name, check in figures.items() if name.startswith("statistics"))
    assert made.spectrum[:, 1].sum() == pytest.approx(1.0) and all(path.exists() for path in made.pictures)
    assert (tmp_path / "report.txt").read_text().strip() == str(made)
    path = lagrangebench(tmp_path) / "metadata.json"
    wrong = json.loads(path.read_text())
    wrong["vel_std"][0] *= 1.001
    path.write_text(json.dumps(wrong))
    assert not datasets.report(tmp_path, pictures=False).passed


def test_a_report_needs_one_format_alone(tmp_path: Path) -> None:
    datasets.generate(small(formats=["gns"]), tmp_path, jobs=1)
    assert [path.name for path in tmp_path.iterdir() if path.is_dir()] == ["gns"]
    made = datasets.report(tmp_path, pictures=False)
    assert made.passed and any(check.name.startswith("largest momentum") for check in made.checks)


@pytest.mark.parametrize(("name", "changes"), [
    ("taylor_green", {"trajectories": 4}),
    ("reverse_poiseuille", {"frames": 200, "warm_up": 15.0}),
    ("lid_driven_cavity", {"frames": 200, "warm_up": 20.0}),
    ("dam_break", {"trajectories": 3, "frames": 120}),
])
def test_flows_with_a_known_answer_have_it(name: str, changes: dict[str, Any], tmp_path: Path, full_tier: bool) -> None:
    if not full_tier:
        pytest.skip("minutes: full tier")
    datasets.generate(datasets.Recipe.load(ROOT / "recipes" / f"{name}.toml", changes), tmp_path)
    made = datasets.report(tmp_path)
    assert made.passed, str(made)
