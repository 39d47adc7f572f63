"""Sweeps over the keys of a scene."""

from __future__ import annotations

import copy
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import command, install
from conftest import ROOT
from kills import kill_when, killed

import unipbd as up
from unipbd import sweep
from unipbd._work import run_all

pandas = pytest.importorskip("pandas")

SCENE: dict[str, Any] = {
    "spacing": 0.1, "fps": 60.0, "duration": 0.1,
    "liquid": [{"name": "water"}],
    "block": [{"material": "water", "min": [0.0, 0.0], "max": [0.5, 0.5]}],
    "tank": [{"name": "tank", "min": [0.0, 0.0], "max": [1.0, 1.0]}],
}
SWEEP: dict[str, Any] = {
    "scene": SCENE,
    "grid": [{"key": "block.0.max.1", "values": [0.3, 0.6]}, {"key": "gravity.1", "from": -10.0, "to": -2.0, "count": 3}],
    "list": [{"keys": ["liquid.water.density", "liquid.water.xsph"], "values": [[1000.0, 0.0], [800.0, 0.1]]}],
    "reduce": {"speed_max": ["max", "mean"], "density_error_max": "max"},
}


def made(**values: Any) -> sweep.Sweep:
    return sweep.Sweep.from_dict({**copy.deepcopy(SWEEP), **values})


def test_grids_and_lists_are_combined_and_repeats_differ_in_the_seed() -> None:
    found = made(repeats=2, seed=5)
    assert len(found) == 2 * 3 * 2 * 2
    points = [tuple(found.point(index).values()) for index in range(len(found))]
    assert len(set(points)) == 12 and points[0] == points[1] == (0.3, -10.0, 1000.0, 0.0)
    scenes = [found.scene_of(index) for index in range(2)]
    assert [seed for _, seed in scenes] == [5, 6]
    assert scenes[0][0]["block"][0]["max"] == [0.5, 0.3] and scenes[0][0]["gravity"] == [0.0, -10.0]
    with pytest.raises(IndexError):
        found.point(24)


def test_a_latin_hypercube_has_a_draw_in_every_strip() -> None:
    random = [{"key": "block.0.velocity", "uniform": [[0.0, -1.0], [2.0, 1.0]]},
              {"key": "liquid.0.density", "log_uniform": [100.0, 10000.0]}]
    found = made(grid=[], list=[], random=random, draws=16, sampling="latin_hypercube")
    points = [found.point(index) for index in range(16)]
    u = np.array([point["block.0.velocity"][0] / 2.0 for point in points])
    v = np.array([(point["block.0.velocity"][1] + 1.0) / 2.0 for point in points])
    w = np.array([np.log10(point["liquid.0.density"] / 100.0) / 2.0 for point in points])
    for column in (u, v, w):
        assert sorted(np.floor(column * 16).astype(int).tolist()) == list(range(16))
    assert abs(np.corrcoef(u, v)[0, 1]) < 0.6
    assert found.point(3) == made(grid=[], list=[], random=random, draws=16, sampling="latin_hypercube").point(3)
    plain = made(grid=[], list=[], random=random, draws=16)
    assert plain.point(3) != found.point(3)


def test_a_table_has_a_row_for_each_run_and_says_what_the_run_was(tmp_path: Path) -> None:
    found = sweep.run(made(), tmp_path, jobs=1)
    assert isinstance(found, pandas.DataFrame) and len(found) == 12 and (found.status == "done").all()
    row = found.iloc[4]
    data, seed = made().scene_of(4)
    sim = up.Scene.from_dict(data).build(seed=seed)
    speeds = [frame.speed_max for frame in sim.run()]
    assert row["state_hash"] == f"{sim.state_hash():016x}" and row["speed_max.max"] == max(speeds)
    assert row["speed_max.mean"] == pytest.approx(np.mean(speeds)) and row["time"] == pytest.approx(0.1)
    assert row["momentum_y"] == sim.diagnostics()["momentum"][1] and row["walls.tank bottom.force_y"] < 0.0
    assert row["block.0.max.1"] == 0.3 and row["gravity.1"] == -2.0 and row["counts.liquid"] == len(sim)


