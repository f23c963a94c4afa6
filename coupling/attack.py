"""Where the load acts on the structure: forces with their places, and their moments.

Of the sheet both are known node by node (`ContactForces`). A block's force is the sum over its contacts, which the
rubble does not hand out; it acts where the block bears on the face: at the mean of the corners that are nearest to it,
weighed linearly from the nearest one to `NEAR` of the block's size farther off. A block that lies flat acts in the
middle of its side, one that stands on a corner acts there. In between the true place is on the same side, so the
place is wrong by half a side at most. A block that no front of the structure faces acts at its centre of mass. Near is
meant in the section of the block, whose cut of the structure it meets; its place across is its own.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from coupling.interface import Array, BlockTable, ContactForces, IntArray, Phase, Structure

NEAR = 0.02  #: of the largest distance of a block's corners: how much farther from the face a corner may be to bear


@dataclass(frozen=True, slots=True)
class PointForces:
    """Forces of the ice on the structure, means over a window; they add up to the load of every phase."""

    position: Array  #: (k, 3) where each acts, at the end of the window [m]
    force: Array  #: (k, 3) [N]
    phase: IntArray  #: (k,) `Phase`
    block: IntArray  #: (k,) number of the block, -1 for the sheet

    def moments(self, point: Array) -> Array:
        """Moments about a point (3,) [m]: (3, 3), rows by `Phase`, columns x, y, z [N m]."""
        arms = np.cross(self.position - point, self.force)
        out = np.zeros((len(Phase), 3))
        np.add.at(out, self.phase, arms)
        return out


@dataclass(frozen=True)
class Attack:
    """A structure, and the sections in which blocks meet it: section k is cut at y = origin + k pitch."""

    structure: Structure
    origin: float  #: [m]
    pitch: float  #: [m]
    _last: list[tuple[ContactForces, BlockTable, PointForces]] = field(default_factory=list, compare=False, repr=False)

    def points(self, contact: ContactForces, blocks: BlockTable) -> PointForces:
        """All forces of a window that are not zero: those of the sheet by node, then those of the blocks.

        Those of the last window are kept: several ask for them.
        """
        if not self._last or self._last[0][0] is not contact or self._last[0][1] is not blocks:
            self._last[:] = [(contact, blocks, self._points(contact, blocks))]
        return self._last[0][2]

    def _points(self, contact: ContactForces, blocks: BlockTable) -> PointForces:
        touching = np.flatnonzero(contact.force.any(axis=1))
        pressing = np.flatnonzero(blocks.load.any(axis=1))
        of_sheet = np.where(contact.hinged[touching], Phase.ROTATING, Phase.BREAKING)
        return PointForces(
            np.concatenate((contact.position[touching], self.bearing(blocks, pressing))),
            np.concatenate((-contact.force[touching], blocks.load[pressing])),
            np.concatenate((of_sheet, blocks.phase[pressing])).astype(np.int64),
            np.concatenate((np.full(len(touching), -1), blocks.id[pressing])).astype(np.int64),
        )

    def bearing(self, blocks: BlockTable, which: IntArray) -> Array:
        """Where blocks bear on the structure, (len(which), 3) [m]; see above."""
        out = blocks.position[which].copy()
        if not len(which):
            return out
        count = np.diff(blocks.offset)[which]
        owner = np.repeat(np.arange(len(which)), count)
        first = np.cumsum(count) - count
        corner = blocks.outline[np.arange(len(owner)) - first[owner] + blocks.offset[which][owner]]
        y, z = (self.origin + self.pitch * blocks.section[which])[owner], corner[:, 1]
        normal = self.structure.normal(y, z)
        gap = (self.structure.face_x(y, z) - corner[:, 0]) * -normal[:, 0] / np.hypot(normal[:, 0], normal[:, 2])
        gap = np.where(np.isfinite(gap), gap, np.inf)
        least = np.minimum.reduceat(gap, first)
        span = np.maximum.reduceat(corner, first) - np.minimum.reduceat(corner, first)
        near = NEAR * np.hypot(span[:, 0], span[:, 1])
        faced = np.isfinite(least)
        on = faced[owner]
        weight = np.zeros(len(owner))
        weight[on] = np.maximum(1.0 - (gap[on] - least[owner][on]) / near[owner][on], 0.0)
        total = np.add.reduceat(weight, first)
        for k, axis in ((0, 0), (1, 2)):
            mean = np.add.reduceat(weight * corner[:, k], first) / np.where(faced, total, 1.0)
            out[faced, axis] = mean[faced]
        return out
