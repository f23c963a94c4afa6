"""One picture of a run at an instant: the ice in three dimensions, from above and in section, the load until then.

It is what ``cosim replay --screenshot`` writes and of which ``--video`` makes a film. Nothing of a viewer is in it.
"""

from __future__ import annotations

import io
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.analysis.lights import trust
from cosim.analysis.run_data import RunData
from cosim.errors import FailedError, InputError
from cosim.recording.pictures import Picture
from cosim.recording.reader import recorded_pictures, recorded_structure
from cosim.show.figures import draw_loads
from cosim.show.ice.history import Failures, Look, busiest
from cosim.show.ice.palette import colormap
from cosim.show.ice.plan import draw_plan
from cosim.show.ice.scene import scene_of
from cosim.show.ice.section import draw_section
from cosim.show.scale import scale_of
from cosim.show.view3d import View
from coupling.interface import NS, Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZE, DOTS = (16.0, 9.0), 100  #: of a picture [inch], and in an inch
LEFT = 1.28  #: width of the left half over the right one
WIDEST = 118  #: letters in a line of the lights


class Stills:
    """Draws pictures of one run, in the order of time; ``section`` is the y of the section, else the busiest [m]."""

    def __init__(self, run: RunData, recording: Path, section: float | None = None) -> None:
        self._run, self._section = run, section
        self._scene = scene_of(run)
        width = LEFT / (LEFT + 1.0) * SIZE[0]
        pixels = round(width * DOTS), round(SIZE[1] * DOTS)
        self._view = View(self._scene, recorded_structure(recording), pixels)
        self._failures = Failures()

    def see(self, picture: Picture) -> None:
        """A picture that is passed over."""
        self._failures.see(picture)

    def draw(self, picture: Picture) -> Array:
        """(height, width, 3) as bytes."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.see(picture)
        figure = Figure(figsize=SIZE, dpi=DOTS)
        canvas: Any = FigureCanvasAgg(figure)
        y = busiest(picture) if self._section is None else self._section
        self._compose(figure, Look("", picture, self._failures.time, y))
        canvas.draw()
        image: Array = np.asarray(canvas.buffer_rgba())[:, :, :3]
        return image

    def _compose(self, figure: Figure, look: Look) -> None:
        left, right = _split(figure)
        ax = left.add_axes((0.0, 0.0, 1.0, 1.0))
        scene = self._scene.at(self._run, look.picture.t_ns)
        ax.imshow(self._view.draw(look.picture, scene.place), aspect="auto", interpolation="antialiased")
        ax.axis("off")
        about = f"{self._run.metadata['title']}\n{look.picture.t_ns / NS:.2f} s{_load(look.picture)}"
        _bar(ax)
        box = {"fc": "w", "ec": "none", "alpha": 0.88, "pad": 6}
        ax.text(0.02, 0.975, about, transform=ax.transAxes, va="top", fontsize=14, parse_math=False, bbox=box)
        top, middle, low = right.subfigures(3, 1, height_ratios=(1.15, 0.95, 1.1))
        draw_plan(_one(top), scene, look, fill=True)
        draw_section(_one(middle), scene, look.picture, look.section, fill=True)
        low.subplots_adjust(left=0.12, right=0.97, top=0.9, bottom=0.17, hspace=0.12)
        draw_loads(low, self._run)
        for axes in low.axes:
            axes.axvline(look.picture.t_ns / NS, color="#c0185a", lw=1.4)
        found = trust(self._run)
        text, colour = "\u2713 within the limits of all lights", "#0072b2"
        if not found["trustworthy"]:
            text, colour = "\u2717 not trustworthy: " + "; ".join(found["because"]), "#b03a2e"
        text = textwrap.fill(text, WIDEST)
        ax.text(0.02, 0.12, text, transform=ax.transAxes, fontsize=9, color=colour, parse_math=False, bbox=box)

    def close(self) -> None:
        """Let go of the window."""
        self._view.close()


def _bar(ax: Axes) -> None:
    """What the colours of the sheet mean."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.patches import Rectangle

    back = Rectangle((0.01, 0.01), 0.36, 0.088, transform=ax.transAxes, fc="w", ec="none", alpha=0.75)
    ax.add_patch(back)
    bar = ax.figure.colorbar(
        ScalarMappable(cmap=colormap()), cax=ax.inset_axes((0.03, 0.045, 0.32, 0.018)), orientation="horizontal"
    )
    bar.set_ticks([0.0, 0.5, 1.0])
    bar.ax.set_title("utilisation of the sheet (fails at 1)", fontsize=9, pad=3.0)
    bar.ax.tick_params(labelsize=9, pad=2.0)


