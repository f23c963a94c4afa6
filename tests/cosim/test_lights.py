"""Honest lights: each number where it is known in closed form, on both sides of its limit, and where it is shown."""

import dataclasses
import json

import numpy as np
import pytest

from cosim.analysis import lights
from cosim.analysis.run_data import RunData
from cosim.build import build_ice
from cosim.recording.reader import read_run
from cosim.recording.writer import Recorder
from cosim.scenario.lengths import beam_cell
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario
from coupling.interface import Event, SimulationError
from lattice.cracks.beam import cut_beam, standard_beam

N = 400
T = 0.05 * np.arange(1, N + 1)
METADATA = {"window_ns": "50000000", "averaging_s": "0.5", "spacing_m": "1.5", "characteristic_length_m": "12.0"}
BREAKS = tuple(
    Event(round(t * 1e9), "circumferential", (1.0, 0.0, 0.0), 3, (0.0, 0.0, 0.0), "") for t in (3.0, 6.0, 9.0)
)


def run(fx=None, ledger=(), budget=(), events=BREAKS, **metadata):
    """20 s with a steady load of 2 MN that is 3 MN from 5 to 7 s."""
    load = np.zeros((N, 3, 3))
    load[:, 0, 0] = np.where((T > 5.0) & (T <= 7.0), 3e6, 2e6) if fx is None else fx
    return RunData(
        "r",
        METADATA | metadata,
        np.rint(T * 1e9).astype(np.int64),
        load,
        events,
        {name: np.linspace(0.0, value, N) for name, value in dict(ledger).items()},
        budget=dict(budget),
    )


def test_a_run_within_all_limits_is_trustworthy():
    found = lights.trust(run(ledger={"drift_work": 1e6, "correction_loss": -5e4, "friction_loss": 9e5}))
    assert (found["trustworthy"], found["because"]) == (True, [])
    assert len(lights.trust_lines(found)) == 1


def test_energy_from_numerics_counts_what_was_put_in():
    books = {"drift_work": 1e6, "correction_loss": -1.2e5, "interface_loss": -5e4, "stepping_loss": 4e5}
    assert lights.numerics_share(run(ledger=books)) == pytest.approx(0.17, rel=1e-12)
    found = lights.trust(run(ledger=books))
    assert found["because"] == ["17% of the drift's work came from numerics (halve coupling.window and rubble.substep)"]
    assert lights.numerics_share(run()) is None


def test_staggering_is_that_at_the_peak():
    stagger = np.where((T > 6.0) & (T <= 6.6), 6e5, 0.0)
    alone = run(budget={"fx_staggering": stagger})
    peak = run(fx=np.where((T > 6.0) & (T <= 6.5), 3e6, 2e6), budget={"fx_staggering": stagger})
    assert lights.staggering_share(peak) == pytest.approx(0.2, rel=1e-9)
    assert lights.trust(peak)["because"][0].startswith("20% of the peak is staggering")
    assert lights.staggering_share(alone) == pytest.approx(0.0, abs=1e-9)  # the peak, of 5.5 s, has none


def test_a_load_that_still_grows_says_so():
    """Of a load that grows as time from 4 s on, the last two of its four quarters of 4 s have means of 10 and 14."""
    grows = run(fx=np.where(T > 4.0, 1e5 * (T - 4.0), 0.0))
    assert lights.growth(grows) == pytest.approx(14.0 / 10.0, rel=0.01)
    assert not any("still grows" in text for text in lights.trust(grows)["because"])
    faster = lights.trust(run(fx=np.where(T > 4.0, 1e3 * (T - 4.0) ** 2, 0.0)))
    assert any("is 1.9 times that of the third: it still grows" in text for text in faster["because"])
    assert lights.growth(run(fx=np.full(N, 2e6))) == pytest.approx(1.0, rel=1e-12)
    assert lights.growth(run(fx=np.zeros(N))) is None


def test_a_run_shorter_than_its_averaging_time_says_so():
    """A mean of a steady 2 MN over 30 s, of which the run has 20, is 1.33 MN: two thirds of the load."""
    short = run(fx=np.full(N, 2e6), averaging_s="30.0")
    assert lights.run_length(short) == pytest.approx(2 / 3, rel=1e-12)
    assert short.lasting.component("fx").max() == pytest.approx(4e6 / 3, rel=1e-12)
    assert any(text.startswith("the run has 0.67 averaging times") for text in lights.trust(short)["because"])
    assert lights.run_length(run()) == pytest.approx(40.0, rel=1e-12)
    assert not any("averaging times" in text for text in lights.trust(run())["because"])
    assert lights.run_length(run(averaging_s="0")) is None


def test_odd_and_even_windows():
    swing = 2e6 + 2e5 * (-1.0) ** np.arange(N)
    assert lights.odd_even(run(fx=swing)) == pytest.approx(0.2, rel=1e-9)
    assert lights.odd_even(run(fx=np.full(N, 2e6))) == pytest.approx(0.0, abs=1e-12)
    assert "odd and even windows differ by 20%" in lights.trust(run(fx=swing))["because"][0]


