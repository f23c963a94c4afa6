"""How far a result can be trusted: numbers that a run knows of itself, each with the limit above which it says so.

The limits are choices of this project, written in one place. They are no proof: a run within all of them can be wrong.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from cosim.analysis.instants import events_of, first_contact
from cosim.analysis.levels import load_mean
from cosim.analysis.peaks import at_peak
from cosim.analysis.run_data import RunData
from coupling.energy import MOVING
from coupling.interface import NS, Array

#: energy terms that no physics lets fall below zero: there they have put energy in
NUMERICS = (
    *("interface_loss", "stepping_loss", "scheme_loss", "correction_loss", "impact_sheet_loss"),
    "contact_crushing_loss",
)


#: cells over those of the beam test: 1.25 moves the nominal strength by 2 %, 2 by 10 % (ice of 1 m and of 0.1 m)
COARSER = 1.25


@dataclass(frozen=True)
class Light:
    """One number about a run."""

    name: str
    value: Callable[[RunData], float | None]  #: None: the run does not tell
    limit: float
    at_least: bool  #: the limit is the smallest good value, else the largest
    shown: str  #: the value as text, with ``{:...}``
    because: str  #: what is wrong beyond the limit, with ``{:...}`` for the value

    def judge(self, run: RunData) -> dict[str, Any]:
        """Value, limit, and whether it is kept; of a value that is not known it is not said."""
        value = self.value(run)
        known = value is not None and math.isfinite(value)
        good = None if not known else value >= self.limit if self.at_least else value <= self.limit  # type: ignore[operator]
        return {"value": value if known else None, "limit": self.limit, "good": good}


def numerics_share(run: RunData) -> float | None:
    """Energy from numerics over the work of the drift, or of a structure that moves, at the end of the run."""
    work = max(abs(_last(run, "drift_work") or 0.0), abs(_last(run, MOVING) or 0.0))
    if not work:
        return None
    return sum(max(-(_last(run, name) or 0.0), 0.0) for name in NUMERICS) / work


def staggering_share(run: RunData) -> float | None:
    """Staggering at the peak over the peak, the larger of Fx and Fz; see `coupling.budget`."""
    run = run.lasting
    shares = []
    for axis in ("fx", "fz"):
        k, term = at_peak(run, axis), run.budget.get(f"{axis}_staggering")
        if k is not None and term is not None and run.component(axis)[k]:
            shares.append(abs(float(term[k] / run.component(axis)[k])))
    return max(shares, default=None)


def odd_even(run: RunData) -> float | None:
    """Difference of the mean loads of odd and of even windows over the mean, the larger of Fx and Fz."""
    n = len(run.t_ns) // 2 * 2
    if n < 20:
        return None
    length = (run.t_ns - run.begin_ns)[:n].astype(float)
    found = [_swing(run.component(axis)[:n], length) for axis in ("fx", "fz")]
    return max((swing for swing in found if swing is not None), default=None)


def _swing(load: Array, length: Array) -> float | None:
    mean = float(np.average(np.abs(load), weights=length))
    odd, even = (float(np.average(load[k::2], weights=length[k::2])) for k in (0, 1))
    return abs(odd - even) / mean if mean else None


def nodes_per_length(run: RunData) -> float | None:
    """Cells in the characteristic length of the floating plate."""
    told = run.metadata.get("characteristic_length_m")
    return None if told is None else float(told) / float(run.metadata["spacing_m"])


def cells_of_beam(run: RunData) -> float | None:
    """Cells over those in which the beam test was simulated that gave the strength of the layers."""
    told = run.metadata.get("beam_cell_m")
    return None if told is None else float(run.metadata["spacing_m"]) / float(told)


def time_after_peak(run: RunData) -> float | None:
    """From the last peak of Fx and Fz to the end of the run, over the averaging time."""
    loads = run.lasting
    if not len(run.t_ns) or not run.averaging or not run.component("f").any():
        return None
    last = max(float(run.t[at_peak(loads, axis) or 0]) for axis in ("fx", "fz"))
    return (float(run.t[-1]) - last) / run.averaging


def growth(run: RunData) -> float | None:
    """Mean load of the last quarter of the time since first contact over that of the third; larger of Fx and Fz.

    Where ice still spreads along a long face, or rubble piles up, the loads of a run are those of its beginning.
    """
    start = first_contact(run)
    if start is None or np.count_nonzero(run.t > start) < 20:
        return None
    quarter = 0.25 * (float(run.t[-1]) - start)
    found = []
    for axis in ("fx", "fz"):
        third, last = (load_mean(run, axis, begin=k * quarter, end=(k + 1) * quarter) for k in (2, 3))
        if third and last is not None:
            found.append(abs(last / third))
    return max(found, default=None)


def run_length(run: RunData) -> float | None:
    """Simulated time over the averaging time: below 1 the means reach to before the run, where they count no load."""
    if not len(run.t_ns) or not run.averaging:
        return None
    return float(run.t_ns[-1] - run.begin_ns[0]) / NS / run.averaging


def breaks(run: RunData) -> float | None:
    """Pieces that broke off in front of the structure."""
    return float(len(events_of(run, "circumferential")))


def _last(run: RunData, name: str) -> float | None:
    values = run.ledger.get(name)
    return None if values is None or not len(values) else float(values[-1])


LIGHTS = (
    Light(
        "numerics_share",
        numerics_share,
        0.1,
        False,
        "energy from numerics {:.1%} of the drift's work",
        "{:.0%} of the drift's work came from numerics (halve coupling.window and rubble.substep)",
    ),
    Light(
        "staggering_share",
        staggering_share,
        0.1,
        False,
        "staggering {:.1%} of the peak",
        "{:.0%} of the peak is staggering between sheet and rubble (halve coupling.window)",
    ),
    Light(
        "odd_even",
        odd_even,
        0.1,
        False,
        "odd and even windows differ by {:.1%}",
        "loads of odd and even windows differ by {:.0%} of the mean (halve coupling.window)",
    ),
    Light(
        "nodes_per_characteristic_length",
        nodes_per_length,
        5.0,
        True,
        "{:.1f} cells per characteristic length",
        "there are {:.1f} cells in the characteristic length (refine sheet.nodes)",
    ),
    Light(
        "cells_of_beam",
        cells_of_beam,
        COARSER,
        False,
        "cells {:.2f} times those of the beam test",
        "cells are {:.1f} times as wide as those in which the beam test was simulated, so that the strength of the "
        "layers is that of another mesh (refine sheet.nodes to half the width of the beam)",
    ),
    Light(
        "time_after_peak",
        time_after_peak,
        1.0,
        True,
        "run goes on for {:.1f} averaging times after the peak",
        "the largest load stands at the end of the run (lengthen scenario.duration)",
    ),
    Light(
        "growth",
        growth,
        1.5,
        False,
        "mean load of the last quarter {:.2f} times that of the third",
        "the mean load of the last quarter is {:.1f} times that of the third: it still grows "
        "(lengthen scenario.duration)",
    ),
    Light(
        "run_length",
        run_length,
        1.0,
        True,
        "run of {:.1f} averaging times",
        "the run has {:.2f} averaging times, so that its means count time without load (lengthen scenario.duration)",
    ),
    Light(
        "breaks",
        breaks,
        3.0,
        True,
        "{:.0f} breaks",
        "{:.0f} breaks are too few for a largest load (lengthen scenario.duration)",
    ),
)


def trust(run: RunData) -> dict[str, Any]:
    """``{"trustworthy", "because", "lights"}`` of a run: every number, and a line for each that is beyond its limit."""
    lights = {light.name: light.judge(run) for light in LIGHTS}
    bad = [light for light in LIGHTS if lights[light.name]["good"] is False]
    because = [light.because.format(lights[light.name]["value"]) for light in bad]
    return {"trustworthy": not because, "because": because, "lights": lights}


def trust_lines(found: dict[str, Any]) -> list[str]:
    """The same for people: the numbers in a line, and what speaks against the result in another."""
    shown = [
        light.shown.format(found["lights"][light.name]["value"])
        for light in LIGHTS
        if found["lights"].get(light.name, {}).get("value") is not None
    ]
    lines = ["lights: " + (", ".join(shown) or "none")]
    return lines if found["trustworthy"] else [*lines, f"not trustworthy, because {'; '.join(found['because'])}"]
