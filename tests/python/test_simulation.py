"""Stepping and looking."""

from __future__ import annotations

import gc
import logging
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, SCENES, pool

import unipbd as up


def test_arrays_have_the_shapes_and_types_they_are_said_to_have(plume: up.Scene) -> None:
    sim = plume.build(seed=1)
    sim.step(30)
    n = len(sim)
    expected = {
        "positions": (np.float32, (n, 2)),
        "velocities": (np.float32, (n, 2)),
        "ids": (np.uint32, (n,)),
        "phases": (np.uint8, (n,)),
        "material_indices": (np.uint16, (n,)),
        "density_errors": (np.float32, (n,)),
        "temperatures": (np.float32, (n,)),
        "inverse_masses": (np.float32, (n,)),
    }
    for name, (dtype, shape) in expected.items():
        array = getattr(sim, name)
        assert array.dtype == dtype and array.shape == shape, name
        assert array.flags.c_contiguous and not array.flags.writeable, name
    assert sim.pressures.dtype == np.float64 and sim.pressures.shape == (n,) and sim.pressures.max() > 0
    assert np.all(np.diff(sim.ids.astype(np.int64)) > 0)
    assert set(np.unique(sim.phases)) == {up.GAS, up.SMOKE}
    smoke = sim.positions[sim.phases == up.SMOKE]
    np.testing.assert_array_equal(smoke, sim.material("smoke").positions)
    assert len(sim.material("smoke")) == len(smoke) == sim.diagnostics()["counts"]["smoke"]


def test_an_array_shows_its_moment_for_ever_and_refuses_writes(sim: up.Simulation) -> None:
    before = sim.positions
    kept = before.copy()
    with pytest.raises(ValueError):
        before[0] = 0.0
    sim.step(10)
    np.testing.assert_array_equal(before, kept)
    assert not np.array_equal(sim.positions, kept)
    del sim
    gc.collect()
    np.testing.assert_array_equal(before, kept)


def test_no_write_into_a_copy_looks_as_if_it_worked(sim: up.Simulation, tmp_path: Path) -> None:
    water = sim.material("water")
    batch = up.Batch(sim.scene, n=2)
    with sim.record(tmp_path / "run.mcap", fields="all"):
        sim.step()
    frame = next(iter(up.read_log(tmp_path / "run.mcap")))
    arrays = [water.positions, water.velocities, water.ids, water.mask, water.density_errors, sim.ids_of("water")]
    arrays += [batch.positions, batch.velocities, batch.stack("ids"), batch.times, batch.counts]
    arrays += [frame.positions, frame.ids, frame.phases, frame.velocities, sim.pressures, sim.walls[0]]
    arrays += [sim.render(width=64)]
    for array in arrays:
        assert array is not None and array.flags.c_contiguous
        with pytest.raises(ValueError):
            array[0] = 0
    with sim.edit() as e:
        for reading in (e.velocities[3], e.velocities[[3, 4]], e.velocities[:][1:]):
            with pytest.raises(ValueError, match=r"set e.velocities\[ids\]"):
                reading[0] = 5.0
        (2.0 * e.velocities[:])[0] = 1.0
        e.velocities[3] *= 0.0
    assert not sim.velocities[3].any()


def test_walls_are_lines_to_draw(sim: up.Simulation) -> None:
    (tank,) = sim.walls
    assert tank.shape == (5, 2) and np.array_equal(tank[0], tank[-1])
    assert (tank.min(axis=0).tolist(), tank.max(axis=0).tolist()) == ([0, 0], [2, 3])


def test_rows_follow_ids_through_sorting_and_removal(sim: up.Simulation) -> None:
    marked = sim.positions[42]
    assert sim.ids[42] == 42
    sim.step(1)
    assert np.linalg.norm(sim.positions[42] - marked) < 0.1
    with sim.edit() as e:
        e.remove([0, 1, 2])
    assert sim.ids[39] == 42


def test_run_yields_frames_up_to_the_time_asked_for(sim: up.Simulation) -> None:
    frames = list(sim.run(until=0.5, fps=20))
    assert [frame.number for frame in frames] == list(range(3, 31, 3))
    assert frames[-1].time == pytest.approx(0.5) == sim.time
    assert frames[0].time < frames[-1].time and frames[0].diagnostics["frame"] == 3
    assert all(np.isfinite(frame.energy) for frame in frames)
    assert frames[-1].density_error_max < 0.1
    assert set(frames[-1].timings) == set(sim.stages)
    assert sum(1 for _ in sim.run()) == 30, "to the end of the scene"
    assert not list(sim.run(until=0.2)), "a time that is over"
    with pytest.raises(ValueError, match="60 frames per second"):
        next(sim.run(until=9, fps=50))
    with pytest.raises(ValueError):
        sim.step(-1)