def test_cells_per_length_end_of_the_run_and_breaks():
    assert lights.nodes_per_length(run()) == 8.0
    coarse = lights.trust(run(spacing_m="3.0"))
    assert coarse["because"] == ["there are 4.0 cells in the characteristic length (refine sheet.nodes)"]
    grows = lights.trust(run(fx=1e5 * T))
    assert any("stands at the end of the run" in text for text in grows["because"])
    assert lights.time_after_peak(run(fx=np.where(T < 15.0, 2e6, 1e6))) > 10.0
    few = lights.trust(run(events=BREAKS[:1]))
    assert few["because"] == ["1 breaks are too few for a largest load (lengthen scenario.duration)"]


def test_what_is_not_known_speaks_neither_for_nor_against():
    bare = lights.trust(run(events=BREAKS))
    assert bare["lights"]["numerics_share"] == {"value": None, "limit": 0.1, "good": None}
    empty = RunData("r", METADATA, np.zeros(0, np.int64), np.zeros((0, 3, 3)))
    assert lights.trust(empty)["lights"]["odd_even"]["good"] is None


def test_a_run_and_its_recording_say_the_same_in_every_command(cosim, tmp_path):
    path = tmp_path / "run.mcap"
    options = ("sheet.nodes=[12, 12]", "scenario.duration='2 s'", "rubble.initial_volume='60 m^3'")
    with Recorder(path) as recorder:
        result = run_scenario(load_scenario("van_vliet_2018_floe_55m_centre", options), [recorder])
    own = json.loads(json.dumps(result.to_json()["trust"]))
    info = json.loads(cosim("info", path, "--json")[1])["trust"]
    beside = json.loads(cosim("compare", path, "--json")[1])["trust"]
    assert not own["trustworthy"]
    assert own["because"] == info["because"] == beside["because"]
    for name, light in own["lights"].items():
        recorded = info["lights"][name]["value"]
        assert (light["value"] is None) == (recorded is None) == (name == "cells_of_beam"), name  # its cracks are open
        if recorded is not None:
            assert light["value"] == pytest.approx(recorded, rel=1e-9), name
    line = f"not trustworthy, because {'; '.join(own['because'])}"
    for command in ("info", "compare"):
        assert line in cosim(command, path)[1]
    cosim("report", path, "-o", tmp_path / "r.html")
    assert line.replace("'", "&#39;") in (tmp_path / "r.html").read_text()
    data = read_run(path)
    assert lights.trust(dataclasses.replace(data, ledger={}))["lights"]["numerics_share"]["value"] is None


def test_a_state_that_is_not_finite_ends_the_run(monkeypatch):
    scenario = load_scenario("van_vliet_2018_floe_55m_centre", ["sheet.nodes=[12, 12]", "scenario.duration='0.2 s'"])
    from coupling.scheduler import Scheduler

    step = Scheduler.macro_step

    def bad(self):
        frame = step(self)
        return dataclasses.replace(frame, load=frame.load * np.nan)

    monkeypatch.setattr(Scheduler, "macro_step", bad)
    with pytest.raises(SimulationError, match=r"t = 0\.050 s: the load is not finite"):
        run_scenario(scenario)


def test_a_structure_that_is_never_touched_ends_the_run(cosim, tmp_path):
    """The ice drifts past a cone that stands beside the corner of a free floe."""
    options = ["sheet.nodes=[12, 12]", "scenario.duration='0.1 s'", "rubble.enabled=false"]
    scenario = load_scenario("van_vliet_2018_floe_55m_centre", options)
    with pytest.MonkeyPatch.context() as patch:
        from coupling.scheduler import Scheduler

        step = Scheduler.macro_step
        patch.setattr(Scheduler, "macro_step", lambda s: dataclasses.replace(f := step(s), load=0.0 * f.load))
        with pytest.raises(SimulationError, match=r"the structure was never touched in 0\.1 s"):
            run_scenario(scenario)
        file = tmp_path / "run.mcap"
        code, _, err = cosim("run", "van_vliet_2018_floe_55m_centre", *(f"--set={o}" for o in options), "-o", file)
    assert (code, "never touched" in err) == (1, True)
    told = json.loads(cosim("info", file, "--json")[1])
    assert told["ended"].startswith("the structure was never touched")
    assert "failed at its end" in told["remark"]


def test_cells_wider_than_those_of_the_beam_test_are_told():
    wide, fine = run(beam_cell_m="1.0"), run(beam_cell_m="1.3")
    assert lights.cells_of_beam(wide) == pytest.approx(1.5, rel=1e-12)
    assert lights.trust(wide)["because"] == [
        "cells are 1.5 times as wide as those in which the beam test was simulated, so that the strength of the layers "
        "is that of another mesh (refine sheet.nodes to half the width of the beam)"
    ]
    assert lights.trust(fine)["trustworthy"]
    assert lights.cells_of_beam(run()) is None


@pytest.mark.parametrize("nodes", ["[121,91]", "[73,55]", "[241,181]", "[25,19]"])
def test_the_cells_of_the_beam_are_those_that_are_simulated(nodes):
    scenario = load_scenario("narrow_cone", [f"sheet.nodes={nodes}"])
    simulated = cut_beam(standard_beam(build_ice(scenario)), scenario.sheet.spacing).grid.d
    assert beam_cell(scenario.model) == pytest.approx(simulated, rel=1e-12)
    assert beam_cell(load_scenario("narrow_cone", ["fracture.layer_strength='650 kPa'"]).model) is None
    assert beam_cell(load_scenario("van_vliet_2018_floe_165m").model) is None
