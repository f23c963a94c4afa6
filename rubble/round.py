"""A body of revolution: how deep a point or an edge stands in it, and which way is out.

In the meridian plane (rho, z) through a point it is the area below its generator rho = r(z), closed by a lid at either
end; the nearest point of the surface lies in the same plane.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array
from rubble.compiled import compiled

SURELY = 1e-9  #: share of a distance that rounding is kept away from
DEEPER = 1e-6  #: share of an edge's depth by which a point of it stands deeper than its ends


def closed(generator: Array) -> Array:
    """The closed generator (k + 2, 2) as kernels want it, r and z, from heights and radii (k, 2): a lid at each end."""
    z, r = generator.T
    return np.column_stack([[0.0, *r, 0.0], [z[0], *z, z[-1]]])


class Spot(NamedTuple):
    """Where ice stands in the body, in its axes."""

    x: float
    y: float
    z: float
    depth: float  #: below the surface, negative outside [m]
    n_rho: float  #: normal of the surface, in the meridian plane
    n_z: float


@compiled(nogil=True, borrows=True)
def widest_between(body: Array, low: float, high: float) -> float:
    """Greatest radius of the body whose closed generator is (k, 2) (r, z) between two heights [m]; -inf beside it."""
    widest = -np.inf
    for k in range(body.shape[0] - 1):
        below, above = body[k, 1], body[k + 1, 1]
        if above < low or below > high:
            continue
        a, b = body[k, 0], body[k + 1, 0]
        if below < above:
            slope = (b - a) / (above - below)
            a, b = a + slope * max(low - below, 0.0), b - slope * max(above - high, 0.0)
        widest = max(widest, a, b)
    return widest


@compiled(nogil=True, borrows=True)
def is_far(body: Array, o: tuple[float, float, float], outline: Array, half: float) -> bool:
    """Whether the body is nowhere within the reach of the prism about o, by the ball around it."""
    reach = 0.0
    for i in range(outline.shape[0]):
        reach = max(reach, outline[i, 0] * outline[i, 0] + outline[i, 1] * outline[i, 1])
    reach = (1.0 + SURELY) * np.sqrt(reach + half * half)
    far: bool = np.hypot(o[0], o[1]) - reach > widest_between(body, o[2] - reach, o[2] + reach)
    return far


@compiled(nogil=True, borrows=True)
def depth_at(body: Array, rho: float, z: float) -> tuple[float, float, float]:
    """How deep a point stands in the body whose closed generator is (k, 2) (r, z) [m], and the normal; -1 outside."""
    last = body.shape[0] - 1
    if not body[0, 1] < z < body[last, 1]:
        return -1.0, 1.0, 0.0
    k = 1
    while k < last - 2 and z >= body[k + 1, 1]:
        k += 1
    t = (z - body[k, 1]) / (body[k + 1, 1] - body[k, 1])
    if rho >= body[k, 0] + t * (body[k + 1, 0] - body[k, 0]):
        return -1.0, 1.0, 0.0
    best, n_rho, n_z = np.inf, 1.0, 0.0
    for k in range(last):
        er, ez = body[k + 1, 0] - body[k, 0], body[k + 1, 1] - body[k, 1]
        square = er * er + ez * ez
        if square == 0.0:
            continue
        t = min(max(((rho - body[k, 0]) * er + (z - body[k, 1]) * ez) / square, 0.0), 1.0)
        dr, dz = body[k, 0] + t * er - rho, body[k, 1] + t * ez - z
        distance = np.hypot(dr, dz)
        if distance < best:
            best, n_rho, n_z = distance, ez / np.sqrt(square), -er / np.sqrt(square)
            if (t == 0.0 or t == 1.0) and distance > 0.0:  # a corner that turns inwards
                n_rho, n_z = dr / distance, dz / distance
    return best, n_rho, n_z


@compiled(nogil=True, borrows=True)
def spot_at(body: Array, x: float, y: float, z: float) -> Spot:
    """A point in the axes of the body."""
    depth, n_rho, n_z = depth_at(body, np.hypot(x, y), z)
    return Spot(x, y, z, depth, n_rho, n_z)


@compiled(nogil=True, borrows=True)
def is_beside(body: Array, p: Spot, q: Spot) -> bool:
    """Whether the edge between two corners is farther from the axis than the body is wide where it is."""
    dx, dy = q.x - p.x, q.y - p.y
    a, b = dx * dx + dy * dy, p.x * dx + p.y * dy
    s = min(max(-b / a, 0.0), 1.0) if a > 0.0 else 0.0
    nearest = np.hypot(p.x + s * dx, p.y + s * dy)
    beside: bool = (1.0 - SURELY) * nearest > widest_between(body, min(p.z, q.z), max(p.z, q.z))
    return beside


@compiled(nogil=True, borrows=True)
def deepest(body: Array, p: Spot, q: Spot) -> Spot:
    """The point between two corners that stands deepest in the body; one of them if none between stands deeper.

    Along p + s q the distance n_rho rho + n_z z from a cone has its minimum where n_rho (p . q + s q . q) / rho + n_z
    q_z = 0, scalar products in the plan.
    """
    best = p if p.depth >= q.depth else q
    dx, dy, dz = q.x - p.x, q.y - p.y, q.z - p.z
    a, b = dx * dx + dy * dy, p.x * dx + p.y * dy
    if a == 0.0:
        return best
    least = np.sqrt(max(p.x * p.x + p.y * p.y - b * b / a, 0.0))  # distance from the axis at which the line passes it
    for k in range(body.shape[0] - 1):
        er, ez = body[k + 1, 0] - body[k, 0], body[k + 1, 1] - body[k, 1]
        length = np.hypot(er, ez)
        if length == 0.0 or ez <= 0.0:
            continue
        n, m = ez / length, dz * er / length  # n_rho, and - n_z dz
        if n * n * a <= m * m:
            continue
        s = m * least / (np.sqrt(a) * np.sqrt(n * n * a - m * m)) - b / a
        if 0.0 < s < 1.0:
            found = spot_at(body, p.x + s * dx, p.y + s * dy, p.z + s * dz)
            if found.depth > best.depth * (1.0 + DEEPER):
                best = found
    return best


@compiled(nogil=True, borrows=True)
def turns_outwards(body: Array, k: int) -> bool:
    """Whether the generator has a convex corner there."""
    ar, az = body[k, 0] - body[k - 1, 0], body[k, 1] - body[k - 1, 1]
    br, bz = body[k + 1, 0] - body[k, 0], body[k + 1, 1] - body[k, 1]
    convex: bool = ar * bz - az * br > 0.0
    return convex
