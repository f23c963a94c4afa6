"""Pairs that are pressed harder than their contact can carry, noted for `crushing`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arbiters import Contact
from rubble.arrays import Array, Records, record
from rubble.compiled import compiled

#: an overloaded pair over a window: impulse along the normal [N s], its x and z part on b, length of the contact
#: weighted with the impulse [m N s]; slots a and b, sub-steps
OVERLOAD = record("push", "push_x", "push_z", "length", integers=("a", "b", "substeps"))
#: how many overloaded pairs a window has
COUNT = record(integers=("pairs",))


class Strength(NamedTuple):
    """What a contact of ice carries in a sub-step."""

    per_area: float  #: strength times sub-step [Pa s]; infinite: nothing crushes
    length: float  #: least length of a contact [m]
    least: float  #: least impulse that can be too much for any block of the section [N s]
    width: Array  #: (n,) of the blocks along y [m]


@compiled(nogil=True)
def note_overload(
    a: int, b: int, first: Contact, last: Contact, strength: Strength, overloads: Records, count: Records
) -> None:
    """Keep the pair of slots a <= b if its normal impulse exceeds strength times contact length times width.

    ``first`` and ``last`` are its outer contact points, the same twice if it has only one. The caller has made room.
    """
    push, length = first.push, 0.0
    if first.b_x != last.b_x or first.b_z != last.b_z:
        push += last.push
        length = np.hypot(last.b_x - first.b_x, last.b_z - first.b_z)
    width = strength.width[b] if a < 0 else min(strength.width[a], strength.width[b])
    if push <= strength.per_area * width * max(length, strength.length):
        return
    k, known = 0, count[0].pairs
    while k < known and (overloads[k].a != a or overloads[k].b != b):
        k += 1
    row = overloads[k]
    if k == known:
        count[0].pairs = known + 1
        row.a, row.b, row.substeps = a, b, 0
        row.push, row.push_x, row.push_z, row.length = 0.0, 0.0, 0.0, 0.0
    both = length > 0.0
    row.substeps += 1
    row.push += push
    row.push_x += first.push_x + (last.push_x if both else 0.0)
    row.push_z += first.push_z + (last.push_z if both else 0.0)
    row.length += push * length
