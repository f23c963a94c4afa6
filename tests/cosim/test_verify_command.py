"""The command `cosim verify`: JSON, exit codes, one line per error."""

from __future__ import annotations

import json

import pytest

from cosim.verify.case import at_most, near, plain, value
from cosim.verify.cases import CASES, run


def test_json_of_a_case_is_one_object_with_the_agreed_keys(cosim):
    code, out, err = cosim("verify", "eigenfrequencies", "--set", "nodes=[19,31]", "--json")
    assert (code, err) == (0, "")
    case = json.loads(out)
    assert set(case) == {"case", "parameters", "quantities", "passed"}
    assert {"name", "value", "unit", "reference", "source", "tolerance", "passed"} <= set(case["quantities"][0])
    assert case["passed"] is True


def test_parameters_without_a_reference_still_give_values(cosim):
    case = json.loads(cosim("verify", "eigenfrequencies", "--set", "nodes=[25,41]", "--set", "nu=0.25", "--json")[1])
    assert case["parameters"]["nodes"] == [25, 41]
    assert all(q["reference"] is None and q["passed"] is None for q in case["quantities"])
    lattice = next(q for q in case["quantities"] if q["name"] == "lattice 25x41")
    assert len(lattice["value"]) == 20


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("xyz",), "known: eigenfrequencies, "),
        (("frooude",), "did you mean froude?"),
        (("--set", "nu=0.2"), "--set needs a case"),
        (("eigenfrequencies", "--set", "nuu=0.2"), "did you mean nu?"),
        (("eigenfrequencies", "--set", "nu=0.4"), "Poisson's ratio 0.4"),
        (("eigenfrequencies", "--set", "nu"), "write name=value"),
        (("eigenfrequencies", "--set", "nodes=[19,30]"), "cells must be square"),
        (("eigenfrequencies", "--set", "modes=2.5"), "whole number"),
        (("splitting", "--set", "E=NaN"), "must be a number"),
        (("splitting", "--set", "a=31"), "does not end inside"),
        (("froude", "--set", "steps=100"), "is not stable"),
        (("dispersion", "--set", "stiffness=foo"), "unknown stiffness set"),
    ],
)
def test_bad_input_is_one_line_and_exit_2(cosim, arguments, text):
    code, out, err = cosim("verify", *arguments)
    assert (code, out) == (2, "")
    assert text in err
    assert err.startswith("cosim: ")
    assert err.count("\n") == 1


def test_a_failed_check_is_exit_1(cosim, monkeypatch):
    import cosim.verify.eigenfrequencies as case

    monkeypatch.setitem(case.LATTICE, (19, 31), [0.7] * 20)
    code, out, err = cosim("verify", "eigenfrequencies", "--set", "nodes=[19,31]")
    assert code == 1
    assert "FAILED" in out
    assert "1 of 1 cases miss their reference: eigenfrequencies" in err


def test_figures_are_saved_as_png(tmp_path):
    pytest.importorskip("matplotlib")
    run("dispersion", plots_dir=tmp_path, quick=True)
    assert sorted(p.name for p in tmp_path.iterdir()) == [f"dispersion_figure_2-{n}.png" for n in (10, 11, 18, 9)]


def test_every_case_says_what_it_is():
    for module in CASES.values():
        assert module.__doc__
        assert isinstance(module.PARAMETERS, dict)


def test_nan_never_passes():
    with pytest.raises(ValueError, match="not finite"):
        plain([1.0, float("nan")])
    assert near("x", 1.02, "-", 1.0, 0.01, "").passed is False
    assert near("x", 1.0, "-", None, 0.01, "").passed is None
    assert at_most("x", -0.2, "-", 0.1, "").passed is False
    assert value("x", 1.0, "-").passed is None
