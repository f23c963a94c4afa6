"""Several named loads on one sheet: each booked under its own name, together the same as their sum."""

import numpy as np
import pytest

from lattice.contact import NoContact
from lattice.explicit.engine import ExplicitEngine
from lattice.explicit_sheet import ExplicitSheet
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.loads import NodeLoad
from lattice.sheet import Sheet
from lattice.stiffness import hrennikoff

GRID = Grid(9, 7, 3.0)
ICE = Ice(E=8.7e9, nu=1 / 3, h=3.0, rho_i=846.0, rho_w=1006.0, sigma_t=1e15, sigma_f=1e15, sigma_c=5e15)
ENGINES = [Sheet, ExplicitSheet]


def load(name, x, z, at=slice(None)):
    force_u, force_q = np.zeros((GRID.nodes, 2)), np.zeros((GRID.nodes, 3))
    force_u[at, 0], force_q[at, 0] = x, z
    return NodeLoad(name, force_u, force_q)


def loads():
    return [load("rubble", 2e3, -5e4, GRID.edge_nodes("x+")), load("current", 4e2, 0.0)]


def floe(engine):
    held = np.zeros(GRID.nodes, bool)
    held[GRID.edge_nodes("x-")] = True
    options = {"held_in_plane": held, "damping": 2000.0, "alpha": 1e-3}
    if engine is Sheet:
        return Sheet(Engine(GRID, ICE, hrennikoff(ICE), **options), 0.025)
    return ExplicitSheet(ExplicitEngine(GRID, ICE, hrennikoff(ICE), 0.025, **options))


def press(engine, make):
    sheet = floe(engine)
    for k in range(60):
        out = sheet.advance(0.025 * k, make(), NoContact(), lambda nodes: None)
    return sheet, out


def summed():
    a, b = loads()
    return [NodeLoad("all", a.force_u + b.force_u, a.force_q + b.force_q)]


@pytest.mark.parametrize("engine", ENGINES)
def test_two_loads_move_the_sheet_as_their_sum(engine):
    (two, _), (one, _) = press(engine, loads), press(engine, summed)
    np.testing.assert_allclose(two.state.q, one.state.q, rtol=0, atol=1e-9 * np.abs(one.state.q).max())
    assert two.energy.received == pytest.approx(one.energy.received, rel=1e-9)
    assert abs(one.energy.received) > 0.0


@pytest.mark.parametrize(("engine", "tolerance"), [(Sheet, 1e-9), (ExplicitSheet, 1e-3)])
def test_each_load_is_booked_under_its_name(engine, tolerance):
    sheet, out = press(engine, loads)
    assert out.reaction.applied["rubble"] == pytest.approx((2e3 * GRID.ny, -5e4 * GRID.ny), rel=1e-12)
    assert out.reaction.applied["current"] == pytest.approx((4e2 * GRID.nodes, 0.0), rel=1e-12)
    work = {name: book.work for name, book in sheet.energy.loads.items()}
    assert set(work) == {"rubble", "current"}
    assert work["rubble"] > 10.0 * work["current"] > 0.0
    assert abs(sheet.energy.residual) < tolerance * sheet.energy.received
    work["rubble"] *= -1.0
    assert abs(sum(work.values()) - sheet.energy.received) > 0.1 * sheet.energy.received  # a wrong sign is noticed
    assert sheet.energy.loads["current"].push == pytest.approx(4e2 * GRID.nodes * 60 * 0.025, rel=1e-9)


@pytest.mark.parametrize("engine", ENGINES)
def test_the_sum_of_forces_closes_with_two_loads(engine):
    """What acts is what the water, inertia, drag and supports take."""
    r = press(engine, loads)[1].reaction
    parts = np.array([r.foundation, r.drag, r.inertia, r.held, *r.applied.values()])
    assert np.abs(parts.sum(axis=0)).max() < 1e-3 * np.abs(parts).max()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_start_at_rest_shares_the_work_by_force_and_path(engine):
    sheet = floe(engine)
    sheet.rest_under(loads())
    q, u = sheet.state.q, sheet.state.u
    for each in loads():
        done = 0.5 * float((each.force_u * u).sum() + (each.force_q * q).sum())
        assert sheet.energy.loads[each.name].work == pytest.approx(done, rel=1e-6)
    assert abs(sheet.energy.residual) < 1e-9 * sheet.energy.stored


@pytest.mark.parametrize("engine", ENGINES)
def test_saved_books_are_not_written_to(engine):
    sheet = floe(engine)
    sheet.advance(0.0, loads(), NoContact(), lambda nodes: None)
    saved, before = sheet.save(), {n: b.work for n, b in sheet.energy.loads.items()}
    sheet.advance(0.025, loads(), NoContact(), lambda nodes: None)
    assert sheet.energy.loads["rubble"].work != before["rubble"]
    sheet.restore(saved)
    assert {n: b.work for n, b in sheet.energy.loads.items()} == before


@pytest.mark.parametrize("engine", ENGINES)
def test_two_loads_of_one_name_are_refused(engine):
    with pytest.raises(ValueError, match="two loads of one name"):
        floe(engine).advance(0.0, [loads()[0], loads()[0]], NoContact(), lambda nodes: None)
