"""Contacts of pieces with a body of revolution, in three dimensions.

A section's plane shows the cut of the body there, and half a section beside it the body is another one: on the flank of
a cone, where the surface looks along y, by metres. So pieces do not meet the cut of the body but the body itself, each
as the prism that it is. What touches:

    corners of the prism
    edges of it, with the point that stands deepest
    rims of the body, where its generator turns outwards, where they pass the middle of the prism

The normal of corners and edges is that of the body, radial in the plan; that of a rim is the face of the ice.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array
from rubble.compiled import compiled
from rubble.corners import bounds, deepest_chord, first_of, go_on_from
from rubble.gather import Scene
from rubble.moving import aside, from_axes, own_axes, turned
from rubble.plates import times
from rubble.round import Spot, deepest, is_beside, is_far, spot_at, turns_outwards
from rubble.rows import STRUCTURE, Rows, set_normal
from rubble.slices import CORNERS
from rubble.slots import ROUND_SLOT

SPOT, DEPTH = 6, 3  #: numbers of a `Spot`, and which of them is its depth
FEATURES = 4096  #: more than an outline has
AXIS = 1e-9  #: distance from the axis below which a point has no bearing, in radii


class Prism(NamedTuple):
    """A piece in the axes of the structure: o + a x + b y + c z, with (x, z) in its outline and y between +- half."""

    origin: tuple[float, float, float]
    a: tuple[float, float, float]
    b: tuple[float, float, float]
    c: tuple[float, float, float]
    outline: Array  #: (n, 2) x and z, counter-clockwise [m]
    half: float  #: of its width [m]


@compiled(nogil=True, borrows=True)
def _own(scene: Scene, k: int, x: float, y: float, z: float) -> tuple[float, float, float]:
    """A point of plate k, in its axes, in those of the structure [m]."""
    p, moving = scene.plates.position[k], scene.moving
    dx, dy, dz = times(scene.plates.rotation[k], x, y, z)
    at_x, at_z = own_axes(moving, p[1] + dy, p[0] + dx, p[2] + dz)
    return at_x, p[1] + dy - aside(moving, at_x, at_z), at_z


@compiled(nogil=True, borrows=True)
def _along(scene: Scene, k: int, axis: int) -> tuple[float, float, float]:
    """An axis of plate k in the axes of the structure, to first order in its angles as `_own`."""
    r, d, cos, sin = scene.plates.rotation[k], scene.moving.place, scene.moving.turn[0], scene.moving.turn[1]
    dx, dy, dz = r[0, axis] + d[5] * r[1, axis], r[1, axis], r[2, axis] - d[3] * r[1, axis]
    x, z = cos * dx - sin * dz, sin * dx + cos * dz
    return x, dy - d[5] * x + d[3] * z, z


@compiled(nogil=True, borrows=True)
def _prism(scene: Scene, i: int) -> Prism:
    """Piece i."""
    pieces, k = scene.pieces, scene.pieces.plate[i]
    return Prism(
        _own(scene, k, 0.0, pieces.y[i], 0.0),
        _along(scene, k, 0),
        _along(scene, k, 1),
        _along(scene, k, 2),
        pieces.corners[pieces.offset[i] : pieces.offset[i + 1]],
        0.5 * pieces.width[i],
    )


@compiled(nogil=True, borrows=True)
def _at(prism: Prism, x: float, y: float, z: float) -> tuple[float, float, float]:
    """A point of a prism in the axes of the structure [m]."""
    o, a, b, c = prism.origin, prism.a, prism.b, prism.c
    return (
        o[0] + a[0] * x + b[0] * y + c[0] * z,
        o[1] + a[1] * x + b[1] * y + c[1] * z,
        o[2] + a[2] * x + b[2] * y + c[2] * z,
    )


@compiled(nogil=True, borrows=True)
def _put(scene: Scene, rows: Rows, c: int, spot: tuple[float, float, float], n: tuple[float, float, float]) -> None:
    """Place and directions of a row from a point and a normal, both in the axes of the structure."""
    moving, point = scene.moving, rows.point[c]
    point.y = spot[1] + aside(moving, spot[0], spot[2])
    point.x, point.z = from_axes(moving, point.y, spot[0], spot[2])
    x, z = turned(moving, n[0], n[2])
    set_normal(rows, c, x, n[1] + moving.place[5] * n[0] - moving.place[3] * n[2], z)


@compiled(nogil=True, borrows=True)
def _on_surface(scene: Scene, widest: float, rows: Rows, c: int, spot: Spot) -> None:
    """A row where ice stands in the body, whose greatest radius is ``widest`` [m]: half-way to the surface."""
    rho, half = np.hypot(spot.x, spot.y), 0.5 * spot.depth
    cos, sin = (spot.x / rho, spot.y / rho) if rho > AXIS * widest else (-1.0, 0.0)
    n = (spot.n_rho * cos, spot.n_rho * sin, spot.n_z)
    rows.point[c].depth = spot.depth
    _put(scene, rows, c, (spot.x + half * n[0], spot.y + half * n[1], spot.z + half * n[2]), n)


@compiled(nogil=True, borrows=True)
def _rim(scene: Scene, rows: Rows, c: int, prism: Prism, edge: int, side: float) -> bool:
    """A row where the rim between two pieces of the generator passes the middle of a prism, on either side.

    The rim (r cos q, r sin q, z) is in the middle plane, b . (p - o) = 0, where r |b| cos(q - bearing of b) = d.
    """
    r, z = scene.body[edge, 0], scene.body[edge, 1]
    o, a, b, e = prism.origin, prism.a, prism.b, prism.c
    most, d = r * np.hypot(b[0], b[1]), b[0] * o[0] + b[1] * o[1] + b[2] * (o[2] - z)
    if not turns_outwards(scene.body, edge) or most <= abs(d):
        return False
    q = np.arctan2(b[1], b[0]) - side * np.arccos(d / most)
    px, py, pz = r * np.cos(q), r * np.sin(q), z
    u = a[0] * (px - o[0]) + a[1] * (py - o[1]) + a[2] * (pz - o[2])
    v = e[0] * (px - o[0]) + e[1] * (py - o[1]) + e[2] * (pz - o[2])
    best, nu, nv, n = np.inf, 0.0, 0.0, prism.outline.shape[0]
    for i in range(n):
        f, g = prism.outline[i], prism.outline[i + 1 if i + 1 < n else 0]
        tu, tv = g[0] - f[0], g[1] - f[1]
        length = max(np.hypot(tu, tv), 1e-300)
        depth = (tu * (v - f[1]) - tv * (u - f[0])) / length
        if depth < best:
            best, nu, nv = depth, -tv / length, tu / length
    if best < 0.0:
        return False
    normal = (a[0] * nu + e[0] * nv, a[1] * nu + e[1] * nv, a[2] * nu + e[2] * nv)
    half = 0.5 * best
    rows.point[c].depth = best
    _put(scene, rows, c, (px - half * normal[0], py - half * normal[1], pz - half * normal[2]), normal)
    return True


@compiled(nogil=True, borrows=True)
def _find_corners(body: Array, prism: Prism, spots: Array) -> None:
    """All corners of a prism, SPOT: n at one end, n at the other."""
    n = prism.outline.shape[0]
    for i in range(2 * n):
        x, z = prism.outline[i % n, 0], prism.outline[i % n, 1]
        at = _at(prism, x, -prism.half if i < n else prism.half, z)
        spot, own = spot_at(body, at[0], at[1], at[2]), spots[i]
        own[0], own[1], own[2], own[3], own[4], own[5] = spot.x, spot.y, spot.z, spot.depth, spot.n_rho, spot.n_z


@compiled(nogil=True, borrows=True)
def _corner(spots: Array, i: int) -> Spot:
    """A corner that `_find_corners` has found."""
    s = spots[i]
    return Spot(s[0], s[1], s[2], s[3], s[4], s[5])


@compiled(nogil=True, borrows=True)
def _ends(edge: int, n: int) -> tuple[int, int]:
    """Corners between which an edge of a prism goes: n at one end, n at the other, n from end to end."""
    if edge < 2 * n:
        start = n if edge >= n else 0
        return edge, start + (edge - start + 1) % n
    return edge - 2 * n, edge - n


@compiled(nogil=True, borrows=True)
def _may_touch(body: Array, spots: Array, n: int, feature: int) -> bool:
    """Whether a feature of a prism with these 2n corners comes near the body at all; features as in `_touch`."""
    if feature >= 5 * n:
        return bool(turns_outwards(body, 1 + (feature - 5 * n) // 2))
    if feature < 2 * n:
        return bool(spots[feature, DEPTH] >= 0.0)
    i, j = _ends(feature - 2 * n, n)
    p, q = _corner(spots, i), _corner(spots, j)
    return p.depth >= 0.0 or q.depth >= 0.0 or not is_beside(body, p, q)


@compiled(nogil=True, borrows=True)
def _touch(scene: Scene, widest: float, rows: Rows, c: int, prism: Prism, spots: Array, feature: int) -> bool:
    """Row c from a feature of a prism: 2n corners, 3n edges, and two places of each rim. Whether it touches."""
    n = prism.outline.shape[0]
    if feature >= 5 * n:
        k = feature - 5 * n
        return bool(_rim(scene, rows, c, prism, 1 + k // 2, 1.0 if k % 2 else -1.0))
    spot = _corner(spots, feature % (2 * n))
    touches = spot.depth >= 0.0
    if feature >= 2 * n:
        i, j = _ends(feature - 2 * n, n)
        spot = deepest(scene.body, _corner(spots, i), _corner(spots, j))
        touches = spot.depth >= 0.0 and spot.depth > max(spots[i, DEPTH], spots[j, DEPTH])
    if touches:
        _on_surface(scene, widest, rows, c, spot)
    return bool(touches)


@compiled(nogil=True)
def round_rows(scene: Scene, rows: Rows, old: Rows, found: int, before: int) -> int:
    """Adds the contacts of pieces with the body of revolution; returns the number of rows, -1 if there is no room.

    ``old`` has ``before`` rows. A contact goes on over new slices, since it depends on the piece alone; it stands under
    the piece's number; the features of an outline that has worn are other ones.
    """
    if scene.body.shape[0] == 0:
        return found
    spots, widest = np.empty((2 * CORNERS, SPOT)), float(scene.body[:, 0].max())
    return int(_rows_of_all(scene, (rows, old), found, before, spots, widest))


@compiled(nogil=True, borrows=True)
def _rows_of_all(scene: Scene, both: tuple[Rows, Rows], found: int, before: int, spots: Array, widest: float) -> int:
    """The same, with room for the corners of a piece, and the greatest radius of the body [m]."""
    (rows, old), slices, pieces = both, scene.slices, scene.pieces
    last, c, piece = first_of(old, before, ROUND_SLOT), found, -1
    for s in range(slices.piece.shape[0]):
        if slices.piece[s] == piece:
            continue
        piece, start = slices.piece[s], c
        outline, k = pieces.corners[pieces.offset[piece] : pieces.offset[piece + 1]], pieces.plate[piece]
        origin = _own(scene, k, 0.0, pieces.y[piece], 0.0)
        if is_far(scene.body, origin, outline, 0.5 * pieces.width[piece]):
            continue
        prism = _prism(scene, piece)
        features = 5 * prism.outline.shape[0] + 2 * (scene.body.shape[0] - 2)
        if rows.point.shape[0] < c + features:
            return -1
        _find_corners(scene.body, prism, spots)
        for feature in range(features):
            if not _may_touch(scene.body, spots, prism.outline.shape[0], feature):
                continue
            if not _touch(scene, widest, rows, c, prism, spots, feature):
                continue
            point = rows.point[c]
            point.a, point.b, point.edge, point.kind = scene.plates.moved.shape[0] - 1, slices.plate[s], -1, STRUCTURE
            point.slot_a, point.slot_b = ROUND_SLOT, pieces.number[piece]
            point.feature = FEATURES * pieces.worn[piece] + feature
            last = go_on_from(rows, c, old, last, before, False)
            c += 1
        bounds(scene, rows, start, c, (scene.widths[s], deepest_chord(scene, outline, rows, start, c)))
    return c
