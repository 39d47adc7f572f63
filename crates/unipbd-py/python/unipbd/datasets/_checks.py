"""Physical checks of the flows that have a known answer."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._read import all_trajectories
from ._statistics import displacements, periodic_box
from ._tables import GHIA_U, GHIA_V, MARTIN_MOYCE

Points = npt.NDArray[np.float64]
MOST = 400
"""Displacements of a trajectory that a profile is averaged over."""


@dataclass(frozen=True)
class Check:
    """A figure of a report, and the band that it must lie in.

    Attributes:
        name: what it is. value: the figure. low, high: its band; None where there is none.
        note: how it was found.
    """

    name: str
    value: float
    low: float | None = None
    high: float | None = None
    note: str = ""

    @property
    def passed(self) -> bool:
        """Whether it lies in its band."""
        return (self.low is None or self.value >= self.low) and (self.high is None or self.value <= self.high)

    def __str__(self) -> str:
        band = "" if self.low is None and self.high is None else f"  [{_end(self.low)} .. {_end(self.high)}]"
        mark = "" if not band else "  ok" if self.passed else "  OUT OF BAND"
        return f"{self.name}: {self.value:.6g}{band}{mark}" + (f"  ({self.note})" if self.note else "")


def _end(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"


@dataclass(frozen=True)
class Curve:
    """What was measured beside what is known, for a picture: over what `axis` names."""

    title: str
    axis: str
    x: Points
    measured: Points
    known_x: Points
    known: Points


@dataclass
class Flow:
    """A data set, as the checks see it: `fluid` is the type of fluid particles, `numbers` the diagnostics
    (trajectories, frames, columns)."""

    folder: Path
    metadata: dict[str, Any]
    fluid: set[int]
    recipe: dict[str, Any]
    columns: dict[str, Points]

    @property
    def viscosity(self) -> float:
        """Kinematic viscosity of the first liquid [m^2/s]."""
        return float(self.recipe["scene"]["liquid"][0]["kinematic_viscosity"])

    @property
    def dx(self) -> float:
        """Spacing of the particles [m]."""
        return float(self.recipe["scene"]["spacing"])

    @property
    def dt(self) -> float:
        """Time between two stored frames [s]."""
        return float(self.metadata["dt"]) * float(self.metadata.get("write_every", 1))

    def steps(self) -> Iterator[tuple[Points, Points]]:
        """Middles and velocities of the fluid over each stored step, at most `MOST` of each trajectory."""
        box = periodic_box(self.metadata)
        for positions, types in all_trajectories(self.folder):
            rows = np.isin(types, list(self.fluid))
            stride = max(1, (len(positions) - 1) // MOST)
            for frame in range(0, len(positions) - 1, stride):
                x, y = positions[frame][rows], positions[frame + 1][rows]
                moved = displacements(y, x, box)
                yield x + 0.5 * moved, moved / self.dt


def taylor_green(flow: Flow) -> tuple[list[Check], list[Curve]]:
    """Viscosity from the decay of the kinetic energy, fitted down to a twentieth of it."""
    viscosity = flow.viscosity
    time, energy = flow.columns["time"], flow.columns["kinetic_energy"]
    wave = 2.0 * np.pi / float(flow.recipe["start"].get("wavelength", 1.0))
    ratios = []
    for t, k in zip(time, energy, strict=True):
        kept = k > 0.05 * k[0]
        slope = np.polyfit(t[kept], np.log(k[kept]), 1)[0] if kept.sum() > 2 else np.nan
        ratios.append(-slope / (4.0 * wave**2) / viscosity)
    note = f"mean of {len(ratios)} trajectories, spread {np.std(ratios):.2g}"
    check = Check("fitted viscosity over the true one", float(np.mean(ratios)), 0.97, 1.03, note)
    exact = np.exp(-4.0 * viscosity * wave**2 * (time[0] - time[0][0]))
    curve = Curve("kinetic energy over that of the start", "time [s]", time[0], energy[0] / energy[0][0], time[0], exact)
    return [check], [curve]


def reverse_poiseuille(flow: Flow) -> tuple[list[Check], list[Curve]]:
    """Mean profile of the velocity along the force."""
    force = float(np.linalg.norm(flow.recipe["force"].get("acceleration", [1.0, 0.0])))
    height = float(flow.recipe["force"].get("height", 1.0))
    viscosity = flow.viscosity
    bins = 40
    count, total = np.zeros(bins), np.zeros(bins)
    for x, v in flow.steps():
        place = np.floor(np.mod(x[:, 1], 2.0 * height) / (2.0 * height) * bins).astype(int) % bins
        count += np.bincount(place, minlength=bins)
        total += np.bincount(place, weights=v[:, 0], minlength=bins)
    y = (np.arange(bins) + 0.5) * 2.0 * height / bins
    part = np.mod(y, height)
    # The mean of a parabola over a bin, which its middle value is not.
    width = 2.0 * height / bins
    exact = force / (2.0 * viscosity) * (part * (height - part) - width**2 / 12.0) * np.where(y < height, 1.0, -1.0)
    mean = total / np.maximum(count, 1.0)
    largest = force * height**2 / (8.0 * viscosity)
    error = float(np.sqrt(np.mean((mean - exact) ** 2)) / np.sqrt(np.mean(exact**2)))
    note = f"largest speed {np.abs(mean).max():.4g}, exact {largest:.4g}"
    curve = Curve("mean velocity along the force [m/s]", "y [m]", y, mean, y, exact)
    return [Check("L2 error of the profile", error, 0.0, 0.03, note)], [curve]


def lid_driven_cavity(flow: Flow) -> tuple[list[Check], list[Curve]]:
    """Velocities along the centre lines against Ghia et al. 1982, at Re = 100."""
    tank = flow.recipe["scene"]["tank"][0]
    corner, side = np.array(tank["min"]), float(tank["max"][0] - tank["min"][0])
    lid = next(wall for wall in flow.recipe["scene"]["half_plane"] if any(wall.get("velocity", [0.0, 0.0])))
    speed = float(np.linalg.norm(lid["velocity"]))
    reynolds = speed * side / flow.viscosity
    dx = flow.dx / side
    lines = [_Line(0, GHIA_U, dx), _Line(1, GHIA_V, dx)]
    for x, v in flow.steps():
        for line in lines:
            line.add((x - corner) / side, v / speed)
    checks, curves = [], []
    for line, name in zip(lines, ("u along x = 0.5", "v along y = 0.5"), strict=True):
        measured = line.values()
        error = float(np.sqrt(np.mean((measured - line.known) ** 2)))
        high = 0.03 if abs(reynolds - 100.0) < 1.0 else None
        note = f"of the lid speed, largest {np.abs(measured - line.known).max():.3g}; Re = {reynolds:.4g}"
        checks.append(Check(f"root mean square error of {name}", error, None, high, note))
        curves.append(Curve(name, "place over the side", line.places, measured, line.places, line.known))
    return checks, curves


class _Line:
    """A velocity along a centre line: straight lines fitted around each place, over all frames."""

    def __init__(self, component: int, table: tuple[tuple[float, float], ...], dx: float) -> None:
        self.component = component
        self.places = np.array([row[0] for row in table])
        self.known = np.array([row[1] for row in table])
        self.dx = dx
        self.sums = np.zeros((len(table), 5))

    def add(self, x: Points, v: Points) -> None:
        across, along = x[:, self.component], x[:, 1 - self.component]
        near = np.abs(across - 0.5) < 2.0 * self.dx
        offset = (along[near, None] - self.places) / self.dx
        beside = np.maximum(0.0, 1.0 - ((across[near] - 0.5) / (2.0 * self.dx)) ** 2)
        weight = np.maximum(0.0, 1.0 - offset**2) * beside[:, None]
        u = v[near, self.component, None]
        parts = (weight, weight * offset, weight * offset**2, weight * u, weight * offset * u)
        self.sums += np.stack([part.sum(axis=0) for part in parts], axis=1)

    def values(self) -> Points:
        s0, s1, s2, u0, u1 = self.sums.T
        spread = s0 * s2 - s1**2
        found: Points = (s2 * u0 - s1 * u1) / np.where(spread > 0.0, spread, np.nan)
        return found


def dam_break(flow: Flow) -> tuple[list[Check], list[Curve]]:
    """Way of the front over the height h of the column against t sqrt(g/h), beside the square column of Martin &
    Moyce: it does not depend on the width until the back wall is felt. Their gate takes time to open: one shift of
    time is fitted."""
    block, tank = flow.recipe["scene"]["block"][0], flow.recipe["scene"]["tank"][0]
    height = float(block["max"][1] - block["min"][1])
    start = float(block["max"][0])
    scale = np.sqrt(float(np.linalg.norm(flow.recipe["scene"]["gravity"])) / height)
    room = (float(tank["max"][0]) - start - flow.dx) / height
    known = np.array([row for row in MARTIN_MOYCE if row[1] - 1.0 < room])
    errors, shifts, curves = [], [], []
    for positions, types in all_trajectories(flow.folder):
        rows = np.isin(types, list(flow.fluid))
        # The third of all: a drop that flies ahead is no front.
        front = np.array([np.sort(np.asarray(frame)[rows, 0])[-3] for frame in positions])
        way = (front + 0.5 * flow.dx - start) / height
        running = way < room
        end = len(way) if running.all() else int(np.argmin(running))
        t = np.arange(end) * flow.dt * scale
        error, shift = _fitted(t, way[:end], known)
        errors.append(error)
        shifts.append(shift)
        place = 1.0 + way[:end]
        curves.append(Curve("place of the front over h", "t sqrt(g/h)", t - shift, place, known[:, 0], known[:, 1]))
    note = f"mean of {len(errors)} trajectories, largest {max(errors):.3g}, shift of time {np.mean(shifts):.3g} sqrt(h/g)"
    return [Check("front against Martin & Moyce", float(np.mean(errors)), 0.0, 0.05, note)], curves[:1]


def _fitted(t: Points, way: Points, known: Points) -> tuple[float, float]:
    """Largest error of the place of the front, and the shift of time that makes it smallest."""
    shifts = np.arange(-0.6, 0.6, 0.002)
    places = np.array([1.0 + np.interp(known[:, 0] + shift, t, way) for shift in shifts])
    errors = np.abs(places / known[:, 1] - 1.0).max(axis=1)
    best = int(np.argmin(errors))
    return float(errors[best]), float(shifts[best])


KNOWN: dict[str, Callable[[Flow], tuple[list[Check], list[Curve]]]] = {
    "TGV": taylor_green,
    "RPF": reverse_poiseuille,
    "LDC": lid_driven_cavity,
    "DAM": dam_break,
}
"""Checks by the case of LagrangeBench that the name of the recipe stands for."""
