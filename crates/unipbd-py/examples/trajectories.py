"""A data set of trajectories, as learned simulators are trained on: one npz file with all worlds.

    python trajectories.py [trajectories.npz]
"""

import sys

import numpy as np

import unipbd as up

WORLDS, FRAMES = 6, 40


def random_scene(rng: np.random.Generator) -> up.Scene:
    """Two blocks of water, somewhere, thrown somehow."""
    scene = up.Scene(spacing=0.06, fps=60)
    scene.add_liquid("water")
    for left, right in ((0.0, 1.0), (1.2, 2.4)):
        low = rng.uniform(0.0, 0.8)
        corner = (rng.uniform(left, left + 0.2), low)
        far = (corner[0] + rng.uniform(0.4, right - left - 0.2), low + rng.uniform(0.4, 0.8))
        scene.add_block("water", min=corner, max=far, velocity=tuple(rng.uniform(-1.5, 1.5, 2)))
    scene.add_tank(min=(0, 0), max=(2.4, 2.4))
    return scene


def main(path: str = "trajectories.npz") -> None:
    rng = np.random.default_rng(0)
    batch = up.Batch([random_scene(rng) for _ in range(WORLDS)])
    frames = [[world.positions for world in batch]]
    for _ in range(FRAMES):
        batch.step()
        frames.append([world.positions for world in batch])
    # Ids are in ascending order in every array, so row i is the same particle in all frames.
    data = {f"world_{number}": np.stack(columns) for number, columns in enumerate(zip(*frames, strict=True))}
    np.savez_compressed(path, dt=batch[0].frame_time, spacing=batch[0].spacing, **data)  # type: ignore[arg-type]

    with np.load(path) as saved:
        for name, array in saved.items():
            print(f"{name:10s} {str(array.dtype):8s} {array.shape}")
        assert saved["world_0"].shape == (FRAMES + 1, batch.counts[0], 2)


if __name__ == "__main__":
    main(*sys.argv[1:])
