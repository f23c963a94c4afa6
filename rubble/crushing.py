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
from rubble.compiled import compiled
from rubble.geometry import Array
from rubble.section import Section
from rubble.stock import energy_of


def crush(section: Section, window: float) -> tuple[float, Array, float]:
    """Cut the overloaded blocks of a section after a window [s]; returns crushed mass [kg], its momentum (3,) and its
    energy [J].
    """
    physics, mass, momentum, energy = section.physics, 0.0, np.zeros(3), 0.0
    for row in section.heavy[1 : 1 + int(section.heavy[0, 0])]:
        needed = float(row[3]) / window / physics.contact_strength  # contact area [m2]
        along = float(np.hypot(row[4], row[5]))
        if along == 0.0:
            continue  # pressed from opposite sides alike: no side to cut back
        ends = [
            (section.blocks[int(row[k])], sign * row[4:6] / along) for k, sign in ((0, 1.0), (1, -1.0)) if row[k] >= 0
        ]
        lacking, depth, block, normal = max(
            ((*depth_for(b, n, needed, float(row[3]), window), b, n) for b, n in ends), key=lambda found: found[0]
        )
        if lacking > physics.slop:
            before = np.array([block.body.velocity.x, block.v_y, block.body.velocity.y])
            had = sum(energy_of(block, physics))
            lost = _cut(block, normal, depth)
            mass, momentum = mass + lost, momentum + lost * before
            energy += had - sum(energy_of(block, physics))
    if mass > 0.0:
        section.changed()
    return mass, momentum, energy


@compiled("float64(float64[:, ::1], float64, float64, float64)", nogil=True)
def _chord(polygon: Array, nx: float, nz: float, at: float) -> float:
    """Length of a convex polygon's cut by the line ``n . x = at``; along an edge its length."""
    low, high, k = np.inf, -np.inf, polygon.shape[0]
    eps = 1e-9 * (abs(at) + 1.0)
    for i in range(k):
        j = i + 1 if i + 1 < k else 0
        di = polygon[i, 0] * nx + polygon[i, 1] * nz - at
        dj = polygon[j, 0] * nx + polygon[j, 1] * nz - at
        ti, tj = polygon[i, 1] * nx - polygon[i, 0] * nz, polygon[j, 1] * nx - polygon[j, 0] * nz
        if abs(di) <= eps:
            low, high = min(low, ti), max(high, ti)
        elif abs(dj) > eps and di * dj < 0.0:
            t = ti + di / (di - dj) * (tj - ti)
            low, high = min(low, t), max(high, t)
    return max(high - low, 0.0)


def depth_for(block: Block, normal: Array, needed: float, impulse: float, window: float) -> tuple[float, float]:
    """How far a block must be cut back along the outward ``normal`` (2,) for a contact of ``needed`` area, and how far
    it recedes in this window [m]; the first is infinite if no section of the block is wide enough.
    """
    c, s = np.cos(block.body.angle), np.sin(block.body.angle)
    nx, nz = float(c * normal[0] + s * normal[1]), float(-s * normal[0] + c * normal[1])
    chord = needed / block.prism.width
    lacking, there = _cut_depth(block.prism.polygon, nx, nz, chord)
    pace = 0.5 * impulse * (1.0 - min(there / chord, 1.0)) / block.body.mass * window
    return lacking, min(lacking, float(pace))


@compiled("UniTuple(float64, 2)(float64[:, ::1], float64, float64, float64)", nogil=True)
def _cut_depth(polygon: Array, nx: float, nz: float, chord: float) -> tuple[float, float]:
    """Depth below the farthest corner along n at which a convex polygon is ``chord`` wide (inf: nowhere), and its width
    at that corner.
    """
    reach = np.sort(polygon[:, 0] * nx + polygon[:, 1] * nz)[::-1]
    there = _chord(polygon, nx, nz, reach[0])
    near, narrow = reach[0], there
    for far in reach[1:]:
        if narrow >= chord:
            break
        wide = _chord(polygon, nx, nz, far)
        if wide < narrow:
            return np.inf, there  # past the widest place
        if wide >= chord:  # the chord is linear between corners
            return reach[0] - near + (chord - narrow) / (wide - narrow) * (near - far), there
        near, narrow = far, wide
    return (reach[0] - near if narrow >= chord else np.inf), there


def _cut(block: Block, normal: Array, depth: float) -> float:
    c, s = np.cos(block.body.angle), np.sin(block.body.angle)
    nx, nz = c * normal[0] + s * normal[1], -s * normal[0] + c * normal[1]
    reach = float((block.prism.polygon @ np.array([nx, nz])).max())
    return cut_block(block, float(nx), float(nz), reach - depth)