def test_the_seed_decides_and_threads_do_not() -> None:
    scene = up.Scene.load(SCENES / "open_gas.toml")
    scene.spacing = 0.03
    hashes = set()
    for threads in (1, 2, 3):
        sim = scene.build(seed=5, threads=threads)
        sim.step(40)
        hashes.add(sim.state_hash())
    other = scene.build(seed=6)
    other.step(40)
    assert len(hashes) == 1 and other.state_hash() not in hashes


def test_python_and_the_command_reach_the_same_state(tmp_path: Path) -> None:
    sim = up.Scene.load(SCENES / "dam_break.toml").build()
    sim.step(30)
    log = tmp_path / "run.mcap"
    command = [sys.executable, "-m", "unipbd._command", "run", str(SCENES / "dam_break.toml"), "--quiet"]
    subprocess.run([*command, "--set", "duration=0.5", "--output", str(log)], check=True, timeout=120)
    frames = list(up.read_log(log))
    assert frames[-1].diagnostics is not None
    assert frames[-1].diagnostics["state_hash"] == sim.state_hash()
    np.testing.assert_array_equal(frames[-1].positions, sim.positions)


def test_python_and_rust_and_its_command_reach_the_same_state(tmp_path: Path) -> None:
    if "UNIPBD" not in os.environ and shutil.which("cargo") is None:
        pytest.skip("needs cargo")
    path = SCENES / "floating_bodies.toml"
    sim = up.Scene.load(path).build()
    sim.step(20)
    if "UNIPBD" in os.environ:
        # Left behind by the Rust tests.
        unipbd = Path(os.environ["UNIPBD"])
        example, command = [str(unipbd.parent / "examples" / "run_scene")], [str(unipbd)]
    else:
        cargo = ["cargo", "run", "--quiet", "-p", "unipbd-cli"]
        example, command = [*cargo, "--example", "run_scene", "--"], [*cargo, "--"]
    rust = [*example, str(path), "20"]
    shown = subprocess.run(rust, check=True, timeout=900, capture_output=True, text=True, cwd=ROOT).stdout
    assert shown.split()[-1] == f"{sim.state_hash():016x}" and f" {len(sim)} particles" in shown
    command += ["run", str(path), "--set", f"duration={20 / 60}", "--json", "--no-record"]
    lines = subprocess.run(command, check=True, timeout=900, capture_output=True, text=True, cwd=ROOT).stdout
    assert f'"{sim.state_hash():016x}"' in lines.splitlines()[-1]


