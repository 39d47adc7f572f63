"""Sequences of calls in any order, with any values: what goes wrong is an exception, and the simulation goes on.

UNIPBD_FUZZ_CASES sets the number of sequences, UNIPBD_FUZZ_SEED where they begin.
"""

from __future__ import annotations

import math
import os
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import unipbd as up

CASES = int(os.environ.get("UNIPBD_FUZZ_CASES", "60"))
SEED = int(os.environ.get("UNIPBD_FUZZ_SEED", "0"))

# What calls may raise: the package's own errors, and those of Python for what means nothing.
EXPECTED = (up.UnipbdError, ValueError, TypeError, KeyError, IndexError, OverflowError, AttributeError, RuntimeError)

NUMBERS = [0.0, -0.0, 1.0, -1.0, 0.05, 1e-300, 1e3, 1e9, 1e30, -1e30, 1e308, math.inf, -math.inf, math.nan]
WHOLE = [0, 1, 2, 3, 7, 99, -1, 2**31, 2**32 - 1, 2**32, 2**63, 2**64, -(2**63)]


class Boom(Exception):
    """Raised by hooks and groups."""


def scene(dice: random.Random) -> up.Scene:
    made = up.Scene(name="sequence", spacing=0.1, duration=1.0)
    made.add_liquid("water", density=1000.0)
    made.add_block("water", min=(0, 0), max=(0.6, 0.6))
    made.add_tank(min=(0, 0), max=(2, 2))
    if dice.random() < 0.5:
        made.add_gas("air")
        made.add_block("air", min=(1.0, 0), max=(1.4, 0.4))
    if dice.random() < 0.5:
        made.add_body("box", at=(1.6, 0.3), size=(0.2, 0.2))
    return made


def number(dice: random.Random) -> float:
    return dice.choice(NUMBERS) if dice.random() < 0.4 else dice.uniform(0.0, 2.0)


def whole(dice: random.Random) -> int:
    return dice.choice(WHOLE) if dice.random() < 0.4 else dice.randrange(100)


def rows(dice: random.Random, count: int) -> Any:
    if dice.random() < 0.1:
        count += dice.choice([-1, 1])
    return np.array([[number(dice), number(dice)] for _ in range(max(count, 0))]).reshape(-1, 2)


class Player:
    """A simulation and what was kept of it."""

    def __init__(self, dice: random.Random, folder: Path) -> None:
        self.dice = dice
        self.sim = scene(dice).build(seed=dice.randrange(9), threads=1)
        self.states: list[up.State] = []
        self.recordings: list[Any] = []
        self.folder = folder

    def step(self) -> None:
        self.sim.step(self.dice.choice([0, 1, 1, 2, 3, -1]))

    def edit(self) -> None:
        dice, sim = self.dice, self.sim
        with sim.edit() as edit:
            for _ in range(dice.randrange(1, 4)):
                ids = [whole(dice) for _ in range(dice.randrange(1, 4))]
                if dice.random() < 0.7:
                    ids = list(sim.ids[: dice.randrange(1, 4)])
                what = dice.randrange(6)
                if what == 0:
                    edit.positions[ids] = rows(dice, len(ids))
                elif what == 1:
                    edit.velocities[ids] = rows(dice, len(ids))
                elif what == 2:
                    edit.temperatures[ids] = number(dice)
                elif what == 3:
                    edit.remove(ids)
                elif what == 4:
                    name = dice.choice(["water", "air", "nothing", ""])
                    edit.add(name, positions=rows(dice, 3), velocities=(number(dice), number(dice)))
                else:
                    edit.bodies["box"].velocity = (number(dice), number(dice))

    def crowd(self) -> None:
        with self.sim.edit() as edit:
            edit.add("water", positions=np.full((20_000, 2), self.dice.uniform(0.1, 1.9)))

    def save(self) -> None:
        self.states.append(self.sim.state())

    def restore(self) -> None:
        if self.states:
            self.sim.restore(self.dice.choice(self.states))

    def damage(self) -> None:
        data = bytearray(self.sim.state().to_bytes())
        data[self.dice.randrange(len(data))] ^= 1 << self.dice.randrange(8)
        self.sim.restore(up.State.from_bytes(bytes(data)))

    def record(self) -> None:
        path = self.folder / f"{len(self.recordings)}.mcap"
        recording = self.sim.record(path, fields=self.dice.choice(["", "all", "velocity", "nonsense"]))
        recording.__enter__()
        self.recordings.append(recording)

    def stop(self) -> None:
        if self.recordings:
            self.dice.choice(self.recordings).__exit__(None, None, None)

    def hook(self) -> None:
        dice, sim = self.dice, self.sim

        def act(substep: up.Substep) -> None:
            what = dice.randrange(7)
            if what == 0:
                raise Boom
            if what == 1:
                substep.add_acceleration((number(dice), number(dice)))
            elif what == 2:
                substep.add_acceleration(rows(dice, len(substep.ids)))
            elif what == 3:
                substep.set_velocities([whole(dice)], (number(dice), number(dice)))
            elif what == 4:
                sim.step(1)
            elif what == 5:
                substep.bodies["box"].push((number(dice), number(dice)))

        sim.on_substep(act)
        try:
            sim.step(1)
        finally:
            sim.remove_hook(act)

    def group(self) -> None:
        dice = self.dice
        if len(self.sim.groups) > 3:
            return

        def project(projection: up.Projection) -> Any:
            what = dice.randrange(8)
            if what == 0:
                raise Boom
            if what == 1:
                return rows(dice, len(projection.ids))
            return np.full((len(projection.ids), 2), 1e-5) if what == 2 else None

        self.sim.add_group("own", project)

    def look(self) -> None:
        sim, dice = self.sim, self.dice
        assert sim.positions.shape == (len(sim), 2) == sim.velocities.shape
        assert np.isfinite(sim.positions).all()
        assert len(set(sim.ids.tolist())) == len(sim)
        dice.choice([lambda: sim.diagnostics, lambda: sim.pressures, sim.state_hash, lambda: sim.copy(), lambda: repr(sim)])()

    def threads(self) -> None:
        self.sim.threads = self.dice.choice([1, 2, 0, -1, 10**9, "3", None])  # type: ignore[assignment]

    def play(self, calls: int) -> int:
        actions: list[Callable[[], None]] = [
            self.step, self.step, self.edit, self.edit, self.crowd, self.save, self.restore, self.damage, self.record,
            self.stop, self.hook, self.hook, self.group, self.look, self.threads,
        ]  # fmt: skip
        raised = 0
        for _ in range(calls):
            try:
                self.dice.choice(actions)()
            except (*EXPECTED, Boom):
                raised += 1
        for recording in self.recordings:
            recording.__exit__(None, None, None)
        return raised


def test_any_sequence_of_calls_leaves_a_simulation_that_goes_on(tmp_path: Path) -> None:
    raised = 0
    for case in range(SEED, SEED + CASES):
        player = Player(random.Random(case), tmp_path)
        raised += player.play(25)
        player.look()
        for recording in player.recordings:
            assert len(list(up.Log(recording.path))) == recording.frames, f"sequence {case}"
    assert raised > CASES, "mistakes are made"
    print(f"sequences: {CASES} from seed {SEED}, {raised} calls refused")
