"""Gymnasium environments: ``pip install "unipbd[gym]"``.

    import gymnasium
    import unipbd.envs

    env = gymnasium.make("unipbd/Balance-v0")

Importing this module registers

- ``unipbd/Balance-v0``: keep a top-heavy float upright on moving water, see `Balance`,
- ``unipbd/Pour-v0``: pour water over a wall by tilting the vessel, see `Pour`.

Episodes repeat bit for bit with the same seed and actions.
"""

from __future__ import annotations

try:
    from gymnasium.envs.registration import register
except ImportError:
    raise ImportError('the environments need gymnasium: pip install "unipbd[gym]"') from None

from .balance import Balance
from .pour import Pour

__all__ = ["Balance", "Pour"]

register("unipbd/Balance-v0", entry_point="unipbd.envs.balance:Balance", max_episode_steps=200)
register("unipbd/Pour-v0", entry_point="unipbd.envs.pour:Pour", max_episode_steps=100)
