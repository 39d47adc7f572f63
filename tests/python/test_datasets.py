"""Data sets for learned simulators."""

from __future__ import annotations

import copy
import filecmp
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import unipbd as up
from unipbd import datasets
from unipbd.datasets import _trajectory
from unipbd.datasets._draw import Drawer
from unipbd.datasets._tfrecord import crc32c, masked_crc, sequence_example

h5py = pytest.importorskip("h5py")

RECIPES = sorted((ROOT / "recipes").glob("*.toml"))
POOL: dict[str, Any] = {
    "name": "2D_POOL",
    "trajectories": 6,
    "frames": 9,
    "formats": ["lagrangebench", "gns", "npz"],
    "vary": [{"key": "block.0.max.1", "uniform": [0.4, 0.9]}],
    "scatter": [{"table": "body", "count": {"integers": [0, 2]}, "apart": 0.1, "values": {
        "position": {"uniform": [[0.4, 1.2], [1.6, 1.6]]}, "radius": 0.15, "density": {"choice": [300.0, 2000.0]}}}],
    "scene": {
        "spacing": 0.1, "fps": 60.0,
        "liquid": [{"name": "water"}],
        "block": [{"material": "water", "min": [0.0, 0.0], "max": [1.0, 0.5]}],
        "tank": [{"min": [0.0, 0.0], "max": [2.0, 2.0]}],
    },
}


def small(**values: Any) -> datasets.Recipe:
    return datasets.Recipe.from_dict({**copy.deepcopy(POOL), **values})


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("set")
    datasets.generate(small(), folder, jobs=1)
    return folder


def lagrangebench(folder: Path) -> Path:
    return next(folder.glob("2D_*"))


def same(one: Path, other: Path) -> None:
    names = sorted(path.relative_to(one) for path in one.rglob("*") if path.is_file())
    assert names == sorted(path.relative_to(other) for path in other.rglob("*") if path.is_file())
    wrong = [str(name) for name in names if not filecmp.cmp(one / name, other / name, shallow=False)]
    assert not wrong, wrong


# -- layouts -----------------------------------------------------------------------------------


def test_the_layout_is_that_of_lagrangebench(made: Path) -> None:
    folder = lagrangebench(made)
    metadata = json.loads((folder / "metadata.json").read_text())
    keys = (
        "case solver density_evolution dim dx dt t_end viscosity p_bg_factor g_ext_magnitude artificial_alpha free_slip "
        "write_every is_bc_trick sequence_length_train num_trajs_train sequence_length_test num_trajs_test "
        "num_particles_max periodic_boundary_conditions bounds default_connectivity_radius vel_mean vel_std acc_mean acc_std"
    ).split()
    assert list(metadata) == keys
    largest, moved, changed = 0, [], []
    for split in ("train", "valid", "test"):
        with h5py.File(folder / f"{split}.h5") as file:
            assert list(file) == ["00000", "00001"]
            for group in file.values():
                position, kind = group["position"], group["particle_type"][:]
                assert position.shape == (10, len(kind), 2) and position.dtype == np.float32
                assert position.compression == "gzip" and kind.dtype.kind == "i" and set(kind) <= {0, 1, 3}
                largest = max(largest, len(kind))
                v = np.diff(position[:][:, kind == 0].astype(np.float64), axis=0)
                moved.append(v)
                changed.append(np.diff(v, axis=0))
    assert metadata["num_particles_max"] == largest and folder.name == f"2D_POOL_{largest}_9every1"
    assert metadata["num_trajs_train"] == metadata["num_trajs_test"] == 2
    assert metadata["sequence_length_train"] == metadata["sequence_length_test"] == 9
    assert metadata["default_connectivity_radius"] == pytest.approx(0.145, abs=0.006) and metadata["dx"] == 0.1
    for name, values in (("vel", moved), ("acc", changed)):
        mean = np.mean([part.mean(axis=(0, 1)) for part in values], axis=0)
        std = np.sqrt(np.mean([((part - mean) ** 2).mean(axis=(0, 1)) for part in values], axis=0))
        np.testing.assert_allclose(metadata[f"{name}_mean"], mean, rtol=1e-9, atol=1e-15)
        np.testing.assert_allclose(metadata[f"{name}_std"], std, rtol=1e-9)
    assert "def force_fn(r):" in (folder / "force.py").read_text()
    assert re.search(r"(?:2D|3D)_[A-Z]{3}", folder.name)


