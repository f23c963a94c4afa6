"""Slices: what a vertical section sees of the pieces of plates.

A piece is a prism: an outline in the plate's x-z plane, as wide as it is. The plane y of a section cuts it; points of
the plane in the plate's axes are

    b = p a + q c + d e,   a = R'(cos, 0, sin), c = R'(-sin, 0, cos), e = R'(0, 1, 0), d = y - y_plate

with (p, q) coordinates that turn with the plate's x axis, seen in the plane. So corners of the outline have their
places (p, q), and the two sides of the piece clip what lies beyond them. Within a window a slice moves as the rigid
body does that it belongs to; at the start of the next one it is cut anew. A plate between two planes, so small that
none meets it, is cut by the plane through its own middle and stands in the nearest section.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray
from rubble.compiled import compiled
from rubble.plates import Plates, times, turn_back

CORNERS = 32  #: most corners of a slice; the sides of a piece may add one each to those of its outline
EDGE_ON = 1e-6  #: |e_y| of a plate that stands across the sections: below it a cut counts as this oblique


class Pieces(NamedTuple):
    """Prisms of which plates are made, in the axes of their plate."""

    number: IntArray  #: (p,) never reused
    worn: IntArray  #: (p,) how often crushed ice has come off: the outline is another one each time
    plate: IntArray  #: (p,) row of the plate
    y: Array  #: (p,) of the middle [m]
    width: Array  #: (p,) along y [m]
    corners: Array  #: (v, 2) of the outlines, counter-clockwise [m]
    offset: IntArray  #: (p + 1,) piece i owns corners[offset[i]:offset[i + 1]]
    range: IntArray  #: (p, 2) first and last section whose plane meets it, now


class Slices(NamedTuple):
    """Slices of pieces, in the order of their numbers."""

    piece: IntArray  #: (s,)
    plate: IntArray  #: (s,)
    section: IntArray  #: (s,) place of its section in the list of sections
    body: IntArray  #: (s,) address of its body in pymunk
    y: Array  #: (s,) plane of the cut [m]
    anchor: Array  #: (s, 3) its origin, in the plate's axes [m]
    sides: IntArray  #: (s,) how many corners
    corners: Array  #: (s, CORNERS, 2) relative to its origin, along axes that turn with the plate [m]
    side: Array  #: (s, CORNERS, 2) outward normal of the edge from each corner, in these axes
    face: Array  #: (s, CORNERS, 3) outward normal of the face that makes this edge, in the plate's axes


@compiled(nogil=True)
def find_ranges(plates: Plates, pieces: Pieces, origin: float, pitch: float) -> None:
    """Which sections meet which pieces; of a plate that none meets the piece nearest to its middle has one."""
    n = plates.moved.shape[0] - 1
    met, nearest, distance = np.zeros(n, np.bool_), np.full(n, -1), np.full(n, np.inf)
    for i in range(pieces.plate.shape[0]):
        k = pieces.plate[i]
        r = plates.rotation[k]
        y, low, high = plates.position[k, 1] + r[1, 1] * pieces.y[i], np.inf, -np.inf
        half = 0.5 * pieces.width[i] * abs(r[1, 1])
        for c in range(pieces.offset[i], pieces.offset[i + 1]):
            at = y + r[1, 0] * pieces.corners[c, 0] + r[1, 2] * pieces.corners[c, 1]
            low, high = min(low, at - half), max(high, at + half)
        first, last = int(np.ceil((low - origin) / pitch)), int(np.ceil((high - origin) / pitch)) - 1
        pieces.range[i, 0], pieces.range[i, 1] = first, last
        met[k] = met[k] or last >= first
        if abs(pieces.y[i]) < distance[k]:
            distance[k], nearest[k] = abs(pieces.y[i]), i
    for k in range(n):
        if not met[k] and nearest[k] >= 0:
            at = int(np.floor((plates.position[k, 1] - origin) / pitch + 0.5))
            pieces.range[nearest[k], 0], pieces.range[nearest[k], 1] = at, at


@compiled(nogil=True)
def cut_piece(plates: Plates, pieces: Pieces, slices: Slices, s: int, y: float) -> float:
    """Cut slice s anew in the plane y; returns by how much its corners have moved at most [m], inf if their number has.

    If the plane misses the piece, it is cut in the nearest plane that meets its middle.
    """
    i, k = slices.piece[s], slices.plate[s]
    r, first, n = plates.rotation[k], pieces.offset[i], pieces.offset[i + 1] - pieces.offset[i]
    h = np.hypot(r[0, 0], r[2, 0])
    cos, sin = (r[0, 0] / h, r[2, 0] / h) if h > 1e-12 else (1.0, 0.0)
    ax, ay, az = turn_back(r, cos, 0.0, sin)
    cx, cy, cz = turn_back(r, -sin, 0.0, cos)
    ex, ey, ez = r[1, 0], r[1, 1], r[1, 2]
    d = y - plates.position[k, 1]
    slices.y[s] = y
    slices.anchor[s, 0], slices.anchor[s, 1], slices.anchor[s, 2] = ex * d, ey * d, ez * d
    det = ax * cz - az * cx
    if abs(det) < EDGE_ON:
        det = EDGE_ON if det >= 0.0 else -EDGE_ON
    at, edge = np.empty((n + 2, 2)), np.empty(n + 2, np.int64)
    for c in range(n):
        j = c if det > 0.0 else n - 1 - c
        bx, bz = pieces.corners[first + j, 0] - d * ex, pieces.corners[first + j, 1] - d * ez
        at[c, 0], at[c, 1] = (cz * bx - cx * bz) / det, (ax * bz - az * bx) / det
        edge[c] = j if det > 0.0 else (j - 1 if j > 0 else n - 1)
    m = n
    for side in range(2):
        sign = 1.0 if side == 0 else -1.0
        limit = 0.5 * pieces.width[i] + sign * (pieces.y[i] - d * ey)
        if abs(ay) > 1e-12 or abs(cy) > 1e-12:
            m = _clip(at, edge, m, sign * ay, sign * cy, limit, n + side)
    moved = 0.0 if m == slices.sides[s] else np.inf
    for c in range(m):
        moved = max(moved, abs(at[c, 0] - slices.corners[s, c, 0]), abs(at[c, 1] - slices.corners[s, c, 1]))
        slices.corners[s, c, 0], slices.corners[s, c, 1] = at[c, 0], at[c, 1]
        j = (c + 1) % m
        tx, tz = at[j, 0] - at[c, 0], at[j, 1] - at[c, 1]
        length = max(np.hypot(tx, tz), 1e-300)
        slices.side[s, c, 0], slices.side[s, c, 1] = tz / length, -tx / length
        _face(pieces, first, n, edge[c], slices.face[s, c])
    slices.sides[s] = m
    return moved


@compiled(nogil=True, borrows=True)
def strayed(plates: Plates, slices: Slices, s: int) -> float:
    """How far slice s has come along y since it was cut [m]."""
    k, b = slices.plate[s], slices.anchor[s]
    _, y, _ = times(plates.rotation[k], b[0], b[1], b[2])
    way: float = plates.position[k, 1] + y - slices.y[s]
    return way


@compiled(nogil=True, borrows=True)
def _face(pieces: Pieces, first: int, n: int, edge: int, out: Array) -> None:
    """Outward normal of a face in the plate's axes: of an edge of the outline, or of a side of the piece."""
    if edge >= n:
        out[0], out[1], out[2] = 0.0, (1.0 if edge == n else -1.0), 0.0
        return
    a, b = pieces.corners[first + edge], pieces.corners[first + (edge + 1) % n]
    tx, tz = b[0] - a[0], b[1] - a[1]
    length = np.hypot(tx, tz)
    out[0], out[1], out[2] = tz / length, 0.0, -tx / length


