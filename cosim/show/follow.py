"""`cosim replay --follow`: a run in rerun while it is being recorded; ends with the run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import rerun as rr
import rerun.blueprint as rrb

from cosim.analysis.run_data import RunData
from cosim.outputs import whole
from cosim.recording.decoding import DATA_TOPICS, Stored, decode
from cosim.recording.pictures import TOPICS, pictures
from cosim.recording.reader import in_order
from cosim.recording.tail import Tail, begun
from cosim.show import replay
from cosim.show.console import print_line
from cosim.show.ice.scene import scene_of
from cosim.show.layout import TIMELINE, blueprint, load_scale
from cosim.show.opening import opened
from cosim.show.viewer import screen_viewer, web_viewer
from coupling.interface import NS

LOAD = "/load/structure"


Opened = Callable[[RunData], rr.RecordingStream]  #: opens where a run is sent to, with the layout for it


def follow(recording: Path, out: Path | None = None, web: bool = False) -> None:
    """Sends what is recorded to a viewer, or into a file (.rrd), as it comes, until the run ends."""
    run = begun(recording)
    with _into(out) if out is not None else _browser() if web else _screen() as opens:
        sink, scene = opens(run), scene_of(run)
        section = scene.section_at(0.0)
        replay.name_curves(sink)
        replay.send_still(sink, recording, scene, section)
        for picture in pictures(Following(sink, run, load_scale(run).size).stored(recording)):
            replay.send_picture(sink, picture, scene, section)
        text = replay.about(opened(recording))
        sink.log("about", rr.TextDocument(text, media_type="text/markdown"), static=True)
        sink.flush()


def _layout(run: RunData) -> rrb.Blueprint:
    return blueprint(run, int(run.metadata["duration_ns"]) / NS)


@contextmanager
def _into(out: Path) -> Iterator[Opened]:
    with whole(out, ".rrd") as part, replay.stream() as sink:
        made = sink.memory_recording()

        def opens(run: RunData) -> rr.RecordingStream:
            sink.send_blueprint(_layout(run))
            return sink

        yield opens
        part.write_bytes(made.drain_as_bytes() or b"")


@contextmanager
def _screen() -> Iterator[Opened]:
    with screen_viewer() as url, replay.stream() as sink:
        yield lambda run: _connected(sink, url, run)


@contextmanager
def _browser() -> Iterator[Opened]:
    with web_viewer() as (url, page, process):
        print_line(page)
        with replay.stream() as sink:
            yield lambda run: _connected(sink, url, run)
        print_line("the run has ended; Ctrl-C ends the viewer")
        process.wait()


def _connected(sink: rr.RecordingStream, url: str, run: RunData) -> rr.RecordingStream:
    sink.connect_grpc(url, default_blueprint=_layout(run))
    return sink


@dataclass
class Following:
    """Sends loads and events as they come, and gives the parts of pictures on."""

    sink: rr.RecordingStream
    run: RunData  #: as it was when it was first seen
    size: float  #: in which loads are told [N]
    _windows: list[Stored] = field(default_factory=list)

    def stored(self, recording: Path) -> Iterator[Stored]:
        """Messages of pictures."""
        for record in in_order(recording, Tail(recording)):
            if isinstance(record, tuple):
                if record[0] in TOPICS:
                    yield record
                elif record[0] in DATA_TOPICS:
                    self._data(record)

    def _data(self, record: Stored) -> None:
        """Loads as their mean over the averaging time until now, events as lines."""
        if record[0] == LOAD:
            since = record[1] - 2.0 * self.run.averaging * NS
            later = sum(w[1] >= since for w in self._windows)
            self._windows = [*self._windows[-later - 1 :], record]  # and the one before: each begins where that ends
            now = decode(self.run.name, self.run.metadata, self.run.texts, self._windows)
            self.sink.set_time(TIMELINE, duration=record[1] / NS)
            for path, values in replay.curves(now.lasting):
                self.sink.log(path, rr.Scalars(float(values[-1]) / self.size))
        elif record[0] == "/events":
            for event in decode(self.run.name, self.run.metadata, self.run.texts, [record]).events:
                replay.send_event(self.sink, event)
