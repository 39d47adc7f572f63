"""Making data sets for learned simulators: shards, kills, filters, mistakes, the command."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import command
from kills import killed
from small_dataset import POOL, lagrangebench, same, small

import unipbd as up
from unipbd import datasets
from unipbd.datasets import _trajectory

pytest.importorskip("h5py")

# -- the same bytes ----------------------------------------------------------------------------


def test_shards_and_processes_give_the_same_bytes(small_set: Path, tmp_path: Path) -> None:
    assert datasets.generate(small(), tmp_path, shard=(2, 2), jobs=2) == []
    with pytest.raises(FileNotFoundError):
        datasets.assemble(small(), tmp_path)
    datasets.generate(small(), tmp_path, shard=(1, 2), jobs=1)
    folders = datasets.generate(small(), tmp_path)
    assert [folder.name for folder in folders] == [lagrangebench(small_set).name, "gns", "npz"]
    same(small_set, tmp_path)


def test_threads_give_the_same_bytes(tmp_path: Path) -> None:
    recipe = small(scene={**POOL["scene"], "spacing": 0.012}, frames=3, trajectories=3)
    for threads in (1, 3):
        record = _trajectory.run_trajectory(recipe, 0, tmp_path / str(threads), threads)
        assert record["particles"] > 2000
    same(tmp_path / "1", tmp_path / "3")


class Killed(BaseException):
    pass


def test_a_killed_run_goes_on_and_gives_the_same_bytes(
    small_set: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
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
    same(small_set, tmp_path)
    assert datasets.generate(small(), tmp_path) and len(resumed) == 4, "a complete set is left alone"


def test_a_command_that_was_killed_goes_on_and_gives_the_same_bytes(tmp_path: Path) -> None:
    whole, parts, recipe = tmp_path / "whole", tmp_path / "parts", tmp_path / "recipe.toml"
    up.Scene.from_dict(POOL["scene"]).save(tmp_path / "pool.toml")
    recipe.write_text('name = "2D_POOL"\nscene = "pool.toml"\ntrajectories = 24\nframes = 80\n'
                      '[[vary]]\nkey = "block.0.max.1"\nuniform = [0.4, 0.9]\n')
    datasets.generate(recipe, whole, jobs=1)
    arguments = ["dataset", recipe, "-o", parts, "--jobs", 2]
    killed([*arguments, "--shard", "1/2"], lambda: len(list(parts.glob("parts/*/record.json"))) >= 2)
    assert not (parts / "manifest.json").exists()
    killed(arguments, lambda: len(list(parts.glob("parts/*/record.json"))) >= 8)
    assert len(list(parts.glob("parts/*/record.json"))) < 24
    made = command(*arguments)
    assert made.returncode == 0, made.stderr
    same(whole, parts)


def test_a_folder_of_another_recipe_is_refused(small_set: Path) -> None:
    with pytest.raises(up.UnipbdError, match="frames, seed differ"):
        datasets.generate(small(seed=5, frames=8), small_set)


def test_the_manifest_says_all_that_a_trajectory_was_made_from(small_set: Path) -> None:
    manifest = json.loads((small_set / "manifest.json").read_text())
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


def test_runs_that_warn_are_drawn_again_unless_the_warning_is_to_be_ignored(tmp_path: Path) -> None:
    scene = {**POOL["scene"], "solver": {"max_substeps": 3}}
    values = {"scene": scene, "vary": [{"key": "block.0.velocity.0", "uniform": [0.0, 9.0]}], "scatter": []}
    datasets.generate(small(**values), tmp_path / "strict", jobs=1)
    manifest = json.loads((tmp_path / "strict" / "manifest.json").read_text())
    reasons = [reason for one in manifest["trajectories"] for reason in one["refused"]]
    assert manifest["refused"] == {"warning": len(reasons)} and "substeps capped at 3" in reasons[0]
    assert all(one["attempt"] == len(one["refused"]) for one in manifest["trajectories"])
    datasets.generate(small(**values, filter={"ignore": ["substeps capped"]}), tmp_path / "lenient", jobs=1)
    assert json.loads((tmp_path / "lenient" / "manifest.json").read_text())["refused"] == {}


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


# -- the command -------------------------------------------------------------------------------


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
