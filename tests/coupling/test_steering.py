"""Windows steered by the power residual: rungs of a ladder in whole sub-steps, and books that close."""

import numpy as np
import pytest

from coupling.power import PowerBooks
from coupling.steering import ByPower, fixed

MS = 1_000_000
STEER = ByPower(50 * MS, 5 * MS, 200 * MS, 5 * MS, 0.1)


def power(error):
    books = PowerBooks()
    books.error = error
    return books


def test_the_ladder_halves_and_doubles_in_whole_sub_steps():
    assert STEER.ladder == [5 * MS, 10 * MS, 25 * MS, 50 * MS, 100 * MS, 200 * MS]
    assert ByPower(50 * MS, 20 * MS, 120 * MS, 5 * MS, 0.1).ladder == [25 * MS, 50 * MS, 100 * MS]


@pytest.mark.parametrize(
    ("window", "error", "jump", "then"),
    [
        (50, 0.2, False, 25),
        (50, 0.05, False, 50),
        (50, 0.01, False, 100),
        (50, 0.0, False, 100),
        (200, 0.0, False, 200),
        (5, 0.9, False, 5),
        (200, 0.9, True, 50),
        (10, 0.9, True, 10),
    ],
)
def test_next_window(window, error, jump, then):
    assert STEER(window * MS, power(error), jump) == then * MS
    assert fixed(window * MS, power(error), jump) == window * MS


def test_power_books():
    books = PowerBooks()
    assert books.close_window(0.0, 0.0, 0.1)["power_error"] == 0.0
    first = books.close_window(100.0, 80.0, 0.1)
    assert (first["power_residual"], first["power_error"]) == pytest.approx((20.0, 0.2))
    faint = books.close_window(1.0, -1.0, 0.1)  # edges that barely touch: against the mean of 50.5 W
    assert faint["power_error"] == pytest.approx(2.0 / 50.5)
    assert faint["interface_lost"] == pytest.approx(0.1 * (20.0 + 2.0))
    assert np.isfinite(list(faint.values())).all()
