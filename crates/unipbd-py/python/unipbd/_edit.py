"""Changes of particles between two frames."""

from __future__ import annotations

from functools import cached_property
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Doubles, Ids, fixed, numbers, pair, pairs, plain, points
from ._body_edit import BodyEdit
from ._errors import EditError
from ._phase import Phase
from ._substep import id_list

if TYPE_CHECKING:
    from ._simulation import Simulation


class _Reading(np.ndarray[Any, np.dtype[np.float64]]):
    """What is read from a column: ``e.velocities[ids] *= 2`` changes it in place and sets it, but
    ``e.velocities[ids][0] = v`` would be lost, so it is refused."""

    column = ""

    def __array_finalize__(self, source: Any) -> None:
        if self.base is not None and self.base is source:
            self.column = getattr(source, "column", "")

    def __setitem__(self, key: Any, value: Any) -> None:
        if self.column:
            raise ValueError(f"this is a copy, a change of it is lost: set e.{self.column}[ids] as a whole")
        super().__setitem__(key, value)


class Column:
    """A column of particles to be changed, by id.

    The key is an array of ids, one id, a boolean mask over all particles in ascending order of
    ids, or ``:`` for all but the samples of rigid bodies. Reading gives a copy that refuses writes;
    ``e.velocities[ids] *= 0.5`` works.
    """

    __slots__ = ("_changed", "_edit", "_name", "_values")

    def __init__(self, edit: Edit, name: str, values: Doubles) -> None:
        self._edit = edit
        self._name = name
        self._values = values
        self._changed = np.zeros(len(values), dtype=bool)

    def __getitem__(self, key: Any) -> Doubles:
        values = self._values[self._edit._rows(key)].view(_Reading)
        values.column = self._name
        return values[0] if _is_one(key) else values

    def __setitem__(self, key: Any, value: npt.ArrayLike) -> None:
        rows = self._edit._rows(key)
        if self._values.ndim == 2:
            new = pairs(value, len(rows), self._name, EditError)
        else:
            try:
                new = np.broadcast_to(numbers(value, self._name, EditError), (len(rows),))
            except ValueError as error:
                raise EditError(f"{self._name} do not fit {len(rows)} particles: {error}") from None
        if not np.all(np.isfinite(new)):
            raise EditError(f"{self._name} must be finite numbers")
        self._values[rows] = new
        self._changed[rows] = True

    def __len__(self) -> int:
        return len(self._values)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Doubles:
        return np.array(self._values, dtype=dtype)

    def __repr__(self) -> str:
        return f"<{self._name} of {len(self)} particles, {int(self._changed.sum())} changed>"


