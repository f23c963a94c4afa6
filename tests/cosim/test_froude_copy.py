"""Froude copies of the shipped scenarios: exact, and the same dimensionless case."""

from __future__ import annotations

import dataclasses
import json
import math
import tomllib
from fractions import Fraction

import pytest

from cosim.scenario.errors import ScenarioError
from cosim.scenario.finding import find_scenarios
from cosim.scenario.froude import factor_of, froude_copy, multiplier, power_of
from cosim.scenario.loading import load_scenario
from cosim.scenario.model import ScenarioModel


def copy(path, name, factor, overrides=()):
    made = froude_copy(load_scenario(name, overrides), factor_of(factor))
    path.write_text(made.text, encoding="utf-8")
    return made, load_scenario(path)


@pytest.mark.parametrize(
    ("unit", "power"),
    [
        ("m", 1), ("s", "1/2"), ("m/s", "1/2"), ("m/s^2", 0), ("kg/m^3", 0), ("N", 3), ("Pa", 1), ("Pa*m^0.5", "3/2"),
        ("J/m^2", 2), ("m^3", 3), ("rad", 0),
    ],
)  # fmt: skip
def test_powers_are_those_of_table_a4_1(unit, power):
    """van Vliet 2018, Table A4-1: length 1, time 1/2, velocity 1/2, force 3, stress and E 1, density 0."""
    assert power_of(unit) == Fraction(power)


def test_multipliers_are_exact_for_squares_and_to_double_for_others():
    assert multiplier(Fraction(36), Fraction(1, 2)) == 6
    assert multiplier(Fraction(1, 36), Fraction(3, 2)) == Fraction(1, 216)
    assert float(multiplier(Fraction(30), Fraction(1, 2))) == math.sqrt(30.0)
    assert multiplier(Fraction(30), Fraction(-1)) == Fraction(1, 30)


def leaves(model, prefix=""):
    for name in type(model).model_fields:
        value = getattr(model, name)
        if hasattr(type(value), "model_fields"):
            yield from leaves(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


@pytest.mark.parametrize("name", sorted(folder.name for folder in find_scenarios()))
def test_a_model_at_25_is_exact_and_back_again_the_case(name, tmp_path):
    """Every number of the copy is its number times the power, to the last bits; the copy of the copy is the case."""
    case = load_scenario(name)
    made, small = copy(tmp_path / "small.toml", name, "1/25")
    assert not [line for line in made.told if "sub-step" in line]
    power = {q.key: float(multiplier(Fraction(1, 25), q.power)) for q in made.quantities}
    old = dict(leaves(case.model))
    for key, value in leaves(small.model):
        if isinstance(value, float) and key in power:
            assert value == pytest.approx(power[key] * old[key], rel=4e-16), key
        elif key not in power:
            assert value == old[key], key
    assert small.model.structure.slope == case.model.structure.slope
    assert small.model.ice.density == case.model.ice.density
    assert small.averaging == pytest.approx(case.averaging / 5.0, rel=1e-12)
    _, back = copy(tmp_path / "back.toml", tmp_path / "small.toml", "25")
    for key, value in leaves(back.model):
        assert value == (pytest.approx(old[key], rel=4e-16) if isinstance(value, float) else old[key]), key


def test_another_root_keeps_whole_nanoseconds_and_is_told(tmp_path):
    made, small = copy(tmp_path / "small.toml", "first_cone", "1/30")
    assert "the sub-step is 365148 ns" in made.told[0]  # 2 ms / 30^0.5 = 365148.37 ns
    case = load_scenario("first_cone")
    assert small.substeps == case.substeps
    assert small.duration_ns / small.window_ns == case.duration_ns / case.window_ns
    assert small.model.scenario.duration == pytest.approx(20.0 / math.sqrt(30.0), rel=2e-6)


def test_profiles_and_currents_scale():
    """Values in lists, of one quantity and of pairs."""
    plane = load_scenario("first_cone", ["water.current=['0.5 m/s', '-0.1 m/s']"])
    assert 'current = ["1 m/s", "-0.2 m/s"]' in froude_copy(plane, Fraction(4)).text
    profile = [
        "structure={kind='profile', breaking='downward', profile=[['-6 m', '3 m'], ['4 m', '8 m']], top='4 m'}",
    ]
    raw = load_scenario("first_cone")
    table = {**raw.raw, "structure": tomllib.loads(profile[0])["structure"]}
    made = froude_copy(dataclasses.replace(raw, raw=table, model=ScenarioModel.model_validate(table)), Fraction(4))
    assert 'profile = [["-24 m", "12 m"], ["16 m", "32 m"]]' in made.text


def test_command(cosim, tmp_path):
    code, out, err = cosim("scale", "first_cone", "1/4", "-o", tmp_path / "x.toml", "--json")
    assert code == 0, err
    rows = {row["key"]: row for row in json.loads(out)["quantities"]}
    assert rows["ice.thickness"] == {"key": "ice.thickness", "from": "0.5 m", "to": "0.125 m", "power": "1"}
    assert cosim("check", tmp_path / "x.toml")[0] == 0
    assert cosim("scale", "first_cone", "1/4", "-o", tmp_path / "x.toml")[0] == 2
    code, out, _ = cosim("scale", "first_cone", "2")
    assert code == 0
    assert 'thickness = "1 m"' in out


@pytest.mark.parametrize(
    ("factor", "line"), [("x", "is no number"), ("0", "not between"), ("-3", "not between"), ("1/0", "is no number")]
)
def test_a_wrong_factor_is_one_line(factor, line):
    with pytest.raises(ScenarioError, match=line):
        factor_of(factor)


def test_a_copy_runs_to_the_same_dimensionless_peak(cosim, tmp_path):
    """First break of the first cone at 1:1 and at 1:4: force 64 : 1, time 2 : 1, same pieces (Table A4-1)."""
    copy(tmp_path / "quarter.toml", "first_cone", "1/4", ["scenario.duration='2 s'"])
    found = []
    for case, settings in (("first_cone", ["--set", "scenario.duration='2 s'"]), (tmp_path / "quarter.toml", [])):
        code, out, err = cosim("run", case, *settings, "-q", "--json")
        assert code == 0, err
        found.append(json.loads(out))
    full, quarter = found
    assert full["fragments"] == quarter["fragments"] > 0
    for name in ("fx", "fz"):
        a, b = full["peaks"][name], quarter["peaks"][name]
        assert 64.0 * b["value"] == pytest.approx(a["value"], rel=0.01)
        assert 2.0 * b["time"] == pytest.approx(a["time"], rel=0.01)
