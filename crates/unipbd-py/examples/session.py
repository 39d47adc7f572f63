"""A whole session: load, edit, hook, record, run, look, edit, save, restore, draw.

    python session.py [folder for what it writes]
"""

import sys
from pathlib import Path

import numpy as np

import unipbd as up

SCENES = Path(__file__).resolve().parents[3] / "scenes"


def scene_with_a_pond() -> up.Scene:
    """The plume of the repository, and beside it a pond with a raft."""
    scene = up.Scene.load(SCENES / "open_gas.toml")
    scene.spacing = 0.04
    scene.add_liquid("water", density=900.0)
    scene.materials["water"].density = 1000.0
    xy = np.stack(np.meshgrid(np.arange(1.22, 2.0, 0.04), np.arange(0.02, 0.4, 0.04)), axis=-1).reshape(-1, 2)
    scene.add_particles("water", positions=xy, velocities=np.zeros_like(xy))
    scene.add_body("raft", outline=[(0, 0), (0.4, 0), (0.4, 0.12), (0, 0.12)], density=400, at=(1.4, 0.4))
    scene.add_half_plane(point=(0, -0.2), normal=(0, 1))
    scene.add_obstacle(min=(1.0, -0.2), max=(2.2, 0.0))
    scene.add_obstacle(min=(1.0, 0.0), max=(1.2, 0.6))
    scene.add_obstacle(min=(2.0, 0.0), max=(2.2, 0.6))
    scene.view.min, scene.view.max = (-1.0, -0.2), (2.2, 2.2)
    return scene


def main(folder: str = ".") -> None:
    scene = scene_with_a_pond()
    assert up.Scene.from_toml(scene.to_toml()) == scene
    sim = scene.build(seed=7, threads=2)

    center = np.array([1.6, 0.2], dtype=np.float32)
    sim.on_substep(lambda s: s.add_acceleration(-0.5 * (s.positions - center)))
    log = Path(folder) / "run.mcap"
    with sim.record(log, fps=60):
        for frame in sim.run(until=0.5, fps=60):
            if frame.number % 10 == 0:
                slowest = max(frame.timings, key=lambda stage: frame.timings[stage])
                print(f"{frame.time:.2f} s: {frame.particles} particles, compression {frame.density_error_max:.1%},")
                print(f"        energy {frame.energy:.1f} J, most time in {slowest}")
    print(up.read_log(log))

    liquid = sim.positions[sim.phases == up.LIQUID]
    assert np.array_equal(liquid, sim.material("water").positions)
    print("mean velocity of the water:", sim.material("water").velocities.mean(axis=0))
    raft = sim.bodies["raft"]
    print(raft, "velocity", raft.velocity, "force of the water", raft.fluid_force, "torque", raft.fluid_torque)

    with sim.edit() as e:
        e.velocities[sim.ids_of("water")] = 0
        e.remove(sim.ids_of("smoke"))
        e.add("water", positions=[(1.8, 0.8)], velocities=(0, -1))
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
