"""`cosim replay`: a recording in rerun. Sheet, structure and blocks as solids, loads by phase, the log of events.

Nothing is converted on disk: the recording is read and sent to a viewer, saved as .rrd, or photographed headless.
"""

from __future__ import annotations

import json
import socket
import subprocess
import time
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from cosim import pictures, shapes
from cosim.errors import FailedError, InputError
from cosim.recording import messages, read_run
from cosim.run_data import RunData
from coupling.interface import NS, PHASES, Phase

APPLICATION = "cosim"
TIMELINE = "simulated_time"
TOTAL_RGB = (235, 235, 235)
NO_DRIVER = (
    "the viewer found no Vulkan driver for a picture without screen; "
    "install one, on Debian: apt-get install mesa-vulkan-drivers"
)


def save(recording: Path, out: Path) -> None:
    """Write a rerun file with pictures, curves and layout."""
    with _stream() as stream:
        run = read_run(recording)
        stream.save(out, default_blueprint=blueprint(run))
        send(stream, recording, run)


def open_viewer(recording: Path) -> None:
    """Open the viewer on this machine's screen."""
    with _stream() as stream:
        run = read_run(recording)
        stream.spawn(default_blueprint=blueprint(run))
        send(stream, recording, run)


def serve(recording: Path) -> None:
    """Serve viewer and data to a browser on this machine, until interrupted."""
    with _stream() as stream:
        run = read_run(recording)
        url = stream.serve_grpc(default_blueprint=blueprint(run))
        send(stream, recording, run)
        rr.serve_web_viewer(connect_to=url, open_browser=True)
        while True:
            time.sleep(1)


def screenshot(
    recording: Path, out: Path, at: float | None = None, size: tuple[int, int] = (1800, 1050), settle: float = 6.0
) -> list[str]:
    """Write a picture at a simulated time [s], default the end; returns what the views complain about.

    ``settle`` [s] of wall time lets the viewer's start-up notices fade, which else cover part of the picture.
    """
    run = read_run(recording)
    at = float(run.t[-1]) if at is None else at
    if not 0 <= at <= run.t[-1]:
        raise InputError(f"--time {at:g}: outside of the run; give 0 to {run.t[-1]:g} s")
    with _headless_viewer(size) as (url, client):
        with _stream() as stream:
            stream.connect_grpc(url, default_blueprint=blueprint(run))
            send(stream, recording, run)
        _wait_until_loaded(client, run)
        client.set_time(TIMELINE, duration=at, play_state="paused")
        time.sleep(settle)
        out.write_bytes(client.take_screenshot())
        return [str(report) for view in client.get_state().views for report in view.reports]


def send(stream: rr.RecordingStream, recording: Path, run: RunData) -> None:
    """All of a run: pictures of the recorded frames, loads of every window, events."""
    _send_loads(stream, run)
    for event in run.events:
        stream.set_time(TIMELINE, duration=event.t_ns / NS)
        stream.log("events", rr.TextLog(f"{event.kind}: {event.text}", level=_level(event.kind)))
    for mesh in pictures.meshes(messages(recording, pictures.TOPICS), float(run.metadata["thickness_m"])):
        stream.set_time(TIMELINE, duration=mesh.t_ns / NS)
        stream.log(f"world/{mesh.name}", _mesh(mesh), static=mesh.name == "structure")
    stream.flush()


def blueprint(run: RunData) -> rrb.Blueprint:
    """Two cameras on the left, of the sheet and of the rubble; loads and events on the right."""
    reach = 0.5 * float(run.metadata["spacing_m"]) * max(_nodes(run))
    above = _view(
        "Sheet: blue to red = utilisation, dark = cracked",
        (-0.5 * reach - 44, -0.6 * reach - 46, 0.4 * reach + 36),
        (-0.3 * reach - 8, -4, -4),
        (24, 34, 52),
    )
    below = _rubble_view(run)
    curves = [
        rrb.TimeSeriesView(
            origin=f"/load/{axis}",
            name=f"{label} on the structure [MN]",
            plot_legend=rrb.PlotLegend(corner="LeftTop", visible=True),
        )
        for axis, label in (("fx", "Fx"), ("fz", "Fz"))
    ]
    log = rrb.TextLogView(origin="/events", name="Events")
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(above, below), rrb.Vertical(*curves, log, row_shares=[3, 3, 2]), column_shares=[3, 2]
        ),
        rrb.TimePanel(timeline=TIMELINE, state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )


