"""Extreme loads: a distribution fitted to peaks or to maxima, the load of a return period, and its confidence.

Coles (2001), An Introduction to Statistical Modeling of Extreme Values: sections 3.3 (maxima) and 4.3 (peaks).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize_scalar
from scipy.special import gamma
from scipy.stats import chi2, genpareto

from coupling.interface import Array

FEWEST = 10  #: peaks or maxima of a fit
FOR_SHAPE = 50  #: with fewer peaks the shape of the tail is not fitted: exponential
SHAPES = (-1.0, 2.0)  #: of tails that are looked at
DRAWS = 2000  #: of a bootstrap
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
    maximum likelihood, the interval by the profile of the likelihood over the level (Coles 2.6.6, 4.3.3); with fewer
    than `FOR_SHAPE` peaks xi = 0, ``u + sigma ln(rate period)``, the interval exact. Range: above the threshold. The
    number of peaks is taken as known. None with fewer than `FEWEST` peaks or without scatter, or for a period in which
    no more than one peak occurs.
    """
    excess, n = values - threshold, rate * period
    if len(excess) < FEWEST or n <= 1.0 or np.ptp(values) == 0.0:
        return None
    if len(excess) < FOR_SHAPE:
        growth = float(excess.mean()) * math.log(n)
        ends = 2.0 * len(excess) / chi2.ppf([(1.0 + confidence) / 2.0, (1.0 - confidence) / 2.0], 2 * len(excess))
        low, high = (threshold + growth * float(end) for end in ends)
        return Extreme(threshold + growth, low, high, 0.0, float(excess.mean()), threshold)
    xi, _, sigma = (float(v) for v in genpareto.fit(excess, floc=0.0))
    growth = sigma * _growth(xi, n)
    low, high = _profile(excess, growth, n, confidence)
    return Extreme(threshold + growth, threshold + low, threshold + high, xi, sigma, threshold)


def _growth(xi: float, n: float) -> float:
    """``(n^xi - 1) / xi``, ln n at xi = 0."""
    x = xi * math.log(n)
    return math.log(n) * (math.expm1(x) / x if x else 1.0)


def _likelihood(excess: Array, xi: float, sigma: float) -> float:
    """Log-likelihood of a generalised Pareto distribution; of what is outside of it, minus infinity."""
    z = excess / sigma
    if xi * float(z.max()) <= -1.0:
        return -math.inf
    sums = float(np.log1p(xi * z).sum()) / xi + float(np.log1p(xi * z).sum()) if xi else float(z.sum())
    return -len(excess) * math.log(sigma) - sums


def _profile(excess: Array, level: float, n: float, confidence: float) -> tuple[float, float]:
    """Levels at which the likelihood, the best over all shapes, has fallen by half a quantile of chi-squared."""

    def best(at: float) -> float:
        def loss(xi: float) -> float:
            found = -_likelihood(excess, xi, at / _growth(xi, n))
            return found if math.isfinite(found) else 1e30

        return -float(minimize_scalar(loss, bounds=SHAPES, method="bounded", options={"xatol": 1e-5}).fun)

    limit = best(level) - 0.5 * float(chi2.ppf(confidence, 1))
    ends = []
    for step in (1.0 / 1.1, 1.1):
        far = level * step
        while best(far) > limit and 1e-3 < far / level < 1e3:
            far *= step
        if best(far) > limit:  # the tail may be so heavy that the series says nothing about this end
            ends.append(0.0 if step < 1.0 else math.inf)
        else:
            ends.append(float(brentq(lambda at: best(at) - limit, level, far, rtol=1e-4)))
    return ends[0], ends[1]


def of_maxima(values: Array, periods: float, confidence: float = 0.9) -> Extreme | None:
    """Return level of maxima ``values`` (m,) of equal blocks or of runs, exceeded once in ``periods`` blocks, [N].

    ``mu - sigma / xi (1 - y^-xi)``, ``y = -ln(1 - 1/periods)`` (Coles 3.4), the generalised extreme value distribution
    (Gumbel, Frechet, Weibull) by probability-weighted moments (Hosking, Wallis and Wood 1985), which serve few maxima
    better than likelihood. The interval is a parametric bootstrap. None with fewer than `FEWEST` maxima, without
    scatter, or for ``periods <= 1``.
    """
    if len(values) < FEWEST or periods <= 1.0 or np.ptp(values) == 0.0:
        return None
    fit = tuple(float(v[0]) for v in _moments(values[None, :]))
    samples = _gev(np.random.default_rng(SEED).exponential(size=(DRAWS, len(values))), *fit)
    y = np.array([-math.log1p(-1.0 / periods)])
    xi, mu, sigma = _moments(samples)
    levels = _gev(y, xi, mu, sigma)
    low, high = np.quantile(levels, [(1.0 - confidence) / 2.0, (1.0 + confidence) / 2.0])
    return Extreme(float(_gev(y, *fit)[0]), float(low), float(high), fit[0], fit[2], fit[1])


def _moments(x: Array) -> tuple[Array, Array, Array]:
    """xi, mu and sigma (k,) of samples (k, m) by their probability-weighted moments b_0, b_1, b_2."""
    x, m = np.sort(x, axis=1), x.shape[1]
    i = np.arange(m)
    b0, b1 = x.mean(axis=1), (x * i / (m - 1)).mean(axis=1)
    b2 = (x * i * (i - 1) / ((m - 1) * (m - 2))).mean(axis=1)
    c = (2.0 * b1 - b0) / (3.0 * b2 - b0) - math.log(2.0) / math.log(3.0)
    k = 7.8590 * c + 2.9554 * c**2
    k = np.where(np.abs(k) < 1e-9, 1e-9, k)
    sigma = (2.0 * b1 - b0) * k / (gamma(1.0 + k) * (1.0 - 2.0**-k))
    return -k, b0 + sigma * (gamma(1.0 + k) - 1.0) / k, sigma


def _gev(y: Array, xi: Array | float, mu: Array | float, sigma: Array | float) -> Array:
    """Value whose probability of not being exceeded is exp(-y)."""
    return np.asarray(mu + sigma * np.expm1(-np.asarray(xi) * np.log(y)) / xi)
