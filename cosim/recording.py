"""Recordings: a run becomes an MCAP file, and an MCAP file becomes arrays again.

Scenario, reference and run data are written first, and the file is flushed at every recorded frame, so that a killed
run leaves a file that `recover` can read. The same scenario gives the same bits: stamps are simulated time, and
nothing of the machine (clock, path, user) is written.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO, Any, Self

import mcap.writer
from mcap.records import Attachment, Channel, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import StreamReader
from mcap_protobuf.schema import build_file_descriptor_set

from cosim import channels
from cosim.observer import RunInfo
from cosim.run_data import DATA_TOPICS, RecordingError, RunData, Stored
from coupling.interface import Frame

__all__ = ["Recorder", "RecordingError", "RunData", "messages", "read_run", "recover"]

MAGIC = b"\x89MCAP0\r\n"

SHEET_EVERY = 4  #: recorded frames between two meshes of a sheet in which no cell fails


class Recorder:
    """Observer that writes a run to ``path``. Closing is idempotent; use it in ``finally`` or as a context manager."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self._file: IO[bytes] | None = None
        self._channel: dict[str, int] = {}
        self._count: dict[str, int] = {}

    def on_start(self, run_info: RunInfo) -> None:
        self._info = run_info
        self._every_ns = round(run_info.scenario.recording.every * 1e9)
        self._thickness = float(run_info.scenario.ice.thickness)
        self._cells, self._since_sheet, self._due_ns = -1, 0, self._every_ns
        self._file = self.path.open("wb")
        self._writer = mcap.writer.Writer(self._file)
        self._writer.start(profile="", library="cosim")
        self._write_run_data()
        self._register()
        for packed in channels.structure(*run_info.structure_mesh, spacing=self._thickness / 3):
            self._add(0, packed)
        self._writer.flush()

    def on_frame(self, frame: Frame) -> None:
        self._add(frame.t_ns, channels.load(frame.t_ns, frame.load))
        if frame.ledger:
            self._add(frame.t_ns, channels.ledger(frame.t_ns, frame.ledger))
        if frame.budget:
            self._add(frame.t_ns, channels.ledger(frame.t_ns, frame.budget, "/load/budget"))
        for event in frame.events:
            for packed in channels.event(event):
                self._add(event.t_ns, packed)
        if self._is_recorded(frame):
            for packed in channels.frame(frame, self._thickness, self._with_sheet(frame)):
                self._add(frame.t_ns, packed)
            self._writer.flush()

    def on_close(self) -> None:
        if self._file is not None:
            self._writer.finish()
            self._file.close()
            self._file = None

    close = on_close

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.on_close()

    def _is_recorded(self, frame: Frame) -> bool:
        """Every so often, at the start and end, and whenever something breaks."""
        first = frame.t_ns <= self._info.window_ns
        last = frame.t_ns >= self._info.duration_ns
        due = frame.t_ns >= self._due_ns
        if due:
            self._due_ns = (frame.t_ns // self._every_ns + 1) * self._every_ns
        return first or last or bool(frame.events) or due

    def _with_sheet(self, frame: Frame) -> bool:
        cells = int(frame.sheet.intact.sum())
        due = cells != self._cells or self._since_sheet >= SHEET_EVERY - 1
        self._cells, self._since_sheet = cells, 0 if due else self._since_sheet + 1
        return due

    def _write_run_data(self) -> None:
        scenario = self._info.scenario
        attach(self._writer, "scenario.toml", scenario.resolved_toml())
        attach(self._writer, "scenario.as-written.toml", scenario.text)
        reference = scenario.folder / "reference.toml" if scenario.folder else None
        if reference is not None and reference.is_file():
            attach(self._writer, "reference.toml", reference.read_text(encoding="utf-8"))
        self._writer.add_metadata("run", run_metadata(self._info))

    def _register(self) -> None:
        """All channels at once, in the order of the table, so that their numbers never depend on the run."""
        schemas: dict[str, int] = {}
        for topic, message in channels.SCHEMAS.items():
            name = message.DESCRIPTOR.full_name
            if name not in schemas:
                data = build_file_descriptor_set(message).SerializeToString(deterministic=True)
                schemas[name] = self._writer.register_schema(name, "protobuf", data)
            self._channel[topic] = self._writer.register_channel(topic, "protobuf", schemas[name])

    def _add(self, t_ns: int, packed: channels.Packed) -> None:
        topic, data = packed
        self._count[topic] = self._count.get(topic, 0) + 1
        self._writer.add_message(self._channel[topic], t_ns, data, t_ns, self._count[topic])


def attach(writer: Any, name: str, text: str) -> None:
    writer.add_attachment(0, 0, name, "application/toml", text.encode())


def run_metadata(info: RunInfo) -> dict[str, str]:
    """What identifies a run: strings, as MCAP wants them."""
    from importlib.metadata import version

    scenario = info.scenario
    return {
        "format": "1",
        "version": version("brash-ice"),
        "scenario": scenario.name,
        "title": scenario.title,
        "seed": str(scenario.seed),
        "overrides": json.dumps(list(scenario.overrides)),
        "nodes": json.dumps(list(info.sheet_shape)),
        "spacing_m": repr(float(info.d)),
        "thickness_m": repr(float(scenario.ice.thickness)),
        "drift_m_s": repr(float(scenario.drift.velocity)),
        "ice_density": repr(float(scenario.ice.density)),
        "duration_ns": str(info.duration_ns),
        "window_ns": str(info.window_ns),
    }


def read_run(path: str | Path) -> RunData:
    """A complete recording as arrays. A truncated or foreign file is a `RecordingError` with its remedy."""
    return _run_data(Path(path), _records(Path(path)))


def messages(path: str | Path, topics: Sequence[str]) -> Iterator[Stored]:
    """The messages of some topics of a complete recording, in the order of writing."""
    channel: dict[int, Channel] = {}
    for record in _records(Path(path)):
        if isinstance(record, Channel):
            channel[record.id] = record
        elif isinstance(record, Message) and channel[record.channel_id].topic in topics:
            yield channel[record.channel_id].topic, record.log_time, record.data


def recover(path: str | Path, out: str | Path) -> RunData:
    """Write what can be read of a truncated recording as a clean file; returns what it holds."""
    source, target = Path(path), Path(out)
    if target.exists() and target.samefile(source):
        raise RecordingError(f"{target}: recovery does not overwrite its source; name another file with -o")
    data = _run_data(source, _records(source, until_damage=True))
    if not len(data.t_ns):
        raise RecordingError(f"{source}: holds no data, nothing to recover; run the scenario again")
    with target.open("wb") as file:
        writer = mcap.writer.Writer(file)
        writer.start(profile="", library="cosim")
        _copy(_records(source, until_damage=True), writer)
        writer.finish()
    return data


def _copy(records: Iterator[McapRecord], writer: mcap.writer.Writer) -> None:
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


def _records(path: Path, until_damage: bool = False) -> Iterator[McapRecord]:
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


def _run_data(path: Path, records: Iterator[McapRecord]) -> RunData:
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
    return RunData.decode(path.name, metadata, texts, stored)
