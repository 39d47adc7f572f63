"""Recording of runs."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from . import _native

if TYPE_CHECKING:
    from ._simulation import Simulation


class Recording:
    """Records frames while its `with` block lasts. See `Simulation.record`."""

    def __init__(self, simulation: Simulation, path: Path, stride: int, fields: str) -> None:
        self._simulation = simulation
        self._stride = stride
        self._fields = fields
        self._recorder: _native.Recorder | None = None
        self._left = stride
        self.path = path
        """Where the log is."""
        self.frames = 0
        """Frames in the log, known when it is complete."""
        self.bytes = 0
        """Size of the log [bytes], known when it is complete."""

    def __enter__(self) -> Recording:
        simulation = self._simulation
        fps = 1.0 / (simulation.frame_time * self._stride)
        self._recorder = _native.Recorder(str(self.path), simulation._native, fps, self._fields)
        self._recorder.record(simulation._native)
        self._left = self._stride
        simulation._recordings.append(self)
        return self

    def _after_frame(self) -> None:
        self._left -= 1
        recorder = self._recorder  # another thread may leave the block meanwhile
        if self._left == 0 and recorder is not None:
            self._left = self._stride
            recorder.record(self._simulation._native)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        recorder, self._recorder = self._recorder, None
        recordings = self._simulation._recordings
        self._simulation._recordings = [other for other in recordings if other is not self]
        if recorder is not None:
            self.frames, self.bytes = recorder.finish()