class Edit:
    """Changes of particles, bodies, joints, emitters, ropes and gravity, made together when the `with` block ends. See
    `Simulation.edit`.

    Where anything is wrong - an unknown id, a wrong shape, a number that is not finite - an
    `EditError` is raised and nothing has changed; an exception within the block leaves everything
    as it was, too. Values are set first, then particles are removed, then new ones added, then bodies,
    joints, emitters and ropes change in the order of the calls.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._open = False

    def __enter__(self) -> Edit:
        """Opens the edit; what it does not touch is not copied. The changes are made at the end of the block."""
        for name in ("ids", "positions", "velocities", "_temperatures", "bodies", "_free"):
            self.__dict__.pop(name, None)
        native = self._simulation._native
        self._moment = (native.substeps_done, native.count)
        self._world: list[dict[str, Any]] = []
        self._motions: list[tuple[str, list[int], str]] = []
        self._removed: set[int] = set()
        self._added: list[dict[str, Any]] = []
        self._open = True
        self.added: Ids = np.empty(0, dtype=np.uint32)
        """Ids of the particles that were added, after the block."""
        return self

    @cached_property
    def ids(self) -> Ids:
        """Ids before the edit, in ascending order, uint32, shape (N,)."""
        return self._simulation.ids

    @cached_property
    def positions(self) -> Column:
        """Positions [m], to be set by id."""
        return Column(self, "positions", self._simulation.positions.astype(np.float64))

    @cached_property
    def velocities(self) -> Column:
        """Velocities [m/s], to be set by id."""
        return Column(self, "velocities", self._simulation.velocities.astype(np.float64))

    @cached_property
    def _temperatures(self) -> Column | None:
        values = self._simulation.temperatures
        return None if values is None else Column(self, "temperatures", values.astype(np.float64))

    @property
    def temperatures(self) -> Column:
        """Temperatures, to be set by id. Raises `EditError` in a scene without gas."""
        if self._temperatures is None:
            raise EditError("the scene has no gas, so no temperatures")
        return self._temperatures

    @cached_property
    def bodies(self) -> dict[str, BodyEdit]:
        """Rigid bodies by name, to set their ``velocity``, ``angular_velocity``, ``position`` and ``angle``, to
        ``push`` them, and to ``set`` their properties."""
        simulation = self._simulation
        rows = zip(_native.body_roster(simulation._native), simulation.body_poses, simulation.body_velocities, strict=True)
        return {name: BodyEdit(name, number, pose, velocity) for (number, name), pose, velocity in rows}

    @cached_property
    def _free(self) -> npt.NDArray[np.bool_]:
        """Particles that are no samples of a body."""
        return np.not_equal(self._simulation.phases, Phase.RIGID)

    def remove(self, which: Any) -> None:
        """Removes particles: an array of ids, or a boolean mask over all of them."""
        self._removed.update(self.ids[self._rows(which)].tolist())

    def add(
        self,
        material: str,
        positions: npt.ArrayLike,
        velocities: npt.ArrayLike = (0.0, 0.0),
        temperature: float = 0.0,
        motion: str = "free",
    ) -> None:
        """Adds particles of a material at `positions`, shape (N, 2) [m].

        `velocities` [m/s] is one vector or an array of shape (N, 2). With ``motion="kinematic"`` only
        their velocity moves them. Their ids are in `added` after the block.
        """
        where = points(positions, "positions", EditError)
        self._added.append(
            {
                "material": material,
                "positions": where,
                "velocities": pairs(velocities, len(where), "velocities", EditError),
                "temperature": float(temperature),
                "motion": motion,
            }
        )

    def add_block(self, material: str, low: npt.ArrayLike, high: npt.ArrayLike, **values: Any) -> None:
        """Fills a rectangle with particles of a material, from its lower left to its upper right corner [m]."""
        spacing = self._simulation.spacing
        corners = np.array([pair(low, "low", EditError), pair(high, "high", EditError)])
        columns, rows = np.maximum(np.rint((corners[1] - corners[0]) / spacing), 0).astype(int)
        x, y = np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5)
        self.add(material, corners[0] + spacing * np.column_stack([x.ravel(), y.ravel()]), **values)

    # -- bodies, joints, gravity ---------------------------------------------------------------

    @property
    def gravity(self) -> tuple[float, float]:
        """Gravity [m/s^2], to be set."""
        return self._simulation.gravity

    @gravity.setter
    def gravity(self, value: npt.ArrayLike) -> None:
        self._world.append({"change": "gravity", "gravity": pair(value, "gravity", EditError)})

    def add_body(self, name: str, at: npt.ArrayLike, **values: Any) -> None:
        """Adds a rigid body at `at` [m]; the keys are those of ``[[body]]`` in a scene file: one of ``radius``,
        ``size`` and ``outline``, and ``density``, ``velocity``, ``kind`` and so on. The scene may have had no body so
        far."""
        body = {"name": name, "position": pair(at, "at", EditError), **values}
        self._world.append({"change": "add_body", "body": plain(body)})

    def remove_body(self, name: str) -> None:
        """Takes a body away, with its joints."""
        self._world.append({"change": "remove_body", "body": self._body(name)._number})

    def add_joint(self, kind: str, body: str, at: npt.ArrayLike, **values: Any) -> None:
        """Links two bodies, or a body and the world, at a point [m], where they are then; the keys are those of
        ``[[joint]]`` in a scene file. Bodies that this edit adds before can be named."""
        joint = {"kind": kind, "body": body, "at": pair(at, "at", EditError), **values}
        self._world.append({"change": "add_joint", "joint": plain(joint)})

    def remove_joint(self, joint: str | int) -> None:
        """Takes a joint away, by name or by its place in `Simulation.joints`."""
        self._world.append({"change": "remove_joint", "joint": self._joint(joint)})

    def set_motor(self, joint: str | int, speed: float | None, limit: float | None = None) -> None:
        """Changes the motor of a hinge (`speed` in rad/s, `limit` in N m) or slider (m/s, N); without a speed it is
        taken away."""
        change = {"change": "set_motor", "joint": self._joint(joint), "speed": speed, "limit": limit}
        self._world.append(plain(change))

    def _body(self, name: str) -> BodyEdit:
        if name not in self.bodies:
            raise EditError(f"there is no body {name!r}")
        return self.bodies[name]

    def _joint(self, joint: str | int) -> int:
        if not isinstance(joint, str):
            return int(joint)
        for number, known in enumerate(self._simulation.joints):
            if known.name == joint and not known.removed:
                return number
        raise EditError(f"there is no joint {joint!r}")

    # -- emitters, ropes -----------------------------------------------------------------------

    def add_emitter(
        self,
        material: str,
        position: npt.ArrayLike,
        width: float,
        speed: float,
        direction: npt.ArrayLike = (0.0, 1.0),
        **values: Any,
    ) -> None:
        """Adds a nozzle of this width [m] that pushes a material out at this speed [m/s]; the keys are those of
        ``[[emitter]]`` in a scene file, ``name`` among them; ``start`` and ``stop`` are times of the run [s]. Leave room
        for three rows of particles behind its face."""
        emitter = {
            "material": material,
            "position": pair(position, "position", EditError),
            "width": float(width),
            "speed": float(speed),
            "direction": pair(direction, "direction", EditError),
            **values,
        }
        self._world.append({"change": "add_emitter", "emitter": plain(emitter)})

    def change_emitter(
        self,
        emitter: str | int,
        speed: float | None = None,
        temperature: float | None = None,
        on: bool | None = None,
    ) -> None:
        """Changes the speed [m/s] or temperature of an emitter, or switches it on or off from now on. It is named by its
        name or by its place in `Simulation.emitters`."""
        values = {"speed": speed, "temperature": temperature, "on": on}
        self._world.append({"change": "change_emitter", "emitter": self._emitter(emitter), **plain(values)})

    def remove_emitter(self, emitter: str | int) -> None:
        """Takes an emitter away; the particles behind its face are let go."""
        self._world.append({"change": "remove_emitter", "emitter": self._emitter(emitter)})

    def add_rope(self, material: str, start: npt.ArrayLike, end: npt.ArrayLike, **values: Any) -> None:
        """Lays a rope of points of a solid (or liquid) from `start` to `end` [m]; the keys are those of ``[[rope]]`` in a
        scene file: ``length``, ``held``, ``body``, ``from_body``, ``compliance`` and so on. Bodies that this edit adds
        before can be named."""
        ends = {"from": pair(start, "start", EditError), "to": pair(end, "end", EditError)}
        self._world.append({"change": "add_rope", "rope": plain({"material": material, **ends, **values})})

    def cut_rope(self, rope: int, piece: int) -> None:
        """Cuts a rope, named by its place in `Simulation.ropes`, between its points `piece` and ``piece + 1``."""
        self._world.append({"change": "cut_rope", "rope": int(rope), "piece": int(piece)})

    def remove_rope(self, rope: int) -> None:
        """Takes a rope away with its points; its place in `Simulation.ropes` is not given to another."""
        self._world.append({"change": "remove_rope", "rope": int(rope)})

    def _emitter(self, emitter: str | int) -> int:
        if not isinstance(emitter, str):
            return int(emitter)
        for number, known in enumerate(self._simulation.emitters):
            if known.name == emitter and not known.removed:
                return number
        raise EditError(f"there is no emitter {emitter!r}")

    def make_kinematic(self, which: Any) -> None:
        """From now on only their velocity moves these particles, and nothing but you changes it."""
        self._motions.append(("motion", self.ids[self._rows(which)].tolist(), "kinematic"))

    def free(self, which: Any) -> None:
        """Lets kinematic particles go."""
        self._motions.append(("motion", self.ids[self._rows(which)].tolist(), "free"))

    def _rows(self, key: Any) -> npt.NDArray[np.intp]:
        """Rows of the columns of this edit that a key means."""
        if not self._open:
            raise EditError("an edit is used within its with block")
        if isinstance(key, slice):
            if key != slice(None):
                raise EditError("particles are named by ids, by a mask, or all by [:]")
            # Samples of rigid bodies go where their body goes.
            return np.flatnonzero(self._free)
        array = np.asarray(key)
        if array.dtype == bool:
            if array.shape != self.ids.shape:
                raise EditError(f"a mask must have shape {self.ids.shape}, not {array.shape}")
            return np.flatnonzero(array)
        try:
            wanted = np.asarray(id_list(key), dtype=np.int64)
        except ValueError as error:
            raise EditError(str(error)) from None
        if len(np.unique(wanted)) != len(wanted):
            raise EditError("an id is given twice")
        rows = np.searchsorted(self.ids, wanted)
        found = np.zeros(len(wanted), dtype=bool)
        inside = rows < len(self.ids)
        found[inside] = self.ids[rows[inside]] == wanted[inside]
        if not found.all():
            raise EditError(f"there is no particle with id {wanted[~found][0]}")
        return rows

    def _changes(self) -> list[tuple[str, list[int], Any]]:
        changes: list[tuple[str, list[int], Any]] = []
        for name in ("positions", "velocities", "_temperatures"):
            column: Column | None = self.__dict__.get(name)
            if column is not None and column._changed.any():
                values = np.ascontiguousarray(column._values[column._changed])
                changes.append((column._name, self.ids[column._changed].tolist(), values))
        return changes + list(self._motions)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if not self._open or kind is not None:
            self._open = False
            return
        self._open = False
        native = self._simulation._native
        if self._moment != (native.substeps_done, native.count):
            raise EditError("the simulation was stepped or edited within the edit")
        edits: dict[str, BodyEdit] = self.__dict__.get("bodies", {})
        changed = (body for body in edits.values() if body._changed)
        bodies = [(body._number, body.velocity.tolist(), body.angular_velocity) for body in changed]
        world = [change for body in edits.values() for change in body._changes()] + self._world
        first, last = native.apply(self._changes(), sorted(self._removed), self._added, bodies, world)
        self.added = fixed(np.arange(first, last, dtype=np.uint32))


def _is_one(key: Any) -> bool:
    return not isinstance(key, slice) and np.ndim(key) == 0
