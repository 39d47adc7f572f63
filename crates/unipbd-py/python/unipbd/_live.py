"""Viewers that watch a run."""

from __future__ import annotations

from types import TracebackType
from typing import TYPE_CHECKING

from . import _native

if TYPE_CHECKING:
    from ._simulation import Simulation


class Live:
    """Lets viewers watch and steer a simulation until it is closed. See `Simulation.live`."""

    def __init__(self, simulation: Simulation, address: str, speed: float, paused: bool, fields: str) -> None:
        self._simulation: Simulation | None = simulation
        self.url = _native.start_live(simulation._native, address, speed, paused, fields)
        """Where viewers connect."""

    def __repr__(self) -> str:
        return f"<Live at {self.url}{'' if self._simulation else ', closed'}>"

    @property
    def viewers(self) -> int:
        """Number of viewers that are connected."""
        return _native.live_viewers(self._simulation._native) if self._simulation else 0

    def hold(self, seconds: float | None = None) -> None:
        """Answers viewers while the simulation does not step: for some seconds, or, left out, until all have left."""
        if self._simulation:
            _native.hold_live(self._simulation._native, seconds)
            self._simulation._tell()

    def close(self) -> None:
        """Closes the connections. Nothing happens where that was done before."""
        simulation, self._simulation = self._simulation, None
        if simulation:
            _native.stop_live(simulation._native)
            simulation._tell()

    def __enter__(self) -> Live:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
