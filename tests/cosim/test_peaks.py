"""Largest loads: by magnitude, with their sign."""

import numpy as np
import pytest

from cosim.analysis.peaks import at_peak, peaks, shares_at_peak
from cosim.analysis.run_data import RunData
from coupling.interface import PHASES

#: pressed down at 2 s, lifted less at 3 s; (windows, phases, components) [N]
LOAD = np.array(
    [
        [[1.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[3.0, 0.0, -8.0], [1.0, 0.0, -1.0], [0.0, 0.0, 2.0]],
        [[6.0, 0.0, 4.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]],
        [[0.0, 1.0, -2.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
    ]
)
RUN = RunData("run", {"window_ns": "1000000000", "averaging_s": "0"}, np.arange(1, 5) * 1_000_000_000, LOAD)


def test_a_structure_that_is_pressed_down_has_its_peak_below_zero():
    assert at_peak(RUN, "fz") == 1
    found = peaks(RUN)
    assert found["fz"] == {"value": -7.0, "time": 2.0}
    assert found["fx"] == {"value": 5.0, "time": 3.0}
    assert found["fy"] == {"value": 1.0, "time": 4.0}
    assert found["f"] == {"value": pytest.approx(np.hypot(4.0, 7.0), rel=1e-12), "time": 2.0}


def test_the_same_for_one_phase():
    assert peaks(RUN, "breaking")["fz"] == {"value": -8.0, "time": 2.0}
    assert peaks(RUN, "sliding")["fx"] == {"value": -1.0, "time": 3.0}


def test_a_run_that_lifts_has_a_positive_peak_and_its_mirror_a_negative_one():
    for sign in (1.0, -1.0):
        run = RunData("run", RUN.metadata, RUN.t_ns, sign * LOAD)
        assert peaks(run)["fz"]["value"] == -7.0 * sign
        assert peaks(run)["f"]["value"] > 0.0


def test_the_phases_share_the_peak():
    found = shares_at_peak(RUN)
    assert (found["fz"]["value"], found["fz"]["time"]) == (-7.0, 2.0)
    assert list(found["fz"]["phases"].values()) == [-8.0, -1.0, 2.0]
    assert list(found["fz"]["shares"]) == list(PHASES)
    assert list(found["fz"]["shares"].values()) == pytest.approx([8 / 7, 1 / 7, -2 / 7], rel=1e-12)
    f = found["f"]
    assert sum(f["phases"].values()) == pytest.approx(f["value"], rel=1e-12)
    assert f["phases"]["breaking"] == pytest.approx((3.0 * 4.0 + 8.0 * 7.0) / 65.0**0.5, rel=1e-12)


def test_a_run_without_load_or_windows_has_no_shares():
    still = RunData("run", RUN.metadata, RUN.t_ns, np.zeros_like(LOAD))
    assert shares_at_peak(still)["f"]["shares"] == dict.fromkeys(PHASES, 0.0)
    empty = RunData("run", RUN.metadata, RUN.t_ns[:0], LOAD[:0])
    assert shares_at_peak(empty) == {}
    assert at_peak(empty) is None
