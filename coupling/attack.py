"""Where the load acts on the structure: forces with their places, and their moments.

Of the sheet both are known node by node (`ContactForces`). A block's force is the sum over its contacts; it acts in the
mean of their places, each weighed with its pressure. Contacts that press in different directions also leave a couple,
which is left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coupling.interface import Array, BlockTable, ContactForces, IntArray, Phase


@dataclass(frozen=True, slots=True)
class PointForces:
    """Forces of the ice on the structure, means over a window; they add up to the load of every phase."""

    position: Array  #: (k, 3) where each acts, at the end of the window [m]
    force: Array  #: (k, 3) [N]
    phase: IntArray  #: (k,) `Phase`
    block: IntArray  #: (k,) number of the block, -1 for the sheet

    def moments(self, point: Array) -> Array:
        """Moments about a point (3,) [m]: (3, 3), rows by `Phase`, columns x, y, z [N m]."""
        (x, y, z), (fx, fy, fz) = (self.position - point).T, self.force.T
        turning = np.stack((y * fz - z * fy, z * fx - x * fz, x * fy - y * fx), axis=1)
        out = np.zeros((len(Phase), 3))
        np.add.at(out, self.phase, turning)
        return out


def point_forces(contact: ContactForces, blocks: BlockTable) -> PointForces:
    """All forces of a window that are not zero: those of the sheet by node, then those of the blocks."""
    touching = np.flatnonzero(contact.force.any(axis=1))
    pressing = np.flatnonzero(blocks.load.any(axis=1))
    of_sheet = np.where(contact.hinged[touching], Phase.ROTATING, Phase.BREAKING)
    return PointForces(
        np.concatenate((contact.position[touching], blocks.bearing[pressing])),
        np.concatenate((-contact.force[touching], blocks.load[pressing])),
        np.concatenate((of_sheet, blocks.phase[pressing])).astype(np.int64),
        np.concatenate((np.full(len(touching), -1), blocks.id[pressing])).astype(np.int64),
    )