def test_all_formats_hold_the_same_trajectories(made: Path) -> None:
    metadata = json.loads((made / "gns" / "metadata.json").read_text())
    for split in ("train", "valid", "test"):
        with h5py.File(lagrangebench(made) / f"{split}.h5") as file, np.load(
            made / "npz" / f"{split}.npz", allow_pickle=True
        ) as npz:
            records = list(datasets.read_records(made / "gns" / f"{split}.tfrecord"))
            assert len(file) == len(records) == len(npz.files)
            for number, (group, record, key) in enumerate(zip(file.values(), records, npz.files, strict=True)):
                index, types, positions = datasets.parse_sequence_example(record)
                assert index == number and positions.shape[0] == metadata["sequence_length"] + 1
                np.testing.assert_array_equal(positions, group["position"][:])
                stored, kinds = npz[key]
                np.testing.assert_array_equal(stored, positions)
                np.testing.assert_array_equal(kinds, types)
                table = {0: 5, 1: 3, 3: 0}
                assert types.tolist() == [table[kind] for kind in group["particle_type"][:]]


def test_checksums_and_messages_are_those_of_the_format() -> None:
    assert crc32c(b"123456789") == 0xE3069283 and crc32c(b"") == 0
    assert crc32c(bytes(32)) == 0x8A9136AA and crc32c(bytes(range(32))) == 0x46DD794E
    slow = 0xFFFFFFFF
    data = np.random.default_rng(0).bytes(5000)
    for byte in data:
        slow ^= byte
        for _ in range(8):
            slow = slow >> 1 ^ (0x82F63B78 if slow & 1 else 0)
    assert crc32c(data) == slow ^ 0xFFFFFFFF
    crc = crc32c(data)
    assert masked_crc(data) == ((crc >> 15 | crc << 17 & 0xFFFFFFFF) + 0xA282EAD8) % 2**32
    example = sequence_example(3, np.array([5]), [np.array([[1.0, 2.0]], dtype=np.float32)])
    types, frame = (5).to_bytes(8, "little"), np.array([1.0, 2.0], dtype="<f4").tobytes()
    context = b"\x0a\x0c" + b"\x0a\x03key\x12\x05\x1a\x03\x0a\x01\x03"
    context += b"\x0a\x1d" + b"\x0a\x0dparticle_type\x12\x0c\x0a\x0a\x0a\x08" + types
    lists = b"\x0a\x1a\x0a\x08position\x12\x0e\x0a\x0c\x0a\x0a\x0a\x08" + frame
    assert example == b"\x0a" + bytes([len(context)]) + context + b"\x12" + bytes([len(lists)]) + lists


def test_a_damaged_record_is_noticed(made: Path, tmp_path: Path) -> None:
    data = bytearray((made / "gns" / "test.tfrecord").read_bytes())
    data[200] ^= 1
    (tmp_path / "test.tfrecord").write_bytes(data)
    with pytest.raises(ValueError, match="damaged"):
        list(datasets.read_records(tmp_path / "test.tfrecord"))


# -- the same bytes ----------------------------------------------------------------------------


def test_shards_and_processes_give_the_same_bytes(made: Path, tmp_path: Path) -> None:
    assert datasets.generate(small(), tmp_path, shard=(2, 2), jobs=2) == []
    with pytest.raises(FileNotFoundError):
        datasets.assemble(small(), tmp_path)
    datasets.generate(small(), tmp_path, shard=(1, 2), jobs=1)
    folders = datasets.generate(small(), tmp_path)
    assert [folder.name for folder in folders] == [lagrangebench(made).name, "gns", "npz"]
    same(made, tmp_path)


class Killed(BaseException):
    pass


