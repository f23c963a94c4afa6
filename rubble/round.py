"""A body of revolution as pieces of ice meet it: in three dimensions.

A piece that one section alone sees stands anywhere within half a section of its plane, and there the body is another
one: on the flank of a cone, where the surface looks along y, by metres. So such pieces do not meet the cut of the body
but the body itself. In the meridian plane (rho, z) through a point it is the area below its generator rho = r(z),
closed by a lid at either end; the nearest point of the surface lies in the same plane. What touches it:

    corners of the outline in the middle of the piece
    edges of it, with the point that stands deepest: along p + s q the distance n_rho rho + n_z z from a cone has its
        minimum where n_rho (p . q + s q . q) / rho + n_z q_z = 0, scalar products in the plan
    rims of the body, where its generator turns outwards, within the outline

The normal of corners and edges is that of the body, radial in the plan; that of a rim is the face of the ice.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array
from rubble.compiled import compiled
from rubble.corners import bounds, first_of, go_on_from
from rubble.gather import Scene, in_three
from rubble.moving import aside, from_axes, own_axes, turned
from rubble.plates import times
from rubble.rows import STRUCTURE, Rows, set_arms, set_normal
from rubble.slots import ROUND_SLOT

AXIS = 1e-9  #: distance from the axis below which a point has no bearing, in radii
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


@compiled(nogil=True)
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


@compiled(nogil=True)
def _spot(body: Array, x: float, y: float, z: float) -> Spot:
    depth, n_rho, n_z = depth_at(body, np.hypot(x, y), z)
    return Spot(x, y, z, depth, n_rho, n_z)


@compiled(nogil=True)
def _deepest(body: Array, p: Spot, q: Spot) -> Spot:
    """The point between two corners that stands deepest in the body; one of them if none between stands deeper."""
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
            found = _spot(body, p.x + s * dx, p.y + s * dy, p.z + s * dz)
            if found.depth > best.depth * (1.0 + DEEPER):
                best = found
    return best


@compiled(nogil=True)
def _corners(scene: Scene, s: int) -> Array:
    """Corners (m, 3) of the outline in the middle of a slice's piece, in the axes of the structure [m]."""
    pieces, k, i = scene.pieces, scene.slices.plate[s], scene.slices.piece[s]
    first, p, r = pieces.offset[i], scene.plates.position[k], scene.plates.rotation[k]
    out = np.empty((pieces.offset[i + 1] - first, 3))
    for c in range(out.shape[0]):
        x, y, z = times(r, pieces.corners[first + c, 0], pieces.y[i], pieces.corners[first + c, 1])
        out[c, 1] = p[1] + y
        out[c, 0], out[c, 2] = own_axes(scene.moving, out[c, 1], p[0] + x, p[2] + z)
        out[c, 1] -= aside(scene.moving, out[c, 0], out[c, 2])
    return out


@compiled(nogil=True)
def _is_far(body: Array, widest: float, corners: Array) -> bool:
    """Whether a piece with these corners (m, 3) is too far from the axis, or below or above the body, to meet it."""
    x, y, m = corners[:, 0].mean(), corners[:, 1].mean(), corners.shape[0]
    reach, low, high = 0.0, np.inf, -np.inf
    for i in range(m):
        reach = max(reach, np.hypot(corners[i, 0] - x, corners[i, 1] - y))
        low, high = min(low, corners[i, 2]), max(high, corners[i, 2])
    far: bool = np.hypot(x, y) - reach > widest or low > body[-1, 1] or high < body[0, 1]
    return far


@compiled(nogil=True)
def _put(scene: Scene, rows: Rows, c: int, spot: tuple[float, float, float], n: tuple[float, float, float]) -> None:
    """Place and directions of a row from a point and a normal, both in the axes of the structure."""
    moving, point = scene.moving, rows.point[c]
    point.y = spot[1] + aside(moving, spot[0], spot[2])
    point.x, point.z = from_axes(moving, point.y, spot[0], spot[2])
    x, z = turned(moving, n[0], n[2])
    set_normal(rows, c, x, n[1] + moving.place[5] * n[0] - moving.place[3] * n[2], z)


