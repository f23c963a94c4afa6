"""Large repeated fields written as protobuf bytes straight from arrays (python-protobuf needs 100 times as long).

A numpy record with tag and length bytes in front of each number *is* the wire format of ``foxglove.Point3`` and
``foxglove.Color``; `tests/cosim/test_channels.py` parses the bytes back with the official classes.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from coupling.interface import Array, IntArray


def _record(names: str) -> np.dtype[Any]:
    """Tag and length of one message, then tag and double of each of its fields."""
    parts: list[tuple[str, str]] = [("tag", "u1"), ("length", "u1")]
    for name in names:
        parts += [(f"tag_{name}", "u1"), (name, "<f8")]
    return np.dtype(parts)


def _doubles(number: int, values: Array, names: str) -> bytes:
    """Repeated message field ``number`` whose fields 1, 2, ... are the doubles in the columns of ``values``."""
    out = np.empty(len(values), _record(names))
    out["tag"], out["length"] = number << 3 | 2, 9 * len(names)
    for k, name in enumerate(names):
        out[f"tag_{name}"] = (k + 1) << 3 | 1
        out[name] = values[:, k]
    return out.tobytes()


def points(number: int, xyz: Array) -> bytes:
    """Repeated ``foxglove.Point3``."""
    return _doubles(number, xyz, "xyz")


def colors(number: int, rgba: Array) -> bytes:
    """Repeated ``foxglove.Color``, components 0-1."""
    return _doubles(number, rgba, "rgba")


def fixed32(number: int, values: IntArray) -> bytes:
    """Packed repeated ``fixed32``."""
    return nested(number, np.ascontiguousarray(values, "<u4").tobytes()) if values.size else b""


def nested(number: int, payload: bytes) -> bytes:
    """A length-delimited field."""
    return bytes(_varint(number << 3 | 2)) + bytes(_varint(len(payload))) + payload


def _varint(value: int) -> list[int]:
    out = []
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    return [*out, value]
