"""Fields of varying ice: their statistics, their files, and that a field without variation changes not one bit."""

import tomllib

import numpy as np
import pytest
from scipy import stats

from cosim.build import build
from cosim.errors import InputError
from cosim.ice.fields import drawn, from_file, gaussian, middles, seed_of, varied, weibull_shape
from cosim.scenario.loading import load_scenario
from cosim.scenario.variation import FieldSection
from cosim.simulation import run_scenario
from lattice.grid import Grid

GRID = Grid(41, 31, 2.0)  # 80 m x 60 m
XY = middles(GRID)
CASE = "first_cone"
CLOSING, OPEN = ("fracture.cracks=closing",), ("fracture.cracks=open",)


def field(**keys):
    return FieldSection.model_validate(keys | {"correlation_length": f"{keys.pop('length', 0)} m"})


# ---- what is drawn -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("distribution", ["lognormal", "normal", "weibull"])
@pytest.mark.parametrize("length", [0.0, 6.0])
def test_mean_and_variation_over_many_draws(distribution, length):
    """Of all cells of 40 sheets; the mean of correlated cells is as uncertain as that of the patches they form."""
    f = field(variation=0.2, distribution=distribution, length=length)
    values = np.array([drawn("f", f, XY, seed) for seed in range(40)])
    patches = values.size / max(1.0, 2 * np.pi * (length / GRID.d) ** 2)
    assert values.mean() == pytest.approx(1.0, abs=4 * 0.2 / np.sqrt(patches))
    assert values.std() == pytest.approx(0.2, rel=4 * 1.5 / np.sqrt(2 * patches))


@pytest.mark.parametrize(
    ("distribution", "of"),
    [
        ("lognormal", stats.lognorm(np.sqrt(np.log(1.09)), scale=1 / np.sqrt(1.09))),
        ("normal", stats.norm(1.0, 0.3)),
        ("weibull", stats.weibull_min(weibull_shape(0.3), scale=1 / stats.weibull_min(weibull_shape(0.3)).mean())),
    ],
)
def test_values_follow_their_distribution_and_no_other(distribution, of):
    values = drawn("f", field(variation=0.3, distribution=distribution), XY, 5)
    assert stats.kstest(values, of.cdf).pvalue > 0.01
    assert (of.mean(), of.std()) == pytest.approx((1.0, 0.3), rel=1e-9)
    assert stats.kstest(values, stats.uniform(0.4, 1.2).cdf).pvalue < 1e-6


@pytest.mark.parametrize(("kind", "at_length"), [("exponential", np.exp(-1.0)), ("gaussian", np.exp(-np.pi / 4))])
def test_the_correlation_falls_as_it_says(kind, at_length):
    """Between cells 5 apart along x and along y, 10 m, the correlation length; beside each other it is high."""
    f, draws = field(variation=0.2, correlation=kind, length=10.0), 300
    z = np.array([gaussian(f, XY, seed) for seed in range(draws)]).reshape(draws, 40, 30)
    patches = draws * 80.0 * 60.0 / (2 * np.pi * 10.0**2)
    for a, b in ((z[:, :-5], z[:, 5:]), (z[:, :, :-5], z[:, :, 5:])):
        assert (a * b).mean() == pytest.approx(at_length, abs=4 * np.sqrt((1 + at_length**2) / patches))
    assert (z[:, :-1] * z[:, 1:]).mean() > 0.75
    alone = np.array([gaussian(field(variation=0.2), XY, seed) for seed in range(60)]).reshape(60, 40, 30)
    assert abs((alone[:, :-1] * alone[:, 1:]).mean()) < 0.02


def test_draws_are_the_same_again_and_others_for_another_seed_or_quantity():
    f = field(variation=0.2, length=8.0)
    assert (drawn("f", f, XY, 7) == drawn("f", f, XY, 7)).all()
    assert (drawn("f", f, XY, 7) != drawn("f", f, XY, 8)).all()
    assert len({seed_of(seed, k) for seed in range(100) for k in range(3)}) == 300


def test_a_normal_distribution_that_is_too_wide_is_refused():
    with pytest.raises(InputError, match="use lognormal or weibull"):
        drawn("ice.strength_field", field(variation=0.5, distribution="normal"), XY, 1)


# ---- files ---------------------------------------------------------------------------------------------------------


def write(path, rows, head="x,y,strength"):
    path.write_text("\n".join([head, *(",".join(map(repr, row)) for row in rows)]) + "\n")
    return path


