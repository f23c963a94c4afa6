"""Ice that varies: stiffness, stress and strength of single cells against those of ice that is so everywhere."""

import numpy as np
import pytest

from lattice.assembly import assemble, in_plane_springs, out_of_plane_springs
from lattice.cracks.cells import HOURGLASS, Plate, plate_at
from lattice.cracks.law import law_at, law_of, local_of, softening
from lattice.criteria.judge import Judge
from lattice.criteria.table import CRITERIA
from lattice.explicit.engine import ExplicitEngine
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.springs import SpringTable, spring_energy
from lattice.stiffness import equations_matching, hrennikoff
from lattice.varied import Varied

GRID = Grid(7, 6, 2.0)
VALUES = {
    "E": 5e9,
    "nu": 0.3,
    "h": 1.0,
    "rho_i": 900.0,
    "rho_w": 1025.0,
    "sigma_t": 5e5,
    "sigma_f": 5e5,
    "sigma_c": 2e6,
}
MORE = {"sigma_spall": -4e6, "sigma_f_upward": 6e5, "sigma_f_downward": 7e5, "sigma_shear": 6e5, "K_IC": 1e5}
RNG = np.random.default_rng(0)
VARIED = Varied(*(1.0 + 0.3 * RNG.uniform(-1, 1, (3, GRID.cells))))
ONE = Varied.uniform(GRID.cells)


def ice(strength=1.0, thickness=1.0, E=1.0):
    v = VALUES | MORE
    strengths = {k: strength * x for k, x in v.items() if k.startswith(("sigma", "K_"))}
    return Ice(**(v | strengths | {"h": thickness * v["h"], "E": E * v["E"]}))


def local_ice(cell):
    return ice(VARIED.strength[cell], VARIED.thickness[cell], VARIED.E[cell])


def motion():
    u, q = 1e-5 * RNG.standard_normal((GRID.nodes, 2)), 1e-5 * RNG.standard_normal((GRID.nodes, 3))
    return u, q


@pytest.mark.parametrize("springs", [hrennikoff, equations_matching])
def test_each_cell_has_the_springs_of_its_own_ice(springs):
    """Energy of every cell, in the plane and out of it, as that of a sheet that is all of that ice."""
    u, q = motion()
    for x, rows_of in ((u, in_plane_springs), (q, lambda s: out_of_plane_springs(s, GRID.d))):
        table = SpringTable.of(GRID, rows_of(springs(ice())), VARIED.springs)
        for cell in range(0, GRID.cells, 7):
            live = np.arange(GRID.cells) == cell
            own = SpringTable.of(GRID, rows_of(springs(local_ice(cell))))
            expected = spring_energy(own, live, x.ravel())
            assert spring_energy(table, live, x.ravel()) == pytest.approx(expected, rel=1e-12)
            assert spring_energy(SpringTable.of(GRID, rows_of(springs(ice()))), live, x.ravel()) != expected
        K = assemble(GRID, rows_of(springs(ice())), share=VARIED.springs)
        live = np.ones(GRID.cells, bool)
        assert 0.5 * x.ravel() @ (K @ x.ravel()) == pytest.approx(spring_energy(table, live, x.ravel()), rel=1e-12)


@pytest.mark.parametrize("name", list(CRITERIA))
def test_each_cell_is_judged_as_its_own_ice(name):
    u, q = motion()
    judge = Judge(GRID, ice(), (CRITERIA[name],), VARIED)
    live = np.ones(GRID.cells, bool)
    if CRITERIA[name].at_tips:
        live[12] = False  # a crack tip, beside which the others are judged
    standing = judge.standing(live)
    found = judge.utilisation(u, q, standing)
    for cell in np.flatnonzero(live)[::5]:
        alone = Judge(GRID, local_ice(cell), (CRITERIA[name],))
        assert found[cell] == pytest.approx(alone.utilisation(u, q, alone.standing(live))[cell], rel=1e-10)
    uniform = Judge(GRID, ice(), (CRITERIA[name],), ONE).utilisation(u, q, standing)
    assert (uniform == Judge(GRID, ice(), (CRITERIA[name],)).utilisation(u, q, standing)).all()


