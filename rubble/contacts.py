"""Sums of the contact impulses of a section over the sub-steps of a window.

They are formed in the order in which the solver goes through the contacts, see `arbiters`.
"""

from __future__ import annotations

import numpy as np

from rubble.arbiters import read_contact
from rubble.compiled import compiled
from rubble.friction import STRUCTURE_SLOT, UNKNOWN, shares, slot_of, tilt
from rubble.geometry import Array
from rubble.pointers import IntArray, integer, real, short

#: columns of the sums of a block over a window [N s]: impulse on the structure x, z; side impulse N n_y of the
#: structure on the block; mu N of the structure; mu N weighted with 1 / p; normal impulses on other ice; with the sheet
SUM_COLUMNS = 7
#: columns of an overloaded pair over a window: slots a and b, sub-steps, impulse along the normal, its x and z part on
#: b, length of the contact weighted with the impulse
HEAVY_COLUMNS = 7


@compiled("void(float64[::1], float64[::1], float64[::1], float64[::1], float64, float64)", nogil=True)
def _on_structure(v: Array, law: Array, state: Array, block: Array, y: float, v_y: float) -> None:
    """A block's contact with the structure, whose body stands at the origin: v[0], v[1] is the point in the section."""
    block[0] -= v[4]
    block[1] -= v[5]
    if v[6] == 0.0:
        return
    n_x, n_z, push = v[7] / v[6], v[8] / v[6], v[6]
    slip = n_x * (state[4] + state[5] * v[2]) - n_z * (state[3] - state[5] * v[3])
    p, n_y = tilt(v[0], n_x, law[2], law[1], y)
    mu, more, _ = shares(law, p, n_y, slip, v_y)
    block[2] += push * more * n_y
    block[3] += mu * push * more
    block[4] += mu * push * more / p


@compiled("void(float64[::1], float64[::1], float64[:, ::1])", nogil=True)
def _on_sheet(v: Array, sheet: Array, nodes: Array) -> None:
    """Share out a contact with the sheet to the two nodes next to it; force and moment are kept.

    Linear weights along x keep the moment of the vertical force. The horizontal force acts off the line of the nodes;
    its moment goes into a pair of vertical forces.
    """
    x, z, jx, jz = sheet[0] + v[0], sheet[1] + v[1], -v[4], -v[5]
    sheet[4] += v[4] * sheet[2] + v[5] * sheet[3]
    sheet[5] += jx
    sheet[6] += jz
    sheet[7] += x * jz - z * jx
    m = nodes.shape[0]
    if m == 1:
        nodes[0, 2] += jx
        nodes[0, 3] += jz
        return
    k = 0
    while k < m - 2 and x < nodes[k + 1, 0]:
        k += 1
    span = nodes[k, 0] - nodes[k + 1, 0]
    w = (x - nodes[k + 1, 0]) / span
    lever = w * nodes[k, 1] + (1.0 - w) * nodes[k + 1, 1] - z
    nodes[k, 2] += w * jx
    nodes[k, 3] += w * jz + jx * lever / span
    nodes[k + 1, 2] += (1.0 - w) * jx
    nodes[k + 1, 3] += (1.0 - w) * jz - jx * lever / span


@compiled("void(int64[::1], float64[::1], float64[::1], float64[::1], float64[:, ::1])", nogil=True)
def _note_heavy(pair: IntArray, first: Array, last: Array, limit: Array, heavy: Array) -> None:
    """Keep a pair whose normal impulse exceeds strength times contact length times width in a sub-step.

    ``limit`` = (strength times sub-step [Pa s], least length [m], least impulse that can be too much [N s], widths
    of the blocks...); row 0 of ``heavy`` counts.
    """
    jn, length = first[6], 0.0
    if first[2] != last[2] or first[3] != last[3]:
        jn += last[6]
        length = np.hypot(last[2] - first[2], last[3] - first[3])
    width = limit[3 + pair[1]] if pair[0] < 0 else min(limit[3 + pair[0]], limit[3 + pair[1]])
    if jn <= limit[0] * width * max(length, limit[1]):
        return
    k, count = 1, int(heavy[0, 0])
    while k <= count and (heavy[k, 0] != pair[0] or heavy[k, 1] != pair[1]):
        k += 1
    if k >= heavy.shape[0]:
        return
    if k > count:
        heavy[0, 0], heavy[k, :] = k, 0.0
        heavy[k, 0], heavy[k, 1] = pair[0], pair[1]
    both = length > 0.0
    heavy[k, 2] += 1.0
    heavy[k, 3] += jn
    heavy[k, 4] += first[7] + (last[7] if both else 0.0)
    heavy[k, 5] += first[8] + (last[8] if both else 0.0)
    heavy[k, 6] += jn * length


