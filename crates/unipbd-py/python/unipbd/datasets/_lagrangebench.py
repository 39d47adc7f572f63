"""The layout of LagrangeBench 0.2: three HDF5 files, metadata.json, force.py."""

from __future__ import annotations

import importlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from .._errors import UnipbdError
from ._parts import Parts
from ._recipe import SPLITS, Recipe
from ._statistics import periodic_box, statistics

FRAMES_PER_CHUNK = 8
"""A window of a learner is six or seven frames."""


def h5py() -> Any:
    """The module, or an error that says how to get it."""
    try:
        return importlib.import_module("h5py")
    except ImportError:
        raise UnipbdError('HDF5 files need h5py: pip install "unipbd[data]"') from None


def folder_name(parts: Parts) -> str:
    """NAME_PARTICLES_STEPSeverySTRIDE: the loader takes the case from its beginning, such as 2D_DAM."""
    recipe = parts.recipe
    name = "".join(letter if letter.isalnum() or letter in "_-" else "_" for letter in recipe.name)
    return f"{name}_{parts.particles_max}_{_short(recipe.frames)}every{recipe.stride}"


def _short(count: int) -> str:
    return f"{count // 1000}k" if count >= 1000 and count % 1000 == 0 else str(count)


def write(parts: Parts, folder: Path) -> Path:
    """Writes the data set into `folder` and returns its own folder."""
    place = folder / folder_name(parts)
    place.mkdir(parents=True, exist_ok=True)
    for split in SPLITS:
        _write_split(parts, split, place / f"{split}.h5")
    text = json.dumps(metadata(parts), indent=1)
    (place / "metadata.json").write_text(text, encoding="utf-8")
    force = force_module(parts.recipe)
    if force is not None:
        (place / "force.py").write_text(force, encoding="utf-8")
    return place


def _write_split(parts: Parts, split: str, path: Path) -> None:
    # Without times in it, the same data is the same file.
    with h5py().File(path, "w", libver="earliest") as file:
        for number, piece in enumerate(parts.split(split)):
            group = file.create_group(f"{number:05d}", track_times=False)
            shape = piece.positions.shape
            chunks = (min(FRAMES_PER_CHUNK, shape[0]), *shape[1:])
            data = group.create_dataset(
                "position", shape, np.float32, chunks=chunks, compression="gzip", track_times=False)
            for first in range(0, shape[0], FRAMES_PER_CHUNK):
                data[first : first + FRAMES_PER_CHUNK] = piece.positions[first : first + FRAMES_PER_CHUNK]
            group.create_dataset("particle_type", data=piece.types["lagrangebench"], track_times=False)


def metadata(parts: Parts) -> dict[str, Any]:
    """What metadata.json holds; `metadata` of the recipe replaces values."""
    recipe = parts.recipe
    scene = parts.records[0]["scene"]
    dx = float(scene["spacing"])
    trajectories_train, frames_train = parts.frames_of("train")
    trajectories_test, frames_test = parts.frames_of("test")
    fluids = [*scene.get("liquid", []), *scene.get("gas", [])]
    walls = [*scene.get("tank", []), *scene.get("half_plane", []), *scene.get("obstacle", [])]
    found: dict[str, Any] = {
        "case": _case(recipe.name),
        "solver": "unipbd",
        "density_evolution": False,
        "dim": 2,
        "dx": dx,
        "dt": parts.frame_time / recipe.stride,
        "t_end": recipe.frames * parts.frame_time,
        "viscosity": max((float(fluid.get("kinematic_viscosity", 0.0)) for fluid in fluids), default=0.0),
        "p_bg_factor": 0.0,
        "g_ext_magnitude": _force_magnitude(recipe),
        "artificial_alpha": 0.0,
        "free_slip": all(wall.get("slip", "free") == "free" for wall in walls) if walls else False,
        "write_every": recipe.stride,
        "is_bc_trick": False,
        # The last frame is a target alone.
        "sequence_length_train": max(0, frames_train - 1),
        "num_trajs_train": trajectories_train,
        "sequence_length_test": max(0, frames_test - 1),
        "num_trajs_test": trajectories_test,
        "num_particles_max": parts.particles_max,
        "periodic_boundary_conditions": parts.periodic,
        "bounds": parts.bounds,
        "default_connectivity_radius": float(f"{1.45 * dx:.2g}"),
    }
    found.update(recipe.metadata)
    found.update(statistics(_fluid(parts), periodic_box(found)))
    return found


def _fluid(parts: Parts) -> Iterator[tuple[Any, Any]]:
    return ((piece.positions, piece.fluid) for piece in parts.all())


def _case(name: str) -> str:
    return name.split("_")[1].upper() if name[:3] in ("2D_", "3D_") and len(name) > 3 else name


def _force_magnitude(recipe: Recipe) -> float:
    """Size of the acceleration on the fluid [m/s^2]."""
    force = recipe.force or {}
    own = np.linalg.norm(np.asarray(force.get("acceleration", [0.0, 0.0]), dtype=np.float64))
    gravity = np.linalg.norm(np.asarray(recipe.scene.get("gravity", [0.0, -9.81]), dtype=np.float64))
    return float(max(own, gravity))


def force_module(recipe: Recipe) -> str | None:
    """force.py: `force_fn(r)`, the acceleration at one place, as the loader's models call it; None without a force."""
    gravity = [float(part) for part in recipe.scene.get("gravity", [0.0, -9.81])]
    head = '"""The force on the fluid: acceleration [m/s^2] at a place r [m]."""\n\nimport jax.numpy as jnp\n\n\n'
    if recipe.force is not None and recipe.force["kind"] == "reverse":
        pushed = [float(part) for part in recipe.force.get("acceleration", [1.0, 0.0])]
        height = float(recipe.force.get("height", 1.0))
        return head + (
            f"def force_fn(r):\n    force = jnp.array({pushed})\n"
            f"    return jnp.array({gravity}) + jnp.where(r[1] > {height}, -force, force)\n")
    return head + f"def force_fn(r):\n    return jnp.array({gravity})\n" if any(gravity) else None