def test_the_sheet_is_solved_with_its_own_stiffness_and_after_cells_have_gone():
    """Woodbury's updates and a new factorisation give what the assembled matrix gives."""
    held = np.zeros((GRID.nodes, 2), bool)
    held[GRID.edge_nodes("x-")] = True
    engine = Engine(GRID, ice(), hrennikoff(ice()), held_in_plane=held, varied=VARIED)
    f = RNG.standard_normal((GRID.nodes, 3))
    gone = np.array([3, 17])
    engine.use(0.1)
    before = engine._out.solve(f.ravel())
    engine.remove(gone)
    after = engine._out.solve(f.ravel())
    live = ~np.isin(np.arange(GRID.cells), gone)
    on = engine.M_q / engine._a**2 + engine.C_q / engine._a + engine.k_f
    for x, intact in ((before, None), (after, live)):
        K = assemble(GRID, engine.rows_q, intact, VARIED.springs)
        assert K @ x + on * x == pytest.approx(f.ravel(), abs=1e-8)
    anew = Engine(GRID, ice(), hrennikoff(ice()), held_in_plane=held, varied=VARIED)
    anew.remove(gone)
    anew.use(0.1)
    assert anew._out.solve(f.ravel()) == pytest.approx(after, rel=1e-9)


def test_the_explicit_kernel_gives_the_forces_of_the_assembled_matrix():
    from lattice.explicit.kernels import sweep

    held = np.zeros((GRID.nodes, 2), bool)
    e = ExplicitEngine(GRID, ice(), hrennikoff(ice()), 0.01, held_in_plane=held, varied=VARIED)
    u, q = motion()
    e.put(e.motion.y, np.hstack((u, q)))
    sweep(e.motion, e.mesh.intact, e.mesh.kick, e.mesh.springs, e.mesh.pace, e.mesh.rows)
    v = e.get(e.motion.v)
    K_u = assemble(GRID, e.rows_u, share=VARIED.springs)
    K_q = assemble(GRID, e.rows_q, share=VARIED.springs)
    assert v[:, :2].ravel() == pytest.approx(-e.dt / e.M_u * (K_u @ u.ravel()), rel=1e-9)
    assert v[:, 2:].ravel() == pytest.approx(-e.dt / e.M_q * (K_q @ q.ravel() + e.k_f * q.ravel()), rel=1e-9)


@pytest.mark.parametrize("G_f", [0.0, 30.0, 60.0, 500.0])
def test_the_law_of_a_layered_cell_is_that_of_its_own_ice(G_f):
    """Also where cells of this size are brittle if they are strong, and soften if they are weak."""
    base = law_of(ice(), G_f, 0.3, GRID.d)
    local = local_of(base, VARIED.E, VARIED.strength, VARIED.thickness, softening(ice(), G_f, GRID.d))
    for cell in range(0, GRID.cells, 4):
        own = local_ice(cell)
        expected = law_of(own, G_f, 0.3, GRID.d)
        assert tuple(law_at(cell, base, local)) == pytest.approx(tuple(expected), rel=1e-12)
        K_out = hrennikoff(ice()).K_out
        plate = plate_at(cell, Plate(GRID.d, 1.0, 0.5 * K_out, HOURGLASS * 5e9), local)
        shear = 0.5 * hrennikoff(own).K_out
        assert tuple(plate) == pytest.approx((GRID.d, own.h, shear, HOURGLASS * own.E * own.h), rel=1e-12)
    brittle = law_of(ice(), 0.0, 0.3, GRID.d)
    local = local_of(brittle, VARIED.E, VARIED.strength, VARIED.thickness)
    assert (local.e_f == local.e_0).all()


def test_cells_have_all_ice_or_are_refused():
    with pytest.raises(ValueError, match="must be above 0"):
        Varied(np.ones(3), np.array([1.0, 0.0, 1.0]), np.ones(3))
