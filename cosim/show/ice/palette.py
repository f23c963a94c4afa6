"""Colours of pictures: told apart by people who do not see red from green (Okabe and Ito 2008), and by hatches."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cosim.recording import shapes
from coupling.interface import PHASES, Phase

if TYPE_CHECKING:
    from matplotlib.colors import LinearSegmentedColormap


def _hex(rgb: tuple[int, int, int]) -> str:
    return "#" + bytes(rgb).hex()


#: those of the recording, so that report, replay and stock viewers agree
BLOCK = {phase: _hex(rgb) for phase, rgb in shapes.PHASE_RGB.items()}
PHASE_COLOURS = {name: BLOCK[Phase(k)] for k, name in enumerate(PHASES)}
HATCH = {Phase.BREAKING: "", Phase.ROTATING: "", Phase.SLIDING: "//"}
ICE, WATER, WATERLINE = "#eef5fa", "#d3e3ee", "#4c7f9f"
STRUCTURE, CRACK = _hex(shapes.STRUCTURE_RGB), _hex(shapes.CRACKED_RGB)
EDGE, FORCE = "#2a3440", "#c0185a"
SHALLOW = "#b7c1cc"  #: cells that have begun to crack; `CRACK`: cracked through
UTILISATION = tuple(map(_hex, shapes.UTILISATION_RGB))  #: from ice to dark as utilisation goes to 1
AGE = "cividis"  #: time of failure


def colormap() -> LinearSegmentedColormap:
    """Of the utilisation, 0 to 1."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("utilisation", list(UTILISATION))
