"""A body of revolution of several slopes, given by heights and radii."""

import math

import pytest

from cosim.baselines.inputs import given
from cosim.build import build_structure
from cosim.scenario.errors import ScenarioError
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario

CASE = "van_vliet_2018_floe_55m_centre"
CONE = [["-20 m", "9 m"], ["-6 m", "9 m"], ["5 m", "20 m"]]  # the case's own: 45 deg, 15 m at the waterline, neck 9 m
STEEPER_BELOW = [["-20 m", "9 m"], ["-6 m", "12 m"], ["0 m", "15 m"], ["5 m", "22 m"]]


@pytest.fixture
def case(tmp_path):
    """The 55 m floe before a structure of this profile, with further lines of [structure]."""

    def load(points, *more, top="5 m", overrides=()):
        text = load_scenario(CASE).text
        before, after = text.split("[structure]")
        after = after.partition("[contact]")[2]
        section = ['kind = "profile"', f"profile = {points}", f'top = "{top}"', *more]
        file = tmp_path / "case.toml"
        file.write_text(before + "[structure]\n" + "\n".join(section) + "\n\n[contact]" + after, "utf-8")
        return load_scenario(file, overrides)

    return load


def test_a_profile_of_one_slope_and_a_neck_is_the_cone(case):
    options = ["sheet.nodes=[20, 20]", "scenario.duration='1 s'"]
    assert run_scenario(case(CONE, overrides=options)).peaks.value[0] == pytest.approx(
        run_scenario(load_scenario(CASE, options)).peaks.value[0], rel=1e-9
    )


def test_each_slope_has_its_own_normal_and_the_load_follows_the_one_that_is_met(case):
    structure = build_structure(case(STEEPER_BELOW))
    assert (structure.bottom, structure.top, structure.half_width) == (-20.0, 5.0, 15.0)
    assert structure.normal(0.0, -3.0)[2] == pytest.approx(-0.5 / math.hypot(1.0, 0.5))
    assert structure.normal(0.0, 2.0)[2] == pytest.approx(-1.4 / math.hypot(1.0, 1.4))
    options = ["sheet.nodes=[20, 20]", "scenario.duration='1 s'"]
    gentle, cone = (run_scenario(case(points, overrides=options)) for points in (STEEPER_BELOW, CONE))
    assert gentle.peaks.value[2] / gentle.peaks.value[0] > 1.2 * cone.peaks.value[2] / cone.peaks.value[0]


def test_design_formulas_take_slope_and_width_at_the_waterline(case):
    own, cone = given(case(CONE).model).case, given(load_scenario(CASE).model).case
    assert (own.a, own.w, own.D_T) == pytest.approx((cone.a, cone.w, cone.D_T), rel=1e-12)
    assert not own.wide
    assert given(case(STEEPER_BELOW).model).case.a == pytest.approx(math.atan(5.0 / 7.0))


def test_it_may_break_upwards(case):
    structure = build_structure(case([["-4 m", "9 m"], ["5 m", "3 m"]], 'breaking = "upward"'))
    assert not structure.faces_down
    with pytest.raises(ScenarioError, match="passes under the slope"):
        case([["-1 m", "9 m"], ["5 m", "3 m"]], 'breaking = "upward"')


@pytest.mark.parametrize(
    ("points", "more", "says"),
    [
        ([["5 m", "20 m"], ["-6 m", "9 m"]], "", "each higher than the one before"),
        ([["-6 m", "9 m"]], "", "needs two or more points"),
        ([["1 m", "9 m"], ["5 m", "20 m"]], "", "misses the waterline"),
        ([["-6 m", "9 m"], ["4 m", "20 m"]], "", 'ends at 4 m, the structure at 5 m; set top = "4 m"'),
        ([["-6 m", "9 m"], ["5 m", "4 m"]], "", "to break ice downward a structure widens upwards at the waterline"),
        ([["-6 m", "9 m"], ["5 m", "9 m"]], "", "to break ice downward a structure widens upwards at the waterline"),
        (CONE, 'breaking = "upward"', "to break ice upward a structure narrows upwards at the waterline"),
        (CONE, 'toe_depth = "8 m"', "structure.toe_depth = '8 m': the profile begins at -20 m; remove the key"),
        (CONE, 'slope = "45 deg"', "structure.slope = '45 deg': a profile has none"),
        ([["-6 m", "-1 m"], ["5 m", "9 m"]], "", "must not be negative"),
        ([["-6 m", "1 m", "2 m"], ["5 m", "9 m"]], "", "write 2 values in brackets"),
    ],
)
def test_faults(case, points, more, says):
    with pytest.raises(ScenarioError) as error:
        case(points, more)
    assert says in str(error.value)


def test_other_kinds_need_their_slope_and_no_profile(tmp_path):
    text = load_scenario(CASE).text
    file = tmp_path / "case.toml"
    file.write_text("".join(line for line in text.splitlines(True) if not line.startswith("slope")), "utf-8")
    with pytest.raises(ScenarioError, match=r'structure.slope: missing; a cone needs it, for example slope = "45 deg"'):
        load_scenario(file)
    with pytest.raises(ScenarioError, match=r"structure\.profile = .*: a cone has none"):
        load_scenario(CASE, [f"structure.profile={CONE}"])
