"""Walls as sampled particles."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ._scene import Scene

FIXED, MOVING = 1, 2

Points = npt.NDArray[np.float64]
_SIDES = ("left", "right", "bottom", "top")


@dataclass(frozen=True)
class Walls:
    """Particles that stand for the walls of a scene.

    Attributes:
        positions: at time 0 [m], float64, shape (W, 2).
        velocities: of the walls that slide along themselves [m/s], float64, shape (W, 2).
        types: 1 for a wall, 2 for one that slides, shape (W,).
        lengths: the length over which a sliding row comes back [m], 0 for the others, shape (W,).
    """

    positions: Points
    velocities: Points
    types: npt.NDArray[np.int64]
    lengths: Points

    def at(self, time: float, wrap: bool) -> npt.NDArray[np.float32]:
        """Positions at a time [m], float32: with `wrap` a sliding row moves with its wall, and its end comes in at
        its beginning; without, all stand still."""
        if not wrap or not (self.lengths > 0.0).any():
            return self.positions.astype(np.float32)
        moved = self.positions.copy()
        speed = np.linalg.norm(self.velocities, axis=1)
        for row in np.flatnonzero((self.lengths > 0.0) & (speed > 0.0)):
            along = self.velocities[row] / speed[row]
            tail = self._tail(int(row), along)
            start = float(self.positions[row] @ along)
            place = (start - tail + float(speed[row]) * time) % float(self.lengths[row]) + tail
            moved[row] += (place - start) * along
        return moved.astype(np.float32)

    def _tail(self, row: int, along: Points) -> float:
        """Where the row of a particle begins."""
        same = (self.lengths == self.lengths[row]) & (self.velocities == self.velocities[row]).all(axis=1)
        places = self.positions[same] @ along
        count = len(np.unique(np.round(places, 9)))
        return float(places.min() - 0.5 * self.lengths[row] / max(count, 1))


def wall_particles(scene: Scene, layers: int = 1, reach: float = 1.0) -> Walls:
    """Samples tanks, obstacles and straight walls of a scene, one spacing apart, the first layer half
    a spacing inside the solid: as the fluid would go on.

    `layers` is their thickness in particles. Bodies are not among them: their samples are particles already. A
    straight wall without end is sampled along the box of the tanks, periodic axes and blocks of the scene, and
    `reach` spacings beyond it.
    """
    data = scene.to_dict()
    dx = float(data["spacing"])
    box = _box(data)
    parts: list[tuple[Points, list[float], float]] = []
    for tank in data.get("tank", []):
        parts.append((_ring(tank, dx, layers), [0.0, 0.0], 0.0))
    for wall in data.get("half_plane", []):
        parts.append(_row(wall, dx, layers, reach, box, _periodic(data)))
    for block in data.get("obstacle", []):
        parts.append((_shell(block, dx, layers), [0.0, 0.0], 0.0))
    return _joined(parts, dx)


def _joined(parts: list[tuple[Points, list[float], float]], dx: float) -> Walls:
    """All in one, without those that stand on another: walls that move first."""
    kept = np.empty((0, 2))
    velocities = np.empty((0, 2))
    lengths = np.empty(0)
    for points, velocity, length in sorted(parts, key=lambda part: not any(part[1])):
        apart = np.linalg.norm(points[:, None] - kept[None], axis=2).min(axis=1, initial=np.inf) > 0.6 * dx
        points = points[apart]
        kept = np.concatenate([kept, points])
        velocities = np.concatenate([velocities, np.broadcast_to(np.array(velocity), points.shape)])
        lengths = np.concatenate([lengths, np.full(len(points), length)])
    types = np.where(velocities.any(axis=1), MOVING, FIXED).astype(np.int64)
    return Walls(kept, velocities, types, lengths)


def _depth_of_box(point: Points, box: Mapping[str, Any]) -> float:
    """How deep a point lies in a box, negative outside."""
    (left, low), (right, high) = box["min"], box["max"]
    return float(min(point[0] - left, right - point[0], point[1] - low, high - point[1]))


def _axis(low: float, high: float, dx: float) -> Points:
    """A row of points between two walls, half a step from each: as near to a spacing apart as a whole number of them is."""
    count = max(1, round((high - low) / dx))
    places: Points = np.asarray(low + (np.arange(count) + 0.5) * ((high - low) / count), dtype=np.float64)
    return places


def _ring(tank: Mapping[str, Any], dx: float, layers: int) -> Points:
    """The lattice outside the closed sides of a tank."""
    (left, low), (right, high) = tank["min"], tank["max"]
    outer = (np.arange(layers) + 0.5) * dx
    all_x = np.concatenate([left - outer[::-1], _axis(left, right, dx), right + outer])
    all_y = np.concatenate([low - outer[::-1], _axis(low, high, dx), high + outer])
    grid = np.stack(np.meshgrid(all_x, all_y, indexing="ij"), axis=-1).reshape(-1, 2)
    side = {"left": grid[:, 0] < left, "right": grid[:, 0] > right,
            "bottom": grid[:, 1] < low, "top": grid[:, 1] > high}
    closed = [name for name in _SIDES if name not in tank.get("open", [])]
    opened = [name for name in _SIDES if name not in closed]
    kept = np.any([side[name] for name in closed] or [np.zeros(len(grid), dtype=bool)], axis=0)
    for name in opened:
        kept &= ~side[name]
    ring: Points = grid[kept]
    return ring


def _shell(box: Mapping[str, Any], dx: float, layers: int) -> Points:
    """The lattice just inside a box."""
    (left, low), (right, high) = box["min"], box["max"]
    grid = np.stack(np.meshgrid(_axis(left, right, dx), _axis(low, high, dx), indexing="ij"), axis=-1).reshape(-1, 2)
    return grid[[_depth_of_box(point, box) < layers * dx for point in grid]]


def _row(
    wall: Mapping[str, Any], dx: float, layers: int, reach: float, box: Points, periodic: list[bool]
) -> tuple[Points, list[float], float]:
    """Rows behind a straight wall, along the box."""
    normal = np.asarray(wall["normal"], dtype=np.float64)
    normal = normal / np.linalg.norm(normal)
    along = np.array([normal[1], -normal[0]])
    point = np.asarray(wall["point"], dtype=np.float64)
    corners = np.array([[x, y] for x in box[:, 0] for y in box[:, 1]])
    places = (corners - point) @ along
    ends = abs(along) @ np.array(periodic, dtype=np.float64) > 0.5
    extra = 0.0 if ends else round(reach) * dx
    first, last = float(places.min() - extra), float(places.max() + extra)
    row = _axis(first, last, dx)
    depth = (np.arange(layers) + 0.5) * dx
    points = point + row[None, :, None] * along - depth[:, None, None] * normal
    velocity = [float(part) for part in wall.get("velocity", [0.0, 0.0])]
    return points.reshape(-1, 2), velocity, last - first if any(velocity) else 0.0


def _periodic(data: Mapping[str, Any]) -> list[bool]:
    domain = data.get("domain", {})
    return [domain.get("periodic_x") is not None, domain.get("periodic_y") is not None]


def _box(data: Mapping[str, Any]) -> Points:
    """The room of the scene, as lower left and upper right corner."""
    boxes = [np.array([table["min"], table["max"]], dtype=np.float64) for table in data.get("tank", [])]
    if not boxes:
        boxes = [np.array([table["min"], table["max"]], dtype=np.float64) for table in data.get("block", [])]
    if not boxes:
        boxes = [np.array([[0.0, 0.0], [1.0, 1.0]])]
    box: Points = np.array([np.min([one[0] for one in boxes], axis=0), np.max([one[1] for one in boxes], axis=0)])
    domain = data.get("domain", {})
    for axis, key in enumerate(("periodic_x", "periodic_y")):
        if domain.get(key) is not None:
            box[:, axis] = domain[key]
    return box


def bounds(scene: Scene, walls: Walls) -> list[list[float]]:
    """The room of a scene with its walls: [from, to] for x and y [m]."""
    box = _box(scene.to_dict())
    if len(walls.positions):
        half = 0.5 * float(scene.spacing)
        outer = np.array([walls.positions.min(axis=0) - half, walls.positions.max(axis=0) + half])
        free = ~np.array(_periodic(scene.to_dict()))
        box[0, free] = np.minimum(box[0], outer[0])[free]
        box[1, free] = np.maximum(box[1], outer[1])[free]
    # Without what binary fractions leave of sums such as 2.0 + 0.06.
    return [[round(float(box[0, axis]), 12), round(float(box[1, axis]), 12)] for axis in range(2)]
