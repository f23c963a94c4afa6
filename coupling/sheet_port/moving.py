"""What a structure that moves gets from the sheet, and what it puts into it."""

from __future__ import annotations

import numpy as np

from coupling.contact import OverlapContact
from coupling.interface import Array, ContactForces, Path
from coupling.structure import moved


class OnMoving:
    """Load with its moment, window by window, and the work of the structure, by the way that the ice saw it go."""

    def __init__(self, contact: OverlapContact, path: Path) -> None:
        self._contact, self.path = contact, path
        self.wrench = np.zeros(6)  #: mean over the last window, about the waterline point at its end [N], [N m]
        self.work, self.rubbed = 0.0, 0.0  #: of the structure on the sheet so far, and the part by friction [J]

    def close(self, t: float, window: float, forces: ContactForces, at: Array) -> None:
        """A window of so many seconds ends at t under these forces; ``at`` (m, 3) displaces the edge's points now.

        Friction of nodes that have left in the window counts as pressure.
        """
        arm, velocity = forces.position - self.path.at(t)[:3], self.path.velocity
        self.wrench = moved.wrench(-forces.force, arm)
        self.work -= float(self.wrench @ velocity) * window
        m = len(self._contact.nodes)
        friction = self._contact.friction_in(at, forces.force[:m])
        self.rubbed += float(moved.wrench(friction, arm[:m]) @ velocity) * window
