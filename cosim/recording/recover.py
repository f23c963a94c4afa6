"""What can be read of a recording that was cut off or is damaged, as a clean file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from mcap.records import Attachment, Channel, McapRecord, Message, Metadata, Schema

from cosim.analysis.run_data import RunData
from cosim.outputs import whole
from cosim.recording.metadata import END, sealed
from cosim.recording.reader import run_data
from cosim.recording.records import DamageError, Records
from cosim.recording.writer import new_writer


def recover(path: str | Path, out: str | Path) -> RunData:
    """Write what stands before the damage as a clean file; returns what it holds."""
    source = Path(path)
    data = run_data(source, undamaged(Records(source)))
    with whole(Path(out), ".mcap") as part, part.open("wb") as file:
        writer = new_writer(file)
        writer.start(profile="", library="cosim")
        _copy(undamaged(Records(source)), writer)
        writer.add_metadata(END, sealed({"ended": data.ended}))
        writer.finish()
    return data


def undamaged(records: Iterable[McapRecord]) -> Iterator[McapRecord]:
    """Records up to the first that is damaged."""
    try:
        yield from records
    except DamageError:
        return


def _copy(records: Iterable[McapRecord], writer: Any) -> None:
    schema: dict[int, int] = {}
    channel: dict[int, int] = {}
    for r in records:
        if isinstance(r, Attachment):
            writer.add_attachment(r.create_time, r.log_time, r.name, r.media_type, r.data)
        elif isinstance(r, Metadata) and r.name != END:
            writer.add_metadata(r.name, r.metadata)
        elif isinstance(r, Schema) and r.id not in schema:
            schema[r.id] = writer.register_schema(r.name, r.encoding, r.data)
        elif isinstance(r, Channel) and r.id not in channel:
            channel[r.id] = writer.register_channel(r.topic, r.message_encoding, schema[r.schema_id], r.metadata)
        elif isinstance(r, Message):
            writer.add_message(channel[r.channel_id], r.log_time, r.data, r.publish_time, r.sequence)
