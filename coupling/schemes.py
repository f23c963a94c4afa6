"""Coupling schemes by name: who sees whose newest data."""

from __future__ import annotations

from collections.abc import Callable

from coupling.scheduler import Report, Scheduler


def serial_explicit(s: Scheduler) -> Report:
    """First the sheet under the rubble's forces of the last window, then the rubble against the sheet as it is now.

    Blocks are born with the state that their ice had at the start of the window and are moved through it by the
    rubble, so no time is lost or counted twice.
    """
    report = s.sheet.advance(s.t_ns, s.window_ns, s.rubble.forces_on_sheet(), s.rubble_load())
    for fragment in report.fragments:
        s.hand_over(fragment)
    s.rubble.set_sheet(s.sheet.edges(s.rubble.sections_in_use()))
    s.rubble.advance(s.window_ns)
    return report


SCHEMES: dict[str, Callable[[Scheduler], Report]] = {"serial-explicit": serial_explicit}
