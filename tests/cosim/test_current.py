"""Water that flows: one key moves sheet and blocks, and what it does is booked under its own name."""

import numpy as np
import pytest

from cosim.analysis import budget
from cosim.analysis.run_data import RunData
from cosim.build import build
from cosim.recording.reader import read_run
from cosim.recording.writer import Recorder
from cosim.scenario.errors import ScenarioError
from cosim.scenario.loading import load_scenario
from cosim.show.report import content
from cosim.show.tables import ledger_lines
from cosim.simulation import run_scenario

CASE = "van_vliet_2018_floe_55m_centre"
SHORT = (
    "sheet.nodes=[20, 20]",
    "scenario.duration='6 s'",
    "drift.velocity='0.4 m/s'",
    "contact.strength='800 kPa'",
)


def recorded(tmp_path, *overrides) -> RunData:
    with Recorder(tmp_path / "run.mcap") as recorder:
        run_scenario(load_scenario(CASE, [*SHORT, *overrides]), [recorder])
    return read_run(tmp_path / "run.mcap")


@pytest.mark.parametrize(("speed", "sign"), [("2 m/s", 1.0), ("-2 m/s", -1.0)])
def test_a_current_carries_a_part_of_the_load_and_the_ledger_closes(tmp_path, speed, sign):
    """The skin friction rho C_f |v| v / 2 on the whole floe; with the drift it pushes, against it it holds back."""
    run = recorded(tmp_path, f"water.current=['{speed}', '0 m/s']")
    through = sign * 2.0 - 0.4
    area = 55.0**2
    first = run.budget["fx_current"][0]
    assert first == pytest.approx(0.5 * 1006.0 * 0.002 * area * abs(through) * through, rel=0.01)
    assert np.all(np.sign(run.budget["fx_current"]) == sign)
    work = run.ledger["current_load_work"]
    assert work[-1] == pytest.approx(np.sum(run.budget["fx_current"]) * 0.4 * 0.05, rel=0.05)
    assert abs(run.ledger["energy_residual"][-1]) < 1e-3 * run.ledger["drift_work"][-1]
    assert abs(run.ledger["mass_error"][-1]) < 1e-12
    assert np.abs(run.budget["fx_residual"]).max() < 1e-6 * run.component("fx").max()
    (mean,) = (row for row in budget.rows(run) if (row["when"], row["component"]) == ("mean", "Fx"))
    assert sum(mean["terms"].values()) == pytest.approx(mean["total"], rel=1e-9)
    assert len(content(run)["figures"]) == 4


def test_the_work_of_a_current_is_printed_with_the_energy():
    terms = {"drift_work": 1e6, "current_load_work": 4e5, "sheet_elastic": 1.4e6}
    assert "current_load_work 0.40" in ledger_lines(terms)[1]


def test_blocks_drift_in_the_same_water():
    s = build(load_scenario(CASE, [*SHORT, "water.current=['0.3 m/s', '-0.1 m/s']"]))
    assert s.rubble.physics.current == (0.3, -0.1)
    assert s.rubble.layer.physics.current == (0.3, -0.1)
    (load,) = s.sheet.loads
    assert (load.velocity, load.density, load.skin_drag) == ((0.3, -0.1), 1006.0, 0.002)


def test_left_out_the_water_is_still_and_does_not_drag_on_the_sheet():
    scenario = load_scenario(CASE, SHORT)
    assert scenario.water.current is None
    assert "current" not in scenario.resolved_toml()
    s = build(scenario)
    assert s.sheet.loads == ()
    assert s.rubble.physics.current == (0.0, 0.0)


def test_water_that_stands_still_by_its_key_drags_on_the_sheet():
    (load,) = build(load_scenario(CASE, [*SHORT, "water.current=['0 m/s', '0 m/s']"])).sheet.loads
    assert load.velocity == (0.0, 0.0)


def test_a_resolved_scenario_has_the_same_current(tmp_path):
    scenario = load_scenario(CASE, ["water.current=['10 cm/s', '-1 km/h']"])
    file = tmp_path / "again.toml"
    file.write_text(scenario.resolved_toml(), "utf-8")
    assert load_scenario(file).model == scenario.model
    assert scenario.water.current == pytest.approx((0.1, -1.0 / 3.6))


@pytest.mark.parametrize(
    ("value", "says"),
    [
        ("'0.1 m/s'", 'write 2 values in brackets; for example ["0.1 m/s", "0 m/s"]'),
        ("['0.1 m/s']", "write 2 values in brackets"),
        ("['0.1 m/s', 3]", 'a quantity needs its unit: write it as a string, for example "3 m/s"'),
        ("['0.1 m/s', '3 m']", "wrong unit, this quantity is measured in m/s"),
    ],
)
def test_faults(value, says):
    with pytest.raises(ScenarioError) as error:
        load_scenario(CASE, [f"water.current={value}"])
    assert "water.current" in str(error.value)
    assert says in str(error.value)
