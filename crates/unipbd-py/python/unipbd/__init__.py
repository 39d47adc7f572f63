"""unipbd: a fast, accurate, unified 2D particle solver.

Liquids, gas, smoke and rigid bodies are particles held together by constraints.

    import unipbd as up

    scene = up.Scene.load("scenes/dam_break.toml")
    sim = scene.build(seed=7)
    for frame in sim.run(until=2.0):
        print(frame.time, frame.density_error_max)
    sim.render("frame.png")

Start with `help(up.Scene)` and `help(up.Simulation)`. All quantities are in SI units: lengths in
metres, times in seconds, masses in kilograms, densities in kilograms per square metre (2D).

Arrays are NumPy arrays of shape (N,) or (N, 2), C-contiguous, one row per particle in ascending
order of the particles' ids. They are copies and read-only: they keep showing the moment they were
taken at, and a write into one raises ValueError. To change particles use `Simulation.edit`.
"""

from __future__ import annotations

from ._batch import Batch
from ._body import Body
from ._body_edit import BodyEdit
from ._edit import Column, Edit
from ._errors import (
    BusyError,
    EditError,
    RecordingError,
    SceneError,
    SceneProblem,
    SolverError,
    StateError,
    UnipbdError,
)
from ._frame import Frame
from ._gradient import Gradient, gradient
from ._live import Live
from ._log import Log, LogFrame, read_log
from ._material import Material
from ._native import __version__
from ._phase import GAS, LIQUID, RIGID, SMOKE, SOLID, Phase
from ._recording import Recording
from ._scene import Scene
from ._simulation import Simulation
from ._state import State
from ._substep import Projection, Substep, SubstepBody
from ._world import Contact, ContactEvent, ContactPair, Emitter, Joint, Nearest, RayHit, Rope
from ._tables import Table, Tables

__all__ = [
    "GAS",
    "LIQUID",
    "RIGID",
    "SMOKE",
    "SOLID",
    "Batch",
    "Body",
    "BodyEdit",
    "BusyError",
    "Column",
    "Contact",
    "ContactEvent",
    "ContactPair",
    "Edit",
    "EditError",
    "Emitter",
    "Frame",
    "Gradient",
    "Joint",
    "Live",
    "Log",
    "LogFrame",
    "Material",
    "Nearest",
    "Phase",
    "Projection",
    "RayHit",
    "Recording",
    "RecordingError",
    "Rope",
    "Scene",
    "SceneError",
    "SceneProblem",
    "Simulation",
    "SolverError",
    "State",
    "StateError",
    "Substep",
    "SubstepBody",
    "Table",
    "Tables",
    "UnipbdError",
    "__version__",
    "gradient",
    "read_log",
]
