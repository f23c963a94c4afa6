"""Bending of plates: what presses on a plate, along its length and across, as on a beam in two directions.

Loads normal to the plate, along the axis, and the moment of the latter about the middle of the ice are put on stations
along each axis, those of contacts sub-step by sub-step, water and weight when the plate is judged, from where it lies
then. Inertia closes the balance: a rigid plate answers to what is left with the acceleration a_0 + a_1 x + a_2 y of its
mass. At a station the moment of all loads beyond it and their pull are then those of the cut there,

    M(s) = sum (s_j - s) F_n - z_j F_s,   T(s) = sum F_s,   sigma = 6 |M| / (w h^2) + T / (w h),

with the width w of the ice there. Bending in the plane is left out: plates are much wider than thick.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, BoolArray, IntArray
from rubble.compiled import compiled
from rubble.plates import Plates, turn_back
from rubble.rows import ICE, Rows
from rubble.slices import Pieces

CELLS = 24  #: between the stations of an axis: a cut is found to a 24th of the length
NORMAL, ALONG, COUPLE = 0, 1, 2  #: columns of the loads


class Loaded(NamedTuple):
    """Plates that are long enough to break."""

    row: IntArray  #: (n,) place of each plate among them, -1: it is too short
    span: Array  #: (m, 2, 2) from where to where they reach along x and y, in their axes [m]
    impulse: Array  #: (m, 2, CELLS + 1, 3) of contacts so far: normal, along the axis [N s], and its couple [N m s]


class Ice(NamedTuple):
    """What plates are made of, and the water around."""

    density: float  #: [kg/m3]
    thickness: float  #: [m]
    strength: float  #: flexural [Pa]
    g: float  #: [m/s2]
    rho_g: float  #: of the water [N/m3]


@compiled(nogil=True, borrows=True)
def sum_bending(rows: Rows, count: int, plates: Plates, loaded: Loaded) -> None:
    """Adds the impulses of a sub-step's contacts."""
    for c in range(count):
        point = rows.point[c]
        a, b = loaded.row[point.b], -1
        if point.kind == ICE:
            b = loaded.row[point.a]
        if a < 0 and b < 0:
            continue
        x = y = z = 0.0
        for d in range(3):
            way = rows.way[c, d]
            x, y, z = x + way.impulse * way.x, y + way.impulse * way.y, z + way.impulse * way.z
        if x == 0.0 and y == 0.0 and z == 0.0:
            continue
        if a >= 0:
            _press(plates, point.b, a, (point.x, point.y, point.z), (x, y, z), loaded)
        if b >= 0:
            _press(plates, point.a, b, (point.x, point.y, point.z), (-x, -y, -z), loaded)


@compiled(nogil=True, borrows=True)
def _press(
    plates: Plates,
    k: int,
    row: int,
    at: tuple[float, float, float],
    push: tuple[float, float, float],
    loaded: Loaded,
) -> None:
    """An impulse at a point on plate k, which is ``row`` of those loaded."""
    r, p = plates.rotation[k], plates.position[k]
    x, y, z = turn_back(r, at[0] - p[0], at[1] - p[1], at[2] - p[2])
    fx, fy, fz = turn_back(r, push[0], push[1], push[2])
    put(loaded.span[row, 0], loaded.impulse[row, 0], x, fz, fx, z * fx)
    put(loaded.span[row, 1], loaded.impulse[row, 1], y, fz, fy, z * fy)


@compiled(nogil=True, borrows=True)
def put(span: Array, out: Array, s: float, normal: float, along: float, couple: float) -> None:
    """A load at s goes to the two stations next to it (CELLS + 1, 3); force and moment are kept."""
    at = (s - span[0]) / (span[1] - span[0]) * CELLS
    k = min(max(int(np.floor(at)), 0), CELLS - 1)
    w = at - k
    out[k, NORMAL] += (1.0 - w) * normal
    out[k + 1, NORMAL] += w * normal
    w = min(max(w, 0.0), 1.0)
    out[k, ALONG] += (1.0 - w) * along
    out[k + 1, ALONG] += w * along
    out[k, COUPLE] += (1.0 - w) * couple
    out[k + 1, COUPLE] += w * couple


@compiled(nogil=True)
def judge(k: int, row: int, plates: Plates, pieces: Pieces, loaded: Loaded, time: float, ice: Ice) -> Array:
    """Highest stress of plate k over its strength, the axis that is cut there (0: x, 1: y), and where (3,) [m].

    ``time`` over which its contacts were summed [s]. No part is shorter than the thickness.
    """
    load = loaded.impulse[row] / time
    count = 0
    for i in range(*_pieces_of(k, pieces)):
        count += CELLS * _across(pieces.width[i], loaded.span[row])
    cells = np.zeros((count, 4))  # x, y, mass, normal load
    width = np.zeros((2, CELLS + 1))
    _weigh(k, plates, pieces, loaded.span[row], ice, cells, width)
    _balance(cells, loaded.span[row], load)
    found = np.zeros(3)
    for d in range(2):
        low, high = loaded.span[row, d]
        step = (high - low) / CELLS
        for c in range(1, CELLS):
            if min(c, CELLS - c) * step < ice.thickness * (1.0 - 1e-9) or width[d, c] <= 0.0:
                continue
            moment = pull = 0.0
            for j in range(c + 1, CELLS + 1):
                moment += (j - c) * step * load[d, j, NORMAL] - load[d, j, COUPLE]
                pull += load[d, j, ALONG]
            h, w = ice.thickness, width[d, c]
            stress = (6.0 * abs(moment) / (w * h * h) + pull / (w * h)) / ice.strength
            if stress > found[0]:
                found[0], found[1], found[2] = stress, d, low + c * step
    return found


