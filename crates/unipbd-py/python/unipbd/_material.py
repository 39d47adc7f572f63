"""The particles of one material."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ._arrays import Floats, Ids, fixed
from ._phase import Phase

if TYPE_CHECKING:
    from ._observe import Observable


class Material:
    """The particles of one material, as they are at each access. See `Simulation.material`.

    Arrays are read-only copies with one row per particle of the material, in ascending order of ids.
    """

    def __init__(self, simulation: Observable, index: int) -> None:
        self._simulation = simulation
        self._index = index
        self._name, phase, self._density, self._color = simulation._native.materials()[index]
        self._phase = Phase(phase)

    @property
    def name(self) -> str:
        """Name in the scene."""
        return self._name

    @property
    def phase(self) -> Phase:
        """What its particles are."""
        return self._phase

    @property
    def density(self) -> float:
        """Rest density [kg/m^2]; 0 for smoke."""
        return self._density

    @property
    def color(self) -> str:
        """Colour in pictures, ``"#rrggbb"``."""
        return self._color

    @property
    def mask(self) -> npt.NDArray[np.bool_]:
        """Which of the simulation's rows are of this material, bool, shape (N,)."""
        mask: npt.NDArray[np.bool_] = self._simulation.material_indices == self._index
        return fixed(mask)

    @property
    def ids(self) -> Ids:
        """Ids in ascending order, uint32, shape (M,)."""
        return fixed(self._simulation.ids[self.mask])

    @property
    def positions(self) -> Floats:
        """Positions [m], float32, shape (M, 2)."""
        return fixed(self._simulation.positions[self.mask])

    @property
    def velocities(self) -> Floats:
        """Velocities [m/s], float32, shape (M, 2)."""
        return fixed(self._simulation.velocities[self.mask])

    @property
    def density_errors(self) -> Floats:
        """Density errors C = rho/rho0 - 1, as fractions, float32, shape (M,)."""
        return fixed(self._simulation.density_errors[self.mask])

    def __len__(self) -> int:
        return int(np.count_nonzero(self.mask))

    def __repr__(self) -> str:
        return f"<{self.phase.name.lower()} {self.name!r}: {len(self)} particles>"
