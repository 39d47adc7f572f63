"""The layouts of the graph network simulators: TFRecord files (DeepMind) and npz files (geoelements/gns)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from ._parts import Parts
from ._recipe import SPLITS
from ._statistics import periodic_box, statistics
from ._tfrecord import sequence_example, write_record

BOUNDARY = 3
"""The type of what does not move by itself."""


def write_tfrecords(parts: Parts, folder: Path) -> Path:
    """Writes train, valid and test.tfrecord and metadata.json into `folder`/gns."""
    place = folder / "gns"
    place.mkdir(parents=True, exist_ok=True)
    for split in SPLITS:
        with open(place / f"{split}.tfrecord", "wb") as file:
            for number, piece in enumerate(parts.split(split)):
                write_record(file, sequence_example(number, piece.types["gns"], piece.positions))
    return _write_metadata(parts, place)


def write_npz(parts: Parts, folder: Path) -> Path:
    """Writes train, valid and test.npz and metadata.json into `folder`/npz: each trajectory an array of two objects,
    positions (T, N, 2) and particle types (N,)."""
    place = folder / "npz"
    place.mkdir(parents=True, exist_ok=True)
    for split in SPLITS:
        entries: dict[str, Any] = {}
        for number, piece in enumerate(parts.split(split)):
            pair = np.empty(2, dtype=object)
            pair[0], pair[1] = np.array(piece.positions), piece.types["gns"]
            entries[f"simulation_trajectory_{number}"] = pair
        np.savez_compressed(place / f"{split}.npz", **entries)
    return _write_metadata(parts, place)


def metadata(parts: Parts) -> dict[str, Any]:
    """What metadata.json holds: statistics of all that is no boundary."""
    dx = float(parts.records[0]["scene"]["spacing"])
    found: dict[str, Any] = {
        "bounds": parts.bounds,
        "periodic_boundary_conditions": parts.periodic,
        # There is one frame more than this, for the first displacement.
        "sequence_length": parts.frames_of("train")[1] - 1,
        "default_connectivity_radius": float(f"{1.45 * dx:.2g}"),
        "dim": 2,
        "dt": parts.frame_time,
    }
    found.update({key: value for key, value in parts.recipe.metadata.items() if key in found})
    moving = ((piece.positions, piece.types["gns"] != BOUNDARY) for piece in parts.all())
    found.update(statistics(moving, periodic_box(found)))
    return found


def _write_metadata(parts: Parts, place: Path) -> Path:
    (place / "metadata.json").write_text(json.dumps(metadata(parts), indent=1), encoding="utf-8")
    return place
