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
    way = answer_to(tower({**PARAMETERS, "damping": 0.5}, 1.0), t, np.full(len(t), 5e4))
    assert way[-1] == pytest.approx(0.05, rel=1e-9)


@pytest.mark.slow
def test_a_stiff_tower_answers_as_to_the_load_of_a_cone_that_rests():
    """What it gives way by is small against the pieces: coupled and not agree; a soft one, the twin, does not."""

    def pair(stiffness):
        settings = {"stiffness": stiffness, "ratios": [2.0], "seconds": 4.0, "skip": 0.5, "rubble": False}
        result = run("lock-in", settings)[0]
        assert result.passed
        found = {q.name: q.value for q in result.quantities}
        return found["its amplification"][0], found["the same under the load at rest"][0]

    coupled, alone = pair(1e9)
    assert coupled == pytest.approx(alone, rel=0.02)
    coupled, alone = pair(2e5)
    assert abs(coupled / alone - 1.0) > 0.02
