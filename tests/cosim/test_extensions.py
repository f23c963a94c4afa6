"""What is added from outside to a table of names can be chosen by a scenario at once, and acts in its run."""

from __future__ import annotations

from dataclasses import astuple

import pytest

from cosim.run import run_scenario
from cosim.scenario.errors import ScenarioError
from cosim.scenario.loading import load_scenario
from coupling.contact import CONTACTS, OverlapContact
from coupling.schemes import SCHEMES, serial_explicit
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
    windows = []

    def counting(scheduler):
        windows.append(scheduler.t_ns)
        return serial_explicit(scheduler)

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


@pytest.mark.parametrize(
    ("override", "says"),
    [
        ("sheet.stiffness=hrenikoff", "sheet.stiffness = 'hrenikoff': unknown name; did you mean hrennikoff?"),
        ("coupling.scheme=countin", "known: serial-explicit, parallel-explicit, serial-implicit"),
        ("contact.model=overlapping", "did you mean overlap?"),
    ],
)
def test_a_name_that_is_in_no_table_is_refused_with_the_nearest(override, says):
    with pytest.raises(ScenarioError) as error:
        load_scenario(CASE, [override])
    assert says in str(error.value)
