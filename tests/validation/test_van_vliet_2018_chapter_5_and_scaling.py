"""van Vliet (2018), chapter 5 (L-beam) and Appendix 4 (scaling)."""

from __future__ import annotations

import numpy as np

from cosim.verify.cases import run
from cosim.verify.froude import PARAMETERS, simulate


def failures(case: str) -> list[tuple[str, object]]:
    (result,) = run(case, quick=True)
    return [(q.name, q.value) for q in result.quantities if q.passed is False]


def test_table_5_1_and_figures_5_2_to_5_4_l_beam() -> None:
    assert failures("l-beam") == []


def test_corner_b_has_the_same_strain_in_three_rows() -> None:
    """Section 5.2: near corner B (the side to which the L turns) the first three rows are strained alike."""
    (result,) = run("l-beam")
    rows = np.array(next(q.value for q in result.quantities if q.name.startswith("bending utilisation (5.1)")))
    near_b, near_a = rows[:, 8:10], rows[:, :1]
    assert (near_b.max(axis=0) / near_b.min(axis=0)).max() < 1.3 < near_a.max() / near_a.min()


def test_appendix_4_froude_scaling() -> None:
    assert failures("froude") == []


def test_a_scale_with_the_wrong_modulus_is_seen() -> None:
    """The wrong twin: full-scale modulus in the model (Table A4-1 scales it with length)."""
    short = {**PARAMETERS, "time": 0.08, "steps": 1600}
    small = simulate({**short, "E": 2.0 * short["E"]}, 1.0 / 36.0)
    large = simulate(short, 1.0)
    assert np.abs(small[0] - large[0]).max() > 0.01 * np.abs(large[0]).max()
