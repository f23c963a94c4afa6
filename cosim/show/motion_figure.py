"""The motion of the structure over time as a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cosim.analysis.motion import motion
from cosim.analysis.run_data import RunData

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw(figure: Figure, run: RunData) -> None:
    """Every degree of freedom that moves, each in its own panel."""
    moved = list(motion(run) or {})
    axes = figure.subplots(max(len(moved), 1), 1, sharex=True, squeeze=False)[:, 0]
    for ax, name in zip(axes, moved, strict=False):
        turns = name in ("roll", "pitch", "yaw")
        way = np.degrees(run.motion[name]) if turns else run.motion[name]
        ax.plot(run.t, way, "k", lw=0.9)
        ax.set_ylabel(f"{name} [{'deg' if turns else 'm'}]")
        ax.grid(alpha=0.3)
    axes[-1].set_xlabel("time [s]")
    axes[-1].set_xlim(0.0, run.t[-1])
