"""Diagnostics as one row of a table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def flat(numbers: Mapping[str, Any], prefix: str = "") -> dict[str, float]:
    """All numbers by name: ``counts.liquid``, ``momentum_x``, ``walls.floor.force_y``."""
    row: dict[str, float] = {}
    for name, value in numbers.items():
        if isinstance(value, Mapping):
            row.update(flat(value, f"{prefix}{name}."))
        elif isinstance(value, (tuple, list)) and len(value) == 2:
            row[f"{prefix}{name}_x"], row[f"{prefix}{name}_y"] = float(value[0]), float(value[1])
        elif isinstance(value, (int, float)):
            row[f"{prefix}{name}"] = value
    return row
