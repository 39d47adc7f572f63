"""Gauges and motions by tables from Python."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import unipbd as up


@pytest.fixture
def gauged(scene: up.Scene) -> up.Scene:
    scene.tank[0]["name"] = "tank"
    scene.add_gauge("depth", "level", at=(0.5, 0.0))
    scene.add_gauge("floor", "force", on="tank bottom", direction=(0, -1))
    scene.add_gauge("dry", "level", at=(90.0, 0.0))
    return scene


def test_gauges_read_floats_by_name_and_nan_where_there_is_nothing(gauged: up.Scene) -> None:
    sim = gauged.build(seed=7, threads=1)
    start = sim.gauges
    assert list(start) == ["depth", "floor", "dry"]
    assert abs(start["depth"] - 1.0) < 0.05 and math.isnan(start["floor"]) and math.isnan(start["dry"])
    sim.step(60)
    assert abs(sim.gauges["floor"] + sim.wall_forces["tank bottom"][1]) < 1e-9
    assert sim.diagnostics()["gauges"]["depth"] == {"value": sim.gauges["depth"], "kind": "level"}


def test_gauges_come_back_from_a_log(gauged: up.Scene, tmp_path: Path) -> None:
    sim = gauged.build(seed=7, threads=1)
    path = tmp_path / "run.mcap"
    read = [sim.gauges]
    with sim.record(path):
        for _ in range(5):
            sim.step(1)
            read.append(sim.gauges)
    log = up.read_log(path)
    for frame, expected in zip(log, read, strict=True):
        np.testing.assert_equal(frame.gauges, expected)
    table = log.gauges()
    assert list(table) == ["time", "depth", "floor", "dry"]
    np.testing.assert_array_equal(table["depth"], [row["depth"] for row in read])
    pandas = pytest.importorskip("pandas")
    frame = log.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame["gauge_depth"].iloc[-1] == read[-1]["depth"]


def test_a_scene_without_gauges_has_none(scene: up.Scene, tmp_path: Path) -> None:
    sim = scene.build(seed=7, threads=1)
    with sim.record(tmp_path / "run.mcap"):
        sim.step(1)
    assert sim.gauges == {} and next(iter(up.read_log(tmp_path / "run.mcap"))).gauges == {}


def test_a_faulty_gauge_is_named(gauged: up.Scene) -> None:
    gauged.add_gauge("depth", "front", direction=(1, 0))
    gauged.add_gauge("push", "force", on="tank botom")
    with pytest.raises(up.SceneError) as raised:
        gauged.build()
    said = str(raised.value)
    assert "taken by" in said and "did you mean" in said and "tank bottom" in said


MOVED = """
spacing = 0.1
[[body]]
name = "maker"
kind = "kinematic"
size = [0.5, 1.0]
position = [0.0, 1.0]
motion = { file = "maker.csv" }
"""


def test_a_body_follows_a_file_from_the_folder_of_its_scene(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "maker.csv").write_text("time,x,angle_deg\n0,0,0\n0.5,0.2,30\n1,0.1,10\n")
    (tmp_path / "maker.toml").write_text(MOVED)
    scenes = [up.Scene.load(tmp_path / "maker.toml"), up.Scene.from_toml(MOVED, folder=tmp_path)]
    monkeypatch.chdir(tmp_path)
    scenes.append(up.Scene.from_toml(MOVED))
    bare = up.Scene(spacing=0.1)
    bare.add_body("maker", at=(0, 1), size=(0.5, 1.0), kind="kinematic", motion={"file": "maker.csv"})
    for scene in [*scenes, bare]:
        sim = scene.build()
        sim.step(30)
        body = sim.bodies["maker"]
        assert abs(body.position[0] - 0.2) < 1e-12 and abs(body.angle - math.radians(30)) < 1e-12


def test_a_log_holds_the_samples_of_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "maker.csv").write_text("time,x\n0,0\n1,0.2\n")
    sim = up.Scene.from_toml(MOVED, folder=tmp_path).build()
    with sim.record(tmp_path / "run.mcap"):
        sim.step(1)
    (tmp_path / "maker.csv").unlink()
    scene = up.read_log(tmp_path / "run.mcap").scene
    assert scene.body[0].motion.table.x == [0.0, 0.2]
    assert scene.build().bodies["maker"].position[0] == 0.0


def test_a_mistake_in_a_file_is_named_with_its_line(tmp_path: Path) -> None:
    (tmp_path / "maker.csv").write_text("time,x\n0,0\n0,0.2\n")
    with pytest.raises(up.SceneError, match="maker.csv, line 3: time must increase"):
        up.Scene.from_toml(MOVED, folder=tmp_path)


def test_a_scene_is_shaken_by_arrays(scene: up.Scene) -> None:
    scene.shaking.table = {"time": [0.0, 0.1, 1.0], "ax": [0.0, 5.0, 5.0]}
    sim = scene.build(seed=7, threads=1)
    before = sim.positions[:, 0].mean()
    sim.step(20)
    assert sim.positions[:, 0].mean() > before + 0.05
    assert sim.gravity == (0.0, -9.81)
