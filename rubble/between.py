"""Between two windows: the blocks of a section move laterally, change phase and crush."""

from __future__ import annotations

import numpy as np

from rubble.arrays import Records, rows
from rubble.crushing import crush
from rubble.lateral import move_laterally, resistance_of
from rubble.lost import Lost
from rubble.section import Section


def after_window(section: Section, window: float, time: float, *, hold: bool) -> Lost:
    """Mean loads, lateral motion, phases and crushing of the blocks of a section; returns what was crushed.

    ``hold``: blocks keep their lateral place and speed. RuntimeError if a motion is not finite.
    """
    lost = Lost()
    if not section.blocks:
        return lost
    finite = np.isfinite(rows(section.state))
    if not finite.all():
        number = section.blocks[int(np.argmin(finite.all(axis=1)))].id
        raise RuntimeError(
            f"block {number} in the section at y = {section.y:g} m, t = {time:g} s: its motion "
            "is not finite; shorten rubble.substep"
        )
    tables, sums = section.tables, section.sums
    lateral: Records = tables.lateral.copy() if hold else tables.lateral
    move_laterally(
        resistance_of(section.physics, window),
        tables.outlines,
        tables.moved,
        section.state,
        sums.block,
        lateral,
        tables.load,
        sums.lateral,
    )
    section.update_phases()
    return crush(section, window) if len(sums.overloads) else lost