@compiled(nogil=True)
def _on_surface(scene: Scene, widest: float, rows: Rows, c: int, spot: Spot) -> None:
    """A row where ice stands in the body, whose greatest radius is ``widest`` [m]: half-way to the surface."""
    rho, half = np.hypot(spot.x, spot.y), 0.5 * spot.depth
    cos, sin = (spot.x / rho, spot.y / rho) if rho > AXIS * widest else (-1.0, 0.0)
    n = (spot.n_rho * cos, spot.n_rho * sin, spot.n_z)
    rows.point[c].depth = spot.depth
    _put(scene, rows, c, (spot.x + half * n[0], spot.y + half * n[1], spot.z + half * n[2]), n)


@compiled(nogil=True)
def _rim(scene: Scene, rows: Rows, c: int, corners: Array, edge: int, side: float) -> bool:
    """A row where the rim between two pieces of the generator stands in the outline, in front or behind."""
    body = scene.body
    r, z = body[edge, 0], body[edge, 1]
    if r <= 0.0 or not _turns_outwards(body, edge):
        return False
    y, n = corners[:, 1].mean(), corners.shape[0]
    if r * r <= y * y:
        return False
    x = side * np.sqrt(r * r - y * y)
    best, nx, nz, sign = np.inf, 0.0, 0.0, 0.0
    for i in range(n):  # either way round
        j = i + 1 if i + 1 < n else 0
        sign += corners[i, 0] * corners[j, 2] - corners[j, 0] * corners[i, 2]
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        tx, tz = corners[j, 0] - corners[i, 0], corners[j, 2] - corners[i, 2]
        length = np.copysign(max(np.hypot(tx, tz), 1e-300), sign)
        depth = (tx * (z - corners[i, 2]) - tz * (x - corners[i, 0])) / length
        if depth < best:
            best, nx, nz = depth, -tz / length, tx / length
    if best < 0.0:
        return False
    rows.point[c].depth = best
    _put(scene, rows, c, (x - 0.5 * best * nx, y, z - 0.5 * best * nz), (nx, 0.0, nz))
    return True


@compiled(nogil=True)
def _turns_outwards(body: Array, k: int) -> bool:
    """Whether the generator has a convex corner there."""
    ar, az = body[k, 0] - body[k - 1, 0], body[k, 1] - body[k - 1, 1]
    br, bz = body[k + 1, 0] - body[k, 0], body[k + 1, 1] - body[k, 1]
    convex: bool = ar * bz - az * br > 0.0
    return convex


@compiled(nogil=True)
def round_rows(scene: Scene, rows: Rows, old: Rows, found: int, before: int) -> int:
    """Adds the contacts of pieces with the body of revolution; returns the number of rows, -1 if there is no room.

    ``old`` has ``before`` rows. A contact goes on over new slices, since it depends on the piece alone.
    """
    if scene.body.shape[0] == 0:
        return found
    slices, last, c, widest = scene.slices, first_of(old, before, ROUND_SLOT), found, scene.body[:, 0].max()
    for s in range(slices.piece.shape[0]):
        if not in_three(scene, s):
            continue
        corners, start = _corners(scene, s), c
        if _is_far(scene.body, widest, corners):
            continue
        n, rims = corners.shape[0], scene.body.shape[0] - 2
        if rows.point.shape[0] < c + 2 * n + 2 * rims:
            return -1
        spots = [_spot(scene.body, corners[i, 0], corners[i, 1], corners[i, 2]) for i in range(n)]
        for feature in range(2 * n + 2 * rims):
            spot = spots[feature % n]
            if feature < n:
                met = spot.depth >= 0.0
            elif feature < 2 * n:
                p, q = spot, spots[(feature + 1) % n]
                spot = _deepest(scene.body, p, q)
                met = spot.depth >= 0.0 and spot.depth > max(p.depth, q.depth)
            else:
                k = feature - 2 * n
                met = _rim(scene, rows, c, corners, 1 + k // 2, 1.0 if k % 2 else -1.0)
            if not met:
                continue
            if feature < 2 * n:
                _on_surface(scene, widest, rows, c, spot)
            point = rows.point[c]
            point.a, point.b, point.edge, point.kind = scene.plates.moved.shape[0] - 1, slices.plate[s], -1, STRUCTURE
            point.slot_a, point.slot_b, point.feature = ROUND_SLOT, s, feature
            set_arms(rows, c, scene.plates, scene.edges)
            last = go_on_from(rows, c, old, last, before, False)
            c += 1
        bounds(scene, rows, start, c)
    return c
