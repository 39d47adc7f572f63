"""Running a sweep: one run, those that are left, the table."""

from __future__ import annotations

import csv
import functools
import importlib
import io
import json
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .._errors import SceneError, SolverError, UnipbdError
from .._flat import flat
from .._scene import Scene
from .._simulation import Simulation
from .._work import claim, processes, run_all, share, write
from ._points import Sweep


@dataclass(frozen=True)
class Progress:
    """How far it has come: runs done and in all, of them failed, time since the start and left [s]."""

    done: int
    total: int
    failed: int
    elapsed: float
    remaining: float


def run_point(sweep: Sweep, index: int, folder: str | os.PathLike[str]) -> dict[str, Any]:
    """Does a run and writes its row to `folder`/runs; a row that is there is returned as it is.

    The row has the values of the point, ``status`` (``done``, ``diverged`` or ``invalid``), ``message``, the diagnostics of
    the last frame, the reductions, and the hash of the last state.
    """
    path = _row_path(Path(folder), index)
    if path.exists():
        return _read(path)
    scene, seed = sweep.scene_of(index)
    row: dict[str, Any] = {"run": index, "seed": seed}
    row.update({key: value for key, value in sweep.point(index).items()})
    try:
        row.update(_result(sweep, Scene.from_dict(scene), seed, Path(folder), index))
    except SceneError as error:
        row.update(status="invalid", message=str(error))
    except SolverError as error:
        row.update(status="diverged", message=str(error))
    path.parent.mkdir(parents=True, exist_ok=True)
    write(path, json.dumps(row))
    return row


def _result(sweep: Sweep, scene: Scene, seed: int, folder: Path, index: int) -> dict[str, Any]:
    sim = Simulation(scene, seed=seed, threads=1)
    kept: dict[str, list[float]] = {name: [] for name in sweep.reduce}
    last: dict[str, float] = {}
    recording = None
    if sweep.logs:
        (folder / "logs").mkdir(parents=True, exist_ok=True)
        recording = sim.record(folder / "logs" / f"{index:05d}.mcap").__enter__()
    try:
        for frame in sim.run():
            last = flat(frame.diagnostics)
            for name, values in kept.items():
                if name not in last:
                    raise UnipbdError(f"reduce: there is no diagnostic {name!r}; there are {', '.join(last)}")
                values.append(last[name])
    finally:
        if recording is not None:
            recording.__exit__(None, None, None)
    row: dict[str, Any] = {"status": "done", "message": "", **last}
    for name, values in kept.items():
        hows = sweep.reduce[name]
        for how in [hows] if isinstance(hows, str) else hows:
            row[f"{name}.{how}"] = _REDUCTIONS[how](values) if values else None
    row["state_hash"] = f"{sim.state_hash():016x}"
    return row


_REDUCTIONS: dict[str, Callable[[list[float]], float]] = {
    "max": max,
    "min": min,
    "mean": lambda values: sum(values) / len(values),
    "last": lambda values: values[-1],
}


def left(sweep: Sweep, folder: str | os.PathLike[str], shard: tuple[int, int] = (1, 1)) -> list[int]:
    """Takes the folder for the sweep and returns the runs that have no row in it yet."""
    place = Path(folder)
    claim(place, "sweep.json", sweep.to_dict())
    return [index for index in share(len(sweep), shard) if not _row_path(place, index).exists()]


def run(
    sweep: Sweep | str | os.PathLike[str],
    folder: str | os.PathLike[str],
    shard: tuple[int, int] = (1, 1),
    jobs: int | None = None,
    progress: Callable[[Progress], object] | None = None,
) -> Any:
    """Does all runs that are left, on all processors, and returns the table as a pandas frame.

    What was killed goes on with the runs that have no row. `shard` (3, 16) does the third of sixteen shares. Rows are the
    same whatever the shards and `jobs` (processes).
    """
    sweep = sweep if isinstance(sweep, Sweep) else Sweep.load(sweep)
    run_left(sweep, Path(folder), shard, jobs, progress)
    return table(folder)


def run_left(
    sweep: Sweep, folder: Path, shard: tuple[int, int], jobs: int | None, progress: Callable[[Progress], object] | None
) -> None:
    """Does all runs that are left."""
    wanted = left(sweep, folder, shard)
    total = len(share(len(sweep), shard))
    started, done, failed = time.monotonic(), total - len(wanted), 0
    work = functools.partial(_numbered, sweep, folder)
    for row in run_all(work, wanted, processes(jobs, len(wanted))):
        done, failed = done + 1, failed + (row["status"] != "done")
        elapsed = time.monotonic() - started
        if progress is not None:
            progress(Progress(done, total, failed, elapsed, elapsed / (done - total + len(wanted)) * (total - done)))


def _numbered(sweep: Sweep, folder: Path, index: int) -> dict[str, Any]:
    return run_point(sweep, index, folder)


# -- the table ---------------------------------------------------------------------------------


def rows(folder: Path) -> list[dict[str, Any]]:
    """The rows that are there, by the number of the run."""
    return [_read(path) for path in sorted((folder / "runs").glob("*.json"))]


def table(folder: str | os.PathLike[str]) -> Any:
    """The rows that are there as a pandas frame."""
    return _package("pandas").DataFrame(rows(Path(folder)))


def write_table(folder: str | os.PathLike[str], path: str | os.PathLike[str]) -> None:
    """Writes the rows that are there to a file: .csv, or .parquet, which needs pandas and pyarrow."""
    place = Path(path)
    if place.suffix == ".parquet":
        _package("pyarrow")
        found = table(folder)
        for column in found.columns:
            if found[column].map(lambda value: isinstance(value, (list, dict))).any():
                found[column] = found[column].map(json.dumps)
        found.to_parquet(place, index=False)
        return
    if place.suffix != ".csv":
        raise UnipbdError(f"a table is written as .csv or .parquet, not {place.name}")
    found = rows(Path(folder))
    columns = list(dict.fromkeys(key for row in found for key in row))
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, columns, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(found)
    write(place, text.getvalue())


def _package(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError:
        raise UnipbdError(f'a table needs {name}: pip install "unipbd[data]"') from None


def _row_path(folder: Path, index: int) -> Path:
    return folder / "runs" / f"{index:06d}.json"


def _read(path: Path) -> dict[str, Any]:
    row: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return row
