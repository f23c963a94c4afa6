"""Rows of a large pile in three parts: two halves that share neither plate nor sheet, and the seam between them.

The solver goes through one half, through the other and through the seam, in every sweep and whatever solves them: two
threads, one half each, come to the bits of one that does both. Rows keep their order within their part. What divides
is an upright plane along the drift, so little askew that it passes through one section from end to end, with as many
rows on either side of it; a plate belongs to the side of its centre.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import IntArray
from rubble.compiled import compiled
from rubble.gather import Scene
from rubble.rows import Rows
from rubble.team import TILES

TASK, DEEP = 0, 1  #: places in `Halves.ask`
#: rows below which a pile is one part: what two threads need to meet is then no less than what the second one saves
FEW = 1000
BISECTIONS = 20  #: by which the plane is found


class Halves(NamedTuple):
    """Which rows are in which part."""

    row: IntArray  #: (room,) those of the halves, then those of the seam
    start: IntArray  #: (TILES + 2,) where each part begins in ``row``, and the last one ends
    ask: IntArray  #: (2,) what the first of a team asks of the others, see `stepping`; whether rows have a shift


def halves(room: int) -> Halves:
    """For so many rows, all of them in the seam until they are divided."""
    start = np.zeros(TILES + 2, np.int64)
    start[-1] = room
    return Halves(np.arange(room), start, np.zeros(2, np.int64))


@compiled(nogil=True, borrows=True)
def divide(scene: Scene, rows: Rows, count: int, out: Halves) -> None:
    """Divides rows; fewer than `FEW` are all in the seam."""
    at, few = 0, count < FEW
    askew, plane = (0.0, 0.0) if few else _plane(scene, rows, count)
    for part in range(TILES + 1):
        out.start[part] = at
        for c in range(count):
            if (TILES if few else _part(scene, rows, c, askew, plane)) == part:
                out.row[at] = c
                at += 1
    out.start[TILES + 1] = at


@compiled(nogil=True, borrows=True)
def _plane(scene: Scene, rows: Rows, count: int) -> tuple[float, float]:
    """The plane y + askew x = plane with as many rows on either side, to a part in a hundred [m]."""
    at, first, last, low, high = scene.plates.position, np.inf, -np.inf, np.inf, -np.inf
    for c in range(count):
        k = rows.point[c].b
        first, last = min(first, at[k, 0]), max(last, at[k, 0])
        low, high = min(low, at[k, 1]), max(high, at[k, 1])
    askew = scene.pitch / max(last - first, scene.pitch)
    low, high = low + askew * first, high + askew * last
    for _ in range(BISECTIONS):
        plane, left = 0.5 * (low + high), 0
        for c in range(count):
            k = rows.point[c].b
            left += at[k, 1] + askew * at[k, 0] < plane
        if abs(2 * left - count) < 0.01 * count:
            break
        low, high = (low, plane) if 2 * left > count else (plane, high)
    return askew, plane


@compiled(nogil=True, borrows=True, forceinline=True)
def _part(scene: Scene, rows: Rows, c: int, askew: float, plane: float) -> int:
    """Half in which all lies that a row moves, 0 before the plane along y, else 1; `TILES`: there is none."""
    point, at, edges = rows.point[c], scene.plates.position, scene.edges
    a, b, e = point.a, point.b, point.edge
    before = at[b, 1] + askew * at[b, 0] < plane
    if a != scene.plates.moved.shape[0] - 1 and (at[a, 1] + askew * at[a, 0] < plane) != before:
        return TILES
    if e >= 0:  # the nodes of a section are on one side, whichever plate meets them
        foremost = edges.nodes[edges.offset[e]]
        if edges.yields.shape[1] > 0 or (scene.sections.y[e] + askew * foremost.x < plane) != before:
            return TILES
    return 0 if before else 1
