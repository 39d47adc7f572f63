"""Phases of particles."""

from __future__ import annotations

from enum import IntEnum


class Phase(IntEnum):
    """What a particle is. Values are those of `Simulation.phases`."""

    LIQUID = 0
    """Resists compression, has a free surface."""
    GAS = 1
    """Resists compression and dilation, carries heat and smoke."""
    SMOKE = 2
    """Follows the flow, pushes nothing."""
    RIGID = 3
    """A sample of a rigid body."""
    SOLID = 4
    """A free point, held by constraints alone."""


LIQUID = Phase.LIQUID
GAS = Phase.GAS
SMOKE = Phase.SMOKE
RIGID = Phase.RIGID
SOLID = Phase.SOLID
