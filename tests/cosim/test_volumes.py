"""Rubble over time."""

import pytest

from cosim.analysis.volumes import POINTS, volumes
from coupling.interface import NS


def test_a_steady_feed_that_is_cleared():
    """7 t/s come in, 5 t/s leave: volumes grow at these rates over the density."""
    t = [k * NS for k in range(1, 901)]
    stored, cleared = [2e3 * k + 1e6 for k in range(1, 901)], [5e3 * k for k in range(1, 901)]
    found = volumes(t, stored, cleared, 900.0)
    assert len(found["time"]) == POINTS
    assert found["feed_rate"] == pytest.approx(7e3, rel=1e-9)
    assert found["clearing_rate"] == pytest.approx(5e3, rel=1e-9)
    assert found["fed"][-1] == pytest.approx((7e3 * 900 + 1e6) / 900.0, rel=1e-12)
    for fed, there, gone in zip(found["fed"], found["stored"], found["cleared"], strict=True):
        assert fed == pytest.approx(there + gone, rel=1e-12)


def test_no_windows_no_volumes():
    assert volumes([], [], [], 900.0) == {}
