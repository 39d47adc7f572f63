"""Numbers about one frame of a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import _native

_COPIED = (
    "time substeps density_error_mean density_error_max density_error_min pressure_max kinetic_energy "
    "potential_energy momentum angular_momentum speed_max"
).split()


@dataclass(frozen=True)
class Frame:
    """Numbers about one frame of a run. They stay the same when the run goes on.

    The attributes are the numbers asked for most; `diagnostics` has every one.

    Attributes:
        time: simulated time at the end of the frame [s].
        number: frames done, from the start of the run.
        substeps: substeps the frame took.
        particles: number of particles.
        density_error_mean: mean of max(C, 0) over the fluid, C = rho/rho0 - 1, as a fraction.
        density_error_max: largest C, as a fraction.
        density_error_min: smallest C, as a fraction; below 0 where the fluid is thinned.
        pressure_max: largest pressure over density [m^2/s^2].
        kinetic_energy: kinetic energy [J].
        potential_energy: potential energy in the gravity of the scene, 0 at the origin [J].
        momentum: linear momentum (x, y) [kg m/s].
        angular_momentum: angular momentum about the origin [kg m^2/s].
        speed_max: largest speed of a particle [m/s].
        diagnostics: all of these and more, by name; see `Simulation.diagnostics`.
        timings: wall-clock time spent in each stage since the start of the run [s].
    """

    time: float
    number: int
    substeps: int
    particles: int
    density_error_mean: float
    density_error_max: float
    density_error_min: float
    pressure_max: float
    kinetic_energy: float
    potential_energy: float
    momentum: tuple[float, float]
    angular_momentum: float
    speed_max: float
    diagnostics: Mapping[str, Any] = field(repr=False)
    timings: Mapping[str, float] = field(repr=False)

    @property
    def energy(self) -> float:
        """Kinetic and potential energy [J]."""
        return self.kinetic_energy + self.potential_energy

    @classmethod
    def _of(cls, native: _native.Solver) -> Frame:
        numbers = native.diagnostics()
        fields = {name: numbers[name] for name in _COPIED}
        timings = native.timings()
        return cls(number=numbers["frame"], particles=native.count, diagnostics=numbers, timings=timings, **fields)
