"""Scene descriptions: read, edited, built."""

from __future__ import annotations

import copy
import difflib
import functools
import json
import os
from collections.abc import Iterator, Mapping, MutableMapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy.typing as npt

from . import _native
from ._arrays import pairs, plain, points

if TYPE_CHECKING:
    from ._simulation import Simulation

MATERIALS = ("liquid", "gas", "smoke", "solid")


@functools.lru_cache(maxsize=1)
def _schema() -> dict[str, Any]:
    schema: dict[str, Any] = json.loads(_native.scene_schema())
    return schema


def _resolve(node: Mapping[str, Any]) -> Mapping[str, Any]:
    """The part of the schema that a reference, or a choice with one table in it, stands for."""
    if "$ref" in node:
        return _resolve(_schema()["$defs"][node["$ref"].rsplit("/", 1)[1]])
    for choice in node.get("anyOf", node.get("oneOf", node.get("allOf", ()))):
        found = _resolve(choice)
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
        object.__setattr__(self, "_node", _resolve(node))

    def _properties(self) -> Mapping[str, Any]:
        properties: Mapping[str, Any] = self._node.get("properties", {})
        return properties

    def _known(self, key: str) -> Mapping[str, Any]:
        properties = self._properties()
        if key not in properties:
            near = difflib.get_close_matches(key, properties, 1)
            hint = f"; did you mean {near[0]!r}?" if near else f"; the keys are {', '.join(properties)}"
            raise AttributeError(f"a scene has no key {key!r} here{hint}")
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


def _wrap(value: Any, node: Mapping[str, Any]) -> Any:
    if isinstance(value, dict):
        return Table(value, node)
    items = _resolve(node).get("items")
    if isinstance(value, list) and items and "properties" in _resolve(items):
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


class _Named(Mapping[str, Table]):
    """Tables by their name, over one or more kinds."""

    def __init__(self, scene: Scene, kinds: Sequence[str], noun: str) -> None:
        self._scene = scene
        self._kinds = kinds
        self._noun = noun

    def _entries(self) -> Iterator[tuple[str, Table]]:
        for kind in self._kinds:
            for table in self._scene._tables(kind):
                yield table.name or "", table

    def __getitem__(self, name: str) -> Table:
        for known, table in self._entries():
            if known == name:
                return table
        names = ", ".join(repr(known) for known in self) or "none"
        raise KeyError(f"there is no {self._noun} {name!r}; there is {names}")

    def __iter__(self) -> Iterator[str]:
        return (name for name, _ in self._entries())

    def __len__(self) -> int:
        return sum(1 for _ in self._entries())

    def __repr__(self) -> str:
        return repr(dict(self._entries()))


