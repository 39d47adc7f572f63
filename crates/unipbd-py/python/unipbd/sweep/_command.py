"""`unipbd sweep`: runs a scene over many values of its keys."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from .._options import EXIT_CODES, Line, add_running, guarded, time_text
from ._points import Sweep
from ._run import Progress, rows, run_left, write_table

EXAMPLES = f"""examples:
  unipbd sweep heights.toml -o results
  unipbd sweep heights.toml -o results --set repeats=4 --parquet
  unipbd sweep heights.toml -o results --shard 3/16      one machine of sixteen

{EXIT_CODES}"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command with these arguments; returns the exit code."""
    return guarded(_main, arguments)


def _main(given: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(
        "unipbd sweep", description="Runs a scene over many values of its keys and makes one table of the results.",
        epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sweep", metavar="SWEEP", help="the sweep (.toml)")
    add_running(parser, "repeats=4 or scene.spacing=0.05")
    parser.add_argument("--parquet", action="store_true", help="write results.parquet too; needs pandas and pyarrow")
    options = parser.parse_args(given)
    sweep = Sweep.load(options.sweep, dict(options.changes))
    folder = Path(options.output)
    line = Line()
    progress = None if options.quiet else lambda found: line.show(_text(found), found.done == found.total)
    run_left(sweep, folder, options.shard, options.jobs, progress)
    write_table(folder, folder / "results.csv")
    if options.parquet:
        write_table(folder, folder / "results.parquet")
    found = rows(folder)
    wrong = sum(row["status"] != "done" for row in found)
    print(f"{folder / 'results.csv'}: {len(found)} of {len(sweep)} runs" + (f", {wrong} of them failed" if wrong else ""))
    return 0


def _text(progress: Progress) -> str:
    failed = f", {progress.failed} failed" if progress.failed else ""
    return f"{progress.done}/{progress.total} runs{failed}, {time_text(progress.remaining)} left"
