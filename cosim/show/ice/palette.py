"""Colours of pictures: told apart by people who do not see red from green (Okabe and Ito 2008), and by hatches."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coupling.interface import Phase

if TYPE_CHECKING:
    from matplotlib.colors import LinearSegmentedColormap

PHASE_COLOURS = {"breaking": "#0072b2", "rotating": "#e69f00", "sliding": "#009e73"}
BLOCK = {Phase.BREAKING: "#0072b2", Phase.ROTATING: "#e69f00", Phase.SLIDING: "#009e73"}
HATCH = {Phase.BREAKING: "", Phase.ROTATING: "", Phase.SLIDING: "//"}
ICE, WATER, WATERLINE = "#eef5fa", "#d3e3ee", "#4c7f9f"
STRUCTURE, EDGE, FORCE, CRACK = "#c9b27a", "#2a3440", "#c0185a", "#14202c"
SHALLOW = "#b7c1cc"  #: cells that have begun to crack; `CRACK`: cracked through
UTILISATION = ("#eef5fa", "#fbd9a5", "#f0943c", "#b3202c", "#4d0a1c")  #: from ice to dark as utilisation goes to 1
AGE = "cividis"  #: time of failure


def colormap() -> LinearSegmentedColormap:
    """Of the utilisation, 0 to 1."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("utilisation", list(UTILISATION))
