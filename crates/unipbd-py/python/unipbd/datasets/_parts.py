"""The trajectories of a folder as the writers of the formats see them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._recipe import SPLITS, Recipe
from ._trajectory import read_record, spread
from ._types import fluid_rows, particle_types


@dataclass(frozen=True)
class Piece:
    """A trajectory of a split: some frames of a run.

    Attributes:
        index: number of the run. first, last: its frames, the last one left out.
        positions: float32, shape (T, N, 2), read from the file as asked for.
        types: particle types by format. fluid: which particles are fluid.
    """

    index: int
    first: int
    last: int
    positions: Any
    types: dict[str, npt.NDArray[np.int64]]
    fluid: npt.NDArray[np.bool_]


class Parts:
    """All runs of a recipe in a folder."""

    def __init__(self, recipe: Recipe, folder: Path) -> None:
        self.recipe = recipe
        self.folder = folder
        self.records = [read_record(folder / f"{index:05d}") for index in range(recipe.trajectories)]

    @property
    def particles_max(self) -> int:
        """Particles of the largest trajectory, walls and all."""
        return max(int(record["particles"]) + int(record["wall_particles"]) for record in self.records)

    @property
    def frame_time(self) -> float:
        """Time between two stored frames [s]."""
        return float(self.records[0]["frame_time"])

    @property
    def bounds(self) -> list[list[float]]:
        """The room that holds all runs: [from, to] for x and y [m]."""
        rooms = np.array([record["bounds"] for record in self.records])
        low, high = rooms[:, :, 0].min(axis=0), rooms[:, :, 1].max(axis=0)
        return [[float(low[axis]), float(high[axis])] for axis in range(2)]

    @property
    def periodic(self) -> list[bool]:
        """The periodic axes of the scene."""
        domain = self.records[0]["scene"].get("domain", {})
        return [domain.get(key) is not None for key in ("periodic_x", "periodic_y")]

    def frames_of(self, split: str) -> tuple[int, int]:
        """Trajectories of a split, and frames of each."""
        if self.recipe.cut == "frames":
            return (self.recipe.trajectories if self._range(split)[1] else 0), self._range(split)[1]
        return self.recipe.shares(self.recipe.trajectories)[split], self.recipe.frames + 1

    def _range(self, split: str) -> tuple[int, int]:
        """First frame and number of frames of a split of each run, with ``cut = "frames"``."""
        shares, first = self.recipe.shares(self.recipe.frames + 1), 0
        for name in SPLITS:
            if name == split:
                return first, shares[name]
            first += shares[name]
        raise KeyError(split)

    def split(self, split: str) -> Iterator[Piece]:
        """The trajectories of a split, one after the other."""
        for index, record in enumerate(self.records):
            if self.recipe.cut == "frames":
                first, count = self._range(split)
            else:
                first, count = 0, self.recipe.frames + 1 if self.recipe.split_of(index) == split else 0
            if count:
                yield self._piece(index, record, first, first + count)

    def _piece(self, index: int, record: dict[str, Any], first: int, last: int) -> Piece:
        positions = np.load(self.folder / f"{index:05d}" / "position.npy", mmap_mode="r")[first:last]
        kinds = spread(record["kinds"])
        names = record["materials"]
        materials = [names[number] for number in spread(record["material_of_particle"])]
        materials += ["walls"] * record["wall_particles"]
        types = {form: particle_types(kinds, materials, names, form, self.recipe.types.get(form, {}))
                 for form in ("lagrangebench", "gns")}
        return Piece(index, first, last, positions, types, fluid_rows(kinds))

    def all(self) -> Iterator[Piece]:
        """The trajectories of all splits."""
        for split in SPLITS:
            yield from self.split(split)