def test_shards_processes_and_kills_make_no_difference(tmp_path: Path) -> None:
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    sweep.run(made(), whole, jobs=1)

    def stop(progress: sweep.Progress) -> None:
        if progress.done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sweep.run(made(), parts, shard=(1, 2), jobs=1, progress=stop)
    assert len(sweep.left(made(), parts)) == 10 and len(sweep.left(made(), parts, (1, 2))) == 4
    sweep.run(made(), parts, shard=(2, 2), jobs=2)
    sweep.run(made(), parts)
    assert sweep.left(made(), parts) == []
    for folder in (whole, parts):
        sweep.write_table(folder, folder / "results.csv")
    assert (whole / "results.csv").read_bytes() == (parts / "results.csv").read_bytes()
    with pytest.raises(up.UnipbdError, match="repeats differ"):
        sweep.left(made(repeats=3), parts)


def test_runs_that_fail_are_rows_too(tmp_path: Path) -> None:
    scene = {**SCENE, "tank": []}
    found = sweep.run(made(scene=scene, list=[], reduce={}, grid=[
        {"key": "gravity.1", "values": [-1e9, -10.0]}, {"key": "block.0.max.0", "values": [0.5, -1.0]}]), tmp_path, jobs=1)
    assert found.status.tolist() == ["diverged", "invalid", "done", "invalid"]
    assert "max" in found.message[1] and found.message[2] == ""


def test_logs_and_parquet_on_request(tmp_path: Path) -> None:
    found = sweep.run(made(grid=[], logs=True), tmp_path, jobs=1)
    log = up.read_log(tmp_path / "logs" / "00001.mcap")
    assert len(list(log)) == 7 and len(found) == 2
    pytest.importorskip("pyarrow")
    sweep.write_table(tmp_path, tmp_path / "results.parquet")
    again = pandas.read_parquet(tmp_path / "results.parquet")
    assert again.state_hash.tolist() == found.state_hash.tolist()
    with pytest.raises(up.UnipbdError, match="csv or .parquet"):
        sweep.write_table(tmp_path, tmp_path / "results.txt")


@pytest.mark.parametrize(("values", "key", "message"), [
    ({"gird": []}, "gird", "did you mean 'grid'"),
    ({"grid": [{"key": "block.3.max", "values": [1]}]}, "grid[0].key", "ends before '3'"),
    ({"grid": [{"key": "spacing"}]}, "grid[0]", "values are wanted"),
    ({"list": [{"keys": ["spacing", "fps"], "values": [[1]]}]}, "list[0]", "rows of as many values"),
    ({"random": [{"key": "spacing"}]}, "random[0]", "a distribution"),
    ({"reduce": {"speed_max": "median"}}, "reduce.speed_max", "there are max"),
    ({"sampling": "sobol"}, "sampling", "latin_hypercube"),
    ({"repeats": 0}, "repeats", "from 1 on"),
    ({"scene": {"spacing": -1.0}}, "scene.spacing", "spacing"),
])
def test_mistakes_are_named(values: dict[str, Any], key: str, message: str) -> None:
    with pytest.raises(sweep.RecipeError) as caught:
        made(**values)
    assert caught.value.key == key and message in str(caught.value)


def end_at_three(number: int) -> int:
    return os._exit(9) if number == 3 else number


def test_a_worker_that_is_killed_is_said_and_a_missing_package_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(up.UnipbdError, match="ran out of memory; the same call goes on"):
        list(run_all(end_at_three, range(6), 2))
    sweep.run(made(grid=[], list=[]), tmp_path, jobs=1)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(up.UnipbdError, match=r'pip install "unipbd\[data\]"'):
        sweep.write_table(tmp_path, tmp_path / "results.parquet")


