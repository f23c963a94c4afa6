"""Between the sheet's bodies in the sections and the tables of the solver: before and after a window."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rubble.arrays import Array, IntArray, Records, gathered, rows
from rubble.compiled import compiled
from rubble.edges import Edges, still_edges
from rubble.pointers import set_corners
from rubble.sections import SET_CORNERS, SectionTable
from rubble.sheet import IMPULSE, NODE, SAME, SheetBody, Sheets, sheet_polygons

Yields = tuple[dict[int, int], Array]  #: place of a section's edge by its number, and (2, k, k) [1/kg]
DRIFTED, OTHER_CORNERS, OTHER_NUMBER = 0, 1, 2  #: what has become of the outline of a section
NO_NODES = np.zeros(0, NODE)


def follow(bodies: Sequence[SheetBody], sheets: Sheets, tolerance: float) -> None:
    """Bodies take over the lattice's motion in a window, from its start; outlines are straight within ``tolerance``."""
    nodes, start = np.zeros(len(sheets.x), NODE), sheets.offset[:-1]
    place = np.column_stack((sheets.x[start], sheets.z[start]))
    old = np.concatenate([np.zeros((0, 4, 2)), *(b.corners for b in bodies)])
    had = np.cumsum([0, *(len(b.corners) for b in bodies)], dtype=np.int64)
    shapes = np.concatenate([np.zeros(0, np.int64), *(b.addresses for b in bodies)])
    new, ends = np.empty((len(nodes) + len(bodies), 4, 2)), np.zeros(len(bodies) + 1, np.int64)
    news = np.full(len(bodies), DRIFTED)
    _bend(sheets, tolerance, nodes, (old, had, new, ends), news, shapes, (SET_CORNERS, new.ctypes.data))
    for k, body in enumerate(bodies):
        body.nodes, body.place = nodes[sheets.offset[k] : sheets.offset[k + 1]], place[k]
        body.applied = sheets.applied[k]
        if news[k] == OTHER_CORNERS:
            body.corners = new[ends[k] : ends[k + 1]]
        elif news[k] == OTHER_NUMBER:
            body.replace_shapes(new[ends[k] : ends[k + 1]])


@compiled(nogil=True)
def _bend(
    sheets: Sheets,
    tolerance: float,
    nodes: Records,
    outlines: tuple[Array, IntArray, Array, IntArray],
    news: IntArray,
    shapes: IntArray,
    at: tuple[int, int],
) -> None:
    """Fills in nodes and outlines, and gives pymunk's shapes their corners where these are as many as before.

    ``outlines``: corners that there are, and where those of each section begin; the same for the new ones. ``at``:
    addresses of pymunk's function and of the new corners.
    """
    old, had, new, ends = outlines
    for e in range(sheets.front.shape[0]):
        first, end = sheets.offset[e], sheets.offset[e + 1]
        x, z = sheets.x[first:end], sheets.z[first:end]
        for k in range(first, end):
            node = nodes[k]
            node.x, node.z, node.v_x, node.v_z = sheets.x[k], sheets.z[k], sheets.velocity[k, 0], sheets.velocity[k, 1]
            node.outline_x, node.outline_z = sheets.x[k] - x[0], sheets.z[k] - z[0]
        corners = sheet_polygons(x, z, sheets.front[e], sheets.thickness, tolerance)
        count, to = corners.shape[0], ends[e]
        ends[e + 1], way = to + count, 0.0
        same = count == had[e + 1] - had[e]
        for p in range(count):
            for c in range(4):
                new[to + p, c, 0], new[to + p, c, 1] = corners[p, c, 0] - x[0], corners[p, c, 1] - z[0]
                if same:
                    for d in range(2):
                        way = max(way, abs(new[to + p, c, d] - old[had[e] + p, c, d]))
        if not same:
            news[e] = OTHER_NUMBER
        elif not way < SAME * sheets.thickness:
            news[e] = OTHER_CORNERS
            for p in range(count):
                set_corners(at[0], shapes[had[e] + p], 4, at[1] + 64 * (to + p))


def edges_of(sections: SectionTable, yields: Yields | None) -> Edges:
    """The sheet in all sections as a window finds it; None: sheet and rubble go in lockstep."""
    nodes, offset = _nodes(sections)
    edges = still_edges(nodes, offset, yielding=yields is not None)
    if yields is not None:
        known, matrix = yields
        at = np.array([known.get(k, -1) for k in sections.by_key], np.int64)
        on = np.flatnonzero(at >= 0)
        edges.yields[:, on[:, None], on[None, :]] = matrix[:, at[on][:, None], at[on][None, :]]
    for e, section in enumerate(sections.by_key.values()):
        if section.sheet is not None:
            edges.carried[e], edges.body[e] = section.sheet.applied, section.sheet.address
    return edges


def _nodes(sections: SectionTable) -> tuple[Any, IntArray]:
    own = [NO_NODES if s.sheet is None else s.sheet.nodes for s in sections.by_key.values()]
    nodes = gathered(own, NODE).view(NODE).reshape(-1)
    rows(nodes)[:, IMPULSE] = 0.0
    return nodes, np.cumsum([0, *map(len, own)], dtype=np.int64)


def keep(sections: SectionTable, edges: Edges) -> None:
    """The sheet's bodies take their nodes as the window has left them."""
    for e, section in enumerate(sections.by_key.values()):
        if section.sheet is not None:
            section.sheet.nodes = edges.nodes[edges.offset[e] : edges.offset[e + 1]].copy()
