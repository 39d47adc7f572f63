"""From a recipe and the number of a trajectory to a scene."""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .._distribution import Distribution
from .._paths import assign
from .._toml import RecipeError, known

if TYPE_CHECKING:
    from ._recipe import Recipe

TABLES = ("block", "disc", "body", "emitter", "obstacle")
"""What can be scattered."""
TRIES = 1000
"""Places tried for one of them before the whole scene is drawn anew."""


class Crowded(Exception):
    """No room was found for all that is scattered."""


class Drawer:
    """Draws scenes: the same for the same recipe, number and attempt, on any machine."""

    def __init__(self, recipe: Recipe) -> None:
        self._recipe = recipe
        self._vary = [_Vary(table, f"vary[{number}]", recipe.scene) for number, table in enumerate(recipe.vary)]
        self._scatter = [_scatter(table, f"scatter[{number}]") for number, table in enumerate(recipe.scatter)]

    def draw(self, index: int, attempt: int) -> tuple[dict[str, Any], int]:
        """The scene of a trajectory and the seed of its run. Raises `Crowded` where things find no room."""
        random = np.random.Generator(np.random.PCG64(np.random.SeedSequence([self._recipe.seed, index, attempt])))
        seed = int(random.integers(2**63))
        scene = copy.deepcopy(self._recipe.scene)
        for vary in self._vary:
            vary.set(scene, random)
        placed: list[tuple[list[float], float, float]] = []
        for table in self._scatter:
            table.place(scene, random, placed)
        scene["seed"] = seed
        return scene, seed


class _Vary:
    """Keys that are given one drawn value."""

    def __init__(self, table: Any, where: str, scene: dict[str, Any]) -> None:
        keys = table.get("key") if isinstance(table, Mapping) else None
        self.keys: list[str] = [keys] if isinstance(keys, str) else list(keys or ())
        if not self.keys or not all(isinstance(key, str) for key in self.keys):
            raise RecipeError('a key of the scene is wanted, such as key = "block.0.max"', where)
        distribution = Distribution.parse({k: v for k, v in table.items() if k not in ("key", "step")}, where)
        if distribution is None:
            raise RecipeError("a distribution is wanted", where, "such as uniform = [0.5, 1.5]")
        self.distribution = distribution
        self.step = float(table.get("step", 0.0))
        self.where = where
        for key in self.keys:
            assign(copy.deepcopy(scene), key, 0, f"{where}.key")

    def set(self, scene: dict[str, Any], random: np.random.Generator) -> None:
        value = _stepped(self.distribution.draw(random), self.step)
        for key in self.keys:
            assign(scene, key, copy.deepcopy(value), self.where)


def _stepped(value: Any, step: float) -> Any:
    """The nearest multiple of a step: of the spacing, so that blocks touch."""
    if step <= 0.0 or isinstance(value, str):
        return value
    return [_stepped(part, step) for part in value] if isinstance(value, list) else round(value / step) * step


def _scatter(table: Any, where: str) -> _Scatter:
    if not isinstance(table, Mapping):
        raise RecipeError("a table is wanted", where)
    known(table, ("table", "count", "apart", "values", "either"), where)
    if table.get("table") not in TABLES:
        raise RecipeError(f"a table of {', '.join(TABLES)} is wanted, not {table.get('table')!r}", f"{where}.table")
    count = Distribution.parse(table.get("count", 1), f"{where}.count")
    either = [_values(entry, f"{where}.either[{number}]") for number, entry in enumerate(table.get("either", [{}]))]
    values = _values(table.get("values", {}), f"{where}.values")
    return _Scatter(table["table"], count or int(table.get("count", 1)), float(table.get("apart", 0.0)), values, either)


def _values(table: Any, where: str) -> dict[str, Any]:
    if not isinstance(table, Mapping):
        raise RecipeError("a table of values and distributions is wanted", where)
    return {key: Distribution.parse(value, f"{where}.{key}") or value for key, value in table.items()}


class _Scatter:
    """Several of one table, at places apart from each other."""

    def __init__(
        self, table: str, count: Distribution | int, apart: float, values: dict[str, Any], either: list[dict[str, Any]]
    ) -> None:
        self.table = table
        self.count = count
        self.apart = apart
        self.values = values
        self.either = either

    def place(
        self, scene: dict[str, Any], random: np.random.Generator, placed: list[tuple[list[float], float, float]]
    ) -> None:
        count = self.count if isinstance(self.count, int) else int(self.count.draw(random))
        for _ in range(count):
            choice = self.either[int(random.integers(len(self.either)))]
            for _ in range(TRIES):
                drawn = {key: _draw(value, random) for key, value in {**self.values, **choice}.items()}
                middle, radius = _circle(drawn)
                if all(math.dist(middle, other) >= radius + size + max(self.apart, gap) for other, size, gap in placed):
                    break
            else:
                raise Crowded(f"no room for {count} tables [[{self.table}]]")
            placed.append((middle, radius, self.apart))
            scene.setdefault(self.table, []).append(_entry(self.table, drawn, len(scene.get(self.table, []))))


def _draw(value: Any, random: np.random.Generator) -> Any:
    return value.draw(random) if isinstance(value, Distribution) else copy.deepcopy(value)


def _middle(drawn: Mapping[str, Any]) -> list[float]:
    place = drawn.get("position", drawn.get("center", drawn.get("min", [0.0, 0.0])))
    return [float(place[0]), float(place[1])]


def _circle(drawn: Mapping[str, Any]) -> tuple[list[float], float]:
    """A circle that holds it."""
    if "radius" in drawn:
        return _middle(drawn), float(drawn["radius"])
    if "size" in drawn:
        return _middle(drawn), 0.5 * math.hypot(*drawn["size"])
    corners = drawn.get("outline", [[0.0, 0.0]])
    return _middle(drawn), max(math.hypot(*corner) for corner in corners)


def _entry(table: str, drawn: dict[str, Any], number: int) -> dict[str, Any]:
    """The table of the scene: a block or obstacle may be given by its middle and size."""
    if table in ("block", "obstacle") and "size" in drawn:
        (x, y), (width, height) = _middle(drawn), drawn.pop("size")
        drawn.pop("position", None)
        drawn.pop("center", None)
        drawn["min"], drawn["max"] = [x - width / 2, y - height / 2], [x + width / 2, y + height / 2]
    if table == "body":
        drawn.setdefault("name", f"body {number}")
    if table == "disc" and "position" in drawn:
        drawn["center"] = drawn.pop("position")
    return drawn
