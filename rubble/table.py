"""All blocks as arrays, and what carries them, gathered over the sections."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rubble.arrays import Array, filled, gathered, rows
from rubble.bodies import LATERAL, LOAD, STATE, Outlines, place_all
from rubble.section import Section


def columns(sections: Mapping[int, Section]) -> dict[str, NDArray[Any]]:
    """All blocks as arrays, in the order of their numbers.

    ``id``, ``section``, ``sliding`` (else rotating), ``mass`` [kg], ``width`` [m], ``position`` (n, 3) [m], ``angle``
    counter-clockwise in the x-z picture [rad], ``velocity`` (n, 3) [m/s], ``omega`` [rad/s], ``load`` (n, 3) mean force
    on the structure [N]; ``outline`` (v, 2) all corners [m], of which block i owns those from ``offset[i]`` to
    ``offset[i + 1]``.
    """
    blocks = [b for s in sections.values() for b in s.blocks]
    ids = np.array([b.id for b in blocks], np.int64)
    order = np.argsort(ids)
    state = filled(STATE, gathered((s.state for s in sections.values()), STATE)[order])
    lateral = filled(LATERAL, gathered((s.tables.lateral for s in sections.values()), LATERAL)[order])
    number = np.repeat(np.array(list(sections), np.int64), [len(s.blocks) for s in sections.values()])
    outlines = _outlines(sections, order)
    return {
        "id": ids[order],
        "section": number[order],
        "sliding": np.array([b.sliding for b in blocks], np.bool_)[order],
        "mass": np.array([b.mass for b in blocks], np.float64)[order],
        "width": np.array([b.prism.width for b in blocks], np.float64)[order],
        "position": np.stack([state["x"], lateral["y"], state["z"]], -1),
        "angle": state["angle"].copy(),
        "velocity": np.stack([state["v_x"], lateral["v_y"], state["v_z"]], -1),
        "omega": state["omega"].copy(),
        "load": gathered((s.tables.load for s in sections.values()), LOAD)[order],
        "outline": place_all(outlines, state),
        "offset": outlines.offset,
    }


def _outlines(sections: Mapping[int, Section], order: NDArray[np.intp]) -> Outlines:
    """Outlines of all blocks in body frames, in the given order."""
    own = [s.tables.outlines for s in sections.values()]
    corners = np.concatenate([np.zeros((0, 2)), *(o.corners for o in own)])
    count = np.concatenate([np.zeros(0, np.int64), *(np.diff(o.offset) for o in own)])
    start, count = (np.cumsum(count) - count)[order], count[order]
    offset = np.concatenate([[0], np.cumsum(count)]).astype(np.int64)
    return Outlines(corners[np.repeat(start - offset[:-1], count) + np.arange(offset[-1])], offset)


def contact_centres(sections: Mapping[int, Section]) -> Array:
    """Mean place of each block's contacts with the structure (n, 2), see `RubbleLayer.contact_centres` [m]."""
    ids = np.array([b.id for s in sections.values() for b in s.blocks], np.int64)
    centres = [np.zeros((0, 2))]
    for s in sections.values():
        push = s.sums.block["push"][:, None]
        at = rows(s.sums.block, "push_at_x", 2)
        centres.append(np.divide(at, push, out=np.full(at.shape, np.nan), where=push > 0.0))
    found: Array = np.concatenate(centres)[np.argsort(ids)]
    return found


def budget(sections: Iterable[Section], window: float) -> dict[str, Array]:
    """Mean forces on all blocks, x and z, over the last window of length ``window`` [s], each (2,) [N].

    ``flooded_rubble`` weight and the pressure of water as if all tops were flooded, ``dry_tops`` what tops that are not
    add to it, ``drag``, ``inertia`` minus the gain of momentum with added mass, ``on_sheet`` the force that the blocks
    exert on the sheet. What these do not carry presses on the structure.
    """
    flooded, dry, drag, inertia, on_sheet = np.zeros((5, 2))
    for s in sections:
        sums = s.sums
        flooded += rows(sums.water_impulse, "flooded_x", 2)[0]
        dry += rows(sums.water_impulse, "dry_x", 2)[0]
        drag += rows(sums.water_impulse, "drag_x", 2)[0]
        flooded += window * sums.dead_load
        inertia -= sums.momentum_gain
        on_sheet += rows(sums.sheet, "x", 2)[0]
    forces = {"flooded_rubble": flooded, "dry_tops": dry, "drag": drag, "inertia": inertia, "on_sheet": on_sheet}
    return {name: f / window if window else f for name, f in forces.items()}
