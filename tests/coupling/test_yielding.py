"""What the rubble knows of a sheet that yields: displacement and velocity after a window, for all sections at once."""

import numpy as np
import pytest

from cosim.build import build
from cosim.scenario.loading import load_scenario
from coupling.interface import SimulationError
from coupling.sheet_port.yielding import Yielding

HEAVY = ["sheet.nodes=[30,30]", "rubble.initial_volume='1500 m^3'", "scenario.duration='2 s'"]


@pytest.fixture(scope="module")
def sheet():
    return build(load_scenario("scenarios/van_vliet_2018_floe_165m", ["sheet.nodes=[30,30]"])).sheet.sheet


def test_the_compliance_is_that_of_the_lattice(sheet):
    """Symmetric, positive, its row sums what all sections do together; one alone is stiffer than all together."""
    nodes = sheet.front[8:22] * sheet.grid.ny + np.arange(8, 22)
    G = Yielding(sheet).matrix(nodes)
    together = sheet.answer(nodes)[0]
    for axis in range(2):
        assert pytest.approx(G[axis].T, rel=1e-12) == G[axis]
        assert np.linalg.eigvalsh(G[axis]).min() > 0.0
        assert G[axis].sum(axis=1) == pytest.approx(together[:, axis], rel=1e-6)
        assert (np.diag(G[axis]) < together[:, axis]).all()


def test_columns_are_kept_while_their_nodes_stay_in_front(sheet, monkeypatch):
    nodes = sheet.front[8:12] * sheet.grid.ny + np.arange(8, 12)
    known = Yielding(sheet)
    first = known.matrix(nodes)
    steps = []
    step = sheet.engine.step
    monkeypatch.setattr(sheet.engine, "step", lambda *a: steps.append(1) or step(*a))
    assert known.matrix(nodes[1:]).tobytes() == first[:, 1:, 1:].tobytes()
    assert not steps
    known.matrix(np.append(nodes, sheet.front[14] * sheet.grid.ny + 14))
    assert len(steps) == 1


def test_heavy_rubble_lies_still_under_a_light_sheet():
    """The lift swung between 0 and 8 MN when the rubble knew the stiffness of single nodes for a part of the window."""
    scheduler = build(load_scenario("scenarios/van_vliet_2018_floe_165m", HEAVY))
    start = scheduler.rubble.forces_on_sheet().force[:, 2].sum()
    on_cone = scheduler.rubble.layer.wrench_on_structure[2]  # of what has slipped into the gap before it
    lifts = []
    while scheduler.t_ns < 2_000_000_000:
        scheduler.macro_step()
        lifts.append(scheduler.rubble.forces_on_sheet().force[:, 2].sum())
    assert start + on_cone == pytest.approx(1500 * 160 * 9.81, rel=0.05)
    assert np.array(lifts) == pytest.approx(start, rel=0.1)
    assert scheduler.ledger.mass_error < 1e-14


def test_rubble_that_would_break_the_sheet_at_rest_is_refused():
    with pytest.raises(SimulationError, match=r"utilisation .*initial_volume"):
        build(
            load_scenario(
                "scenarios/van_vliet_2018_floe_165m",
                [*HEAVY, "ice.tensile_strength='200 kPa'", "ice.flexural_strength='200 kPa'"],
            )
        )
