"""What can be read of a truncated recording, as a clean file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import mcap.writer
from mcap.records import Attachment, Channel, McapRecord, Message, Metadata, Schema

from cosim.analysis.run_data import RunData
from cosim.recording.reader import RecordingError, records, run_data


def recover(path: str | Path, out: str | Path) -> RunData:
    """Write what can be read of a truncated recording as a clean file; returns what it holds."""
    source, target = Path(path), Path(out)
    if target.exists() and target.samefile(source):
        raise RecordingError(f"{target}: recovery does not overwrite its source; name another file with -o")
    data = run_data(source, records(source, until_damage=True))
    if not len(data.t_ns):
        raise RecordingError(f"{source}: holds no data, nothing to recover; run the scenario again")
    with target.open("wb") as file:
        writer: Any = mcap.writer.Writer(file)  # its methods carry no types
        writer.start(profile="", library="cosim")
        _copy(records(source, until_damage=True), writer)
        writer.finish()
    return data


def _copy(records: Iterator[McapRecord], writer: Any) -> None:
    schema: dict[int, int] = {}
    channel: dict[int, int] = {}
    for r in records:
        if isinstance(r, Attachment):
            writer.add_attachment(r.create_time, r.log_time, r.name, r.media_type, r.data)
        elif isinstance(r, Metadata):
            writer.add_metadata(r.name, r.metadata)
        elif isinstance(r, Schema) and r.id not in schema:
            schema[r.id] = writer.register_schema(r.name, r.encoding, r.data)
        elif isinstance(r, Channel) and r.id not in channel:
            channel[r.id] = writer.register_channel(r.topic, r.message_encoding, schema[r.schema_id], r.metadata)
        elif isinstance(r, Message):
            writer.add_message(channel[r.channel_id], r.log_time, r.data, r.publish_time, r.sequence)