def test_a_diagnostic_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(up.UnipbdError, match="no diagnostic 'sped_max'"):
        sweep.run(made(reduce={"sped_max": "max"}), tmp_path, jobs=1)


def test_the_command_writes_the_table(tmp_path: Path) -> None:
    up.Scene.from_dict(SCENE).save(tmp_path / "pool.toml")
    text = 'scene = "pool.toml"\n[[grid]]\nkey = "gravity.1"\nvalues = [-5.0, -10.0]\n'
    (tmp_path / "sweep.toml").write_text(text)
    words = ["sweep", tmp_path / "sweep.toml", "-o", tmp_path / "out"]
    run = command(*words, "--jobs", 1)
    assert run.returncode == 0 and "2 of 2 runs" in run.stdout, run.stderr
    assert len((tmp_path / "out" / "results.csv").read_text().splitlines()) == 3
    (tmp_path / "sweep.toml").write_text(text.replace("gravity.1", "gravty.1"))
    run = command(*words)
    assert run.returncode == 3 and "sweep.toml:3" in run.stderr, run.stderr


def test_two_hundred_runs_that_were_killed_half_way_go_on(tmp_path: Path) -> None:
    up.Scene.from_dict(SCENE).save(tmp_path / "pool.toml")
    (tmp_path / "sweep.toml").write_text(
        'scene = "pool.toml"\ndraws = 20\nsampling = "latin_hypercube"\n'
        '[[grid]]\nkey = "gravity.1"\nfrom = -10.0\nto = -1.0\ncount = 10\n'
        '[[random]]\nkey = "block.0.max"\nuniform = [[0.3, 0.3], [0.8, 0.8]]\n')
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    arguments = ["sweep", tmp_path / "sweep.toml", "-o", parts, "--jobs", 2]
    killed(arguments, lambda: len(list(parts.glob("runs/*.json"))) >= 100)
    done = len(list(parts.glob("runs/*.json")))
    assert 100 <= done < 200 and not (parts / "results.csv").exists()
    written = {path: path.stat().st_mtime_ns for path in parts.glob("runs/*.json")}
    run = command(*arguments)
    assert run.returncode == 0 and "200 of 200 runs" in run.stdout, run.stderr
    assert all(path.stat().st_mtime_ns == time for path, time in written.items()), "no run is done twice"
    assert command(*arguments[:2], "-o", whole, "--jobs", 1).returncode == 0
    assert (whole / "results.csv").read_bytes() == (parts / "results.csv").read_bytes()


# -- machinery of others -----------------------------------------------------------------------

ENGINES = ROOT / "crates" / "unipbd-py" / "examples" / "sweep_engines.py"


def table_of(engine: str, folder: Path) -> bytes:
    run = subprocess.run([sys.executable, str(ENGINES), engine, str(folder)], capture_output=True, text=True, timeout=600)
    assert run.returncode == 0, run.stderr[-3000:]
    return (folder / "results.csv").read_bytes()


@pytest.fixture(scope="module")
def one(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The table of the example by one process."""
    return table_of("one", tmp_path_factory.mktemp("one"))


def test_joblib_gives_the_same_table_as_one_process(one: bytes, tmp_path: Path) -> None:
    pytest.importorskip("joblib")
    assert table_of("joblib", tmp_path) == one and one.count(b"\n") == 201


@pytest.mark.parametrize("engine", ["ray", "dask", "submitit"])
def test_ray_dask_and_submitit_go_on_and_give_the_same_table(
    engine: str, one: bytes, tmp_path: Path, full_tier: bool
) -> None:
    if not full_tier:
        pytest.skip("heavy packages: full tier")
    install(sys.executable, {"ray": "ray", "dask": "distributed", "submitit": "submitit"}[engine])
    kill_when([sys.executable, str(ENGINES), "one", str(tmp_path)], lambda: len(list(tmp_path.glob("runs/*.json"))) >= 100)
    assert table_of(engine, tmp_path) == one
