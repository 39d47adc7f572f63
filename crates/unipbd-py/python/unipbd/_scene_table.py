"""Scenes within other descriptions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from . import _native
from ._arrays import plain
from ._errors import SceneError
from ._toml import RecipeError


def read_scene(given: Any, folder: Path) -> dict[str, Any]:
    """The scene of a description as a dict with all its defaults: a table, or the name of a file in the folder."""
    if isinstance(given, str):
        data, _ = _native.load_scene(folder / given)
        return data
    if not isinstance(given, Mapping):
        raise RecipeError("a scene is wanted: a table [scene], or the name of a scene file", "scene")
    try:
        return _native.check_scene(plain(dict(given)))
    except SceneError as error:
        problem = error.problems[0] if error.problems else None
        if problem is None:
            raise
        raise RecipeError(problem.message, f"scene.{problem.key}" if problem.key else "scene", problem.hint) from None
