"""The contract between the participants: what crosses, who owns it, in which units and signs.

This room holds all of it and nothing else: `sheet` and `rubble` (the participants and what each hands out), `exchange`
(forces between them, saved states), `structure`, `motion` and `load` (what a structure, its motion and a load have to
give), `frame` (what observers see), `units`.

Call order of one macro step (time window) of the serial-explicit scheme::

    report = sheet.advance(window, rubble_forces)   the sheet moves, meets the structure, breaks
    for fragment in report.fragments:               broken pieces have left the lattice ...
        rubble.add(fragment)                        ... and become blocks
    rubble.set_sheet(path, rubble_forces)           how the sheet's underside and edge move, and what they carry already
    rubble.advance(window)                          blocks move; impulses are summed
    rubble_forces = rubble.forces_on_sheet()        act on the sheet in the next window
    observers(frame)                                recorder, progress, load series: read only

Other schemes call the same in another order (`coupling.schemes`). An implicit one repeats a window: both participants
``save()`` at its start, and calling what they return sets them back, as often as needed (`Restore`).

A structure that moves goes through every window with them (`coupling.moving`): it gives its path before the others move
and is moved on by their mean load afterwards.

Frame: SI units, right-handed, fixed to where the structure rests. x = drift direction of the ice towards the structure,
y to the left, z up, z = 0 still water. The structure's axis is x = y = 0; the ice comes from -x.

Loads are forces of the ice on the structure: Fx > 0 in drift direction, Fz > 0 lifts the structure.

Time is an integer number of nanoseconds (``t_ns``), so that windows add up without rounding.

Ownership: a participant owns the arrays that it hands out unless a method says otherwise; who keeps one copies it.
"""

from coupling.interface.exchange import ForcePairs, Restore, SheetForces
from coupling.interface.frame import Frame
from coupling.interface.load import Load, SheetMotion
from coupling.interface.motion import FREEDOMS, Motion, Path
from coupling.interface.rubble import BlockTable, HandOver, RubbleParticipant
from coupling.interface.sheet import (
    Answer,
    ContactForces,
    Event,
    Fragment,
    SheetEdge,
    SheetParticipant,
    SheetReport,
    SheetView,
)
from coupling.interface.structure import Structure
from coupling.interface.units import NS, PHASES, Array, BoolArray, IntArray, Phase, SimulationError

__all__ = [
    "FREEDOMS",
    "NS",
    "PHASES",
    "Answer",
    "Array",
    "BlockTable",
    "BoolArray",
    "ContactForces",
    "Event",
    "ForcePairs",
    "Fragment",
    "Frame",
    "HandOver",
    "IntArray",
    "Load",
    "Motion",
    "Path",
    "Phase",
    "Restore",
    "RubbleParticipant",
    "SheetEdge",
    "SheetForces",
    "SheetMotion",
    "SheetParticipant",
    "SheetReport",
    "SheetView",
    "SimulationError",
    "Structure",
]