@compiled(
    "int64(int64[::1], int64[::1], int64[::1], int64[::1], int64[::1], float64[:, ::1], float64[::1], "
    "float64[:, ::1], float64[::1], float64[::1], float64[:, ::1], float64[:, ::1], float64[:, ::1])",
    nogil=True,
)
def accumulate(
    header: IntArray,
    pairs: IntArray,
    layout: IntArray,
    addresses: IntArray,
    slots: IntArray,
    state: Array,
    law: Array,
    side: Array,
    limit: Array,
    sheet: Array,
    sums: Array,
    nodes: Array,
    heavy: Array,
) -> int:
    """Add the contacts of one sub-step; ``addresses`` and ``slots`` (`friction.slot_table`) tell bodies apart.

    ``header``, ``pairs`` and ``layout`` are those of `arbiters.ContactReader`; ``sums`` (blocks, 7) see SUM_COLUMNS;
    ``nodes`` (m, 4): x, z of the nodes and the impulse on them; ``sheet`` = (x, z of the sheet body's origin, its
    v_x, v_z, work done by the sheet on blocks, impulse x, z on it, moment); ``side`` (2, blocks): y and v_y; ``law``
    of the structure; ``heavy`` see HEAVY_COLUMNS and `_note_heavy`. Returns the number of pairs with bodies that are
    neither block, sheet nor structure (must be 0).
    """
    pair, v, before_v = np.empty(2, np.int64), np.empty(9), np.empty(9)
    strange, crushes, n, size = 0, limit[0] < np.inf, header[0], layout[11]
    body_a, body_b, last, arbiter, turn = 0, 0, 0, 0, False
    for k in range(n):
        before, before_turn, before_arbiter = last, turn, arbiter
        arbiter = pairs[k]
        a, b = integer(arbiter + layout[0]), integer(arbiter + layout[1])
        if a != body_a or b != body_b:
            before = 0
        body_a, body_b = a, b
        a, b = slot_of(body_a, addresses, slots), slot_of(body_b, addresses, slots)
        if a == UNKNOWN or b == UNKNOWN:
            strange += 1
            continue
        turn = a > b  # smaller slot first: structure and sheet before blocks
        if turn:
            a, b = b, a
        start, count = integer(arbiter + layout[3]), short(arbiter + layout[2])
        for c in range(count):
            contact = start + c * size
            push = real(contact + layout[9])
            if a >= 0:
                sums[a, 5] += push
                sums[b, 5] += push
                continue
            read_contact(arbiter, contact, layout, turn, v)
            if a == STRUCTURE_SLOT:
                _on_structure(v, law, state[b], sums[b], side[0, b], side[1, b])
            else:
                _on_sheet(v, sheet, nodes)
                sums[b, 5] += push
                sums[b, 6] += push
        last = start + (count - 1) * size
        if not crushes:
            continue
        if count > 1:
            before, before_turn, before_arbiter = last - size, turn, arbiter
        push = real(last + layout[9]) + (real(before + layout[9]) if before != 0 else 0.0)
        if push <= limit[2]:
            continue
        if k + 1 < n and integer(pairs[k + 1] + layout[0]) == body_a and integer(pairs[k + 1] + layout[1]) == body_b:
            continue  # the same two bodies go on with other shapes
        pair[0], pair[1] = a, b
        read_contact(arbiter, last, layout, turn, v)
        if before != 0:
            read_contact(before_arbiter, before, layout, before_turn, before_v)
        _note_heavy(pair, before_v if before != 0 else v, v, limit, heavy)
    return strange
