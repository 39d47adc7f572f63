"""Recording and reading back."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import unipbd as up


def test_a_recorded_run_reads_back_as_it_was(plume: up.Scene, tmp_path: Path) -> None:
    sim = plume.build(seed=2)
    path = tmp_path / "run.mcap"
    expected = [(sim.time, sim.positions, sim.state_hash())]
    with sim.record(path, fps=30, fields="all") as recording:
        for _ in sim.run(until=0.5, fps=30):
            expected.append((sim.time, sim.positions, sim.state_hash()))
    assert recording.frames == len(expected) == 16 and recording.bytes == path.stat().st_size
    sim.step()
    log = up.read_log(path)
    assert len(log) == 16 and log.fps == 30 and log.seed == 2 and not log.truncated
    assert log.materials == list(plume.materials) == list(sim.materials)
    assert log.phases == [material.phase for material in sim.materials.values()]
    assert log.scene == plume
    for frame, (time, positions, state_hash) in zip(log, expected, strict=True):
        assert frame.time == pytest.approx(time, abs=1e-6)
        np.testing.assert_array_equal(frame.positions, positions)
        assert frame.diagnostics is not None and frame.diagnostics["state_hash"] == state_hash
        assert frame.velocities is not None and frame.velocities.shape == positions.shape
        assert len(positions) == 0 or frame.temperatures is not None and len(frame.temperatures) == len(positions)
    assert len(list(log)) == 16, "a log can be read again"
    assert log.diagnostics()["speed_max"].shape == (16,)


def test_an_exception_leaves_a_complete_log(sim: up.Simulation, tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    with pytest.raises(RuntimeError):
        with sim.record(path):
            sim.step(4)
            raise RuntimeError
    assert len(up.read_log(path)) == 5
    assert not sim._recordings
    sim.copy()


def test_frames_become_data_frames(sim: up.Simulation, tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    path = tmp_path / "run.mcap"
    with sim.record(path, fields="velocity"):
        sim.step(3)
    log = up.read_log(path)
    table = pandas.concat([frame.to_pandas() for frame in log])
    assert list(table.columns) == ["time", "phase", "material", "x", "y", "vx", "vy"] and len(table) == 400
    assert log.to_pandas().index.name == "time"
    described = next(iter(log)).to_xarray_dict()
    assert described["data_vars"]["x"]["data"].shape == (100,) and "id" in described["coords"]
    data = pytest.importorskip("xarray").Dataset.from_dict(described)
    assert data.sizes == {"id": 100} and data["vy"].dims == ("id",) and data.attrs["time"] == 0.0


def test_what_cannot_be_recorded_or_read_is_a_clear_error(sim: up.Simulation, tmp_path: Path) -> None:
    with pytest.raises(up.RecordingError) as caught, sim.record(tmp_path / "missing" / "run.mcap"):
        pass
    assert isinstance(caught.value, OSError) and "missing" in str(caught.value)
    assert not sim._recordings
    with pytest.raises(ValueError, match="taste"), sim.record(tmp_path / "run.mcap", fields="taste"):
        pass
    foreign = tmp_path / "foreign.mcap"
    foreign.write_bytes(b"something else")
    with pytest.raises(up.RecordingError):
        up.read_log(foreign)
    with pytest.raises(up.RecordingError):
        up.read_log(tmp_path / "nothing.mcap")


def test_a_log_that_was_cut_off_gives_its_frames(sim: up.Simulation, tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    with sim.record(path):
        sim.step(30)
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 2 // 3])
    log = up.read_log(path)
    assert log.truncated and 0 < len(list(log)) < 31


def test_exported_arrays_are_the_log_with_gaps_where_particles_are_not_there(plume: up.Scene, tmp_path: Path) -> None:
    sim = plume.build(seed=3, threads=1)
    path = tmp_path / "plume.mcap"
    with sim.record(path, fields="velocity"):
        sim.step(20)
    command = Path(sys.executable).with_name("unipbd")
    subprocess.run([command, "export", path, "-o", tmp_path / "plume.npz", "-q"], check=True)
    arrays = np.load(tmp_path / "plume.npz")
    log = up.read_log(path)
    assert arrays["position"].shape == (21, len(arrays["id"]), 2) and np.isnan(arrays["position"]).any()
    for number, frame in enumerate(log):
        columns = np.searchsorted(arrays["id"], frame.ids)
        np.testing.assert_array_equal(arrays["position"][number, columns], frame.positions)
        np.testing.assert_array_equal(arrays["velocity"][number, columns], frame.velocities)
        assert np.isfinite(arrays["position"][number, :, 0]).sum() == len(frame.ids)
    np.testing.assert_array_equal(arrays["kinetic_energy"], log.diagnostics()["kinetic_energy"])
