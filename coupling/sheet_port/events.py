"""What a window of the sheet tells: cells fail, the floe splits, pieces break off, ice leaves the water."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coupling.interface import Array, Event, Fragment


@dataclass(frozen=True)
class Failed:
    """Cells that failed in a window: how many, and by which criteria."""

    cells: int
    cause: str = ""  #: see `coupling.interface.Event`


NONE = Failed(0)


def event(
    t_ns: int, kind: str, load: Array, failed: Failed, where: Array, text: str, size: tuple[float, float] = (0.0, 0.0)
) -> Event:
    """An event at ``where`` (3,) [m] under a load (3,) [N], about a piece of this length [m] and area [m2]."""
    force = (float(load[0]), float(load[1]), float(load[2]))
    place = (float(where[0]), float(where[1]), float(where[2]))
    return Event(t_ns, kind, force, failed.cells, place, text, *size, failed.cause)


def told(value: float) -> str:
    """A number for people, with three digits at any scale of the case."""
    return f"{float(f'{value:.3g}'):.12g}"


def failures(t_ns: int, load: Array, failed: Failed, where: Array, parts: int | None, quiet: bool) -> list[Event]:
    """Cells have failed about ``where``, after a quiet window or not; ``parts`` if there are more of them now."""
    events = []
    if quiet:
        text = "1 cell fails" if failed.cells == 1 else f"{failed.cells} cells fail"
        events.append(event(t_ns, "cell_failure", load, failed, where, text))
    if parts is not None:
        events.append(event(t_ns, "split", load, failed, where, f"the floe splits, {parts} parts stay in the lattice"))
    return events


def crack(t_ns: int, load: Array, where: Array, length: float) -> Event:
    """Cracks of this length [m] in all have passed the middle of the ice."""
    text = f"cracks of {told(length)} m have passed the middle of the ice: they are hinges under thrust"
    return event(t_ns, "crack", load, NONE, where, text, (length, 0.0))


def hinge(t_ns: int, load: Array, where: Array, area: float) -> Event:
    """Pieces of this area [m2] in all are surrounded by cracks."""
    text = f"{told(area)} m2 are surrounded by cracks and held by what presses them"
    return event(t_ns, "hinge", load, NONE, where, text, (0.0, area))


def hinged_apart(t_ns: int, load: Array, where: Array, parts: int) -> Event:
    """The floe has fallen into parts that closed cracks still join."""
    return event(t_ns, "split", load, NONE, where, f"the floe splits, {parts} parts are hinged to each other")


def departure(t_ns: int, load: Array, failed: Failed, f: Fragment, at_structure: bool) -> list[Event]:
    """A piece leaves the lattice, in front of the structure or elsewhere, after cells have failed."""
    where = np.average(f.position, axis=0, weights=f.length * f.width)
    length = max(float(f.length[f.column == c].sum()) for c in np.unique(f.column))
    area = float((f.length * f.width).sum())
    text = f"a piece of {told(area)} m2, {told(f.mass.sum())} kg"
    events = []
    if at_structure:
        what = f"{text}, breaks off in front of the structure ({told(length)} m along the drift)"
        events.append(event(t_ns, "circumferential", load, failed, where, what, (length, area)))
    return [*events, event(t_ns, "hand_over", load, failed, where, f"{text}, becomes rubble", (length, area))]


def lifted_out(t_ns: int, load: Array, where: Array, lift: float, draft: float, linear: bool) -> Event:
    """Where the lattice's foundation ends.

    It pulls lifted ice down with rho_w g w, the missing buoyancy. That is right until the underside leaves the water at
    w = draft; beyond, it pulls too much if it is ``linear`` without end.
    """
    pull = (
        "the linear foundation pulls it down with more than its weight" if linear else "only its weight pulls it down"
    )
    text = f"the sheet is lifted by {told(lift)} m, more than its draft of {told(draft)} m: from here on {pull}"
    return event(t_ns, "out_of_water", load, NONE, where, text)
