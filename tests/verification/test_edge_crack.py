"""LEFM reference of the edge-cracked plate: finite elements, energy release rate."""

from __future__ import annotations

import numpy as np
import pytest

from lattice.edge_crack import mouth_compliance, normalised_load


def test_two_extrapolations_agree() -> None:
    ratio = np.arange(0.2, 0.71, 0.1)
    assert normalised_load(ratio, 60) == pytest.approx(normalised_load(ratio, 120), rel=5e-3)


def test_the_error_without_extrapolation_is_of_first_order() -> None:
    """Three meshes, each twice as fine; two-sided, because a wrong release rate would not converge at all."""
    slopes = []
    for n in (30, 60, 120):
        delta = mouth_compliance(n)
        a = n * 2 // 5 - 1  # index of the crack of 0.4 L
        slopes.append(0.5 * n * (delta[a + 1] - delta[a - 1]))
    order = np.log2((slopes[1] - slopes[0]) / (slopes[2] - slopes[1]))
    assert 0.8 < order < 1.2


def test_a_ligament_in_bending_and_tension() -> None:
    """A deep crack leaves a ligament b = L - a under the moment F (a + b/2).

    Its intensity is 3.975 M / (t b^1.5) (Tada, Paris and Irwin, handbook, deep edge crack in bending), so the
    normalised load falls as b^1.5.
    """
    b = np.array([0.14, 0.2])
    load = normalised_load(1.0 - b, 100)
    assert 1.3 < np.log(load[1] / load[0]) / np.log(b[1] / b[0]) < 1.9
    leading = b**1.5 / (3.975 * (1.0 - 0.5 * b))
    assert load == pytest.approx(leading, rel=0.05)


@pytest.mark.parametrize("ratio", [0.01, 0.95])
def test_a_crack_outside_the_reference_is_refused(ratio: float) -> None:
    with pytest.raises(ValueError, match="leave the range"):
        normalised_load(np.array([ratio]))
