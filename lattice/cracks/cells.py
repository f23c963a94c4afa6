"""Layered cells: Lobatto layers each, in the fixed axes of the crack with which they began.

The mean membrane strain and curvature of the cell give the strain of each layer, the layers give forces N and moments
M per width, and these act on the four nodes. Two further modes of the nodes, the hourglass ones, leave the mean strain
alone: they keep a small stiffness, else a share of the broken cell would keep carrying tension. Out-of-plane shear
goes through the four edge springs of the cell, each limited by friction and what is left of the cohesion.

Between two evaluations of the law a cell is linear: forces are the tangent times the strain plus an offset, all in the
axes of the sheet. It is evaluated anew when a strain of its faces has moved by `MOVED` of e_0. What the tangent stores
is known exactly, so each evaluation books what cracking, crushing and slip have taken; what changes because a crack
closed or opened a little earlier or later than the tangent knew is booked as ``switching``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.cracks.kinematics import Edges, Strain
from lattice.cracks.law import Local
from lattice.cracks.layers import HISTORY, LAYERS, ROW, SLIP, STACK
from lattice.explicit.layout import LANES, aligned
from lattice.grid import Array, IntArray
from lattice.team import TILES

MOVED = 0.02  #: change of a face's strain, as share of e_0, at which the law is evaluated anew
#: share of the largest strain of a face that is added to e_0 there: in an open crack the place between the layers that
#: touch and those that do not is then known to 0.2 % of the thickness
WIDE = 0.1
HOURGLASS = 0.05  #: stiffness of the modes without mean strain, as share of E h (in bending times h^2 / 12)

N_N, N_T, N_G, M_N, M_T, M_G = range(6)  #: resultants along two axes and shear
LOSSES = ("cracking", "crushing", "rubbing", "switching", "turning")
CRACKING, CRUSHING, RUBBING, SWITCHING, TURNING = range(5)  #: entries of ``Cracks.losses``

#: Lines of ``Cracks.linear``, each with a value of `LANES` cells side by side. Tangents are symmetric and have six:
#: xx, xy, x-shear, yy, y-shear, shear-shear; offsets, and strains ``seen`` at the last evaluation, are x, y, shear.
MEMBRANE, COUPLING, BENDING, OFFSET, TURN, STIFF, HELD, SEEN, SEEN_TURN, FAR, FACE, SKEW, SKEW_TURN = (
    LANES * line for line in (0, 6, 12, 18, 21, 24, 28, 32, 35, 38, 39, 40, 41)
)
BLOCK = 42 * LANES  #: length of the lines of `LANES` cells


class Plate(NamedTuple):
    """What layered cells of a sheet have in common."""

    d: float  #: cell size [m]
    h: float  #: thickness [m]
    shear: float  #: of an edge spring of one cell, K_out / 2 [N/m]
    hourglass: float  #: stiffness of the modes without mean strain in the plane [N/m]


@compiled(inline="always")
def plate_at(b: int, plate: Plate, local: Local) -> Plate:
    """The plate of the cell at b."""
    t = local.thickness[b]
    share = local.E[b] * t
    return Plate(plate.d, plate.h * t, plate.shear * share, plate.hourglass * share)


class Cracks(NamedTuple):
    """Layered cells, struct of arrays with room for m of them."""

    cell: IntArray  #: (m,) number of the cell
    corner: IntArray  #: (m,) place of its node 0 in a padded row-by-row array
    axis: Array  #: (2, m) cosine and sine of the direction n
    history: Array  #: (m, HISTORY) of the layers, lines as in `layers`
    shear_slip: Array  #: (m, 4) slip of the edge springs [m]
    thrust: Array  #: (m, 2) sum of the compression across n and t [N/m]
    constant: Array  #: (m,) energy by which the tangent's differs from what is stored [J]
    linear: Array  #: (m / LANES * BLOCK,) `MEMBRANE` ... of `LANES` cells, then of the next [N/m], [N], [N m]
    losses: Array  #: (TILES, LANES) `CRACKING` ...: sums over the cells of each part, see `part_of` [J]
    stack: Array  #: (TILES, STACK) room for the layers of a cell of each part

    @property
    def damage(self) -> Array:
        """Of each layer across n and t, 0 to 1, (m, LAYERS, 2); what is written here is kept."""
        lines: Array = self.history.reshape(len(self.cell), -1, ROW)[:, :2, :LAYERS].swapaxes(1, 2)
        return lines

    @property
    def slip(self) -> Array:
        """Plastic shear strain, (m, LAYERS)."""
        return self.history[:, SLIP : SLIP + LAYERS]


def room_for(m: int) -> Cracks:
    """Room for m layered cells, none of them in use."""
    zeros = np.zeros
    return Cracks(
        cell=zeros(m, np.int64),
        corner=zeros(m, np.int64),
        axis=zeros((2, m)),
        history=aligned(m, HISTORY),
        shear_slip=zeros((m, 4)),
        thrust=zeros((m, 2)),
        constant=zeros(m),
        linear=aligned(-(-m // LANES) * BLOCK),
        losses=aligned(TILES, LANES),
        stack=aligned(TILES, STACK),
    )


@compiled(inline="always")
def place(k: int) -> int:
    """Where the values of cell k begin in ``Cracks.linear``; one of its lines lies so much further."""
    return k // LANES * BLOCK + k % LANES


@compiled(inline="always")
def part_of(k: int) -> int:
    """Which part of the work of a team cell k is: every other block of `LANES`."""
    return k // LANES % TILES


@compiled(inline="always")
def times(line: int, at: int, x: float, y: float, s: float, linear: Array) -> tuple[float, float, float]:
    """A tangent that begins at ``line`` times (x, y, shear)."""
    a, L = line + at, LANES
    xy, xs, ys = linear[a + L], linear[a + 2 * L], linear[a + 4 * L]
    return (
        linear[a] * x + xy * y + xs * s,
        xy * x + linear[a + 3 * L] * y + ys * s,
        xs * x + ys * y + linear[a + 5 * L] * s,
    )


@compiled(inline="always")
def offsets(line: int, at: int, linear: Array) -> tuple[float, float, float]:
    """Three values, from ``line`` on."""
    return linear[line + at], linear[line + LANES + at], linear[line + 2 * LANES + at]


@compiled(inline="always")
def forces(at: int, e: Strain, linear: Array) -> tuple[float, float, float, float, float, float]:
    """N and M of the linear cell at ``at`` from its tangent alone, in the axes of the sheet [N/m], [N]."""
    m, u = times(MEMBRANE, at, e.n, e.t, e.g, linear), times(COUPLING, at, e.kn, e.kt, e.kg, linear)
    v, p = times(COUPLING, at, e.n, e.t, e.g, linear), times(BENDING, at, e.kn, e.kt, e.kg, linear)
    return m[0] + u[0], m[1] + u[1], m[2] + u[2], v[0] + p[0], v[1] + p[1], v[2] + p[2]


@compiled(inline="always")
def resultants(at: int, e: Strain, linear: Array) -> tuple[float, float, float, float, float, float]:
    """N and M of the linear cell at ``at``, see `place`, in the axes of the sheet [N/m], [N]."""
    f, n, m = forces(at, e, linear), offsets(OFFSET, at, linear), offsets(TURN, at, linear)
    return n[0] + f[0], n[1] + f[1], n[2] + f[2], m[0] + f[3], m[1] + f[4], m[2] + f[5]


@compiled(inline="always")
def tangent_energy(at: int, e: Strain, linear: Array) -> float:
    """Energy of the linear cell per area at a strain, without its constant [J/m2]."""
    f, n, m = forces(at, e, linear), offsets(OFFSET, at, linear), offsets(TURN, at, linear)
    E: float = (n[0] + 0.5 * f[0]) * e.n + (n[1] + 0.5 * f[1]) * e.t + (n[2] + 0.5 * f[2]) * e.g
    E += (m[0] + 0.5 * f[3]) * e.kn + (m[1] + 0.5 * f[4]) * e.kt + (m[2] + 0.5 * f[5]) * e.kg
    return E


@compiled(inline="always")
def edge_forces(at: int, long: Edges, linear: Array) -> Edges:
    """Of the edge springs at these elongations [N]."""
    held, stiff, L = HELD + at, STIFF + at, LANES
    return (
        linear[held] + linear[stiff] * long[0],
        linear[held + L] + linear[stiff + L] * long[1],
        linear[held + 2 * L] + linear[stiff + 2 * L] * long[2],
        linear[held + 3 * L] + linear[stiff + 3 * L] * long[3],
    )


@compiled(inline="always")
def edge_energy(at: int, long: Edges, energy: float, linear: Array) -> float:
    """``energy`` and that of the linear edge springs, without their constant [J]."""
    for i in range(4):
        energy += (0.5 * linear[STIFF + LANES * i + at] * long[i] + linear[HELD + LANES * i + at]) * long[i]
    return energy
