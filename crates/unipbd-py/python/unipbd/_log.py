"""Reading recorded runs."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Floats, Ids, fixed
from ._phase import Phase
from ._scene import Scene

if TYPE_CHECKING:
    import pandas


def _columns(diagnostics: Mapping[str, Any]) -> dict[str, Any]:
    """The quantities of a frame with one column for each number, without those of materials, groups, walls and gauges."""
    columns = {f"count_{phase}": count for phase, count in diagnostics["counts"].items()}
    for name, value in diagnostics.items():
        if isinstance(value, tuple):
            columns |= {f"{name}_x": value[0], f"{name}_y": value[1]}
        elif isinstance(value, (int, float, str)):
            columns[name] = value
    return columns


@dataclass(frozen=True)
class LogFrame:
    """One frame of a log. Arrays are read-only, with one row per particle in ascending order of ids.

    Attributes:
        time: simulated time [s].
        positions: positions [m], float32, shape (N, 2).
        ids: ids, uint32, shape (N,).
        phases: phases, uint8, shape (N,).
        material_indices: indices into `Log.materials`, uint16, shape (N,); samples of bodies that came to a run of fluids
            without any have the next index.
        velocities: velocities [m/s], float32, shape (N, 2), where they were recorded.
        density_errors: density errors C = rho/rho0 - 1, as fractions, float32, shape (N,), where
            they were recorded.
        temperatures: temperatures, float32, shape (N,), where they were recorded.
        bodies: rigid bodies by name, each a dict with the keys of `Body`: position, angle,
            velocity, fluid_force and so on.
        diagnostics: the state in numbers, as `Simulation.diagnostics`, with the ``state_hash``.
        events: what happened since the frame before, as (time [s], severity, message).
    """

    time: float
    positions: Floats = field(repr=False)
    ids: Ids = field(repr=False)
    phases: npt.NDArray[np.uint8] = field(repr=False)
    material_indices: npt.NDArray[np.uint16] = field(repr=False)
    velocities: Floats | None = field(repr=False)
    density_errors: Floats | None = field(repr=False)
    temperatures: Floats | None = field(repr=False)
    bodies: Mapping[str, Mapping[str, Any]] = field(repr=False)
    diagnostics: Mapping[str, Any] | None = field(repr=False)
    events: list[tuple[float, str, str]] = field(repr=False)

    @property
    def gauges(self) -> dict[str, float]:
        """Readings of the gauges by name, as `Simulation.gauges`."""
        gauges = self.diagnostics["gauges"] if self.diagnostics is not None else {}
        return {name: gauge["value"] for name, gauge in gauges.items()}

    def to_dict(self) -> dict[str, Any]:
        """The columns of the particles by name, two for vectors: for tables and data frames."""
        columns: dict[str, Any] = {
            "time": np.full(len(self.ids), self.time),
            "id": self.ids,
            "phase": self.phases,
            "material": self.material_indices,
            "x": self.positions[:, 0],
            "y": self.positions[:, 1],
        }
        if self.velocities is not None:
            columns |= {"vx": self.velocities[:, 0], "vy": self.velocities[:, 1]}
        if self.density_errors is not None:
            columns["density_error"] = self.density_errors
        if self.temperatures is not None:
            columns["temperature"] = self.temperatures
        return columns

    def to_pandas(self) -> pandas.DataFrame:
        """The particles as a data frame indexed by id (needs pandas)."""
        import pandas

        return pandas.DataFrame(self.to_dict()).set_index("id")

    def to_xarray_dict(self) -> dict[str, Any]:
        """What `xarray.Dataset.from_dict` takes: the columns over the ids."""
        columns = self.to_dict()
        return {
            "coords": {"id": {"dims": "id", "data": columns.pop("id")}},
            "attrs": {"time": self.time},
            "dims": {"id": len(self.ids)},
            "data_vars": {name: {"dims": "id", "data": values} for name, values in columns.items()},
        }


class Log:
    """A recorded run: iterate over it for its frames, as often as you like. See `read_log`.

    Attributes:
        path: where the log is.
        name: title of the scene.
        seed: seed of the run.
        fps: frames per simulated second [1/s].
        spacing: rest distance of particles [m].
        version: version of unipbd that wrote it.
        scene_text: the scene file of the run.
        overrides: changes to the scene from the command line, ``key=value``.
        materials: names of the materials, by index.
        phases: phases of the materials, by index.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.fspath(path)
        header = _native.LogReader(self.path).header()
        self.name: str = header["name"]
        self.seed: int = header["seed"]
        self.fps: float = header["fps"]
        self.spacing: float = header["spacing"]
        self.version: str = header["version"]
        self.scene_text: str = header["scene"]
        self.overrides: list[str] = header["overrides"]
        self.materials: list[str] = [material["name"] for material in header["materials"]]
        self.phases: list[Phase] = [Phase(material["phase"]) for material in header["materials"]]
        self._fields: list[str] = header["fields"].split(",")
        self._frames: int | None = header["frames"]
        self._truncated = self._frames is None

    @property
    def scene(self) -> Scene:
        """The scene of the run, without the overrides of the command line."""
        return Scene.from_toml(self.scene_text, self.path)

    @property
    def truncated(self) -> bool:
        """Whether the run was cut off: all frames up to the cut can be read."""
        return self._truncated

    def __iter__(self) -> Iterator[LogFrame]:
        reader = _native.LogReader(self.path)
        while (frame := reader.next_frame()) is not None:
            bodies = {body["name"]: body for body in frame.pop("bodies")}
            if len(frame["ids"]) == 0:
                frame |= self._empty_columns()
            yield LogFrame(bodies=bodies, **frame)

    def _empty_columns(self) -> dict[str, Any]:
        """Recorded columns of a frame without particles: empty, not missing."""
        shapes = {"velocity": ("velocities", (0, 2)), "density": ("density_errors", (0,))}
        known = [shapes[word] for word in self._fields if word in shapes]
        return {name: fixed(np.empty(shape, dtype=np.float32)) for name, shape in known}

    def __len__(self) -> int:
        if self._frames is None:
            self._frames = sum(1 for _ in self)
        return self._frames

    def diagnostics(self) -> dict[str, npt.NDArray[Any]]:
        """The quantities of all frames as arrays by name, shape (frames,): for plots and tables.

        The names are the columns of docs/diagnostics.md: a vector has two, ``momentum_x`` and ``momentum_y``,
        and ``counts`` has one for each phase, ``count_liquid`` and so on.
        """
        rows = [_columns(frame.diagnostics) for frame in self if frame.diagnostics is not None]
        names = list(rows[0]) if rows else []
        return {name: fixed(np.array([row[name] for row in rows])) for name in names}

    def gauges(self) -> dict[str, npt.NDArray[np.float64]]:
        """The ``time`` of all frames and the readings of each gauge by name, as arrays of shape (frames,)."""
        rows = [{"time": frame.time, **frame.gauges} for frame in self if frame.diagnostics is not None]
        names = list(rows[0]) if rows else []
        return {name: fixed(np.array([row[name] for row in rows])) for name in names}

    def to_pandas(self) -> pandas.DataFrame:
        """The numbers of all frames as a data frame indexed by time, those of gauges as ``gauge_NAME`` (needs
        pandas)."""
        import pandas

        gauges = {f"gauge_{name}": values for name, values in self.gauges().items() if name != "time"}
        return pandas.DataFrame({**self.diagnostics(), **gauges}).set_index("time")

    def __repr__(self) -> str:
        count = "cut off" if self.truncated else f"{len(self)} frames"
        return f"<unipbd.Log {self.path!r}: {self.name!r}, {count}>"


def read_log(path: str | os.PathLike[str]) -> Log:
    """Opens a log that `Simulation.record` or the `unipbd` command wrote::

        for frame in up.read_log("run.mcap"):
            print(frame.time, frame.positions.mean(axis=0))

    Raises `RecordingError` for a file that is something else or damaged.
    """
    return Log(path)
