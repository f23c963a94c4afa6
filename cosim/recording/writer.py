"""Recordings written: a run becomes an MCAP file.

Scenario, reference and run data are written first, and the file is flushed at every recorded frame, so that a killed
run leaves a file that `cosim.recording.recover` can read. The same scenario gives the same bits: stamps are simulated
time, and nothing of the machine (clock, path, user) is written.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import IO, Any, Self

import mcap.writer
from mcap_protobuf.schema import build_file_descriptor_set

from cosim.observer import RunInfo
from cosim.recording import channels
from coupling.interface import Frame

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
