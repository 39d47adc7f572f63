"""World-frames per second of learning environments: many worlds in a batch against as many single ones, and what a
reset costs.

    python benches/python/environments.py [worlds] [threads]

Both take turns in one run: compare them with each other, not with those of another day. On a machine with other work the
processor time tells more than the time that has passed: a batch that had one processor is no faster than single
environments. `busy` is how many processors the batch had on average.
"""

import sys
import time
from collections.abc import Callable

import numpy as np

from unipbd.envs import TASKS, BatchEnv, TaskEnv

FRAMES, RESETS = 60, 10


class Clock:
    """Time that has passed, and processor time of all threads [s]."""

    def __init__(self) -> None:
        self.wall = self.processor = 0.0

    def of(self, work: Callable[[], object]) -> None:
        """Adds what this takes."""
        wall, processor = time.perf_counter(), time.process_time()
        work()
        self.wall += time.perf_counter() - wall
        self.processor += time.process_time() - processor


def measure(task: str, count: int, threads: int | None) -> tuple[Clock, Clock, float]:
    """What a batch and single environments take, and the time of a reset of one world [s]."""
    envs, single = BatchEnv(task, count, threads=threads), [TaskEnv(task) for _ in range(count)]
    envs.reset(seed=0)
    for number, env in enumerate(single):
        env.reset(seed=number)
    random = np.random.default_rng(0)
    together, apart = Clock(), Clock()
    for _ in range(FRAMES):
        actions = random.uniform(-0.2, 0.2, (count, envs.task.actions)).astype(np.float32)
        together.of(lambda actions=actions: envs.step(actions))  # type: ignore[misc]
        apart.of(lambda actions=actions: [env.step(action) for env, action in zip(single, actions)])  # type: ignore[misc]
    resets = [Clock() for _ in range(RESETS)]
    for reset in resets:
        reset.of(envs.reset)
    return together, apart, min(reset.processor for reset in resets) / count


def main(worlds: str = "16", threads: str = "") -> None:
    count = int(worlds)
    print(f"{count} worlds      world-frames/s   processor time    busy  reset")
    print("          batch  single  ratio   us/frame, both")
    frames = FRAMES * count
    for task in TASKS:
        together, apart, reset = measure(task, count, int(threads) if threads else None)
        micro = [1e6 * clock.processor / frames for clock in (together, apart)]
        print(f"{task:8} {frames / together.wall:6.0f} {frames / apart.wall:7.0f} {apart.wall / together.wall:6.2f} "
              f"{micro[0]:8.0f} {micro[1]:7.0f} {together.processor / together.wall:7.2f} "
              f"{1e6 * reset / micro[1]:6.2f} frames", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
