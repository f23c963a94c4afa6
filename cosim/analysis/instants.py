"""Moments of a recorded run that features count from: first contact, events, encounters.

An *encounter* is one build-up and break of the sheet: from the first touch, or from the end of the encounter before,
to the drop of the load after the sheet has broken off. Several pieces that break off in one drop are one encounter, and
so are those that follow before the load has built up again. What builds up to less than half of the first encounter's
load and breaks, a splinter or a corner, belongs to the level between encounters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.analysis.run_data import RunData
from coupling.interface import NS, Array, BoolArray, Event, IntArray

Kinds = str | Sequence[str]
DROP = 0.5  #: share of an encounter's largest load below which the load has dropped, and from which it builds up
LEAST = 0.5  #: share of the first encounter's largest load that a later one reaches


@dataclass(frozen=True)
class Encounter:
    """Windows of one encounter: first, the one of the event, and the last, all included."""

    begin: int
    event: int
    end: int


def largest(load: Array) -> int:
    """Place of the load that is largest in magnitude: an upward-breaking structure is pressed down, Fz < 0."""
    return int(np.abs(load).argmax())


def evenly(t_ns: IntArray, load: Array) -> tuple[IntArray, Array]:
    """Times at even distances, the shortest that occurs [ns], and the load there."""
    even = np.arange(t_ns[0], t_ns[-1] + 1, np.diff(t_ns).min())
    return even, np.interp(even, t_ns, load)


def within(run: RunData, begin: float, end: float | None) -> BoolArray:
    """(n,) whether a window ends within ``begin`` to ``end``, both from first contact [s]; no window without one."""
    start = first_contact(run)
    if start is None:
        return np.zeros(len(run.t_ns), bool)
    t = run.t - start
    return np.asarray((t > begin) & (t <= (np.inf if end is None else end) + 1e-9))


def peaks_in(t_ns: IntArray, load: Array, prominence: float, smooth: float) -> tuple[IntArray, Array, float]:
    """Places of the peaks of a load (n,), the load at even distances [N], and that distance [s].

    A peak stands out by ``prominence`` of the largest load, after a running mean over ``smooth`` [s].
    """
    from scipy.ndimage import uniform_filter1d  # these take a second to load, and most commands do not need them
    from scipy.signal import find_peaks

    if len(load) < 3 or not load.max() > 0:
        return np.zeros(0, np.int64), np.zeros(0), 0.0
    even_ns, even = evenly(t_ns, load)
    step = int(even_ns[1] - even_ns[0])
    even = uniform_filter1d(even, max(1, round(smooth * NS / step)), mode="nearest")
    return find_peaks(even, prominence=prominence * load.max())[0], even, step / NS


def events_of(run: RunData, event: Kinds) -> list[Event]:
    """All events of one of these kinds, in order."""
    kinds = (event,) if isinstance(event, str) else tuple(event)
    return [e for e in run.events if e.kind in kinds]


def first_event(run: RunData, event: Kinds) -> Event | None:
    """The first event of one of these kinds."""
    return next(iter(events_of(run, event)), None)


def first_contact(run: RunData) -> float | None:
    """Time at which the structure is loaded first [s]: the start of the first window with a load."""
    loaded = np.flatnonzero(run.component("f") > 0)
    if not len(loaded):
        return None
    return float(run.begin_ns[loaded[0]]) / NS


def between(run: RunData, after: Kinds | None, before: Kinds | None) -> tuple[int | None, int]:
    """Times of the first events ``after`` and ``before`` [ns]; without them the run's start and end.

    None: there is no such event ``after``.
    """
    first = first_event(run, after) if after else None
    last = first_event(run, before) if before else None
    begin = (first.t_ns if first else None) if after else 0
    return begin, last.t_ns if last else int(run.t_ns[-1]) if len(run.t_ns) else 0


def encounters(run: RunData, event: Kinds = "circumferential", component: str = "f") -> list[Encounter]:
    """All encounters of a run, in order.

    The drop ends in the first window below `DROP` of the largest load until the event, or, if the load stays higher,
    in the lowest one before the next event.
    """
    load, begin = run.component(component), 0
    found: list[Encounter] = []
    start = first_contact(run)
    if start is not None:
        begin = int(np.searchsorted(run.t_ns, round(start * NS), side="right"))
    at = sorted({int(np.searchsorted(run.t_ns, e.t_ns)) for e in events_of(run, event)} - {len(load)})
    for k, now in enumerate(at):
        if found and (now <= found[-1].end or not _built_up(load[begin : now + 1])):
            found[-1] = replace(found[-1], end=max(found[-1].end, now))  # it goes on breaking
            begin = found[-1].end + 1
            continue
        if found and load[begin : now + 1].max() < LEAST * load[found[0].begin : found[0].end + 1].max():
            continue
        until = at[k + 1] if k + 1 < len(at) else len(load)
        low = np.flatnonzero(load[now:] < DROP * load[begin : now + 1].max())
        end = now + (int(low[0]) if len(low) else int(load[now:until].argmin()))
        found.append(Encounter(begin, now, end))
        begin = end + 1
    return found


def _built_up(load: Array) -> bool:
    """Whether a load has risen to its largest value from less than `DROP` of it."""
    top = int(load.argmax())
    return bool(load[: top + 1].min() < DROP * load[top])
