"""`cosim replay`: a recording in rerun. Sheet, structure and blocks as solids, loads by phase, the log of events.

Nothing is converted on disk: the recording is read and sent to a viewer, or saved as .rrd.
"""

from __future__ import annotations

import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import rerun as rr
from rerun.components import AggregationPolicy

from cosim.analysis.lights import trust, trust_lines
from cosim.analysis.run_data import RunData
from cosim.errors import FailedError
from cosim.outputs import whole
from cosim.recording import shapes
from cosim.recording.pictures import Picture
from cosim.recording.reader import recorded_pictures, recorded_structure
from cosim.series.series import Series
from cosim.show import pictures
from cosim.show.console import print_line
from cosim.show.ice.history import busiest
from cosim.show.ice.scene import Scene, scene_of
from cosim.show.ice.strips import FORCE_RGB, Strips, moving_strips, still_strips
from cosim.show.layout import TIMELINE, blueprint, load_scale
from cosim.show.opening import opened
from cosim.show.pictures import still_meshes
from cosim.show.viewer import screen_viewer, web_viewer
from coupling.interface import NS, PHASES, Array, Event, Phase
from coupling.structure.moved import turned

APPLICATION = "cosim"
TOTAL_RGB, MEASURED_RGB, DRIFT_RGB = (140, 150, 165), (204, 121, 167), (120, 200, 255)
Measured = Callable[[RunData], Series] | None  #: gives a measured series in the time of a run
#: of the load: entity, name, phase, colour; drawn in the order of their entities, the total first: it hides no phase
OUTLINE = "/structure"  #: how names of outlines of the structure end
CURVES = (("all", "total", None, TOTAL_RGB), *((p, p, p, shapes.PHASE_RGB[Phase(k)]) for k, p in enumerate(PHASES)))


def save(recording: Path, out: Path, measured: Measured = None) -> None:
    """Write a rerun file with pictures, curves and layout; as the others with a series laid over the curves.

    It is made in memory and written in one go: rerun's own writer waits without end where a disk is full.
    """
    run = opened(recording)
    with whole(out, ".rrd") as part, stream() as sink:
        made = sink.memory_recording()
        sink.send_blueprint(blueprint(run))
        send(sink, recording, run, measured)
        part.write_bytes(made.drain_as_bytes() or b"")


def open_viewer(recording: Path, measured: Measured = None) -> None:
    """Open the viewer on this machine's screen."""
    run = opened(recording)
    with screen_viewer() as url, stream() as sink:
        sink.connect_grpc(url, default_blueprint=blueprint(run))
        send(sink, recording, run, measured)


def serve(recording: Path, measured: Measured = None, port: int | None = None, browser: bool = True) -> None:
    """Serve viewer and data to a browser on this machine, until interrupted."""
    run = opened(recording)
    with web_viewer(port) as (url, page, process):
        with stream() as sink:
            sink.connect_grpc(url, default_blueprint=blueprint(run))
            send(sink, recording, run, measured)
        print_line(page)
        print_line("this machine only; Ctrl-C ends it")
        if browser:
            webbrowser.open(page)
        code = process.wait()
    raise FailedError(f"the viewer ended by itself (exit code {code}); try again, or save a .rrd with --save")


def send(sink: rr.RecordingStream, recording: Path, run: RunData, measured: Measured = None) -> None:
    """All of a run: pictures of the recorded frames, sections, plan, loads of every window, events, lights."""
    _send_loads(sink, run)
    if measured is not None:
        _send_measured(sink, measured(run), load_scale(run).size)
    sink.log("about", rr.TextDocument(about(run), media_type="text/markdown"), static=True)
    for event in run.events:
        send_event(sink, event)
    scene, section = scene_of(run), shown_section(run, recording)
    send_still(sink, recording, scene, section, moves=bool(run.motion))
    for picture in recorded_pictures(recording):
        send_picture(sink, picture, scene, section)
        if run.motion:
            _send_moved(sink, scene.at(run, picture.t_ns), section)
    sink.flush()


def send_event(sink: rr.RecordingStream, event: Event) -> None:
    """A line of the log."""
    sink.set_time(TIMELINE, duration=event.t_ns / NS)
    sink.log("events", rr.TextLog(f"{event.kind}: {event.text}", level=_level(event.kind)))


def send_still(sink: rr.RecordingStream, recording: Path, scene: Scene, section: int, moves: bool = False) -> None:
    """What does not move; outlines of the structure only if it does not."""
    for mesh in still_meshes(recorded_structure(recording), scene):
        sink.log(f"world/{mesh.name}", _mesh(mesh), static=True)
    for strips in still_strips(scene, section):
        if not (moves and strips.name.endswith(OUTLINE)):
            sink.log(strips.name, _strips(strips), static=True)
    h = scene.thickness
    start = [[float(-scene.reach - 8.0 * h), 0.0, 4.0 * h]]
    arrow = rr.Arrows3D(origins=start, vectors=[[6.0 * h, 0.0, 0.0]], colors=[DRIFT_RGB], radii=0.12 * h)
    sink.log("world/drift", arrow, static=True)


