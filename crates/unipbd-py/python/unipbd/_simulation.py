"""Running simulations."""

from __future__ import annotations

import copy
import html
import logging
import os
from base64 import b64encode
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Doubles, Floats, Ids, points
from ._edit import Edit
from ._phase import Phase
from ._recording import Recording
from ._scene import Scene
from ._state import State
from ._substep import Projection, Substep

logger = logging.getLogger("unipbd")

# Frames differ from a time by rounding only.
_SAME_FRAME = 1e-6


def thread_count(threads: int | None) -> int | None:
    """The number of threads asked for by an argument or by UNIPBD_THREADS; None for all there are."""
    word = os.environ.get("UNIPBD_THREADS", "") if threads is None else str(threads)
    if not word:
        return None
    try:
        count = int(word)
    except ValueError:
        count = 0
    if count < 1:
        name = "UNIPBD_THREADS" if threads is None else "threads"
        raise ValueError(f"{name} must be a whole number of at least 1, not {word!r}")
    return count


@dataclass(frozen=True)
class Frame:
    """Numbers about one frame of a run. They stay what they are when the run goes on."""

    time: float
    """Simulated time at the end of the frame [s]."""
    number: int
    """Frames done, from the start of the run."""
    substeps: int
    """Substeps the frame took."""
    particles: int
    """Number of particles."""
    density_error_mean: float
    """Mean of max(C, 0) over the fluid, C = rho/rho0 - 1, as a fraction."""
    density_error_max: float
    """Largest C, as a fraction."""
    density_error_min: float
    """Smallest C, as a fraction; below 0 where the fluid is thinned."""
    pressure_max: float
    """Largest pressure over density [m^2/s^2]."""
    kinetic_energy: float
    """Kinetic energy [J]."""
    potential_energy: float
    """Potential energy in the gravity of the scene, 0 at the origin [J]."""
    momentum: tuple[float, float]
    """Linear momentum [kg m/s]."""
    angular_momentum: float
    """Angular momentum about the origin [kg m^2/s]."""
    speed_max: float
    """Largest speed of a particle [m/s]."""
    diagnostics: Mapping[str, Any] = field(repr=False)
    """All of these and more, by name: also ``counts``, ``materials`` and ``groups``."""
    timings: Mapping[str, float] = field(repr=False)
    """Wall-clock time spent in each stage since the start of the run [s]."""

    @property
    def energy(self) -> float:
        """Kinetic and potential energy [J]."""
        return self.kinetic_energy + self.potential_energy


class Material:
    """The particles of one material, as they are at each access. See `Simulation.material`."""

    def __init__(self, simulation: Simulation, index: int) -> None:
        self._simulation = simulation
        self._index = index
        name, phase, density, color = simulation._native.materials()[index]
        self.name = name
        """Name in the scene."""
        self.phase = Phase(phase)
        """What its particles are."""
        self.density = density
        """Rest density [kg/m^2]; 0 for smoke."""
        self.color = color
        """Colour in pictures, ``"#rrggbb"``."""

    @property
    def mask(self) -> npt.NDArray[np.bool_]:
        """Which of the simulation's rows are of this material, shape (N,)."""
        mask: npt.NDArray[np.bool_] = self._simulation.material_indices == self._index
        return mask

    @property
    def ids(self) -> Ids:
        """Ids in ascending order, shape (M,)."""
        return self._simulation.ids[self.mask]

    @property
    def positions(self) -> Floats:
        """Positions [m], shape (M, 2)."""
        return self._simulation.positions[self.mask]

    @property
    def velocities(self) -> Floats:
        """Velocities [m/s], shape (M, 2)."""
        return self._simulation.velocities[self.mask]

    @property
    def density_errors(self) -> Floats:
        """Density errors C, as fractions, shape (M,)."""
        return self._simulation.density_errors[self.mask]

    def __len__(self) -> int:
        return int(np.count_nonzero(self.mask))

    def __repr__(self) -> str:
        return f"<{self.phase.name.lower()} {self.name!r}: {len(self)} particles>"


