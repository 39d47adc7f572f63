"""Gymnasium environments: ``pip install "unipbd[gym]"``.

    import gymnasium
    import unipbd.envs

    env = gymnasium.make("unipbd/Balance-v0")
    envs = gymnasium.make_vec("unipbd/Stir-v0", num_envs=16, vectorization_mode="vector_entry_point")

Importing this module registers ``unipbd/Balance-v0``, ``unipbd/Pour-v0``, ``unipbd/Stir-v0`` and ``unipbd/HoldBoat-v0``:
tasks that run in one world (`TaskEnv`) or in many at once (`BatchEnv`), shown as numbers, grids, points or probes; see
`unipbd.envs.tasks`. Episodes repeat bit for bit with the same seed and actions.
"""

from __future__ import annotations

try:
    from gymnasium.envs.registration import register
except ImportError:
    raise ImportError('the environments need gymnasium: pip install "unipbd[gym]"') from None

from ._batch import BatchEnv
from ._single import TaskEnv
from .tasks import TASKS

__all__ = ["TASKS", "BatchEnv", "TaskEnv"]

_NAMES = {"balance": "Balance", "pour": "Pour", "stir": "Stir", "boat": "HoldBoat"}
for _task, _name in _NAMES.items():
    register(
        f"unipbd/{_name}-v0",
        entry_point="unipbd.envs:TaskEnv",
        vector_entry_point="unipbd.envs:BatchEnv",
        max_episode_steps=TASKS[_task].horizon,
        kwargs={"task": _task},
    )