def test_a_file_is_linear_between_its_points(tmp_path):
    corners = [(x, y, 1.0 + 0.01 * x - 0.002 * y) for x in (0.0, 80.0) for y in (0.0, 60.0)]
    found = from_file(write(tmp_path / "f.csv", corners), "strength", XY, GRID.d)
    assert found == pytest.approx(1.0 + 0.01 * XY[:, 0] - 0.002 * XY[:, 1], rel=1e-12)
    cells = [(x, y, 0.5 + x * y) for x, y in XY.tolist()]
    assert from_file(write(tmp_path / "g.csv", cells), "strength", XY, GRID.d) == pytest.approx(0.5 + XY.prod(axis=1))


@pytest.mark.parametrize(
    ("rows", "head", "says"),
    [
        ([(0.0, 0.0, 1.0)], "x,y,thickness", "has no column strength"),
        ([(0.0, 0.0, 1.0), (1.0, 0.0, 1.0)], "x,y,strength", "span no area"),
        ([(0.0, 0.0, 1.0), (80.0, 0.0, 1.0), (0.0, 60.0, 1.0)], "x,y,strength", "lie outside of its points"),
        ([(0.0, 0.0, 1.0), (80.0, 0.0, -1.0), (0.0, 60.0, 1.0)], "x,y,strength", "row 2 has strength = -1"),
        ([(0.0, 0.0, "a"), (80.0, 0.0, 1.0)], "x,y,strength", "no number"),
        ([], "x,y,strength", "holds no row"),
    ],
)
def test_a_wrong_file_is_one_line(tmp_path, rows, head, says):
    with pytest.raises(InputError, match=says) as error:
        from_file(write(tmp_path / "f.csv", rows, head), "strength", XY, GRID.d)
    assert "\n" not in str(error.value)
    with pytest.raises(InputError, match="no such file"):
        from_file(tmp_path / "none.csv", "strength", XY, GRID.d)


# ---- in a scenario -------------------------------------------------------------------------------------------------


def test_each_quantity_has_its_own_field():
    s = load_scenario(CASE, ["ice.strength_field={variation=0.2}", "ice.modulus_field={variation=0.1}"])
    v = varied(s, build(s).sheet.sheet.grid)
    assert (v.thickness == 1.0).all()
    assert v.strength.std() == pytest.approx(0.2, rel=0.15)
    assert v.E.std() == pytest.approx(0.1, rel=0.15)
    assert abs(np.corrcoef(v.strength, v.E)[0, 1]) < 0.15
    assert varied(load_scenario(CASE), GRID) is None


@pytest.mark.parametrize(
    ("value", "says"), [("{}", "either a variation or a file"), ("{variation=0.1,file='f.csv'}", "either a variation")]
)
def test_a_field_is_drawn_or_read(value, says):
    with pytest.raises(InputError, match=says):
        load_scenario(CASE, [f"ice.strength_field={value}"])


SHORT = ("scenario.duration='3 s'", "sheet.nodes=[25,19]", "sheet.length='36 m'", "sheet.width='27 m'")


def bits(*overrides):
    return np.array([load for _, load in run_scenario(load_scenario(CASE, [*SHORT, *overrides])).loads])


@pytest.mark.parametrize("how", [OPEN, CLOSING, (*OPEN, "fracture.propagation=dynamic")])
def test_a_constant_field_changes_not_one_bit_and_another_does(tmp_path, how):
    write(tmp_path / "one.csv", [(x, y, 1.0, 1.0, 1.0) for x in (0, 18, 36) for y in (0, 9, 27)], HEAD)
    one = str(tmp_path / "one.csv")
    plain = bits(*how)
    fields = ("strength_field", "thickness_field", "modulus_field")
    assert (bits(*how, *(f"ice.{f}={{file='{one}'}}" for f in fields)) == plain).all()
    assert (bits(*how, *(f"ice.{f}={{variation=0.0,correlation_length='9 m'}}" for f in fields)) == plain).all()
    for f in fields:
        assert (bits(*how, f"ice.{f}={{variation=0.2}}") != plain).any(), f


HEAD = "x,y,strength,thickness,youngs_modulus"


@pytest.mark.parametrize("how", [OPEN, CLOSING])
def test_balances_close_with_all_three_fields(how):
    fields = [f"ice.{f}={{variation=0.2,correlation_length='6 m'}}" for f in ("strength_field", "thickness_field")]
    run = run_scenario(load_scenario(CASE, [*SHORT, *how, *fields, "ice.modulus_field={variation=0.2}"]))
    assert run.events
    assert abs(run.ledger["mass_error"]) < 1e-9
    assert abs(run.ledger["sheet_energy_residual"]) < 2e-3


def test_a_recorded_field_is_in_the_scenario_that_ran():
    s = load_scenario(CASE, ["ice.strength_field={variation=0.2,correlation_length='6 m'}"])
    again = tomllib.loads(s.resolved_toml())["ice"]["strength_field"]
    assert again["variation"] == 0.2
    assert again["correlation_length"] == "6 m"
    assert "thickness_field" not in s.resolved_toml()