class Body:
    """A rigid body, as it is at each access. See `Simulation.bodies`."""

    def __init__(self, native: _native.Solver, index: int) -> None:
        self._native = native
        self._index = index

    def _motion(self, key: str) -> Any:
        return self._native.body_motion(self._index)[key]

    def _shape(self, key: str) -> Any:
        return self._native.body_shape(self._index)[key]

    @property
    def name(self) -> str:
        """Name in the scene."""
        name: str = self._shape("name")
        return name

    @property
    def kind(self) -> str:
        """``"dynamic"``, ``"kinematic"`` or ``"static"``."""
        kind: str = self._shape("kind")
        return kind

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return float(self._shape("mass"))

    @property
    def inertia(self) -> float:
        """Moment of inertia about the centre of mass [kg m^2]."""
        return float(self._shape("inertia"))

    @property
    def outline(self) -> Doubles:
        """Corners in body coordinates, counter-clockwise [m], shape (M, 2); empty for a disc."""
        outline: Doubles = self._shape("outline")
        return outline

    @property
    def radius(self) -> float:
        """Radius of a disc [m], 0 for a polygon."""
        return float(self._shape("radius"))

    @property
    def position(self) -> Doubles:
        """Centre of mass [m], shape (2,)."""
        position: Doubles = self._motion("position")
        return position

    @property
    def angle(self) -> float:
        """Rotation, counter-clockwise [rad]."""
        return float(self._motion("angle"))

    @property
    def velocity(self) -> Doubles:
        """Velocity of the centre of mass [m/s], shape (2,)."""
        velocity: Doubles = self._motion("velocity")
        return velocity

    @property
    def angular_velocity(self) -> float:
        """Angular velocity, counter-clockwise [rad/s]."""
        return float(self._motion("angular_velocity"))

    @property
    def fluid_force(self) -> Doubles:
        """Mean force of the fluid over the last frame [N], shape (2,)."""
        force: Doubles = self._motion("fluid_force")
        return force

    @property
    def fluid_torque(self) -> float:
        """Mean torque of the fluid about the centre of mass over the last frame [N m]."""
        return float(self._motion("fluid_torque"))

    @property
    def contact_force(self) -> Doubles:
        """Mean force of contacts and joints over the last frame [N], shape (2,)."""
        force: Doubles = self._motion("contact_force")
        return force

    @property
    def contact_torque(self) -> float:
        """Mean torque of contacts and joints over the last frame [N m]."""
        return float(self._motion("contact_torque"))

    @property
    def asleep(self) -> bool:
        """Whether it is held still until something wakes it."""
        return bool(self._motion("asleep"))

    def __repr__(self) -> str:
        x, y = self.position
        return f"<{self.kind} body {self.name!r} at ({x:.3g}, {y:.3g}), angle {self.angle:.3g}>"


