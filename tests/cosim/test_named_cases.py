"""Five cases that an engineer would try first run for 20 s, with loads that design formulas do not contradict.

A bridge pier, a lighthouse and a drill barge, and two cones of the size of small structures; 5 GPa, 500 kPa, 0.3 m/s,
and the default of every key that may be left out.
"""

import numpy as np
import pytest

from cosim.analysis.lights import trust
from cosim.baselines.methods import design_loads
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario

#: breaking, slope [deg], diameter at the waterline [m], thickness [m]
CASES = {
    "upward cone": ("upward", 60, 8.0, 0.8),
    "downward cone": ("downward", 50, 20.0, 1.5),
    "bridge pier": ("upward", 52, 14.0, 1.0),
    "lighthouse": ("upward", 56, 10.0, 1.0),
    "drill barge": ("downward", 31, 70.0, 1.2),
}
TEXT = """[scenario]
title = "{name}"
duration = "20 s"
[ice]
thickness = "{h} m"
density = "900 kg/m^3"
youngs_modulus = "5 GPa"
poisson_ratio = 0.3333333333333333
flexural_strength = "500 kPa"
compressive_strength = "2.5 MPa"
[water]
density = "1025 kg/m^3"
[sheet]
length = "{length:.6f} m"
width = "{width:.6f} m"
nodes = [{nx}, {ny}]
back = "held"
sides = "held"
[structure]
kind = "cone"
breaking = "{breaking}"
slope = "{slope} deg"
waterline_radius = "{radius} m"
neck_radius = "{neck} m"
toe_depth = "{toe} m"
top = "8 m"
[contact]
model = "crushing"
strength = "2.5 MPa"
friction = 0.1
[drift]
velocity = "0.3 m/s"
"""


def text_of(name):
    """Six cells in the characteristic length, a floe of four, and one and a half on either side of the structure."""
    breaking, slope, D, h = CASES[name]
    bending = (5e9 * h**3 / (12.0 * (1.0 - 1.0 / 9.0) * 1025.0 * 9.81)) ** 0.25
    d = min(bending / 6.0, D / 4.2)
    nx, ny = round(4.0 * bending / d) + 1, 2 * round((D + 3.1 * bending) / 2.0 / d) + 1
    size = {"nx": nx, "ny": ny, "length": (nx - 1) * d, "width": (ny - 1) * d}
    shape = {"radius": D / 2, "neck": D / 4, "toe": h + (4.0 if breaking == "upward" else 6.0)}
    return TEXT.format(name=name, breaking=breaking, slope=slope, h=h, **size, **shape)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_a_named_case_runs_near_the_formula_or_says_why_not(tmp_path, name, capsys):
    """Between a fifth and five times Croasdale's, or a light that speaks against the run."""
    (tmp_path / "case.toml").write_text(text_of(name))
    scenario = load_scenario(tmp_path / "case.toml")
    result = run_scenario(scenario)
    found, design = result.peaks.to_json(), design_loads(scenario.model)["croasdale"]
    ratios = {axis: found[axis]["value"] / design[axis] for axis in ("fx", "fz")}
    told = trust(result.data)
    with capsys.disabled():
        print(f"\n{name}: {ratios['fx']:.2f} and {ratios['fz']:.2f} of Croasdale; {'; '.join(told['because'])}")
    assert result.t_ns == 20_000_000_000
    assert all(np.isfinite(ratio) for ratio in ratios.values())
    assert all(0.2 <= ratio <= 5.0 for ratio in ratios.values()) or told["because"]
