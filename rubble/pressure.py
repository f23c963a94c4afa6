"""Pressure of still water on the edges of a block, and the energy that belongs to it.

A block is a prism (convex polygon in x-z) whose width along y is piecewise constant in strips along its long axis. It
is stored as its wetted **edges** in the body frame, each with a width: the outline, split at the strips, and the steps
between strips, whose width is the difference of the two. Buoyancy is the integral of the water pressure over the
edges, exact for straight edges. By the divergence theorem it equals rho_w g times the submerged area
(`geometry.submerged`); a test keeps the two together.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Record, Records, record
from rubble.compiled import compiled

#: an edge from (x0, z0) to (x1, z1) in the body frame [m], its width [m], 1 for an edge of the block's top, and its
#: unit direction (t_x, t_z); water lies to the right of it
EDGE = record("x0", "z0", "x1", "z1", "width", "top", "t_x", "t_z")


class Ends(NamedTuple):
    """A straight piece, relative to the centre of the block [m]."""

    ax: float
    az: float
    bx: float
    bz: float


class Force(NamedTuple):
    """A force in the plane and its moment about the centre of mass [N, N, N m]."""

    x: float
    z: float
    moment: float


@compiled(nogil=True)
def wetted(ends: Ends, da: float, db: float) -> Ends:
    """The part of a piece below still water, its ends at heights da and db; nothing: both ends the same."""
    ax, az, bx, bz = ends
    if da >= 0.0 and db >= 0.0:
        return Ends(ax, az, ax, az)
    if da > 0.0:
        f = da / (da - db)
        ax, az = ax + f * (bx - ax), az + f * (bz - az)
    elif db > 0.0:
        f = da / (da - db)
        bx, bz = ax + f * (bx - ax), az + f * (bz - az)
    return Ends(ax, az, bx, bz)


@compiled(nogil=True)
def turned(edge: Record, c: float, s: float) -> Ends:
    """An `EDGE` in the directions of the section, with cosine and sine of the block's angle."""
    return Ends(
        c * edge.x0 - s * edge.z0, s * edge.x0 + c * edge.z0, c * edge.x1 - s * edge.z1, s * edge.x1 + c * edge.z1
    )


@compiled(nogil=True)
def pressure_on(ends: Ends, width: float, z: float, rho_g: float) -> Force:
    """Force of the water pressure on an edge of a block whose centre stands at z; exact for a straight edge."""
    wet = wetted(ends, z + ends.az, z + ends.bz)
    lx, lz = wet.bx - wet.ax, wet.bz - wet.az
    mean, tilt = -rho_g * (z + (wet.az + wet.bz) / 2), -rho_g * lz / 12  # pressure: mean, and its first moment
    mx, mz = (wet.ax + wet.bx) / 2, (wet.az + wet.bz) / 2
    moment = width * (mean * (mx * lx + mz * lz) + tilt * (lx * lx + lz * lz))
    return Force(-width * mean * lz, width * mean * lx, moment)


@compiled(nogil=True)
def water_energy(edges: Records, start: int, end: int, z: float, angle: float, rho_g: float) -> float:
    """rho_w g times the integral of depth over the submerged part of a block with water all around [J].

    By the divergence theorem a sum over the wet edges; the waterline at depth 0 adds nothing.
    """
    c, s, total = np.cos(angle), np.sin(angle), 0.0
    for e in range(start, end):
        ends = turned(edges[e], c, s)
        wet = wetted(ends, z + ends.az, z + ends.bz)
        middle, rise = z + 0.5 * (wet.az + wet.bz), wet.bz - wet.az
        total += 0.5 * edges[e].width * (wet.bx - wet.ax) * (middle * middle + rise * rise / 12.0)
    return rho_g * total
