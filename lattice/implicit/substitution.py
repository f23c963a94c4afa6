"""Substitution with the factors of `lattice.implicit.factors`: through all fronts, or along the ways from some dof.

What acts on a few dof meets, on its way forward, only the fronts that hold them and those that come after these, a few
hundred numbers of many thousand; and what a few dof do needs only these fronts on the way back.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.grid import Array, IntArray
from lattice.implicit.dissection import Dissection


class Way(NamedTuple):
    """Fronts on the way from some dof to the last front. Numbers are those of the order of elimination."""

    fronts: IntArray  #: (p,) children before parents
    rows: IntArray  #: (k,) their own dof, ascending
    edge: IntArray  #: place in ``rows`` of each dof of their edges, one edge after the other


def way_from(s: Dissection, dof: IntArray) -> Way:
    """The way from these dof."""
    fronts: set[int] = set()
    for home in np.unique(np.searchsorted(s.first, dof, side="right") - 1).tolist():
        k = home
        while k >= 0 and k not in fronts:
            fronts.add(k)
            k = int(s.parent[k])
    along = sorted(fronts)
    rows = np.concatenate([np.arange(s.first[k], s.first[k + 1]) for k in along])
    edge = np.concatenate([s.edge[s.edge_at[k] : s.edge_at[k + 1]] for k in along])
    return Way(np.array(along), rows, np.searchsorted(rows, edge))


@compiled(nogil=True)
def forward(s: Dissection, panels: Array, x: Array, work: Array) -> None:
    """In place, x (n,) in the order of elimination."""
    first, edge, edge_at, panel_at = s.first, s.edge, s.edge_at, s.panel_at
    for k in range(len(first) - 1):
        a, b, c = first[k], first[k + 1], edge_at[k]
        w, m = b - a, edge_at[k + 1] - c
        y = work[: w + m]
        np.dot(panels[panel_at[k] : panel_at[k + 1]].reshape(w + m, w), x[a:b], y)
        x[a:b] = y[:w]
        for i in range(m):
            x[edge[c + i]] -= y[w + i]


@compiled(nogil=True)
def backward(s: Dissection, panels: Array, x: Array, work: Array) -> None:
    """In place, as `forward`."""
    first, edge, edge_at, panel_at = s.first, s.edge, s.edge_at, s.panel_at
    for k in range(len(first) - 2, -1, -1):
        a, b, c = first[k], first[k + 1], edge_at[k]
        w, m = b - a, edge_at[k + 1] - c
        z = work[: w + m]
        z[:w] = x[a:b]
        for i in range(m):
            z[w + i] = -x[edge[c + i]]
        np.dot(panels[panel_at[k] : panel_at[k + 1]].reshape(w + m, w).T, z, x[a:b])


@compiled(nogil=True)
def forward_along(s: Dissection, panels: Array, way: Way, x: Array) -> None:
    """In place, for right sides x (k, r) at the rows of a way that are zero elsewhere."""
    start, at = 0, 0
    for k in way.fronts:
        w, m = s.first[k + 1] - s.first[k], s.edge_at[k + 1] - s.edge_at[k]
        y = np.dot(panels[s.panel_at[k] : s.panel_at[k + 1]].reshape(w + m, w), x[start : start + w])
        x[start : start + w] = y[:w]
        for i in range(m):
            x[way.edge[at + i]] -= y[w + i]
        start, at = start + w, at + m


@compiled(nogil=True)
def backward_along(s: Dissection, panels: Array, way: Way, x: Array) -> None:
    """In place, for x (k,) at the rows of a way: what `backward` gives there."""
    start, at = len(way.rows), len(way.edge)
    for n in range(len(way.fronts) - 1, -1, -1):
        k = way.fronts[n]
        w, m = s.first[k + 1] - s.first[k], s.edge_at[k + 1] - s.edge_at[k]
        start, at = start - w, at - m
        z = np.empty(w + m)
        z[:w] = x[start : start + w]
        for i in range(m):
            z[w + i] = -x[way.edge[at + i]]
        x[start : start + w] = np.dot(panels[s.panel_at[k] : s.panel_at[k + 1]].reshape(w + m, w).T, z)
