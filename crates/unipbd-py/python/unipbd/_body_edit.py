"""Changes of rigid bodies between two frames."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._arrays import Doubles, fixed, pair
from ._errors import EditError


class BodyEdit:
    """A rigid body whose velocity is to be changed. See `Edit.bodies`.

    A dynamic body goes on from the velocity it is given. A kinematic one keeps it, whatever its
    script says, until it is given another: set it before every step to move a body as you like.
    """

    def __init__(self, name: str, velocity: Doubles, angular_velocity: float) -> None:
        self._name = name
        self._velocity = velocity
        self._angular_velocity = angular_velocity
        self._changed = False

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
