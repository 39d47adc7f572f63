"""The few fields that a recipe can name: velocities of the start, and forces that gravity cannot be."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from .._simulation import Simulation
from .._substep import Substep
from .._toml import RecipeError, known

STARTS = {"taylor_green": ("speed", "wavelength"), "modes": ("speed", "count", "box")}
FORCES = {"reverse": ("acceleration", "height"), "sway": ("acceleration", "period")}

Points = npt.NDArray[np.float64]


def check_start(table: Mapping[str, Any] | None) -> None:
    """Refuses a ``[start]`` that is not known."""
    _check(table, STARTS, "start")


def check_force(table: Mapping[str, Any] | None) -> None:
    """Refuses a ``[force]`` that is not known."""
    _check(table, FORCES, "force")


def _check(table: Mapping[str, Any] | None, kinds: Mapping[str, tuple[str, ...]], where: str) -> None:
    if table is None:
        return
    if not isinstance(table, Mapping) or table.get("kind") not in kinds:
        kind = table.get("kind") if isinstance(table, Mapping) else table
        raise RecipeError(f"there is no field {kind!r}", f"{where}.kind", f"there are {', '.join(kinds)}")
    known(table, ("kind", *kinds[table["kind"]]), where)


def stir(sim: Simulation, table: Mapping[str, Any] | None, seed: int) -> None:
    """Gives all fluid the velocities that a ``[start]`` names. At scattered points the field does not sum to
    zero: what is left would be a drift, and is taken away.

    - ``taylor_green``: vortices, u = -U cos(kx) sin(ky), v = U sin(kx) cos(ky), k = 2 pi / wavelength (1 m).
    - ``modes``: a few random divergence-free waves in a box [width, height], of this largest speed.
    """
    if table is None:
        return
    speed = float(table.get("speed", 1.0))
    x = sim.positions.astype(np.float64)
    if table["kind"] == "taylor_green":
        k = 2.0 * np.pi / float(table.get("wavelength", 1.0))
        cos, sin = np.cos(k * x), np.sin(k * x)
        field = speed * np.stack([-cos[:, 0] * sin[:, 1], sin[:, 0] * cos[:, 1]], axis=1)
    else:
        field = _modes(x, speed, int(table.get("count", 4)), table.get("box", [1.0, 1.0]), seed)
    fluid = sim.phases <= 1
    field -= field[fluid].mean(axis=0)
    with sim.edit() as edit:
        edit.velocities[fluid] = field[fluid]


def _modes(x: Points, speed: float, count: int, box: Any, seed: int) -> Points:
    """Curl of a random stream function."""
    random = np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, 1])))
    field = np.zeros_like(x)
    for _ in range(count):
        wave = 2.0 * np.pi * random.integers(1, 4, 2) * random.choice([-1, 1], 2) / np.asarray(box, dtype=np.float64)
        phase = random.uniform(0.0, 2.0 * np.pi)
        slope = np.cos(x @ wave + phase)
        field += slope[:, None] * np.array([wave[1], -wave[0]]) / np.linalg.norm(wave)
    largest = np.linalg.norm(field, axis=1).max(initial=0.0)
    return field * (speed / largest) if largest > 0.0 else field


def force(table: Mapping[str, Any] | None) -> Callable[[Substep], object] | None:
    """The hook of a ``[force]``.

    - ``reverse``: an acceleration below the `height`, and its opposite above, their mean taken off: reverse Poiseuille
      flow.
    - ``sway``: an acceleration that swings with this period [s].
    """
    if table is None:
        return None
    acceleration = np.asarray(table.get("acceleration", [1.0, 0.0]), dtype=np.float64)
    if table["kind"] == "sway":
        period = float(table.get("period", 1.0))
        return lambda substep: substep.add_acceleration(np.sin(2.0 * np.pi * substep.time / period) * acceleration)
    height = float(table.get("height", 1.0))

    def push(substep: Substep) -> None:
        side = np.where(substep.positions[:, 1] > height, -1.0, 1.0)
        # A few particles more on one side would push all of them.
        substep.add_acceleration((side - side.mean())[:, None] * acceleration)

    return push
