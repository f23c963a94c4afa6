"""What the runs of a group have in common: median, 5 to 95 %, intervals by bootstrap, and where a measured value lies.

Intervals are of the estimate, at 95 %: were the ensemble drawn again, so far would the median or the quantile move
(percentile bootstrap, Efron 1979, by scipy.stats.bootstrap, with a fixed seed). The chance that a run exceeds a
measured value is the share of runs that do, with Clopper and Pearson's interval.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy import stats

from cosim.analysis.reference import Reference
from cosim.study.task import COMPONENTS, FEATURE, Row
from coupling.interface import Array

QUANTILES = (0.05, 0.5, 0.95)
LEVEL = 0.95  #: of all intervals
RESAMPLES, FEWER, DRAWS = 9999, 999, 20_000_000  #: resamples, at least, and values that are drawn for an interval
BATCH = 1_000_000  #: values at the same time
FEWEST = 3  #: runs from which on there is an interval


def quantiles(values: Array) -> Array:
    """Of `QUANTILES`, (3,); linear between order statistics (Hyndman and Fan 1996, type 7)."""
    return np.asarray(np.quantile(values, QUANTILES))


def interval(values: Array, share: float) -> list[float] | None:
    """Of the quantile at ``share``; None for fewer than `FEWEST` values."""
    if len(values) < FEWEST:
        return None
    found = stats.bootstrap(
        (values,),
        lambda x, axis: np.quantile(x, share, axis=axis),
        n_resamples=min(RESAMPLES, max(FEWER, DRAWS // len(values))),
        batch=max(1, BATCH // len(values)),
        confidence_level=LEVEL,
        method="percentile",
        rng=np.random.default_rng(0),
    ).confidence_interval
    return [float(found.low), float(found.high)]


def beside_measured(values: Array, measured: tuple[float, float] | None) -> dict[str, Any]:
    """Where a measured value, or both ends of a range, lies among runs.

    ``below`` and ``above`` are numbers of runs under its lower and over its upper end. ``rank`` is the place of its
    middle, 1 to n + 1, when it is put among the runs. ``exceedance`` is the chance that a run exceeds the middle.
    """
    if measured is None:
        return {"measured": None}
    middle, n = 0.5 * (measured[0] + measured[1]), len(values)
    above = int((values > middle).sum())
    low, high = stats.binomtest(above, n).proportion_ci(LEVEL)
    return {
        "measured": middle,
        "measured_range": list(measured) if measured[0] != measured[1] else None,
        "below": int((values < measured[0]).sum()),
        "above": int((values > measured[1]).sum()),
        "rank": int((values < middle).sum()) + 1,
        "exceedance": above / n,
        "exceedance_interval": [float(low), float(high)],
    }


def distribution(values: Sequence[float | None], measured: tuple[float, float] | None = None) -> dict[str, Any]:
    """Of one quantity over the runs; ``n`` counts the runs that have it, ``missing`` those that do not."""
    x = np.array([v for v in values if v is not None], np.float64)
    if not len(x):
        return {"n": 0, "missing": len(values)}
    low, median, high = quantiles(x).tolist()
    return {
        "n": len(x),
        "missing": len(values) - len(x),
        "mean": float(x.mean()),
        "deviation": float(x.std(ddof=1)) if len(x) > 1 else None,
        "p05": low,
        "median": median,
        "p95": high,
        "median_interval": interval(x, 0.5),
        "p05_interval": interval(x, 0.05),
        "p95_interval": interval(x, 0.95),
        **beside_measured(x, measured),
    }


def ensembles(rows: Sequence[Row], reference: Reference | None) -> list[dict[str, Any]]:
    """Distributions of peaks and of features, for each group of runs that differ in their seed only."""
    groups: dict[str, list[Row]] = {}
    for row in rows:
        if row["error"] is None:
            groups.setdefault(row["group"], []).append(row)
    features = () if reference is None else reference.features
    found = []
    for name, group in groups.items():
        of_peaks = [
            {"group": name, "quantity": f"{c}_peak", "unit": "N", **distribution([r[f"{c}_peak"] for r in group])}
            for c in COMPONENTS
        ]
        of_features = [
            {
                "group": name,
                "quantity": f.name,
                "unit": f.unit,
                **distribution([r.get(FEATURE + f.name) for r in group], f.measured),
            }
            for f in features
        ]
        found += [*of_peaks, *of_features]
    return found
