"""From the pairs that pymunk has found to rows of the solver, in the order of sections and pairs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arbiters import ADDRESS, COUNT, ROOM
from rubble.arrays import Array, IntArray, Record, Records
from rubble.compiled import compiled
from rubble.cut import nearest
from rubble.edges import Edges, deeper_on_sheet
from rubble.geometry import chord
from rubble.moving import Moving, aside, from_axes, turned
from rubble.plates import Plates, times
from rubble.pointers import ArbiterLayout, BodyLayout, integer, real, set_integer, short
from rubble.rows import ICE, SHEET, STEEPEST, STRUCTURE, Rows, go_on, set_normal
from rubble.slices import Pieces, Slices, strayed
from rubble.slots import SHEET_SLOT, STRUCTURE_SLOT, UNKNOWN, Slots, slot_of

SAME_FACE = 1.0 - 1e-6  #: cosine from which a contact's normal is that of a face


class Sections(NamedTuple):
    """The sections for the kernels."""

    y: Array  #: (k,) their planes [m]
    margin: Array  #: (k,) by which the structure in them is thicker than it is, see `section.Section` [m]
    space: IntArray  #: (k,) addresses of the spaces
    pairs: IntArray  #: (k,) addresses of their lists of pairs, `arbiters.LIST`
    aside: Array  #: (k,) how far along y the structure had gone when it was cut [m]
    faces: Records  #: `cut.Cut.bearings` of all sections
    offset: IntArray  #: (k + 1,) section i owns faces[offset[i]:offset[i + 1]]
    step: int  #: address of cpSpaceStep
    arbiter: ArbiterLayout
    body: BodyLayout


class Scene(NamedTuple):
    """What contacts are made of."""

    plates: Plates
    slices: Slices
    sections: Sections
    slots: Slots
    edges: Edges
    dt: float  #: sub-step [s]
    pitch: float  #: width of a section [m]
    widths: Array  #: (s,) of the slices along y [m]
    pieces: Pieces
    strength: float  #: greatest pressure of a contact times the sub-step [Pa s]
    shortest: float  #: least length of a contact [m]
    cut: int  #: number of the sub-step in which the slices are new
    bed: float  #: height of the sea bed, -inf without one [m]
    moving: Moving  #: the structure
    body: Array  #: (k, 2) r and z of its closed generator if it is a body of revolution, else (0, 2), see `prisms` [m]


@compiled(nogil=True, borrows=True)
def gather(scene: Scene, rows: Rows, old: Rows, stamp: int) -> int:
    """Rows of all contacts of this sub-step; returns how many, or minus what went wrong: see `stepping`.

    ``old`` are those of the sub-step before, whose number is ``stamp - 1``; what they carried is the first guess.
    """
    sections, slots, layout = scene.sections, scene.slots, scene.sections.arbiter
    count = 0
    for i in range(sections.space.shape[0]):
        found = sections.pairs[i]
        pairs, arbiters = integer(found + COUNT), integer(found + ADDRESS)
        if pairs > integer(found + ROOM):
            return -1
        for k in range(pairs):
            arbiter = integer(arbiters + 8 * k)
            a = slot_of(integer(arbiter + layout.body_a), slots.address, slots.slot)
            b = slot_of(integer(arbiter + layout.body_b), slots.address, slots.slot)
            points = short(arbiter + layout.points)
            if real(arbiter + layout.n) == 0.0 and real(arbiter + layout.n + 8) == 0.0:
                continue  # outlines that just fall together have no direction in which they could push
            if a == UNKNOWN or b == UNKNOWN:
                return -2
            if min(a, b) == STRUCTURE_SLOT and scene.body.shape[0] > 0:
                continue
            if count + points > rows.point.shape[0]:
                return -3
            start, contact = count, integer(arbiter + layout.contacts)
            for p in range(points):
                _row(scene, rows, count, i, arbiter, contact + p * layout.size, a, b)
                if rows.point[count].depth >= 0.0:
                    count += 1
            if count == start:
                continue
            _law(scene, rows, start, count)
            _first_guess(rows, start, count, old, integer(arbiter + layout.data), stamp, stamp == scene.cut)
            set_integer(arbiter + layout.data, (stamp << 24) | (start + 1))
    return count


@compiled(nogil=True, borrows=True, forceinline=True)
def _row(scene: Scene, rows: Rows, c: int, section: int, arbiter: int, contact: int, a: int, b: int) -> None:
    """One contact; the smaller slot becomes end a: structure and sheet before slices."""
    layout, place = scene.sections.arbiter, scene.sections.body
    body_a, body_b = integer(arbiter + layout.body_a), integer(arbiter + layout.body_b)
    xa, za = real(body_a + place.x) + real(contact + layout.r1), real(body_a + place.z) + real(contact + layout.r1 + 8)
    xb, zb = real(body_b + place.x) + real(contact + layout.r2), real(body_b + place.z) + real(contact + layout.r2 + 8)
    nx, nz = real(arbiter + layout.n), real(arbiter + layout.n + 8)
    depth = (xa - xb) * nx + (za - zb) * nz
    if a > b:
        a, b, nx, nz, xa, za, xb, zb = b, a, -nx, -nz, xb, zb, xa, za
    if a == STRUCTURE_SLOT:
        margin = scene.sections.margin[section]
        xa, za, depth = xa - margin * nx, za - margin * nz, depth - margin
    point = rows.point[c]
    point.a, point.b = scene.plates.moved.shape[0] - 1, scene.slices.plate[b]
    point.edge, point.kind, point.slot_a, point.slot_b = -1, ICE, a, b
    point.feature = integer(contact + layout.hash)
    point.x, point.y, point.z = 0.5 * (xa + xb), scene.sections.y[section], 0.5 * (za + zb)
    n_y = 0.0
    if a == STRUCTURE_SLOT:
        point.kind = STRUCTURE
        n_y, deeper = _on_structure(scene, section, point, nx, nz)
        depth += deeper
    point.x, point.z = from_axes(scene.moving, scene.sections.y[section], point.x, point.z)
    nx, nz = turned(scene.moving, nx, nz)
    if a == SHEET_SLOT:
        point.kind, point.edge = SHEET, section
        depth += deeper_on_sheet(scene.edges, section, point, nx, nz)
    elif a != STRUCTURE_SLOT:
        point.a = scene.slices.plate[a]
        n_y = _lean(scene, a, b, nx, nz)
        depth += n_y * (strayed(scene.plates, scene.slices, a) - strayed(scene.plates, scene.slices, b))
    point.depth = depth * set_normal(rows, c, nx, n_y, nz)


@compiled(nogil=True, borrows=True, forceinline=True)
def _face_of(scene: Scene, s: int, px: float, pz: float) -> int:
    """Edge of a slice whose outward normal is (px, pz); -1 if it has none."""
    r = scene.plates.rotation[scene.slices.plate[s]]
    h = max(np.hypot(r[0, 0], r[2, 0]), 1e-12)
    cos, sin = r[0, 0] / h, r[2, 0] / h
    ux, uz = cos * px + sin * pz, cos * pz - sin * px
    best, found = SAME_FACE, -1
    for k in range(scene.slices.sides[s]):
        like = ux * scene.slices.side[s, k, 0] + uz * scene.slices.side[s, k, 1]
        if like > best:
            best, found = like, k
    return found


@compiled(nogil=True, borrows=True, forceinline=True)
def _on_structure(scene: Scene, section: int, point: Record, nx: float, nz: float) -> tuple[float, float]:
    """n_y of the structure over its part in the plane, (nx, nz); by how much the contact is deeper.

    A piece that one plane alone cuts counts with the surface at its own middle, so that this recedes as it slides round
    the structure. On a body of revolution the surface at another y has the same radius; on a facet it goes along it.
    All in the structure's axes; where that has gone aside it stands there with the surface of another y.
    """
    sections, slices, pieces, moving = scene.sections, scene.slices, scene.pieces, scene.moving
    faces = sections.faces[sections.offset[section] : sections.offset[section + 1]]
    x, away, cut = point.x, aside(moving, point.x, point.z), point.y - sections.aside[section]
    face, r, b = faces[nearest(faces, x, point.z)], scene.plates.rotation[point.b], slices.anchor[point.slot_b]
    i, y = slices.piece[point.slot_b], scene.plates.position[point.b, 1]
    if pieces.range[i, 0] == pieces.range[i, 1]:
        y += r[1, 1] * pieces.y[i]
    else:
        y += r[1, 0] * b[0] + r[1, 1] * b[1] + r[1, 2] * b[2]
    y = min(max(y, point.y - 0.5 * scene.pitch), point.y + 0.5 * scene.pitch)
    point.y, y = y, y - away
    radius, lean = np.hypot(x, cut), moving.place[5] * nx - moving.place[3] * nz
    least = max(radius, 1e-300) / STEEPEST
    at, shift = x, -face.constant * (y - cut)
    if face.radial != 0.0:
        at = np.copysign(max(np.sqrt(max(radius * radius - y * y, 0.0)), least), x)
        shift = at - x
    elif abs(at) < least:
        at = np.copysign(least, at)
    return nx * (face.constant + face.radial * y / at) + lean, shift * nx


@compiled(nogil=True, borrows=True, forceinline=True)
def _lean(scene: Scene, a: int, b: int, nx: float, nz: float) -> float:
    """n_y over the part in the plane of the normal of two slices: that of the face, or faces, which it belongs to."""
    y = across = 0.0
    for side in range(2):
        s, sign = (a, 1.0) if side == 0 else (b, -1.0)
        found = _face_of(scene, s, sign * nx, sign * nz)
        if found >= 0:
            f = scene.slices.face[s, found]
            fx, fy, fz = times(scene.plates.rotation[scene.slices.plate[s]], f[0], f[1], f[2])
            y += sign * fy
            across += np.hypot(fx, fz)
    if across == 0.0:
        return 0.0
    return min(max(y / across, -STEEPEST), STEEPEST)


@compiled(nogil=True, borrows=True)
def _chord(scene: Scene, point: Record, n: Record) -> float:
    """Length over which a slice meets the surface of the structure at a contact [m]."""
    s = point.slot_b
    p, r, b = scene.plates.position[point.b], scene.plates.rotation[point.b], scene.slices.anchor[s]
    h, half = max(np.hypot(r[0, 0], r[2, 0]), 1e-12), 0.5 * point.depth
    cos, sin, at = r[0, 0] / h, r[2, 0] / h, times(r, b[0], b[1], b[2])
    x, z = point.x + half * n.x - p[0] - at[0], point.z + half * n.z - p[2] - at[2]
    corners, count = scene.slices.corners[s], scene.slices.sides[s]
    found: float = chord(
        corners, count, cos * x + sin * z, cos * z - sin * x, cos * n.x + sin * n.z, cos * n.z - sin * n.x
    )
    return found


@compiled(nogil=True, borrows=True, forceinline=True)
def _law(scene: Scene, rows: Rows, start: int, end: int) -> None:
    """What the contact of a pair carries before it crushes, shared by its points.

    Where a corner has come off on the structure there is a facet, which widens on both sides as it is pressed in; the
    face of a piece does not get wider.
    """
    first, last = rows.point[start], rows.point[end - 1]
    length = np.hypot(first.x - last.x, first.z - last.z)
    if first.kind == STRUCTURE:
        flanks = 2.0 * min(first.depth, last.depth)
        length = max(length, min(length + flanks, _chord(scene, first, rows.way[start, 0])))
    for c in range(start, end):  # a corner of 90 degrees is as wide as it is deep on both sides
        length = max(length, 2.0 * rows.point[c].depth)
    width = min(scene.pitch, scene.widths[first.slot_b])
    if first.slot_a >= 0:
        width = min(width, scene.widths[first.slot_a])
    for c in range(start, end):
        rows.point[c].most = scene.strength * width * max(length, scene.shortest) / (end - start)


@compiled(nogil=True, borrows=True, forceinline=True)
def _first_guess(rows: Rows, start: int, end: int, old: Rows, kept: int, stamp: int, cut: bool) -> None:
    """Impulses of the same points one sub-step ago; a new point has as much to give back as the others of its pair."""
    first = (kept & 0xFFFFFF) - 1 if kept >> 24 == stamp - 1 else -1
    for c in range(start, end):
        own, at, owed = rows.point[c], -1, 0.0
        if first >= 0:
            for o in range(first, min(first + 2, old.point.shape[0])):
                was = old.point[o]
                if was.slot_a == own.slot_a and was.slot_b == own.slot_b:
                    owed = max(owed, was.owed)
                    if was.feature == own.feature:
                        at = o
        go_on(rows, c, old, at, owed, cut)
