"""World-frames per second of learning environments: many worlds in a batch against as many single ones, and what a
reset costs.

    python benches/python/environments.py [worlds]

Both take turns in one run: compare them with each other, not with those of another day.
"""

import sys
import time

import numpy as np

from unipbd.envs import TASKS, BatchEnv, TaskEnv

FRAMES, RESETS = 60, 10


def main(worlds: str = "8") -> None:
    count = int(worlds)
    print(f"{count} worlds: world-frames per second in a batch, in single environments, and a reset in frames")
    for task in TASKS:
        batch, single = BatchEnv(task, count), [TaskEnv(task) for _ in range(count)]
        batch.reset(seed=0)
        for number, env in enumerate(single):
            env.reset(seed=number)
        random = np.random.default_rng(0)
        together = apart = 0.0
        for _ in range(FRAMES):
            actions = random.uniform(-0.2, 0.2, (count, batch.task.actions)).astype(np.float32)
            started = time.perf_counter()
            batch.step(actions)
            between = time.perf_counter()
            for env, action in zip(single, actions, strict=True):
                env.step(action)
            together += between - started
            apart += time.perf_counter() - between
        resets = []
        for _ in range(RESETS):
            started = time.perf_counter()
            batch.reset()
            resets.append((time.perf_counter() - started) / count)
        frames = FRAMES * count
        print(f"{task:8} {frames / together:7.0f} {frames / apart:7.0f}  ratio {apart / together:4.2f}, "
              f"a reset {min(resets) / (apart / frames):4.2f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
