"""How a run begins: rubble of earlier ice lies under the floe, and both are at rest.

The rubble settles at the sheet, the sheet bends under it, the rubble settles at the bent sheet, until the force between
them has found its value. The floe then just touches the structure.
"""

from __future__ import annotations

from math import inf

from coupling.interface import SheetForces, SimulationError
from coupling.rubble_port import RubblePort
from coupling.rubble_port.initial import Initial, all_sections, fill, rest_again, sections_of
from coupling.sheet_port import SheetPort

CHANGE = 0.01  #: of the lift on the sheet between two rounds, relative
ROUNDS = 20


def lay_rubble(sheet: SheetPort, rubble: RubblePort, asked: Initial) -> None:
    """Settles rubble, with the sheet in equilibrium with it."""
    sections = sections_of(rubble, asked, sheet.edges(dict.fromkeys(all_sections(rubble), -inf)))
    pile = fill(rubble, asked, sheet.edges(dict.fromkeys(sections, -inf)))
    lift = _lift(rubble.forces_on_sheet())
    for _ in range(ROUNDS):
        sheet.rest_under(rubble.forces_on_sheet())
        rest_again(rubble, sheet.edges(dict.fromkeys(sections, rubble.layer.rear)))
        before, lift = lift, _lift(rubble.forces_on_sheet())
        if abs(lift - before) <= CHANGE * pile.force:
            sheet.rest_under(rubble.forces_on_sheet())
            return
    raise SimulationError(
        f"initial rubble and sheet found no rest in {ROUNDS} rounds: the force on the sheet still "
        f"changes from {before:.3g} to {lift:.3g} N; give less rubble (rubble.initial_volume)"
    )


def _lift(forces: SheetForces) -> float:
    return float(forces.force[:, 2].sum())