@compiled(nogil=True)
def _clip(at: Array, edge: IntArray, m: int, nx: float, nz: float, limit: float, face: int) -> int:
    """Keep the part of a convex polygon with ``n . x <= limit``, in place; the new edge belongs to ``face``."""
    out, own, k = np.empty((m + 1, 2)), np.empty(m + 1, np.int64), 0
    for i in range(m):
        j = i + 1 if i + 1 < m else 0
        di, dj = nx * at[i, 0] + nz * at[i, 1] - limit, nx * at[j, 0] + nz * at[j, 1] - limit
        if di <= 0.0 and k <= m:
            out[k, 0], out[k, 1], own[k] = at[i, 0], at[i, 1], edge[i]
            if dj > 0.0 and di == 0.0:
                own[k] = face
            k += 1
        if (di < 0.0 < dj or dj < 0.0 < di) and k <= m:
            t = di / (di - dj)
            out[k, 0], out[k, 1] = at[i, 0] + t * (at[j, 0] - at[i, 0]), at[i, 1] + t * (at[j, 1] - at[i, 1])
            own[k] = face if dj > 0.0 else edge[i]
            k += 1
    for i in range(k):
        at[i, 0], at[i, 1], edge[i] = out[i, 0], out[i, 1], own[i]
    return k


@compiled(nogil=True, borrows=True)
def end_along_y(
    plates: Plates, slices: Slices, pieces: Pieces, s: int, x: float, z: float, sign: float
) -> tuple[float, float, float, float]:
    """Where the line along y through (x, z) leaves the piece of a slice, going to +y or -y, and the normal there."""
    i, k = slices.piece[s], slices.plate[s]
    r, p = plates.rotation[k], plates.position
    bx, by, bz = turn_back(r, x - p[k, 0], slices.y[s] - p[k, 1], z - p[k, 2])
    ex, ey, ez = sign * r[1, 0], sign * r[1, 1], sign * r[1, 2]
    way, fx, fy, fz = np.inf, 0.0, sign, 0.0
    for side in range(2):
        n = 1.0 if side == 0 else -1.0
        if n * ey > 1e-9 and (0.5 * pieces.width[i] - n * (by - pieces.y[i])) / (n * ey) < way:
            way, fx, fy, fz = (0.5 * pieces.width[i] - n * (by - pieces.y[i])) / (n * ey), 0.0, n, 0.0
    first, last = pieces.offset[i], pieces.offset[i + 1]
    for c in range(first, last):
        a, b = pieces.corners[c], pieces.corners[c + 1 if c + 1 < last else first]
        tx, tz = b[0] - a[0], b[1] - a[1]
        length = np.hypot(tx, tz)
        nx, nz = tz / length, -tx / length
        rate = nx * ex + nz * ez
        if rate > 1e-9 and (nx * (a[0] - bx) + nz * (a[1] - bz)) / rate < way:
            way, fx, fy, fz = (nx * (a[0] - bx) + nz * (a[1] - bz)) / rate, nx, 0.0, nz
    fx, fy, fz = times(r, fx, fy, fz)
    return slices.y[s] + sign * max(way, 0.0), fx, fy, fz
