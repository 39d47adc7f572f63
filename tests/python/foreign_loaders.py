"""Reads data sets with the loaders of others: LagrangeBench's `H5Dataset` and the `tfrecord` package.

    python foreign_loaders.py lagrangebench DIR SPLIT    prints windows, shape and types
    python foreign_loaders.py tfrecord FILE              prints key, particle types and positions of every record

Runs in an environment of its own (see `test_foreign_loaders.py`). LagrangeBench asks for versions of jax and torch that
few have: what its loader takes from them, a base class and two functions of NumPy, is put in their place.
"""

from __future__ import annotations

import importlib.util
import json
import sys
import types
from pathlib import Path

import numpy as np


def stand_ins() -> None:
    """Modules with the few names that the loader imports."""
    for name in ("jax", "jax.numpy", "torch", "torch.utils", "torch.utils.data", "wget", "cloudpickle"):
        sys.modules[name] = types.ModuleType(name)
    sys.modules["jax"].numpy = sys.modules["jax.numpy"]  # type: ignore[attr-defined]
    sys.modules["jax"].Array = np.ndarray  # type: ignore[attr-defined]
    for name in ("array", "cumsum", "where", "mean", "sqrt", "ones_like", "ndarray"):
        setattr(sys.modules["jax.numpy"], name, getattr(np, name))
    sys.modules["torch"].Generator = object  # type: ignore[attr-defined]
    sys.modules["torch.utils.data"].Dataset = object  # type: ignore[attr-defined]


def lagrangebench_module() -> types.ModuleType:
    """`lagrangebench.data` without the models that the package itself imports."""
    stand_ins()
    found = importlib.util.find_spec("lagrangebench")
    assert found is not None and found.submodule_search_locations is not None
    package = types.ModuleType("lagrangebench")
    package.__path__ = list(found.submodule_search_locations)
    sys.modules["lagrangebench"] = package
    return importlib.import_module("lagrangebench.data")


def read_lagrangebench(folder: str, split: str) -> dict[str, object]:
    data = lagrangebench_module().H5Dataset(split, folder, extra_seq_length=0 if split == "train" else 4)
    stats = importlib.import_module("lagrangebench.data.utils").get_dataset_stats(data.metadata, False, 0.0)
    first, kinds = data[0]
    last, _ = data[len(data) - 1]
    return {
        "name": data.name,
        "windows": int(len(data)),
        "shape": list(first.shape),
        "dtype": str(first.dtype),
        "types": sorted(set(int(kind) for kind in kinds)),
        "first": first[0].tolist(),
        "last": last[-1].tolist(),
        "force": np.asarray(data.external_force_fn(np.array([0.5, 0.5]))).tolist() if data.external_force_fn else None,
        "vel_std": [float(part) for part in stats["velocity"]["std"]],
    }


def read_tfrecord(path: str) -> list[dict[str, object]]:
    reader = importlib.import_module("tfrecord.reader")
    records = []
    for context, lists in reader.sequence_loader(path, None, ["key", "particle_type"], ["position"]):
        frames = [np.frombuffer(bytes(frame), dtype="<f4") for frame in lists["position"]]
        kinds = np.frombuffer(bytes(context["particle_type"]), dtype="<i8")
        records.append({"key": int(context["key"][0]), "types": kinds.tolist(), "frames": len(frames),
                        "first": frames[0].tolist(), "last": frames[-1].tolist()})
    return records


if __name__ == "__main__":
    if sys.argv[1] == "lagrangebench":
        found: object = read_lagrangebench(str(Path(sys.argv[2])), sys.argv[3])
    else:
        found = read_tfrecord(sys.argv[2])
    print(json.dumps(found))
