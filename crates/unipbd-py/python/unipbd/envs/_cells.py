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
        # Axis by axis: NumPy is slow along rows of two.
        across, up = (np.floor((x[:, axis] - self.low[axis]) / self.size[axis]).astype(np.intp) for axis in range(2))
        # Below 0 is far above any number of cells in numbers without a sign.
        inside = (across.view(np.uintp) < self.shape[0]) & (up.view(np.uintp) < self.shape[1])
        return np.where(inside, up * self.shape[0] + across, self.count)

    def sums(self, numbers: npt.NDArray[np.intp], weights: npt.NDArray[Any] | None = None) -> Values:
        """How many points each cell has, or the sum of their weights."""
        found = np.bincount(numbers, weights, self.count + 1)[: self.count]
        return found.astype(np.float64, copy=False)
