"""Scene descriptions: read, edited, built."""

from __future__ import annotations

import copy
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _native
from ._arrays import plain
from ._builder import Builder
from ._errors import SceneError
from ._keys import Keys
from ._tables import Table, Tables, resolve, schema

if TYPE_CHECKING:
    from ._simulation import Simulation

MATERIALS = ("liquid", "gas", "smoke", "solid")


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


class Scene(Keys, Builder):
    """A scene description: what to simulate, as plain data that can be edited.

    Read one with `load`, `from_toml` or `from_dict`, or make one with builder calls. Everything a
    scene file holds is an attribute::

        scene = up.Scene(spacing=0.05, gravity=(0, -9.81))
        scene.add_liquid("water", density=1000.0)
        scene.add_block("water", min=(0, 0), max=(1, 2))
        scene.add_tank(min=(0, 0), max=(3, 3), open=["top"])
        scene.solver.substeps = 8
        scene.materials["water"].xsph = 0.02
        sim = scene.build(seed=7)

    `describe` lists all keys and says what they mean. Values are checked by `check` and `build`,
    which name all problems at once in a `SceneError`.
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
    def from_toml(
        cls, text: str, file_name: str = "scene.toml", folder: str | os.PathLike[str] = ""
    ) -> Scene:
        """Reads a scene from TOML text; `file_name` stands in messages, CSV files that it names lie in `folder`."""
        return cls._of(_native.parse_scene(text, file_name, os.fspath(folder)))

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
        return Table(self._data, schema())

    def _tables(self, kind: str) -> Tables:
        node = resolve(self._root()._known(kind)).get("items", {})
        entries: list[dict[str, Any]] = self._data.setdefault(kind, [])
        return Tables(entries, node)

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        root = self._root()
        if resolve(root._known(key)).get("type") == "array" and key not in self._data:
            items = resolve(root._known(key)).get("items")
            if items and "properties" in resolve(items):
                return self._tables(key)
        return getattr(root, key)

    def __setattr__(self, key: str, value: Any) -> None:
        setattr(self._root(), key, value)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *schema()["properties"]]

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

    def describe(self, table: str = "") -> str:
        """What each key of a scene means, one per line, or each key of one of its tables.

        For example::

            print(scene.describe())
            print(scene.describe("body"))
        """
        if not table:
            return self._root().describe()
        node = resolve(self._root()._known(table))
        return Table({}, node.get("items", node)).describe()

    def add_rope(
        self, material: str, start: tuple[float, float], end: tuple[float, float], **values: Any
    ) -> Table:
        """Adds a rope of points of a solid (or of a liquid, which floats) from `start` to `end` [m].

        Further keys are those of ``[[rope]]`` in a scene file, such as ``length``, ``compliance``,
        ``held`` and ``body``.
        """
        ends: dict[str, Any] = {"from": start, "to": end}
        return self.add("rope", material=material, **ends, **values)

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
        """Whether both describe the same: a default that is written out makes no difference."""
        if not isinstance(other, Scene):
            return NotImplemented
        try:
            return self.to_toml() == other.to_toml()
        except (SceneError, TypeError, ValueError):
            return self.to_dict() == other.to_dict()

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        kinds = [f"{len(value)} {key}" for key, value in self._data.items() if isinstance(value, list) and value
                 and isinstance(value[0], dict)]
        title = f" {self._data['name']!r}" if self._data.get("name") else ""
        return f"<unipbd.Scene{title}: spacing {self._data['spacing']:g} m; {', '.join(kinds) or 'empty'}>"
