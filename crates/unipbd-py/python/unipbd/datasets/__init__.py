"""Data sets for learned simulators: ``pip install "unipbd[data]"``.

    from unipbd import datasets

    recipe = datasets.Recipe.load("recipes/dam_break.toml")
    datasets.generate(recipe.changed(trajectories=8), "data/dam")
    print(datasets.report("data/dam"))

A recipe is a scene with distributions: what is drawn for each trajectory depends on the seed of the recipe and the
number of the trajectory alone. `generate` writes the layouts of LagrangeBench (HDF5), DeepMind's graph
network simulator (TFRecord) and geoelements/gns (npz); on the command line it is ``unipbd dataset``.
"""

from __future__ import annotations

from .._toml import RecipeError
from .._walls import Walls, wall_particles
from ._checks import Check
from ._generate import Estimate, Progress, assemble, estimate, generate
from ._recipe import Recipe
from ._report import Report, report
from ._statistics import statistics
from ._tfrecord import parse_sequence_example, read_records

__all__ = [
    "Check",
    "Estimate",
    "Progress",
    "Recipe",
    "RecipeError",
    "Report",
    "Walls",
    "assemble",
    "estimate",
    "generate",
    "parse_sequence_example",
    "read_records",
    "report",
    "statistics",
    "wall_particles",
]
