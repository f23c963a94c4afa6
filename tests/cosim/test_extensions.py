"""What is added from outside to a table of names can be chosen by a scenario at once, and acts in its run."""

from __future__ import annotations

from dataclasses import astuple
from types import SimpleNamespace

import pytest

from cosim.build import build
from cosim.loads import LOADS
from cosim.recording.reader import read_run
from cosim.recording.writer import Recorder
from cosim.scenario.errors import ScenarioError
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario
from cosim.structures import KINDS, Kind
from coupling.contact import OverlapContact
from coupling.crushing import CONTACTS
from coupling.schemes import SCHEMES, Iteration
from coupling.structure import plane_slope
from lattice.criteria.table import CRITERIA, Criterion
from lattice.stiffness import STIFFNESS_SETS, Springs, hrennikoff

CASE = "van_vliet_2018_floe_55m_centre"
SHORT = ("sheet.nodes=[20, 20]", "scenario.duration='1 s'")


def result_of(*overrides):
    return run_scenario(load_scenario(CASE, [*SHORT, *overrides]))


def peak(*overrides):
    """Largest Fx [N]."""
    return result_of(*overrides).peaks.value[0]


@pytest.fixture(scope="module")
def usual():
    return peak()


def test_a_stiffness_set(monkeypatch, usual):
    """Softer springs: a floe that gives way to the cone. At nu = 1/3 the two sets of the thesis are one."""
    assert peak("sheet.stiffness='equations-matching'") == pytest.approx(usual, rel=1e-9)
    monkeypatch.setitem(STIFFNESS_SETS, "soft", lambda ice: Springs(*(0.1 * x for x in astuple(hrennikoff(ice)))))
    assert peak("sheet.stiffness='soft'") < 0.99 * usual


def test_a_coupling_scheme(monkeypatch, usual):
    windows, usual_scheme = [], SCHEMES["serial-explicit"](Iteration())

    def counting(scheduler):
        windows.append(scheduler.t_ns)
        return usual_scheme(scheduler)

    monkeypatch.setitem(SCHEMES, "counting", lambda _: counting)
    assert peak("coupling.scheme='counting'") == usual
    assert len(windows) == 20


def test_a_contact(monkeypatch, usual):
    class Lighter(OverlapContact):
        """As if the ice were a tenth as strong."""

        def evaluate(self, *arguments):
            force, tangent = super().evaluate(*arguments)
            return 0.1 * force, 0.1 * tangent

    monkeypatch.setitem(CONTACTS, "lighter", Lighter)
    assert 0.05 * usual < peak("contact.model='lighter'") < 0.5 * usual


#: a first failure after 2.4 s; a window that is read off a long step books the energy of a fracture up to 0.2 % wrong
BREAKS = (
    "scenario.duration='4 s'",
    "drift.velocity='0.4 m/s'",
    "contact.strength='800 kPa'",
    "rubble.enabled=false",
    "fracture.longest_step='50 ms'",
)


@pytest.mark.parametrize("propagation", ["quasi-static", "dynamic"])
def test_a_failure_criterion(monkeypatch, propagation, tmp_path):
    """Cells fail by it before they do by the thesis's; the event says so, in the run and in its recording."""

    def careful(state, ice):
        return 1.5 * CRITERIA["combined-tension"].judge(state, ice)

    options = (*BREAKS, f"fracture.propagation='{propagation}'")
    usual = result_of(*options).events[0]
    assert (usual.kind, usual.cause) == ("cell_failure", "combined-tension")
    monkeypatch.setitem(CRITERIA, "careful", Criterion("careful", careful, needs=("sigma_t",)))
    both = "fracture.criteria=['combined-tension', 'careful']"
    with Recorder(tmp_path / "run.mcap") as recorder:
        first = run_scenario(load_scenario(CASE, [*SHORT, *options, both]), [recorder]).events[0]
    assert (first.kind, first.cause) == ("cell_failure", "careful")
    assert first.t_ns < 0.95 * usual.t_ns
    assert read_run(tmp_path / "run.mcap").events[0] == first


