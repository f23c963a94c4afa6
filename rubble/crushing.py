"""Crushing: no contact carries more than the ice's strength times its area.

The solver's contacts are rigid and have two points at most. A pair whose mean normal force over a window needs more
area than it has loses ice from its sharper block: the block is cut back square to the force until the section is wide
enough for it, ``chord(depth) w = F / strength``. It recedes no faster than the excess force (over strength times the
area that is there) moves the block in a window: a gap opened at once would let it run up. Contacts that lack less
than the solver's own tolerance (slop) are left. What is cut off has left the block with its momentum; nothing of the
force is capped.
"""

from __future__ import annotations

import numpy as np

from rubble.block import Block, cut_block
from rubble.geometry import Array, clip
from rubble.section import Section


def crush(section: Section, window: float) -> tuple[float, Array]:
    """Cut the overloaded blocks of a section after a window [s]; returns crushed mass [kg] and its momentum (3,)."""
    physics, mass, momentum = section.physics, 0.0, np.zeros(3)
    for row in section.heavy[1:1 + int(section.heavy[0, 0])]:
        needed = float(row[3]) / window / physics.contact_strength  # contact area [m2]
        ends = [(section.blocks[int(row[k])], np.hypot(row[4], row[5]) and sign * row[4:6] / np.hypot(row[4], row[5]))
                for k, sign in ((0, 1.0), (1, -1.0)) if row[k] >= 0]
        lacking, depth, block, normal = max(((*depth_for(b, n, needed, float(row[3]), window), b, n) for b, n in ends),
                                            key=lambda found: found[0])
        if lacking > physics.slop:
            before = np.array([block.body.velocity.x, block.v_y, block.body.velocity.y])
            lost = _cut(block, normal, depth)
            mass, momentum = mass + lost, momentum + lost * before
    if mass > 0.0:
        section.changed()
    return mass, momentum


def depth_for(block: Block, normal: Array, needed: float, impulse: float, window: float) -> tuple[float, float]:
    """How far a block must be cut back along the outward ``normal`` (2,) for a contact of ``needed`` area, and how far
    it recedes in this window [m]; the first is infinite if no section of the block is wide enough."""
    polygon, c, s = block.prism.polygon, np.cos(block.body.angle), np.sin(block.body.angle)
    own = np.array([c * normal[0] + s * normal[1], -s * normal[0] + c * normal[1]])
    reach = np.sort(polygon @ own)[::-1]
    chord = needed / block.prism.width
    there = min(_chord(polygon, own, float(reach[0])) / chord, 1.0)
    pace = float(0.5 * impulse * (1.0 - there) / block.body.mass * window)
    for far, near in zip(reach[1:], reach[:-1], strict=True):  # the chord is linear between corners
        wide, narrow = _chord(polygon, own, far), _chord(polygon, own, near)
        if max(wide, narrow) >= chord and near - far > 0.0:
            share = 0.0 if narrow >= chord else (chord - narrow) / (wide - narrow)
            lacking = float(reach[0] - near + share * (near - far))
            return lacking, min(lacking, pace)
        if wide < narrow:
            break  # past the widest place
    return float("inf"), pace


def _chord(polygon: Array, n: Array, at: float) -> float:
    """Length of the polygon's cut by the line ``n . x = at``."""
    eps = 1e-9 * float(np.abs(polygon).max())
    rest = clip(polygon, -n[0], -n[1], -(at - eps))
    on = rest[np.abs(rest @ n - (at - eps)) < 2 * eps] if len(rest) else rest
    return float(np.ptp(on @ np.array([-n[1], n[0]]))) if len(on) > 1 else 0.0


def _cut(block: Block, normal: Array, depth: float) -> float:
    c, s = np.cos(block.body.angle), np.sin(block.body.angle)
    nx, nz = c * normal[0] + s * normal[1], -s * normal[0] + c * normal[1]
    reach = float((block.prism.polygon @ np.array([nx, nz])).max())
    return cut_block(block, float(nx), float(nz), reach - depth)
