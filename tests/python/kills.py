"""A command that is killed: nothing can be tidied up."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable

from commands import COMMAND

PATIENCE = 120.0
"""Longest wait for a command that makes no progress [s]: a hung test ends there."""


def killed(arguments: list[object], enough: Callable[[], bool]) -> None:
    """Runs `unipbd` with these arguments and kills it as soon as enough is done."""
    kill_when([*COMMAND, *map(str, arguments)], enough)


def kill_when(words: list[str], enough: Callable[[], bool]) -> None:
    """Runs a command and kills it as soon as enough is done. Returns when its workers are gone: they hold the other end
    of its output."""
    run = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    started = time.monotonic()
    while not enough():
        assert run.poll() is None, f"it ended by itself: {run.communicate()[0]}"
        assert time.monotonic() - started < PATIENCE
        time.sleep(0.002)
    run.kill()
    run.communicate(timeout=PATIENCE)
