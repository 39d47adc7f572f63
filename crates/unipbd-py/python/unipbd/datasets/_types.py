"""Kinds of particles, and what the formats call them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from .._body import Body
from .._phase import GAS, LIQUID, RIGID
from .._simulation import Simulation

FLUIDS = ("liquid", "gas")
LAGRANGEBENCH = {
    "liquid": 0, "gas": 0, "wall": 1, "sliding wall": 2, "static": 1, "kinematic": 2, "dynamic": 3, "solid": 3}
"""Of the kinds of `kinds_of`; -1 is padding, which its loader adds."""
GNS = {"liquid": 5, "gas": 8, "wall": 3, "sliding wall": 3, "static": 3, "kinematic": 3, "dynamic": 0, "solid": 0}
"""Rigid 0, boundary 3, water 5, sand 6, goop 7."""
_LIQUIDS = (5, 7, 6)
"""Types of the first, second and third liquid in GNS."""


def kinds_of(sim: Simulation) -> npt.NDArray[np.str_]:
    """What each particle is: ``liquid``, ``gas``, ``solid`` (a free point), or the kind of the body that it is a sample
    of: ``dynamic``, ``kinematic`` or ``static``. Good at the start, where samples are at their places."""
    phases = sim.phases
    kinds = np.full(len(phases), "solid", dtype="U9")
    kinds[phases == LIQUID] = "liquid"
    kinds[phases == GAS] = "gas"
    rigid = np.flatnonzero(phases == RIGID)
    nearest = np.full(len(rigid), np.inf)
    x = sim.positions[rigid].astype(np.float64)
    for body in sim.bodies.values():
        if not len(rigid) or not len(body.samples):
            continue
        places = samples_of(body)
        distance = np.linalg.norm(x[:, None] - places[None], axis=2).min(axis=1)
        closer = distance < nearest
        kinds[rigid[closer]] = body.kind
        nearest[closer] = distance[closer]
    return kinds


def samples_of(body: Body) -> npt.NDArray[np.float64]:
    """The samples of a body where they are."""
    cos, sin = np.cos(body.angle), np.sin(body.angle)
    return np.asarray(body.samples @ np.array([[cos, sin], [-sin, cos]]) + body.position)


def outlined_bodies(sim: Simulation) -> list[str]:
    """Bodies whose samples are not among the particles: fluids meet them by their outlines. Good at the start."""
    rigid = sim.positions[sim.phases == RIGID].astype(np.float64)
    names = []
    for name, body in sim.bodies.items():
        if body.kind == "dynamic" or not len(body.samples):
            continue
        apart = np.linalg.norm(rigid - samples_of(body)[0], axis=1)
        if not len(apart) or apart.min() > 0.01 * sim.spacing:
            names.append(name)
    return names


def particle_types(
    kinds: Sequence[str], materials: Sequence[str], names: Sequence[str], form: str, own: Mapping[str, int]
) -> npt.NDArray[np.int64]:
    """Types in a format: those of the kinds; liquids of GNS by their order; `own` by the name of the material."""
    table: Mapping[str, int] = GNS if form == "gns" else LAGRANGEBENCH
    types = np.array([table[kind] for kind in kinds], dtype=np.int64)
    if form == "gns":
        liquids = [name for name in names if any(k == "liquid" and m == name for k, m in zip(kinds, materials))]
        order = dict(zip(liquids, _LIQUIDS))
        for row, (kind, name) in enumerate(zip(kinds, materials)):
            types[row] = order.get(name, types[row]) if kind == "liquid" else types[row]
    for row, name in enumerate(materials):
        if name in own:
            types[row] = own[name]
    return types


def fluid_rows(kinds: Sequence[str]) -> npt.NDArray[np.bool_]:
    """Which particles are fluid."""
    return np.isin(np.array(kinds), FLUIDS)
