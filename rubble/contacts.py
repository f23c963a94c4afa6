"""Sums of the contact impulses of a section over the sub-steps of a window.

They are formed in the order in which the solver goes through the contacts, see `arbiters`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arbiters import Contact, Pairs, read_contact
from rubble.arrays import Record, Records, record
from rubble.bodies import Bodies
from rubble.compiled import compiled
from rubble.cut import nearest
from rubble.friction import split, tilt
from rubble.overload import Strength, note_overload
from rubble.pointers import ArbiterLayout, integer, real, short
from rubble.slots import STRUCTURE_SLOT, UNKNOWN, Slots, slot_of

#: of a block over a window [N s]
ON_BLOCK = record(
    *("structure_x", "structure_z"),  # impulse on the structure
    *("lateral", "grip", "grip_slip"),  # of the structure on the block: N n_y; mu N; mu N weighted with 1 / p
    *("ice", "sheet"),  # normal impulses on other ice; with the sheet
    *("push", "push_at_x", "push_at_z"),  # normal impulse on the structure; weighted with x and z of the point [N s m]
)
#: of the sheet over a window: work done by it on blocks [J], impulse x, z on it [N s] and moment about the origin
ON_SHEET = record("work", "x", "z", "moment")
#: a node of the sheet: x, z [m], and the impulse on it over a window [N s]
NODE = record("x", "z", "impulse_x", "impulse_z")


class Meeting(NamedTuple):
    """What is needed to tell who meets whom, and with what friction."""

    pairs: Pairs
    slots: Slots
    law: Records  #: (1,) LAW of the structure
    faces: Records  #: `cut.Cut.bearings`
    lateral: Records  #: (n,) LATERAL of the blocks
    strength: Strength


class Impulses(NamedTuple):
    """Sums over a window."""

    block: Records  #: (n,) ON_BLOCK
    sheet: Records  #: (1,) ON_SHEET
    node: Records  #: (m,) NODE
    overload: Records  #: (room,) OVERLOAD
    overloads: Records  #: (1,) COUNT of them


@compiled(nogil=True)
def _on_structure(v: Contact, law: Record, faces: Records, state: Record, lateral: Record, block: Record) -> None:
    """A block's contact with the structure, whose body stands at the origin: (a_x, a_z) is the point in the section."""
    block.structure_x -= v.j_x
    block.structure_z -= v.j_z
    if v.push == 0.0:
        return
    n_x, n_z, push = v.push_x / v.push, v.push_z / v.push, v.push
    slip = n_x * (state.v_z + state.omega * v.b_x) - n_z * (state.v_x - state.omega * v.b_z)
    face = tilt(faces[nearest(faces, v.a_x, v.a_z)], v.a_x, n_x, law.y, lateral.y)
    found = split(law, face, slip, lateral.v_y)
    block.lateral += push * found.true * face.n_y
    block.grip += found.mu * push * found.true
    block.grip_slip += found.mu * push * found.true / face.p
    block.push += push
    block.push_at_x += push * v.a_x
    block.push_at_z += push * v.a_z


@compiled(nogil=True)
def _on_sheet(v: Contact, body: Record, sums: Record, nodes: Records) -> None:
    """Divide a contact with the sheet between the two nodes next to it; force and moment are kept.

    Linear weights along x keep the moment of the vertical force. The horizontal force acts off the line of the nodes;
    its moment goes into a pair of vertical forces.
    """
    x, z, jx, jz = body.x + v.a_x, body.z + v.a_z, -v.j_x, -v.j_z
    sums.work += v.j_x * body.v_x + v.j_z * body.v_z
    sums.x += jx
    sums.z += jz
    sums.moment += x * jz - z * jx
    m = nodes.shape[0]
    if m == 1:
        nodes[0].impulse_x += jx
        nodes[0].impulse_z += jz
        return
    k = 0
    while k < m - 2 and x < nodes[k + 1].x:
        k += 1
    front, rear = nodes[k], nodes[k + 1]
    span = front.x - rear.x
    w = (x - rear.x) / span
    lever = w * front.z + (1.0 - w) * rear.z - z
    front.impulse_x += w * jx
    front.impulse_z += w * jz + jx * lever / span
    rear.impulse_x += (1.0 - w) * jx
    rear.impulse_z += (1.0 - w) * jz - jx * lever / span


@compiled(nogil=True)
def accumulate(meeting: Meeting, bodies: Bodies, sums: Impulses) -> int:
    """Add the contacts of one sub-step; returns how many pairs have a body that nobody knows (must be 0)."""
    pairs, layout, slots, strength = meeting.pairs, meeting.pairs.layout, meeting.slots, meeting.strength
    address, slot, law, faces, lateral = slots.address, slots.slot, meeting.law[0], meeting.faces, meeting.lateral
    state, block, sheet, arbiters = bodies.state, sums.block, sums.sheet[0], pairs.arbiter
    strange, crushes, n, size = 0, strength.per_area < np.inf, pairs.list[0].count, layout.size
    body_a, body_b, last, arbiter, turn = 0, 0, 0, 0, False
    for k in range(n):
        before, before_turn, before_arbiter = last, turn, arbiter
        arbiter = arbiters[k]
        a, b = integer(arbiter + layout.body_a), integer(arbiter + layout.body_b)
        if a != body_a or b != body_b:
            before = 0
        body_a, body_b = a, b
        a, b = slot_of(body_a, address, slot), slot_of(body_b, address, slot)
        if a == UNKNOWN or b == UNKNOWN:
            strange += 1
            continue
        turn = a > b  # smaller slot first: structure and sheet before blocks
        if turn:
            a, b = b, a
        start, count = integer(arbiter + layout.contacts), short(arbiter + layout.points)
        for c in range(count):
            contact = start + c * size
            push = real(contact + layout.jn)
            if a >= 0:
                block[a].ice += push
                block[b].ice += push
                continue
            v = read_contact(arbiter, contact, layout, turn)
            if a == STRUCTURE_SLOT:
                _on_structure(v, law, faces, state[b], lateral[b], block[b])
            else:
                _on_sheet(v, state[bodies.blocks], sheet, sums.node)
                block[b].ice += push
                block[b].sheet += push
        last = start + (count - 1) * size
        if not crushes:
            continue
        if count > 1:
            before, before_turn, before_arbiter = last - size, turn, arbiter
        push = real(last + layout.jn) + (real(before + layout.jn) if before != 0 else 0.0)
        if push <= strength.least:
            continue
        if k + 1 < n and _same_bodies(arbiters[k + 1], layout, body_a, body_b):
            continue  # the same two bodies go on with other shapes
        end = read_contact(arbiter, last, layout, turn)
        first = read_contact(before_arbiter, before, layout, before_turn) if before != 0 else end
        note_overload(a, b, first, end, strength, sums.overload, sums.overloads)
    return strange


@compiled(nogil=True, inline="always")
def _same_bodies(arbiter: int, layout: ArbiterLayout, body_a: int, body_b: int) -> bool:
    same: bool = integer(arbiter + layout.body_a) == body_a and integer(arbiter + layout.body_b) == body_b
    return same
