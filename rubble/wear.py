"""Crushed ice comes off: corners of a piece that stand in the structure, and that nothing pushes out again.

Where ice crushes the overlap stays (`rows.set_laws`). It is ice that is not there any more, so once it is thicker than
`WORN` slops the piece is cut along the surface at the corner that stands in it, and loses mass, momentum and energy.
Overlap that was found, without crushing, is an error of place and no ice lost: it stays. Where the structure's own
corner stands in a face of the ice the piece keeps its outline: the notch would not be convex.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from rubble.arrays import Array
from rubble.breaking import LEAST
from rubble.geometry import area_moments, clip
from rubble.lost import Lost
from rubble.physics import RubblePhysics
from rubble.piece import Piece, Plate, prism_of
from rubble.prism import Prism
from rubble.rows import STRUCTURE, Rows
from rubble.slices import CORNERS, Slices
from rubble.slots import ROUND_SLOT
from rubble.store import Store

WORN = 0.8  #: thickness of crushed ice, in slops, from which it comes off: with the slop it is in 0.9 % of h
BY_CORNER = 2.0  #: distance of a point from a corner of the outline up to which it is that corner's, in slops
TINY = 1e-5  #: area that a corner takes along, in thicknesses squared, below which it goes with the crushed ice
MOST = CORNERS - 4  #: corners of an outline beyond which the least one goes with the crushed ice


Left = tuple[Piece, tuple[Prism, Array] | None]


class Bite(NamedTuple):
    """Where a piece has been crushed, in the axes of its plate."""

    spot: Array  #: (3,) the point that stands in the structure [m]
    normal: Array  #: (3,) out of the structure
    depth: float  #: of crushed ice [m]


def find_bites(store: Store, rows: Rows, count: int, slices: Slices) -> dict[int, list[Bite]]:
    """Where the structure has crushed pieces, by the number of the piece; from the rows of the last sub-step."""
    point, n, least = rows.point[:count], rows.way[:count, 0], WORN * store.physics.slop
    pieces, found = store.tables.pieces, dict[int, list[Bite]]()
    deep = (point["kind"] == STRUCTURE) & (point["crushed"] > 0.0) & (point["met"] > least)
    for c in np.flatnonzero(deep).tolist():
        slot = int(point["slot_b"][c])
        own = point["slot_a"][c] == ROUND_SLOT  # else it is a slice
        piece = int(np.flatnonzero(pieces.number == slot)[0]) if own else int(slices.piece[slot])
        normal = np.array([n[axis][c] for axis in "xyz"])
        spot = np.array([point[axis][c] for axis in "xyz"]) - 0.5 * point["depth"][c] * normal
        plate = store.list[int(pieces.plate[piece])]
        depth = min(float(point["met"][c]), float(point["crushed"][c]) + least)
        bite = Bite((spot - plate.position) @ plate.rotation, normal @ plate.rotation, depth)
        found.setdefault(int(pieces.number[piece]), []).append(bite)
    return found


def take_off(store: Store, found: dict[int, list[Bite]], energy_of: Callable[[Plate], float], crushed: Lost) -> Array:
    """Takes crushed ice off; returns by how much what plates carry has changed, as `Store.replace`.

    A piece that has gone in the meantime is none of them.
    """
    pairs: list[tuple[Plate, list[Plate]]] = []
    for plate in [p for p in store.list if any(piece.number in found for piece in p.pieces)] if found else []:
        left = _worn(plate, found, store.physics)
        if all(rest is None for _, rest in left) and len(left) == len(plate.pieces):
            continue
        new = [_rest(store, plate, left)] if left else []
        mass, momentum, energy = sum(p.mass for p in new), sum(p.momentum for p in new), sum(map(energy_of, new))
        crushed.take(plate.mass - mass, plate.momentum - momentum, energy_of(plate) - energy)
        pairs.append((plate, new))
    return store.replace(pairs)


def _worn(plate: Plate, found: dict[int, list[Bite]], physics: RubblePhysics) -> list[Left]:
    """Pieces of a plate of which something is left, with the prism that it is now, None if it has lost nothing."""
    left: list[Left] = []
    for piece in plate.pieces:
        rest = _bitten(piece, found.get(piece.number, ()), physics.slop, physics.thickness)
        if rest is None:
            left.append((piece, None))
        elif len(rest[0]) >= 3 and rest[2].min() > 0.0 and area_moments(rest[0]).area >= LEAST * physics.thickness**2:
            left.append((piece, prism_of(rest[0], rest[1], piece.prism.cuts + piece.centre[0], rest[2], physics.rho_i)))
    return left


def _rest(store: Store, plate: Plate, left: Sequence[Left]) -> Plate:
    """What is left of a plate: it and its pieces keep their numbers, so that their contacts go on."""
    rest = store.part_of(plate, [(p.prism, p.centre) if new is None else new for p, new in left])
    rest.id, rest.thrust = plate.id, plate.thrust
    for own, (piece, new) in zip(rest.pieces, left, strict=True):
        own.number, own.worn = piece.number, piece.worn + (new is not None)
    return rest


def _bitten(piece: Piece, found: Sequence[Bite], slop: float, thickness: float) -> tuple[Array, float, Array] | None:
    """Outline (k, 2), y of the middle and widths (s,) without what was crushed; None if it stays as it is."""
    outline, y, widths, changed = piece.corners, float(piece.centre[1]), piece.prism.widths, False
    for bite in found:
        x, z = bite.spot[::2]
        if np.hypot(*(piece.corners - bite.spot[::2]).T).min() > BY_CORNER * slop:
            continue
        nx, ny, nz = bite.normal
        if np.hypot(nx, nz) >= abs(ny):
            outline = clip(outline, -nx, -nz, -(nx * x + nz * z + bite.depth))
        else:  # its side stands in the structure
            widths, y = widths - bite.depth / abs(ny), y + 0.5 * bite.depth / ny
        changed = True
        if len(outline) < 3 or not (widths > 0.0).all():
            break
    return (_fewer(outline, TINY * thickness**2), y, widths) if changed else None


def _fewer(outline: Array, tiny: float) -> Array:
    """The same without corners that take less ice along than an area, and with at most `MOST`.

    Cuts one after the other leave corners within rounding of each other, between which an edge has no direction.
    """
    while len(outline) > 3:
        before, after = np.roll(outline, 1, axis=0) - outline, np.roll(outline, -1, axis=0) - outline
        lost = 0.5 * np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
        least = int(np.argmin(lost))
        if lost[least] >= tiny and len(outline) <= MOST:
            break
        outline = np.delete(outline, least, axis=0)
    return np.ascontiguousarray(outline)
