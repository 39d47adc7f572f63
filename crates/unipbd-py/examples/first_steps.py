"""First steps: a column of water collapses, and matplotlib draws what NumPy holds.

    python first_steps.py [picture.png]
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import unipbd as up


def main(path: str = "first_steps.png") -> None:
    scene = up.Scene(name="Dam break", spacing=0.05, duration=1.2)
    scene.add_liquid("water", density=1000.0)
    scene.add_block("water", min=(0, 0), max=(1, 2))
    scene.add_tank(min=(0, 0), max=(4, 3), open=["top"])
    sim = scene.build(seed=7)
    print(sim)

    times, fronts, energies = [], [], []
    for frame in sim.run(fps=20):
        times.append(frame.time)
        fronts.append(float(sim.positions[:, 0].max()))
        energies.append(frame.energy)
        print(f"{frame.time:.2f} s: front at {fronts[-1]:.2f} m, compression {frame.density_error_max:.2%}")

    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    speed = (sim.velocities**2).sum(axis=1) ** 0.5
    x, y = sim.positions.T
    shown = left.scatter(x, y, c=speed, s=6)
    figure.colorbar(shown, ax=left, label="speed [m/s]")
    left.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", title=f"t = {sim.time:.2f} s")
    right.plot(times, fronts)
    right.set(xlabel="time [s]", ylabel="front [m]", title="The front runs along the floor")
    figure.tight_layout()
    figure.savefig(path)
    assert fronts[-1] > 2.5 and energies[-1] < energies[0]


if __name__ == "__main__":
    main(*sys.argv[1:])
