"""Tables of `unipbd export --format parquet`, read by pandas and pyarrow."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq

import unipbd as up

from commands import command


def test_pandas_reads_what_was_recorded(scene: up.Scene, tmp_path: Path) -> None:
    scene.add_gauge("depth", "level", at=(0.5, 0.0))
    scene.add_body("box", at=(1.5, 2.0), size=(0.3, 0.3))
    sim = scene.build(seed=7, threads=1)
    path = tmp_path / "run.mcap"
    with sim.record(path, fields="velocity"):
        sim.step(4)
    assert command("export", path, "-o", tmp_path / "tables", "--format", "parquet").returncode == 0
    log = up.read_log(path)
    particles = pd.read_parquet(tmp_path / "tables" / "particles.parquet")
    assert particles.dtypes.astype(str).to_dict() | {"phase": "", "material": ""} == {
        "frame": "int64", "time": "float64", "id": "uint32", "phase": "", "material": "",
        "x": "float32", "y": "float32", "velocity_x": "float32", "velocity_y": "float32"}
    for number, frame in enumerate(log):
        rows = particles[particles["frame"] == number]
        np.testing.assert_array_equal(rows[["x", "y"]], frame.positions)
        np.testing.assert_array_equal(rows["id"], frame.ids)
    assert set(particles["phase"]) == {"liquid", "rigid"}
    diagnostics = pd.read_parquet(tmp_path / "tables" / "diagnostics.parquet")
    np.testing.assert_array_equal(diagnostics["gauge_depth"], log.gauges()["depth"])
    np.testing.assert_array_equal(diagnostics["kinetic_energy"], log.diagnostics()["kinetic_energy"])
    bodies = pq.read_table(tmp_path / "tables" / "bodies.parquet")
    assert bodies.num_rows == 5 and bodies.column("name").to_pylist() == ["box"] * 5
