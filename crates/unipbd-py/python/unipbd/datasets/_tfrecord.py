"""TFRecord files with SequenceExamples, without TensorFlow.

A record is its length (8 bytes), the masked CRC-32C of the length, the data, and the masked CRC-32C of the data.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

_POLYNOMIAL = 0x82F63B78
"""Of CRC-32C (Castagnoli), reflected."""

Words = npt.NDArray[np.uint32]


def _table() -> Words:
    value = np.arange(256, dtype=np.uint32)
    for _ in range(8):
        value = np.where(value & 1, (value >> 1) ^ np.uint32(_POLYNOMIAL), value >> 1).astype(np.uint32)
    return value


_TABLE = _table()


def crc32c(data: bytes) -> int:
    """The CRC-32C of some bytes: blocks side by side, then joined."""
    length = max(64, int(len(data) ** 0.5))
    blocks = len(data) // length
    register = 0xFFFFFFFF
    if blocks > 1:
        columns = np.frombuffer(data, dtype=np.uint8, count=blocks * length).reshape(blocks, length)
        parts = np.zeros(blocks, dtype=np.uint32)
        for column in columns.T:
            parts = (parts >> np.uint32(8)) ^ _TABLE[(parts ^ column) & np.uint32(0xFF)]
        shift = _shift(length)
        for part in parts.tolist():
            register = _moved(shift, register) ^ part
        data = data[blocks * length :]
    for byte in data:
        register = (register >> 8) ^ int(_TABLE[(register ^ byte) & 0xFF])
    return register ^ 0xFFFFFFFF


def _shift(length: int) -> list[list[int]]:
    """What this many zero bytes make of a register, by its bytes."""
    units = np.array([1 << bit for bit in range(32)], dtype=np.uint32)
    for _ in range(length):
        units = (units >> np.uint32(8)) ^ _TABLE[units & np.uint32(0xFF)]
    tables = []
    for byte in range(4):
        table = np.zeros(256, dtype=np.uint32)
        for bit in range(8):
            table ^= np.where(np.arange(256) >> bit & 1, units[8 * byte + bit], 0).astype(np.uint32)
        tables.append([int(entry) for entry in table])
    return tables


def _moved(shift: list[list[int]], register: int) -> int:
    return (shift[0][register & 0xFF] ^ shift[1][register >> 8 & 0xFF] ^ shift[2][register >> 16 & 0xFF]
            ^ shift[3][register >> 24])


def masked_crc(data: bytes) -> int:
    """The CRC-32C, turned and offset: that of data which holds its own would be useless."""
    crc = crc32c(data)
    return ((crc >> 15 | crc << 17) + 0xA282EAD8) & 0xFFFFFFFF


def write_record(file: BinaryIO, data: bytes) -> None:
    """Appends a record."""
    length = struct.pack("<Q", len(data))
    file.write(length + struct.pack("<I", masked_crc(length)) + data + struct.pack("<I", masked_crc(data)))


def read_records(path: Path) -> Iterator[bytes]:
    """The records of a file; raises ValueError where one is damaged."""
    with open(path, "rb") as file:
        while header := file.read(12):
            length, crc = struct.unpack("<QI", header) if len(header) == 12 else (0, -1)
            data = file.read(length) if crc == masked_crc(header[:8]) else b""
            end = file.read(4)
            if len(data) != length or len(end) != 4 or struct.unpack("<I", end)[0] != masked_crc(data):
                raise ValueError(f"{path} is damaged at byte {file.tell()}")
            yield data


# -- protocol buffers: the few messages of a SequenceExample -----------------------------------


def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def _field(number: int, data: bytes) -> bytes:
    return _varint(number << 3 | 2) + _varint(len(data)) + data


def _bytes_feature(value: bytes) -> bytes:
    return _field(1, _field(1, value))


def _int_feature(value: int) -> bytes:
    return _field(3, _field(1, _varint(value)))


def _entry(key: str, value: bytes) -> bytes:
    return _field(1, _field(1, key.encode("utf-8")) + _field(2, value))


def sequence_example(key: int, particle_type: npt.NDArray[np.int64], positions: Sequence[Any]) -> bytes:
    """A trajectory: `positions` of every frame as f32 bytes, particle types as i64 bytes."""
    types = np.ascontiguousarray(particle_type, dtype="<i8").tobytes()
    context = _entry("key", _int_feature(key)) + _entry("particle_type", _bytes_feature(types))
    frames = b"".join(
        _field(1, _bytes_feature(np.ascontiguousarray(frame, dtype="<f4").tobytes())) for frame in positions)
    return _field(1, context) + _field(2, _entry("position", frames))


def _fields(data: bytes) -> Iterator[tuple[int, Any]]:
    place = 0
    while place < len(data):
        tag, place = _read_varint(data, place)
        if tag & 7 == 0:
            value, place = _read_varint(data, place)
            yield tag >> 3, value
        else:
            length, place = _read_varint(data, place)
            yield tag >> 3, data[place : place + length]
            place += length


def _read_varint(data: bytes, place: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = data[place]
        place += 1
        value |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            return value, place


def _map(data: bytes) -> Mapping[str, bytes]:
    entries = {}
    for _, entry in _fields(data):
        parts = dict(_fields(entry))
        entries[parts[1].decode("utf-8")] = parts[2]
    return entries


def parse_sequence_example(data: bytes) -> tuple[int, npt.NDArray[np.int64], npt.NDArray[np.float32]]:
    """Key, particle types (N,) and positions (T, N, 2) of a trajectory."""
    parts = dict(_fields(data))
    context, lists = _map(parts[1]), _map(parts[2])
    key = next(iter(dict(_fields(dict(_fields(context["key"]))[3])).values()))
    if isinstance(key, bytes):
        key = _read_varint(key, 0)[0]
    types = np.frombuffer(dict(_fields(dict(_fields(context["particle_type"]))[1]))[1], dtype="<i8")
    frames = [dict(_fields(dict(_fields(feature))[1]))[1] for _, feature in _fields(lists["position"])]
    positions = np.stack([np.frombuffer(frame, dtype="<f4").reshape(-1, 2) for frame in frames])
    return int(key), types.astype(np.int64), positions.astype(np.float32)