def _rubble_view(run: RunData) -> Any:
    """From under water, or from above it where ice rides up: close by, as blocks are as long as a few thicknesses."""
    scenario = tomllib.loads(run.texts.get("scenario.toml", ""))
    colours = "orange = rotating, green = sliding"
    if scenario.get("structure", {}).get("breaking") != "upward":
        return _view(f"Rubble from under water: {colours}", (-58, -52, -24), (-12, 0, -7), (14, 52, 70))
    h = float(run.metadata["thickness_m"])
    return _view(
        f"Rubble from above: {colours}", (-14.0 * h - 4, -16.0 * h - 8, 7.0 * h + 4), (-2.0 * h, 0, 0), (14, 52, 70)
    )


def _nodes(run: RunData) -> list[int]:
    nodes: list[int] = json.loads(run.metadata["nodes"])
    return nodes


def _view(name: str, position: tuple[float, ...], target: tuple[float, ...], rgb: tuple[int, int, int]) -> Any:
    return rrb.Spatial3DView(
        name=name,
        origin="/world",
        background=rrb.Background(color=(*rgb, 255), kind="SolidColor"),
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(position=position, look_target=target, eye_up=(0, 0, 1)),
    )


def _send_loads(stream: rr.RecordingStream, run: RunData) -> None:
    # curves are drawn in the order of their paths: the total first, so that it hides no phase
    series = [("all", "total", None, TOTAL_RGB), *((p, p, p, shapes.PHASE_RGB[Phase(k)]) for k, p in enumerate(PHASES))]
    index = rr.TimeColumn(TIMELINE, duration=run.t)
    for axis in ("fx", "fz"):
        for key, name, phase, rgb in series:
            path = f"load/{axis}/{key}"
            width = 3.5 if phase is None else 1.6
            stream.log(path, rr.SeriesLines(names=name, colors=rgb, widths=width), static=True)
            values = rr.Scalars.columns(scalars=run.component(axis, phase) * 1e-6)
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
def _stream() -> Iterator[rr.RecordingStream]:
    stream = rr.RecordingStream(APPLICATION)
    try:
        yield stream
    finally:
        stream.disconnect()


@contextmanager
def _headless_viewer(size: tuple[int, int]) -> Iterator[tuple[str, Any]]:
    """A viewer without screen that listens on this machine only; ended on the way out."""
    import rerun_cli
    from rerun.experimental import ViewerClient

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    binary = Path(rerun_cli.__file__).with_name("rerun")
    process = subprocess.Popen(
        [
            binary,
            "--headless",
            "--bind",
            "127.0.0.1",
            "--port",
            str(port),
            "--window-size",
            f"{size[0]}x{size[1]}",
            "--hide-welcome-screen",
        ],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    url = f"rerun+http://127.0.0.1:{port}/proxy"
    try:
        yield url, _connect(ViewerClient, url, process)
    finally:
        process.terminate()
        process.wait(timeout=10)


def _connect(client_class: Any, url: str, process: subprocess.Popen[bytes], patience: float = 30.0) -> Any:
    until = time.monotonic() + patience
    while time.monotonic() < until:
        if process.poll() is not None:
            raise FailedError(NO_DRIVER)
        try:
            client = client_class.connect(url)
            client.get_state()
            return client
        except Exception:
            time.sleep(0.1)
    raise FailedError(f"the viewer did not answer within {patience:g} s; try again, or save a .rrd with --save")


def _wait_until_loaded(client: Any, run: RunData, patience: float = 120.0) -> None:
    until = time.monotonic() + patience
    while time.monotonic() < until:
        state = client.get_state()
        if not state.loading and state.views and _end_of(state) >= run.t_ns[-1]:
            return
        time.sleep(0.1)
    raise FailedError(f"the viewer did not load the run within {patience:g} s; save a .rrd with --save instead")


def _end_of(state: Any) -> int:
    """Latest simulated time that the viewer has [ns]."""
    ends = [t.end for recording in state.recordings for t in recording.timelines if t.name == TIMELINE]
    return max((end for end in ends if end is not None), default=-1)
