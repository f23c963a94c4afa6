"""Between the sheet's bodies in the sections and the tables of the solver: before and after a window."""

from __future__ import annotations

from typing import Any

import numpy as np

from rubble.arrays import Array, IntArray
from rubble.edges import Edges, still_edges
from rubble.sections import SectionTable
from rubble.sheet import NODE

Yields = tuple[dict[int, int], Array]  #: place of a section's edge by its number, and (2, k, k) [1/kg]


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
    own = [s.sheet.nodes if s.sheet is not None else np.zeros(0, NODE) for s in sections.by_key.values()]
    nodes = np.concatenate([np.zeros(0, NODE), *own])
    for axis in "xyz":
        nodes[f"impulse_{axis}"] = 0.0
    return nodes, np.cumsum([0, *map(len, own)], dtype=np.int64)


def keep(sections: SectionTable, edges: Edges) -> None:
    """The sheet's bodies take their nodes as the window has left them."""
    for e, section in enumerate(sections.by_key.values()):
        if section.sheet is not None:
            section.sheet.nodes = edges.nodes[edges.offset[e] : edges.offset[e + 1]].copy()
