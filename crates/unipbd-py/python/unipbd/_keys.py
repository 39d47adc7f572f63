"""The keys of a scene file, for type checkers and editors."""

from __future__ import annotations

from ._tables import Table, Tables


class Keys:
    """The top-level keys of a scene file: attributes of `Scene`.

    Those that are tables, such as ``scene.solver``, have keys of their own; `Scene.describe` says
    what they mean.
    """

    name: str
    """Title shown by viewers and ``unipbd info``."""
    description: str
    """What the scene shows and what to look at."""
    spacing: float
    """Rest distance between neighbouring particles [m]."""
    duration: float
    """Simulated time of a run [s]."""
    fps: float
    """Frames per simulated second [1/s]."""
    gravity: tuple[float, float]
    """Gravitational acceleration [m/s^2]."""
    seed: int
    """Seed of every random choice."""

    liquid: Tables
    """Liquids, one table each."""
    gas: Tables
    """Gases, one table each."""
    smoke: Tables
    """Smokes, one table each."""
    solid: Tables
    """Solids, one table each."""

    block: Tables
    """Rectangles filled with particles at the start."""
    disc: Tables
    """Discs filled with particles at the start."""
    points: Tables
    """Particles at places given one by one."""
    wave: Tables
    """Waves of the start."""

    tank: Tables
    """Static containers: particles stay inside."""
    obstacle: Tables
    """Static boxes: particles stay outside."""
    half_plane: Tables
    """Static straight walls without end."""
    body: Tables
    """Rigid bodies, one table each."""
    joint: Tables
    """Joints between bodies, or a body and the world."""
    rope: Tables
    """Ropes of points, loose, held, or fixed to bodies."""

    emitter: Tables
    """Sources of particles."""
    injector: Tables
    """Sources of particles at random places of a region."""
    sink: Tables
    """Regions that take particles away."""
    heater: Tables
    """Regions that warm or cool gas."""

    gauge: Tables
    """Numbers that a run reads of itself, once per frame."""

    domain: Table
    """Periodic axes and the region outside which particles are removed."""
    shaking: Table
    """An acceleration that is added to gravity over time."""
    environment: Table
    """The air around an open scene."""
    solver: Table
    """How the constraints are solved."""
    contacts: Table
    """How contacts of bodies are solved."""
    legacy: Table
    """Options of the papers that the project grew from, for comparison."""
    view: Table
    """What pictures show."""
    expect: Table
    """What a run is expected to do; ``unipbd expect`` looks whether it does."""
