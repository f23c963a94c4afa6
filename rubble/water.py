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
* Added mass stands in mass and moment of inertia of the body, see `section`.

The pose is taken one sub-step ahead, because pymunk moves bodies before it applies forces: with the force at the old
pose bobbing would gain energy by (omega dt)^2 per step.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from rubble.geometry import Array, clip, moments

IntArray = NDArray[np.int64]

#: columns of an edge table: x0, z0, x1, z1 in the body frame [m], width [m]; water lies to the right of 0 -> 1
EDGE_COLUMNS = 5
#: columns of a state row: x, z, angle, v_x, v_z, omega, as pymunk.batch delivers them
STATE_COLUMNS = 6

GAUSS_X = (-np.sqrt(0.15), 0.0, np.sqrt(0.15))  # on -1/2 ... 1/2
GAUSS_W = (5 / 18, 8 / 18, 5 / 18)


@njit("void(float64[:, ::1], float64, float64, float64, float64, float64, float64[::1], float64[::1])", cache=True,
      nogil=True)
def block_force(edges: Array, rho_g: float, half_rho: float, form: float, skin: float, ahead: float, state: Array,
                out: Array) -> None:
    """Water force on one block: out = (Fx, Fz, moment about the centre of mass, drag power) [N, N, N m, W].

    ``rho_g`` = rho_w g [N/m^3], ``half_rho`` = rho_w / 2, ``ahead`` = time by which the pose is advanced [s].
    """
    vx, vz, om = state[3], state[4], state[5]
    z, angle = state[1] + ahead * vz, state[2] + ahead * om
    c, s = np.cos(angle), np.sin(angle)
    out[:] = 0.0
    for e in range(edges.shape[0]):
        ax, az = c * edges[e, 0] - s * edges[e, 1], s * edges[e, 0] + c * edges[e, 1]
        bx, bz = c * edges[e, 2] - s * edges[e, 3], s * edges[e, 2] + c * edges[e, 3]
        da, db = z + az, z + bz  # heights above still water
        if da >= 0.0 and db >= 0.0:
            continue
        if da > 0.0:
            f = da / (da - db)
            ax, az, da = ax + f * (bx - ax), az + f * (bz - az), 0.0
        elif db > 0.0:
            f = da / (da - db)
            bx, bz, db = ax + f * (bx - ax), az + f * (bz - az), 0.0
        lx, lz = bx - ax, bz - az
        length, w = np.hypot(lx, lz), edges[e, 4]
        if length == 0.0:
            continue
        tx, tz = lx / length, lz / length
        nx, nz = tz, -tx
        mean, tilt = -rho_g * (da + db) / 2, -rho_g * (db - da) / 12  # pressure: mean, and its first moment
        mx, mz = (ax + bx) / 2, (az + bz) / 2
        out[0] -= w * length * mean * nx
        out[1] -= w * length * mean * nz
        out[2] -= w * length * (mean * (mx * nz - mz * nx) + tilt * (lx * nz - lz * nx))
        for q in range(3):  # Gauss-Legendre, exact to fifth order
            xi, weight = GAUSS_X[q], GAUSS_W[q] * w * length * half_rho
            px, pz = mx + xi * lx, mz + xi * lz
            ux, uz = vx - om * pz, vz + om * px
            un, ut = ux * nx + uz * nz, ux * tx + uz * tz
            k, kt = weight * form * max(un, 0.0), weight * skin * abs(ut) * ut
            fx, fz = -k * ux - kt * tx, -k * uz - kt * tz
            out[0] += fx
            out[1] += fz
            out[2] += px * fz - pz * fx
            out[3] += fx * ux + fz * uz


@njit("void(float64[:, ::1], int64[::1], float64[::1], float64[::1], int64[::1], float64[:, ::1], float64[:, ::1], "
      "float64[::1])", cache=True, nogil=True)
def apply_water(edges: Array, offset: IntArray, weight: Array, water: Array, row: IntArray, state: Array, force: Array,
                work: Array) -> None:
    """Weight, buoyancy and drag of all blocks of a section, written to their rows of ``force`` (Fx, Fz, moment).

    Block i owns ``edges[offset[i]:offset[i + 1]]`` and stands in row ``row[i]`` of ``state``; ``weight`` in newtons;
    ``water`` = (rho_w g, rho_w / 2, C_d, C_f, sub-step). ``work`` collects the energy lost to drag [J] and the
    impulse of all these forces in x and z [N s].
    """
    out = np.empty(4)
    for i in range(row.shape[0]):
        own = edges[offset[i]:offset[i + 1]]
        block_force(own, water[0], water[1], water[2], water[3], water[4], state[row[i]], out)
        force[row[i], 0], force[row[i], 1], force[row[i], 2] = out[0], out[1] - weight[i], out[2]
        work[0] -= out[3] * water[4]
        work[1] += force[row[i], 0] * water[4]
        work[2] += force[row[i], 1] * water[4]


def strips(polygon: Array, cuts: Array, widths: Array) -> list[Array]:
    """Parts of a body-frame polygon between the cuts (s + 1,) along body x, one for each of the (s,) widths."""
    parts = []
    for k in range(len(widths)):
        part = polygon if k == 0 else clip(polygon, -1.0, 0.0, -float(cuts[k]))
        parts.append(part if k == len(widths) - 1 else clip(part, 1.0, 0.0, float(cuts[k + 1])))
    return parts


def inertia(parts: list[Array], widths: Array) -> tuple[float, float, float, float]:
    """Volume [m^3], centre x and z [m], and second moment of volume about the centre [m^5] of strips with widths."""
    m = np.array([moments(p) for p in parts])
    volume = m[:, 0] * widths
    total = float(volume.sum())
    x, z = float(volume @ m[:, 1]) / total, float(volume @ m[:, 2]) / total
    polar = m[:, 3] * widths + volume * ((m[:, 1] - x) ** 2 + (m[:, 2] - z) ** 2)
    return total, x, z, float(polar.sum())


def wetted_edges(parts: list[Array], cuts: Array, widths: Array) -> Array:
    """Edge table (e, 5) of a block of strips: outer edges with their strip's width, steps with the difference.

    A face at a cut appears in both strips with opposite directions; keeping it with both widths is the step.
    """
    rows = []
    for k, part in enumerate(parts):
        for a, b in zip(part, np.roll(part, -1, axis=0), strict=True):
            neighbour = _beyond_cut(a[0], b[0], cuts, k, len(parts))
            width = widths[k] - (0.0 if neighbour is None else min(widths[k], widths[neighbour]))
            if width > 0:
                rows.append((a[0], a[1], b[0], b[1], width))
    return np.array(rows, dtype=np.float64).reshape(-1, EDGE_COLUMNS)


def _beyond_cut(xa: float, xb: float, cuts: Array, k: int, count: int) -> int | None:
    """Number of the strip on the other side of an edge that lies on a cut; None for an outer edge."""
    for cut, other in ((k, k - 1), (k + 1, k + 1)):
        if 0 <= other < count and abs(xa - cuts[cut]) < 1e-12 and abs(xb - cuts[cut]) < 1e-12:
            return other
    return None
