"""Where the energy of a section goes, sub-step by sub-step; exact for what the solver does.

A sub-step moves every body by (v_0 + b) dt, b the solver's correction of overlap, then kicks it with its force F and
solves the contacts: v' = v_0 + F dt / M, v_1 = v' + sum J / M. Kinetic energy is a square, so in the sum over bodies

    forces    F dt . (v_0 + v') / 2 = F . v_0 dt + (F dt)^2 / 2 M
    contacts  J . (u' + u_1) / 2 each, u the velocity of its point

whatever the order in which the solver has found the impulses J. F . v_0 is the power of weight, water and drag. The
second part of the kick, and what `water` finds for the pressure at the end of a sub-step, come from the step being
finite: *stepping*. A contact at rest gives the kick back. The correction b dt moves a block against its weight and the
pressure without any velocity: *correction*. M counts the added mass: the water that moves with a block is part of it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arbiters import Pairs, read_contact
from rubble.arrays import Array, Record, Records, record
from rubble.bodies import Bodies
from rubble.compiled import compiled
from rubble.pointers import integer, real, short
from rubble.pressure import water_energy
from rubble.slots import SHEET_SLOT, Slots, slot_of
from rubble.water import Hulls

#: since the start [J]: put in by stepping, by correction; done by blocks on the sheet
STEP_WORK = record("stepping", "correction", "on_sheet")
#: lost in contacts since the start [J], along the normal and to friction; a row for each of the pairs below
PAIR_LOSS = record("impact", "friction")
PAIRS = ("ice", "structure", "sheet")  #: what a block meets: slots 0 and more, -1, -2
#: energy now [J]: kinetic in the plane and lateral, of weight and water
ENERGY = record("kinetic", "potential")
#: Displacement of a correction up to which the pressure counts as constant [m], [rad]. The error of the energy is
#: of the second order: rho_w g times the length of the block times half the square, 5e-3 J on 10 m x 10 m of ice.
NEAR = 1e-4


class Ground(NamedTuple):
    """From where the energy of weight and water counts."""

    g: float  #: [m/s^2]
    rho_g: float  #: rho_w g [N/m^3]
    afloat: float  #: energy of ice that floats flat, see `RubblePhysics.afloat` [J/kg]


@compiled(nogil=True)
def kick(bodies: Bodies, dt: float, kicked: Records, work: Record) -> None:
    """Velocities (n,) that the forces in the bodies will have made, before contacts, and what the kick adds."""
    at, address, state = bodies.layout, bodies.address, bodies.state
    for i in range(address.shape[0]):
        body, row, out = address[i], state[i], kicked[i]
        jx, jz, spin = real(body + at.force_x) * dt, real(body + at.force_z) * dt, real(body + at.moment) * dt
        inverse_mass = real(body + at.inverse_mass)
        dx, dz, turn = jx * inverse_mass, jz * inverse_mass, spin * real(body + at.inverse_inertia)
        out.v_x, out.v_z, out.omega = row.v_x + dx, row.v_z + dz, row.omega + turn
        if i < bodies.blocks:
            work.stepping += 0.5 * jx * dx + 0.5 * jz * dz + 0.5 * spin * turn


@compiled(nogil=True)
def book_correction(old: Records, bodies: Bodies, dt: float, hulls: Hulls, rho_g: float, work: Record) -> None:
    """After a step: what the correction of overlap has moved each block, times weight and pressure.

    A displacement up to `NEAR` changes the water's energy by the pressure times it; along a longer one, as of blocks
    that are born into each other, the pressure changes: the energy is taken at both ends, and is unknown afterwards.
    """
    state, weight, pressure = bodies.state, hulls.weight, hulls.pressure
    for i in range(bodies.blocks):
        row, was, own, water = state[i], old[i], weight[i], pressure[i]
        x, z = row.x - was.x - dt * was.v_x, row.z - was.z - dt * was.v_z
        turn = row.angle - was.angle - dt * was.omega
        work.correction -= (own.x + water.x) * x
        work.correction -= (own.z + water.z) * z
        work.correction -= (own.moment + water.moment) * turn
        if max(abs(x), abs(z), abs(turn)) > NEAR:
            work.correction += water.x * x
            work.correction += water.z * z
            work.correction += water.moment * turn
            water.x, water.z, water.moment = np.nan, np.nan, np.nan
            start, end = hulls.offset[i], hulls.offset[i + 1]
            work.correction += water_energy(hulls.edges, start, end, row.z, row.angle, rho_g)
            work.correction -= water_energy(
                hulls.edges, start, end, was.z + dt * was.v_z, was.angle + dt * was.omega, rho_g
            )


@compiled(nogil=True)
def middle_velocity(state: Records, kicked: Records) -> None:
    """``kicked`` becomes the velocity at which contacts do their work: the mean of before and after them."""
    for i in range(state.shape[0]):
        row, out = state[i], kicked[i]
        out.v_x = 0.5 * (out.v_x + row.v_x)
        out.v_z = 0.5 * (out.v_z + row.v_z)
        out.omega = 0.5 * (out.omega + row.omega)


@compiled(nogil=True)
def contact_work(pairs: Pairs, slots: Slots, middle: Records, sheet_row: int, loss: Records, work: Record) -> None:
    """Adds what each contact of a sub-step takes; ``middle`` (n,) from `middle_velocity`."""
    layout, arbiters, address, slot = pairs.layout, pairs.arbiter, slots.address, slots.slot
    for k in range(pairs.list[0].count):
        arbiter = arbiters[k]
        a = slot_of(integer(arbiter + layout.body_a), address, slot)
        b = slot_of(integer(arbiter + layout.body_b), address, slot)
        turn = a > b
        if turn:
            a, b = b, a
        start, kind, own = integer(arbiter + layout.contacts), loss[max(0, -a)], middle[b]
        row = sheet_row if a == SHEET_SLOT else a
        for c in range(short(arbiter + layout.points)):
            v = read_contact(arbiter, start + c * layout.size, layout, turn)
            ux, uz = own.v_x - own.omega * v.b_z, own.v_z + own.omega * v.b_x
            if row >= 0:
                other = middle[row]
                wx, wz = other.v_x - other.omega * v.a_z, other.v_z + other.omega * v.a_x
                ux, uz = ux - wx, uz - wz
                if a == SHEET_SLOT:
                    work.on_sheet -= v.j_x * wx + v.j_z * wz
            normal = v.push_x * ux + v.push_z * uz
            kind.impact -= normal
            kind.friction -= v.j_x * ux + v.j_z * uz - normal


@compiled(nogil=True)
def energy_now(bodies: Bodies, lateral: Records, hulls: Hulls, mass: Array, ground: Ground, out: Records) -> None:
    """Add the energy of the blocks of a section to ``out`` (1,) ENERGY; ``mass`` (n,) is the true one [kg]."""
    at, address, state, total = bodies.layout, bodies.address, bodies.state, out[0]
    for i in range(bodies.blocks):
        row, body = state[i], address[i]
        moving, turning = 1.0 / real(body + at.inverse_mass), real(body + at.inverse_inertia)
        total.kinetic += 0.5 * moving * (row.v_x**2 + row.v_z**2 + lateral[i].v_y ** 2)
        if turning > 0.0:  # a block that is kept from turning has an infinite moment of inertia
            total.kinetic += 0.5 / turning * row.omega**2
        start, end = hulls.offset[i], hulls.offset[i + 1]
        total.potential += mass[i] * (ground.g * row.z - ground.afloat)
        total.potential += water_energy(hulls.edges, start, end, row.z, row.angle, ground.rho_g)
