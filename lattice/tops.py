"""Water that a linear foundation does not know: tops that flood, and a bottom that has left the water.

The foundation gives -k_f w for a deflection w from floating (2.3.2). That is what still water does while the water line
stands between top and bottom, -freeboard <= w <= draft, and with a dry top also below: the ice displaces what its top
keeps out. But

* water comes over a top that is under water. As on blocks of rubble its node carries the part ``flooded`` of the head
  of water above it; the part grows with time while the top is under water, and a top that is out of it drains:

      F = -flooded k_f A (-freeboard - w)

  so a sheet that is flooded throughout is lifted by its own buoyancy less its weight, k_f A freeboard, however deep;
* where the bottom has left the water only the weight pulls down, k_f A draft: the foundation's pull beyond is given
  back,

      F = k_f A (w - draft)

Both are constant over a window, with the deflection that the velocity at its start leads to in its middle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lattice.grid import Array, BoolArray
from lattice.implicit.engine import Engine
from lattice.loads import NodeLoad
from lattice.state import State, StepError

ABOVE = "water_above"  #: name of the load of the water on flooded tops
BELOW = "water_left_below"  #: name of the load that gives back what the foundation pulls where the bottom is out
NAMES = (ABOVE, BELOW)


@dataclass
class Tops:
    """What the water does beyond the foundation. ``flooded`` is replaced in every window, never written to."""

    lift: Array  #: (nodes,) k_f A of each node [N/m]
    freeboard: float  #: depth to which the sheet is pressed when water comes over its top [m]
    draft: float  #: height to which it is lifted when its bottom leaves the water [m]
    filling_rate: float  #: part of the head on a wet top that comes per second; 0: tops stay dry, inf: at once [1/s]
    flooded: Array  #: (nodes,) part of the head that each top carries

    @classmethod
    def of(cls, engine: Engine, filling_rate: float) -> Tops:
        """Dry tops of an engine's sheet. ValueError if the rate is negative or no number."""
        if not filling_rate >= 0.0:
            raise ValueError(f"filling rate of the tops is {filling_rate:g} 1/s: use 0 (dry) or more")
        ice = engine.ice
        lift = np.ascontiguousarray(engine.k_f[::3])
        return cls(lift, ice.freeboard, ice.h - ice.freeboard, filling_rate, np.zeros(engine.grid.nodes))

    def loads(self, state: State, present: BoolArray, dt: float) -> list[NodeLoad]:
        """Forces in a window of ``dt`` [s] that begins in this state; none while the foundation tells all.

        Fills and drains the tops to the end of the window.
        """
        w = np.where(present, state.q[:, 0] + 0.5 * dt * state.q_dot[:, 0], 0.0)
        head, out = np.maximum(-self.freeboard - w, 0.0), np.maximum(w - self.draft, 0.0)
        wet = head > 0.0
        middle = np.minimum(self.flooded + 0.5 * dt * self.filling_rate, 1.0)
        if wet.any() or self.flooded.any():
            self.flooded = np.where(wet, np.minimum(self.flooded + dt * self.filling_rate, 1.0), 0.0)
        forces = ((ABOVE, -self.lift * middle * head), (BELOW, self.lift * out))
        return [_vertical(name, force) for name, force in forces if force.any()]

    def check_rest(self, w: Array) -> None:
        """StepError where a sheet at rest, by the foundation alone, lies at w (nodes,) [m] beyond what that tells."""
        low, high = float(w.min()), float(w.max())
        if low < -self.freeboard or high > self.draft:
            raise StepError(
                f"the sheet at rest lies {low:.2f} m to {high:.2f} m from afloat, "
                f"beyond its freeboard of {self.freeboard:.2f} m or its draft of {self.draft:.2f} m"
            )


def _vertical(name: str, force: Array) -> NodeLoad:
    """Vertical forces on nodes (n,) [N] as a load."""
    n = len(force)
    return NodeLoad(name, np.zeros((n, 2)), np.column_stack((force, np.zeros((n, 2)))))
