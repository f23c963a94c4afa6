"""The loop over the sub-steps of a window, compiled: forces, step, contacts, without Python in between.

A Python loop costs as much as the solver for a section of thirty blocks, and two threads gain nothing because each of
many short calls waits for the interpreter lock. Here one compiled call holds no lock for a whole window. It calls the
same library function as `pymunk.Space.step`, by the address that cffi reports, and reads and writes the bodies where
the library keeps them.
"""

from __future__ import annotations

import numpy as np
from pymunk._chipmunk_cffi import ffi, lib

from rubble.compiled import compiled
from rubble.contacts import accumulate
from rubble.geometry import Array
from rubble.losses import contact_work, kick, settle
from rubble.pointers import IntArray, address, real, set_real, step_space
from rubble.sheet import spring_force
from rubble.water import apply_water

STEP = address(ffi.addressof(lib, "cpSpaceStep"))


@compiled("void(int64[::1], int64[::1], float64[:, ::1])", nogil=True)
def read_bodies(bodies: IntArray, layout: IntArray, state: Array) -> None:
    """State rows of bodies, given by their addresses; ``layout`` as in `pointers.body_offsets`."""
    for i in range(bodies.shape[0]):
        for k in range(6):
            state[i, k] = real(bodies[i] + layout[k])


@compiled(
    "int64(int64, float64, int64, int64, int64[::1], int64[::1], float64[:, ::1], float64[:, ::1], int64[::1], "
    "float64[:, ::1], float64[::1], float64[::1], float64[::1], float64[::1], float64[::1], int64[::1], int64[::1], "
    "int64[::1], int64[::1], int64[::1], float64[::1], float64[:, ::1], float64[::1], float64[::1], float64[:, ::1], "
    "float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[::1])",
    nogil=True,
)
def run(
    n: int,
    dt: float,
    step: int,
    space: int,
    bodies: IntArray,
    layout: IntArray,
    state: Array,
    edges: Array,
    offset: IntArray,
    dead: Array,
    water: Array,
    flooded: Array,
    losses: Array,
    spring: Array,
    driver: Array,
    header: IntArray,
    pairs: IntArray,
    pair_layout: IntArray,
    addresses: IntArray,
    slots: IntArray,
    law: Array,
    side: Array,
    limit: Array,
    sheet: Array,
    sums: Array,
    nodes: Array,
    heavy: Array,
    pressure: Array,
    work: Array,
) -> int:
    """Do up to ``n`` sub-steps and returns how many; fewer when the list of pairs (``header``) is half full.

    ``state`` holds the blocks and, in its last row, the sheet if there is one; valid after every step. -1: a pair
    did not fit any more; -2: one with a body that is no block, sheet or structure. ``pressure`` as in `water`;
    ``work`` as in `losses`.
    """
    sheet_row = dead.shape[0]
    force, old, kicked = np.zeros(3), np.empty_like(state), np.empty((state.shape[0], 3))
    read_bodies(bodies, layout, state)
    for k in range(n):
        apply_water(edges, offset, dead, water, flooded, state, bodies, layout, pressure, losses)
        if sheet_row < bodies.shape[0]:
            spring_force(spring, dt, driver, state[sheet_row], force)
            for i in range(3):
                set_real(bodies[sheet_row] + layout[6 + i], force[i])
        header[0] = 0
        old[:] = state
        kick(bodies, layout, state, dt, sheet_row, kicked, work)
        step_space(step, space, dt)
        read_bodies(bodies, layout, state)
        settle(old, state, dt, dead, edges, offset, water[0], pressure, kicked, work)
        if sheet_row < bodies.shape[0]:
            sheet[0], sheet[1] = state[sheet_row, 0], state[sheet_row, 1]
            sheet[2], sheet[3] = state[sheet_row, 3], state[sheet_row, 4]
        if header[0] > header[1]:
            return -1
        if (
            header[0] > 0
            and accumulate(
                header, pairs, pair_layout, addresses, slots, state, law, side, limit, sheet, sums, nodes, heavy
            )
            > 0
        ):
            return -2
        contact_work(header, pairs, pair_layout, addresses, slots, kicked, sheet_row, work)
        if 2 * header[0] > header[1]:
            return k + 1
    return n
