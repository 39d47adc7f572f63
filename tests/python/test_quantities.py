"""Every quantity of docs/diagnostics.md, which a Rust test checks against the table, is in Python."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

import unipbd as up

from conftest import ROOT

PAGE = (ROOT / "docs" / "diagnostics.md").read_text(encoding="utf-8")


def documented() -> dict[str, dict[str, list[str]]]:
    """Columns by quantity, by the list they are in; those of a frame under the empty name."""
    tables: dict[str, dict[str, list[str]]] = {}
    for part in PAGE.split("\n## ")[1:]:
        title, _, rest = part.partition("\n")
        place = re.search("`(.*)`", title)
        table = tables.setdefault(place[1] if place else "", {})
        for row in re.findall(r"^\| `(\w+)` \|.*\| (.*) \|$", rest, re.MULTILINE):
            table[row[0]] = re.findall(r"`(\w+)`", row[1]) or [row[0]]
    return tables


def measured_pool(scene: up.Scene) -> up.Simulation:
    scene.tank[0]["name"] = "tank"
    scene.add_gauge("depth", "level", at=(0.5, 0.0))
    return scene.build(seed=7, threads=1)


def check(diagnostics: Mapping[str, Any], further: set[str]) -> None:
    tables = documented()
    assert set(diagnostics) == set(tables[""]) | set(tables) - {""} | further
    for name in set(tables) - {""}:
        assert diagnostics[name], f"the scene has no {name}"
        for entry in diagnostics[name].values():
            assert set(entry) == set(tables[name])


def test_the_page_has_the_tables() -> None:
    tables = documented()
    assert set(tables) == {"", "materials", "groups", "walls", "gauges"} and len(tables[""]) > 20
    assert tables[""]["momentum"] == ["momentum_x", "momentum_y"]


def test_every_quantity_is_in_the_diagnostics_of_a_run_and_of_a_log(scene: up.Scene, tmp_path: Path) -> None:
    sim = measured_pool(scene)
    path = tmp_path / "run.mcap"
    with sim.record(path):
        sim.step(3)
        running = sim.diagnostics()
    check(running, set())
    log = up.read_log(path)
    recorded = list(log)[-1].diagnostics
    assert recorded is not None
    check(recorded, {"state_hash"})
    assert recorded == {**running, "state_hash": sim.state_hash()}


def test_every_column_is_in_the_table_of_a_log(scene: up.Scene, tmp_path: Path) -> None:
    sim = measured_pool(scene)
    path = tmp_path / "run.mcap"
    with sim.record(path):
        sim.step(3)
    columns = up.read_log(path).diagnostics()
    names = {name for columns in documented()[""].values() for name in columns}
    assert set(columns) == names | {"state_hash"}
    assert all(values.shape == (4,) for values in columns.values())
    np.testing.assert_array_equal(columns["count_liquid"], np.full(4, 100))
    assert columns["substeps_reason"].dtype.kind == "U"
