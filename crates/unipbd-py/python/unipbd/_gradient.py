"""Derivatives of what a run leads to, by differences over a batch."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ._arrays import Doubles
from ._batch import Batch
from ._paths import assign, look_up
from ._scene import Scene
from ._simulation import Simulation

logger = logging.getLogger("unipbd")

SIZES = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
"""Steps that are tried, over the size of a parameter."""


@dataclass(frozen=True)
class Gradient:
    """What `gradient` found.

    Attributes:
        value: the loss of the scene itself: a number, or an array where the loss is one.
        derivatives: by parameter, each of the shape of the loss.
        steps: the step taken for each parameter.
        usable: the smallest and largest step between which differences agree; None where no three steps in a row do:
            the run is too chaotic, or too long, for its derivative to mean anything.
        tried: all steps and their derivatives, by parameter.
        substeps: substeps per frame, fixed for all runs.
        runs: how many worlds were run.
    """

    value: Any
    derivatives: dict[str, Any]
    steps: dict[str, float]
    usable: dict[str, tuple[float, float] | None]
    tried: dict[str, list[tuple[float, Any]]]
    substeps: int
    runs: int

    @property
    def trusted(self) -> bool:
        """Whether every parameter has a range of steps that agree, or its step was given."""
        return all(name not in self.usable or self.usable[name] is not None for name in self.derivatives)

    def jacobian(self) -> Doubles:
        """Derivatives side by side, shape (size of the loss, parameters)."""
        return np.stack([np.ravel(np.asarray(one, dtype=np.float64)) for one in self.derivatives.values()], axis=1)


def gradient(
    loss: Callable[[Any], Any],
    scene: Scene,
    parameters: Mapping[str, float] | Iterable[str],
    frames: int = 60,
    watch: Callable[[Simulation], Any] | None = None,
    steps: Mapping[str, float] | None = None,
    scales: Mapping[str, float] | None = None,
    tolerance: float = 0.05,
    method: str = "central",
    seed: int | None = None,
    threads: int | None = None,
) -> Gradient:
    """The derivative of a loss by parameters of a scene, by differences of runs side by side in a `Batch`.

        found = up.gradient(lambda sim: sim.positions[:, 0].max(), scene, ["gravity.1"], frames=30)
        found.derivatives["gravity.1"], found.usable["gravity.1"]

    `loss` is called with each `Simulation` after these frames and returns a number or an array. With `watch`, which is
    called at the start and after every frame, it is called with the list of what that returned instead. `parameters`
    are paths of keys (values are those of the scene) or a mapping from path to value.

    All runs have one seed and one number of substeps: that of the scene, or where it is ``"auto"`` the most that a run of
    the scene takes. No noise of sampling is left; rounding and rebuilt neighbour lists are, and grow with time as the
    flow is chaotic. So several steps are tried (`tried`), the range in which neighbouring ones agree to `tolerance` is
    `usable`, and its middle is taken. `steps` from an earlier call spares the search.

    Cost: 2 P + 1 runs for P parameters with `steps` (P + 1 with ``method="forward"``, less exact), 14 P + 1 without.
    `scales` is the size of parameters whose value is 0.
    """
    if method not in ("central", "forward"):
        raise ValueError(f"method is 'central' or 'forward', not {method!r}")
    values = _values(scene, parameters)
    base, substeps = _fixed(scene, values, frames, seed)
    tried = {name: _steps_of(name, value, steps, scales) for name, value in values.items()}
    runs: list[Scene] = [base]
    for name, sizes in tried.items():
        for size in sizes:
            runs.append(_changed(base, name, values[name] + size))
            if method == "central":
                runs.append(_changed(base, name, values[name] - size))
    losses = _run(loss, runs, frames, watch, seed, threads)
    value, rest = losses[0], iter(losses[1:])
    found: dict[str, list[tuple[float, Any]]] = {}
    for name, sizes in tried.items():
        found[name] = []
        for size in sizes:
            upper = next(rest)
            lower, width = (next(rest), 2.0 * size) if method == "central" else (value, size)
            found[name].append((size, (upper - lower) / width))
    return _judged(value, found, steps or {}, tolerance, substeps, len(runs))


def _values(scene: Scene, parameters: Mapping[str, float] | Iterable[str]) -> dict[str, float]:
    if isinstance(parameters, Mapping):
        return {name: float(value) for name, value in parameters.items()}
    if isinstance(parameters, str):
        parameters = [parameters]
    values = {}
    for name in parameters:
        value = look_up(scene.to_dict(), name)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise ValueError(f"{name} is no number but {value!r}: name one of its entries, such as {name}.0")
        values[name] = float(value)
    return values


def _changed(scene: Scene, name: str, value: float) -> Scene:
    data = scene.to_dict()
    assign(data, name, value, name)
    return Scene.from_dict(data)


def _fixed(scene: Scene, values: Mapping[str, float], frames: int, seed: int | None) -> tuple[Scene, int]:
    """The scene with its parameters, one number of substeps, and the pressure grid on or off as it is now: what goes by
    itself would jump from one value of a parameter to the next."""
    for name, value in values.items():
        scene = _changed(scene, name, value)
    scene = scene.copy()
    sim, wanted = scene.build(seed=seed, threads=1), scene.solver.substeps
    if wanted == "auto":
        wanted = 1
        for _ in range(frames):
            before = sim.substeps
            sim.step()
            wanted = max(wanted, sim.substeps - before)
    scene.solver.pressure_grid = "on" if "pressure_grid" in sim.stages else "off"
    scene.solver.substeps = int(wanted)
    return scene, int(wanted)


def _steps_of(
    name: str, value: float, steps: Mapping[str, float] | None, scales: Mapping[str, float] | None
) -> Sequence[float]:
    if steps is not None and name in steps:
        return [float(steps[name])]
    scale = float((scales or {}).get(name, abs(value)))
    if scale <= 0.0:
        raise ValueError(f"{name} is 0: give its size, such as scales={{{name!r}: 0.1}}")
    return [size * scale for size in SIZES]


def _run(
    loss: Callable[[Any], Any],
    scenes: list[Scene],
    frames: int,
    watch: Callable[[Simulation], Any] | None,
    seed: int | None,
    threads: int | None,
) -> list[Any]:
    """The loss of every scene."""
    batch = Batch(scenes, seeds=[scenes[0].seed if seed is None else seed] * len(scenes), threads=threads)
    if watch is None:
        batch.step(frames)
        return [_number(loss(world)) for world in batch]
    seen = [[watch(world)] for world in batch]
    for _ in range(frames):
        batch.step()
        for world, kept in zip(batch, seen, strict=True):
            kept.append(watch(world))
    return [_number(loss(kept)) for kept in seen]


def _number(value: Any) -> Any:
    array: npt.NDArray[np.float64] = np.asarray(value, dtype=np.float64)
    return float(array) if array.ndim == 0 else array.copy()


def _judged(
    value: Any, found: dict[str, list[tuple[float, Any]]], steps: Mapping[str, float], tolerance: float, substeps: int,
    runs: int,
) -> Gradient:
    derivatives: dict[str, Any] = {}
    taken: dict[str, float] = {}
    usable: dict[str, tuple[float, float] | None] = {}
    for name, tried in found.items():
        if name in steps:
            taken[name], derivatives[name] = tried[0]
            continue
        first, last = _agreeing([derivative for _, derivative in tried], tolerance)
        trusted = last - first >= 2
        usable[name] = (tried[last][0], tried[first][0]) if trusted else None
        taken[name], derivatives[name] = tried[(first + last) // 2]
        if not trusted:
            logger.warning("the derivative by %s depends on the step: no three steps agree to %g", name, tolerance)
    return Gradient(value, derivatives, taken, usable, found, substeps, runs)


def _agreeing(derivatives: list[Any], tolerance: float) -> tuple[int, int]:
    """The longest row of derivatives of which each agrees with the next, first and last; without any the two that
    differ least."""
    apart = [_apart(one, other) for one, other in zip(derivatives[:-1], derivatives[1:], strict=True)]
    best, first = (0, 0), 0
    for number in range(len(derivatives)):
        if number and apart[number - 1] > tolerance:
            first = number
        if number - first > best[1] - best[0]:
            best = (first, number)
    if best == (0, 0):
        least = int(np.argmin(apart))
        return least, least + 1
    return best


def _apart(one: Any, other: Any) -> float:
    size = max(float(np.linalg.norm(one)), float(np.linalg.norm(other)))
    return float(np.linalg.norm(np.asarray(one) - np.asarray(other))) / size if size > 0.0 else 0.0
