"""Recordings read: an MCAP file becomes arrays again."""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from google.protobuf.message import DecodeError
from mcap.records import Attachment, Channel, McapRecord, Message, Metadata, Schema

from cosim.analysis.run_data import RunData
from cosim.recording import metadata as meta
from cosim.recording.channels import CHANNELS
from cosim.recording.decoding import DATA_TOPICS, Stored, decode
from cosim.recording.pictures import READ, SHEET, TOPICS, Picture, pictures
from cosim.recording.records import DamageError, RecordingError, Records
from cosim.recording.scenes import triangles_of
from cosim.recording.stresses import BEGAN, WORST, gathered, unpacked
from cosim.stresses import Stresses
from coupling.interface import Array, IntArray, SheetView

T = TypeVar("T")
STRUCTURE = "/structure/scene"
TEXTS = ("scenario.toml", "scenario.as-written.toml", "reference.toml")  #: attachments that are used
CUT_OFF = "its end is missing"  #: how a run ended whose file was cut off


def read_run(path: str | Path) -> RunData:
    """A recording as arrays; of one that was cut off what is whole, see `RunData.remark`.

    A damaged, foreign or empty file is a `RecordingError` with its remedy.
    """
    records = Records(Path(path))
    run = run_data(Path(path), records)
    return replace(run, cut=records.cut)


def messages(path: str | Path, topics: Sequence[str]) -> Iterator[Stored]:
    """The messages of some topics of a recording, in the order of writing, up to where it may be cut off."""
    for record in in_order(Path(path), Records(Path(path))):
        if isinstance(record, tuple) and record[0] in topics:
            yield record


def recorded_pictures(path: str | Path) -> Iterator[Picture]:
    """What the recorded frames show, in order; RecordingError if one cannot be read."""
    yield from _read(Path(path), pictures(messages(path, TOPICS)))


def last_sheet(path: str | Path) -> SheetView | None:
    """The sheet of the last picture, None if there is none; RecordingError if it cannot be read."""
    last = deque(messages(path, (SHEET,)), maxlen=1)
    return next(_read(Path(path), (READ[SHEET](data) for _, _, data in last)), None)


def recorded_structure(path: str | Path) -> tuple[Array, IntArray]:
    """Surface of the structure: points (p, 3) [m] and triangles (q, 3); RecordingError if it cannot be read."""
    stored = (triangles_of(data) for _, _, data in messages(path, [STRUCTURE]))
    found = next(_read(Path(path), stored), None)
    if found is None:
        raise RecordingError(f"{path}: no structure is recorded; give a file that `cosim run` wrote")
    return found


def recorded_stresses(path: str | Path) -> tuple[Stresses | None, Stresses | None]:
    """Stresses at which cells began to crack, and those of the most used cells of all recorded frames.

    None where none are recorded; RecordingError if they cannot be read.
    """
    found: dict[str, list[Stresses]] = {BEGAN: [], WORST: []}
    for topic, part in _read(Path(path), ((t, unpacked(data)) for t, _, data in messages(path, tuple(found)))):
        found[topic].append(part)
    began, worst = _read(Path(path), map(gathered, found.values()))
    return began, worst


def _read(path: Path, items: Iterator[T]) -> Iterator[T]:
    try:
        yield from items
    except RecordingError:
        raise
    except (DecodeError, ValueError, IndexError, OverflowError, MemoryError) as error:
        raise RecordingError(
            f"{path}: a picture in it cannot be read: {error}; give a file that `cosim run` wrote"
        ) from None


def in_order(path: Path, records: Iterable[McapRecord]) -> Iterator[McapRecord | Stored]:
    """Records, messages as topic, time and content: each once, none missing, of the kind that their topic has."""
    schema: dict[int, Schema] = {}
    topic: dict[int, str] = {}
    count: dict[int, int] = {}
    for r in records:
        if isinstance(r, Schema):
            schema[r.id] = r
        elif isinstance(r, Channel):
            _check_channel(path, r, schema.get(r.schema_id))
            topic[r.id] = r.topic
        elif isinstance(r, Message):
            if r.channel_id not in topic:
                raise DamageError(path, f"a message of an unknown channel {r.channel_id}")
            count[r.channel_id] = count.get(r.channel_id, 0) + 1
            if r.sequence != count[r.channel_id]:
                where = f"message {count[r.channel_id]} of {topic[r.channel_id]}"
                raise DamageError(path, f"{where} is missing, double or out of order (there is {r.sequence})")
            yield topic[r.channel_id], r.log_time, r.data
            continue
        yield r


def _check_channel(path: Path, channel: Channel, schema: Schema | None) -> None:
    known = CHANNELS.get(channel.topic)
    if known is None:
        return
    name = None if schema is None else schema.name
    if channel.message_encoding != "protobuf" or name != known.schema.DESCRIPTOR.full_name:
        raise RecordingError(
            f"{path}: {channel.topic} holds {name} as {channel.message_encoding}, "
            f"not {known.schema.DESCRIPTOR.full_name} as protobuf; give a file that `cosim run` wrote"
        )


def run_data(path: Path, records: Iterable[McapRecord]) -> RunData:
    """Decode loads, events and ledger; pictures are passed over as they come, they may be large."""
    run: dict[str, str] | None = None
    ended = CUT_OFF
    texts: dict[str, str] = {}
    stored: list[Stored] = []
    for r in in_order(path, records):
        if isinstance(r, Metadata) and r.name == meta.RUN:
            if run is not None:
                raise DamageError(path, "its metadata stand there twice")
            run = _metadata(path, r.metadata)
        elif isinstance(r, Metadata) and r.name == meta.END:
            ended = _opened(path, r.metadata).get("ended", ended)
        elif isinstance(r, Attachment) and r.name in TEXTS:
            texts[r.name] = _text(path, r)
        elif isinstance(r, tuple) and r[0] in DATA_TOPICS:
            stored.append(r)
    if run is None:
        raise RecordingError(f"{path}: an MCAP file, but not a recording of cosim; give a file that `cosim run` wrote")
    if lost := set(json.loads(run["attachments"])) - set(texts):
        raise DamageError(path, f"{', '.join(sorted(lost))} in it is missing")
    try:
        data = decode(path.name, run, texts, stored)
    except (DecodeError, ValueError, OverflowError) as error:
        raise RecordingError(f"{path}: {error}; give a file that `cosim run` wrote") from None
    if not len(data.t_ns):
        raise RecordingError(f"{path}: holds no data, not one window; run the scenario again")
    return replace(data, ended=ended)


def _opened(path: Path, values: dict[str, str]) -> dict[str, str]:
    try:
        return meta.opened(values)
    except KeyError:
        raise RecordingError(
            f"{path}: an MCAP file, but not a recording of this version of cosim: its metadata have no checksum; "
            "run the scenario again"
        ) from None
    except ValueError as error:
        raise DamageError(path, str(error)) from None


def _metadata(path: Path, values: dict[str, str]) -> dict[str, str]:
    found = _opened(path, values)
    if found.get("format") != meta.FORMAT:
        raise RecordingError(
            f"{path}: format {found.get('format')} of version {found.get('version')}, "
            f"this version reads {meta.FORMAT}; use that version, or run the scenario again"
        )
    if fault := meta.fault(found):
        raise RecordingError(f"{path}: {fault} cannot be; give a file that `cosim run` wrote")
    return found


def _text(path: Path, attachment: Attachment) -> str:
    try:
        return attachment.data.decode()
    except UnicodeDecodeError:
        raise RecordingError(
            f"{path}: {attachment.name} in it is no text; give a file that `cosim run` wrote"
        ) from None
