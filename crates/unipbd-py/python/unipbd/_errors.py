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
        return _rebuild, (type(self), self.message, {name: getattr(self, name) for name in self._fields})


def _rebuild(kind: type[UnipbdError], message: str, fields: Mapping[str, Any]) -> UnipbdError:
    return kind(message, **fields)


@dataclass(frozen=True)
class SceneProblem:
    """One thing that is wrong with a scene.

    Attributes:
        key: where it is, such as ``emitter[0].position``.
        message: what is wrong, with the offending value.
        hint: what to do about it.
        line: line in the file, from 1; None for a scene that has no file.
        column: column in the line, from 1.
    """

    key: str
    message: str
    hint: str | None = None
    line: int | None = None
    column: int | None = None

    def __str__(self) -> str:
        where = f"{self.key}: " if self.key else ""
        return f"{where}{self.message}" + (f" ({self.hint})" if self.hint else "")


class SceneError(UnipbdError, ValueError):
    """A scene that cannot be built. All its problems are named at once.

    Attributes:
        problems: all that is wrong, each a `SceneProblem`.
        path: the file; None for a scene that has no file.
        line, column, key, hint: those of the first problem.
    """

    def __init__(
        self, message: str = "", path: str | None = None, problems: Sequence[Mapping[str, Any] | SceneProblem] = ()
    ) -> None:
        super().__init__(message, path=path, problems=problems)
        self.path = path
        made = (problem if isinstance(problem, SceneProblem) else SceneProblem(**problem) for problem in problems)
        self.problems: tuple[SceneProblem, ...] = tuple(made)
        first = self.problems[0] if self.problems else SceneProblem("", message)
        self.line = first.line
        self.column = first.column
        self.key = first.key
        self.hint = first.hint


class SolverError(UnipbdError, ArithmeticError):
    """The simulation diverged. The state is that of the failing substep.

    Attributes:
        stage: stage after which it was noticed.
        step: substep since the start.
        time: simulated time [s].
        particle: id of the particle.
        material: name of its material.
        world: index of the world, in a batch.
    """

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
        self.step = step
        self.time = time
        self.particle = particle
        self.material = material
        self.world = world


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
