"""The loaders of others read our data sets. Full tier: an environment of its own is made from the registry."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import install, own_environment
from small_dataset import small

from unipbd import datasets

SCRIPT = Path(__file__).with_name("foreign_loaders.py")


@pytest.fixture(scope="module")
def python(full_tier: bool) -> Path:
    if not full_tier:
        pytest.skip("the full tier makes an environment for it")
    found = own_environment("foreign-loaders", "numpy", "h5py", "tfrecord")
    install(found, "--no-deps", "--ignore-requires-python", "lagrangebench==0.2.0")
    return found


def read(python: Path, *arguments: object) -> Any:
    words = [str(python), str(SCRIPT), *map(str, arguments)]
    return json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("set")
    return {path.name.split("_")[0]: path for path in datasets.generate(small(name="2D_DAM"), folder, jobs=1)}


def test_the_loader_of_lagrangebench_reads_windows_and_statistics(python: Path, made: dict[str, Path]) -> None:
    h5py = pytest.importorskip("h5py")
    folder = made["2D"]
    found = read(python, "lagrangebench", folder, "train")
    metadata = json.loads((folder / "metadata.json").read_text())
    with h5py.File(folder / "train.h5") as file:
        first = file["00000/position"][:7].transpose(1, 0, 2)
        windows = sum(len(file[key]["position"]) - 6 for key in file)
    assert found["name"] == "dam2d" and found["windows"] == windows and found["dtype"] == "float32"
    assert found["shape"] == list(first.shape) and found["types"] == [0, 1]
    np.testing.assert_array_equal(np.array(found["first"], dtype=np.float32), first[0])
    assert found["force"] == [0.0, -9.81]
    np.testing.assert_allclose(found["vel_std"], metadata["vel_std"], rtol=1e-6)
    assert read(python, "lagrangebench", folder, "valid")["windows"] >= 1


def test_the_protocol_buffers_of_others_read_our_records(python: Path, made: dict[str, Path]) -> None:
    records = read(python, "tfrecord", made["gns"] / "train.tfrecord")
    ours = list(datasets.read_records(made["gns"] / "train.tfrecord"))
    assert len(records) == len(ours)
    for record, raw in zip(records, ours, strict=True):
        key, types, positions = datasets.parse_sequence_example(raw)
        assert record["key"] == key and record["types"] == types.tolist() and record["frames"] == len(positions)
        np.testing.assert_array_equal(np.array(record["first"], dtype=np.float32), positions[0].ravel())
        np.testing.assert_array_equal(np.array(record["last"], dtype=np.float32), positions[-1].ravel())
