"""Rows that are remembered by number are found again when numbers have come and gone."""

import numpy as np

from rubble.arrays import Known


def test_rows_are_found_by_their_number_and_filled_where_it_is_new():
    known = Known(np.array([2, 5, 9]), np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]))
    found = known.of(np.array([0, 5, 7, 9, 12]), -1.0)
    assert found.tolist() == [[-1.0, -1.0], [3.0, 4.0], [-1.0, -1.0], [5.0, 6.0], [-1.0, -1.0]]
    assert known.of(np.zeros(0, np.int64), 0.0).shape == (0, 2)


def test_nothing_known_fills_all():
    none = Known(np.zeros(0, np.int64), np.zeros((0, 2, 3)))
    assert (none.of(np.array([1, 4]), 0.5) == np.full((2, 2, 3), 0.5)).all()
