"""A tower before ice that breaks: the measure of its amplification, and one run that is coupled."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from cosim.verify.cases import run
from cosim.verify.lock_in import DENSE, PARAMETERS, Answer, Draw, answer_to, sine_amplification, tower
from cosim.verify.lock_in_figure import draw, ratio_of, told


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
    assert np.min(found["largest displacement"]) > 1e-3  # of every draw, at every ratio


def two_draws():
    """Loads of 10 N at rest in the one, of 20 N in the other; three ratios, the last without two peaks in one draw."""
    draws = []
    for size, breaks in ((10.0, (0.2, 0.4, 0.0)), (20.0, (0.3, 0.6, 0.9))):
        still = Answer(0.0, 0.0, size, 2.0 * size, size, 0.25)
        found = [Answer(k * size, 3.0 * size, size, 4.0 * size, size, b) for k, b in enumerate(breaks, 1)]
        draws.append(Draw(still, found, np.ones((3, 2)), np.column_stack((DENSE, DENSE, DENSE))))
    return draws


def test_amplifications_are_over_the_cone_at_rest_in_the_same_ice():
    draws = two_draws()
    assert ratio_of(draws, "deviation", "load_deviation").tolist() == [[1.0, 2.0, 3.0]] * 2
    assert ratio_of(draws, "load_largest").tolist() == [[2.0] * 3] * 2
    assert told(draws, "breaking").tolist() == [[0.2, 0.4, 0.0], [0.3, 0.6, 0.9]]


def test_the_figure_has_median_and_range_of_the_draws():
    figure = Figure()
    draw(figure, {**PARAMETERS, "ratios": [0.5, 1.0, 2.0], "stiffness": 1.0}, 0.25, two_draws())
    ways, loads, breaks = figure.axes
    bars = [c.lines for c in (*ways.containers, *loads.containers, *breaks.containers)]
    middles = [line.get_ydata().tolist() for line, _, _ in bars]
    assert middles == [[1.0, 2.0, 3.0], [1.5] * 3, [1.0] * 3, [2.0] * 3, pytest.approx([1.0, 2.0, 3.6])]
    _, _, (last,) = bars[-1]
    spans = [segment[:, 1].tolist() for segment in last.get_segments()]
    assert spans == [pytest.approx(span) for span in ([0.8, 1.2], [1.6, 2.4], [3.6, 3.6])]