class Simulation:
    """A running simulation. Made by `Scene.build`.

    The frame is the unit of time: `step` advances by whole frames of ``1 / scene.fps`` seconds, and
    the solver chooses the substeps within. Stepping releases the interpreter's lock; Ctrl-C stops a
    run between two frames.

    Arrays have one row per particle in ascending order of ids, are copies, and cannot be written
    to. Row i of all arrays taken at the same moment is the same particle; it stays in row i until
    particles are added or removed. Ids are never reused.
    """

    def __init__(
        self,
        scene: Scene,
        seed: int | None = None,
        threads: int | None = None,
        _settled: bool = False,
    ) -> None:
        """Builds the scene; see `Scene.build`."""
        if seed is not None and not 0 <= seed < 2**64:
            raise ValueError(f"seed must be a whole number from 0 to 2^64 - 1, not {seed}")
        self._scene = scene.copy()
        self._native = _native.Solver(self._scene._data, seed, thread_count(threads), _settled)
        self._hooks: list[Callable[[Substep], object]] = []
        self._groups: list[tuple[str, Callable[[Projection], npt.ArrayLike | None]]] = []
        self._recordings: list[Recording] = []

    # -- stepping ------------------------------------------------------------------------------

    def step(self, frames: int = 1) -> None:
        """Advances by this many frames.

        Raises `SolverError` when the simulation diverges. An exception in a hook passes through as
        it is; the simulation then stands between two substeps and can go on.
        """
        if frames < 0:
            raise ValueError(f"frames must not be negative: {frames}")
        hooks = [_call(hook) for hook in self._hooks]
        if not self._recordings:
            self._native.step(frames, hooks)
            self._tell()
            return
        for _ in range(frames):
            self._native.step(1, hooks)
            self._tell()
            for recording in self._recordings:
                recording._after_frame()

    def run(
        self, until: float | None = None, fps: float | None = None, frames: int | None = None
    ) -> Iterator[Frame]:
        """Steps to the time `until` [s] (the scene's duration where left out) and yields a `Frame`
        after every step, `fps` times per simulated second.

        `fps` must divide the frames per second of the scene, which it is where left out. `frames`
        limits the number of frames that are yielded.
        """
        stride = self._stride(fps)
        end = self._scene.duration if until is None else until
        yielded = 0
        while (frames is None or yielded < frames) and self.time < end - _SAME_FRAME * self.frame_time:
            left = (end - self.time) / self.frame_time
            self.step(max(1, min(stride, round(left))))
            yielded += 1
            yield self._frame()

    def _stride(self, fps: float | None) -> int:
        """Frames per step of `fps` steps per second."""
        if fps is None:
            return 1
        ratio = 1.0 / (self.frame_time * fps) if fps > 0 else 0.0
        if ratio < 0.5 or abs(ratio - round(ratio)) > 1e-6 * ratio:
            own = 1.0 / self.frame_time
            raise ValueError(
                f"fps must be a whole fraction of the scene's {own:g} frames per second, not {fps:g}; "
                f"set scene.fps before building to have others"
            )
        return round(ratio)

    def _tell(self) -> None:
        for time, severity, message in self._native.take_events():
            level = logging.WARNING if severity == "warning" else logging.INFO
            logger.log(level, "%.3f s: %s", time, message)

    def _frame(self) -> Frame:
        numbers = self._native.diagnostics()
        names = (
            "time substeps density_error_mean density_error_max density_error_min pressure_max "
            "kinetic_energy potential_energy momentum angular_momentum speed_max"
        )
        fields = {name: numbers[name] for name in names.split()}
        return Frame(
            number=numbers["frame"],
            particles=self._native.count,
            diagnostics=numbers,
            timings=self._native.timings(),
            **fields,
        )

    def on_substep(self, hook: Callable[[Substep], object]) -> Callable[[Substep], object]:
        """Calls `hook` at the start of every substep with a `Substep`; also works as a decorator.

        The hook sees all particles as arrays and can add accelerations and set velocities::

            sim.on_substep(lambda s: s.add_acceleration(-9.0 * s.positions))
        """
        if not callable(hook):
            raise TypeError(f"a hook must be callable, not {type(hook).__name__}")
        self._hooks.append(hook)
        return hook

    def remove_hook(self, hook: Callable[[Substep], object]) -> None:
        """No longer calls `hook`. Raises ValueError where it is not known."""
        self._hooks.remove(hook)

    def add_group(self, name: str, project: Callable[[Projection], npt.ArrayLike | None]) -> None:
        """Adds a constraint group of your own behind those of the scene.

        `project` is called in every iteration of every substep with a `Projection` and returns the
        displacements it wants [m], shape (N, 2), or None. Slow next to the built-in groups, but
        nothing is out of reach.
        """
        if not callable(project):
            raise TypeError(f"project must be callable, not {type(project).__name__}")
        self._native.add_group(name, _project(project))
        self._groups.append((name, project))

    # -- looking -------------------------------------------------------------------------------

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
        """Most threads in use."""
        return self._native.threads

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
    def temperatures(self) -> Floats | None:
        """Temperatures, float32, shape (N,); None in a scene without gas."""
        return self._native.temperatures()

    @property
    def inverse_masses(self) -> Floats:
        """Inverse masses [1/kg], float32, shape (N,); 0 for what a script moves, and for smoke."""
        return self._native.inverse_masses()

    @property
    def materials(self) -> Mapping[str, Material]:
        """All materials by name, in the order of `material_indices`."""
        names = [entry[0] for entry in self._native.materials()]
        return {name: Material(self, index) for index, name in enumerate(names)}

    def material(self, name: str) -> Material:
        """The particles of one material."""
        materials = self.materials
        if name not in materials:
            raise KeyError(f"there is no material {name!r}; there are {', '.join(map(repr, materials))}")
        return materials[name]

    def ids_of(self, material: str) -> Ids:
        """Ids of the particles of one material, shape (M,)."""
        return self.material(material).ids

    @property
    def bodies(self) -> Mapping[str, Body]:
        """Rigid bodies by name."""
        return {name: Body(self._native, index) for index, name in enumerate(self._native.body_names())}

    def diagnostics(self) -> dict[str, Any]:
        """The state in numbers: energies, density errors, momenta, counts, materials, groups."""
        return self._native.diagnostics()

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

    @property
    def memory_bytes(self) -> int:
        """Memory held by particles, lists and indexes [bytes]."""
        return self._native.memory_bytes

    # -- changing ------------------------------------------------------------------------------

    def edit(self) -> Edit:
        """Changes particles between two frames, all at once or not at all::

            with sim.edit() as e:
                e.velocities[sim.ids_of("water")] = 0
                e.remove(sim.positions[:, 1] > 2.0)
                e.add("water", positions=xy, velocities=(0, -1))

        See `help(unipbd.Edit)`.
        """
        return Edit(self)

    # -- state ---------------------------------------------------------------------------------

    def state(self) -> State:
        """This moment: everything the simulation goes on from, bit for bit."""
        return State(self._native.save())

    def restore(self, state: State) -> None:
        """Goes back (or on) to a saved moment of this scene and seed; from there the run goes on bit
        for bit as the saved one did. Raises `StateError` for a state of another scene."""
        if not isinstance(state, State):
            raise TypeError(f"a State is wanted, not {type(state).__name__}")
        self._native.restore(state._state)

    def state_hash(self) -> int:
        """A hash of the whole state: equal hashes go on equally, on any number of threads."""
        return self._native.state_hash()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the state to a file; `load` reads it back."""
        self.state().save(path)

    def load(self, path: str | os.PathLike[str]) -> None:
        """Goes to the state in a file. Raises `StateError` for a damaged or foreign one."""
        self.restore(State.load(path))

    def __getstate__(self) -> dict[str, Any]:
        if self._recordings:
            raise TypeError("a simulation cannot be copied or pickled while it is recorded")
        return {
            "scene": self._scene,
            "seed": self.seed,
            "threads": self.threads,
            "hooks": self._hooks,
            "groups": self._groups,
            "state": self.state(),
        }

    def __setstate__(self, saved: dict[str, Any]) -> None:
        Simulation.__init__(self, saved["scene"], saved["seed"], saved["threads"], _settled=True)
        self._hooks = list(saved["hooks"])
        for name, project in saved["groups"]:
            self.add_group(name, project)
        self.restore(saved["state"])

    def copy(self) -> Simulation:
        """An independent simulation at the same moment, with the same hooks and groups."""
        return copy.copy(self)

    def __deepcopy__(self, memo: dict[int, Any]) -> Simulation:
        return copy.copy(self)

    # -- showing -------------------------------------------------------------------------------

    def record(self, path: str | os.PathLike[str], fps: float | None = None, fields: str = "") -> Recording:
        """Records every frame to an MCAP log while the `with` block lasts, the present one first::

            with sim.record("run.mcap", fps=30):
                sim.step(300)

        `fps` must divide the frames per second of the scene. `fields` names columns to record beside
        positions: ``"velocity,density,temperature"`` or ``"all"``. A file that is there is replaced.
        """
        return Recording(self, Path(path), self._stride(fps), fields)

    def render(
        self,
        path: str | os.PathLike[str] | None = None,
        width: int = 960,
        color_by: str = "material",
        style: str = "surface",
        background: str = "dark",
        view: tuple[tuple[float, float], tuple[float, float]] | None = None,
        time_stamp: bool = True,
    ) -> npt.NDArray[np.uint8]:
        """Draws the present frame, returns the picture, uint8, shape (height, width, 3), and writes
        it to a PNG file where `path` is given.

        `color_by` is ``"material"``, ``"speed"``, ``"density"`` or ``"temperature"``; `style` is
        ``"surface"`` or ``"discs"``; `background` is ``"dark"`` or ``"light"``; `view` is the lower
        left and the upper right corner [m].
        """
        look = {
            "width": width,
            "color_by": color_by,
            "style": style,
            "background": background,
            "view": view,
            "time_stamp": time_stamp,
        }
        if path is not None:
            path = Path(path)
            if path.suffix.lower() != ".png":
                raise ValueError(f"pictures are PNG files: {path}")
            path.write_bytes(self._native.png(look))
        return self._native.pixels(look)

    def _summary(self) -> str:
        counts = [f"{count} {phase}" for phase, count in self._native.counts().items() if count]
        return f"{', '.join(counts) or 'no particles'} at {self.time:.4g} s, {self.substeps} substeps"

    def __repr__(self) -> str:
        title = f" {self._scene.name!r}" if self._scene.name else ""
        return f"<unipbd.Simulation{title}: {self._summary()}>"

    def _repr_html_(self) -> str:
        look = {
            "width": 480,
            "color_by": "material",
            "style": "surface",
            "background": "dark",
            "view": None,
            "time_stamp": True,
        }
        picture = b64encode(self._native.png(look)).decode("ascii")
        title = html.escape(self._scene.name or "Simulation")
        return (
            f"<figure><img alt='{title}' src='data:image/png;base64,{picture}'>"
            f"<figcaption><b>{title}</b>: {html.escape(self._summary())}</figcaption></figure>"
        )


def _call(hook: Callable[[Substep], object]) -> Callable[[_native.Substep], None]:
    def call(native: _native.Substep) -> None:
        hook(Substep(native))

    return call


def _project(
    project: Callable[[Projection], npt.ArrayLike | None],
) -> Callable[[_native.Projection], Doubles | None]:
    def call(native: _native.Projection) -> Doubles | None:
        wanted = project(Projection(native))
        return None if wanted is None else points(wanted, "displacements", ValueError)

    return call
