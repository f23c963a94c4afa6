"""How much of the scatter of a load comes from which key: indices of a sampled design, by SALib.

Sobol's first-order index is the share of the variance that a key explains alone, the total index its share with all
interactions (Sobol 2001, Saltelli et al. 2010); both need the points of the design ``sobol``. From points drawn at
random come first-order indices by RBD-FAST (Tarantola et al. 2006) and Borgonovo's moment-independent delta (2007).
A point stands for the mean over its seeds.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from cosim.errors import InputError
from cosim.study.design import Design, problem
from cosim.study.task import COMPONENTS, Row
from cosim.study.variants import Range, Variant
from coupling.interface import Array

FEWEST = 16  #: points from which on indices say something


def indices(
    design: Design, ranges: Sequence[Range], variants: Sequence[Variant], rows: Sequence[Row]
) -> list[dict[str, Any]]:
    """For each peak and key the indices with their 95 % intervals; none where too few points have ended.

    ``{"quantity", "key", "first", "first_interval", "total" or "delta", ..., "points"}``; an interval is +- its value.
    """
    points, found = design.points(ranges), []
    for c in COMPONENTS:
        y = _of_points(f"{c}_peak", len(points), variants, rows)
        if design.name == "sobol":
            y, of = _whole_blocks(y, len(ranges)), _sobol
        else:
            of = _given
        ran = np.isfinite(y)
        if ran.sum() >= FEWEST and np.ptp(y[ran]) > 0.0:
            of_key = of(ranges, points, y)
            found += [
                {"quantity": f"{c}_peak", "key": r.key, **index, "points": int(ran.sum())}
                for r, index in zip(ranges, of_key, strict=True)
            ]
    return found


def _of_points(name: str, count: int, variants: Sequence[Variant], rows: Sequence[Row]) -> Array:
    """Mean over the seeds of each point; nan where a run is missing or has failed, (points,)."""
    if len(variants) % count:
        raise InputError(f"{len(variants)} variants are no whole number of seeds at {count} points")
    values = np.full(len(variants), np.nan)
    for row in rows:
        if row["error"] is None:
            values[row["number"]] = row[name]
    return np.asarray(values.reshape(count, -1).mean(axis=1))


def _whole_blocks(y: Array, keys: int) -> Array:
    """Saltelli's points come in blocks of keys + 2, each is used whole or not at all."""
    blocks = y.reshape(-1, keys + 2)
    blocks[~np.isfinite(blocks).all(axis=1)] = np.nan
    return blocks.ravel()


def _sobol(ranges: Sequence[Range], points: Array, y: Array) -> list[dict[str, float]]:  # noqa: ARG001  as `_given`
    from SALib.analyze import sobol

    ran = y[np.isfinite(y)]
    s = sobol.analyze(problem(ranges), (ran - ran.mean()) / ran.std(), calc_second_order=False, seed=0)
    return [
        {
            "first": float(s["S1"][k]),
            "first_interval": float(s["S1_conf"][k]),
            "total": float(s["ST"][k]),
            "total_interval": float(s["ST_conf"][k]),
        }
        for k in range(len(ranges))
    ]


def _given(ranges: Sequence[Range], points: Array, y: Array) -> list[dict[str, float]]:
    from SALib.analyze import delta, rbd_fast

    ran = np.isfinite(y)
    of, x, y = problem(ranges), points[ran], y[ran]
    first = rbd_fast.analyze(of, x, y, seed=0)
    d = delta.analyze(of, x, y, method="delta", seed=0)
    return [
        {
            "first": float(first["S1"][k]),
            "first_interval": float(first["S1_conf"][k]),
            "delta": float(d["delta_balanced"][k]),
            "delta_interval": float(d["delta_balanced_conf"][k]),
        }
        for k in range(len(ranges))
    ]
