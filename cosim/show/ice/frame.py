"""What axes with one scale for both directions show."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Frame = tuple[float, float, float, float]  #: from, to to the right, then from, to upwards [m]
BEFORE = 0.6  #: part of what is added that lies before the structure


def set_frame(ax: Axes, frame: Frame, fill: bool) -> None:
    """Shows this; with ``fill`` as much more to the sides, or upwards and downwards, as the axes have room for."""
    left, right, low, high = frame
    if fill:
        wanted = ax.bbox.width / ax.bbox.height
        wide, tall = right - left, high - low
        more = max(wanted * tall - wide, 0.0)
        left, right = left - BEFORE * more, right + (1.0 - BEFORE) * more
        more = max(wide / wanted - tall, 0.0)
        low, high = low - 0.5 * more, high + 0.5 * more
    ax.set(xlim=(left, right), ylim=(low, high), aspect="equal")
