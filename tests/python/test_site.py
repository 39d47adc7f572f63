"""The generated pages of the documentation site say what the command says. `docs/build.py` builds the whole site."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest
from documents import ROOT

sys.path.insert(0, str(ROOT / "docs" / "_ext"))

command_line = pytest.importorskip("command_line")
scene_format = pytest.importorskip("scene_format")
UNIPBD = Path(sys.executable).with_name("unipbd.exe" if sys.platform == "win32" else "unipbd")


@pytest.fixture(scope="module")
def schema() -> object:
    return scene_format.Schema(UNIPBD)


@pytest.mark.parametrize(("table", "key", "expected"), [
    ("liquid", "density", ("number", "kg/m^2", "1000.0", "from 1e-6 to 1e9")),
    ("contacts", "iterations", ("integer", "", "2", "from 1 to 4")),
    ("tank", "friction", ("number", "", "", "0 or more")),
    ("body", "kind", ("word", "", '"dynamic"', "")),
])
def test_a_key_is_told_as_it_is(schema: object, tmp_path: Path, table: str, key: str, expected: tuple[str, ...]) -> None:
    found, many = schema.tables()[table]  # type: ignore[attr-defined]
    told = next(known for known in schema.keys(found) if known.name == key)  # type: ignore[attr-defined]
    scene_format.Checker(UNIPBD, scene_format.Scenes(ROOT / "scenes"), tmp_path).fill(table, many, told)
    assert (told.kind, told.unit, told.default, told.range) == expected
    assert told.example and told.description


def test_every_table_has_a_page(schema: object) -> None:
    placed = {name for _, names in scene_format.TOPICS.values() for name in names}
    assert placed - {""} <= set(schema.tables()), "a table that is gone"  # type: ignore[attr-defined]


def test_the_command_line_page_has_every_command(tmp_path: Path) -> None:
    command_line.write(UNIPBD, tmp_path)
    page = (tmp_path / "command_line.md").read_text(encoding="utf-8")
    headings = re.findall(r"^## (.*)$", page, re.MULTILINE)
    assert headings[0] == "unipbd" and {"unipbd run", "unipbd render", "unipbd completions"} <= set(headings)
    assert "--stop-on" in page and "Exit codes" in page
