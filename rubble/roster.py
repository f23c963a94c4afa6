"""All plates as plain numbers: what is left at the end of a run, and what another one begins with.

Places and motions are kept to the last digit. What the contacts of a pile know of each other is not kept, nor what the
water has moved: plates that are put in again touch anew, at once, where they lie.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rubble.arrays import Array
from rubble.layer import RubbleLayer
from rubble.piece import Piece, Plate, Start, prism_of
from rubble.prism import Prism


@dataclass(frozen=True)
class PrismState:
    """A prism of a plate, in the axes of the plate, from its centre of mass."""

    outline: Array  #: (k, 2) in x, z, counter-clockwise [m]
    y: float  #: of its middle [m]
    cuts: Array  #: (s + 1,) places along x between which its width is constant [m]
    widths: Array  #: (s,) along y [m]


@dataclass(frozen=True)
class PlateState:
    """A plate where and as it moves."""

    position: Array  #: (3,) of the centre of mass [m]
    quaternion: Array  #: (4,) w, x, y, z of the turn from its axes to the fixed ones
    velocity: Array  #: (3,) of the centre of mass [m/s]
    omega: Array  #: (3,) rate of turning, fixed axes [rad/s]
    flooded: float  #: part of its head of water that the top carries
    aligned: bool  #: its long axis has once aligned with the slope
    sliding: bool  #: it slides: it has aligned and has left the sheet
    prisms: tuple[PrismState, ...]


Entry = tuple[PlateState, list[tuple[Prism, Array]]]  #: a plate, and its prisms with their places (3,) in its axes


def roster(layer: RubbleLayer) -> list[PlateState]:
    """All plates that are followed, in the order of their numbers."""
    return [_state_of(p) for p in layer.blocks]


def entries(plates: Sequence[PlateState], density: float) -> list[Entry]:
    """Plates with their prisms of ice of this density [kg/m^3], each at its place (3,).

    ValueError, which names plate and prism, if an outline is not convex or strips do not fit it.
    """
    found: list[Entry] = []
    for k, state in enumerate(plates):
        own: list[tuple[Prism, Array]] = []
        for i, p in enumerate(state.prisms):
            try:
                own.append(prism_of(p.outline, p.y, p.cuts, p.widths, density))
            except ValueError as error:
                raise ValueError(f"plates.{k}.prisms.{i}: {error}") from error
        found.append((state, own))
    return found


def enter(layer: RubbleLayer, plates: Sequence[Entry]) -> None:
    """Puts plates into a layer; each is a fragment of its own."""
    made = []
    for fragment, (state, prisms) in enumerate(plates):
        start = Start(state.position, state.quaternion, state.velocity, state.omega)
        plate = layer.store.make(fragment, prisms, start, state.flooded)
        plate.aligned, plate.sliding = state.aligned, state.sliding
        made.append(plate)
    layer.store.add(*made)


def _state_of(plate: Plate) -> PlateState:
    rows, i = plate.rows, plate.row
    return PlateState(
        position=plate.position.copy(),
        quaternion=rows.quaternion[i].copy(),
        velocity=plate.velocity.copy(),
        omega=plate.omega.copy(),
        flooded=plate.flooded,
        aligned=plate.aligned,
        sliding=plate.sliding,
        prisms=tuple(_prism_state(p) for p in plate.pieces),
    )


def _prism_state(piece: Piece) -> PrismState:
    x, y, z = piece.centre.tolist()
    own = piece.prism
    return PrismState(own.polygon + np.array([x, z]), y, own.cuts + x, own.widths.copy())
