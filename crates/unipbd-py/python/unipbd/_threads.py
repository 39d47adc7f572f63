"""How many threads to use."""

from __future__ import annotations

import os


def thread_count(threads: int | None) -> int | None:
    """The number of threads asked for by an argument or by UNIPBD_THREADS; None for all there are."""
    word = os.environ.get("UNIPBD_THREADS", "") if threads is None else str(threads)
    if not word:
        return None
    try:
        count = int(word)
    except ValueError:
        count = 0
    if count < 1:
        name = "UNIPBD_THREADS" if threads is None else "threads"
        raise ValueError(f"{name} must be a whole number of at least 1, not {word!r}")
    return count