def test_a_killed_run_goes_on_and_gives_the_same_bytes(
    made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(progress: datasets.Progress) -> None:
        if progress.done == 2:
            raise Killed

    with pytest.raises(Killed):
        datasets.generate(small(), tmp_path, jobs=1, progress=stop)
    # The next is killed between two states, after the first of them.
    stored, resumed = _trajectory._Run._store, []

    def store(run: Any, number: int) -> None:
        stored(run, number)
        if number == 8:
            raise KeyboardInterrupt

    monkeypatch.setattr(_trajectory, "CHECKPOINT", 5)
    monkeypatch.setattr(_trajectory._Run, "_store", store)
    with pytest.raises(KeyboardInterrupt):
        datasets.generate(small(), tmp_path, jobs=1)
    monkeypatch.setattr(_trajectory._Run, "_store", stored)
    resume = _trajectory._Run._resume
    monkeypatch.setattr(_trajectory._Run, "_resume", lambda *all: resumed.append(resume(*all)) or resumed[-1])
    datasets.generate(small(), tmp_path, jobs=1)
    assert resumed[0] == 6 and not any(resumed[1:])
    same(made, tmp_path)
    assert datasets.generate(small(), tmp_path) and len(resumed) == 4, "a complete set is left alone"


def test_a_folder_of_another_recipe_is_refused(made: Path) -> None:
    with pytest.raises(up.UnipbdError, match="frames, seed differ"):
        datasets.generate(small(seed=5, frames=8), made)


def test_the_manifest_says_all_that_a_trajectory_was_made_from(made: Path) -> None:
    manifest = json.loads((made / "manifest.json").read_text())
    assert manifest["unipbd"] == up.__version__ and len(manifest["trajectories"]) == 6
    record = manifest["trajectories"][2]
    sim = up.Scene.from_dict(record["scene"]).build(seed=record["seed"])
    assert f"{sim.state_hash():016x}" == record["state_hash_first"]
    sim.step(9)
    assert f"{sim.state_hash():016x}" == record["state_hash_last"]
    counts = {len(one["scene"].get("body", [])) for one in manifest["trajectories"]}
    assert len(counts) > 1, "the number of bodies is drawn"


# -- what is refused ---------------------------------------------------------------------------


def test_refused_runs_are_drawn_again_and_counted(tmp_path: Path) -> None:
    recipe = small(filter={"speed": 4.5}, vary=[{"key": "block.0.velocity.0", "uniform": [0.5, 6.0]}], scatter=[])
    datasets.generate(recipe, tmp_path, jobs=1)
    manifest = json.loads((tmp_path / "manifest.json").read_text())
    assert manifest["refused"]["speed"] == sum(len(one["refused"]) for one in manifest["trajectories"]) > 0
    with np.load(tmp_path / "diagnostics.npz") as file:
        assert file["values"][:, :, list(file["columns"]).index("speed_max")].max() <= 4.5


def test_where_every_draw_is_refused_the_reason_is_said(tmp_path: Path) -> None:
    with pytest.raises(up.UnipbdError, match="all 2 draws were refused, the last one: speed: speed_max"):
        datasets.generate(small(filter={"speed": 1e-9}, attempts=2), tmp_path, jobs=1)
    crowded = {**POOL["scatter"][0], "count": 60}
    with pytest.raises(up.UnipbdError, match="crowded: no room for 60"):
        datasets.generate(small(scatter=[crowded], attempts=2), tmp_path / "other", jobs=1)


def test_particles_that_come_and_go_are_refused(tmp_path: Path) -> None:
    scene = {**POOL["scene"], "sink": [{"region": {"min": [0.0, 0.0], "max": [0.5, 0.5]}}]}
    with pytest.raises(up.UnipbdError, match="come and go"):
        datasets.generate(small(scene=scene, scatter=[]), tmp_path, jobs=1)


@pytest.mark.parametrize(("old", "new", "line", "message"), [
    ("frames = 4", "frame = 4", 2, "did you mean 'frames'"),
    ("frames = 4", "frames = 0", 2, "from 1 on"),
    ('key = "block.0.max.1"', 'key = "block.7.max"', 7, "ends before '7'"),
    ("uniform = [0.2, 0.5]", "uniform = [0.5, 0.2]", 8, "lies above"),
    ("uniform = [0.2, 0.5]", "unifrom = [0.2, 0.5]", 6, "a distribution is wanted"),
    ("spacing = 0.1", "spacing = -0.1", 11, "spacing"),
    ("min = [0.0, 0.0]", "mim = [0.0, 0.0]", 14, "mim"),
    ('kind = "reverse"', 'kind = "revers"', 4, "there are reverse, sway"),
    ("frames = 4", "frames = ", 2, "no TOML"),
])
def test_a_mistake_is_named_with_its_line(old: str, new: str, line: int, message: str, tmp_path: Path) -> None:
    text = """name = "2D_POOL"
frames = 4
[force]
kind = "reverse"
acceleration = [1.0, 0.0]
[[vary]]
key = "block.0.max.1"
uniform = [0.2, 0.5]

[scene]
spacing = 0.1
[[scene.block]]
material = "water"
min = [0.0, 0.0]
max = [1.0, 0.5]
[[scene.liquid]]
name = "water"
"""
    assert old in text
    path = tmp_path / "recipe.toml"
    path.write_text(text.replace(old, new))
    with pytest.raises(datasets.RecipeError) as caught:
        datasets.Recipe.load(path)
    assert message in str(caught.value) and abs((caught.value.line or 0) - line) <= 1, str(caught.value)


# -- scenes ------------------------------------------------------------------------------------


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


def test_walls_of_a_simulation_are_particles_on_request(sim: up.Simulation) -> None:
    one, two = sim.wall_particles(), sim.wall_particles(layers=2)
    assert len(one) == 2 * (20 + 30) + 4 and len(two) == len(one) + 2 * (22 + 32) + 4
    inside = (one > 0).all(axis=1) & (one < (2, 3)).all(axis=1)
    assert not inside.any() and one.dtype == np.float32


def test_bodies_have_the_type_of_their_kind(tmp_path: Path) -> None:
    scene = {**POOL["scene"], "body": [
        {"name": "paddle", "kind": "kinematic", "size": [0.4, 0.3], "position": [1.6, 0.5]},
        {"name": "rock", "kind": "static", "radius": 0.2, "position": [1.3, 1.3]},
        {"name": "ball", "radius": 0.2, "position": [0.5, 1.5]},
    ]}
    datasets.generate(small(scene=scene, scatter=[], trajectories=3, frames=2), tmp_path, jobs=1)
    with h5py.File(lagrangebench(tmp_path) / "train.h5") as file:
        position, kind = file["00000/position"][0], file["00000/particle_type"][:]
    near = {2: ([1.6, 0.5], 0.26), 3: ([0.5, 1.5], 0.21)}
    for value, (middle, radius) in near.items():
        assert (kind == value).sum() >= 8
        assert np.linalg.norm(position[kind == value] - middle, axis=1).max() < radius
    rock = (kind == 1) & (np.linalg.norm(position - [1.3, 1.3], axis=1) < 0.21)
    assert rock.sum() >= 8


def test_one_long_run_is_cut_in_time(tmp_path: Path) -> None:
    datasets.generate(small(trajectories=1, frames=19, cut="frames", scatter=[], warm_up=0.1), tmp_path, jobs=1)
    metadata = json.loads((lagrangebench(tmp_path) / "metadata.json").read_text())
    lengths = []
    for split in ("train", "valid", "test"):
        with h5py.File(lagrangebench(tmp_path) / f"{split}.h5") as file:
            lengths.append(len(file["00000/position"]))
    assert lengths == [10, 5, 5] and metadata["sequence_length_train"] == 9 and metadata["sequence_length_test"] == 4


# -- the report --------------------------------------------------------------------------------


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


# -- the command -------------------------------------------------------------------------------


def command(*arguments: object) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, "-m", "unipbd._command", *map(str, arguments)]
    return subprocess.run(words, capture_output=True, text=True)


def test_the_command_makes_a_set_and_reports(tmp_path: Path) -> None:
    scene = up.Scene.from_dict(POOL["scene"])
    scene.save(tmp_path / "pool.toml")
    (tmp_path / "recipe.toml").write_text('name = "2D_POOL"\nscene = "pool.toml"\ntrajectories = 3\nframes = 50\n')
    out = tmp_path / "out"
    options = (tmp_path / "recipe.toml", "-o", out, "--set", "frames=6", "--jobs", 1)
    assert "before compression" in command("dataset", *options, "--dry-run").stderr and not out.exists()
    first = command("dataset", *options, "--shard", "1/2")
    assert first.returncode == 0 and "puts them together" in first.stdout, first.stderr
    made = command("dataset", *options, "-q")
    assert made.returncode == 0 and "_6every1" in made.stdout, made.stderr
    report = command("dataset", "report", out, "--no-pictures")
    assert report.returncode == 0 and "largest compression" in report.stdout, report.stderr
    wrong = command("dataset", tmp_path / "recipe.toml", "-o", tmp_path / "other", "--set", "farmes=6")
    assert wrong.returncode == 3 and "did you mean 'frames'" in wrong.stderr
    assert command("dataset", "report", tmp_path / "nowhere").returncode == 4
