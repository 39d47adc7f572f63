"""`unipbd dataset`: makes data sets and reports on them."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from .._options import EXIT_CODES, Line, add_running, guarded, size_text, time_text
from .._work import processes, share
from ._generate import Progress, estimate, generate
from ._recipe import Recipe
from ._report import report

EXAMPLES = f"""examples:
  unipbd dataset recipes/dam_break.toml -o data/dam
  unipbd dataset recipes/dam_break.toml -o data/dam --set trajectories=8 --set frames=100
  unipbd dataset recipes/dam_break.toml -o data/dam --shard 3/16     one machine of sixteen
  unipbd dataset recipes/dam_break.toml -o data/dam                  puts the shards together
  unipbd dataset report data/dam

{EXIT_CODES}"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command with these arguments; returns the exit code."""
    return guarded(_main, arguments)


def _main(given: Sequence[str]) -> int:
    return _report(given[1:]) if given[:1] == ["report"] else _generate(given)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        "unipbd dataset", description="Makes a data set of trajectories for learned simulators from a recipe.",
        epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipe", metavar="RECIPE", help="the recipe (.toml)")
    add_running(parser, "trajectories=8 or scene.spacing=0.05")
    parser.add_argument("--keep-parts", action="store_true", help="keep the trajectories as they were made")
    parser.add_argument("--dry-run", action="store_true", help="estimate size and time, and make nothing")
    return parser


def _generate(given: Sequence[str]) -> int:
    options = _parser().parse_args(given)
    recipe = Recipe.load(options.recipe, dict(options.changes))
    if options.dry_run or not options.quiet:
        cost, number = estimate(recipe), len(share(recipe.trajectories, options.shard))
        wall = cost.seconds * number / recipe.trajectories / processes(options.jobs, os.cpu_count() or 1)
        part = "" if options.shard == (1, 1) else f"; this shard makes {number} of them"
        print(f"{recipe.trajectories} trajectories of about {cost.particles} particles and {recipe.frames + 1} frames{part}: "
              f"{size_text(cost.bytes)} before compression, about {time_text(wall)} here "
              f"({time_text(cost.seconds)} of one core for all)", file=sys.stderr)
    if options.dry_run:
        return 0
    line = Line()
    progress = None if options.quiet else lambda found: line.show(_text(found), found.done == found.total)
    made = generate(recipe, options.output, options.shard, options.jobs, progress, options.keep_parts)
    for folder in made:
        size = sum(path.stat().st_size for path in folder.iterdir())
        print(f"{folder}: {size_text(size)}")
    if not made:
        number, of = options.shard
        print(f"shard {number} of {of} is done; with all of them in {Path(options.output) / 'parts'}, "
              f"unipbd dataset {options.recipe} -o {options.output} puts them together")
    return 0


def _text(progress: Progress) -> str:
    left = "" if progress.remaining is None else f", {time_text(progress.remaining)} left"
    refused = f", {progress.refused} refused" if progress.refused else ""
    part = f" and {progress.part:.1%} of the next" if progress.part else ""
    return f"{progress.done}/{progress.total} trajectories{part}{refused}{left}"


def _report(given: Sequence[str]) -> int:
    parser = argparse.ArgumentParser("unipbd dataset report", description="Looks at a data set that was made here.")
    parser.add_argument("folder", metavar="DIR", help="the folder of the data set")
    parser.add_argument("--no-pictures", action="store_true", help="draw nothing")
    options = parser.parse_args(given)
    made = report(options.folder, not options.no_pictures)
    print(made)
    return 0 if made.passed else 5