def test_threads_come_from_the_argument_or_the_environment(
    scene: up.Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("UNIPBD_THREADS", "3")
    assert scene.build().threads == 3
    sim = scene.build(threads=2)
    assert sim.threads == 2
    sim.threads = 1
    assert sim.threads == 1
    with pytest.raises(ValueError):
        sim.threads = 0


@pytest.mark.parametrize("wrong", ["many", "0", "-1", "4097", "1000000000", "99999999999999999999999", "1.5"])
def test_a_wrong_number_of_threads_is_refused_as_on_the_command_line(
    wrong: str, scene: up.Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("UNIPBD_THREADS", wrong)
    with pytest.raises(ValueError, match="UNIPBD_THREADS must be a whole number from 1 to 4096, found"):
        scene.build()
    with pytest.raises(ValueError, match="UNIPBD_THREADS"):
        up.Batch(scene, n=1)
    with pytest.raises(ValueError, match="threads must be a whole number from 1 to 4096, found"):
        scene.build(threads=wrong)  # type: ignore[arg-type]
    sim = scene.build(threads=1)
    with pytest.raises(ValueError, match="threads must be"):
        sim.threads = wrong  # type: ignore[assignment]


@pytest.mark.parametrize("empty", ["", "  "])
def test_an_empty_variable_is_as_if_it_were_not_set(
    empty: str, scene: up.Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("UNIPBD_THREADS", empty)
    assert scene.build().threads >= 1
    with pytest.raises(ValueError):
        scene.build(threads=0)
    with pytest.raises(ValueError, match="seed"):
        scene.build(seed=-1)


def test_the_interpreter_is_free_while_the_simulation_steps() -> None:
    scene = pool()
    scene.spacing = 0.02
    sim = scene.build(threads=1)
    counted = 0
    worker = threading.Thread(target=sim.step, args=(15,))
    worker.start()
    while worker.is_alive():
        counted += 1
        time.sleep(0.001)
    worker.join()
    assert counted > 10


def test_a_second_thread_is_told_that_the_simulation_is_busy() -> None:
    scene = pool()
    scene.spacing = 0.02
    sim = scene.build(threads=1)
    worker = threading.Thread(target=sim.step, args=(20,))
    worker.start()
    seen = False
    while worker.is_alive() and not seen:
        try:
            sim.positions  # noqa: B018
        except up.BusyError:
            seen = True
    worker.join()
    assert seen
    assert sim.frame == 20


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_ctrl_c_stops_a_long_run_and_leaves_it_usable(sim: up.Simulation) -> None:
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        sim.step(10_000_000)
    assert time.monotonic() - begin < 5
    frame = sim.frame
    sim.step()
    assert sim.frame == frame + 1


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_ctrl_c_stops_within_a_long_frame_and_the_run_comes_to_the_same_end() -> None:
    scene = pool()
    scene.spacing = 0.0098
    scene.solver.substeps = 60
    scene.solver.settle_substeps = 0
    sim, expected = scene.build(threads=1), scene.build(threads=1)
    assert len(sim) > 10_000
    begin = time.monotonic()
    expected.step()
    whole = time.monotonic() - begin
    timer = threading.Timer(0.3 * whole, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        sim.step()
    assert sim.frame == 0 and 0 < sim.substeps < 60
    sim.step()
    assert sim.frame == 1 and sim.state_hash() == expected.state_hash()


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_ctrl_c_stops_a_batch_between_two_frames(scene: up.Scene) -> None:
    batch = up.Batch(scene, n=3, threads=2)
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        batch.step(10_000_000)
    assert time.monotonic() - begin < 5
    assert len({world.frame for world in batch}) == 1


def test_divergence_is_an_error_with_its_circumstances(scene: up.Scene) -> None:
    scene.tank.clear()
    sim = scene.build(threads=1)
    sim.on_substep(lambda s: s.add_acceleration((3e8, 0.0)))
    with pytest.raises(up.SolverError) as caught:
        sim.step(10)
    error = caught.value
    assert isinstance(error, ArithmeticError)
    assert error.stage == "update_velocities" and error.material == "water" and 0 <= error.particle < 100
    assert error.step > 0 and 0.0 < error.time < 0.1
    assert len(sim.positions) == 100


def test_events_of_a_run_are_logged(caplog: pytest.LogCaptureFixture, scene: up.Scene) -> None:
    scene.solver.max_substeps = 1
    scene.solver.pressure_grid = "off"
    scene.block[0].max = (2, 3)
    scene.gravity = (0.0, -90.0)
    with caplog.at_level(logging.INFO, logger="unipbd"):
        scene.build().step(2)
    assert any("substeps capped" in record.message for record in caplog.records)


def test_pictures_are_arrays_and_files(sim: up.Simulation, tmp_path: Path) -> None:
    path = tmp_path / "frame.png"
    picture = sim.render(path, width=320)
    assert picture.dtype == np.uint8 and picture.shape[1:] == (320, 3)
    assert path.read_bytes().startswith(b"\x89PNG")
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 3
    assert not np.array_equal(picture, sim.render(width=320, color_by="speed"))
    for wrong in ({"color_by": "taste"}, {"style": "cubist"}, {"path": "frame.gif"}, {"background": "pink"}):
        with pytest.raises(ValueError):
            sim.render(**wrong)  # type: ignore[arg-type]
    assert "100 liquid" in repr(sim) and "pool" in repr(sim)
    assert "data:image/png;base64," in sim._repr_html_()


def test_importing_does_nothing_visible() -> None:
    code = (
        "import threading, sys; before = threading.active_count(); import unipbd;"
        "import os; tasks = '/proc/self/task';"
        "count = len(os.listdir(tasks)) if os.path.exists(tasks) else 1;"
        "assert threading.active_count() == before and 'matplotlib' not in sys.modules; print(count)"
    )
    environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")
    output = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    assert output.returncode == 0, output.stderr
    assert output.stdout.strip() == "1" and output.stderr == ""


def test_the_command_is_installed() -> None:
    command = Path(sys.executable).with_name("unipbd")
    shown = subprocess.run([str(command), "--version"], capture_output=True, text=True, check=True)
    assert up.__version__ in shown.stdout
    missing = subprocess.run([str(command), "run", "no-such-file.toml"], capture_output=True, text=True, cwd=ROOT)
    assert missing.returncode == 1 and "no-such-file" in missing.stderr


def test_no_cycle_leaks(scene: up.Scene, full_tier: bool) -> None:
    resource = pytest.importorskip("resource")
    cycles = 10_000 if full_tier else 500
    scene.solver.settle_substeps = 1

    def resident() -> int:
        statm = Path("/proc/self/statm")
        if statm.exists():
            return int(statm.read_text().split()[1]) * resource.getpagesize()
        return int(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)

    def cycle() -> None:
        sim = scene.build(threads=1)
        sim.on_substep(lambda s: s.add_acceleration((0.0, 1.0)))
        sim.step()
        state = sim.state()
        sim.restore(state)
        sim.positions, sim.ids  # noqa: B018

    for _ in range(cycles // 5):
        cycle()
    gc.collect()
    before = resident()
    for _ in range(cycles):
        cycle()
    gc.collect()
    assert resident() - before < 3_000_000, f"{resident() - before} bytes more after {cycles} cycles"
