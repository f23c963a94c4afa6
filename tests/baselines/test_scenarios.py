"""`cosim baseline`, and the design formulas beside a run."""

import json

import numpy as np
import pytest

from cosim.analysis.run_data import RunData
from cosim.baselines.beside import beside
from cosim.baselines.methods import METHODS, design_loads
from cosim.scenario.loading import load_scenario
from cosim.show.report import write_report

GLA, PLANE, FLOE = "icefloe_gla_upward_cone", "upward_plane", "van_vliet_2018_floe_165m"


def test_the_scenario_of_icefloe_gives_its_logged_loads(cosim):
    """OpenFAST, modules/icefloe, tests GLA_*: 2.65997 MN (ISO) and 3.74475 MN (IEC)."""
    code, out, err = cosim("baseline", GLA, "--json")
    found = json.loads(out)
    assert (code, err, set(found)) == (0, "", set(METHODS))
    assert all({"terms", "fx", "fz"} <= set(method) for method in found.values())
    assert found["croasdale"]["fx"] == pytest.approx(2.65997e6, rel=2e-6)
    assert found["ralston_tresca"]["fx"] == pytest.approx(3.74475e6, rel=1e-6)
    assert all(method["fz"] < 0.0 for method in found.values())
    assert not found["croasdale"]["assumed"]
    assert not found["ralston_tresca"]["assumed"]
    terms = found["croasdale"]["terms"]
    assert found["croasdale"]["breaking_share"] == pytest.approx(terms["H_B"] / sum(terms.values()), rel=1e-12)


def test_what_a_scenario_does_not_say_is_printed_as_assumed(cosim):
    code, out, _ = cosim("baseline", FLOE)
    assert code == 0
    assert "Croasdale" in out
    assert "assumed" in out
    for key in ("rubble_height = 6 m", "porosity = 0.3", "rubble_slope = 30 deg", "top_diameter = 18 m"):
        assert key in out
    stated = design_loads(load_scenario(FLOE, ["baseline.rubble_height=0 m"]).model)["croasdale"]
    assert "rubble_height" not in stated["assumed"]
    assert stated["terms"]["H_R"] == 0.0
    assert stated["fx"] == pytest.approx(11.2e6, abs=0.05e6)
    assert stated["fz"] > 0.0


def test_a_plane_has_no_cone_formulas():
    found = design_loads(load_scenario(PLANE).model)
    assert found["ralston_tresca"]["refused"] == found["nevel"]["refused"] == "for cones only"
    assert found["croasdale"]["intermediate"]["l_c"] == load_scenario(PLANE).sheet.width


def test_a_formula_that_cannot_serve_says_why(cosim):
    code, out, _ = cosim("baseline", GLA, "--set", "contact.friction=0.57")
    assert code == 0
    assert "use less friction or a gentler slope" in " ".join(out.split())
    code, _, err = cosim("baseline", GLA, "--set", "contact.friction=0.6")  # above 1 / tan(60 deg) no ice slides
    assert code == 2
    assert "does not slide" in err


def test_bad_values_are_one_line(cosim):
    for override, says in [
        ("baseline.porosity=1.5", "less than 1"),
        ("baseline.rubble_hight=1 m", "rubble_height"),
        ("baseline.rubble_height=-1 m", "negative"),
    ]:
        code, out, err = cosim("baseline", FLOE, "--set", override)
        assert (code, out) == (2, "")
        assert says in err
        assert err.count("\n") == 1


def a_run(text):
    load = np.zeros((3, 3, 3))
    load[:, 0, 0], load[:, 1, 0], load[:, 1, 2] = [1e6, 2e6, 0.0], [0.0, 1e6, 0.0], [0.0, -2e6, 0.0]
    metadata = {
        "scenario": "case",
        "title": "A case",
        "version": "1",
        "seed": "0",
        "duration_ns": "150000000",
        "window_ns": "50000000",
        "averaging_s": "0",
        "overrides": "[]",
    }
    ledger = {n: np.ones(3) for n in ("sheet_mass", "rubble_mass", "crushed_mass", "cleared_mass")}
    return RunData("run.mcap", metadata, 50_000_000 * np.arange(1, 4), load, (), ledger, {"scenario.toml": text})


def test_beside_a_run_the_peak_keeps_its_sign(tmp_path):
    run = a_run(load_scenario(GLA).resolved_toml())
    design = beside(run)
    assert design["simulated"] == {"fx": 3e6, "fz": -2e6, "breaking_share": pytest.approx(2 / 3)}
    croasdale = design["methods"]["croasdale"]
    assert croasdale["ratio_fx"] == pytest.approx(3e6 / croasdale["fx"])
    assert croasdale["ratio_fz"] > 0.0
    write_report(run, tmp_path / "r.html")
    page = (tmp_path / "r.html").read_text("utf-8")
    assert "Design formulas" in page
    assert "Ralston, Tresca" in page
    assert "unverified" in page


def test_a_scenario_of_another_version_is_said_to_be_so():
    assert "cannot be read" in beside(a_run("[scenario]"))["refused"]