class Scene:
    """A scene description: what to simulate, as plain data that can be edited.

    Read one with `load`, `from_toml` or `from_dict`, or make one with builder calls. Everything a
    scene file holds is an attribute::

        scene = up.Scene(spacing=0.05, gravity=(0, -9.81))
        scene.add_liquid("water", density=1000.0)
        scene.add_block("water", min=(0, 0), max=(1, 2))
        scene.add_tank(min=(0, 0), max=(3, 3), open=["top"])
        scene.solver.substeps = 8
        scene.materials["water"].viscosity = 0.02
        sim = scene.build(seed=7)

    `describe` lists all keys. Values are checked by `check` and `build`, which name all problems at
    once in a `SceneError`.
    """

    _data: dict[str, Any]

    def __init__(self, **values: Any) -> None:
        """An empty scene with these top-level keys set."""
        object.__setattr__(self, "_data", _native.default_scene())
        for key, value in values.items():
            setattr(self, key, value)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Scene:
        """Reads a scene file (TOML). Raises `SceneError` with lines and hints, or `OSError`."""
        data, _ = _native.load_scene(os.fspath(path))
        return cls._of(data)

    @classmethod
    def from_toml(cls, text: str, file_name: str = "scene.toml") -> Scene:
        """Reads a scene from TOML text; `file_name` stands in messages."""
        return cls._of(_native.parse_scene(text, file_name))

    @classmethod
    def from_dict(cls, description: Mapping[str, Any]) -> Scene:
        """A scene from nested dicts and lists with the keys of a scene file. It is checked at once."""
        return cls._of(_native.check_scene(plain(dict(description))))

    @classmethod
    def _of(cls, data: dict[str, Any]) -> Scene:
        scene = cls.__new__(cls)
        object.__setattr__(scene, "_data", data)
        return scene

    # -- attributes ----------------------------------------------------------------------------

    def _root(self) -> Table:
        return Table(self._data, _schema())

    def _tables(self, kind: str) -> Tables:
        node = _resolve(self._root()._known(kind)).get("items", {})
        entries: list[dict[str, Any]] = self._data.setdefault(kind, [])
        return Tables(entries, node)

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        root = self._root()
        if _resolve(root._known(key)).get("type") == "array" and key not in self._data:
            items = _resolve(root._known(key)).get("items")
            if items and "properties" in _resolve(items):
                return self._tables(key)
        return getattr(root, key)

    def __setattr__(self, key: str, value: Any) -> None:
        setattr(self._root(), key, value)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *_schema()["properties"]]

    @property
    def materials(self) -> Mapping[str, Table]:
        """Liquids, gases, smokes and solids by name."""
        return _Named(self, MATERIALS, "material")

    @property
    def emitters(self) -> Mapping[str, Table]:
        """Emitters by name."""
        return _Named(self, ("emitter",), "emitter")

    @property
    def bodies(self) -> Mapping[str, Table]:
        """Rigid bodies by name."""
        return _Named(self, ("body",), "body")

    def describe(self) -> str:
        """What each key of a scene means, one per line."""
        return self._root().describe()

    # -- builder calls -------------------------------------------------------------------------

    def add(self, kind: str, **values: Any) -> Table:
        """Adds a table of any kind, such as ``scene.add("tank", min=(0, 0), max=(1, 1))``."""
        return self._tables(kind).append(**values)

    def add_liquid(self, name: str, density: float = 1000.0, **values: Any) -> Table:
        """Adds a liquid of this rest density [kg/m^2]."""
        return self.add("liquid", name=name, density=density, **values)

    def add_gas(self, name: str, density: float = 1.2, **values: Any) -> Table:
        """Adds a gas of this rest density [kg/m^2]."""
        return self.add("gas", name=name, density=density, **values)

    def add_smoke(self, name: str, **values: Any) -> Table:
        """Adds a smoke: markers that follow the flow."""
        return self.add("smoke", name=name, **values)

    def add_solid(self, name: str, density: float = 1000.0, **values: Any) -> Table:
        """Adds a solid: free points for constraints of your own."""
        return self.add("solid", name=name, density=density, **values)

    def add_block(
        self, material: str, min: tuple[float, float], max: tuple[float, float], **values: Any
    ) -> Table:
        """Fills a rectangle [m] with particles of a material."""
        return self.add("block", material=material, min=min, max=max, **values)

    def add_disc(self, material: str, center: tuple[float, float], radius: float, **values: Any) -> Table:
        """Fills a disc [m] with particles of a material."""
        return self.add("disc", material=material, center=center, radius=radius, **values)

    def add_particles(
        self,
        material: str,
        positions: npt.ArrayLike,
        velocities: npt.ArrayLike | None = None,
        **values: Any,
    ) -> Table:
        """Adds particles at `positions`, shape (N, 2) [m].

        `velocities` [m/s] is one vector for all of them or an array of shape (N, 2).
        ``motion="scripted"`` lets only their velocity move them.
        """
        where = points(positions, "positions", ValueError)
        if velocities is not None:
            values["velocities"] = pairs(velocities, len(where), "velocities", ValueError)
        return self.add("points", material=material, positions=where, **values)

    def add_emitter(
        self,
        material: str,
        position: tuple[float, float],
        width: float,
        speed: float,
        direction: tuple[float, float] = (0.0, 1.0),
        **values: Any,
    ) -> Table:
        """Adds a nozzle of this width [m] that pushes a material out at this speed [m/s]."""
        return self.add(
            "emitter", material=material, position=position, width=width, speed=speed, direction=direction, **values
        )

    def add_tank(self, min: tuple[float, float], max: tuple[float, float], **values: Any) -> Table:
        """Adds a container: particles stay inside the rectangle [m]."""
        return self.add("tank", min=min, max=max, **values)

    def add_obstacle(self, min: tuple[float, float], max: tuple[float, float], **values: Any) -> Table:
        """Adds a static box: particles stay outside the rectangle [m]."""
        return self.add("obstacle", min=min, max=max, **values)

    def add_half_plane(self, point: tuple[float, float], normal: tuple[float, float], **values: Any) -> Table:
        """Adds a straight wall without end; particles stay on the side the normal points to."""
        return self.add("half_plane", point=point, normal=normal, **values)

    def add_body(
        self,
        name: str,
        at: tuple[float, float],
        outline: npt.ArrayLike | None = None,
        size: tuple[float, float] | None = None,
        radius: float | None = None,
        density: float = 1000.0,
        **values: Any,
    ) -> Table:
        """Adds a rigid body at `at` [m]: a polygon (`outline`, shape (M, 2), seen from `at`), a box
        (`size`: width and height) or a disc (`radius`), of this mass per area [kg/m^2].

        Further keys are those of ``[[body]]`` in a scene file, such as ``angle_deg``, ``velocity``,
        ``friction`` and ``kind="kinematic"``.
        """
        if outline is not None:
            values["outline"] = points(outline, "outline", ValueError)
        shape = {"size": size, "radius": radius}
        values |= {key: value for key, value in shape.items() if value is not None}
        return self.add("body", name=name, position=at, density=density, **values)

    def add_joint(self, kind: str, body: str, at: tuple[float, float], **values: Any) -> Table:
        """Links two bodies, or a body and the world, at a point [m].

        `kind` is ``"hinge"``, ``"rod"`` or ``"rope"``; ``other`` names the second body.
        """
        return self.add("joint", kind=kind, body=body, at=at, **values)

    # -- use -----------------------------------------------------------------------------------

    def check(self) -> None:
        """Raises `SceneError` with everything that is wrong with the scene."""
        _native.check_scene(self._data)

    def estimate(self) -> dict[str, float]:
        """What the scene would cost: particles, substeps, memory [bytes], computing time [s]."""
        return _native.estimate_scene(self._data)

    def build(self, seed: int | None = None, threads: int | None = None) -> Simulation:
        """Builds a simulation of the scene as it is now.

        `seed` replaces the seed of the scene. `threads` is the number of threads to use; left out,
        the environment variable UNIPBD_THREADS decides, or all processors are used. Threads never
        change results.
        """
        from ._simulation import Simulation

        return Simulation(self, seed=seed, threads=threads)

    def to_toml(self) -> str:
        """The scene as the text of a scene file."""
        return _native.scene_to_toml(self._data)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene file."""
        text = self.to_toml()
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def to_dict(self) -> dict[str, Any]:
        """A copy as nested dicts and lists."""
        data: dict[str, Any] = plain(copy.deepcopy(self._data))
        return {key: value for key, value in data.items() if value != []}

    def copy(self) -> Scene:
        """An independent copy."""
        return Scene._of(copy.deepcopy(self._data))

    __copy__ = copy

    def __deepcopy__(self, memo: dict[int, Any]) -> Scene:
        return self.copy()

    def __getstate__(self) -> dict[str, Any]:
        return self._data

    def __setstate__(self, data: dict[str, Any]) -> None:
        object.__setattr__(self, "_data", data)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self.to_dict() == other.to_dict()

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        kinds = [f"{len(value)} {key}" for key, value in self._data.items() if isinstance(value, list) and value
                 and isinstance(value[0], dict)]
        title = f" {self._data['name']!r}" if self._data.get("name") else ""
        return f"<unipbd.Scene{title}: spacing {self._data['spacing']:g} m; {', '.join(kinds) or 'empty'}>"
