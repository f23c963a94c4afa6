"""The records of a recording, front to back, each byte checked before it is used.

A file that its writer has finished ends with a mark: then any byte that is wrong is damage, and nothing is taken from
the file. A file without the mark was cut off: its whole records are taken, and that it was cut off is told. Chunks,
attachments and metadata carry checksums of their own, so that a cut file is checked as well.
"""

from __future__ import annotations

import io
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, DataEnd, McapRecord, Message, Metadata, Schema

from cosim.errors import InputError

MAGIC = b"\x89MCAP0\r\n"
FOOTER = Opcode.FOOTER.to_bytes(1, "little") + (20).to_bytes(8, "little")  #: how the last record begins
TAIL = len(FOOTER) + 20 + len(MAGIC)
#: what a file may unpack to: as much as is harmless, or so many times its size (recordings: 3 to 20)
HARMLESS, EXPANSION = 2**24, 100
PASSED = (Opcode.HEADER, Opcode.MESSAGE_INDEX)  #: outside of chunks; all that is shown stands elsewhere


class RecordingError(InputError):
    """A recording that cannot be used; the message is one line with its remedy."""


class DamageError(RecordingError):
    """A byte is wrong."""

    def __init__(self, path: Path, what: str) -> None:
        super().__init__(
            f"{path}: recording is damaged: {what}; "
            f"`cosim recover {path} -o {path.stem}.recovered.mcap` keeps what stands before"
        )


class Records:
    """Iterates over the records of a file; afterwards ``cut`` tells whether it was cut off.

    ``chunks`` counts those begun: messages between which it does not change share one.
    """

    def __init__(self, path: Path) -> None:
        self.path, self.cut, self.chunks = path, False, 0
        if not path.is_file():
            raise RecordingError(f"{path}: no such recording; `cosim run SCENARIO -o {path.name}` writes one")
        with path.open("rb") as file:
            if file.read(len(MAGIC)) != MAGIC:
                raise RecordingError(f"{path}: not an MCAP recording; give a file that `cosim run -o` has written")
        self._size = path.stat().st_size
        self._unpacked = 0

    def __iter__(self) -> Iterator[McapRecord]:
        with self.path.open("rb") as file:
            finished = _finished(file, self._size)
            crc = zlib.crc32(file.read(len(MAGIC)))
            while (found := self._next(file, finished)) is not None:
                head, body = found
                try:
                    record = _parse(head[0], body, crc)
                    yield from self._unpack(record) if isinstance(record, Chunk) else [record] if record else []
                except RecordingError:
                    raise
                except Exception as error:  # the parsers raise what their parts raise
                    text = str(error) or type(error).__name__
                    raise DamageError(self.path, f"{text}, before byte {file.tell()}") from None
                if isinstance(record, DataEnd):
                    self._end(file, finished)
                    return
                crc = zlib.crc32(body, zlib.crc32(head, crc))

    def _next(self, file: IO[bytes], finished: bool) -> tuple[bytes, bytes] | None:
        """Head and body of the next record; None where the file was cut off."""
        head = file.read(9)
        length = int.from_bytes(head[1:], "little")
        if len(head) == 9 and length <= self._size - file.tell():
            return head, file.read(length)
        if finished:
            raise DamageError(self.path, f"a record ends behind the file, before byte {file.tell()}")
        self.cut = True
        return None

    def _end(self, file: IO[bytes], finished: bool) -> None:
        """The summary, which other programs use: under one checksum."""
        rest = file.read()
        if not finished:
            self.cut = True
        elif zlib.crc32(rest[: -len(MAGIC) - 4]).to_bytes(4, "little") != rest[-len(MAGIC) - 4 : -len(MAGIC)]:
            raise DamageError(self.path, "the checksum of its summary is wrong")

    def _unpack(self, chunk: Chunk) -> Iterator[McapRecord]:
        """Records of a chunk; no more memory than its size says, which is bounded by that of the file."""
        self._unpacked += chunk.uncompressed_size
        self.chunks += 1
        if self._unpacked > max(HARMLESS, EXPANSION * self._size):
            raise ValueError(f"it unpacks to more than {self._unpacked / 2**20:.0f} MiB, no recording does so")
        if chunk.compression == "zstd":
            with zstandard.ZstdDecompressor().stream_reader(io.BytesIO(chunk.data)) as reader:
                data = reader.read(chunk.uncompressed_size + 1)
        elif chunk.compression == "":
            data = chunk.data
        else:
            raise ValueError(f"unknown compression {chunk.compression!r}")
        if len(data) != chunk.uncompressed_size or zlib.crc32(data) != chunk.uncompressed_crc:
            raise ValueError("the checksum of a chunk is wrong")
        stream = ReadDataStream(io.BytesIO(data))
        while stream.count < len(data):
            opcode, length = stream.read1(), stream.read8()
            if length > len(data) - stream.count:
                raise ValueError("a record ends behind its chunk")
            if opcode not in _INNER:
                raise ValueError(f"a record of kind {opcode} has no place in a chunk")
            yield _INNER[opcode](ReadDataStream(io.BytesIO(stream.read(length))), length)


def _finished(file: IO[bytes], size: int) -> bool:
    """Whether the writer came to the end of the file."""
    file.seek(max(size - TAIL, 0))
    tail = file.read(TAIL)
    file.seek(0)
    return tail.startswith(FOOTER) and tail.endswith(MAGIC)


def _parse(opcode: int, body: bytes, crc: int) -> McapRecord | None:
    """A record outside of a chunk, with its own checksum right; None for one that says nothing of the run."""
    stream: Any = ReadDataStream(io.BytesIO(body))
    record: McapRecord | None = None
    if opcode == Opcode.CHUNK:
        record = Chunk.read(stream)
    elif opcode == Opcode.METADATA:
        record = Metadata.read(stream)
    elif opcode == Opcode.ATTACHMENT:
        if zlib.crc32(body[:-4]).to_bytes(4, "little") != body[-4:]:
            raise ValueError("the checksum of an attachment is wrong")
        record = Attachment.read(stream)
    elif opcode == Opcode.DATA_END:
        if body != crc.to_bytes(4, "little"):
            raise ValueError("the checksum of its data is wrong")
        record = DataEnd.read(stream)
    elif opcode not in PASSED:
        raise ValueError(f"a record of kind {opcode} has no place there")
    return record


_INNER: dict[int, Any] = {
    Opcode.SCHEMA: lambda stream, _length: Schema.read(stream),
    Opcode.CHANNEL: lambda stream, _length: Channel.read(stream),
    Opcode.MESSAGE: Message.read,
}
