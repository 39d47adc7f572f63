"""Keys of a scene by their paths, as `--set` of the command line names them."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from ._toml import RecipeError, read

T = TypeVar("T")


def split(path: str) -> list[str]:
    """``block[0].max`` and ``block.0.max`` as their parts."""
    return [part for part in re.sub(r"\[(\d+)\]", r".\1", path).split(".") if part]


def assign(scene: dict[str, Any], path: str, value: Any, where: str = "") -> None:
    """Sets a key of a description: a table of an array is named by its number or its ``name``; the number of an
    entry sets that entry alone, as in ``block.0.max.1``."""
    *parts, last = split(path) or [""]
    place: Any = scene
    for part in parts:
        place = _step(place, part, path, where)
    if isinstance(place, dict) and last:
        place[last] = value
    elif isinstance(place, list) and last.isdigit() and int(last) < len(place):
        place[int(last)] = value
    else:
        raise RecipeError(f"the scene has no {path!r}", where, _there(place))


def look_up(scene: dict[str, Any], path: str) -> Any:
    """The value of a key; raises `RecipeError` where there is none."""
    place: Any = scene
    for part in split(path):
        place = _step(place, part, path, "", make=False)
    return place


def _step(place: Any, part: str, path: str, where: str, make: bool = True) -> Any:
    if isinstance(place, dict):
        if part in place:
            return place[part]
        if make and part in ("solver", "domain", "view", "environment", "contacts", "expect", "legacy", "motion"):
            return place.setdefault(part, {})
    if isinstance(place, list):
        if part.isdigit() and int(part) < len(place):
            return place[int(part)]
        for entry in place:
            if isinstance(entry, dict) and entry.get("name") == part:
                return entry
    raise RecipeError(f"the scene has no {path!r}: it ends before {part!r}", where, _there(place))


def _there(place: Any) -> str:
    if isinstance(place, list):
        names = [str(entry.get("name")) for entry in place if isinstance(entry, dict) and entry.get("name")]
        return f"there are {len(place)} entries, numbered from 0" + (f", named {', '.join(names)}" if names else "")
    if isinstance(place, dict):
        return f"there are {', '.join(key for key in place)}"
    return "it is no table"


def load(
    path: str | os.PathLike[str],
    changes: Mapping[str, Any] | None,
    make: Callable[[dict[str, Any], Path], T],
) -> T:
    """What `make` makes of a file and its folder; `changes` replace values by their paths before. Raises `RecipeError`
    with the line, or `OSError`."""
    tables, text = read(path)
    try:
        for key, value in (changes or {}).items():
            assign(tables, key, value, key)
        return make(tables, Path(path).parent)
    except RecipeError as error:
        raise error.placed(os.fspath(path), text) from None
