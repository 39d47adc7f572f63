"""Settled starts, made once for each scene."""

from __future__ import annotations

from collections import OrderedDict

from .._scene import Scene
from .._simulation import Simulation
from .._state import State
from .tasks import Task

KEPT = 64
"""Starts in memory."""
_starts: OrderedDict[tuple[str, str], State] = OrderedDict()


def settled(task: Task, scene: Scene) -> State:
    """The state from which episodes of a task start in this scene."""
    key = (task.name, scene.to_toml())
    if key not in _starts:
        sim = Simulation(scene, seed=0, threads=1)
        task.settle(sim)
        _starts[key] = sim.state()
        while len(_starts) > KEPT:
            _starts.popitem(last=False)
    _starts.move_to_end(key)
    return _starts[key]
