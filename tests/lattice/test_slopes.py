"""Slopes that strain the middle plane: forces are the slope of the energy, and what they do is booked exactly."""

from __future__ import annotations

import numpy as np
import pytest

from lattice.contact import NoContact
from lattice.cracks.cells import TURNING
from lattice.cracks.engine import CrackingEngine
from lattice.cracks.law import law_of
from lattice.cracks.lean import gather_lean
from lattice.cracks.motion import look_at_layered
from lattice.cracks.tiles import look, tile_of
from lattice.explicit.engine import SubSteps
from lattice.explicit.forces import NOTHING, touch_at
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.springs import spring_energy
from lattice.state import State
from lattice.stiffness import hrennikoff
from lattice.team import ALONE, TILES

ICE = Ice(E=8.7e9, nu=1 / 3, h=3.0, rho_i=846.0, rho_w=1006.0, sigma_t=450e3, sigma_f=450e3, sigma_c=4e6)
GRID = Grid(5, 6, 3.0)


def engine(grid=GRID, window=0.1, **options):
    none = np.zeros(grid.nodes, bool)
    law = law_of(ICE, 300.0, 0.3, grid.d)
    return CrackingEngine(grid, ICE, hrennikoff(ICE), window, law=law, held_in_plane=none, **options)


def placed(e, u, q):
    """The sheet at rest in this place, with its present slopes."""
    live = np.ones(e.grid.cells, bool)
    e.set_cells(live, np.full(e.grid.cells, np.inf), np.ones(e.grid.nodes, bool))
    e.put(e.motion.y, np.hstack((u, q)))
    e.put(e.motion.v, np.zeros((e.grid.nodes, 5)))
    nodes, layered = e._nodes(), e.layered.view()
    tiles = [tile_of(k, e.grid.nx, nodes.my) for k in range(TILES)]
    for tile in tiles:
        look(tile, False, nodes, e.mesh, layered)
    look_at_layered(ALONE, nodes, layered)
    for tile in tiles:
        gather_lean(tile.places, nodes.my, layered)
    return live


def test_forces_of_slopes_are_the_slope_of_their_energy():
    """On every node along x, y and z; without the forces across the sheet it is not."""
    random, e = np.random.default_rng(5), engine()
    u, q = 1e-4 * random.standard_normal((GRID.nodes, 2)), np.zeros((GRID.nodes, 3))
    q[:, 0] = 0.1 * random.standard_normal(GRID.nodes)

    def energy(u, q):
        return e.lean_energy(u, placed(e, u, q))

    placed(e, u, q)
    force = np.array(
        [on[: GRID.nx, : GRID.ny].ravel() for on in e.layered.lean.force.reshape(3, *e.motion.y.shape[1:])]
    )
    for node in (0, 1, 6, 13, 29):
        for c in range(3):
            step_u, step_q = np.zeros_like(u), np.zeros_like(q)
            (step_u if c < 2 else step_q)[node, c if c < 2 else 0] = 1e-6
            slope = (energy(u + step_u, q + step_q) - energy(u - step_u, q - step_q)) / 2e-6
            assert force[c, node] == pytest.approx(-slope, rel=1e-5, abs=1e-6 * np.abs(force).max())


def test_a_sheet_that_leans_as_a_whole_is_stretched_by_half_the_square_of_its_slope():
    """And it is not strained where its nodes come nearer by as much."""
    e, s = engine(), 0.02
    u, q = np.zeros((GRID.nodes, 2)), np.zeros((GRID.nodes, 3))
    q[:, 0] = s * GRID.xy[:, 0]
    live = placed(e, u, q)
    np.testing.assert_allclose(e.lean_strain()[0], 0.5 * s**2, rtol=1e-12)
    N = ICE.E * ICE.h / (1 - ICE.nu**2) * 0.5 * s**2
    assert e.lean_energy(u, live) == pytest.approx(0.5 * N * 0.5 * s**2 * GRID.cells * GRID.d**2, rel=1e-12)
    u[:, 0] = -0.5 * s**2 * GRID.xy[:, 0]
    live = placed(e, u, q)
    springs = 0.5 * N * 0.5 * s**2 * GRID.cells * GRID.d**2
    assert e.lean_energy(u, live) == pytest.approx(-springs, rel=1e-12)


@pytest.mark.parametrize("cracked", [False, True])
def test_a_swinging_sheet_keeps_its_energy(cracked):
    """A plate that is thrown into a bowl swings free: what slopes take or give is booked, and next to nothing."""
    e = engine(sub_steps=SubSteps(scaling=4.0))
    g = e.grid
    x, y = (GRID.xy - GRID.xy.mean(axis=0)).T
    s = State.rest(g.nodes)
    s.q_dot[:, 0] = 20.0 * (x**2 + y**2 - (x**2 + y**2).mean()) / 36.0
    everything, live = np.ones(g.nodes, bool), np.ones(g.cells, bool)
    e.set_cells(live, np.full(g.cells, np.inf), everything)
    e.start(s, everything, ())
    if cracked:
        e.begin(9, 0.3)
        live[9] = False
        e.set_cells(live, np.full(g.cells, np.inf), everything)
    e.layered.view().cells.losses[:] = 0.0

    def stored(u, q):
        springs = spring_energy(e.springs_u, live, u.ravel()) + spring_energy(e.springs_q, live, q.ravel())
        water = 0.5 * float((e.k_f * q.ravel() ** 2).sum())
        return springs + water + e.lean_energy(u, live) + e.layered_energy(u, q)

    def energy():
        """Leapfrog conserves x(n) . K x(n-1) / 2 and what is linear at the place in between."""
        v, ends = e.get(e.motion.v), 0.5 * (stored(*e.displacement(0.0)) + stored(*e.displacement(1.0)))
        kinetic = 0.5 * float((e.inertia_u * v[:, :2].ravel() ** 2).sum() + (e.inertia_q * v[:, 2:].ravel() ** 2).sum())
        return kinetic + 2.0 * stored(*e.displacement(0.5)) - ends

    start, touch, most = energy(), touch_at(0.0, NoContact(), np.zeros((0, 3)), g.ny), 0.0
    for _ in range(40):
        e.march(20, NOTHING, touch, lively=True)
        most = max(most, np.abs(e.lean_strain()).max())
        lost = sum(e.layered.losses.values())
        assert energy() + lost == pytest.approx(start, rel=1e-6 if not cracked else 1e-4)
    assert most > 1e-4
    assert abs(e.layered.losses["turning"]) < 1e-3 * start
    assert e.layered.view().cells.losses[:, TURNING].any()
