"""What can go wrong. Every exception is a `UnipbdError` and a fitting builtin."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any


class UnipbdError(Exception):
    """Any error of this package."""

    def __init__(self, message: str = "", **fields: Any) -> None:
        super().__init__(message)
        self.message = message
        self._fields = fields

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (type(self), self.message, self._fields)


def _rebuild(kind: type[UnipbdError], message: str, fields: Mapping[str, Any]) -> UnipbdError:
    return kind(message, **fields)


@dataclass(frozen=True)
class SceneProblem:
    """One thing that is wrong with a scene."""

    key: str
    """Where it is, such as ``emitter[0].position``."""
    message: str
    """What is wrong, with the offending value."""
    hint: str | None = None
    """What to do about it."""
    line: int | None = None
    """Line in the file, from 1; None for a scene that has no file."""
    column: int | None = None
    """Column in the line, from 1."""

    def __str__(self) -> str:
        where = f"{self.key}: " if self.key else ""
        return f"{where}{self.message}" + (f" ({self.hint})" if self.hint else "")


class SceneError(UnipbdError, ValueError):
    """A scene that cannot be built. All its problems are named at once.

    `path`, `line`, `column`, `key` and `hint` are those of the first of `problems`.
    """

    def __init__(
        self, message: str = "", path: str | None = None, problems: Sequence[Mapping[str, Any]] = ()
    ) -> None:
        super().__init__(message, path=path, problems=problems)
        self.path = path
        self.problems: tuple[SceneProblem, ...] = tuple(SceneProblem(**problem) for problem in problems)
        first = self.problems[0] if self.problems else SceneProblem("", message)
        self.line = first.line
        self.column = first.column
        self.key = first.key
        self.hint = first.hint


class SolverError(UnipbdError, ArithmeticError):
    """The simulation diverged. The state is that of the failing substep."""

    def __init__(
        self,
        message: str = "",
        stage: str = "",
        step: int = 0,
        time: float = 0.0,
        particle: int = 0,
        material: str = "",
        world: int | None = None,
    ) -> None:
        super().__init__(
            message, stage=stage, step=step, time=time, particle=particle, material=material, world=world
        )
        self.stage = stage
        """Stage after which it was noticed."""
        self.step = step
        """Substep since the start."""
        self.time = time
        """Simulated time [s]."""
        self.particle = particle
        """Id of the particle."""
        self.material = material
        """Name of its material."""
        self.world = world
        """Index of the world, in a batch."""


class StateError(UnipbdError, ValueError):
    """A saved state that is damaged, foreign, or of another scene."""


class EditError(UnipbdError, ValueError):
    """An edit that cannot be made. Nothing has changed then."""


class RecordingError(UnipbdError, OSError):
    """A log that cannot be written or read."""

    def __str__(self) -> str:
        return self.message


class BusyError(UnipbdError, RuntimeError):
    """The simulation is being stepped, by another thread or by the step that called the hook."""
