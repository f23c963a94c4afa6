"""Recordings read: an MCAP file becomes arrays again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from mcap.records import Attachment, Channel, McapRecord, Message, Metadata
from mcap.stream_reader import StreamReader

from cosim.analysis.run_data import RunData
from cosim.errors import InputError
from cosim.recording.decoding import DATA_TOPICS, Stored, decode

MAGIC = b"\x89MCAP0\r\n"


class RecordingError(InputError):
    """A recording that cannot be used; the message is one line with its remedy."""


def read_run(path: str | Path) -> RunData:
    """A complete recording as arrays. A truncated or foreign file is a `RecordingError` with its remedy."""
    return run_data(Path(path), records(Path(path)))


def messages(path: str | Path, topics: Sequence[str]) -> Iterator[Stored]:
    """The messages of some topics of a complete recording, in the order of writing."""
    channel: dict[int, Channel] = {}
    for record in records(Path(path)):
        if isinstance(record, Channel):
            channel[record.id] = record
        elif isinstance(record, Message) and channel[record.channel_id].topic in topics:
            yield channel[record.channel_id].topic, record.log_time, record.data


def records(path: Path, until_damage: bool = False) -> Iterator[McapRecord]:
    """Records in the order of writing; at damage an error with its remedy, or the end if ``until_damage``."""
    if not path.is_file():
        raise RecordingError(f"{path}: no such recording; `cosim run SCENARIO -o {path.name}` writes one")
    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            raise RecordingError(f"{path}: not an MCAP recording; give a file that `cosim run -o` has written")
        file.seek(0)
        records = iter(StreamReader(file, validate_crcs=True).records)
        while True:
            try:
                record = next(records)
            except StopIteration:
                return
            except Exception:  # the reader raises what its parts raise: end of file, length, CRC, decompression
                if until_damage:
                    return
                raise RecordingError(
                    f"{path}: recording is truncated or damaged; "
                    f"run `cosim recover {path} -o {path.stem}.recovered.mcap`"
                ) from None
            yield record


def run_data(path: Path, records: Iterator[McapRecord]) -> RunData:
    """Decode loads, events and ledger; pictures are passed over as they come, they may be large."""
    metadata: dict[str, str] | None = None
    texts: dict[str, str] = {}
    topic: dict[int, str] = {}
    stored: list[Stored] = []
    for r in records:
        if isinstance(r, Metadata) and r.name == "run":
            metadata = r.metadata
        elif isinstance(r, Attachment):
            texts[r.name] = r.data.decode()
        elif isinstance(r, Channel):
            topic[r.id] = r.topic
        elif isinstance(r, Message) and topic[r.channel_id] in DATA_TOPICS:
            stored.append((topic[r.channel_id], r.log_time, r.data))
    if metadata is None:
        raise RecordingError(f"{path}: an MCAP file, but not a recording of cosim; give a file that `cosim run` wrote")
    return decode(path.name, metadata, texts, stored)
