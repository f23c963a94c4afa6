"""What a load has to give: forces on the sheet beside those of structure, rubble, still water and supports.

A load acts on the sheet's nodes under its name: the energy balance and the force budget have a term for it. On blocks
the water acts; a load that is water in motion also gives its velocity to the rubble (`rubble.physics.RubblePhysics`),
whose water then drags by the motion of a block through it.

A sheet under a load is solved window by window: no long step is taken ahead.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

from coupling.interface.units import Array, BoolArray


class SheetMotion(NamedTuple):
    """The sheet at the start of a window, all nodes, in the fixed frame. Not to be written to."""

    position: Array  #: (n, 3) middle of the thickness [m]
    velocity: Array  #: (n, 3) [m/s]
    area: Array  #: (n,) of each node's ice [m2]
    present: BoolArray  #: (n,) node is still part of the lattice; forces on others act on nothing


class Load(Protocol):
    """A force on the sheet."""

    @property
    def name(self) -> str:
        """Under which it is booked; no other load has it."""
        ...

    def on_sheet(self, t: float, sheet: SheetMotion) -> Array:
        """Forces on the nodes from time t over the coming window, (n, 3) [N]; a new array.

        A repeated window asks again, with the same arguments: the answer follows from them alone.
        """
        ...
