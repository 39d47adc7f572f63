"""The report of a data set: statistics anew, conservation, spectra, physical checks, pictures."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .._errors import UnipbdError
from ._checks import KNOWN, Check, Curve, Flow
from ._gns import BOUNDARY
from ._pictures import draw
from ._read import all_trajectories, folders, metadata
from ._statistics import displacements, periodic_box, statistics

Points = npt.NDArray[np.float64]
EQUAL = 1e-6
"""Largest difference of statistics, of the deviation: both are sums of the same numbers."""

WITHOUT_WALLS = ("TGV", "RPF")
"""Cases whose momentum stays 0."""


@dataclass(frozen=True)
class Report:
    """What a report found.

    Attributes:
        folder: the data set. checks: all figures. pictures: files that were drawn.
        spectrum: power of the displacements of the fluid by frequency, shape (F, 2): [1/s] and share.
    """

    folder: Path
    checks: list[Check]
    pictures: list[Path]
    spectrum: Points

    @property
    def passed(self) -> bool:
        """Whether every figure lies in its band."""
        return all(check.passed for check in self.checks)

    def __str__(self) -> str:
        lines = [f"{self.folder}", *(f"  {check}" for check in self.checks)]
        lines += [f"  picture: {path}" for path in self.pictures]
        return "\n".join(lines)


def report(folder: str | os.PathLike[str], pictures: bool = True) -> Report:
    """Looks at the data set in a folder of `generate`: recomputes its statistics from the files of every format, and
    judges compression, energy and momentum; flows with a known answer are compared with it. `report.txt` and, with
    matplotlib, pictures are written into the folder."""
    place = Path(folder)
    manifest = _manifest(place)
    columns = _columns(place / "diagnostics.npz")
    forms = folders(place)
    checks: list[Check] = []
    for form in forms:
        checks += _statistics(form, manifest)
    flow = _flow(forms[0], manifest, columns)
    checks += _conservation(flow, manifest)
    spectrum = _spectrum(flow)
    checks.append(_noise(spectrum))
    curves: list[Curve] = []
    case = _case(manifest["recipe"]["name"])
    if case in KNOWN:
        found, curves = KNOWN[case](flow)
        checks += found
    drawn = draw(place, flow, curves, spectrum) if pictures else []
    made = Report(place, checks, drawn, spectrum)
    (place / "report.txt").write_text(f"{made}\n", encoding="utf-8")
    return made


def _manifest(place: Path) -> dict[str, Any]:
    try:
        found: dict[str, Any] = json.loads((place / "manifest.json").read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise UnipbdError(f"{place} holds no complete data set: it has no manifest.json") from None
    return found


def _columns(path: Path) -> dict[str, Points]:
    with np.load(path) as file:
        return {str(name): file["values"][:, :, number] for number, name in enumerate(file["columns"])}


def _case(name: str) -> str:
    parts = name.split("_")
    return parts[1][:3].upper() if len(parts) > 1 else ""


def _form(folder: Path) -> str:
    return "gns" if folder.name in ("gns", "npz") else "lagrangebench"


def _flow(folder: Path, manifest: dict[str, Any], columns: dict[str, Points]) -> Flow:
    fluid = set(manifest["fluid_types"][_form(folder)])
    return Flow(folder, metadata(folder), fluid, manifest["recipe"], columns)


def _statistics(folder: Path, manifest: dict[str, Any]) -> list[Check]:
    """The statistics of the files against those of metadata.json."""
    written = metadata(folder)
    fluid = list(manifest["fluid_types"][_form(folder)])
    gns = _form(folder) == "gns"
    rows = ((x, types != BOUNDARY if gns else np.isin(types, fluid)) for x, types in all_trajectories(folder))
    found = statistics(rows, periodic_box(written))
    worst = 0.0
    for key, values in found.items():
        scale = np.abs(np.array(found[key[:3] + "_std"]))
        worst = max(worst, float(np.max(np.abs(np.array(written[key]) - np.array(values)) / scale)))
    name = f"statistics of {folder.name} against metadata.json"
    return [Check(name, worst, 0.0, EQUAL, "largest difference, of the deviation")]


def _conservation(flow: Flow, manifest: dict[str, Any]) -> list[Check]:
    columns = flow.columns
    energy = columns["kinetic_energy"] + columns["potential_energy"]
    parts = (columns["kinetic_energy"], columns["potential_energy"])
    scale = np.maximum(sum(np.abs(part).max(axis=1) for part in parts), 1e-12)
    growth = float(((energy - energy[:, :1]).max(axis=1) / scale).max())
    driven = flow.recipe.get("force") is not None or any(
        any(wall.get("velocity", [0, 0])) for wall in flow.recipe["scene"].get("half_plane", []))
    momentum = np.hypot(columns["momentum_x"], columns["momentum_y"])
    refused = sum(manifest["refused"].values())
    checks = [
        Check("trajectories", len(manifest["trajectories"]), note=f"{refused} draws refused"),
        Check("largest compression", float(columns["density_error_max"].max())),
        Check("mean compression", float(columns["density_error_mean"].mean())),
        Check("growth of the energy over the largest kinetic and potential", growth, None, None if driven else 0.02),
    ]
    # Mass times speed at the moment of the largest energy, at least.
    largest = max(2.0 * columns["kinetic_energy"].max() / max(columns["speed_max"].max(), 1e-12), 1e-12)
    kept = _case(manifest["recipe"]["name"]) in WITHOUT_WALLS
    name = "largest momentum over mass x speed"
    checks.append(Check(name, float(momentum.max() / largest), 0.0 if kept else None, 0.02 if kept else None))
    return checks


def _spectrum(flow: Flow) -> Points:
    """Power of the displacements of the fluid by frequency, averaged over particles and trajectories."""
    box = periodic_box(flow.metadata)
    power: Points | None = None
    for positions, types in all_trajectories(flow.folder):
        length = min(len(positions), 257)
        rows = np.flatnonzero(np.isin(types, list(flow.fluid)))[::7]
        x = np.asarray(positions[:length])[:, rows]
        if power is not None and length - 1 != 2 * (len(power) - 1) and length - 1 != 2 * len(power) - 1:
            continue
        moved = displacements(x[1:], x[:-1], box)
        found = (np.abs(np.fft.rfft(moved, axis=0)) ** 2).sum(axis=(1, 2))
        power = found if power is None else power + found
        count = length - 1
    if power is None:
        return np.empty((0, 2))
    return np.stack([np.fft.rfftfreq(count, flow.dt), power / max(power.sum(), 1e-300)], axis=1)


def _noise(spectrum: Points) -> Check:
    half = spectrum[spectrum[:, 0] > 0.5 * spectrum[:, 0].max(initial=0.0)]
    return Check("share of displacements in the upper half of the frequencies", float(half[:, 1].sum()),
                 note="what moves to and fro from frame to frame")
