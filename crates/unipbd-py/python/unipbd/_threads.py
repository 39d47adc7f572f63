"""How many threads to use."""

from __future__ import annotations

from . import _native


def thread_count(threads: int | None) -> int | None:
    """The number of threads asked for by an argument or by UNIPBD_THREADS; None for all there are.

    The rule is that of the command line: a whole number from 1 to 4096, and an empty variable is none.
    """
    return _native.thread_count(None if threads is None else str(threads))
