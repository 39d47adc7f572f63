"""A small recipe of a data set, and what tests of data sets share."""

from __future__ import annotations

import copy
import filecmp
from pathlib import Path
from typing import Any

from conftest import ROOT

from unipbd import datasets

RECIPES = sorted((ROOT / "recipes").glob("*.toml"))
POOL: dict[str, Any] = {
    "name": "2D_POOL",
    "trajectories": 6,
    "frames": 9,
    "formats": ["lagrangebench", "gns", "npz"],
    "vary": [{"key": "block.0.max.1", "uniform": [0.4, 0.9]}],
    "scatter": [{"table": "body", "count": {"integers": [0, 2]}, "apart": 0.1, "values": {
        "position": {"uniform": [[0.4, 1.2], [1.6, 1.6]]}, "radius": 0.15, "density": {"choice": [300.0, 2000.0]}}}],
    "scene": {
        "spacing": 0.1, "fps": 60.0,
        "liquid": [{"name": "water"}],
        "block": [{"material": "water", "min": [0.0, 0.0], "max": [1.0, 0.5]}],
        "tank": [{"min": [0.0, 0.0], "max": [2.0, 2.0]}],
    },
}


def small(**values: Any) -> datasets.Recipe:
    return datasets.Recipe.from_dict({**copy.deepcopy(POOL), **values})


def lagrangebench(folder: Path) -> Path:
    return next(folder.glob("2D_*"))


def same(one: Path, other: Path) -> None:
    names = sorted(path.relative_to(one) for path in one.rglob("*") if path.is_file())
    assert names == sorted(path.relative_to(other) for path in other.rglob("*") if path.is_file())
    wrong = [str(name) for name in names if not filecmp.cmp(one / name, other / name, shallow=False)]
    assert not wrong, wrong
