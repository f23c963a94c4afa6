"""Metrics of series on known answers: peaks, periods, spectra, extremes, rainflow of ASTM E1049, errors."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.stats import genextreme, genpareto, norm

from cosim.series import agreement, extremes, fatigue, peaks, spectra
from cosim.series.align import contact_time, correlations
from cosim.series.description import Metrics
from cosim.series.metrics import look

T = 0.01 * np.arange(20001)
#: ASTM E1049-85 (2017), Figure 6: peaks and valleys, and the table of its rainflow count
ASTM = np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
ASTM_COUNT = {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}


def count_by_range(y):
    ranges, _, counts = fatigue.cycles(y)
    return {float(r): float(counts[ranges == r].sum()) for r in np.unique(ranges)}


def test_rainflow_of_the_norm():
    assert count_by_range(ASTM) == ASTM_COUNT


def test_another_count_than_rainflow_is_not_that_of_the_norm():
    """Ranges between neighbouring extremes, each a half cycle (E1049, 5.3): the wrong twin."""
    ranges = np.abs(np.diff(ASTM))
    assert {float(r): 0.5 * float((ranges == r).sum()) for r in np.unique(ranges)} != ASTM_COUNT


def test_rainflow_does_not_see_what_lies_between_extremes():
    fine = np.interp(np.linspace(0, 8, 801), np.arange(9), ASTM)
    assert count_by_range(np.round(fine, 9)) == ASTM_COUNT


@pytest.mark.parametrize("m", [1.0, 4.0, 12.0])
def test_damage_equivalent_load_of_one_sine_and_of_the_norm(m):
    sine = 5.0 * np.sin(2 * math.pi * T[: 100 * 100 + 1])  # 100 s of 1 Hz: 100 cycles of range 10
    assert fatigue.damage_equivalent_load(sine, 100.0, m, 1.0) == pytest.approx(10.0, rel=0.01)
    known = (sum(n * r**m for r, n in ASTM_COUNT.items()) / 100.0) ** (1.0 / m)
    assert fatigue.damage_equivalent_load(ASTM, 50.0, m, 2.0) == pytest.approx(known, rel=1e-12)
    assert fatigue.damage_equivalent_load(np.ones(50), 1.0, m, 1.0) is None


def test_small_cycles_are_not_counted():
    assert fatigue.cycle_rate(ASTM, 10.0, 0.0) == pytest.approx(0.4, rel=1e-12)
    assert fatigue.cycle_rate(ASTM, 10.0, 5.0) == pytest.approx(0.2, rel=1e-12)


def test_spectrum_of_a_known_sum():
    """Sines of 3 and 1 at 0.5 and 2 Hz: lines there, variances 4.5 and 0.5, nothing else."""
    y = 7.0 + 3.0 * np.sin(2 * math.pi * 0.5 * T) + np.sin(2 * math.pi * 2.0 * T + 1.0)
    f, density = spectra.spectrum(T, y)
    df = f[1] - f[0]
    assert density.sum() * df == pytest.approx(5.0, rel=0.01)
    for line, variance in ((0.5, 4.5), (2.0, 0.5)):
        near = np.abs(f - line) < 0.2
        assert density[near].sum() * df == pytest.approx(variance, rel=0.01)
        assert f[near][density[near].argmax()] == pytest.approx(line, abs=df)


def test_spectrum_of_white_noise_is_flat():
    """White noise of variance 4 at 100 Hz: 4 / 50 Hz = 0.08 everywhere."""
    _, density = spectra.spectrum(T, 2.0 * np.random.default_rng(1).standard_normal(len(T)), segments=100)
    halves = np.array_split(density[1:-1], 2)
    assert [h.mean() for h in halves] == pytest.approx([0.08, 0.08], rel=0.03)


@pytest.mark.parametrize("period", [0.8, 4.0, 23.0])
def test_periods_by_spectrum_counting_and_crossing(period):
    y = 5.0 + 0.02 * T + 3.0 * np.sin(2 * math.pi * T / period)
    assert spectra.period_by_spectrum(T, y) == pytest.approx(period, rel=0.01)
    assert peaks.period_by_counting(T, peaks.peaks(y, 1.0, 1.0)) == pytest.approx(period, rel=0.01)
    level = y - 0.02 * T
    assert peaks.period_by_crossing(T, level) == pytest.approx(period, rel=0.01)


def test_a_series_without_period_has_none():
    assert spectra.period_by_spectrum(T, np.sqrt(T)) is None
    assert spectra.period_by_spectrum(T, np.ones(len(T))) is None
    assert peaks.period_by_crossing(T, T) is None


def test_peaks_stand_above_a_threshold_and_out():
    y = np.interp(T, [0, 10, 20, 25, 30, 40, 50, 60, 70], [0, 10, 2, 2.5, 2, 8, 7.5, 9, 0])
    at = peaks.peaks(y, above=1.0, prominence=1.0)
    assert T[at].tolist() == pytest.approx([10.0, 60.0], abs=0.011)  # 8 stands out of 7.5 by 0.5 only
    assert T[peaks.peaks(y, 1.0, 0.1)].tolist() == pytest.approx([10.0, 25.0, 40.0, 60.0], abs=0.011)
    assert T[peaks.peaks(y, 5.0, 0.1)].tolist() == pytest.approx([10.0, 40.0, 60.0], abs=0.011)
    assert peaks.level_between(y, at) == pytest.approx(2.0, rel=1e-9)
    assert peaks.mean_peak(y, at) == pytest.approx(9.5, rel=1e-9)
    assert peaks.time_to_first_peak(T, at, 3.0) == pytest.approx(7.0, rel=1e-9)
    assert peaks.level_between(y, at[:1]) is None


def test_exceedance_is_weibull_s_plotting_position():
    height, share = peaks.exceedance(np.array([3.0, 1.0, 2.0]))
    assert height.tolist() == [1.0, 2.0, 3.0]
    assert share.tolist() == [0.75, 0.5, 0.25]


@pytest.mark.parametrize("xi", [-0.2, 0.0, 0.2])
def test_return_level_of_maxima_of_a_known_distribution(xi):
    """2000 maxima of a known GEV: level of 100 blocks within the interval and within 5 %."""
    known = genextreme(-xi, 10.0, 2.0)
    found = extremes.of_maxima(known.rvs(2000, random_state=3), 100.0)
    true = known.isf(0.01)
    assert found.level == pytest.approx(true, rel=0.05)
    assert found.low < true < found.high
    assert found.shape == pytest.approx(xi, abs=0.05)


@pytest.mark.parametrize("xi", [-0.2, 0.0, 0.2])
def test_return_level_of_peaks_of_a_known_distribution(xi):
    """2000 peaks of a known Pareto tail over 5, one in 10 s: level of a day within 3 of its standard errors."""
    known = genpareto(xi, 5.0, 2.0)
    found = extremes.of_peaks(known.rvs(2000, random_state=5), 5.0, 0.1, 86400.0)
    true = known.isf(1.0 / 8640.0)
    error = (found.high - found.low) / (2.0 * norm.ppf(0.95))
    assert abs(found.level - true) < 3.0 * error
    assert error < 0.15 * true
    assert found.shape == pytest.approx(xi, abs=3.0 * (1.0 + xi) / math.sqrt(2000.0))


@pytest.mark.parametrize(("n", "xi", "trials"), [(30, 0.0, 200), (200, -0.1, 60)])
def test_the_interval_of_a_return_level_covers_as_often_as_it_says(n, xi, trials):
    """An interval of 90 % holds the true level in 90 % of the samples, within 3 standard errors of that count."""
    known = genpareto(xi, 0.0, 2.0)
    true, hits = known.isf(1e-3), 0
    for seed in range(trials):
        found = extremes.of_peaks(known.rvs(n, random_state=seed), 0.0, 1.0, 1000.0)
        hits += found.low < true < found.high
    assert hits / trials == pytest.approx(0.9, abs=3.0 * math.sqrt(0.9 * 0.1 / trials))


def test_the_interval_of_maxima_covers_as_often_as_it_says():
    known = genextreme(0.0, 10.0, 2.0)
    true, hits = known.isf(0.01), 0
    for seed in range(100):
        found = extremes.of_maxima(known.rvs(100, random_state=seed), 100.0)
        hits += found.low < true < found.high
    assert hits / 100 == pytest.approx(0.9, abs=0.09)


def test_few_peaks_have_no_return_level():
    assert extremes.of_peaks(np.ones(9) + 5.0, 5.0, 0.1, 1e4) is None
    assert extremes.of_peaks(np.ones(20) + 5.0, 5.0, 0.1, 1.0) is None
    assert extremes.of_maxima(np.ones(9), 100.0) is None


def test_error_measures_of_known_pairs():
    m = np.array([1.0, 2.0, 3.0, 4.0])
    s = np.array([1.5, 2.5, 3.5, 4.5])
    assert agreement.bias(s, m) == pytest.approx(0.5)
    assert agreement.rms_error(s, m) == pytest.approx(0.5)
    assert agreement.mean_absolute_error(s, m) == pytest.approx(0.5)
    assert agreement.scatter_index(s, m) == pytest.approx(0.0, abs=1e-12)
    assert agreement.correlation(s, m) == pytest.approx(1.0)
    assert agreement.efficiency(s, m) == pytest.approx(1.0 - 1.0 / 5.0)
    spread = sum((abs(a - 2.5) + abs(b - 2.5)) ** 2 for a, b in zip(s, m, strict=True))
    assert agreement.index_of_agreement(s, m) == pytest.approx(1.0 - 1.0 / spread)
    assert agreement.slope(2.0 * m, m) == pytest.approx(2.0)
    assert agreement.wasserstein(s, m) == pytest.approx(0.5)
    assert agreement.kolmogorov_smirnov(s, m) == pytest.approx(0.25)
    assert agreement.efficiency(s, np.ones(4)) is None
    assert agreement.correlation(s, np.ones(4)) is None


def test_distances_of_normal_distributions():
    """Shifted by one standard deviation: Wasserstein 1, Kolmogorov-Smirnov 2 Phi(1/2) - 1 = 0.3829."""
    random = np.random.default_rng(2)
    s, m = random.standard_normal(40000) + 1.0, random.standard_normal(40000)
    assert agreement.wasserstein(s, m) == pytest.approx(1.0, abs=0.02)
    assert agreement.kolmogorov_smirnov(s, m) == pytest.approx(2 * norm.cdf(0.5) - 1, abs=0.01)


def test_correlations_are_pearson_s_of_every_overlap():
    random = np.random.default_rng(4)
    x, y = random.standard_normal(50), random.standard_normal(70) + 100.0
    lags, r = correlations(x, y, 25)
    for lag, value in zip(lags.astype(int), r, strict=True):
        a = slice(max(0, -lag), min(50, 70 - lag))
        b = slice(a.start + lag, a.stop + lag)
        assert value == pytest.approx(np.corrcoef(x[a], y[b])[0, 1], abs=1e-9)
    assert len(lags) == 70 + 50 - 1 - 2 * 24


def test_contact_is_where_the_load_passes_the_threshold():
    t = np.arange(0.0, 10.0, 0.5)
    assert contact_time(t, np.maximum(t - 4.2, 0.0), 0.1) == pytest.approx(4.2 + 0.1 * (9.5 - 4.2), abs=1e-9)


def test_the_random_load_of_a_filter_has_its_mean_crossing_period():
    """AR(2) noise: the mean period of a Gaussian process is by its correlation at one step, pi / arcsin-law."""
    y = lfilter([1.0], [1.0, -1.6, 0.9], np.random.default_rng(7).standard_normal(400_000))
    r = np.corrcoef(y[:-1], y[1:])[0, 1]
    expected = 2.0 * math.pi / math.acos(r)  # steps; Rice 1944 for a series in steps: acos(r) / pi crossings a step
    assert peaks.period_by_crossing(np.arange(len(y), dtype=float), y) == pytest.approx(expected, rel=0.01)


def test_the_return_level_is_that_of_the_highest_peaks():
    """Peaks of 7 and more, exponential by 0.3, over a level of 3: the hour is 7 + 0.3 ln(rate period), not a tail of 3.

    The wrong twin fits all that counts as a peak, from a tenth of the largest load on.
    """
    heights = 7.0 + np.random.default_rng(8).exponential(0.3, 120)
    t = np.arange(0.0, 600.0, 0.05)
    y = np.interp(t, 2.5 * np.arange(240), np.stack((np.full(120, 3.0), heights), axis=1).ravel())
    given = Metrics.model_validate({})
    seen = look(t, y, float(y.max()), 0.05, given)
    assert len(seen.peaks) == 119  # the last one is the end of the record
    found, true = seen.extreme, 7.0 + 0.3 * math.log(3600.0 / 5.0)
    assert found.low < true < found.high
    assert found.level == pytest.approx(true, rel=0.1)
    wrong = extremes.of_peaks(y[seen.peaks][:40], seen.threshold, 0.2, 3600.0)
    assert wrong.low > 2.0 * true
