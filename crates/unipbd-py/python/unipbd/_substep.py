"""What hooks and constraint groups of your own are given."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Generic, TypeVar

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Doubles, Floats, Ids, fixed, numbers, pair, pairs

Native = TypeVar("Native", bound=_native.Particles)


class Particles(Generic[Native]):
    """The particles of one moment within a substep.

    Arrays are as those of `Simulation`: read-only copies, in ascending order of ids.
    """

    __slots__ = ("_native",)

    def __init__(self, native: Native) -> None:
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
        """Positions as they are now [m], float32, shape (N, 2)."""
        return self._native.positions

    @property
    def velocities(self) -> Floats:
        """Velocities as they are now [m/s], float32, shape (N, 2)."""
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

    @property
    def inverse_masses(self) -> Floats:
        """Inverse masses [1/kg], float32, shape (N,); 0 for kinematic ones."""
        return self._native.inverse_masses

    def __len__(self) -> int:
        return len(self._native.ids)


class Substep(Particles[_native.Substep]):
    """The simulation at the start of a substep, for a hook. Good only within the call of the hook."""

    __slots__ = ()

    @property
    def step(self) -> int:
        """Substeps done since the start."""
        return self._native.step

    @property
    def bodies(self) -> Mapping[str, SubstepBody]:
        """Rigid bodies by name, to be looked at, pushed and driven."""
        seen = enumerate(self._native.bodies())
        there = ((index, name, rest) for index, (name, *rest) in seen if name)
        return {name: SubstepBody(self._native, index, *rest) for index, name, rest in there}  # type: ignore[arg-type]

    def add_acceleration(self, acceleration: npt.ArrayLike) -> None:
        """Adds an acceleration [m/s^2] for this substep: shape (N, 2), or one vector for all.

        Kinematic particles, smoke and the samples of bodies do not feel it; a body is pushed
        by `SubstepBody.push`.
        """
        array = numbers(acceleration, "accelerations", ValueError)
        if array.shape == (2,):
            self._native.add_uniform_acceleration(float(array[0]), float(array[1]))
        else:
            self._native.add_accelerations(pairs(array, len(self), "accelerations", ValueError))

    def set_velocities(self, ids: npt.ArrayLike, velocities: npt.ArrayLike) -> None:
        """Sets velocities [m/s] of some particles by id: how kinematic ones are moved.

        `velocities` is one vector or an array of shape (M, 2).
        """
        wanted = id_list(ids)
        self._native.set_velocities(wanted, pairs(velocities, len(wanted), "velocities", ValueError))


class SubstepBody:
    """A rigid body at the start of a substep. See `Substep.bodies`."""

    __slots__ = ("_angle", "_angular_velocity", "_index", "_native", "_position", "_velocity")

    def __init__(
        self,
        native: _native.Substep,
        index: int,
        position: list[float],
        angle: float,
        velocity: list[float],
        angular_velocity: float,
    ) -> None:
        self._native = native
        self._index = index
        self._position = position
        self._angle = angle
        self._velocity = velocity
        self._angular_velocity = angular_velocity

    @property
    def position(self) -> Doubles:
        """Centre of mass [m], float64, shape (2,)."""
        return fixed(np.array(self._position))

    @property
    def angle(self) -> float:
        """Rotation, counter-clockwise [rad]."""
        return self._angle

    @property
    def velocity(self) -> Doubles:
        """Velocity of the centre of mass [m/s], float64, shape (2,)."""
        return fixed(np.array(self._velocity))

    @property
    def angular_velocity(self) -> float:
        """Angular velocity, counter-clockwise [rad/s]."""
        return self._angular_velocity

    def push(self, force: npt.ArrayLike = (0.0, 0.0), torque: float = 0.0) -> None:
        """Lets a force [N] at the centre of mass and a torque [N m] act in this substep. The body
        must be dynamic."""
        self._native.push_body(self._index, pair(force, "the force", ValueError), float(torque))

    def drive(self, velocity: npt.ArrayLike = (0.0, 0.0), angular_velocity: float = 0.0) -> None:
        """Sets velocity [m/s] and angular velocity [rad/s]. A kinematic body keeps them, whatever
        its script says, until it is driven anew."""
        self._native.drive_body(self._index, pair(velocity, "the velocity", ValueError), float(angular_velocity))


class Projection(Particles[_native.Projection]):
    """One iteration of a constraint group of your own. See `Simulation.add_group`.

    `positions` are those that earlier groups and iterations have left.
    """

    __slots__ = ()

    @property
    def starts(self) -> Floats:
        """Positions at the start of the substep [m], float32, shape (N, 2)."""
        return self._native.starts


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
