"""Random values of recipes and sweeps: distributions by their quantiles."""

from __future__ import annotations

import math
from collections.abc import Mapping
from statistics import NormalDist
from typing import Any

import numpy as np
import numpy.typing as npt

from ._toml import RecipeError

KINDS = ("uniform", "log_uniform", "normal", "integers", "choice", "polygon")


class Distribution:
    """A distribution of numbers, vectors, words or outlines, as a table with one key::

        { uniform = [0.2, 1.0] }                    # or vectors: [[0, 0], [1, 2]]
        { log_uniform = [1e-4, 1e-2] }
        { normal = [1000.0, 50.0] }                 # mean and standard deviation
        { integers = [1, 4] }                       # both ends are drawn
        { choice = ["left", "right"] }
        { polygon = { corners = [3, 6], radius = [0.1, 0.2], roughness = 0.3 } }

    `dimension` uniform numbers make one value of it, by `at`: random draws and Latin hypercubes share it.
    """

    def __init__(self, kind: str, arguments: Any, where: str = "") -> None:
        self.kind = kind
        self.arguments = arguments
        self.dimension = _check(kind, arguments, f"{where}.{kind}" if where else kind)

    @classmethod
    def parse(cls, table: Any, where: str) -> Distribution | None:
        """The distribution that a table stands for; None for what is a plain value."""
        if not isinstance(table, Mapping) or not any(kind in table for kind in KINDS):
            return None
        if len(table) != 1:
            raise RecipeError(f"one distribution is wanted, not {', '.join(table)}", where)
        kind = next(iter(table))
        return cls(kind, table[kind], where)

    def at(self, units: npt.ArrayLike) -> Any:
        """The value at these quantiles, each from 0 to 1."""
        u = np.clip(np.atleast_1d(np.asarray(units, dtype=np.float64)), 1e-12, 1.0 - 1e-12)
        if self.kind == "choice":
            return self.arguments[int(u[0] * len(self.arguments))]
        if self.kind == "polygon":
            return _polygon(self.arguments, u)
        low, high = self.arguments
        if self.kind == "integers":
            return int(low) + int(u[0] * (int(high) - int(low) + 1))
        if not isinstance(low, (list, tuple)):
            return self._number(float(low), float(high), float(u[0]))
        return [self._number(float(a), float(b), float(part)) for a, b, part in zip(low, high, u, strict=True)]

    def _number(self, low: float, high: float, u: float) -> float:
        if self.kind == "uniform":
            return low + u * (high - low)
        if self.kind == "log_uniform":
            return math.exp(math.log(low) + u * (math.log(high) - math.log(low)))
        return NormalDist(low, high).inv_cdf(u) if high > 0.0 else low

    def draw(self, random: np.random.Generator) -> Any:
        """A random value."""
        return self.at(random.random(self.dimension))


def _check(kind: str, arguments: Any, where: str) -> int:
    """How many quantiles a value takes; raises what is wrong."""
    if kind == "choice":
        if not isinstance(arguments, list) or not arguments:
            raise RecipeError("a list of values to choose from is wanted", where)
        return 1
    if kind == "polygon":
        return _check_polygon(arguments, where)
    if not isinstance(arguments, (list, tuple)) or len(arguments) != 2:
        raise RecipeError(f"two values are wanted, not {arguments!r}", where)
    low, high = arguments
    vector = isinstance(low, (list, tuple))
    if vector != isinstance(high, (list, tuple)) or vector and len(low) != len(high):
        raise RecipeError("both values must be numbers, or vectors of one length", where)
    pairs = list(zip(low, high, strict=True)) if vector else [(low, high)]
    for a, b in pairs:
        if not all(isinstance(number, (int, float)) and math.isfinite(number) for number in (a, b)):
            raise RecipeError(f"numbers are wanted, not {arguments!r}", where)
        if kind == "normal" and b < 0.0:
            raise RecipeError(f"a standard deviation must not be negative: {b}", where)
        if kind != "normal" and a > b:
            raise RecipeError(f"the lower end {a} lies above the upper end {b}", where)
        if kind == "log_uniform" and a <= 0.0:
            raise RecipeError(f"both ends must be above 0, not {a}", where)
    if kind == "integers" and (vector or int(low) != low or int(high) != high):
        raise RecipeError(f"two whole numbers are wanted, not {arguments!r}", where)
    return len(pairs)


def _check_polygon(arguments: Any, where: str) -> int:
    if not isinstance(arguments, Mapping) or set(arguments) - {"corners", "radius", "roughness"}:
        raise RecipeError("a table with corners, radius and roughness is wanted", where)
    corners, radius = arguments.get("corners"), arguments.get("radius")
    for pair, name in ((corners, "corners"), (radius, "radius")):
        if not isinstance(pair, (list, tuple)) or len(pair) != 2 or not 0 < pair[0] <= pair[1]:
            raise RecipeError(f"two values above 0 are wanted, the lower one first, not {pair!r}", f"{where}.{name}")
    if not 0.0 <= float(arguments.get("roughness", 0.0)) <= 0.8:
        raise RecipeError("roughness is a fraction from 0 to 0.8", f"{where}.roughness")
    assert corners is not None
    if corners[0] < 3:
        raise RecipeError("a polygon has three corners or more", f"{where}.corners")
    return 3 + 2 * int(corners[1])


def _polygon(arguments: Mapping[str, Any], u: npt.NDArray[np.float64]) -> list[list[float]]:
    """Corners around a circle, moved along it and inwards by the roughness."""
    few, many = arguments["corners"]
    count = int(few) + int(u[0] * (int(many) - int(few) + 1))
    low, high = arguments["radius"]
    radius = low + u[1] * (high - low)
    rough = float(arguments.get("roughness", 0.0))
    corners = []
    for number in range(count):
        along, inwards = u[3 + 2 * number], u[4 + 2 * number]
        angle = 2.0 * math.pi * (u[2] + (number + 0.5 * rough * (along - 0.5)) / count)
        distance = radius * (1.0 - rough * inwards)
        corners.append([distance * math.cos(angle), distance * math.sin(angle)])
    return corners
