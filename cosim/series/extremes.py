"""Extreme loads: a distribution fitted to peaks or to maxima, the load of a return period, and its confidence.

Coles (2001), An Introduction to Statistical Modeling of Extreme Values: sections 3.3 (maxima) and 4.3 (peaks).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.stats import genextreme, genpareto

from coupling.interface import Array

FEWEST = 10  #: peaks or maxima of a fit
FOR_SHAPE = 50  #: with fewer peaks the shape of the tail is not fitted: exponential
DRAWS = 400  #: of the bootstrap
SEED = 20240  #: of it: the same series has the same interval


@dataclass(frozen=True)
class Extreme:
    """A return level with its interval, and the fit."""

    level: float  #: exceeded once in the return period on average [N]
    low: float
    high: float  #: of the two-sided interval [N]
    shape: float  #: xi; below 0 the load has an upper end, 0 exponential, above 0 a heavy tail
    scale: float  #: sigma [N]
    location: float  #: threshold of the peaks, mu of the maxima [N]


def of_peaks(values: Array, threshold: float, rate: float, period: float, confidence: float = 0.9) -> Extreme | None:
    """Return level of peaks ``values`` (m,) over ``threshold``, of which ``rate`` occur per second, [N].

    ``u + sigma / xi ((rate period)^xi - 1)`` (Coles 4.12), sigma and xi of the generalised Pareto distribution by
    maximum likelihood; with fewer than `FOR_SHAPE` peaks xi = 0, ``u + sigma ln(rate period)``. Range: above the
    threshold. The interval is a parametric bootstrap over number and heights. None with fewer than `FEWEST` peaks, or
    for a period in which less than one peak occurs.
    """
    excess = values - threshold
    if len(excess) < FEWEST or rate * period < 1.0:
        return None
    shaped = len(excess) >= FOR_SHAPE

    def fit(x: Array) -> tuple[float, float]:
        if not shaped:
            return 0.0, float(x.mean())
        xi, _, sigma = genpareto.fit(x, floc=0.0)
        return float(xi), float(sigma)

    def level(xi: float, sigma: float, count: float) -> float:
        n = count / len(excess) * rate * period
        return threshold + sigma * float(np.log(n) if abs(xi) < 1e-9 else (n**xi - 1.0) / xi)

    def draw(random: np.random.Generator) -> float:
        count = max(2, int(random.poisson(len(excess))))
        return level(*fit(genpareto.rvs(xi, scale=sigma, size=count, random_state=random)), count)

    xi, sigma = fit(excess)
    return Extreme(level(xi, sigma, len(excess)), *_interval(draw, confidence), xi, sigma, threshold)


def of_maxima(values: Array, periods: float, confidence: float = 0.9) -> Extreme | None:
    """Return level of maxima ``values`` (m,) of equal blocks or of runs, exceeded once in ``periods`` blocks, [N].

    ``mu - sigma / xi (1 - y^-xi)``, ``y = -ln(1 - 1/periods)`` (Coles 3.4), by maximum likelihood of the generalised
    extreme value distribution (Gumbel, Frechet, Weibull). None with fewer than `FEWEST` maxima or ``periods <= 1``.
    """
    if len(values) < FEWEST or periods <= 1.0:
        return None

    def fit(x: Array) -> tuple[float, float, float]:
        c, mu, sigma = genextreme.fit(x)
        return -float(c), float(mu), float(sigma)

    def level(xi: float, mu: float, sigma: float) -> float:
        return float(genextreme.isf(1.0 / periods, -xi, mu, sigma))

    def draw(random: np.random.Generator) -> float:
        return level(*fit(genextreme.rvs(-xi, mu, sigma, size=len(values), random_state=random)))

    xi, mu, sigma = fit(values)
    return Extreme(level(xi, mu, sigma), *_interval(draw, confidence), xi, sigma, mu)


def _interval(draw: Callable[[np.random.Generator], float], confidence: float) -> tuple[float, float]:
    """Percentiles of `DRAWS` levels from the fitted distribution."""
    random = np.random.default_rng(SEED)
    levels = [draw(random) for _ in range(DRAWS)]
    low, high = np.quantile(levels, [(1.0 - confidence) / 2.0, (1.0 + confidence) / 2.0])
    return float(low), float(high)
