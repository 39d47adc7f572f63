"""What the commands of this package share: arguments, messages, exit codes."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

from ._errors import UnipbdError
from ._toml import value

EXIT_CODES = """exit codes: 0 done, 1 a file, 2 wrong arguments, 3 a mistake in a file, 4 a run, 5 a figure out of its band,
130 interrupted (the same command goes on)."""


BETWEEN = 0.2
"""Least time between two texts on the line of progress [s]."""


def guarded(work: Callable[[Sequence[str]], int], arguments: Sequence[str] | None) -> int:
    """Runs a command with these arguments, those of the process where left out; returns the exit code."""
    try:
        return work(list(sys.argv[1:] if arguments is None else arguments))
    except UnipbdError as error:
        print(f"error: {error}", file=sys.stderr)
        return 3 if isinstance(error, ValueError) else 4
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("\ninterrupted: the same command goes on from here", file=sys.stderr)
        return 130


def add_running(parser: argparse.ArgumentParser, example: str) -> None:
    """Adds the arguments that say what is changed, and what is run where."""
    parser.add_argument("-o", "--output", metavar="DIR", required=True, help="the folder of the results")
    parser.add_argument("--set", dest="changes", metavar="KEY=VALUE", type=change, action="append", default=[],
                        help=f"a value of the file, such as {example}")
    parser.add_argument("--shard", metavar="K/N", type=shard, default=(1, 1), help="only the K-th of N shares")
    parser.add_argument("--jobs", metavar="N", type=int, help="processes [default: all processors]")
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")


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


class Line:
    """Progress on one line, written anew a few times a second."""

    def __init__(self) -> None:
        self._shown = 0.0

    def show(self, text: str, last: bool) -> None:
        """Shows how far it has come; the `last` text in any case."""
        now = time.monotonic()
        if last or now - self._shown > BETWEEN:
            self._shown = now
            print(f"\r{text}   ", end="\n" if last else "", file=sys.stderr, flush=True)


def size_text(count: float) -> str:
    """A number of bytes."""
    for unit in ("bytes", "kB", "MB", "GB"):
        if count < 1000.0 or unit == "GB":
            break
        count /= 1000.0
    return f"{count:.3g} {unit}"


def time_text(seconds: float) -> str:
    """A time."""
    if seconds < 120.0:
        return f"{seconds:.1f} s" if seconds < 10.0 else f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} h"
