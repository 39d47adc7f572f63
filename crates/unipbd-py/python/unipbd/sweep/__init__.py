"""Parameter sweeps: one scene, many values of its keys, one table of results.

    from unipbd import sweep

    table = sweep.run("heights.toml", "results")      # a pandas frame, one row per run

The same on the command line is ``unipbd sweep heights.toml -o results``. For other machinery, such as joblib, Ray, Dask
or submitit, `left` says which runs are to be done and `run_point` does one.
"""

from __future__ import annotations

from .._toml import RecipeError
from ._points import Sweep
from ._run import Progress, left, run, run_point, table, write_table

__all__ = ["Progress", "RecipeError", "Sweep", "left", "run", "run_point", "table", "write_table"]
