"""Mean and deviation of displacements per stored frame, as the formats ask for them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

CHUNK = 64
"""Frames in memory at once: sums are taken in this order everywhere."""
LEAST = 1e-7
"""A deviation below it counts as 1, so that nobody divides by it."""

Points = npt.NDArray[np.float64]


def displacements(later: Any, earlier: Any, box: Points | None) -> Points:
    """From one frame to the next [m]; across the edges of a periodic box [m] the short way."""
    moved: Points = np.asarray(later, dtype=np.float64) - np.asarray(earlier, dtype=np.float64)
    return moved if box is None else moved - box * np.round(moved / box)


def periodic_box(metadata: dict[str, Any]) -> Points | None:
    """Widths of the periodic box. As in LagrangeBench it is periodic in all directions or not at all."""
    if not any(metadata["periodic_boundary_conditions"]):
        return None
    sides = np.asarray(metadata["bounds"], dtype=np.float64)
    box: Points = sides[:, 1] - sides[:, 0]
    return box


class _Moments:
    """Count, mean and sum of squares about it, taken on by parts."""

    def __init__(self) -> None:
        self.count = 0
        self.mean = np.zeros(2)
        self.squares = np.zeros(2)

    def add(self, values: Points) -> None:
        values = values.reshape(-1, 2)
        if not len(values):
            return
        mean = values.mean(axis=0)
        squares = ((values - mean) ** 2).sum(axis=0)
        total = self.count + len(values)
        apart = mean - self.mean
        self.squares = self.squares + squares + apart**2 * (self.count * len(values) / total)
        self.mean = self.mean + apart * (len(values) / total)
        self.count = total


def statistics(
    trajectories: Iterable[tuple[Any, npt.NDArray[np.bool_]]], box: Points | None
) -> dict[str, list[float]]:
    """``vel_mean``, ``vel_std``, ``acc_mean`` and ``acc_std`` over trajectories of equal weight: of displacements per
    stored frame, and of their differences, for the particles of each mask."""
    velocity, acceleration = [], []
    for positions, mask in trajectories:
        v, a = _of_one(positions, mask, box)
        velocity.append(v)
        acceleration.append(a)
    return {**_combined(velocity, "vel"), **_combined(acceleration, "acc")}


def _of_one(positions: Any, mask: npt.NDArray[np.bool_], box: Points | None) -> tuple[_Moments, _Moments]:
    velocities, accelerations = _Moments(), _Moments()
    for first in range(0, len(positions) - 1, CHUNK):
        # Two frames more: the last displacement of a chunk and the first of the next make an acceleration.
        x = np.asarray(positions[first : first + CHUNK + 2])[:, mask]
        v = displacements(x[1:], x[:-1], box)
        velocities.add(v[:CHUNK])
        accelerations.add(v[1:] - v[:-1])
    return velocities, accelerations


def _combined(parts: list[_Moments], name: str) -> dict[str, list[float]]:
    parts = [part for part in parts if part.count]
    if not parts:
        return {f"{name}_mean": [0.0, 0.0], f"{name}_std": [1.0, 1.0]}
    mean = np.mean([part.mean for part in parts], axis=0)
    square = np.mean([part.squares / part.count + (part.mean - mean) ** 2 for part in parts], axis=0)
    deviation = np.sqrt(square)
    deviation = np.where(deviation < LEAST, 1.0, deviation)
    return {f"{name}_mean": [float(part) for part in mean], f"{name}_std": [float(part) for part in deviation]}
