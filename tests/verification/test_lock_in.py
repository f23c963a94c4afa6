"""A tower before ice that breaks: the measure of its amplification, and one run that is coupled."""

import numpy as np
import pytest

from cosim.verify.cases import run
from cosim.verify.lock_in import PARAMETERS, answer_to, sine_amplification, tower


@pytest.mark.parametrize("ratio", [0.4, 0.8, 1.0, 1.25, 2.5])
def test_a_sine_is_amplified_as_the_formula_says(ratio):
    found, formula = sine_amplification(PARAMETERS, ratio)
    assert found == pytest.approx(formula, rel=0.02)
    twin = sine_amplification({**PARAMETERS, "damping": 0.3}, 1.0)[0]
    assert twin < 0.2 * sine_amplification(PARAMETERS, 1.0)[0]


def test_a_steady_load_gives_way_as_the_stiffness_says():
    t = np.linspace(0.02, 100.0, 5000)
    way = answer_to(tower({**PARAMETERS, "damping": 0.5, "stiffness": 1e6}, 1.0), t, np.full(len(t), 5e4))
    assert way[-1] == pytest.approx(0.05, rel=1e-9)


@pytest.mark.slow
def test_a_short_run_that_is_coupled():
    """Its books close, and it moves."""
    result = run("lock-in", quick=True)[0]
    assert result.passed
    found = {q.name: q.value for q in result.quantities}
    assert found["largest displacement"][0] > 1e-3
