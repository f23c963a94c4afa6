"""Means over half a second: what lasts is kept, what lasts for a window is spread, whatever the windows."""

import numpy as np
import pytest

from cosim.analysis.sustained import running_mean

NS = 1_000_000_000


def windows(*lengths):
    end = np.cumsum([round(x * NS) for x in lengths])
    return np.concatenate(([0], end[:-1])), end


def test_a_steady_load_stays_and_builds_up_from_nothing():
    begin, end = windows(*[0.1] * 20)
    mean = running_mean(begin, end, np.full((20, 3, 3), 7.0), 0.5)
    assert mean[4:] == pytest.approx(7.0, rel=1e-12)
    assert mean[:5, 0, 0] == pytest.approx(7.0 * np.arange(1, 6) / 5, rel=1e-12)


@pytest.mark.parametrize("length", [0.025, 0.05, 0.1])
def test_an_impulse_counts_the_same_in_windows_of_any_length(length):
    n = round(2.0 / length)
    load = np.zeros((n, 1))
    load[n // 2] = 3.0 / length
    assert running_mean(*windows(*[length] * n), load, 0.5).max() == pytest.approx(6.0, rel=1e-9)


def test_windows_of_different_length_are_weighted_with_it():
    mean = running_mean(*windows(0.5, 0.1, 0.4, 0.2), np.array([[1.0], [11.0], [1.0], [6.0]]), 0.5)
    assert mean[:, 0] == pytest.approx([1.0, 3.0, 3.0, 3.0], rel=1e-12)
