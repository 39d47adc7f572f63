"""TOML files of recipes and sweeps, with the line of what is wrong."""

from __future__ import annotations

import difflib
import os
import re
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ._errors import UnipbdError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

_HEADER = re.compile(r"^\s*\[(\[)?\s*([^\[\]]+?)\s*\]")
_KEY = re.compile(r"^\s*([A-Za-z0-9_.\"-]+?)\s*=")


class RecipeError(UnipbdError, ValueError):
    """A recipe or sweep that cannot be used.

    Attributes:
        file: the file, "" for a description that has none.
        key: where it is, such as ``vary[1].uniform``.
        hint: what to do about it.
        line: line in the file, from 1; None where it is not known.
    """

    def __init__(
        self, message: str = "", key: str = "", hint: str | None = None, file: str = "", line: int | None = None
    ) -> None:
        super().__init__(message, key=key, hint=hint, file=file, line=line)
        self.key = key
        self.hint = hint
        self.file = file
        self.line = line

    def __str__(self) -> str:
        place = f"{self.file or 'recipe'}:{self.line}: " if self.line else f"{self.file}: " if self.file else ""
        where = f"{self.key}: " if self.key else ""
        return f"{place}{where}{self.message}" + (f" ({self.hint})" if self.hint else "")

    def placed(self, file: str, text: str) -> RecipeError:
        """The same error with file and line."""
        return RecipeError(self.message, self.key, self.hint, file, line_of(text, self.key))


def read(path: str | os.PathLike[str]) -> tuple[dict[str, Any], str]:
    """The tables of a TOML file, and its text."""
    text = Path(path).read_text(encoding="utf-8")
    try:
        return tomllib.loads(text), text
    except tomllib.TOMLDecodeError as error:
        found = re.search(r"line (\d+)", str(error))
        line = int(found[1]) if found else None
        raise RecipeError(f"this is no TOML: {error}", file=os.fspath(path), line=line) from None


def value(text: str) -> Any:
    """The value of a `--set` on the command line: TOML, or else a string."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def line_of(text: str, key: str) -> int | None:
    """The line of a key such as ``vary[1].uniform``: of the nearest part of it that is written."""
    wanted = key.split(".")
    best, line = 0, None
    table: list[str] = []
    counts: dict[str, int] = {}
    for number, written in enumerate(text.splitlines(), 1):
        header = _HEADER.match(written)
        assignment = _KEY.match(written)
        if header:
            table = _numbered(header[2].split("."), bool(header[1]), counts)
            place = table
        elif assignment:
            place = table + assignment[1].replace('"', "").split(".")
        else:
            continue
        same = len(place) if place == wanted[: len(place)] else 0
        if same > best:
            best, line = same, number
    return line


def _numbered(names: list[str], array: bool, counts: dict[str, int]) -> list[str]:
    """The path of a header, with the numbers of the arrays of tables in it."""
    path: list[str] = []
    for depth, name in enumerate(names):
        plain = ".".join([*path, name])
        if array and depth == len(names) - 1:
            counts[plain] = counts.get(plain, -1) + 1
        path.append(f"{name}[{counts[plain]}]" if plain in counts else name)
    return path


def known(table: Mapping[str, Any], keys: Iterable[str], where: str = "") -> None:
    """Refuses keys that are none of these."""
    keys = list(keys)
    for key in table:
        if key not in keys:
            near = difflib.get_close_matches(key, keys, 1)
            hint = f"did you mean {near[0]!r}?" if near else f"the keys are {', '.join(keys)}"
            raise RecipeError(f"there is no key {key!r} here", f"{where}.{key}" if where else key, hint)
