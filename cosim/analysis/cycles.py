"""Features of loading cycles, as plain functions like those of `features`; ``n`` counts encounters from 1.

A campaign compares them from run to run: loads of an encounter, mean and period of the cycles, size of the pieces, ice
fed into the rubble and cleared from it.
"""

from __future__ import annotations

import numpy as np

from cosim.analysis.instants import Kinds, between, encounters, events_of, first_contact, largest, peaks_in, within
from cosim.analysis.run_data import RunData
from cosim.analysis.volumes import since
from coupling.interface import NS, Array


def largest_load(
    run: RunData, component: str = "fx", phase: str | None = None, begin: float = 0.0, end: float | None = None
) -> float | None:
    """Largest load of the windows that end within ``begin`` to ``end``, both from first contact [s] [N]."""
    chosen = within(run, begin, end)
    return _largest(run.component(component, phase)[chosen]) if chosen.any() else None


def encounter_load(
    run: RunData, n: int = 1, event: Kinds = "circumferential", component: str = "fx", phase: str | None = None
) -> float | None:
    """Largest load of the n-th encounter, from first touch or last drop to the drop after its event [N]."""
    found = encounters(run, event)
    if not 1 <= n <= len(found):
        return None
    return _largest(run.component(component, phase)[found[n - 1].begin : found[n - 1].end + 1])


def _largest(load: Array) -> float:
    """The load that is `largest`, with its sign."""
    return float(load[largest(load)])


def encounter_time(run: RunData, n: int = 1, event: Kinds = "circumferential") -> float | None:
    """Time from the beginning of the n-th encounter to its event [s]."""
    found = encounters(run, event)
    if not 1 <= n <= len(found):
        return None
    return float(run.t_ns[found[n - 1].event] - run.begin_ns[found[n - 1].begin]) / NS


def mean_load(
    run: RunData,
    component: str = "fx",
    phase: str | None = None,
    after: Kinds | None = None,
    before: Kinds | None = None,
) -> float | None:
    """Mean from first contact, or the first event ``after``, to the end or the first event ``before`` [N]."""
    begin, end = between(run, after, before)
    start = first_contact(run)
    if begin is None or start is None:
        return None
    chosen = (run.t_ns > max(begin, round(start * NS))) & (run.t_ns <= end)
    length = (run.t_ns - run.begin_ns)[chosen]
    return float(np.average(run.component(component, phase)[chosen], weights=length)) if chosen.any() else None


def cycle_period(
    run: RunData,
    component: str = "fx",
    after: Kinds | None = None,
    before: Kinds | None = None,
    prominence: float = 0.2,
    smooth: float = 0.5,
) -> float | None:
    """Median time between the peaks of the load [s]; for cycles too few or too uneven for `load_period`.

    A peak stands out by ``prominence`` of the record's largest load, after a running mean over ``smooth`` [s]. None
    with fewer than three peaks.
    """
    begin, end = between(run, after, before)
    if begin is None:
        return None
    chosen = (run.t_ns > begin) & (run.t_ns <= end)
    peaks, _, step = peaks_in(run.t_ns[chosen], run.component(component)[chosen], prominence, smooth)
    return float(np.median(np.diff(peaks))) * step if len(peaks) > 2 else None


def piece_length(run: RunData, event: Kinds = "circumferential") -> float | None:
    """Length along the drift of the pieces that break off, mean weighted with their area [m]."""
    pieces = np.array([(e.length, e.area) for e in events_of(run, event) if e.area > 0]).reshape(-1, 2)
    return float(np.average(pieces[:, 0], weights=pieces[:, 1])) if len(pieces) else None


def piece_area(run: RunData, event: Kinds = "circumferential") -> float | None:
    """Mean area of the pieces that break off [m^2]."""
    areas = [e.area for e in events_of(run, event) if e.area > 0]
    return float(np.mean(areas)) if areas else None


def feed_rate(
    run: RunData, cycle: int | None = None, event: Kinds = "circumferential", last: float = 1.0
) -> float | None:
    """Ice that becomes rubble per time [kg/s], less what the blocks lose by crushing; over the whole run or a cycle.

    The n-th cycle begins after the event of the n-th encounter and ends with that of the next; without one ``last`` is
    the share of the run's time that is looked at, up to its end.
    """
    return _rate(run, ("rubble_mass", "cleared_mass"), cycle, event, last)


def clearing_rate(
    run: RunData, cycle: int | None = None, event: Kinds = "circumferential", last: float = 1.0
) -> float | None:
    """Rubble that passes the structure or leaves the domain per time [kg/s]; as `feed_rate`."""
    return _rate(run, ("cleared_mass",), cycle, event, last)


def rubble_mean(run: RunData, last: float = 1.0) -> float | None:
    """Mean volume of broken ice in front of the structure over the ``last`` share of the run's time [m^3]."""
    if "rubble_mass" not in run.ledger or len(run.t_ns) < 2:
        return None
    chosen = slice(_since(run, last) + 1, None)
    length = (run.t_ns - run.begin_ns)[chosen]
    return float(np.average(run.ledger["rubble_mass"][chosen], weights=length)) / float(run.metadata["ice_density"])


def _since(run: RunData, last: float) -> int:
    """As `since`, with a window behind it."""
    return min(since(run.t, last), len(run.t_ns) - 2)


def _rate(run: RunData, names: tuple[str, ...], cycle: int | None, event: Kinds, share: float) -> float | None:
    if len(run.t_ns) < 2 or not set(names) <= set(run.ledger):
        return None
    first, last = _since(run, share), len(run.t_ns) - 1
    if cycle is not None:
        found = encounters(run, event)
        if not 1 <= cycle < len(found):
            return None
        first, last = found[cycle - 1].event, found[cycle].event
    mass = np.sum([run.ledger[name] for name in names], axis=0)
    return float(mass[last] - mass[first]) * NS / float(run.t_ns[last] - run.t_ns[first])
