"""A recording that is gone on with: what stands in the file until then is written again, and must be the same.

So the writer comes to where it was when it wrote there (counts, indices, checksums), nothing of the file is changed
before all of it has been compared, and a recording ends with the bytes that it would have had without interruption.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from mcap.records import Channel, Message

from cosim.outputs import reopen
from cosim.recording.records import RecordingError, Records


@dataclass(frozen=True)
class Since:
    """From where a recording goes on."""

    t_ns: int  #: end of the last window that stays
    due_ns: int  #: when the next picture is due
    view_ns: int  #: when the next picture for stock viewers is due


class Retraced:
    """A file for the writer: compares what it is given with what stands there, until `go_on`."""

    def __init__(self, path: Path) -> None:
        self._path, self._compares = path, True
        self._file: IO[bytes] = reopen(path, ".mcap")

    def write(self, data: bytes) -> int:
        """RecordingError where something else stands in the file."""
        if not self._compares:
            return self._file.write(data)
        at = self._file.tell()
        if self._file.read(len(data)) != data:
            raise RecordingError(
                f"{self._path}: from byte {at} on it is not what its run writes here; resume it where it was "
                "simulated, or run the scenario again"
            )
        return len(data)

    def go_on(self) -> None:
        """From here on the file grows; what follows is cut off."""
        self._compares = False
        self._file.truncate(self._file.seek(self._file.tell()))

    def tell(self) -> int:
        """Place in the file."""
        return self._file.tell()

    def flush(self) -> None:
        """As of every file."""
        self._file.flush()

    def fileno(self) -> int:
        """As of every file."""
        return self._file.fileno()

    def close(self) -> None:
        """As of every file."""
        self._file.close()


def retrace(writer: Any, path: Path, since: Since, first: str) -> Mapping[str, int]:
    """Writes all messages again up to the end of a window; how many there are of each topic.

    ``first`` is the topic with which windows begin; chunks end where they ended, every checkpoint with one.
    RecordingError where the file does not reach so far.
    """
    count: dict[str, int] = {}
    reached, begun = 0, 1
    for topic, message, chunk in _messages(path):
        if topic == first:
            if message.log_time > since.t_ns:
                break
            reached = message.log_time
        if chunk != begun:
            writer.flush()
            begun = chunk
        writer.add_message(message.channel_id, message.log_time, message.data, message.publish_time, message.sequence)
        count[topic] = message.sequence
    if reached != since.t_ns:
        raise RecordingError(
            f"{path}: ends at {reached / 1e9:g} s, before its checkpoint at {since.t_ns / 1e9:g} s; "
            "run the scenario again"
        )
    writer.flush()
    return count


def _messages(path: Path) -> Iterator[tuple[str, Message, int]]:
    """With their topic and the number of their chunk."""
    topic: dict[int, str] = {}
    records = Records(path)
    for record in records:
        if isinstance(record, Channel):
            topic[record.id] = record.topic
        elif isinstance(record, Message):
            yield topic[record.channel_id], record, records.chunks
