"""`unipbd dataset`: makes data sets and reports on them."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .._errors import SceneError, UnipbdError
from .._toml import value
from ._generate import Progress, estimate, generate
from ._recipe import Recipe
from ._report import report

EXAMPLES = """examples:
  unipbd dataset recipes/dam_break.toml -o data/dam
  unipbd dataset recipes/dam_break.toml -o data/dam --set trajectories=8 --set frames=100
  unipbd dataset recipes/dam_break.toml -o data/dam --shard 3/16     one machine of sixteen
  unipbd dataset report data/dam

exit codes: 0 done, 1 a file, 2 wrong arguments, 3 a wrong recipe, 4 a run, 5 a figure of the report out of its band,
130 interrupted (the same command goes on)."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command with these arguments (those of the process where left out); returns the exit code."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    try:
        return _report(given[1:]) if given[:1] == ["report"] else _generate(given)
    except UnipbdError as error:
        print(f"error: {error}", file=sys.stderr)
        return 3 if isinstance(error, (ValueError, SceneError)) else 4
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("interrupted: the same command goes on from here", file=sys.stderr)
        return 130


def shard(text: str) -> tuple[int, int]:
    """``3/16`` as a pair."""
    number, slash, of = text.partition("/")
    if not slash or not number.isdigit() or not of.isdigit() or not 1 <= int(number) <= int(of):
        raise argparse.ArgumentTypeError(f"a shard is written 3/16, not {text}")
    return int(number), int(of)


def change(text: str) -> tuple[str, Any]:
    """``key=value`` as a pair."""
    key, equals, written = text.partition("=")
    if not equals or not key.strip():
        raise argparse.ArgumentTypeError(f"a change is written key=value, not {text}")
    return key.strip(), value(written.strip())


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        "unipbd dataset", description="Makes a data set of trajectories for learned simulators from a recipe.",
        epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipe", metavar="RECIPE", help="the recipe (.toml)")
    parser.add_argument("-o", "--output", metavar="DIR", required=True, help="the folder of the data set")
    parser.add_argument("--set", dest="changes", metavar="KEY=VALUE", type=change, action="append", default=[],
                        help="a value of the recipe, such as trajectories=8 or scene.spacing=0.05")
    parser.add_argument("--shard", metavar="K/N", type=shard, default=(1, 1),
                        help="only the K-th of N shares; a call without it puts all together")
    parser.add_argument("--jobs", metavar="N", type=int, help="processes [default: all processors]")
    parser.add_argument("--keep-parts", action="store_true", help="keep the trajectories as they were made")
    parser.add_argument("--dry-run", action="store_true", help="estimate size and time, and make nothing")
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")
    return parser


def _generate(given: Sequence[str]) -> int:
    options = _parser().parse_args(given)
    recipe = Recipe.load(options.recipe, dict(options.changes))
    if options.dry_run or not options.quiet:
        cost = estimate(recipe)
        print(f"{recipe.trajectories} trajectories of about {cost.particles} particles and {recipe.frames + 1} frames: "
              f"{_bytes(cost.bytes)} before compression, about {_time(cost.seconds)} of one core", file=sys.stderr)
    if options.dry_run:
        return 0
    show = None if options.quiet else _show
    made = generate(recipe, options.output, options.shard, options.jobs, show, options.keep_parts)
    if not options.quiet:
        print(file=sys.stderr)
    for folder in made:
        size = sum(path.stat().st_size for path in folder.iterdir())
        print(f"{folder}: {_bytes(size)}")
    if not made:
        number, of = options.shard
        print(f"shard {number} of {of} is done; with all of them in {Path(options.output) / 'parts'}, "
              f"unipbd dataset {options.recipe} -o {options.output} puts them together")
    return 0


def _show(progress: Progress) -> None:
    left = "" if progress.remaining is None else f", {_time(progress.remaining)} left"
    refused = f", {progress.refused} refused" if progress.refused else ""
    print(f"\r{progress.done}/{progress.total} trajectories{refused}{left}   ", end="", file=sys.stderr, flush=True)


def _report(given: Sequence[str]) -> int:
    parser = argparse.ArgumentParser("unipbd dataset report", description="Looks at a data set that was made here.")
    parser.add_argument("folder", metavar="DIR", help="the folder of the data set")
    parser.add_argument("--no-pictures", action="store_true", help="draw nothing")
    options = parser.parse_args(given)
    made = report(options.folder, not options.no_pictures)
    print(made)
    return 0 if made.passed else 5


def _bytes(count: float) -> str:
    for unit in ("bytes", "kB", "MB", "GB"):
        if count < 1000.0 or unit == "GB":
            break
        count /= 1000.0
    return f"{count:.3g} {unit}"


def _time(seconds: float) -> str:
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} h"
