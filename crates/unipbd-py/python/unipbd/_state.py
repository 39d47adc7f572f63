"""Saved moments of simulations."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from . import _native


class State:
    """A saved moment of a simulation: everything it goes on from, bit for bit.

    Made by `Simulation.state`, taken by `Simulation.restore`. Can be pickled, copied, and saved to
    a file with `save`. States are immutable. Bytes and files are read by the version of the format that
    wrote them and by no other: a run goes on bit for bit, or not at all.
    """

    __slots__ = ("_state",)

    def __init__(self, state: _native.State) -> None:
        self._state = state

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._state.time

    @property
    def frame(self) -> int:
        """Frames done."""
        return self._state.frame

    @property
    def step(self) -> int:
        """Substeps done."""
        return self._state.step

    @property
    def particles(self) -> int:
        """Number of particles."""
        return self._state.particles

    def to_bytes(self) -> bytes:
        """The state as bytes, with a version and a checksum."""
        return self._state.to_bytes()

    @classmethod
    def from_bytes(cls, data: bytes) -> State:
        """The state from bytes. Raises `StateError` where they are damaged or something else."""
        return cls(_native.State.from_bytes(data))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the state to a file, whole or not at all."""
        path = Path(path)
        partial = path.with_name(path.name + ".partial")
        partial.write_bytes(self.to_bytes())
        os.replace(partial, path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> State:
        """Reads a state from a file. Raises `StateError` where it is damaged or something else."""
        return cls.from_bytes(Path(path).read_bytes())

    def __reduce__(self) -> tuple[Any, ...]:
        return State.from_bytes, (self.to_bytes(),)

    def __copy__(self) -> State:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> State:
        return self

    def __eq__(self, other: object) -> bool:
        return isinstance(other, State) and self.to_bytes() == other.to_bytes()

    def __hash__(self) -> int:
        return hash((self.step, self.particles))

    def __repr__(self) -> str:
        return f"<unipbd.State at {self.time:.4g} s: {self.particles} particles, substep {self.step}>"
