"""Figures of matplotlib (extra ``report``): PNG in a file, vectors (SVG) in a page."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.errors import FailedError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MANY = 600  #: corners of a set of polygons from which a page holds it as pixels, its axes and texts as vectors
SVG: dict[Any, Any] = {"svg.hashsalt": "cosim"}  #: the same figure has the same bytes


def drawn(out: io.BytesIO | Path, draw: Callable[..., None], *about: Any) -> None:
    """Writes what ``draw(figure, *about)`` draws as PNG, without a screen."""
    _figure(draw, *about).savefig(out, format="png", dpi=130)


def embedded(draw: Callable[..., None], *about: Any) -> str:
    """A PNG as text, as `drawn` draws it."""
    buffer = io.BytesIO()
    drawn(buffer, draw, *about)
    return base64.b64encode(buffer.getvalue()).decode()


def picture(title: str, draw: Callable[..., None], *about: Any, caption: str = "") -> dict[str, str]:
    """A figure for an HTML page, with what is said below it."""
    import matplotlib

    figure, buffer = _figure(draw, *about), io.BytesIO()
    _as_pixels(figure)
    with matplotlib.rc_context(SVG):
        figure.savefig(buffer, format="svg", dpi=200, metadata={"Date": None, "Creator": None})
    source = f"data:image/svg+xml;base64,{base64.b64encode(buffer.getvalue()).decode()}"
    return {"title": title, "source": source, "caption": caption}


def _figure(draw: Callable[..., None], *about: Any) -> Figure:
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        text = f"{error.name} is missing: install the extra, for example `uv sync --extra report`"
        raise FailedError(text) from error
    figure = Figure(figsize=(9.0, 4.2), layout="constrained")
    draw(figure, *about)
    return figure


def _as_pixels(figure: Figure) -> None:
    from matplotlib.collections import Collection

    for found in figure.findobj(Collection):
        if sum(len(np.asarray(path.vertices)) for path in found.get_paths()) > MANY:
            found.set_rasterized(True)
