"""Levels and cycles of a load on a signal whose figures are known in closed form."""

import numpy as np
import pytest

from cosim.analysis.levels import load_mean, load_quantile, peak_interval, peak_quantile, trough_load
from cosim.analysis.run_data import RunData
from coupling.interface import NS

DT, PERIOD, START = 0.05, 4.0, 2.0


def saw(lengths=None):
    """From 2 s on a triangle between 1 and 5 MN with a period of 4 s, for 40 s; before it nothing."""
    t = DT * np.arange(1, round((START + 10 * PERIOD) / DT) + 1) if lengths is None else np.cumsum(lengths)
    phase = np.mod(t - START, PERIOD) / PERIOD
    load = np.zeros((len(t), 3, 3))
    load[:, 0, 0] = np.where(t > START + 1e-9, 1e6 + 4e6 * (1.0 - np.abs(2.0 * phase - 1.0)), 0.0)
    return RunData("x", {"window_ns": str(round(DT * NS))}, np.rint(t * NS).astype(int), load)


def test_mean_and_quantiles_of_a_triangle():
    run = saw()
    assert load_mean(run) == pytest.approx(3e6, rel=1e-9)
    assert load_mean(run, end=PERIOD / 2) == pytest.approx(3e6, rel=0.02)
    assert load_mean(run, end=PERIOD / 4) == pytest.approx(2e6, rel=0.03)
    for share in (0.1, 0.5, 0.9):  # heights of a triangle are spread evenly
        assert load_quantile(run, share) == pytest.approx(1e6 + 4e6 * share, rel=0.05)


def test_times_count_from_first_contact_and_a_short_run_has_no_late_level():
    run = saw()
    early = load_quantile(run, 1.0, end=1.0)
    assert early == pytest.approx(3e6, rel=0.02)  # 1 s after contact, not 1 s after the start
    assert load_mean(run, begin=150.0) is None
    assert load_quantile(run, begin=150.0) is None
    assert peak_quantile(run, begin=150.0) is None


def test_quantiles_are_of_time_not_of_windows():
    """Windows of a tenth of the length while the load is low: counted by number they would pull the quantile down."""
    lengths = np.concatenate([np.full(40, DT), np.tile(np.r_[np.full(200, DT / 10), np.full(60, DT)], 10)])
    run = saw(lengths)
    by_number = float(np.quantile(run.component("fx")[run.t > START + 1e-9], 0.5))
    assert load_quantile(run, 0.5) == pytest.approx(3e6, rel=0.05)
    assert by_number < 0.85 * 3e6


def test_peaks_troughs_and_intervals():
    run = saw()
    assert peak_quantile(run) == pytest.approx(5e6, rel=0.03)
    assert trough_load(run) == pytest.approx(1e6, rel=0.1)
    assert peak_interval(run) == pytest.approx(PERIOD, abs=DT)
    assert peak_interval(run, share=0.95) == pytest.approx(PERIOD, abs=DT)
    flat = RunData("x", run.metadata, run.t_ns, np.full_like(run.load, 1e6))
    assert peak_quantile(flat) is None
    assert trough_load(flat) is None
    assert peak_interval(flat) is None
