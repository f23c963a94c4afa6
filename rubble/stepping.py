"""The loop over the sub-steps of a window, compiled: forces, step, contacts, without Python in between.

A Python loop costs as much as the solver for a section of thirty blocks, and two threads gain nothing because each of
many short calls waits for the interpreter lock. Here one compiled call holds no lock for a whole window. It calls the
same library function as `pymunk.Space.step`, by the address that cffi reports, and reads and writes the bodies where
the library keeps them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from pymunk._chipmunk_cffi import ffi, lib

from rubble.arrays import Records
from rubble.bodies import VELOCITY, Bodies, read_bodies, set_force
from rubble.compiled import compiled
from rubble.contacts import Impulses, Meeting, accumulate
from rubble.losses import book_correction, contact_work, kick, middle_velocity
from rubble.pointers import address, step_space
from rubble.sheet import spring_force
from rubble.water import Hulls, Water, apply_water

STEP = address(ffi.addressof(lib, "cpSpaceStep"))
TOO_MANY, STRANGE = -1, -2  #: a pair did not fit any more; one with a body that is no block, sheet or structure


class Steps(NamedTuple):
    """What is stepped, and how far at a time."""

    dt: float  #: sub-step [s]
    space: int  #: address of the space
    function: int  #: address of cpSpaceStep


class Work(NamedTuple):
    """Energy of a section since its start, and impulses of the water over a window."""

    water: Records  #: (1,) WATER_WORK
    impulse: Records  #: (1,) WATER_IMPULSE
    step: Records  #: (1,) STEP_WORK
    loss: Records  #: (3,) PAIR_LOSS


class Sums(NamedTuple):
    """All that is summed over sub-steps."""

    impulses: Impulses
    work: Work


@compiled(nogil=True)
def advance_substeps(
    n: int,
    steps: Steps,
    bodies: Bodies,
    hulls: Hulls,
    water: Water,
    driver: Records,
    meeting: Meeting,
    sums: Sums,
) -> int:
    """Do up to ``n`` sub-steps and return how many; fewer where a list must grow first.

    The states of `Bodies` are valid after every sub-step. ``driver`` (1,) DRIVER moves the sheet if there is one.
    A section goes on after a return, so that nothing is lost: the list of pairs grows when it is half full, that of
    overloaded pairs when it could not take all pairs of another sub-step. Or returns TOO_MANY, STRANGE.
    """
    dt, state, sheet, pairs = steps.dt, bodies.state, bodies.blocks, meeting.pairs.list[0]
    impulses, work = sums.impulses, sums.work
    has_sheet = sheet < bodies.address.shape[0]
    water_work, impulse, step_work = work.water[0], work.impulse[0], work.step[0]
    old, kicked = np.empty_like(state), np.empty(state.shape[0], VELOCITY)
    read_bodies(bodies)
    for k in range(n):
        apply_water(hulls, bodies, water, water_work, impulse)
        if has_sheet:
            fx, fz = spring_force(driver[0], dt, state[sheet])
            set_force(bodies.address[sheet], bodies.layout, fx, fz, 0.0)
        pairs.count = 0
        old[:] = state
        kick(bodies, dt, kicked, step_work)
        step_space(steps.function, steps.space, dt)
        read_bodies(bodies)
        book_correction(old, bodies, dt, hulls, water.rho_g, step_work)
        middle_velocity(state, kicked)
        if pairs.count > pairs.room:
            return TOO_MANY
        if pairs.count > 0 and accumulate(meeting, bodies, impulses) > 0:
            return STRANGE
        contact_work(meeting.pairs, meeting.slots, kicked, sheet, work.loss, step_work)
        if 2 * pairs.count > pairs.room or impulses.overloads[0].pairs + pairs.room > impulses.overload.shape[0]:
            return k + 1
    return n
