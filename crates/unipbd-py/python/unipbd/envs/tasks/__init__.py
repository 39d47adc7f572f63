"""Tasks for learning environments."""

from __future__ import annotations

from ._task import Memory, Task
from .balance import BalanceTask
from .boat import BoatTask
from .pour import PourTask
from .stir import StirTask

TASKS: dict[str, type[Task]] = {task.name: task for task in (BalanceTask, BoatTask, PourTask, StirTask)}
"""Tasks by name."""

__all__ = ["TASKS", "BalanceTask", "BoatTask", "Memory", "PourTask", "StirTask", "Task"]