def test_a_structure(monkeypatch, usual):
    """The shipped cone with a hundred flat sides is nearly round; a wall in its place is another load."""
    flat = peak("structure.kind='multi-sided-cone'", "structure.sides=100")
    assert flat != usual
    assert flat == pytest.approx(usual, rel=0.05)

    def wall(s):
        return plane_slope(1.4, top=s.top, toe_depth=20.0, breaking=s.breaking)

    monkeypatch.setitem(KINDS, "wall", Kind(wall, takes=("slope", "waterline_radius", "neck_radius")))
    assert peak("structure.kind='wall'") > 1.5 * usual


def test_a_load(monkeypatch, usual):
    """A wind over the whole floe, against the drift: it holds the ice back and has its place in budget and energy."""

    class Wind:
        name = "wind"

        def on_sheet(self, t, sheet):
            return (sheet.area * -50.0)[:, None] * [1.0, 0.0, 0.0]

    monkeypatch.setitem(LOADS, "wind", lambda scenario: Wind())
    frames = []
    observer = SimpleNamespace(on_start=lambda info: None, on_frame=frames.append, on_close=lambda: None)
    windy = run_scenario(load_scenario(CASE, SHORT), [observer])
    assert windy.peaks.value[0] != usual
    assert [f.budget["fx_wind"] for f in frames] == pytest.approx([-50.0 * 55.0**2] * 20, rel=1e-9)
    assert windy.ledger["wind_load_work"] < 0.0


@pytest.mark.parametrize(
    ("criterion", "key"),
    [
        ("out-of-plane-shear", "shear_strength"),
        ("upward-bending", "upward_flexural_strength"),
        ("downward-bending", "downward_flexural_strength"),
        ("crack-tip-splitting", "fracture_toughness"),
    ],
)
def test_a_strength_is_asked_for_where_a_criterion_needs_it(tmp_path, criterion, key):
    """Only there: a scenario without it runs by the thesis's criterion, and with it by the other one."""
    text = "".join(line for line in load_scenario(CASE).text.splitlines(True) if not line.startswith("shear_strength"))
    file = tmp_path / "case.toml"
    file.write_text(text)
    assert getattr(load_scenario(file).ice, key) is None
    chosen = f"fracture.criteria=['{criterion}']"
    with pytest.raises(ScenarioError, match=f"ice.{key}: missing; the failure criterion {criterion} needs it"):
        load_scenario(file, [chosen])
    value = "'110 kPa*m^0.5'" if key == "fracture_toughness" else "'700 kPa'"
    assert build(load_scenario(file, [chosen, f"ice.{key}={value}"]))


@pytest.mark.parametrize(
    ("override", "says"),
    [
        ("structure.kind=conne", "structure.kind = 'conne': unknown name; did you mean cone?"),
        ("structure.kind=multi-sided-cone", "structure.sides: missing; a multi-sided-cone needs it, for example sides"),
        ("structure.sides=6", "structure.sides = 6: a cone has none: remove the key or change structure.kind"),
        ("fracture.criteria=['combined-tenson']", "unknown name; did you mean combined-tension?"),
        ("fracture.criteria=[]", "at least one name in brackets"),
        ("fracture.criteria=['spalling']", "ice.spalling_strength: missing; the failure criterion spalling needs it"),
        ("sheet.stiffness=hrenikoff", "sheet.stiffness = 'hrenikoff': unknown name; did you mean hrennikoff?"),
        ("coupling.scheme=countin", "known: lockstep, serial-explicit, parallel-explicit, serial-implicit"),
        ("contact.model=overlapping", "did you mean overlap?"),
    ],
)
def test_a_name_that_is_in_no_table_is_refused_with_the_nearest(override, says):
    with pytest.raises(ScenarioError) as error:
        load_scenario(CASE, [override])
    assert says in str(error.value)
