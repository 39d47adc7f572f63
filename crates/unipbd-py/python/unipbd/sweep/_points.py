"""What a sweep is made of, and the points that come of it."""

from __future__ import annotations

import copy
import itertools
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .._arrays import plain
from .._distribution import Distribution
from .._paths import assign, load
from .._scene_table import read_scene
from .._toml import RecipeError, known

_KEYS = "name description scene seed repeats draws sampling grid list random reduce logs".split()
REDUCTIONS = ("max", "min", "mean", "last")


@dataclass(frozen=True)
class Sweep:
    """A scene, the keys that change, and what is kept. Read one with `load`.

    Every value of the grids is combined with every row of the lists and every draw, `repeats` times with other seeds.

    Attributes:
        scene: the scene as a dict.
        grid: tables with a `key` and `values`, or `from`, `to` and `count`.
        list: tables with several `keys` and rows of `values`, which change together.
        random: tables with a `key` and a distribution; `draws` of them are made.
        sampling: ``"random"`` or ``"latin_hypercube"``.
        reduce: over all frames of a run, by the name of a diagnostic: ``max``, ``min``, ``mean``, or several.
        logs: whether every run is recorded.
        seed: of the draws and the runs.
    """

    scene: dict[str, Any]
    name: str = ""
    seed: int = 0
    repeats: int = 1
    draws: int = 1
    sampling: str = "random"
    grid: tuple[dict[str, Any], ...] = ()
    list: tuple[dict[str, Any], ...] = ()
    random: tuple[dict[str, Any], ...] = ()
    reduce: dict[str, Any] = field(default_factory=dict)
    logs: bool = False
    description: str = ""

    @classmethod
    def load(cls, path: str | os.PathLike[str], changes: Mapping[str, Any] | None = None) -> Sweep:
        """Reads a sweep file; `changes` replace values by their paths. Raises `RecipeError` with the line, `SceneError`
        for its scene, or `OSError`."""
        return load(path, changes, cls.from_dict)

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any], folder: str | os.PathLike[str] = ".") -> Sweep:
        """A sweep from nested dicts; a scene that is a path is looked for in `folder`."""
        data = plain(copy.deepcopy(dict(tables)))
        known(data, _KEYS)
        data["scene"] = read_scene(data.get("scene"), Path(folder))
        for key in ("grid", "list", "random"):
            data[key] = tuple(data.get(key, ()))
        sweep = cls(**data)
        sweep._check()
        return sweep

    def to_dict(self) -> dict[str, Any]:
        """A copy as nested dicts and lists."""
        data = copy.deepcopy(dict(self.__dict__))
        return {key: [*value] if isinstance(value, tuple) else value for key, value in data.items()}

    def __len__(self) -> int:
        """Number of runs."""
        return len(self._combinations()) * self.draws * self.repeats

    def point(self, index: int) -> dict[str, Any]:
        """The values of a run by their keys, without the seed."""
        combination, draw, _ = self._place(index)
        values = dict(self._combinations()[combination])
        for key, column in zip(self._random_keys(), self._drawn(), strict=True):
            values[key] = column[draw]
        return values

    def scene_of(self, index: int) -> tuple[dict[str, Any], int]:
        """The scene and the seed of a run: repeats of a point differ in the seed alone."""
        scene = copy.deepcopy(self.scene)
        for key, value in self.point(index).items():
            assign(scene, key, copy.deepcopy(value))
        seed = self.seed + self._place(index)[2]
        scene["seed"] = seed
        return scene, seed

    def _place(self, index: int) -> tuple[int, int, int]:
        if not 0 <= index < len(self):
            raise IndexError(f"there is no run {index} of {len(self)}")
        rest, repeat = divmod(index, self.repeats)
        combination, draw = divmod(rest, self.draws)
        return combination, draw, repeat

    def _combinations(self) -> Any:
        axes = [[[(table["key"], value)] for value in _values(table, f"grid[{number}]")]
                for number, table in enumerate(self.grid)]
        axes += [[[*zip(table["keys"], row, strict=True)] for row in table["values"]] for table in self.list]
        return [[pair for part in parts for pair in part] for parts in itertools.product(*axes)]

    def _random_keys(self) -> Any:
        return [table["key"] for table in self.random]

    def _drawn(self) -> Any:
        """Values of all draws, by random key."""
        random = np.random.Generator(np.random.PCG64(np.random.SeedSequence([self.seed, 7])))
        columns = []
        for number, table in enumerate(self.random):
            distribution = _distribution(table, f"random[{number}]")
            units = random.random((self.draws, distribution.dimension))
            if self.sampling == "latin_hypercube":
                # One draw in each of as many strips, in an order of its own for every number that is drawn.
                strips = np.stack([random.permutation(self.draws) for _ in range(distribution.dimension)], axis=1)
                units = (strips + units) / self.draws
            columns.append([distribution.at(row) for row in units])
        return columns

    def _check(self) -> None:
        for key, low in (("seed", 0), ("repeats", 1), ("draws", 1)):
            value = getattr(self, key)
            if not isinstance(value, int) or value < low:
                raise RecipeError(f"a whole number from {low} on is wanted, not {value!r}", key)
        if self.sampling not in ("random", "latin_hypercube"):
            raise RecipeError(f"{self.sampling!r} is not known here", "sampling", "there are random, latin_hypercube")
        for name, how in self.reduce.items():
            for one in how if isinstance(how, (tuple, type([]))) else [how]:
                if one not in REDUCTIONS:
                    raise RecipeError(f"{one!r} is not known here", f"reduce.{name}", f"there are {', '.join(REDUCTIONS)}")
        for number, table in enumerate(self.list):
            _check_list(table, f"list[{number}]", self.scene)
        for kind in ("grid", "random"):
            for number, table in enumerate(getattr(self, kind)):
                where = f"{kind}[{number}]"
                if not isinstance(table.get("key"), str):
                    raise RecipeError('a key of the scene is wanted, such as key = "block.0.max"', where)
                assign(copy.deepcopy(self.scene), table["key"], 0, f"{where}.key")
                if kind == "grid":
                    _values(table, where)
                else:
                    _distribution(table, where)


def _values(table: Mapping[str, Any], where: str) -> Any:
    """The values of a grid."""
    known(table, ("key", "values", "from", "to", "count"), where)
    if "values" in table:
        if not table["values"]:
            raise RecipeError("a list of values is wanted", f"{where}.values")
        return table["values"]
    if not all(key in table for key in ("from", "to", "count")) or int(table["count"]) < 1:
        raise RecipeError("values are wanted, or from, to and count", where)
    return [float(value) for value in np.linspace(table["from"], table["to"], int(table["count"]))]


def _distribution(table: Mapping[str, Any], where: str) -> Distribution:
    found = Distribution.parse({key: value for key, value in table.items() if key != "key"}, where)
    if found is None:
        raise RecipeError("a distribution is wanted", where, "such as uniform = [0.5, 1.5]")
    return found


def _check_list(table: Mapping[str, Any], where: str, scene: dict[str, Any]) -> None:
    known(table, ("keys", "values"), where)
    keys, rows = table.get("keys"), table.get("values")
    if not keys or not rows or any(not isinstance(row, (tuple, type([]))) or len(row) != len(keys) for row in rows):
        raise RecipeError("keys are wanted, and rows of as many values", where)
    for key in keys:
        assign(copy.deepcopy(scene), key, 0, f"{where}.keys")
