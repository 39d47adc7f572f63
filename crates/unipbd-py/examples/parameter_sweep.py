"""A parameter sweep: how fast does a heavy liquid sink through a light one, over the density ratio?

Eight worlds are stepped together; each has its own density.

    python parameter_sweep.py
"""

import numpy as np

import unipbd as up

RATIOS = np.array([1.0, 1.2, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0])


def scene_with(ratio: float) -> up.Scene:
    """A drop of heavy liquid in the middle of a pool of light liquid."""
    scene = up.Scene(spacing=0.05, duration=0.5)
    scene.add_liquid("light", density=1000.0)
    scene.add_liquid("heavy", density=1000.0 * ratio)
    scene.add_block("light", min=(0, 0), max=(1, 0.5))
    scene.add_block("heavy", min=(0.3, 0.5), max=(0.7, 0.8))
    scene.add_block("light", min=(0, 0.5), max=(0.3, 0.8))
    scene.add_block("light", min=(0.7, 0.5), max=(1, 0.8))
    scene.add_tank(min=(0, 0), max=(1, 2))
    return scene


def main() -> None:
    batch = up.Batch([scene_with(float(ratio)) for ratio in RATIOS], seeds=[1] * len(RATIOS))
    start = [world.material("heavy").positions[:, 1].mean() for world in batch]
    batch.step(30)
    sunk = [before - world.material("heavy").positions[:, 1].mean() for before, world in zip(start, batch, strict=True)]
    for ratio, depth in zip(RATIOS, sunk, strict=True):
        print(f"density ratio {ratio:3.1f}: sunk by {depth:6.3f} m in {batch[0].time:.2f} s")
    assert abs(sunk[0]) < 0.05, "a drop as heavy as the pool stays where it is"
    assert sunk[-1] > sunk[0] + 0.03, "a heavy drop sinks"


if __name__ == "__main__":
    main()