@compiled(nogil=True)
def judge_all(
    who: IntArray, due: BoolArray, plates: Plates, pieces: Pieces, loaded: Loaded, time: Array, ice: Ice
) -> Array:
    """What `judge` says of those plates ``who`` (m,), all that are loaded, whose turn it is; 0 of others, (m, 3)."""
    out = np.zeros((who.shape[0], 3))
    for k in range(who.shape[0]):
        if due[k]:
            out[k] = judge(who[k], k, plates, pieces, loaded, time[k], ice)
    return out


@compiled(nogil=True)
def _weigh(k: int, plates: Plates, pieces: Pieces, span: Array, ice: Ice, cells: Array, width: Array) -> None:
    """Cells of plate k (c, 4): x, y, mass, and load of water and weight along its normal; widths at the stations."""
    r, p, share = plates.rotation[k], plates.position[k], plates.flooded[k]
    up, half, n = r[2, 2], 0.5 * ice.thickness, 0
    for i in range(*_pieces_of(k, pieces)):
        first, end = pieces.offset[i], pieces.offset[i + 1]
        corners = pieces.corners[first:end]
        rear, front = corners[:, 0].min(), corners[:, 0].max()
        middle = 0.5 * (corners[:, 1].min() + corners[:, 1].max())
        area = 0.0
        for c in range(end - first):
            a, b = corners[c], corners[(c + 1) % (end - first)]
            area += 0.5 * (a[0] * b[1] - b[0] * a[1])
        parts = _across(pieces.width[i], span)
        _widths(pieces.y[i], pieces.width[i], rear, front, span, width)
        for c in range(CELLS):
            x = rear + (c + 0.5) * (front - rear) / CELLS
            for s in range(parts):
                y = pieces.y[i] + ((s + 0.5) / parts - 0.5) * pieces.width[i]
                z = p[2] + r[2, 0] * x + r[2, 1] * y + r[2, 2] * middle
                plan = (front - rear) * pieces.width[i] / (CELLS * parts)
                mass = ice.density * area * pieces.width[i] / (CELLS * parts)
                below, above = ice.rho_g * max(half * up - z, 0.0), ice.rho_g * max(-half * up - z, 0.0)
                load = (share * below - above if up < 0.0 else below - share * above) * plan
                cells[n, 0], cells[n, 1], cells[n, 2], cells[n, 3] = x, y, mass, load - mass * ice.g * up
                n += 1


@compiled(nogil=True)
def _pieces_of(k: int, pieces: Pieces) -> tuple[int, int]:
    """Where the pieces of plate k begin and end: they stand in the order of the plates."""
    return int(np.searchsorted(pieces.plate, k)), int(np.searchsorted(pieces.plate, k + 1))


@compiled(nogil=True)
def _across(width: float, span: Array) -> int:
    """Parts of a piece of this width, none wider than stations along y are apart."""
    return int(np.ceil(width * CELLS / (span[1, 1] - span[1, 0]) * (1.0 - 1e-9)))


@compiled(nogil=True)
def _widths(y: float, width: float, rear: float, front: float, span: Array, out: Array) -> None:
    """Adds the ice of a piece to the widths (2, CELLS + 1) at the stations along x and y."""
    tiny = 1e-9 * (span[0, 1] - span[0, 0])
    for c in range(CELLS + 1):
        x = span[0, 0] + c * (span[0, 1] - span[0, 0]) / CELLS
        if rear - tiny <= x < front + tiny:
            out[0, c] += width
        at = span[1, 0] + c * (span[1, 1] - span[1, 0]) / CELLS
        if y - 0.5 * width <= at < y + 0.5 * width:
            out[1, c] += front - rear


@compiled(nogil=True)
def _balance(cells: Array, span: Array, load: Array) -> None:
    """Adds water, weight and inertia of cells (c, 4) to the loads at the stations (2, CELLS + 1, 3) of both axes."""
    total, mass = np.zeros(3), np.zeros((3, 3))
    for d in range(2):
        low, step = span[d, 0], (span[d, 1] - span[d, 0]) / CELLS
        for j in range(CELLS + 1):
            total[d + 1] += (low + j * step) * load[d, j, NORMAL] - load[d, j, COUPLE]
            if d == 0:
                total[0] += load[d, j, NORMAL]
    field = np.ones(3)
    for n in range(cells.shape[0]):
        field[1], field[2] = cells[n, 0], cells[n, 1]
        for a in range(3):
            total[a] += cells[n, 3] * field[a]
            for b in range(3):
                mass[a, b] += cells[n, 2] * field[a] * field[b]
    rigid = np.linalg.solve(mass, total)
    pull = np.zeros(2)
    for d in range(2):
        pull[d] = load[d, :, ALONG].sum() / mass[0, 0]
    for n in range(cells.shape[0]):
        x, y, m = cells[n, 0], cells[n, 1], cells[n, 2]
        normal = cells[n, 3] - m * (rigid[0] + rigid[1] * x + rigid[2] * y)
        put(span[0], load[0], x, normal, -m * pull[0], 0.0)
        put(span[1], load[1], y, normal, -m * pull[1], 0.0)
