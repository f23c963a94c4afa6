"""Loads on the ice beside structure and rubble: booked under their names, in runs that still balance."""

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

import cosim.build
from cosim.scenario.loading import load_scenario
from coupling.budget import TERMS
from coupling.current import Current
from coupling.interface import SheetMotion, SimulationError
from rubble.energy import energy_terms
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab

QUICK = ("sheet.nodes=[20, 20]", "drift.velocity='0.4 m/s'", "contact.strength='800 kPa'")


class Wind:
    """A load from outside: a shear on the ice that grows with time."""

    name = "wind"

    def on_sheet(self, t, sheet):
        return (sheet.area * 20.0 * (1.0 + t))[:, None] * np.array([1.0, 0.2, -0.5])


def run(loads, windows, overrides=(), *, wrong=None):
    with threadpool_limits(1):
        s = cosim.build.build(load_scenario("van_vliet_2018_floe_55m_centre", [*QUICK, *overrides]))
        s.sheet.loads = loads
        if wrong is not None:
            wrong(s)
        return s, [s.macro_step() for _ in range(windows)]


@pytest.mark.parametrize("propagation", ["quasi-static", "dynamic"])
def test_a_load_from_outside_acts_in_a_run_under_its_own_name(propagation):
    """The sheet carries it to structure and supports: the budget closes with its term, the energy with its work."""
    s, frames = run((Wind(),), 120, [f"fracture.propagation='{propagation}'", "rubble.enabled=false"])
    t = 0.05 * np.arange(120)
    there = [f.sheet.present.all() for f in frames]
    area = s.sheet.sheet.grid.area.sum()
    wind = np.array([[f.budget["fx_wind"], f.budget["fz_wind"]] for f in frames])
    np.testing.assert_allclose(
        wind[there], (20.0 * area * (1.0 + t))[there, None] * [1.0, -0.5], rtol=1e-6, atol=1e-6 * area
    )
    load = np.array([f.load.sum(axis=0)[[0, 2]] for f in frames])
    total = np.array([[sum(f.budget[f"{a}_{n}"] for n in (*TERMS, "wind")) for a in ("fx", "fz")] for f in frames])
    close = 1e-9 if propagation == "quasi-static" else 0.02
    quiet = slice(1, 60)
    assert np.abs(total - load)[quiet].max() < close * np.abs(load).max()
    assert all(f.budget["fx_staggering"] == 0.0 for f in frames)
    assert frames[-1].ledger["wind_load_work"] > 1e3
    assert s.ledger.energy.relative < 1e-3


def test_a_load_that_nobody_books_is_found():
    """The twin whose work is left out of the balance stops, and without the load nothing has its name."""

    def leave_out(s):
        kind = type(s.sheet)
        own = property(lambda p: {k: v for k, v in kind.energy.__get__(p).items() if k != "wind_load_work"})
        s.sheet.__class__ = type("Twin", (kind,), {"energy": own})

    with pytest.raises(SimulationError, match="energy balance is off"):
        run((Wind(),), 60, ["rubble.enabled=false"], wrong=leave_out)
    _, frames = run((), 2, ["rubble.enabled=false"])
    assert not [name for name in (*frames[-1].budget, *frames[-1].ledger) if "wind" in name]


def test_two_loads_of_one_name_are_refused():
    with pytest.raises(ValueError, match="two loads of one name"):
        run((Wind(), Wind()), 1, ["rubble.enabled=false"])


def test_a_current_drags_on_the_underside_by_the_motion_through_it():
    """rho C_f |v| v / 2 per area along v; none on ice that moves along with it, none across."""
    velocity = np.array([[0.1, 0.0, 0.3], [0.5, -0.2, 0.0], [0.1, 0.0, 0.0]])
    sheet = SheetMotion(np.zeros((3, 3)), velocity, np.array([4.0, 2.0, 4.0]), np.array([True, True, False]))
    force = Current((0.5, -0.2), 1000.0, 4e-3).on_sheet(0.0, sheet)
    v = np.array([0.4, -0.2])
    np.testing.assert_allclose(force[0, :2], 0.5 * 1000.0 * 4e-3 * 4.0 * np.linalg.norm(v) * v, rtol=1e-12)
    assert not force[1:].any()
    assert not force[:, 2].any()
    with pytest.raises(ValueError, match="finite"):
        Current((np.nan, 0.0), 1000.0, 4e-3)


@pytest.mark.parametrize("current", [(0.6, 0.0), (0.0, -0.4), (0.5, 0.3)])
def test_a_floating_block_comes_to_drift_with_the_current(current):
    """Drag by the motion through the water: it is taken along to the speed of the water, and its energy is booked."""
    physics = RubblePhysics(rho_i=900.0, rho_w=1000.0, thickness=1.0, form_drag=5.0, current=current)
    layer = RubbleLayer(physics, 2.0, origin=0.0)
    box = np.array([(-1.0, -0.9), (1.0, -0.9), (1.0, 0.1), (-1.0, 0.1)])
    layer.add_block(0, Slab(box, np.array([-1.0, 1.0]), np.array([2.0]), 900.0))
    for _ in range(600):
        layer.advance(10)
    block = layer.blocks[0]
    speed = block.velocity[:2].copy()
    np.testing.assert_allclose(speed, current, atol=0.06)
    assert np.abs(speed[np.abs(current) > 0]).min() > 0.2
    kinetic = 0.5 * block.mass * (speed @ speed + block.velocity[2] ** 2)
    given = -energy_terms(layer)["drag_loss"]
    assert given == pytest.approx(kinetic, rel=0.02)


def test_a_current_under_the_sheet_changes_a_run_that_still_balances():
    _, still = run((), 100)
    s, flowing = run((Current((0.3, 0.0), 1006.0, 4e-3),), 100)
    assert np.abs(flowing[-1].load - still[-1].load).max() > 0.0
    assert flowing[-1].ledger["current_load_work"] != 0.0
    assert s.ledger.energy.relative < 1e-3
