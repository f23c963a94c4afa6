"""Recordings written: a run becomes an MCAP file.

Scenario, reference and run data are written first, and the file is flushed at every recorded frame, so that a killed
run leaves a file that `cosim.recording.recover` can read. The same scenario gives the same bits: stamps are simulated
time, and nothing of the machine (clock, path, user) is written.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import IO, Any, Self

import mcap.writer
from mcap_protobuf.schema import build_file_descriptor_set

from cosim.observer import RunInfo
from cosim.recording.channels import CHANNELS, Channel, When
from cosim.scenario.lengths import characteristic_length
from coupling.interface import Event, Frame

MESH_EVERY = 4  #: recorded frames between two meshes of a sheet in which no cell fails


class Recorder:
    """Observer that writes a run to ``path``. Closing is idempotent; use it in ``finally`` or as a context manager."""

    def __init__(self, path: str | Path, channels: Mapping[str, Channel] = CHANNELS) -> None:
        self.path = Path(path)
        self._channels = channels
        self._file: IO[bytes] | None = None
        self._writer: Any = None  # its methods carry no types
        self._number: dict[str, int] = {}  # of each channel in the file
        self._count: dict[str, int] = {}  # of messages of each channel

    def on_start(self, run_info: RunInfo) -> None:
        """Open the file and write all that holds for the whole run."""
        self._info = run_info
        self._every_ns = round(run_info.scenario.recording.every * 1e9)
        self._cells, self._since_mesh, self._due_ns = -1, 0, self._every_ns
        self._file = self.path.open("wb")
        self._writer = mcap.writer.Writer(self._file)
        self._writer.start(profile="", library="cosim")
        self._write_run_data()
        self._register()
        self._write(0, {When.WORLD})
        self._write(0, {When.START})
        self._writer.flush()

    def on_frame(self, frame: Frame) -> None:
        """Write numbers of the window, its events, and pictures if they are due."""
        self._write(frame.t_ns, {When.WINDOW}, frame)
        for event in frame.events:
            self._write(event.t_ns, {When.EVENT}, event)
        if self._is_recorded(frame):
            self._write(frame.t_ns, {When.PICTURE, When.MESH} if self._with_mesh(frame) else {When.PICTURE}, frame)
            self._writer.flush()

    def on_close(self) -> None:
        """Finish the file; what was written until now can be read."""
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

    def _with_mesh(self, frame: Frame) -> bool:
        cells = int(frame.sheet.intact.sum())
        due = cells != self._cells or self._since_mesh >= MESH_EVERY - 1
        self._cells, self._since_mesh = cells, 0 if due else self._since_mesh + 1
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
        for topic, channel in self._channels.items():
            name = channel.schema.DESCRIPTOR.full_name
            if name not in schemas:
                data = build_file_descriptor_set(channel.schema).SerializeToString(deterministic=True)
                schemas[name] = self._writer.register_schema(name, "protobuf", data)
            self._number[topic] = self._writer.register_channel(topic, "protobuf", schemas[name])

    def _write(self, t_ns: int, when: set[When], *item: Frame | Event) -> None:
        """One message of every channel that is due and has something to say."""
        for topic, channel in self._channels.items():
            data = channel.take(self._info, *item) if channel.when in when else None
            if data is not None:
                self._count[topic] = self._count.get(topic, 0) + 1
                self._writer.add_message(self._number[topic], t_ns, data, t_ns, self._count[topic])


def attach(writer: Any, name: str, text: str) -> None:
    """A text that belongs to the run, as TOML."""
    writer.add_attachment(0, 0, name, "application/toml", text.encode())


def run_metadata(info: RunInfo) -> dict[str, str]:
    """What identifies a run: strings, as MCAP wants them."""
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
        "thickness_m": repr(info.thickness),
        "drift_m_s": repr(float(scenario.drift.velocity)),
        "ice_density": repr(float(scenario.ice.density)),
        "duration_ns": str(info.duration_ns),
        "window_ns": str(info.window_ns),
        "averaging_s": repr(float(scenario.averaging)),
        "characteristic_length_m": repr(characteristic_length(scenario.model)),
    }
