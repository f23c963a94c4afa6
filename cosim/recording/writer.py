"""Recordings written: a run becomes an MCAP file.

Scenario, reference and run data are written first, and the file is flushed after the first window and after every
`CHUNK_NS` of simulated time, so that a killed run leaves a file that lacks no more than that and the window under way.
All is under checksums, see `cosim.recording.records`. The same scenario gives the same bits: stamps are simulated time,
and nothing of the machine (clock, path, user) is written.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import IO, Any, Self

import mcap.writer
from mcap_protobuf.schema import build_file_descriptor_set

from cosim.errors import InputError
from cosim.observer import RunInfo
from cosim.outputs import drop, grow, trouble
from cosim.recording.channels import CHANNELS, Channel, When
from cosim.recording.metadata import COMPLETE, END, RUN, run_metadata, sealed
from cosim.recording.retrace import Retraced, Since, retrace
from cosim.scenario.files import read_toml
from cosim.scenario.scenario import Scenario
from coupling.interface import Event, Frame

CHUNK_NS = 250_000_000  #: of simulated time in a chunk of the file; a longer window is a chunk [ns]
VIEWS = 60  #: in a run, of what stock viewers draw
VIEW_TIMES = 2.0  #: at least between two of them, in times (h / g)^0.5 of ice of thickness h


class Recorder:
    """Observer that writes a run to ``path``. Closing is idempotent; use it in ``finally`` or as a context manager.

    An existing recording is kept unless ``force``; the one of an interrupted run goes on ``since`` its checkpoint.
    FailedError names the file if it cannot be written on.
    """

    def __init__(
        self,
        path: str | Path,
        channels: Mapping[str, Channel] = CHANNELS,
        force: bool = False,
        since: Since | None = None,
    ) -> None:
        self.path, self.force, self._since = Path(path), force, since
        self.ending = "it was stopped"  #: why the run ended, if it ends before its duration or in an error
        self.failed = False  #: it ended in an error, perhaps at its very end
        self.lights: Mapping[str, object] | None = None  #: how far the result can be trusted, of a run that has ended
        self.recorded_ns = 0  #: end of the last window in the file
        self._channels = channels
        self._file: IO[bytes] | Retraced | None = None
        self._writer: Any = None  # its methods carry no types
        self._number: dict[str, int] = {}  # of each channel in the file
        self._count: dict[str, int] = {}  # of messages of each channel

    def on_start(self, run_info: RunInfo) -> None:
        """Open the file and write all that holds for the whole run."""
        self._info = run_info
        self._every_ns = round(run_info.scenario.recording.every * 1e9)
        self._due_ns, self._view_ns = self._every_ns, 0
        texts = attachments(run_info.scenario)
        inputs = run_info.scenario.inputs
        self._file = grow(self.path, ".mcap", self.force, inputs) if self._since is None else Retraced(self.path)
        self._writer = new_writer(self._file)
        self._do(self._writer.start, profile="", library="cosim")
        for name, text in texts.items():
            self._do(attach, self._writer, name, text)
        self._do(self._writer.add_metadata, RUN, sealed(run_metadata(run_info, texts)))
        self._register()
        if self._since is not None:
            self._do(self._go_on, self._since)
            return
        self._write(0, {When.WORLD})
        self._write(0, {When.START})
        self._do(self._writer.flush)

    def _go_on(self, since: Since) -> None:
        """From the end of the window until which the file stays as it is."""
        first = next(topic for topic, channel in self._channels.items() if channel.when is When.WINDOW)
        self._count = dict(retrace(self._writer, self.path, since, first))
        self._due_ns, self._view_ns, self.recorded_ns = since.due_ns, since.view_ns, since.t_ns
        assert isinstance(self._file, Retraced)
        self._file.go_on()

    def settle(self) -> Since:
        """All of the file is on the disk; from where it could go on."""
        if self._file is not None:
            self._do(self._writer.flush)
            self._do(os.fsync, self._file.fileno())
        return Since(self.recorded_ns, self._due_ns, self._view_ns)

    def on_frame(self, frame: Frame) -> None:
        """Write numbers of the window, its events, and pictures if they are due."""
        self._write(frame.t_ns, {When.WINDOW}, frame)
        for event in frame.events:
            self._write(event.t_ns, {When.EVENT}, event)
        if self._is_recorded(frame):
            self._write(frame.t_ns, {When.PICTURE, When.VIEW} if self._with_view(frame) else {When.PICTURE}, frame)
        if self.recorded_ns == 0 or frame.t_ns // CHUNK_NS > self.recorded_ns // CHUNK_NS:
            self._do(self._writer.flush)
        self.recorded_ns = frame.t_ns

    def on_close(self) -> None:
        """Finish the file; what was written until now can be read. A file without a window is taken away."""
        if self._file is None:
            return
        if self.recorded_ns == 0:
            self._do(self._file.close)
            self._file = None
            drop(self.path)
            return
        reached = self.recorded_ns >= self._info.duration_ns
        ended = COMPLETE if reached and not self.failed else self.ending
        told = {} if self.lights is None else {"lights": json.dumps(self.lights)}
        self._do(self._writer.add_metadata, END, sealed({"ended": ended} | told))
        self._do(self._writer.finish)
        self._do(self._file.close)
        self._file = None

    close = on_close

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.on_close()

    def _do(self, call: Callable[..., object], *arguments: Any, **named: Any) -> None:
        """Something that writes; if it does not come to its end, the file is left as it is: cut off."""
        try:
            call(*arguments, **named)
        except BaseException as error:
            file, self._file = self._file, None
            if file is not None:
                with suppress(OSError):  # what is buffered cannot be written either
                    file.close()
            if isinstance(error, OSError):
                raise trouble(self.path, error) from error
            raise

    def _is_recorded(self, frame: Frame) -> bool:
        """Every so often, at the start and end, and whenever something breaks."""
        first = frame.t_ns <= self._info.window_ns
        last = frame.t_ns >= self._info.duration_ns
        due = frame.t_ns >= self._due_ns
        if due:
            self._due_ns = (frame.t_ns // self._every_ns + 1) * self._every_ns
        return first or last or bool(frame.events) or due

    def _with_view(self, frame: Frame) -> bool:
        """At the start, at the end, and evenly between; see `view_every_ns`."""
        due = frame.t_ns >= min(self._view_ns, self._info.duration_ns)
        if due:
            self._view_ns = frame.t_ns + view_every_ns(self._info)
        return due

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
            if channel.when in when and (data := channel.take(self._info, *item)) is not None:
                self._count[topic] = self._count.get(topic, 0) + 1
                self._do(self._writer.add_message, self._number[topic], t_ns, data, t_ns, self._count[topic])


def view_every_ns(info: RunInfo) -> int:
    """Between two pictures for stock viewers: `VIEWS` in a run, and no more than ice moves, `VIEW_TIMES`.

    They are the largest messages of a recording, and a short run would be made of nothing else.
    """
    least: float = VIEW_TIMES * (info.thickness / info.scenario.water.gravity) ** 0.5
    return max(info.duration_ns // VIEWS, round(least * 1e9))


def new_writer(file: Any) -> Any:
    """Of a file all of whose bytes are under checksums."""
    return mcap.writer.Writer(file, enable_data_crcs=True)


def attach(writer: Any, name: str, text: str) -> None:
    """A text that belongs to the run, as TOML."""
    writer.add_attachment(0, 0, name, "application/toml", text.encode())


def attachments(scenario: Scenario) -> dict[str, str]:
    """Texts that belong to a run, by name."""
    texts = {"scenario.toml": scenario.resolved_toml(), "scenario.as-written.toml": scenario.text}
    reference = scenario.folder / "reference.toml" if scenario.folder else None
    if reference is not None and reference.is_file():
        texts["reference.toml"] = read_toml(reference, InputError)[0]
    return texts
