"""What hooks and constraint groups of your own are given."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Floats, Ids, numbers, pairs


class Substep:
    """The simulation at the start of a substep, for a hook. Good only within the call of the hook.

    Arrays are as those of `Simulation`: copies, in ascending order of ids.
    """

    __slots__ = ("_native",)

    def __init__(self, native: _native.Substep) -> None:
        self._native = native

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._native.time

    @property
    def dt(self) -> float:
        """Length of the substep [s]."""
        return self._native.dt

    @property
    def step(self) -> int:
        """Substeps done since the start."""
        return self._native.step

    @property
    def positions(self) -> Floats:
        """Positions [m], float32, shape (N, 2)."""
        return self._native.positions

    @property
    def velocities(self) -> Floats:
        """Velocities [m/s], float32, shape (N, 2)."""
        return self._native.velocities

    @property
    def ids(self) -> Ids:
        """Ids, uint32, shape (N,)."""
        return self._native.ids

    @property
    def phases(self) -> npt.NDArray[np.uint8]:
        """Phases, uint8, shape (N,)."""
        return self._native.phases

    @property
    def material_indices(self) -> npt.NDArray[np.uint16]:
        """Indices of materials, uint16, shape (N,)."""
        return self._native.material_indices

    def add_acceleration(self, acceleration: npt.ArrayLike) -> None:
        """Adds an acceleration [m/s^2] for this substep: shape (N, 2), or one vector for all.

        Particles moved by a script, and smoke, do not feel it.
        """
        array = numbers(acceleration, "accelerations", ValueError)
        if array.shape == (2,):
            self._native.add_uniform_acceleration(float(array[0]), float(array[1]))
        else:
            self._native.add_accelerations(pairs(array, len(self._native.ids), "accelerations", ValueError))

    def set_velocities(self, ids: npt.ArrayLike, velocities: npt.ArrayLike) -> None:
        """Sets velocities [m/s] of some particles by id: how those moved by a script are moved."""
        wanted = id_list(ids)
        self._native.set_velocities(wanted, pairs(velocities, len(wanted), "velocities", ValueError))


class Projection:
    """One iteration of a constraint group of your own. See `Simulation.add_group`."""

    __slots__ = ("_native",)

    def __init__(self, native: _native.Projection) -> None:
        self._native = native

    @property
    def time(self) -> float:
        """Simulated time at the start of the substep [s]."""
        return self._native.time

    @property
    def dt(self) -> float:
        """Length of the substep [s]."""
        return self._native.dt

    @property
    def positions(self) -> Floats:
        """Predicted and projected positions [m], float32, shape (N, 2)."""
        return self._native.positions

    @property
    def starts(self) -> Floats:
        """Positions at the start of the substep [m], float32, shape (N, 2)."""
        return self._native.starts

    @property
    def ids(self) -> Ids:
        """Ids, uint32, shape (N,)."""
        return self._native.ids

    @property
    def inverse_masses(self) -> Floats:
        """Inverse masses [1/kg], float32, shape (N,); 0 for what a script moves."""
        return self._native.inverse_masses


def id_list(ids: npt.ArrayLike) -> list[int]:
    """Ids as a list; whole numbers of any integer type, one or many."""
    array = np.atleast_1d(np.asarray(ids))
    if array.size == 0:
        return []
    if array.dtype.kind not in "iu" or array.ndim != 1:
        raise ValueError(f"ids must be whole numbers of shape (M,), not {array.dtype} of shape {array.shape}")
    least, most = int(array.min()), int(array.max())
    if least < 0 or most >= 2**32:
        raise ValueError(f"there is no particle with id {least if least < 0 else most}")
    return [int(value) for value in array.tolist()]