def send_picture(sink: rr.RecordingStream, picture: Picture, scene: Scene, section: int) -> None:
    """A recorded frame."""
    sink.set_time(TIMELINE, duration=picture.t_ns / NS)
    for mesh in pictures.meshes(picture, scene.thickness):
        sink.log(f"world/{mesh.name}", _mesh(mesh))
    for strips in moving_strips(scene, picture, section):
        sink.log(strips.name, _strips(strips))
    sink.log("world/load", _arrow(picture, scene))


def _send_moved(sink: rr.RecordingStream, scene: Scene, section: int) -> None:
    """Where a structure that moves is, at the time of the picture before."""
    place = np.array(scene.place)
    sink.log("world/structure", rr.Transform3D(translation=place[:3], mat3x3=turned(place[3:])))
    for strips in still_strips(scene, section):
        if strips.name.endswith(OUTLINE):
            sink.log(strips.name, _strips(strips))


def shown_section(run: RunData, recording: Path) -> int:
    """The section that bears most when the load is largest."""
    if not len(run.t_ns):
        return 0
    peak, found = int(run.t_ns[int(run.lasting.component("f").argmax())]), None
    for picture in recorded_pictures(recording):
        if found is None or picture.t_ns <= peak:
            found = picture
    return scene_of(run).section_at(0.0 if found is None else busiest(found))


def _strips(strips: Strips) -> Any:
    if not strips.lines:
        return rr.Clear(recursive=False)
    radii = rr.Radius.ui_points(0.5 * strips.width)
    return rr.LineStrips2D(strips.lines, colors=strips.rgb, radii=radii)


def _arrow(picture: Picture, scene: Scene) -> Any:
    """The load, its tip at the point of attack."""
    total = picture.forces.force.sum(axis=0)
    size = float(np.linalg.norm(total))
    if size == 0.0:
        return rr.Clear(recursive=False)
    weight = np.linalg.norm(picture.forces.force, axis=1)
    vector = total / size * 6.0 * scene.thickness
    at = weight @ picture.forces.position / weight.sum()
    return rr.Arrows3D(origins=[at - vector], vectors=[vector], colors=[FORCE_RGB], radii=0.12 * scene.thickness)


def about(run: RunData) -> str:
    """What is seen, and how far it can be trusted, as Markdown."""
    lines = "\n".join(f"* {line}" for line in trust_lines(trust(run)))
    return (
        f"# {run.metadata['title']}\n\n{lines}\n\n* sheet: pale to red as its utilisation goes to 1, dark where it is "
        "cracked\n* blocks: orange rotate, green slide\n* pink: the load at its point of attack; blue: the drift\n"
    )


def _send_loads(sink: rr.RecordingStream, run: RunData) -> None:
    scale = load_scale(run)
    name_curves(sink)
    index = rr.TimeColumn(TIMELINE, duration=run.t)
    for path, values in curves(run.lasting):
        sink.send_columns(path, indexes=[index], columns=rr.Scalars.columns(scalars=values / scale.size))


def _send_measured(sink: rr.RecordingStream, series: Series, size: float) -> None:
    """The components that the series has, in the time of the run."""
    for axis in (axis for axis in ("fx", "fz") if axis in series.loads):
        path = f"load/{axis}/measured"
        line = rr.SeriesLines(names=series.name, colors=MEASURED_RGB, aggregation_policy=AggregationPolicy.Off)
        sink.log(path, line, static=True)
        index = rr.TimeColumn(TIMELINE, duration=series.t)
        sink.send_columns(path, indexes=[index], columns=rr.Scalars.columns(scalars=series.loads[axis] / size))


def name_curves(sink: rr.RecordingStream) -> None:
    """How each curve of the load looks."""
    for axis in ("fx", "fz"):
        for key, name, phase, rgb in CURVES:
            width = 3.5 if phase is None else 1.6
            # no aggregation: the viewer would draw means over what falls on one pixel, and the peak would be lower
            line = rr.SeriesLines(names=name, colors=rgb, widths=width, aggregation_policy=AggregationPolicy.Off)
            sink.log(f"load/{axis}/{key}", line, static=True)


def curves(run: RunData) -> Iterator[tuple[str, Array]]:
    """Where each curve goes, and its values (n,) [N]."""
    for axis in ("fx", "fz"):
        for key, _, phase, _ in CURVES:
            yield f"load/{axis}/{key}", run.component(axis, phase)


def _mesh(mesh: pictures.Mesh) -> Any:
    if not len(mesh.faces):
        return rr.Clear(recursive=False)
    rgb = np.broadcast_to(mesh.rgb, (len(mesh.vertices), mesh.rgb.shape[-1])).astype(np.uint8)
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
