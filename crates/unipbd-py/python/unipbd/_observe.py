"""What can be read of a running simulation."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Doubles, Floats, Ids, fixed
from ._material import Material
from ._scene import Scene
from ._threads import thread_count
from ._walls import wall_particles
from ._world import World


class Observable(World):
    """What can be read of a `Simulation`, between two frames.

    Arrays have one row per particle in ascending order of ids, are C-contiguous copies, and cannot
    be written to.
    """

    _native: _native.Solver
    _scene: Scene

    # -- the run -------------------------------------------------------------------------------

    @property
    def scene(self) -> Scene:
        """A copy of the scene this was built from."""
        return self._scene.copy()

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._native.time

    @property
    def frame(self) -> int:
        """Frames done."""
        return self._native.frame

    @property
    def substeps(self) -> int:
        """Substeps done since the start."""
        return self._native.substeps_done

    @property
    def frame_time(self) -> float:
        """Length of a frame [s]."""
        return self._native.frame_time

    @property
    def spacing(self) -> float:
        """Rest distance of particles [m]."""
        return self._native.spacing

    @property
    def seed(self) -> int:
        """Seed of all random choices."""
        return self._native.seed

    @property
    def threads(self) -> int:
        """Most threads in use, to be set at any time. Never changes results."""
        return self._native.threads

    @threads.setter
    def threads(self, threads: int) -> None:
        count = thread_count(threads)
        if count is None:
            raise ValueError("threads must be a whole number, not None")
        self._native.set_threads(count)

    @property
    def memory_bytes(self) -> int:
        """Memory held by particles, lists and indexes [bytes]."""
        return self._native.memory_bytes

    # -- particles -----------------------------------------------------------------------------

    def __len__(self) -> int:
        return self._native.count

    @property
    def positions(self) -> Floats:
        """Positions [m], float32, shape (N, 2)."""
        return self._native.positions()

    @property
    def velocities(self) -> Floats:
        """Velocities [m/s], float32, shape (N, 2)."""
        return self._native.velocities()

    @property
    def ids(self) -> Ids:
        """Ids in ascending order, uint32, shape (N,). Stable, never reused."""
        return self._native.ids()

    @property
    def phases(self) -> npt.NDArray[np.uint8]:
        """Phases, uint8, shape (N,); compare with `unipbd.LIQUID` and the like."""
        return self._native.phases()

    @property
    def material_indices(self) -> npt.NDArray[np.uint16]:
        """Indices into `materials`, uint16, shape (N,)."""
        return self._native.material_indices()

    @property
    def density_errors(self) -> Floats:
        """Density errors C = rho/rho0 - 1, as fractions, float32, shape (N,); 0 where there is no fluid."""
        return self._native.density_errors()

    @property
    def pressures(self) -> Doubles:
        """Pressures over density [m^2/s^2], from the momentum of the last substep, float64, shape (N,)."""
        return self._native.pressures()

    @property
    def temperatures(self) -> Floats | None:
        """Temperatures, float32, shape (N,); None in a scene without gas."""
        return self._native.temperatures()

    @property
    def inverse_masses(self) -> Floats:
        """Inverse masses [1/kg], float32, shape (N,); 0 for kinematic ones, and for smoke."""
        return self._native.inverse_masses()

    @property
    def materials(self) -> Mapping[str, Material]:
        """All materials by name, in the order of `material_indices`."""
        names = [entry[0] for entry in self._native.materials()]
        return {name: Material(self, index) for index, name in enumerate(names)}

    def material(self, name: str) -> Material:
        """The particles of one material. Raises KeyError where there is none of this name."""
        materials = self.materials
        if name not in materials:
            raise KeyError(f"there is no material {name!r}; there are {', '.join(map(repr, materials))}")
        return materials[name]

    def ids_of(self, material: str) -> Ids:
        """Ids of the particles of one material in ascending order, uint32, shape (M,)."""
        return self.material(material).ids

    # -- walls ----------------------------------------------------------------------------

    @property
    def walls(self) -> list[Doubles]:
        """Walls as lines to draw: corners [m], float64, shape (M, 2) each; a closed one ends where it begins."""
        return self._native.walls()

    def wall_particles(self, layers: int = 1) -> Floats:
        """Walls as particles, one spacing apart, the first layer half a spacing behind the surface [m], float32, shape
        (W, 2): what learned simulators want beside `positions`. See `unipbd.datasets.wall_particles`."""
        kept: dict[int, Floats] = self.__dict__.setdefault("_sampled_walls", {})
        if layers not in kept:
            kept[layers] = fixed(wall_particles(self._scene, layers).positions.astype(np.float32))
        return kept[layers]

    def positions_with_walls(self, layers: int = 1) -> Floats:
        """`positions`, and behind them `wall_particles` [m], float32, shape (N + W, 2)."""
        return fixed(np.concatenate([self.positions, self.wall_particles(layers)]))

    # -- numbers -------------------------------------------------------------------------------

    def diagnostics(self) -> dict[str, Any]:
        """The state in numbers: all quantities of docs/diagnostics.md by name.

        Vectors are tuples (x, y); ``counts`` has the particles by phase. ``materials``, ``groups`` (constraint
        groups), ``walls`` (those with a name) and ``gauges`` have a dict of quantities for each name.
        """
        return self._native.diagnostics()

    @property
    def wall_forces(self) -> dict[str, tuple[float, float]]:
        """Mean forces of fluids and bodies in the last frame on the walls that have a ``name`` [N];
        `diagnostics` has them apart, as ``fluid_force`` and ``contact_force``.

        The sides of a tank are ``"NAME left"``, ``"NAME right"``, ``"NAME bottom"`` and ``"NAME top"``.
        """
        walls: dict[str, dict[str, tuple[float, float]]] = self._native.diagnostics()["walls"]
        return {name: wall["force"] for name, wall in walls.items()}

    @property
    def gauges(self) -> dict[str, float]:
        """Readings of the gauges of the scene now, in the unit of their kind: level and front [m], pressure [N/m],
        force [N], flow rate [m^2/s]. NaN where a gauge has nothing to read, as pressures before the first frame.
        """
        return self._native.gauges()

    @property
    def density_error_max(self) -> float:
        """Largest density error C of the fluid, as a fraction."""
        return float(self._native.diagnostics()["density_error_max"])

    @property
    def energy(self) -> float:
        """Kinetic and potential energy [J]."""
        return float(self._native.diagnostics()["energy"])

    @property
    def stages(self) -> list[str]:
        """Names of the stages of a substep of this scene, in order."""
        return self._native.stages()

    @property
    def groups(self) -> list[str]:
        """Names of the constraint groups that report a violation, in solving order."""
        return self._native.groups()

    @property
    def timings(self) -> dict[str, float]:
        """Wall-clock time spent in each stage since the start [s]."""
        return self._native.timings()

    def state_hash(self) -> int:
        """A hash of the whole state: equal hashes go on equally, on any number of threads."""
        return self._native.state_hash()
