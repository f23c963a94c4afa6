"""Forces of still water on blocks: buoyancy, form drag, skin drag; one kernel for all blocks of a section.

A block is a prism (convex polygon in x-z) whose width along y is piecewise constant in strips along its long axis. It
is stored as its wetted **edges** in the body frame, each with a width: the outline, split at the strips, and the steps
between strips, whose width is the difference of the two.

* Buoyancy is the integral of the water pressure over the edges, exact for straight edges. By the divergence theorem
  it equals rho_w g times the submerged area (`geometry.submerged`); a test keeps the two together.
* Form drag: where the body moves into the water (u.n > 0), ``-rho_w/2 C_d (u.n) u`` per area. For a translation this is
  C_d on the projected submerged extent; for a rotation it gives the moment with the same coefficient (three Gauss
  points per edge: 3 % too much for an edge that turns about its middle).
* Skin drag: ``-rho_w/2 C_f |u_t| u_t`` per wetted area, u_t along the edge.
* Added mass stands in mass and moment of inertia of the body, see `block`.
* Backfill: the top of a new block carries a share of its head of water, 0 when dry, 1 when flooded. The share grows
  from the moment when water comes over the lowest edge of the top; a top that is out of the water drains.

The pose is taken one sub-step ahead, because pymunk moves bodies before it applies forces: with the force at the old
pose bobbing would gain energy by (omega dt)^2 per step.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from rubble.geometry import Array
from rubble.pointers import IntArray

#: columns of an edge table: x0, z0, x1, z1 in the body frame [m], width [m], 1 for an edge of the block's top; water
#: lies to the right of 0 -> 1
EDGE_COLUMNS = 6
#: columns of a state row: x, z, angle, v_x, v_z, omega, as pymunk.batch delivers them
STATE_COLUMNS = 6

GAUSS_X = (-np.sqrt(0.15), 0.0, np.sqrt(0.15))  # on -1/2 ... 1/2
GAUSS_W = (5 / 18, 8 / 18, 5 / 18)


@njit("UniTuple(float64, 4)(float64, float64, float64, float64, float64)", cache=True, nogil=True)
def _wetted(ax: float, az: float, bx: float, bz: float, z: float) -> tuple[float, float, float, float]:
    """The part of an edge (relative to the centre at height z) below still water; nothing: both ends the same."""
    da, db = z + az, z + bz
    if da >= 0.0 and db >= 0.0:
        return ax, az, ax, az
    if da > 0.0:
        f = da / (da - db)
        ax, az = ax + f * (bx - ax), az + f * (bz - az)
    elif db > 0.0:
        f = da / (da - db)
        bx, bz = ax + f * (bx - ax), az + f * (bz - az)
    return ax, az, bx, bz


@njit("UniTuple(float64, 3)(float64, float64, float64, float64, float64, float64, float64)", cache=True, nogil=True)
def _pressure(ax: float, az: float, bx: float, bz: float, width: float, z: float, rho_g: float,
              ) -> tuple[float, float, float]:
    """Force and moment of the water pressure on an edge, exact for a straight edge."""
    ax, az, bx, bz = _wetted(ax, az, bx, bz, z)
    lx, lz = bx - ax, bz - az
    mean, tilt = -rho_g * (z + (az + bz) / 2), -rho_g * lz / 12  # pressure: mean, and its first moment
    mx, mz = (ax + bx) / 2, (az + bz) / 2
    return -width * mean * lz, width * mean * lx, width * (mean * (mx * lx + mz * lz) + tilt * (lx * lx + lz * lz))


@njit("UniTuple(float64, 3)(float64, float64, float64, float64, float64, float64, float64[::1], float64)", cache=True,
      nogil=True)
def _lacking(ax: float, az: float, bx: float, bz: float, width: float, z: float, water: Array, share: float,
             ) -> tuple[float, float, float]:
    """What an edge of the top carries less (share, level) than if it were flooded: force and moment, reversed."""
    full_x, full_z, full_y = _pressure(ax, az, bx, bz, width, z, water[0])
    fx, fz, my = _pressure(ax, az, bx, bz, width * share, z - water[5], water[0])
    return fx - full_x, fz - full_z, my - full_y


@njit("void(float64, float64, float64, float64, float64, float64, float64, float64, float64, float64[::1], "
      "float64[::1])", cache=True, nogil=True)
def _edge_force(ax: float, az: float, bx: float, bz: float, width: float, z: float, vx: float, vz: float, om: float,
                water: Array, out: Array) -> None:
    """Add pressure and drag on one edge, whose water stands at height 0 when the centre stands at z."""
    ax, az, bx, bz = _wetted(ax, az, bx, bz, z)
    lx, lz = bx - ax, bz - az
    length = np.sqrt(lx * lx + lz * lz)
    if length == 0.0:
        return
    mean, tilt = -water[0] * (z + (az + bz) / 2), -water[0] * lz / 12
    tx, tz, mx, mz = lx / length, lz / length, (ax + bx) / 2, (az + bz) / 2
    nx, nz = tz, -tx
    out[0] -= width * mean * lz
    out[1] += width * mean * lx
    out[2] += width * (mean * (mx * lx + mz * lz) + tilt * length * length)
    for q in range(3):  # Gauss-Legendre, exact to fifth order
        xi, weight = GAUSS_X[q], GAUSS_W[q] * width * length * water[1]
        px, pz = mx + xi * lx, mz + xi * lz
        ux, uz = vx - om * pz, vz + om * px
        un, ut = ux * nx + uz * nz, ux * tx + uz * tz
        k, kt = weight * water[2] * max(un, 0.0), weight * water[3] * abs(ut) * ut
        fx, fz = -k * ux - kt * tx, -k * uz - kt * tz
        out[0] += fx
        out[1] += fz
        out[2] += px * fz - pz * fx
        out[3] += fx * ux + fz * uz


@njit("float64(float64[:, ::1], float64[::1], float64, float64[::1], float64[::1])", cache=True, nogil=True)
def block_force(edges: Array, water: Array, share: float, state: Array, out: Array) -> float:
    """Water force on one block: out = (Fx, Fz, moment about the centre of mass, drag power, power of the head that
    its top lacks) [N, N, N m, W, W]; returns the height of the lowest point of its top [m].

    ``water`` = (rho_w g, rho_w / 2, C_d, C_f, time by which the pose is advanced, level on the tops, filling rate);
    the top carries ``share`` of the head below that level, every other edge the head below z = 0.
    """
    vx, vz, om = state[3], state[4], state[5]
    z, angle = state[1] + water[4] * vz, state[2] + water[4] * om
    c, s = np.cos(angle), np.sin(angle)
    out[:] = 0.0
    lowest = np.inf
    for e in range(edges.shape[0]):
        ax, az = c * edges[e, 0] - s * edges[e, 1], s * edges[e, 0] + c * edges[e, 1]
        bx, bz = c * edges[e, 2] - s * edges[e, 3], s * edges[e, 2] + c * edges[e, 3]
        if edges[e, 5] > 0.0:
            lowest = min(lowest, z + az, z + bz)
            if water[5] < 0.0 or share < 1.0:
                _edge_force(ax, az, bx, bz, edges[e, 4] * share, z - water[5], vx, vz, om, water, out)
                fx, fz, my = _lacking(ax, az, bx, bz, edges[e, 4], z, water, share)
                out[4] += fx * vx + fz * vz + my * om
                continue
        _edge_force(ax, az, bx, bz, edges[e, 4], z, vx, vz, om, water, out)
    return lowest


@njit("void(float64[:, ::1], int64[::1], float64[:, ::1], float64[::1], float64[::1], int64[::1], float64[:, ::1], "
      "float64[:, ::1], float64[::1])", cache=True, nogil=True)
def apply_water(edges: Array, offset: IntArray, dead: Array, water: Array, flooded: Array, row: IntArray,
                state: Array, force: Array, work: Array) -> None:
    """Dead load, buoyancy and drag of all blocks of a section, written to their rows of ``force`` (Fx, Fz, moment).

    Block i owns ``edges[offset[i]:offset[i + 1]]`` and stands in row ``row[i]`` of ``state``; ``dead`` (blocks, 3) is
    the weight and any constant thrust [N, N, N m];
    ``water`` as in `block_force`, its time is the sub-step; ``flooded`` is the share of the head on each top, which
    grows here. ``work`` collects the energy lost to drag [J], the impulse of all these forces in x and z [N s], and
    the work that dry tops do [J].
    """
    out = np.empty(5)
    for i in range(row.shape[0]):
        own = edges[offset[i]:offset[i + 1]]
        lowest = block_force(own, water, flooded[i], state[row[i]], out)
        for k in range(3):
            force[row[i], k] = out[k] + dead[i, k]
        work[0] -= out[3] * water[4]
        work[1] += force[row[i], 0] * water[4]
        work[2] += force[row[i], 1] * water[4]
        work[3] += out[4] * water[4]
        if lowest < 0.0:
            flooded[i] = min(1.0, flooded[i] + water[4] * water[6])
        elif water[6] > 0.0:
            flooded[i] = 0.0
