"""A whole session: load, edit, hook, record, run, save, restore.

    python session.py [folder for what it writes]
"""

import sys
from pathlib import Path

import numpy as np

import unipbd as up

SCENES = Path(__file__).resolve().parents[3] / "scenes"


def main(folder: str = ".") -> None:
    scene = up.Scene.load(SCENES / "open_gas.toml")
    scene.spacing = 0.04
    scene.add_liquid("water", density=900.0)
    scene.materials["water"].density = 1000.0
    print(scene.to_toml()[:120], "...")
    xy = np.stack(np.meshgrid(np.arange(0.5, 1.0, 0.04), np.arange(0.0, 0.4, 0.04)), axis=-1).reshape(-1, 2)
    scene.add_particles("water", positions=xy, velocities=np.zeros_like(xy))
    scene.add_half_plane(point=(0, -0.2), normal=(0, 1))
    sim = scene.build(seed=7, threads=2)

    sim.on_substep(lambda s: s.add_acceleration(-0.5 * s.positions))
    log = Path(folder) / "run.mcap"
    with sim.record(log, fps=60):
        for frame in sim.run(until=0.5, fps=60):
            if frame.number % 10 == 0:
                print(f"{frame.time:.2f} s: {frame.particles} particles, energy {frame.energy:.1f} J")
    print(up.read_log(log))

    liquid = sim.positions[sim.phases == up.LIQUID]
    assert np.array_equal(liquid, sim.material("water").positions)
    with sim.edit() as e:
        e.velocities[sim.ids_of("water")] = 0
        e.remove(sim.positions[:, 1] > 0.6)
        e.add("water", positions=[(0.6, 1.0)], velocities=(0, -1))
    s0 = sim.state()
    sim.step(20)
    h = sim.state_hash()
    sim.restore(s0)
    sim.step(20)
    assert sim.state_hash() == h
    sim.render(Path(folder) / "frame.png")
    print(sim)


if __name__ == "__main__":
    main(*sys.argv[1:])
