"""Arrays as few bytes: whole multiples of a quantum, as differences, byte by byte of equal weight.

Neighbours in a picture are alike, so that the difference of one number to the next is small, and its higher bytes are
zero; put together, they cost a compressor nothing. Numbers are kept to half a quantum, whole numbers exactly.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coupling.interface import Array, BoolArray, IntArray

WIDTH = 4  #: bytes of a difference
LARGEST = 2**30  #: whole numbers that can be kept are below this one in magnitude


def pack(values: Sequence[int] | IntArray) -> bytes:
    """Whole numbers (n,); ValueError if one is not below `LARGEST`."""
    whole = np.asarray(values, np.int64).ravel()
    if whole.size and np.abs(whole).max() >= LARGEST:
        raise ValueError(f"{np.abs(whole).max()} is too large a multiple of the quantum; it has to be below {LARGEST}")
    step = whole.copy()
    step[1:] -= whole[:-1]
    folded = np.where(step < 0, -2 * step - 1, 2 * step).astype("<u4")  # small whichever their sign
    return folded.view(np.uint8).reshape(-1, WIDTH).T.tobytes()


def unpack(data: bytes) -> IntArray:
    """The numbers that `pack` was given; ValueError for bytes that are none of its."""
    if len(data) % WIDTH:
        raise ValueError(f"{len(data)} bytes are no numbers of {WIDTH} bytes each")
    folded = np.frombuffer(data, np.uint8).reshape(WIDTH, -1).T.copy().view("<u4").ravel().astype(np.int64)
    return np.asarray(np.cumsum(np.where(folded & 1, -(folded + 1) // 2, folded // 2)))


def pack_numbers(values: Array, quantum: float) -> bytes:
    """Numbers to half a quantum."""
    return pack(np.rint(np.asarray(values) / quantum).astype(np.int64))


def unpack_numbers(data: bytes, quantum: float) -> Array:
    """Numbers of `pack_numbers`."""
    return unpack(data).astype(np.float64) * quantum


def pack_bits(values: BoolArray) -> bytes:
    """Eight to a byte."""
    return np.packbits(values).tobytes()


def unpack_bits(data: bytes, count: int) -> BoolArray:
    """The first ``count`` bits; ValueError if there are fewer."""
    bits = np.unpackbits(np.frombuffer(data, np.uint8))
    if len(bits) < count:
        raise ValueError(f"{len(bits)} bits where {count} are needed")
    return bits[:count].astype(bool)


def rounded(values: Array, bits: int = 12) -> Array:
    """Numbers with so many binary digits: the rest of their bytes is zero."""
    mantissa, exponent = np.frexp(values)
    out: Array = np.ldexp(np.rint(mantissa * 2**bits) / 2**bits, exponent)
    return out
