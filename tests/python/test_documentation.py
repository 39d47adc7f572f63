"""`help` and the types are enough to work from."""

from __future__ import annotations

import dataclasses
import importlib.metadata
import inspect
import re
import shutil
from collections.abc import Iterator
from typing import Any, get_type_hints

import pytest

import unipbd as up

CLASSES = [value for name in up.__all__ if inspect.isclass(value := getattr(up, name))]


def members() -> Iterator[tuple[str, Any]]:
    """Public methods and properties of the public classes, once each."""
    seen = set()
    for kind in CLASSES:
        for name, value in inspect.getmembers(kind):
            owner = next((base for base in kind.__mro__ if name in vars(base)), object)
            if name.startswith("_") or not owner.__module__.startswith("unipbd") or (owner, name) in seen:
                continue
            if callable(value) or isinstance(value, property):
                seen.add((owner, name))
                yield f"{owner.__name__}.{name}", value


def test_every_public_thing_has_a_docstring() -> None:
    bare = [name for name in up.__all__ if inspect.isroutine(value := getattr(up, name)) and not value.__doc__]
    bare += [kind.__name__ for kind in CLASSES if not kind.__doc__ or kind.__doc__.startswith(kind.__name__ + "(")]
    bare += [name for name, value in members() if not inspect.getdoc(value)]
    assert not bare


def test_docstrings_of_arrays_give_shape_and_type() -> None:
    poor = []
    for name, value in members():
        if not isinstance(value, property) or value.fget is None:
            continue
        returned = str(value.fget.__annotations__.get("return", ""))
        if re.search(r"Floats|Doubles|Ids|NDArray", returned):
            doc = inspect.getdoc(value) or ""
            if not re.search(r"shape \((N|M|n|2|\d)", doc) and "(M, 2)" not in doc:
                poor.append(f"{name}: no shape")
            if not re.search(r"float32|float64|uint8|uint16|uint32|int64|bool", doc):
                poor.append(f"{name}: no type")
    assert not poor


def test_docstrings_of_quantities_give_their_unit() -> None:
    word = re.compile(r"^(\w*_)?(time|times|dt|positions?|velocity|velocities|mass|inertia|angle|radius|energy|force|torque|"
                      r"spacing|pressures|density)$")
    bare = [name for name, value in members() if isinstance(value, property) and word.match(name.rsplit(".")[-1])
            and "[" not in (inspect.getdoc(value) or "")]
    assert not bare


@pytest.mark.parametrize("kind", [kind for kind in CLASSES if dataclasses.is_dataclass(kind)], ids=lambda k: k.__name__)
def test_the_fields_of_records_are_documented(kind: type) -> None:
    for field in dataclasses.fields(kind):
        assert re.search(rf"^\s+{field.name}: ", kind.__doc__ or "", re.MULTILINE), field.name


def test_the_keys_of_a_scene_are_those_that_editors_know() -> None:
    from unipbd import _keys, _tables

    known, written = set(get_type_hints(_keys.Keys)), set(_tables.schema()["properties"])
    assert known == written, "unipbd/_keys.py lists the top-level keys of a scene file"
    described = up.Scene().describe().splitlines()
    assert len(described) == len(known) and all(": " in line for line in described)
    assert "xsph:" in up.Scene().describe("liquid") and "substeps:" in up.Scene().describe("solver")


def test_the_examples_of_the_docstrings_run(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    from conftest import SCENES

    monkeypatch.chdir(tmp_path)
    shutil.copytree(SCENES, tmp_path / "scenes")
    text = (up.__doc__ or "").split("    import unipbd as up", 1)[1].split("\nStart with", 1)[0]
    exec(inspect.cleandoc("import unipbd as up" + text.replace("2.0", "0.05")), {"print": lambda *_: None})
    assert (tmp_path / "frame.png").exists()


def test_there_is_one_version() -> None:
    assert up.__version__ == importlib.metadata.version("unipbd")
