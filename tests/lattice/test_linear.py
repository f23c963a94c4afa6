"""The factorised system that loses cells gives what a fresh factorisation gives."""

import numpy as np
import pytest

from lattice.assembly import CellSprings, in_plane_springs, out_of_plane_springs
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.linear import MAX_RANK, CrackedSystem
from lattice.springs import SpringTable, spring_energy, spring_force
from lattice.stiffness import hrennikoff

GRID = Grid(9, 8, 2.0)
ICE = Ice(E=8.7e9, nu=1 / 3, h=3.0, rho_i=846.0, rho_w=1006.0)
TABLES = {"in-plane": in_plane_springs(hrennikoff(ICE)), "out-of-plane": out_of_plane_springs(hrennikoff(ICE), GRID.d)}


def system(rows, intact):
    n = GRID.nodes * rows.shape[1] // 4
    held = np.zeros(n, bool)
    held[: rows.shape[1] // 4 * GRID.ny] = True
    return CrackedSystem(GRID, CellSprings(rows, np.ones((GRID.cells, 2))), intact, np.full(n, 1e7), 1.3, held)


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize("cells", [1, 9, 52])
def test_removing_cells_is_factorising_without_them(name, cells):
    rows, rng = TABLES[name], np.random.default_rng(1)
    gone = rng.choice(GRID.cells, cells, replace=False)
    updated = system(rows, np.ones(GRID.cells, bool))
    for cell in gone:
        updated.remove(np.array([cell]))
    intact = np.ones(GRID.cells, bool)
    intact[gone] = False
    fresh = system(rows, intact)
    b = rng.normal(size=GRID.nodes * rows.shape[1] // 4)
    np.testing.assert_allclose(updated.solve(b), fresh.solve(b), rtol=1e-9, atol=1e-9 * np.abs(fresh.solve(b)).max())
    assert len(rows) < MAX_RANK < 52 * len(rows)  # one cell is an update, many are a new factorisation


@pytest.mark.parametrize("name", TABLES)
def test_compliance_and_forces_between_the_halves_are_parts_of_the_inverse(name):
    rows = TABLES[name]
    s = system(rows, np.ones(GRID.cells, bool))
    s.remove(np.array([20, 21]))
    dof = np.array([2, 60, 61, 90])  # the first one is held
    identity = np.eye(GRID.nodes * rows.shape[1] // 4)
    columns = np.array([s.solve(identity[k]) for k in dof]).T
    np.testing.assert_allclose(s.compliance(dof), columns[dof], rtol=1e-9, atol=1e-20)
    f = np.array([3.0, -1.0, 2.0, 0.5])
    b = np.random.default_rng(4).normal(size=len(identity))
    half = s.half(b)
    before = s.at(dof, half)
    s.add(dof, f, half)
    after, x = s.at(dof, half), s.whole(half)
    np.testing.assert_allclose(before, s.solve(b)[dof], rtol=1e-9, atol=1e-18)
    np.testing.assert_allclose(after - before, s.compliance(dof) @ f, rtol=1e-7, atol=1e-18)
    np.testing.assert_allclose(x, s.solve(b) + columns @ f, rtol=1e-8, atol=1e-18)
    assert s.compliance(dof)[0].any() == False  # noqa: E712  a held degree of freedom does not move


def test_spring_force_is_the_gradient_of_the_energy():
    springs, live = SpringTable.of(GRID, TABLES["in-plane"]), np.arange(GRID.cells) != 5
    rng = np.random.default_rng(2)
    x, direction = rng.normal(size=(2, 2 * GRID.nodes))
    ahead, behind = (spring_energy(springs, live, x + step * direction) for step in (1e-3, -1e-3))
    assert (ahead - behind) / 2e-3 == pytest.approx(spring_force(springs, live, x) @ direction, rel=1e-9)


def test_a_right_side_that_comes_again_after_a_failure_is_solved_for_the_cells_that_are_left():
    rows = TABLES["in-plane"]
    s, b = system(rows, np.ones(GRID.cells, bool)), np.random.default_rng(6).normal(size=2 * GRID.nodes)
    before = s.solve(b)
    s.remove(np.array([20]))
    after = s.solve(b.copy())
    np.testing.assert_allclose(after, system(rows, np.arange(GRID.cells) != 20).solve(b), rtol=1e-9, atol=1e-18)
    assert np.abs(after - before).max() > 1e-3 * np.abs(after).max()
