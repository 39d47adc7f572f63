"""The layouts of data sets: LagrangeBench, DeepMind's TFRecord, npz."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from small_dataset import POOL, lagrangebench, small

from unipbd import datasets
from unipbd.datasets._tfrecord import crc32c, masked_crc, sequence_example

h5py = pytest.importorskip("h5py")


def test_the_layout_is_that_of_lagrangebench(small_set: Path) -> None:
    folder = lagrangebench(small_set)
    metadata = json.loads((folder / "metadata.json").read_text())
    keys = (
        "case solver density_evolution dim dx dt t_end viscosity p_bg_factor g_ext_magnitude artificial_alpha free_slip "
        "write_every is_bc_trick sequence_length_train num_trajs_train sequence_length_test num_trajs_test "
        "num_particles_max periodic_boundary_conditions bounds default_connectivity_radius vel_mean vel_std acc_mean acc_std"
    ).split()
    assert list(metadata) == keys
    largest, moved, changed = 0, [], []
    for split in ("train", "valid", "test"):
        with h5py.File(folder / f"{split}.h5") as file:
            assert list(file) == ["00000", "00001"]
            for group in file.values():
                position, kind = group["position"], group["particle_type"][:]
                assert position.shape == (10, len(kind), 2) and position.dtype == np.float32
                assert position.compression == "gzip" and kind.dtype.kind == "i" and set(kind) <= {0, 1, 3}
                largest = max(largest, len(kind))
                v = np.diff(position[:][:, kind == 0].astype(np.float64), axis=0)
                moved.append(v)
                changed.append(np.diff(v, axis=0))
    assert metadata["num_particles_max"] == largest and folder.name == f"2D_POOL_{largest}_9every1"
    assert metadata["num_trajs_train"] == metadata["num_trajs_test"] == 2
    assert metadata["sequence_length_train"] == metadata["sequence_length_test"] == 9
    assert metadata["default_connectivity_radius"] == pytest.approx(0.145, abs=0.006) and metadata["dx"] == 0.1
    for name, values in (("vel", moved), ("acc", changed)):
        mean = np.mean([part.mean(axis=(0, 1)) for part in values], axis=0)
        std = np.sqrt(np.mean([((part - mean) ** 2).mean(axis=(0, 1)) for part in values], axis=0))
        np.testing.assert_allclose(metadata[f"{name}_mean"], mean, rtol=1e-9, atol=1e-15)
        np.testing.assert_allclose(metadata[f"{name}_std"], std, rtol=1e-9)
    assert "def force_fn(r):" in (folder / "force.py").read_text()
    assert re.search(r"(?:2D|3D)_[A-Z]{3}", folder.name)


def test_all_formats_hold_the_same_trajectories(small_set: Path) -> None:
    metadata = json.loads((small_set / "gns" / "metadata.json").read_text())
    for split in ("train", "valid", "test"):
        with h5py.File(lagrangebench(small_set) / f"{split}.h5") as file, np.load(
            small_set / "npz" / f"{split}.npz", allow_pickle=True
        ) as npz:
            records = list(datasets.read_records(small_set / "gns" / f"{split}.tfrecord"))
            assert len(file) == len(records) == len(npz.files)
            for number, (group, record, key) in enumerate(zip(file.values(), records, npz.files, strict=True)):
                index, types, positions = datasets.parse_sequence_example(record)
                assert index == number and positions.shape[0] == metadata["sequence_length"] + 1
                np.testing.assert_array_equal(positions, group["position"][:])
                stored, kinds = npz[key]
                np.testing.assert_array_equal(stored, positions)
                np.testing.assert_array_equal(kinds, types)
                table = {0: 5, 1: 3, 3: 0}
                assert types.tolist() == [table[kind] for kind in group["particle_type"][:]]


def test_checksums_and_messages_are_those_of_the_format() -> None:
    assert crc32c(b"123456789") == 0xE3069283 and crc32c(b"") == 0
    assert crc32c(bytes(32)) == 0x8A9136AA and crc32c(bytes(range(32))) == 0x46DD794E
    slow = 0xFFFFFFFF
    data = np.random.default_rng(0).bytes(5000)
    for byte in data:
        slow ^= byte
        for _ in range(8):
            slow = slow >> 1 ^ (0x82F63B78 if slow & 1 else 0)
    assert crc32c(data) == slow ^ 0xFFFFFFFF
    crc = crc32c(data)
    assert masked_crc(data) == ((crc >> 15 | crc << 17 & 0xFFFFFFFF) + 0xA282EAD8) % 2**32
    example = sequence_example(3, np.array([5]), [np.array([[1.0, 2.0]], dtype=np.float32)])
    types, frame = (5).to_bytes(8, "little"), np.array([1.0, 2.0], dtype="<f4").tobytes()
    context = b"\x0a\x0c" + b"\x0a\x03key\x12\x05\x1a\x03\x0a\x01\x03"
    context += b"\x0a\x1d" + b"\x0a\x0dparticle_type\x12\x0c\x0a\x0a\x0a\x08" + types
    lists = b"\x0a\x1a\x0a\x08position\x12\x0e\x0a\x0c\x0a\x0a\x0a\x08" + frame
    assert example == b"\x0a" + bytes([len(context)]) + context + b"\x12" + bytes([len(lists)]) + lists


def test_a_damaged_record_is_noticed(small_set: Path, tmp_path: Path) -> None:
    data = bytearray((small_set / "gns" / "test.tfrecord").read_bytes())
    data[200] ^= 1
    (tmp_path / "test.tfrecord").write_bytes(data)
    with pytest.raises(ValueError, match="damaged"):
        list(datasets.read_records(tmp_path / "test.tfrecord"))


def test_bodies_have_the_type_of_their_kind(tmp_path: Path) -> None:
    scene = {**POOL["scene"], "body": [
        {"name": "paddle", "kind": "kinematic", "size": [0.4, 0.3], "position": [1.6, 0.5]},
        {"name": "rock", "kind": "static", "radius": 0.2, "position": [1.3, 1.3]},
        {"name": "ball", "radius": 0.2, "position": [0.5, 1.5]},
    ]}
    datasets.generate(small(scene=scene, scatter=[], trajectories=3, frames=2), tmp_path, jobs=1)
    with h5py.File(lagrangebench(tmp_path) / "train.h5") as file:
        position, kind = file["00000/position"][0], file["00000/particle_type"][:]
    near = {2: ([1.6, 0.5], 0.26), 3: ([0.5, 1.5], 0.21)}
    for value, (middle, radius) in near.items():
        assert (kind == value).sum() >= 8
        assert np.linalg.norm(position[kind == value] - middle, axis=1).max() < radius
    rock = (kind == 1) & (np.linalg.norm(position - [1.3, 1.3], axis=1) < 0.21)
    assert rock.sum() >= 8


def test_one_long_run_is_cut_in_time(tmp_path: Path) -> None:
    datasets.generate(small(trajectories=1, frames=19, cut="frames", scatter=[], warm_up=0.1), tmp_path, jobs=1)
    metadata = json.loads((lagrangebench(tmp_path) / "metadata.json").read_text())
    lengths = []
    for split in ("train", "valid", "test"):
        with h5py.File(lagrangebench(tmp_path) / f"{split}.h5") as file:
            lengths.append(len(file["00000/position"]))
    assert lengths == [10, 5, 5] and metadata["sequence_length_train"] == 9 and metadata["sequence_length_test"] == 4