def _load(picture: Picture) -> str:
    """The force that the arrow shows."""
    size = float(np.linalg.norm(picture.forces.force.sum(axis=0))) if len(picture.forces.force) else 0.0
    return f"; arrow: load {scale_of((size,), 'N').labelled(size)} in this window" if size else "; no load"


def _split(figure: Any) -> Any:
    return figure.subfigures(1, 2, width_ratios=(LEFT, 1.0))


def _one(figure: Any) -> Any:
    figure.subplots_adjust(left=0.12, right=0.97, top=0.92, bottom=0.16)
    return figure.subplots()


def screenshot(run: RunData, recording: Path, out: Path, at: float | None = None, section: float | None = None) -> None:
    """Write the last picture that was recorded until a simulated time [s], default the end."""
    from PIL import Image

    at = float(run.t[-1]) if at is None else at
    if not 0 <= at <= run.t[-1]:
        raise InputError(f"--at {at:g}: outside of the run; give 0 to {run.t[-1]:g} s")
    stills, chosen = Stills(run, recording, section), None
    try:
        for picture in recorded_pictures(recording):
            if chosen is not None and picture.t_ns > round(at * NS):
                break
            stills.see(picture)
            chosen = picture
        if chosen is None:
            raise InputError(f"{recording}: holds no picture; run the scenario again")
        buffer = io.BytesIO()
        Image.fromarray(stills.draw(chosen).astype(np.uint8)).save(buffer, format="png")
        out.write_bytes(buffer.getvalue())
    finally:
        stills.close()


def video(
    run: RunData, recording: Path, out: Path, told: Callable[[int, int], None], fps: int = 10, most: int = 300
) -> int:
    """Write a film (.mp4, H.264) of at most so many recorded pictures; ``told`` how many of how many are done."""
    import imageio_ffmpeg

    size = round(SIZE[0] * DOTS), round(SIZE[1] * DOTS)
    writer = imageio_ffmpeg.write_frames(
        str(out), size, fps=fps, codec="libx264", output_params=["-f", "mp4"], macro_block_size=4
    )
    writer.send(None)
    count = 0
    try:
        for count, (_, total, image) in enumerate(frames(run, recording, most), 1):
            writer.send(np.ascontiguousarray(image, np.uint8))
            told(count, total)
    finally:
        writer.close()
    return count


def frames(run: RunData, recording: Path, most: int) -> Iterator[tuple[float, int, Array]]:
    """Simulated time [s], number of all, and picture, evenly chosen from the recorded ones, at most so many."""
    times = np.array([p.t_ns for p in recorded_pictures(recording)])
    if not len(times):
        raise FailedError(f"{recording}: holds no picture; run the scenario again")
    wanted = np.linspace(times[0], times[-1], most)
    chosen = set(np.unique(np.abs(times[:, None] - wanted).argmin(axis=0)).tolist())
    stills = Stills(run, recording)
    try:
        for k, picture in enumerate(recorded_pictures(recording)):
            stills.see(picture)
            if k in chosen:
                yield picture.t_ns / NS, len(chosen), stills.draw(picture)
    finally:
        stills.close()
