"""Reading data sets back: any of the formats."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .._errors import UnipbdError
from ._lagrangebench import h5py
from ._recipe import SPLITS
from ._tfrecord import parse_sequence_example, read_records

SUFFIXES = (".h5", ".tfrecord", ".npz")


def folders(place: Path) -> list[Path]:
    """Folders of formats in a folder of `generate`, or the folder itself where it is one."""
    if (place / "metadata.json").exists():
        return [place]
    found = sorted(path.parent for path in place.glob("*/metadata.json"))
    if not found:
        raise UnipbdError(f"{place} holds no data set: no metadata.json is in it, nor in a folder of it")
    return found


def metadata(folder: Path) -> dict[str, Any]:
    """metadata.json of a format."""
    found: dict[str, Any] = json.loads((folder / "metadata.json").read_text(encoding="utf-8"))
    return found


def trajectories(folder: Path, split: str) -> Iterator[tuple[Any, npt.NDArray[np.int64]]]:
    """Positions (T, N, 2) and particle types (N,) of each trajectory of a split. Positions of HDF5 are read from the
    file as they are asked for."""
    for suffix in SUFFIXES:
        path = folder / f"{split}{suffix}"
        if path.exists():
            yield from _READERS[suffix](path)
            return
    raise UnipbdError(f"{folder} has no {split} of {', '.join(SUFFIXES)}")


def all_trajectories(folder: Path) -> Iterator[tuple[Any, npt.NDArray[np.int64]]]:
    """Those of all splits."""
    for split in SPLITS:
        yield from trajectories(folder, split)


def _read_h5(path: Path) -> Iterator[tuple[Any, npt.NDArray[np.int64]]]:
    with h5py().File(path, "r") as file:
        for key in file:
            yield file[key]["position"], file[key]["particle_type"][:]


def _read_tfrecord(path: Path) -> Iterator[tuple[Any, npt.NDArray[np.int64]]]:
    for record in read_records(path):
        _, types, positions = parse_sequence_example(record)
        yield positions, types


def _read_npz(path: Path) -> Iterator[tuple[Any, npt.NDArray[np.int64]]]:
    # Objects are pickled: read only what was written here.
    with np.load(path, allow_pickle=True) as file:
        for key in file:
            positions, types = file[key]
            yield positions, types


_READERS = {".h5": _read_h5, ".tfrecord": _read_tfrecord, ".npz": _read_npz}
