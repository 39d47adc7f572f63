"""Tables of scene descriptions: attributes by the names of their keys."""

from __future__ import annotations

import copy
import difflib
import json
from collections.abc import Iterator, Mapping, MutableMapping, Sequence
from typing import Any

from . import _native
from ._arrays import plain

_known_schema: dict[str, Any] = {}


def schema() -> dict[str, Any]:
    """The JSON schema of a scene, read when first asked for."""
    if not _known_schema:
        _known_schema.update(json.loads(_native.scene_schema()))
    return _known_schema


def resolve(node: Mapping[str, Any]) -> Mapping[str, Any]:
    """The part of the schema that a reference, or a choice with one table in it, stands for."""
    if "$ref" in node:
        return resolve(schema()["$defs"][node["$ref"].rsplit("/", 1)[1]])
    for choice in node.get("anyOf", node.get("oneOf", node.get("allOf", ()))):
        found = resolve(choice)
        if "properties" in found:
            return found
    return node


class Table(MutableMapping[str, Any]):
    """A table of a scene description, such as a material or the solver settings.

    Keys are attributes: ``scene.solver.substeps = 8``. They are those of a scene file; `dir` lists
    them, `describe` says what they mean. A key that is not set reads as None, and setting one to
    None leaves it out. Values are checked when the scene is built.
    """

    __slots__ = ("_data", "_node")

    def __init__(self, data: dict[str, Any], node: Mapping[str, Any]) -> None:
        object.__setattr__(self, "_data", data)
        object.__setattr__(self, "_node", resolve(node))

    def _properties(self) -> Mapping[str, Any]:
        properties: Mapping[str, Any] = self._node.get("properties", {})
        return properties

    def _known(self, key: str) -> Mapping[str, Any]:
        properties = self._properties()
        if key not in properties:
            raise AttributeError(f"a scene has no key {key!r} here; {_hint(key, properties)}")
        node: Mapping[str, Any] = properties[key]
        return node

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        node = self._known(key)
        return _wrap(self._data.get(key), node)

    def __setattr__(self, key: str, value: Any) -> None:
        self._known(key)
        if value is None:
            self._data.pop(key, None)
        else:
            self._data[key] = _unwrap(value)

    def __delattr__(self, key: str) -> None:
        self._known(key)
        self._data.pop(key, None)

    def __getitem__(self, key: str) -> Any:
        if key not in self._data:
            raise KeyError(key)
        return getattr(self, key)

    def __setitem__(self, key: str, value: Any) -> None:
        try:
            setattr(self, key, value)
        except AttributeError as error:
            raise KeyError(str(error)) from None

    def __delitem__(self, key: str) -> None:
        del self._data[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._properties()]

    def describe(self) -> str:
        """What each key means, one per line."""
        lines = (f"{key}: {node.get('description', '')}" for key, node in self._properties().items())
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """A copy as a plain dict."""
        return copy.deepcopy(self._data)

    def __repr__(self) -> str:
        entries = ", ".join(f"{key}={_short(value)}" for key, value in self._data.items())
        return f"{self._node.get('title', 'Table')}({entries})"


class Tables(Sequence[Table]):
    """The tables of one kind, such as all blocks: a list that can grow and shrink."""

    __slots__ = ("_list", "_node")

    def __init__(self, entries: list[dict[str, Any]], node: Mapping[str, Any]) -> None:
        self._list = entries
        self._node = node

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [Table(entry, self._node) for entry in self._list[index]]
        return Table(self._list[index], self._node)

    def __len__(self) -> int:
        return len(self._list)

    def __delitem__(self, index: int | slice) -> None:
        del self._list[index]

    def append(self, **values: Any) -> Table:
        """Adds a table with these values."""
        table = Table({}, self._node)
        for key, value in values.items():
            setattr(table, key, value)
        self._list.append(table._data)
        return table

    def clear(self) -> None:
        """Removes all tables."""
        self._list.clear()

    def __repr__(self) -> str:
        return "[" + ", ".join(map(repr, self)) + "]"


def _hint(key: str, properties: Mapping[str, Any]) -> str:
    """What to write instead of a key that is not one of these."""
    renamed = _native.renamed_key_hint(key)
    if renamed:
        return renamed
    near = difflib.get_close_matches(key, properties, 1)
    return f"did you mean {near[0]!r}?" if near else f"the keys are {', '.join(properties)}"


def _wrap(value: Any, node: Mapping[str, Any]) -> Any:
    if isinstance(value, dict):
        return Table(value, node)
    items = resolve(node).get("items")
    if isinstance(value, list) and items and "properties" in resolve(items):
        return Tables(value, items)
    return tuple(value) if isinstance(value, list) else value


def _unwrap(value: Any) -> Any:
    if isinstance(value, Table):
        return value._data
    if isinstance(value, Tables):
        return value._list
    return plain(value)


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
