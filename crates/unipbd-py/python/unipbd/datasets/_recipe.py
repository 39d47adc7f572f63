"""Recipes of data sets: read and checked."""

from __future__ import annotations

import copy
import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .._arrays import plain
from .._paths import load
from .._scene_table import read_scene
from .._toml import RecipeError, known
from ._fields import check_force, check_start

FORMATS = ("lagrangebench", "gns", "npz")
SPLITS = ("train", "valid", "test")
_KEYS = (
    "name description scene trajectories frames stride warm_up seed formats cut attempts splits vary scatter start "
    "force walls filter types metadata"
).split()
_WALLS = {"layers": 1, "reach": 1.0, "wrap": False}
_FILTER: dict[str, Any] = {
    "warnings": True, "ignore": [], "compression": None, "speed": None, "energy_growth": None, "contained": True}


@dataclass(frozen=True)
class Recipe:
    """What a data set is made of. Read one with `load`; `changed` gives one with other values.

    Attributes:
        name: begins the name of the LagrangeBench folder, such as ``2D_DAM``.
        scene: the scene as a dict, before anything is drawn.
        trajectories: how many; with ``cut = "frames"`` each is cut into the splits.
        frames: stored steps of a trajectory: it has one frame more.
        stride: frames of the scene per stored frame.
        warm_up: time before the first stored frame [s].
        seed: of everything that is drawn.
        formats: of ``lagrangebench``, ``gns`` and ``npz``.
        cut: ``"trajectories"`` share them out among the splits, ``"frames"`` cuts each in time.
        attempts: most draws for one trajectory.
        splits: parts of train, valid and test.
        vary, scatter: what is drawn.
        start, force: a field of velocities at the start and a force, by name, or None.
        walls: how walls are sampled. filter: what is refused and drawn again.
        types: particle types by material, for each format. metadata: replaces what is written there.
    """

    name: str
    scene: dict[str, Any]
    trajectories: int = 10
    frames: int = 100
    stride: int = 1
    warm_up: float = 0.0
    seed: int = 0
    formats: tuple[str, ...] = ("lagrangebench",)
    cut: str = "trajectories"
    attempts: int = 20
    splits: dict[str, float] = field(default_factory=lambda: {"train": 2.0, "valid": 1.0, "test": 1.0})
    vary: tuple[dict[str, Any], ...] = ()
    scatter: tuple[dict[str, Any], ...] = ()
    start: dict[str, Any] | None = None
    force: dict[str, Any] | None = None
    walls: dict[str, Any] = field(default_factory=lambda: dict(_WALLS))
    filter: dict[str, Any] = field(default_factory=lambda: dict(_FILTER))
    types: dict[str, dict[str, int]] = field(default_factory=dict)
    metadata: dict[str, Any] = field(default_factory=dict)
    description: str = ""

    @classmethod
    def load(cls, path: str | os.PathLike[str], changes: Mapping[str, Any] | None = None) -> Recipe:
        """Reads a recipe file; `changes` replace values by their paths. Raises `RecipeError` with the line,
        `SceneError` for its scene, or `OSError`."""
        return load(path, changes, cls.from_dict)

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any], folder: str | os.PathLike[str] = ".") -> Recipe:
        """A recipe from nested dicts; a scene that is a path is looked for in `folder`."""
        data = plain(copy.deepcopy(dict(tables)))
        known(data, _KEYS)
        data["scene"] = read_scene(data.get("scene"), Path(folder))
        data.setdefault("name", data["scene"].get("name") or "data set")
        for key in ("formats", "vary", "scatter"):
            if key in data:
                data[key] = tuple(data[key] if isinstance(data[key], list) else [data[key]])
        for key, defaults in (("walls", _WALLS), ("filter", _FILTER)):
            given = data.get(key, {})
            known(given, defaults, key)
            data[key] = {**defaults, **given}
        recipe = cls(**data)
        recipe._check()
        return recipe

    def changed(self, **values: Any) -> Recipe:
        """The same with other values, such as ``trajectories=4``."""
        return Recipe.from_dict({**self.to_dict(), **values})

    def to_dict(self) -> dict[str, Any]:
        """A copy as nested dicts and lists, as in its file."""
        data = copy.deepcopy(dict(self.__dict__))
        left_out = {key: value for key, value in data.items() if value is not None}
        left_out["filter"] = {key: value for key, value in self.filter.items() if value is not None}
        return {key: list(value) if isinstance(value, tuple) else value for key, value in left_out.items()}

    def digest(self) -> str:
        """A hash of everything that decides the trajectories and their files."""
        text = json.dumps(self.to_dict(), sort_keys=True)
        return hashlib.sha256(text.encode("utf-8")).hexdigest()

    def shares(self, total: int) -> dict[str, int]:
        """How many of this many trajectories, or steps, each split has: every part above 0 has one."""
        parts = {split: float(self.splits.get(split, 0.0)) for split in SPLITS}
        whole = sum(parts.values())
        counts = {split: max(1, round(total * part / whole)) if part else 0 for split, part in parts.items()}
        counts["train"] = max(0, total - counts["valid"] - counts["test"])
        return counts

    def split_of(self, index: int) -> str:
        """The split that a trajectory goes to, with ``cut = "trajectories"``."""
        counts, first = self.shares(self.trajectories), 0
        for split in SPLITS:
            first += counts[split]
            if index < first:
                return split
        return SPLITS[-1]

    def _check(self) -> None:
        for key in ("trajectories", "frames", "stride", "attempts", "seed"):
            low = 0 if key == "seed" else 1
            _whole(getattr(self, key), low, key)
        if not isinstance(self.warm_up, (int, float)) or self.warm_up < 0.0:
            raise RecipeError(f"a time of 0 or more is wanted, not {self.warm_up!r}", "warm_up")
        _words(self.formats, FORMATS, "formats")
        _words((self.cut,), ("trajectories", "frames"), "cut")
        _splits(self)
        _whole(self.walls["layers"], 0, "walls.layers")
        known(self.types, FORMATS[:2], "types")
        check_start(self.start)
        check_force(self.force)
        _drawn(self)


def _whole(value: Any, low: int, key: str) -> None:
    if not isinstance(value, int) or isinstance(value, bool) or value < low:
        raise RecipeError(f"a whole number from {low} on is wanted, not {value!r}", key)


def _words(values: Sequence[Any], words: Sequence[str], key: str) -> None:
    for value in values:
        if value not in words:
            raise RecipeError(f"{value!r} is not known here", key, f"there are {', '.join(words)}")


def _splits(recipe: Recipe) -> None:
    known(recipe.splits, SPLITS, "splits")
    if any(not isinstance(part, (int, float)) or part < 0 for part in recipe.splits.values()):
        raise RecipeError("parts of 0 or more are wanted", "splits")
    wanted = sum(1 for part in recipe.splits.values() if part)
    if not wanted:
        raise RecipeError("a part above 0 is wanted", "splits")
    total = recipe.trajectories if recipe.cut == "trajectories" else recipe.frames
    if total < wanted:
        raise RecipeError(f"{total} {recipe.cut} cannot be shared out among {wanted} splits", "splits")


def _drawn(recipe: Recipe) -> None:
    """Reads all that is drawn once, so that mistakes show before the first run."""
    from ._draw import Drawer

    Drawer(recipe)
