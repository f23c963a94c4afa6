"""What observers see of a window."""

from __future__ import annotations

from dataclasses import dataclass, field

from coupling.interface.rubble import BlockTable
from coupling.interface.sheet import ContactForces, Event, SheetView
from coupling.interface.units import Array


@dataclass(frozen=True, slots=True)
class Frame:
    """One macro step as observers see it. ``t_ns`` is the end of the window; loads are means over it."""

    t_ns: int
    sheet: SheetView
    blocks: BlockTable
    load: Array  #: (3, 3) force on the structure, rows by `Phase`, columns x, y, z [N]
    events: tuple[Event, ...] = ()
    ledger: dict[str, float] = field(default_factory=dict)  #: named balances of `coupling.ledger` [SI]
    budget: dict[str, float] = field(default_factory=dict)  #: what carries the load, see `coupling.budget` [N]
    contact: ContactForces = field(default_factory=ContactForces.none)  #: load of the sheet, node by node
    #: (2, 6) displacement and velocity of the structure, see `coupling.interface.motion`; None: it rests
    motion: Array | None = None
