"""Array-like arguments, checked."""

from __future__ import annotations

from typing import Any, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

Floats: TypeAlias = npt.NDArray[np.float32]
Doubles: TypeAlias = npt.NDArray[np.float64]
Ids: TypeAlias = npt.NDArray[np.uint32]
Array = TypeVar("Array", bound=npt.NDArray[Any])


def fixed(array: Array) -> Array:
    """The array, no longer to be written to: a write into a copy must not look as if it changed the run."""
    array.flags.writeable = False
    return array


def numbers(values: npt.ArrayLike, what: str, error: type[Exception]) -> Doubles:
    """Real numbers as doubles."""
    try:
        array = np.asarray(values)
    except ValueError as cause:
        raise error(f"{what} is no array: {cause}") from None
    if array.size == 0:
        return np.empty(array.shape)
    if array.dtype.kind not in "fiu":
        raise error(f"{what} must be real numbers, not {array.dtype}")
    return np.ascontiguousarray(array, dtype=np.float64)


def points(values: npt.ArrayLike, what: str, error: type[Exception]) -> Doubles:
    """Points or vectors as an (N, 2) array of doubles."""
    array = numbers(values, what, error)
    if array.size == 0:
        return np.empty((0, 2))
    if array.ndim != 2 or array.shape[1] != 2:
        raise error(f"{what} must have shape (N, 2), not {array.shape}")
    return array


def pairs(values: npt.ArrayLike, count: int, what: str, error: type[Exception]) -> Doubles:
    """One vector for each of `count` particles, or one for all of them."""
    array = numbers(values, what, error)
    try:
        return np.ascontiguousarray(np.broadcast_to(array, (count, 2)))
    except ValueError:
        raise error(f"{what} of shape {array.shape} do not fit {count} particles: ({count}, 2) is wanted") from None


def pair(values: npt.ArrayLike, what: str, error: type[Exception]) -> list[float]:
    """One vector."""
    if isinstance(values, tuple) and len(values) == 2 and all(isinstance(value, float) for value in values):
        return [float(value) for value in values]
    array = numbers(values, what, error)
    if array.shape != (2,):
        raise error(f"{what} must have shape (2,), not {array.shape}")
    return [float(array[0]), float(array[1])]


def plain(value: Any) -> Any:
    """Tuples, arrays and scalars of NumPy as lists and numbers."""
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    if isinstance(value, dict):
        return {key: plain(entry) for key, entry in value.items()}
    return value
