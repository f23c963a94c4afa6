"""How the arrays of the compiled loops lie in memory, and their names.

All are padded so that no node needs a special case, with every row at the start of a cache line: n_y below is the
number of columns rounded up to whole `LANES`, m_y is n_y + `LANES`. The loops carry the *effective* displacement
y = x + alpha v and never x itself, see `lattice.explicit.kernels`.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lattice.grid import Array, BoolArray, Grid
from lattice.ice import Ice
from lattice.stiffness import Springs
from lattice.team import at_a_line

LANES = 8  #: doubles in the widest vector
LINE = 1048  #: distance of the lines of ``rows``: an odd number of cache lines, so that they use all sets of a cache
LINES = 19  #: 14 connection forces, 5 sums that a row leaves for the next one; each begins after LANES zeros
U_X, U_Y, W, PHI_X, PHI_Y = range(5)  #: the degrees of freedom of a node, first index of ``y`` and ``v``


class Motion(NamedTuple):
    """Where all nodes are and how they move; zero on the padding and on nodes that have left."""

    y: Array  #: (5, n_x+1, m_y) effective displacement [m], [rad]
    v: Array  #: (5, n_x+1, m_y) velocity half a sub-step before [m/s], [rad/s]


class PerNode(NamedTuple):
    """A value of each node that differs between its degrees of freedom."""

    u: Array  #: (n_x, n_y) of both in-plane displacements
    w: Array  #: (n_x, n_y) of the deflection
    phi: Array  #: (n_x, n_y) of both rotations


class HalfSprings(NamedTuple):
    """Half the constants of `stiffness.Springs`: what each of two cells gives to an axial connection."""

    K_n: float
    K_s: float
    K_out: float
    G_r: float
    G_t: float
    K_n_dia: float
    G_dia: float
    lever: float  #: d/2 [m]


class Pace(NamedTuple):
    """What a sub-step does to every node."""

    alpha: float  #: material damping [s]
    go: float  #: dt + alpha [s]
    buoy: float  #: dt k_f / (rho h) [1/s]
    drag: float  #: dt (c - alpha k_f) / (rho h) [-]


class Intact(NamedTuple):
    """What cells give to their springs, over uniform ice: 1 where ice is as the mean, 0 where there is no cell.

    (n_x+1, m_y) each, cell (i, j) at [i+1, j+1]; zero all around.
    """

    plane: Array  #: to those in the plane and in shear
    bend: Array  #: to those of bending and torsion


class Mesh(NamedTuple):
    """The lattice as the loops see it."""

    intact: Intact
    threshold: Array  #: (n_x, n_y) of `screen.overloaded` for cell (i, j), infinite where there is none
    held: Array  #: (n_x+1, m_y) 1 at nodes that are held along x, else 0
    kick: PerNode  #: dt / mass; zero where held [s/kg], [s/(kg m2)]
    mass: Array  #: (n_x, n_y) of the deflection, zero where there is no node [kg]
    springs: HalfSprings
    pace: Pace
    rows: Array  #: (LINES * LINE,) what one pass over a row leaves for the other
    before: Array  #: (5, n_x+1, m_y) velocities before a sub-step whose damping is taken stock of [m/s], [rad/s]


def aligned(*shape: int) -> Array:
    """Zeros that begin at a cache line: a vector that lies across two lines costs two accesses (measured: 30 %)."""
    return at_a_line(math.prod(shape), np.float64).reshape(shape)


def copied(array: NDArray[Any]) -> NDArray[Any]:
    """A copy; numbers begin at a cache line."""
    if array.dtype != np.float64:
        return array.copy()
    new = aligned(*array.shape)
    new[:] = array
    return new


def motion(grid: Grid) -> Motion:
    """Rest."""
    shape = 5, grid.nx + 1, _wide(grid)
    return Motion(aligned(*shape), aligned(*shape))


def mesh(grid: Grid, held: BoolArray, kick: PerNode, springs: HalfSprings, pace: Pace, dt: float) -> Mesh:
    """A lattice of no cells; ``kick`` (nodes,) each. ValueError where the grid is too wide for the loops."""
    wide, columns = _wide(grid), columns_of(grid)
    if wide > LINE:
        raise ValueError(f"{grid.ny} nodes across are too many for the explicit engine: use at most {LINE - LANES}")
    padded, mass = aligned(3, grid.nx, columns), aligned(grid.nx, columns)
    threshold = aligned(grid.nx, columns)
    threshold[:] = np.inf
    on_x = aligned(grid.nx + 1, wide)
    on_x[: grid.nx, : grid.ny] = held.reshape(grid.nx, grid.ny)
    for k, values in enumerate(kick):
        padded[k, :, : grid.ny] = values.reshape(grid.nx, grid.ny)
    kick = PerNode(*padded)
    np.divide(dt, kick.w, out=mass, where=kick.w > 0.0)
    return Mesh(
        intact=Intact(aligned(grid.nx + 1, wide), aligned(grid.nx + 1, wide)),
        threshold=threshold,
        held=on_x,
        kick=kick,
        mass=mass,
        springs=springs,
        pace=pace,
        rows=aligned(LINES * LINE),
        before=aligned(5, grid.nx + 1, wide),
    )


def _wide(grid: Grid) -> int:
    return columns_of(grid) + LANES


def columns_of(grid: Grid) -> int:
    """N_y, the nodes across rounded up to whole `LANES`."""
    return -(-grid.ny // LANES) * LANES


def at_cells(grid: Grid, values: Array, elsewhere: float) -> Array:
    """Values (cells,) at the places of the cells, (n_x, n_y), and ``elsewhere`` where there is none."""
    padded = aligned(grid.nx, columns_of(grid))
    padded[:] = elsewhere
    padded[: grid.nx - 1, : grid.ny - 1] = values.reshape(grid.nx - 1, grid.ny - 1)
    return padded


def at_places(grid: Grid, values: Array) -> Array:
    """Values (cells,) at the places of the cells' nodes 0 in a row-by-row array of all nodes, 1 elsewhere."""
    padded = np.ones((grid.nx + 1, _wide(grid)))
    padded[: grid.nx - 1, : grid.ny - 1] = values.reshape(grid.nx - 1, grid.ny - 1)
    flat: Array = padded.reshape(-1)
    return flat


def half_springs(s: Springs, d: float) -> HalfSprings:
    """Constants for cells of size d [m]."""
    return HalfSprings(
        K_n=0.5 * s.K_n_axi,
        K_s=0.5 * s.K_s_axi,
        K_out=0.5 * s.K_out,
        G_r=0.5 * s.G_r_axi,
        G_t=0.5 * s.G_t_axi,
        K_n_dia=0.5 * s.K_n_dia,
        G_dia=0.5 * s.G_dia,
        lever=0.5 * d,
    )


def pace(ice: Ice, dt: float, alpha: float, damping: float) -> Pace:
    """Sub-steps of ``dt`` [s] with material ``alpha`` [s] and hydrodynamic ``damping`` [N s/m3]."""
    per_mass = dt / ice.heaving_mass
    return Pace(alpha, dt + alpha, per_mass * ice.k_f, per_mass * (damping - alpha * ice.k_f))
