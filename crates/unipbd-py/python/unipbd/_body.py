"""Rigid bodies of a running simulation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from . import _native
from ._arrays import Doubles

if TYPE_CHECKING:
    from ._world import World


class Body:
    """A rigid body, as it is at each access. See `Simulation.bodies`.

    To push one between two frames, or to drive a kinematic one, use `Edit.bodies`; within the
    substeps of a frame `Substep.bodies`.
    """

    def __init__(self, simulation: World, index: int) -> None:
        self._simulation = simulation
        self._index = index

    def _quantity(self, name: str) -> Any:
        return self._simulation._native.body_quantity(self._index, name)

    @property
    def name(self) -> str:
        """Name in the scene."""
        return cast(str, self._quantity("name"))

    @property
    def kind(self) -> str:
        """``"dynamic"``, ``"kinematic"`` or ``"static"``."""
        return cast(str, self._quantity("kind"))

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return float(self._quantity("mass"))

    @property
    def inertia(self) -> float:
        """Moment of inertia about the centre of mass [kg m^2]."""
        return float(self._quantity("inertia"))

    @property
    def outline(self) -> Doubles:
        """Corners in body coordinates, counter-clockwise [m], float64, shape (M, 2); empty for a disc."""
        return cast(Doubles, self._quantity("outline"))

    @property
    def radius(self) -> float:
        """Radius of a disc [m], 0 for a polygon."""
        return float(self._quantity("radius"))

    @property
    def samples(self) -> Doubles:
        """Lattice samples in body coordinates, through which the fluid feels it [m], float64, shape (M, 2)."""
        return cast(Doubles, self._quantity("samples"))

    @property
    def position(self) -> Doubles:
        """Centre of mass [m], float64, shape (2,)."""
        return cast(Doubles, self._quantity("position"))

    @property
    def angle(self) -> float:
        """Rotation, counter-clockwise [rad]."""
        return float(self._quantity("angle"))

    @property
    def velocity(self) -> Doubles:
        """Velocity of the centre of mass [m/s], float64, shape (2,)."""
        return cast(Doubles, self._quantity("velocity"))

    @property
    def angular_velocity(self) -> float:
        """Angular velocity, counter-clockwise [rad/s]."""
        return float(self._quantity("angular_velocity"))

    @property
    def fluid_force(self) -> Doubles:
        """Mean force of the fluid over the last frame [N], float64, shape (2,)."""
        return cast(Doubles, self._quantity("fluid_force"))

    @property
    def fluid_torque(self) -> float:
        """Mean torque of the fluid about the centre of mass over the last frame [N m]."""
        return float(self._quantity("fluid_torque"))

    @property
    def contact_force(self) -> Doubles:
        """Mean force of contacts and joints over the last frame [N], float64, shape (2,)."""
        return cast(Doubles, self._quantity("contact_force"))

    @property
    def contact_torque(self) -> float:
        """Mean torque of contacts and joints over the last frame [N m]."""
        return float(self._quantity("contact_torque"))

    @property
    def asleep(self) -> bool:
        """Whether it is held still until something wakes it."""
        return bool(self._quantity("asleep"))

    @property
    def friction(self) -> float:
        """Coulomb friction coefficient."""
        return float(self._quantity("friction"))

    @property
    def restitution(self) -> float:
        """Rebound speed over impact speed."""
        return float(self._quantity("restitution"))

    @property
    def gravity_factor(self) -> float:
        """Factor on gravity."""
        return float(self._quantity("gravity_factor"))

    @property
    def sensor(self) -> bool:
        """Whether it reports what it touches and pushes nothing."""
        return bool(self._quantity("sensor"))

    @property
    def user_data(self) -> int:
        """A number of your own, from ``user_data`` of the scene or `Edit`."""
        return int(self._quantity("user_data"))

    def wake(self) -> None:
        """Wakes it, with the bodies that it sleeps with and the liquid around them."""
        _native.wake(self._simulation._native, self._index)

    def __repr__(self) -> str:
        x, y = self.position
        return f"<{self.kind} body {self.name!r} at ({x:.3g}, {y:.3g}), angle {self.angle:.3g}>"
