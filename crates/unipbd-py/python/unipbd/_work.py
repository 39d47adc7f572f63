"""Work in many parts: folders that are claimed for a description, parts that are left, processes."""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context, parent_process
from pathlib import Path
from typing import Any, TypeVar

from ._errors import UnipbdError

Result = TypeVar("Result")


def claim(folder: Path, name: str, description: Mapping[str, Any]) -> None:
    """Takes a folder for a description, which is written there; refuses a folder that was taken for another."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    if not path.exists():
        write(path, json.dumps(description, indent=1, sort_keys=True))
        return
    there, wanted = json.loads(path.read_text(encoding="utf-8")), json.loads(json.dumps(description))
    if there != wanted:
        keys = sorted(key for key in {*there, *wanted} if there.get(key) != wanted.get(key))
        raise UnipbdError(f"{folder} holds the results of another file: {', '.join(keys)} differ; choose another folder")


def write(path: Path, data: str | bytes) -> None:
    """Writes a file, wholly or not at all."""
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    part.write_bytes(data.encode("utf-8") if isinstance(data, str) else data)
    os.replace(part, path)


def share(total: int, shard: tuple[int, int]) -> list[int]:
    """The numbers of a shard such as (3, 16): every sixteenth."""
    number, of = shard
    if not 1 <= number <= of:
        raise ValueError(f"a shard is a pair such as (3, 16), not {shard}")
    return list(range(number - 1, total, of))


def processes(jobs: int | None, parts: int) -> int:
    """How many processes to use for this many parts."""
    return max(1, min(jobs or os.cpu_count() or 1, parts))


def run_all(work: Callable[[int], Result], parts: Sequence[int], jobs: int) -> Iterator[Result]:
    """Results in the order in which they get done, by this many processes; by none of its own for one."""
    if jobs == 1:
        yield from map(work, parts)
        return
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn"), initializer=_end_with_parent) as pool:
        futures = [pool.submit(work, part) for part in parts]
        try:
            for future in as_completed(futures):
                yield future.result()
        except BrokenProcessPool:
            raise UnipbdError(
                "a process ended in the middle of its work: it was killed, or ran out of memory; the same call goes on "
                "with what is left, with fewer jobs in less memory") from None
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def _end_with_parent() -> None:
    """Ends this process once its parent was killed: it would wait for work forever, or write beside the next call."""
    parent = parent_process()
    if parent is None:
        return

    def watch() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
