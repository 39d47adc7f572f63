"""Particles by the cells of a grid."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Values = npt.NDArray[np.float64]


class Cells:
    """A grid over a box: `shape` columns and rows, numbered row by row from the lower left."""

    def __init__(self, low: npt.ArrayLike, high: npt.ArrayLike, shape: tuple[int, int]) -> None:
        self.low = np.asarray(low, dtype=np.float64)
        self.shape = shape
        self.count = shape[0] * shape[1]
        self.size = (np.asarray(high, dtype=np.float64) - self.low) / shape
        """Width and height of a cell [m]."""

    def numbers(self, x: npt.NDArray[Any]) -> npt.NDArray[np.intp]:
        """The cell of each point; `count` for those outside."""
        place = np.floor((x - self.low) / self.size).astype(np.intp)
        # Below 0 is far above any number of cells in numbers without a sign.
        across, up = place.view(np.uintp).T
        inside = (across < self.shape[0]) & (up < self.shape[1])
        return np.where(inside, place[:, 1] * self.shape[0] + place[:, 0], self.count)

    def sums(self, numbers: npt.NDArray[np.intp], weights: npt.NDArray[Any] | None = None) -> Values:
        """How many points each cell has, or the sum of their weights."""
        found = np.bincount(numbers, weights, self.count + 1)[: self.count]
        return found.astype(np.float64, copy=False)
