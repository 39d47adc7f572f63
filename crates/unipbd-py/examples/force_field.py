"""A custom force field: a ball of liquid, without gravity, in a whirl about a centre that pulls.

    python force_field.py [picture.png]
"""

import sys

import numpy as np

import unipbd as up


def main(path: str = "force_field.png") -> None:
    scene = up.Scene(name="Whirl", spacing=0.05, gravity=(0, 0), duration=1.0)
    scene.add_liquid("water", xsph=0.02)
    scene.add_disc("water", center=(0, 0), radius=0.8)
    sim = scene.build(seed=1)

    @sim.on_substep
    def whirl(s: up.Substep) -> None:
        x, y = s.positions.T
        pull = -12.0 * s.positions
        turn = 6.0 * np.stack([-y, x], axis=1) * np.exp(-((s.time / 0.5) ** 2))
        s.add_acceleration(pull + turn)

    for frame in sim.run(fps=10):
        print(f"{frame.time:.1f} s: angular momentum {frame.angular_momentum:8.1f} kg m^2/s")
    sim.render(path, color_by="speed")
    assert frame.angular_momentum > 0
    assert np.linalg.norm(sim.positions, axis=1).max() < 1.3


if __name__ == "__main__":
    main(*sys.argv[1:])
