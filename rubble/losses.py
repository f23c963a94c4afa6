"""Where the energy of a section goes, sub-step by sub-step; exact for what the solver does.

A sub-step moves every body by (v_0 + b) dt, b the solver's correction of overlap, then kicks it with its force F and
solves the contacts: v' = v_0 + F dt / M, v_1 = v' + sum J / M. Kinetic energy is a square, so in the sum over bodies

    forces    F dt . (v_0 + v') / 2 = F . v_0 dt + (F dt)^2 / 2 M
    contacts  J . (u' + u_1) / 2 each, u the velocity of its point

whatever the order in which the solver has found the impulses J. F . v_0 is the power of weight, water and drag. The
second part of the kick, and what `water` finds for the pressure at the end of the way, come from the step being
finite: *stepping*. A contact at rest gives the kick back. The correction b dt moves a block against its weight and the
pressure without any velocity: *correction*. M counts the added mass: the water that moves with a block is part of it.
"""

from __future__ import annotations

import numpy as np

from rubble.arbiters import read_contact
from rubble.compiled import compiled
from rubble.friction import SHEET_SLOT, slot_of
from rubble.geometry import Array
from rubble.pointers import IntArray, integer, real, short
from rubble.water import water_energy

#: sums of a section [J]: put in by stepping, by correction; lost along the normal between ice and ice, structure,
#: sheet; lost to friction in the same pairs; done by blocks on the sheet
STEPPING, CORRECTION, IMPACT, FRICTION, ON_SHEET, WORK = 0, 1, 2, 5, 8, 9
NEAR = 1e-4  #: way of a correction over which the pressure counts as constant [m], [rad]
#: of `stock`: kinetic energy in the plane and across, energy of weight and water
STOCK = 2


@compiled(
    "void(int64[::1], int64[::1], float64[:, ::1], float64, int64, float64[:, ::1], float64[::1])",
    nogil=True,
)
def kick(bodies: IntArray, layout: IntArray, state: Array, dt: float, blocks: int, kicked: Array, work: Array) -> None:
    """Velocities (n, 3) that the forces in the bodies will have made, before contacts, and what the kick adds."""
    for i in range(bodies.shape[0]):
        gain = 0.0
        for k in range(3):
            impulse = real(bodies[i] + layout[6 + k]) * dt
            step = impulse * real(bodies[i] + layout[10 if k == 2 else 9])
            kicked[i, k] = state[i, 3 + k] + step
            gain += 0.5 * impulse * step
        if i < blocks:
            work[STEPPING] += gain


@compiled(
    "void(float64[:, ::1], float64[:, ::1], float64, float64[:, ::1], float64[:, ::1], int64[::1], float64, "
    "float64[:, ::1], float64[:, ::1], float64[::1])",
    nogil=True,
)
def settle(
    old: Array,
    state: Array,
    dt: float,
    dead: Array,
    edges: Array,
    offset: IntArray,
    rho_g: float,
    pressure: Array,
    kicked: Array,
    work: Array,
) -> None:
    """After a step: ``kicked`` becomes the velocity at which contacts do their work, and the correction is booked.

    A way up to `NEAR` changes the water's energy by the pressure times the way; along a longer one, as of blocks that
    are born into each other, the pressure changes: the energy is taken at both ends, and ``pressure`` is unknown.
    """
    for i in range(state.shape[0]):
        far = 0.0
        for k in range(3):
            kicked[i, k] = 0.5 * (kicked[i, k] + state[i, 3 + k])
            if i < dead.shape[0]:
                moved = state[i, k] - old[i, k] - dt * old[i, 3 + k]
                work[CORRECTION] -= (dead[i, k] + pressure[i, k]) * moved
                far = max(far, abs(moved))
        if far > NEAR:
            for k in range(3):
                moved = state[i, k] - old[i, k] - dt * old[i, 3 + k]
                work[CORRECTION] += pressure[i, k] * moved
                pressure[i, k] = np.nan
            start, end, z, angle = offset[i], offset[i + 1], old[i, 1] + dt * old[i, 4], old[i, 2] + dt * old[i, 5]
            work[CORRECTION] += water_energy(edges, start, end, state[i, 1], state[i, 2], rho_g)
            work[CORRECTION] -= water_energy(edges, start, end, z, angle, rho_g)


@compiled(
    "void(int64[::1], int64[::1], int64[::1], int64[::1], int64[::1], float64[:, ::1], int64, float64[::1])",
    nogil=True,
)
def contact_work(
    header: IntArray,
    pairs: IntArray,
    layout: IntArray,
    addresses: IntArray,
    slots: IntArray,
    middle: Array,
    sheet_row: int,
    work: Array,
) -> None:
    """Adds what each contact of a sub-step takes; ``middle`` (n, 3) from `settle`, the rest as in `accumulate`."""
    v = np.empty(9)
    for k in range(header[0]):
        arbiter = pairs[k]
        a = slot_of(integer(arbiter + layout[0]), addresses, slots)
        b = slot_of(integer(arbiter + layout[1]), addresses, slots)
        turn = a > b
        if turn:
            a, b = b, a
        start, kind = integer(arbiter + layout[3]), max(0, -a)
        row = sheet_row if a == SHEET_SLOT else a
        for c in range(short(arbiter + layout[2])):
            read_contact(arbiter, start + c * layout[11], layout, turn, v)
            ux, uz = middle[b, 0] - middle[b, 2] * v[3], middle[b, 1] + middle[b, 2] * v[2]
            if row >= 0:
                wx, wz = middle[row, 0] - middle[row, 2] * v[1], middle[row, 1] + middle[row, 2] * v[0]
                ux, uz = ux - wx, uz - wz
                if a == SHEET_SLOT:
                    work[ON_SHEET] -= v[4] * wx + v[5] * wz
            normal = v[7] * ux + v[8] * uz
            work[IMPACT + kind] -= normal
            work[FRICTION + kind] -= v[4] * ux + v[5] * uz - normal


@compiled(
    "void(int64[::1], int64[::1], float64[:, ::1], float64[:, ::1], float64[:, ::1], int64[::1], float64[::1], "
    "float64, float64, float64, float64[::1])",
    nogil=True,
)
def stock(
    bodies: IntArray,
    layout: IntArray,
    state: Array,
    side: Array,
    edges: Array,
    offset: IntArray,
    mass: Array,
    rho_g: float,
    g: float,
    afloat: float,
    out: Array,
) -> None:
    """Energy of the blocks of a section as they are, see STOCK; ``mass`` (n,) is the true one [kg], ``afloat`` the
    energy of ice afloat, from which they count [J/kg].
    """
    out[:] = 0.0
    for i in range(mass.shape[0]):
        moving, turning = 1.0 / real(bodies[i] + layout[9]), real(bodies[i] + layout[10])
        out[0] += 0.5 * moving * (state[i, 3] ** 2 + state[i, 4] ** 2 + side[1, i] ** 2)
        if turning > 0.0:  # a block that is kept from turning has an infinite moment of inertia
            out[0] += 0.5 / turning * state[i, 5] ** 2
        out[1] += mass[i] * (g * state[i, 1] - afloat)
        out[1] += water_energy(edges, offset[i], offset[i + 1], state[i, 1], state[i, 2], rho_g)
