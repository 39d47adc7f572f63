"""Fits the viscosity and the density of a liquid to a recorded run, by Gauss-Newton steps with `unipbd.gradient`.

A lid drags a light liquid along, which drags a heavy one; the log holds how fast both run. Means over many particles of
a calm flow are smooth in the parameters; places of single particles in a splash would not be.

    python fit_gradient.py
"""

import tempfile
from pathlib import Path

import numpy as np
import numpy.typing as npt

import unipbd as up

Array = npt.NDArray[np.float64]
FRAMES = 40
KEYS = {"liquid.heavy.density": 1.2, "liquid.heavy.kinematic_viscosity": 0.1}
TRUE = {"liquid.heavy.density": 2.0, "liquid.heavy.kinematic_viscosity": 0.05}


def scene_with(values: dict[str, float]) -> up.Scene:
    """Two liquids between a floor and a lid that slides."""
    scene = up.Scene(spacing=1 / 12, fps=60, gravity=(0, 0))
    scene.add_liquid("light", density=1.0, kinematic_viscosity=0.1, surface="none")
    scene.add_liquid("heavy", density=values["liquid.heavy.density"], surface="none",
                     kinematic_viscosity=values["liquid.heavy.kinematic_viscosity"])
    scene.domain.periodic_x = (0.0, 1.0)
    scene.add_block("heavy", min=(0, 0), max=(1, 0.5))
    scene.add_block("light", min=(0, 0.5), max=(1, 1))
    scene.add_half_plane((0, 0), (0, 1), slip="none")
    scene.add_half_plane((0, 1), (0, -1), slip="none", velocity=(1, 0))
    scene.solver.substeps = 4
    return scene


def record(path: Path) -> Array:
    """Mean speeds of both liquids in a run with the true values, as one would have it from an experiment: a log."""
    sim = scene_with(TRUE).build(seed=1, threads=1)
    with sim.record(path, fields="velocity"):
        sim.step(FRAMES)
    heavy = sim.material_indices == list(sim.materials).index("heavy")
    velocities = [frame.velocities for frame in up.read_log(path)]
    return np.array([[v[~heavy, 0].mean(), v[heavy, 0].mean()] for v in velocities if v is not None])


def watch(sim: up.Simulation) -> list[float]:
    return [float(sim.material(name).velocities[:, 0].mean()) for name in ("light", "heavy")]


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        measured = record(Path(folder) / "run.mcap")
    values = dict(KEYS)
    steps: dict[str, float] | None = None
    for turn in range(5):
        found = up.gradient(lambda rows: np.array(rows) - measured, scene_with(values), values, frames=FRAMES,
                            watch=watch, steps=steps, seed=1)
        if steps is None:
            print("steps that agree:", {key: found.usable[key] for key in values})
            # The search is spared from now on: it cost 29 runs, a turn costs 5.
            steps = found.steps
        # Steps in the logarithm: both values are above 0, and of different size.
        jacobian = found.jacobian() * np.array(list(values.values()))
        change, *_ = np.linalg.lstsq(jacobian, -np.ravel(found.value), rcond=None)
        for key, part in zip(values, np.clip(change, -0.7, 0.7), strict=True):
            values[key] *= float(np.exp(part))
        error = float(np.sqrt(np.mean(found.value**2)))
        words = ", ".join(f"{key} {value:.5g}" for key, value in values.items())
        print(f"turn {turn}: error before {error:.2e}, now {words}")
    for key, value in values.items():
        assert abs(value / TRUE[key] - 1.0) < 0.01, key


if __name__ == "__main__":
    main()
