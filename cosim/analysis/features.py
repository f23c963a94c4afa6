"""Features of a recorded run, as plain functions: ``feature(run, ...) -> number in SI, or None if the run has none``.

None is an answer: a run without a split has no load at the split. Nothing is filled in. Times count from first contact.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from cosim.analysis import cycles, levels
from cosim.analysis.instants import Kinds, between, evenly, first_contact, first_event
from cosim.analysis.peaks import at_peak
from cosim.analysis.run_data import RunData
from coupling.interface import NS


def event_load(run: RunData, event: Kinds, component: str = "fx") -> float | None:
    """Load at the first event of a kind, all phases [N]; component ``fx``, ``fy``, ``fz`` or the resultant ``f``."""
    found = first_event(run, event)
    if found is None:
        return None
    force = dict(zip(("fx", "fy", "fz"), found.force, strict=True))
    return float(np.linalg.norm(found.force)) if component == "f" else float(force[component])


def event_time(run: RunData, event: Kinds) -> float | None:
    """Time of the first event of a kind, from first contact [s]."""
    found, start = first_event(run, event), first_contact(run)
    return None if found is None or start is None else found.t_ns / NS - start


def peak_load(run: RunData, component: str = "fx", phase: str | None = None) -> float | None:
    """Load of the window with the largest in magnitude, of all phases or of one, with its sign [N]."""
    k = at_peak(run, component, phase)
    return None if k is None else float(run.component(component, phase)[k])


def peak_time(run: RunData, component: str = "fx", phase: str | None = None) -> float | None:
    """Time of `peak_load` from first contact [s]."""
    start, k = first_contact(run), at_peak(run, component, phase)
    return None if start is None or k is None else float(run.t[k]) - start


def build_up_time(run: RunData, event: Kinds, component: str = "fx") -> float | None:
    """Time from the last window below a tenth of the load at the event, before the largest one until then [s]."""
    found, limit = first_event(run, event), event_load(run, event, component)
    if found is None or limit is None:
        return None
    load = run.component(component)[run.t_ns <= found.t_ns]
    if not len(load):
        return None
    low = np.flatnonzero(load[: load.argmax()] < 0.1 * limit)
    begin = run.t_ns[low[-1]] if len(low) else run.t_ns[0]
    return float(found.t_ns - begin) / NS


def level_between_peaks(run: RunData, component: str = "fx", share: float = 0.05) -> float | None:
    """Mean load of the windows with neither breaking nor rotating, after the first circumferential event [N].

    "Neither" means below ``share`` of the largest load of the run (thesis 6.3.1: "the non-zero load between the load
    peaks, where no breaking and rotating occurs").
    """
    found = first_event(run, ("circumferential", "hand_over"))
    if found is None:
        return None
    total = run.component(component)
    other = np.abs(run.component(component, "breaking")) + np.abs(run.component(component, "rotating"))
    between = (run.t_ns > found.t_ns) & (other < share * np.abs(total).max()) & (total > 0)
    length = run.t_ns - run.begin_ns
    return float(np.average(total[between], weights=length[between])) if between.any() else None


def load_period(
    run: RunData,
    component: str = "fx",
    after: Kinds | None = None,
    before: Kinds | None = None,
) -> float | None:
    """Dominant period of the load cycles [s]: largest line of the spectrum with at least three periods in the record.

    The record runs between the first events ``after`` and ``before``; its linear trend is taken off and a Hann window
    is laid over it; windows of different length are read at the distance of the shortest. None without an event
    ``after``, or if the record is shorter than 8 windows.
    """
    begin, end = between(run, after, before)
    if begin is None:
        return None
    chosen = (run.t_ns > begin) & (run.t_ns <= end)
    t_ns, load = run.t_ns[chosen], run.component(component)[chosen]
    if len(t_ns) < 8 or np.ptp(load) == 0:
        return None
    t_ns, load = evenly(t_ns, load)
    t = t_ns / NS
    cycles = load - np.polyval(np.polyfit(t, load, 1), t)
    padded = 8 * len(t)
    power = np.abs(np.fft.rfft(cycles * np.hanning(len(t)), padded)) ** 2
    frequency = np.fft.rfftfreq(padded, t[1] - t[0])
    power[frequency < 3 / (t[-1] - t[0])] = 0
    return float(1 / frequency[power.argmax()]) if power.any() else None


def rubble_volume(run: RunData) -> float | None:
    """Largest volume of broken ice in front of the structure [m^3], from the ledger's ``rubble_mass``."""
    mass = run.ledger.get("rubble_mass")
    if mass is None or not np.isfinite(mass).any():
        return None
    return float(np.nanmax(mass)) / float(run.metadata["ice_density"])


#: the functions that a reference file may name, and the unit of what they give
UNITS: dict[str, str] = {}
QUANTITIES: dict[str, Callable[..., float | None]] = {}
_OF_UNIT: dict[str, tuple[Callable[..., float | None], ...]] = {
    "N": (
        *(event_load, peak_load, level_between_peaks, cycles.largest_load, cycles.encounter_load, cycles.mean_load),
        *(levels.load_mean, levels.load_quantile, levels.peak_quantile, levels.trough_load),
    ),
    "s": (
        *(event_time, peak_time, build_up_time, load_period, cycles.encounter_time, cycles.cycle_period),
        levels.peak_interval,
    ),
    "m": (cycles.piece_length,),
    "m^2": (cycles.piece_area,),
    "m^3": (rubble_volume, cycles.rubble_mean),
    "kg/s": (cycles.feed_rate, cycles.clearing_rate),
}
for _unit, _functions in _OF_UNIT.items():
    for _function in _functions:
        QUANTITIES[_function.__name__], UNITS[_function.__name__] = _function, _unit
