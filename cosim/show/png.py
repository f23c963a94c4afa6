"""Figures of matplotlib (extra ``report``) as PNG: in a page or in a file."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

from cosim.errors import FailedError


def drawn(out: io.BytesIO | Path, draw: Callable[..., None], *about: Any) -> None:
    """Writes what ``draw(figure, *about)`` draws as PNG, without a screen."""
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        text = f"{error.name} is missing: install the extra, for example `uv sync --extra report`"
        raise FailedError(text) from error
    figure = Figure(figsize=(9.0, 4.2), layout="constrained")
    draw(figure, *about)
    figure.savefig(out, format="png", dpi=130)


def picture(title: str, draw: Callable[..., None], *about: Any) -> dict[str, str]:
    """A figure for an HTML page."""
    buffer = io.BytesIO()
    drawn(buffer, draw, *about)
    return {"title": title, "png": base64.b64encode(buffer.getvalue()).decode()}
