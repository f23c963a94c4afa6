"""A run beside a measured series: aligned, cut to the time that both have, and measured by the same functions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cosim.analysis.compare import ratio
from cosim.analysis.instants import largest
from cosim.analysis.run_data import RunData
from cosim.series.align import Alignment, align
from cosim.series.description import Description, load_description
from cosim.series.metrics import PAIR, SINGLE, Look, look
from cosim.series.read import FEWEST, read_series
from cosim.series.series import Series, of_run
from cosim.series.spectra import even
from cosim.series.told import SeriesError
from coupling.interface import Array


@dataclass(frozen=True)
class Pair:
    """One component of run and series over the time that both have, in the time of the run."""

    component: str
    simulated: Look
    measured: Look
    t: Array  #: (n,) even times [s]
    s: Array  #: (n,) simulated at these [N]
    m: Array  #: (n,) measured [N]


@dataclass(frozen=True)
class Comparison:
    """Everything about one run and one series."""

    run: str
    description: Description
    over: float  #: both are means over this time [s]
    alignment: Alignment
    simulated: Series  #: the whole run
    measured: Series  #: the whole series, in the time of the run
    pairs: tuple[Pair, ...]
    told: tuple[str, ...]


def compare_series(run: RunData, raw: Series, description: Description) -> Comparison:
    """The comparison of a run with a series that `cosim.series.read.read_series` gave."""
    given = description.metrics
    over = run.averaging if given.over is None else float(given.over)
    simulated, measured = of_run(run, over), raw.mean_over(over)
    if len(simulated.t) < FEWEST or not np.any(simulated.loads["f"]):
        raise SeriesError(f"{run.name}: fewer than {FEWEST} windows or no load at all; give a run that meets the ice")
    laid = align(run, simulated, measured, description.align, description.scale.factor)
    there = measured.timed(1.0, -laid.shift)
    begin, end = max(simulated.t[0], there.t[0]), min(simulated.t[-1], there.t[-1])
    a, b = simulated.between(begin, end), there.between(begin, end)
    if min(len(a.t), len(b.t)) < FEWEST:
        raise SeriesError(
            f"{raw.name}: shares no time with {run.name} ({simulated.t[0]:g} s to {simulated.t[-1]:g} s) when it has "
            f"{there.t[0]:g} s to {there.t[-1]:g} s; choose another align.by, or check time.unit and scale.factor"
        )
    pairs = tuple(_pair(name, a, b, description) for name in measured.loads)
    told = (
        *raw.told,
        laid.told,
        f"compared over {begin:.2f} s to {end:.2f} s of the run, both as means over {over:.3g} s",
    )
    return Comparison(run.name, description, over, laid, simulated, there, pairs, told)


def _pair(name: str, a: Series, b: Series, description: Description) -> Pair:
    x, y = a.loads[name], b.loads[name]
    size, share = float(y[largest(y)]), description.align.threshold
    looks = [look(t, v, size, share, description.metrics) for t, v in ((a.t, x), (b.t, y))]
    t, s, _ = even(a.t, x)
    inside = (t >= b.t[0]) & (t <= b.t[-1])
    return Pair(name, looks[0], looks[1], t[inside], s[inside], np.interp(t[inside], b.t, y))


def files(path: Path, runs: Iterable[RunData], settings: Iterable[str] = ()) -> list[Comparison]:
    """Each run beside the series of a file or of a `series.toml`."""
    description, data = load_description(path, settings)
    raw = read_series(data, description)
    return [compare_series(run, raw, description) for run in runs]


def rows(pair: Pair) -> list[dict[str, Any]]:
    """Metrics of one series, for both: name, unit, simulated, measured, ratio."""
    out = []
    for name, (unit, function) in SINGLE.items():
        s, m = function(pair.simulated), function(pair.measured)
        beside = None if m is None else (m, m)
        out.append({"name": name, "unit": unit, "simulated": s, "measured": m, "ratio": ratio(s, beside)})
    return out


def agreement_rows(pair: Pair) -> list[dict[str, Any]]:
    """Measures of the aligned pair: name, unit, value, best."""
    return [
        {"name": name, "unit": unit, "value": function(pair.s, pair.m), "best": best}
        for name, (unit, best, function) in PAIR.items()
    ]


def to_json(c: Comparison) -> dict[str, Any]:
    """``series`` of the JSON of `cosim compare`."""
    return {
        "file": c.measured.name,
        "title": c.description.title,
        "source": c.description.source,
        "told": list(c.told),
        "over_s": c.over,
        "shift_s": c.alignment.shift,
        "aligned_by": c.alignment.by,
        "span_s": [float(c.pairs[0].t[0]), float(c.pairs[0].t[-1])],
        "components": {pair.component: {"metrics": rows(pair), "agreement": agreement_rows(pair)} for pair in c.pairs},
    }
