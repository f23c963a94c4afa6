"""Two hundred ordinary cases run without an abort: eleven cheap ones on every run, all in the slow suite."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario.judge import doubts_of
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario

spec = importlib.util.spec_from_file_location("ordinary", Path(__file__).with_name("ordinary.py"))
cases = importlib.util.module_from_spec(spec)
sys.modules[spec.name] = cases
spec.loader.exec_module(cases)

#: both directions, engines, contacts and kinds of crack, cone and plane, full scale and 1:25, a few seconds each
OFTEN = (0, 4, 5, 7, 8, 9, 10, 12, 13, 14, 189)
COUNT = 200


def runs(number, folder):
    """The case runs for its 5 s (1 s at 1:25), with balances that close and a load that is finite and not nothing."""
    case = cases.ordinary(number, folder)
    scenario = load_scenario(case.write(folder))
    result = run_scenario(scenario)
    assert result.t_ns == scenario.duration_ns == (5e9 if case.drawn["scale"] == 1 else 1e9)
    load = np.array([load for _, load in result.loads])
    assert np.isfinite(load).all()
    assert np.abs(load).max() > 0.0
    assert result.ledger["sheet_energy_residual"] < 1e-3
    assert result.ledger["energy_residual"] < 1e-2
    assert result.ledger["mass_error"] < 1e-12


@pytest.mark.parametrize("number", OFTEN)
def test_an_ordinary_case_runs(tmp_path, number):
    runs(number, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("number", sorted(set(range(COUNT)) - set(OFTEN)))
def test_every_ordinary_case_runs(tmp_path, number):
    runs(number, tmp_path)


def test_the_cases_are_many_and_of_every_kind(tmp_path):
    drawn = [cases.ordinary(number, tmp_path) for number in range(COUNT)]
    for name, values in cases.CHOICES.items():
        seen = [case.drawn[name] for case in drawn]
        assert min(seen.count(value) for value in values) >= 5, name
    assert len({case.text for case in drawn}) == COUNT
    assert max(case.nodes for case in drawn) <= cases.MOST
    often = [drawn[number].drawn for number in OFTEN]
    for name in ("kind", "breaking", "contact", "cracks", "propagation", "cells", "scale"):
        assert {case[name] for case in often} == set(cases.CHOICES[name]), name


def test_a_case_is_without_doubt_and_the_same_every_time(tmp_path):
    for number in (1, 2, 3):
        case = cases.ordinary(number, tmp_path)
        assert case == cases.ordinary(number, tmp_path)
        if case.drawn["scale"] == 1:
            doubts = doubts_of(load_scenario(case.write(tmp_path)).model)
            assert [doubt.key for doubt in doubts if doubt.key != "scenario.duration"] == []
