"""Cracks that have passed the middle of the ice, and the pieces that they surround.

From there on the crack carries moment by thrust alone: it is a hinge. A piece all around which cracks are so deep is
hinged; it stays in the lattice as long as something presses it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lattice.fragments import components
from lattice.grid import BoolArray, Grid, IntArray

DEEP = 0.5  #: share of the thickness from which a crack is a hinge [-]


@dataclass(frozen=True)
class Hinges:
    """What deep cracks divide."""

    cells: IntArray  #: cells whose crack is deep
    hinged: BoolArray  #: (nodes,) of pieces that deep cracks surround and nothing else holds
    pieces: list[IntArray]  #: nodes of these pieces, by their first node
    parts: int  #: of the sheet: what is held, or at least ``share`` of the floe


def no_hinges(nodes: int) -> Hinges:
    """Whole ice."""
    return Hinges(np.empty(0, np.int64), np.zeros(nodes, bool), [], 1)


def hinges(grid: Grid, whole: BoolArray, deep: IntArray, present: BoolArray, held: BoolArray, share: float) -> Hinges:
    """Of a sheet in which ``whole`` cells (cells,) join their nodes and cells ``deep`` are cracked deep."""
    label = np.where(present, components(grid, whole), -1)
    area = np.bincount(label[present], weights=grid.area[present], minlength=int(label.max()) + 1)
    has_held = np.zeros(len(area), bool)
    has_held[label[present & held]] = True
    large = area >= share * grid.area.sum()
    corners = label[grid.cell_nodes[whole]][:, 0]
    solid = np.zeros(len(area), bool)
    solid[corners[corners >= 0]] = True  # single nodes between cracks are no pieces
    loose = solid & ~has_held & ~large
    hinged = np.zeros(grid.nodes, bool)
    hinged[present] = loose[label[present]]
    pieces = [np.flatnonzero(label == k) for k in np.flatnonzero(loose)]
    return Hinges(deep, hinged, sorted(pieces, key=lambda p: int(p[0])), int((solid & (has_held | large)).sum()))
