"""Bodies, joints, contacts, emitters and ropes of a running simulation: as arrays, and asked."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy.typing as npt

from . import _native
from ._arrays import Doubles, pair
from ._body import Body

_ALL_LAYERS = 0xFFFFFFFF


class Contact(NamedTuple):
    """A contact point. See `Simulation.contacts`."""

    body: str
    """Name of the first body."""
    other: str | None
    """Name of the second body; None for a wall."""
    wall: int | None
    """Number of the wall in the order of the scene; None for two bodies."""
    position: tuple[float, float]
    """The point [m]."""
    normal: tuple[float, float]
    """Unit normal, towards the first body."""
    gap: float
    """Distance of the surfaces, negative when they overlap [m]."""
    normal_force: float
    """Normal force on the first body in the last substep [N]."""
    friction_force: float
    """Friction force on the first body, along the normal turned left [N]."""


class ContactPair(NamedTuple):
    """Two bodies, or a body and a wall, that touched in a frame. See `Simulation.contact_pairs`."""

    body: str
    other: str | None
    wall: int | None
    impulse: tuple[float, float]
    """Impulse on the first body over the frame [N s]."""


class ContactEvent(NamedTuple):
    """A contact that began or ended. See `Simulation.take_contact_events`."""

    frame: int
    """Frames watched before it."""
    began: bool
    body: str
    other: str | None
    wall: int | None
    sensor: bool
    """Whether the first body is a sensor."""


class RayHit(NamedTuple):
    """Where a ray enters a solid. See `Simulation.ray_cast`."""

    body: str | None
    wall: int | None
    point: tuple[float, float]
    normal: tuple[float, float]
    fraction: float
    """Part of the way from the start of the ray to its end."""


class Nearest(NamedTuple):
    """The outline nearest to a point. See `Simulation.nearest`."""

    body: str | None
    wall: int | None
    distance: float
    """Negative inside [m]."""
    point: tuple[float, float]
    normal: tuple[float, float]


class Joint(NamedTuple):
    """A joint with its load. See `Simulation.joints`."""

    name: str
    kind: str
    """``"hinge"``, ``"distance"``, ``"weld"``, ``"slider"`` or ``"pulley"``."""
    body: str
    other: str | None
    """Name of the second body; None for the world."""
    force: tuple[float, float]
    """Mean force on the first body at its anchor over the last frame [N]."""
    torque: float
    """Mean torque on the first body about its anchor over the last frame [N m]."""
    broken: bool
    removed: bool


class Emitter(NamedTuple):
    """An emitter as it is now. See `Simulation.emitters`."""

    name: str
    material: str
    position: tuple[float, float]
    """Middle of its face [m]."""
    speed: float
    """Speed at its face [m/s]."""
    temperature: float
    running: bool
    removed: bool


class Rope(NamedTuple):
    """A rope as it is now. See `Simulation.ropes`."""

    ids: list[int]
    """Ids of its points, from its first end to its last."""
    cuts: list[int]
    """Pieces that are cut: number k lies between the points k and k + 1."""
    removed: bool


class World:
    """Bodies, joints, contacts, emitters and ropes of a `Simulation`, between two frames."""

    _native: _native.Solver

    @property
    def bodies(self) -> Mapping[str, Body]:
        """Rigid bodies by name, without those that were taken away."""
        return {name: Body(self, number) for number, name in _native.body_roster(self._native)}

    @property
    def body_names(self) -> list[str]:
        """Names of the bodies, in the order of `bodies` and of the rows of `body_poses`."""
        return [name for _, name in _native.body_roster(self._native)]

    @property
    def body_poses(self) -> Doubles:
        """Centre of mass [m] and angle [rad] of all bodies, float64, shape (N, 3): x, y, angle."""
        return _native.body_poses(self._native, 1.0)

    @property
    def body_velocities(self) -> Doubles:
        """Velocity [m/s] and angular velocity [rad/s] of all bodies, float64, shape (N, 3)."""
        return _native.body_velocities(self._native)

    def interpolated_poses(self, part: float) -> Doubles:
        """`body_poses` between the last two frames, to draw more pictures than frames: `part` is 0 at
        the start of the last frame and 1 at its end."""
        return _native.body_poses(self._native, float(part))

    @property
    def gravity(self) -> tuple[float, float]:
        """Gravity [m/s^2]; `Edit.gravity` changes it."""
        return self._native.gravity

    @property
    def joints(self) -> list[Joint]:
        """All joints by number, with their loads; those that are broken or removed keep their place."""
        return [Joint(**joint) for joint in _native.joints(self._native)]

    @property
    def emitters(self) -> list[Emitter]:
        """All emitters by number; those that were removed keep their place."""
        return [Emitter(*emitter) for emitter in _native.emitters(self._native)]

    @property
    def ropes(self) -> list[Rope]:
        """All ropes by number; those that were removed keep their place."""
        return [Rope(*rope) for rope in _native.ropes(self._native)]

    def wake(self) -> None:
        """Wakes all bodies and liquids that sleep."""
        _native.wake(self._native, None)

    # -- contacts ------------------------------------------------------------------------------

    def _names(self) -> dict[int | None, str]:
        return {None: "", **dict(_native.body_roster(self._native))}

    def contacts(self) -> list[Contact]:
        """Contact points of the last substep, those of sleeping bodies too."""
        names = self._names()
        points = []
        for point in _native.contacts(self._native):
            other = point["other"]
            named = {"body": names[point["body"]], "other": None if other is None else names[other]}
            points.append(Contact(**{**point, **named}))
        return points

    def watch_contacts(self, watch: bool = True) -> None:
        """From now on notes which bodies touch in each frame, and when that begins and ends."""
        _native.watch_contacts(self._native, watch)

    def contact_pairs(self) -> list[ContactPair]:
        """Pairs that touched in the last frame; empty unless contacts are watched."""
        names = self._names()
        return [
            ContactPair(names[body], None if other is None else names[other], wall, impulse)
            for body, other, wall, impulse in _native.contact_pairs(self._native)
            if body in names and other in names
        ]

    def take_contact_events(self) -> list[ContactEvent]:
        """Takes the contacts that began and ended since the last call, sensors included; empty unless
        contacts are watched. Events of bodies that are gone are left out."""
        names = self._names()
        return [
            ContactEvent(frame, began, names[body], None if other is None else names[other], wall, sensor)
            for frame, began, body, other, wall, sensor in _native.take_contact_events(self._native)
            if body in names and other in names
        ]

    # -- places --------------------------------------------------------------------------------

    def ray_cast(
        self,
        start: npt.ArrayLike,
        end: npt.ArrayLike,
        layers: Iterable[int] | None = None,
        sensors: bool = False,
        walls: bool = True,
    ) -> list[RayHit]:
        """The solids that a ray enters on its way from `start` to `end` [m], the nearest first.

        Solids that it starts in are left out. With `layers` only bodies in one of these collision
        layers are met, with `sensors` sensors too.
        """
        names = self._names()
        ends = (pair(start, "start", ValueError), pair(end, "end", ValueError))
        hits = _native.ray_cast(self._native, ends, _mask(layers), sensors, walls)
        return [
            RayHit(None if body is None else names[body], wall, point, normal, fraction)
            for (body, wall), point, normal, fraction in hits
        ]

    def bodies_at(
        self, point: npt.ArrayLike, layers: Iterable[int] | None = None, sensors: bool = False
    ) -> list[str]:
        """Names of the bodies that hold a point [m]."""
        return self.bodies_in(point, point, layers, sensors)

    def bodies_in(
        self,
        low: npt.ArrayLike,
        high: npt.ArrayLike,
        layers: Iterable[int] | None = None,
        sensors: bool = False,
    ) -> list[str]:
        """Names of the bodies that overlap a box, from its lower left to its upper right corner [m]."""
        names = self._names()
        corners = (pair(low, "low", ValueError), pair(high, "high", ValueError))
        return [names[body] for body in _native.bodies_in(self._native, corners, _mask(layers), sensors)]

    def nearest(
        self,
        point: npt.ArrayLike,
        within: float = float("inf"),
        layers: Iterable[int] | None = None,
        sensors: bool = False,
        walls: bool = True,
    ) -> Nearest | None:
        """The solid whose outline is nearest to a point, no farther than `within` [m]."""
        place = pair(point, "point", ValueError)
        found = _native.nearest(self._native, place, float(within), _mask(layers), sensors, walls)
        if found is None:
            return None
        (body, wall), distance, on, normal = found
        return Nearest(None if body is None else self._names()[body], wall, distance, on, normal)


def _mask(layers: Iterable[int] | None) -> int:
    if layers is None:
        return _ALL_LAYERS
    mask = 0
    for layer in layers:
        if not 0 <= layer < 32:
            raise ValueError(f"there are 32 layers, from 0: not {layer}")
        mask |= 1 << layer
    return mask


__all__ = ["Contact", "ContactEvent", "ContactPair", "Emitter", "Joint", "Nearest", "RayHit", "Rope", "World"]
