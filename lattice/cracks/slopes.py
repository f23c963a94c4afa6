"""What lies at the places of nodes and of the cells that begin there: slopes, see `lattice.cracks.lean`, and forces."""

from __future__ import annotations

from typing import NamedTuple

from lattice.cracks.blocks import LOOK
from lattice.explicit.layout import LANES, LINE, LINES, aligned
from lattice.grid import Array
from lattice.team import TILES

#: entries of ``OnNodes.parts``: energy that slopes give over d^2 [J/m2], power of damping [W], faces at their limit,
#: force that held nodes take [N], work of damping [J]
GAINED, POWER, COUNT, HOLD, LOSS = range(5)


class Lean(NamedTuple):
    """What the slopes of cells do in the present sub-step; a cell lies at the place of its node 0, as in `Cracks`."""

    strain: Array  #: (3, places) membrane strain along x and y from the slope, and shear [-]
    stress: Array  #: (3, places) its stress over the thickness in elastic cells, along x and y and shear [N/m]
    pull: Array  #: (2, places) N . s of the membrane forces N per width and the slopes s [N/m]
    force: Array  #: (3, places) of all this on the nodes, along x, y and z [N]


class OnNodes(NamedTuple):
    """What the loops leave for each other within a sub-step."""

    force: Array  #: (5, places) of layered cells and slopes on the nodes [N], [N m]
    room: Array  #: (TILES, LOOK) of a block of layered cells, see `lattice.cracks.blocks`
    rows: Array  #: (TILES, 9 LINE) of a row of cells, see `lattice.cracks.lean`
    lines: Array  #: (TILES + 1, LINES LINE) as `Mesh.rows` of each part, and of the row between both
    parts: Array  #: (TILES, LANES) `GAINED` ...: what each part has summed up


def level(places: int) -> Lean:
    """No slope."""
    three = (3, places)
    return Lean(aligned(*three), aligned(*three), aligned(2, places), aligned(*three))


def on_nodes(places: int) -> OnNodes:
    """No force."""
    rooms = aligned(TILES, LOOK), aligned(TILES, 9 * LINE), aligned(TILES + 1, LINES * LINE)
    return OnNodes(aligned(5, places), *rooms, aligned(TILES, LANES))
