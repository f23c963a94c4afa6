"""The command `cosim verify`: JSON, exit codes, one line per error."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from cosim.verify.case import at_most, near, plain, value
from cosim.verify.cases import CASES, run
from cosim.verify.command import verify_command

APP = typer.Typer()
APP.command()(verify_command)


def call(*arguments: str):  # type: ignore[no-untyped-def]
    return CliRunner().invoke(APP, list(arguments))


def test_json_of_a_case_is_one_object_with_the_agreed_keys() -> None:
    result = call("eigenfrequencies", "--set", "nodes=[19,31]", "--json")
    assert result.exit_code == 0
    case = json.loads(result.stdout)
    assert set(case) == {"case", "parameters", "quantities", "passed"}
    assert {"name", "value", "unit", "reference", "source", "tolerance", "passed"} <= set(case["quantities"][0])
    assert case["passed"] is True


def test_parameters_without_a_reference_still_give_values() -> None:
    case = json.loads(call("eigenfrequencies", "--set", "nodes=[25,41]", "--set", "nu=0.25", "--json").stdout)
    assert case["parameters"]["nodes"] == [25, 41]
    assert all(q["reference"] is None and q["passed"] is None for q in case["quantities"])
    lattice = next(q for q in case["quantities"] if q["name"] == "lattice 25x41")
    assert len(lattice["value"]) == 20


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("nonsense",), "known cases are"),
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
def test_bad_input_is_one_line_and_exit_2(arguments: tuple[str, ...], text: str) -> None:
    result = call(*arguments)
    assert result.exit_code == 2
    assert text in result.stderr
    assert result.stderr.strip().count("\n") == 0


def test_a_failed_check_is_exit_1(monkeypatch: pytest.MonkeyPatch) -> None:
    import cosim.verify.eigenfrequencies as case

    monkeypatch.setitem(case.LATTICE, (19, 31), [0.7] * 20)
    result = call("eigenfrequencies", "--set", "nodes=[19,31]")
    assert result.exit_code == 1
    assert "FAILED" in result.stdout


def test_figures_are_saved_as_png(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    run("dispersion", plots_dir=tmp_path, quick=True)
    assert sorted(p.name for p in tmp_path.iterdir()) == [f"dispersion_figure_2-{n}.png" for n in (10, 11, 18, 9)]


def test_every_case_says_what_it_is() -> None:
    for module in CASES.values():
        assert module.__doc__
        assert isinstance(module.PARAMETERS, dict)


def test_nan_never_passes() -> None:
    with pytest.raises(ValueError, match="not finite"):
        plain([1.0, float("nan")])
    assert near("x", 1.02, "-", 1.0, 0.01, "").passed is False
    assert near("x", 1.0, "-", None, 0.01, "").passed is None
    assert at_most("x", -0.2, "-", 0.1, "").passed is False
    assert value("x", 1.0, "-").passed is None
