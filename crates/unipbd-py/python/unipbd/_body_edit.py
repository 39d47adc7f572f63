"""Changes of rigid bodies between two frames."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._arrays import Doubles, fixed, pair, plain
from ._errors import EditError

_PROPERTIES = (
    "kind",
    "mass",
    "friction",
    "rolling_friction",
    "restitution",
    "surface_speed",
    "gravity_factor",
    "linear_damping",
    "angular_damping",
    "layers",
    "collides_with",
    "collision_group",
    "user_data",
    "radius",
    "size",
    "outline",
)


class BodyEdit:
    """A rigid body that is to be changed. See `Edit.bodies`.

    A dynamic body goes on from the velocity it is given. A kinematic one keeps it, whatever its
    script says, until it is given another: set it before every step to move a body as you like.
    """

    def __init__(self, name: str, number: int, pose: Doubles, velocity: Doubles) -> None:
        self._name = name
        self._number = number
        # Views of arrays that nobody can write to.
        self._position = pose[:2]
        self._angle = float(pose[2])
        self._velocity = velocity[:2]
        self._angular_velocity = float(velocity[2])
        self._changed = False
        self._moved = False
        self._values: dict[str, Any] = {}
        self._pushes: list[dict[str, Any]] = []

    @property
    def velocity(self) -> Doubles:
        """Velocity of the centre of mass [m/s], float64, shape (2,), to be set as a whole."""
        return self._velocity

    @velocity.setter
    def velocity(self, value: npt.ArrayLike) -> None:
        self._velocity = fixed(np.array(pair(value, f"velocity of {self._name!r}", EditError)))
        self._changed = True

    @property
    def angular_velocity(self) -> float:
        """Angular velocity, counter-clockwise [rad/s], to be set."""
        return self._angular_velocity

    @angular_velocity.setter
    def angular_velocity(self, value: float) -> None:
        self._angular_velocity = float(value)
        self._changed = True

    @property
    def position(self) -> Doubles:
        """Centre of mass [m], float64, shape (2,), to be set as a whole: the body is there at once."""
        return self._position

    @position.setter
    def position(self, value: npt.ArrayLike) -> None:
        self._position = fixed(np.array(pair(value, f"position of {self._name!r}", EditError)))
        self._moved = True

    @property
    def angle(self) -> float:
        """Rotation, counter-clockwise [rad], to be set."""
        return self._angle

    @angle.setter
    def angle(self, value: float) -> None:
        self._angle = float(value)
        self._moved = True

    def push(self, impulse: npt.ArrayLike, at: npt.ArrayLike | None = None) -> None:
        """Pushes a dynamic body by an impulse [N s], at a point of the world [m] or its centre of mass."""
        push = {"impulse": pair(impulse, "impulse", EditError), "at": at}
        self._pushes.append(push)

    def set(self, **values: Any) -> None:
        """Changes properties: ``kind``, ``mass`` [kg], ``friction``, ``rolling_friction``, ``restitution``,
        ``surface_speed`` [m/s], ``gravity_factor``, ``linear_damping``, ``angular_damping`` [1/s], ``layers``,
        ``collides_with``, ``collision_group``, ``user_data``; or its shape, by one of ``radius``, ``size`` and
        ``outline`` [m], about the centre of mass, which stays: the mass follows from the density where the body has
        one, the inertia from both."""
        for key in values:
            if key not in _PROPERTIES:
                raise EditError(f"a body has no {key!r} to change; there are {', '.join(_PROPERTIES)}")
        self._values.update(values)

    def _changes(self) -> list[dict[str, Any]]:
        changes: list[dict[str, Any]] = []
        body = self._number
        if self._moved:
            position = self._position.tolist()
            changes.append({"change": "move_body", "body": body, "position": position, "angle": self._angle})
        if self._values:
            changes.append({"change": "change_body", "body": body, "values": plain(self._values)})
        for push in self._pushes:
            point = self._position.tolist() if push["at"] is None else pair(push["at"], "at", EditError)
            changes.append({"change": "push_body", "body": body, "impulse": push["impulse"], "point": point})
        return changes
