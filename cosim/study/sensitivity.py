"""How much of the scatter of a load comes from which key: indices of a sampled design.

Sobol's first-order index is the share of the variance that a key explains alone, the total index its share with all
interactions (Sobol 2001, Saltelli et al. 2010); both need the points of the design ``sobol``. From points drawn at
random, of which dear runs allow a few dozen, first-order indices come from a polynomial in each key (polynomial chaos
without interactions, Sudret 2008), with the share of the variance that it explains at points left out of the fit; and,
of hundreds of points, Borgonovo's moment-independent delta (2007). SALib has the other ones. A point stands for the
mean over its seeds.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.polynomial.legendre import legvander

from cosim.errors import InputError
from cosim.study.design import Design, problem
from cosim.study.task import COMPONENTS, Row
from cosim.study.variants import Range, Variant
from coupling.interface import Array, IntArray

FEWEST = 16  #: points from which on indices say something
FOR_DELTA = 128  #: points from which on there are bins enough for delta
PER_TERM = 3  #: points for each term of a polynomial of second degree; of first degree with fewer
DRAWN = 200  #: samples of the bootstrap


def indices(
    design: Design, ranges: Sequence[Range], variants: Sequence[Variant], rows: Sequence[Row]
) -> list[dict[str, Any]]:
    """For each peak and key the indices with their 95 % intervals; none where too few points have ended.

    ``{"quantity", "key", "first", "first_interval", ..., "points"}``; an interval is +- its value. Of ``sobol`` there
    is ``total``, of points drawn at random ``explained``, see `_by_polynomials`, and ``delta`` where there are many.
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
    ran = np.isfinite(y)
    x, y = points[ran], y[ran]
    first, interval, explained = _by_polynomials(np.array([(r.low, r.high) for r in ranges]), x, y)
    found = [
        {"first": float(first[k]), "first_interval": float(interval[k]), "explained": explained}
        for k in range(len(ranges))
    ]
    return found if len(y) < FOR_DELTA else [a | b for a, b in zip(found, _delta(ranges, x, y), strict=True)]


def _delta(ranges: Sequence[Range], x: Array, y: Array) -> list[dict[str, float]]:
    from SALib.analyze import delta

    d = delta.analyze(problem(ranges), x, y, method="delta", seed=0)
    return [
        {"delta": float(d["delta_balanced"][k]), "delta_interval": float(d["delta_balanced_conf"][k])}
        for k in range(len(ranges))
    ]


def _by_polynomials(ends: Array, x: Array, y: Array) -> tuple[Array, Array, float]:
    """First-order indices (k,) of points x (n, k), half their 95 % interval by bootstrap, and the share explained.

    y = c_0 + sum over keys and degrees m of c_km P_m, Legendre's polynomials over the range of the key, by least
    squares: the variance of a term is c_km^2 / (2 m + 1) for keys spread evenly, and what is left over counts as that
    of interactions. The share is that at each point from the fit to all others (leave one out); it may be negative
    where polynomials say nothing.
    """
    keys, degree = x.shape[1], 2 if len(y) >= PER_TERM * (1 + 2 * x.shape[1]) else 1
    at = 2.0 * (x - ends[:, 0]) / (ends[:, 1] - ends[:, 0]) - 1.0
    terms = np.column_stack([np.ones(len(y)), *(legvander(at[:, k], degree)[:, 1:] for k in range(keys))])
    weight = np.tile(1.0 / (2.0 * np.arange(1, degree + 1) + 1.0), keys)

    def shares(chosen: IntArray) -> Array:
        c = np.linalg.lstsq(terms[chosen], y[chosen], rcond=None)[0]
        left = y[chosen] - terms[chosen] @ c
        own = (c[1:] ** 2 * weight).reshape(keys, degree).sum(axis=1)
        return np.asarray(own / (own.sum() + (left**2).sum() / max(len(y) - len(c), 1)))

    inverse = np.linalg.pinv(terms)
    seen = 1.0 - np.einsum("ij,ji->i", terms, inverse)
    missed = (y - terms @ (inverse @ y)) / np.maximum(seen, 1e-12)
    random = np.random.default_rng(0)
    drawn = np.array([shares(random.integers(0, len(y), len(y), np.int64)) for _ in range(DRAWN)])
    return shares(np.arange(len(y))), 1.96 * drawn.std(axis=0), float(1.0 - (missed**2).mean() / y.var())
