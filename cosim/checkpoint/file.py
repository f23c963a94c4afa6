"""A checkpoint as a file: a line that says what it is, a header, and the state under a checksum.

It is read as data: numbers, texts and memory, see `cosim.checkpoint.restore`; nothing in it is executed, and it is not
unpacked beyond the size that its header tells. It is nevertheless part of a run, no exchange format: compiled kernels
trust the indices in it. The checksum tells damage, not intent; resume what you, or somebody you trust, have run.
"""

from __future__ import annotations

import hashlib
import json
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cosim.checkpoint.arrays import placed
from cosim.checkpoint.graph import Graph
from cosim.errors import InputError
from cosim.outputs import MAGIC, whole

FORMAT = 2  #: goes up with every change that an older reader would misread
ENDING = ".checkpoint"
LARGEST = 2**34  #: bytes that a state may unpack to
LEVEL = 1  #: of the compression: the fastest


class CheckpointError(InputError):
    """A checkpoint that cannot be used; the message is one line with its remedy."""


@dataclass(frozen=True)
class Kept:
    """What a checkpoint holds."""

    header: Mapping[str, Any]
    parts: Mapping[str, Packed]  #: by name


@dataclass(frozen=True)
class Packed:
    """A graph that can be read as often as one likes."""

    nodes: str  #: as JSON
    pieces: Sequence[tuple[int, bytes | memoryview]]  #: of memory: place in a cache line, content

    @classmethod
    def of(cls, graph: Graph) -> Packed:
        """From a walk over objects."""
        return cls(json.dumps(graph.nodes, separators=(",", ":")), graph.memory.pieces)

    def read(self) -> tuple[list[list[Any]], list[NDArray[np.uint8]]]:
        """Nodes, and memory of their own."""
        return json.loads(self.nodes), [placed(*piece) for piece in self.pieces]


def place_of(recording: Path) -> Path:
    """Where the checkpoint of a recording lies: beside it."""
    return recording.with_suffix(ENDING)


def write(path: Path, kept: Kept) -> None:
    """Takes the place of the last one in one go, when all of it is on the disk."""
    packer, sums, bodies = zlib.compressobj(LEVEL), hashlib.sha256(), []
    index, total = _index(kept.parts)
    told = json.dumps({"format": FORMAT, **kept.header, "size": total, "parts": index}).encode()
    for part in kept.parts.values():
        for content in (part.nodes.encode(), *(content for _, content in part.pieces)):
            bodies.append(packer.compress(content))
    bodies.append(packer.flush())
    for body in (told, *bodies):
        sums.update(body)
    with whole(path, ENDING) as place, place.open("wb") as file:
        file.write(MAGIC[ENDING] + sums.hexdigest().encode() + b"\n" + told + b"\n")
        file.writelines(bodies)


def _index(parts: Mapping[str, Packed]) -> tuple[dict[str, Any], int]:
    """How long the pieces of each part are, and all together [bytes]."""
    found, total = {}, 0
    for name, part in parts.items():
        length = len(part.nodes.encode())
        found[name] = [length, [[place, len(content)] for place, content in part.pieces]]
        total += length + sum(len(content) for _, content in part.pieces)
    return found, total


def read(path: Path) -> Kept:
    """A checkpoint from its file; CheckpointError if it is none, damaged, or of another format."""
    try:
        begins, _, rest = path.read_bytes().partition(b"\n")
    except OSError as error:
        raise CheckpointError(f"{path}: cannot be read: {error.strerror}") from None
    if begins + b"\n" != MAGIC[ENDING]:
        raise CheckpointError(f"{path}: no checkpoint of cosim; give a recording beside which a run has left one")
    digest, _, rest = rest.partition(b"\n")
    told, _, body = rest.partition(b"\n")
    sums = hashlib.sha256(told)
    sums.update(body)
    if sums.hexdigest().encode() != digest:
        raise CheckpointError(f"{path}: checkpoint is damaged, its checksum is wrong; run the scenario again")
    try:
        header = json.loads(told)
        if header["format"] != FORMAT:
            raise CheckpointError(
                f"{path}: checkpoint of format {header['format']}, this version reads {FORMAT}; "
                "use the version that wrote it, or run the scenario again"
            )
        return Kept(header, _parts(header, body))
    except CheckpointError:
        raise
    except (ValueError, KeyError, TypeError, IndexError, zlib.error, RecursionError) as error:
        raise CheckpointError(f"{path}: checkpoint cannot be read: {error}; run the scenario again") from None


def _parts(header: Mapping[str, Any], body: bytes) -> dict[str, Packed]:
    size = int(header["size"])
    if not 0 <= size <= LARGEST:
        raise ValueError(f"it says that it holds {size} bytes")
    state = zlib.decompressobj().decompress(body, size + 1)
    if len(state) != size:
        raise ValueError(f"it holds {len(state)} bytes and says {size}")
    at, found, content = 0, {}, memoryview(state)
    for name, (length, pieces) in header["parts"].items():
        nodes, at = bytes(content[at : at + length]).decode(), at + length
        own = []
        for place, count in pieces:
            own.append((int(place), content[at : at + count]))
            at += count
        found[name] = Packed(nodes, own)
    return found
