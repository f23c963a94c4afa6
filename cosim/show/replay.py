"""`cosim replay`: a recording in rerun. Sheet, structure and blocks as solids, loads by phase, the log of events.

Nothing is converted on disk: the recording is read and sent to a viewer, or saved as .rrd.
"""

from __future__ import annotations

import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import rerun as rr
from rerun.components import AggregationPolicy

from cosim.analysis.run_data import RunData
from cosim.errors import FailedError
from cosim.outputs import whole
from cosim.recording import shapes
from cosim.recording.reader import recorded_pictures, recorded_structure
from cosim.show import pictures
from cosim.show.console import print_line
from cosim.show.layout import TIMELINE, blueprint, load_scale
from cosim.show.opening import opened
from cosim.show.viewer import screen_viewer, web_viewer
from coupling.interface import NS, PHASES, Phase

APPLICATION = "cosim"
TOTAL_RGB = (235, 235, 235)


def save(recording: Path, out: Path) -> None:
    """Write a rerun file with pictures, curves and layout."""
    run = opened(recording)
    with whole(out, ".rrd") as part:
        try:
            with stream() as sink:
                sink.save(part, default_blueprint=blueprint(run))
                send(sink, recording, run)
        except RuntimeError as error:  # rerun's only one
            raise FailedError(f"{out}: {error}; free space or write elsewhere") from error


def open_viewer(recording: Path) -> None:
    """Open the viewer on this machine's screen."""
    run = opened(recording)
    with screen_viewer() as url, stream() as sink:
        sink.connect_grpc(url, default_blueprint=blueprint(run))
        send(sink, recording, run)


def serve(recording: Path, port: int | None = None, browser: bool = True) -> None:
    """Serve viewer and data to a browser on this machine, until interrupted."""
    run = opened(recording)
    with web_viewer(port) as (url, page, process):
        with stream() as sink:
            sink.connect_grpc(url, default_blueprint=blueprint(run))
            send(sink, recording, run)
        print_line(page)
        print_line("this machine only; Ctrl-C ends it")
        if browser:
            webbrowser.open(page)
        code = process.wait()
    raise FailedError(f"the viewer ended by itself (exit code {code}); try again, or save a .rrd with --save")


def send(stream: rr.RecordingStream, recording: Path, run: RunData) -> None:
    """All of a run: pictures of the recorded frames, loads of every window, events."""
    _send_loads(stream, run)
    for event in run.events:
        stream.set_time(TIMELINE, duration=event.t_ns / NS)
        stream.log("events", rr.TextLog(f"{event.kind}: {event.text}", level=_level(event.kind)))
    points, faces = recorded_structure(recording)
    structure = pictures.flat_mesh("structure", 0, points, faces, shapes.STRUCTURE_RGB)
    shown = (pictures.meshes(picture, float(run.metadata["thickness_m"])) for picture in recorded_pictures(recording))
    for mesh in chain([structure], chain.from_iterable(shown)):
        stream.set_time(TIMELINE, duration=mesh.t_ns / NS)
        stream.log(f"world/{mesh.name}", _mesh(mesh), static=mesh.name == "structure")
    stream.flush()


def _send_loads(stream: rr.RecordingStream, run: RunData) -> None:
    # curves are drawn in the order of their paths: the total first, so that it hides no phase
    series = [("all", "total", None, TOTAL_RGB), *((p, p, p, shapes.PHASE_RGB[Phase(k)]) for k, p in enumerate(PHASES))]
    run = run.lasting
    scale = load_scale(run)
    index = rr.TimeColumn(TIMELINE, duration=run.t)
    for axis in ("fx", "fz"):
        for key, name, phase, rgb in series:
            path = f"load/{axis}/{key}"
            width = 3.5 if phase is None else 1.6
            # no aggregation: the viewer would draw means over what falls on one pixel, and the peak would be lower
            line = rr.SeriesLines(names=name, colors=rgb, widths=width, aggregation_policy=AggregationPolicy.Off)
            stream.log(path, line, static=True)
            values = rr.Scalars.columns(scalars=run.component(axis, phase) / scale.size)
            stream.send_columns(path, indexes=[index], columns=values)


def _mesh(mesh: pictures.Mesh) -> Any:
    if not len(mesh.faces):
        return rr.Clear(recursive=False)
    rgb = np.broadcast_to(mesh.rgb, mesh.vertices.shape).astype(np.uint8)
    return rr.Mesh3D(
        vertex_positions=mesh.vertices.astype(np.float32),
        triangle_indices=mesh.faces,
        vertex_normals=mesh.normals.astype(np.float32),
        vertex_colors=rgb,
    )


def _level(kind: str) -> str:
    return "WARN" if kind in ("split", "circumferential") else "INFO"


@contextmanager
def stream() -> Iterator[rr.RecordingStream]:
    """Where a run is sent to; let go of on the way out."""
    sink = rr.RecordingStream(APPLICATION)
    try:
        yield sink
    finally:
        sink.disconnect()
