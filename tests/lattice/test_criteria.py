"""Failure criteria in a run: chosen by name, judged alike by both engines, added from outside; limits at crack tips."""

from dataclasses import replace

import numpy as np
import pytest

from lattice.contact import NoContact
from lattice.criteria.laws import combined_tension, crack_tip_bending
from lattice.criteria.table import CRITERIA, THESIS, Criterion, chosen, needed
from lattice.explicit.engine import ExplicitEngine
from lattice.explicit_sheet import ExplicitSheet
from lattice.grid import Grid
from lattice.ice import BeamTest, Ice
from lattice.implicit.engine import Engine
from lattice.loads import NodeLoad
from lattice.sheet import Sheet
from lattice.state import State
from lattice.stiffness import hrennikoff
from lattice.strain import CellState

GRID = Grid(9, 7, 3.0)
ICE = Ice(
    E=8.7e9,
    nu=1 / 3,
    h=3.0,
    rho_i=846.0,
    rho_w=1006.0,
    sigma_t=0.6e6,
    sigma_f=0.9e6,
    sigma_c=4e6,
    beam_test=BeamTest(length=18.0, width=6.0, failure_load=450e3, factor=0.75),
    sigma_spall=-20e6,
    sigma_f_upward=0.7e6,
    sigma_f_downward=1.1e6,
    sigma_shear=0.7e6,
    K_IC=2e5,
)
FREE = np.zeros(GRID.nodes, bool)
ENGINES = [Sheet, ExplicitSheet]
X, Y = GRID.xy.T


def sheet(engine, criteria=THESIS, ice=ICE, **options):
    if engine is Sheet:
        return Sheet(
            Engine(GRID, ice, hrennikoff(ice), held_in_plane=FREE), 1e-3, share=0.0, criteria=criteria, **options
        )
    made = ExplicitEngine(GRID, ice, hrennikoff(ice), 1e-3, held_in_plane=FREE)
    return ExplicitSheet(made, share=0.0, criteria=criteria, **options)


def rough(seed=3, size=2e-4):
    rng, n = np.random.default_rng(seed), GRID.nodes
    return State(*(size * rng.standard_normal((n, k)) for k in (2, 3, 2, 3)))


def bent(stress):
    """Uniaxial bending stress [Pa] at the faces, top in tension, and its cracked cell in the middle taken out."""
    s = State.rest(GRID.nodes)
    curvature = stress / ICE.E / (0.5 * ICE.h)
    s.q[:, 1], s.q[:, 2] = curvature * X, -ICE.nu * curvature * Y
    return s


def pull(stress):
    """Load on the ends x- and x+ that makes a uniform stress [Pa]."""
    share, F = np.full(GRID.ny, GRID.d), np.zeros((GRID.nodes, 2))
    share[[0, -1]] *= 0.5
    for side, sign in (("x+", 1.0), ("x-", -1.0)):
        F[GRID.edge_nodes(side), 0] = sign * stress * ICE.h * share
    return [NodeLoad("pull", F, np.zeros((GRID.nodes, 3)))]


def run(engine, criteria, stress, windows=30, ice=ICE):
    """Outcomes of a sheet that is pulled (or pushed) at both ends with a stress that grows to ``stress`` [Pa]."""
    floe, out = sheet(engine, criteria, ice), []
    for k in range(windows):
        out.append(floe.advance(1e-3 * k, pull(stress * (k + 1) / windows), NoContact(), lambda nodes: None))
    return floe, out


@pytest.mark.parametrize("engine", ENGINES)
def test_the_limit_beside_a_crack_tip_is_one_of_bending(engine):
    """(4.31) bounds the bending stress: there the sheet is used up as the criterion of section 4.2.2 says, whatever
    the ratio of tensile and flexural strength."""
    floe = sheet(engine)
    hole = 4 * (GRID.ny - 1) + 3
    floe.intact[hole] = False
    s = bent(ICE.stress_beside_crack(GRID.d))
    used = floe._utilisation(s).reshape(GRID.nx - 1, GRID.ny - 1)
    alone = crack_tip_bending(CellState.of(GRID, s.u, s.q), ICE).reshape(used.shape)
    assert used[4, 2] == pytest.approx(1.0, rel=1e-9)
    assert used[3:6, 2:5][used[3:6, 2:5] > 0] == pytest.approx(alone[3:6, 2:5][used[3:6, 2:5] > 0], rel=1e-9)
    assert used[0, 0] == pytest.approx(ICE.stress_beside_crack(GRID.d) / ICE.sigma_f, rel=1e-9)


def test_without_a_beam_test_a_crack_tip_bears_what_all_cells_bear():
    ice = replace(ICE, beam_test=None)
    floe = sheet(Sheet, ice=ice)
    floe.intact[20] = False
    assert floe.standing.beside.any()
    assert floe.standing.limit == pytest.approx(np.full(GRID.cells, ice.sigma_t), rel=1e-12)


@pytest.mark.parametrize("name", sorted(CRITERIA))
def test_both_engines_and_the_library_see_the_same(name):
    """With broken cells; what only holds at crack tips is 0 elsewhere."""
    criterion, s, used = CRITERIA[name], rough(), []
    for engine in ENGINES:
        floe = sheet(engine, (criterion,))
        floe.intact[[12, 20, 21]] = False
        used.append(floe._utilisation(s))
    np.testing.assert_array_equal(used[0], used[1])
    judged = np.where(floe.standing.live & (floe.standing.beside | (not criterion.at_tips)), 1.0, 0.0)
    alone = criterion.judge(CellState.of(GRID, s.u, s.q, limit=floe.standing.limit), ICE)
    np.testing.assert_allclose(used[0], judged * alone, rtol=1e-12)
    assert 0 < np.count_nonzero(used[0]) < GRID.cells


def test_of_several_criteria_the_largest_counts_and_is_named():
    names = ("combined-tension", "compression", "out-of-plane-shear")
    floe, s = sheet(Sheet, chosen(names)), rough()
    each = np.array([CRITERIA[n].judge(CellState.of(GRID, s.u, s.q), ICE) for n in names])
    np.testing.assert_allclose(floe._utilisation(s), each.max(axis=0), rtol=1e-12)
    causes = floe.judge.causes(s.u, s.q, floe.standing, np.arange(GRID.cells))
    assert causes == [names[k] for k in each.argmax(axis=0)]
    assert len(set(causes)) > 1


@pytest.mark.parametrize("engine", ENGINES)
def test_a_criterion_from_outside_acts_in_a_run(engine, monkeypatch):
    """Cells whose strain along x passes 2e-5, long before the strength of the ice: one function, one line."""

    def stretch(state, ice):
        return state.strains.e11 / 2e-5

    monkeypatch.setitem(CRITERIA, "stretch", Criterion("stretch", stretch))
    _, quiet = run(engine, THESIS, 0.3e6)
    floe, broken = run(engine, chosen(["combined-tension", "stretch"]), 0.3e6)
    assert not any(o.failed for o in quiet)
    first = next(o for o in broken if o.failed)
    assert set(first.causes) == {"stretch"}
    assert len(first.causes) == len(first.failed)
    assert not floe.intact.all()


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("names", "stress", "cause"),
    [
        (["combined-tension", "compression"], 0.7e6, "combined-tension"),
        (["compression", "principal-stress"], -4.5e6, "compression"),
        (["principal-stress"], 0.7e6, "principal-stress"),
    ],
)
def test_an_event_knows_its_criterion(engine, names, stress, cause):
    _, out = run(engine, chosen(names), stress)
    first = next(o for o in out if o.failed)
    assert first.causes[0] == cause


def test_the_explicit_engine_finds_an_overload_within_a_block():
    """The same criterion under another name is judged at the end of blocks: not before, and at most a block late."""
    copy = Criterion("copy", lambda state, ice: combined_tension(state, ice), limited=True)
    screened, blocks = (run(ExplicitSheet, c, 0.9e6)[0] for c in (THESIS, (copy,)))
    late = blocks.failure_times[0] - screened.failure_times[0]
    assert -1e-9 <= late <= blocks.block * blocks.engine.dt * (1 + 1e-9)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_missing_strength_is_named(engine):
    ice = replace(ICE, sigma_shear=np.inf)
    sheet(engine, ice=ice)
    with pytest.raises(ValueError, match=r"sigma_shear is missing.*out-of-plane-shear"):
        sheet(engine, chosen(["combined-tension", "out-of-plane-shear"]), ice)


@pytest.mark.parametrize("name", sorted(CRITERIA))
def test_what_a_criterion_needs_is_what_it_reads(name):
    """Without one of the strengths that it needs the answer is another; the others it does not look at."""
    criterion, s = CRITERIA[name], rough()
    strengths = (
        "sigma_t",
        "sigma_f",
        "sigma_c",
        "sigma_spall",
        "sigma_f_upward",
        "sigma_f_downward",
        "sigma_shear",
        "K_IC",
    )
    state = CellState.of(GRID, s.u, s.q)
    before = criterion.judge(state, replace(ICE, beam_test=None))
    for strength in strengths:
        other = replace(ICE, beam_test=None, **{strength: 1.7 * getattr(ICE, strength)})
        changed = not np.array_equal(criterion.judge(state, other), before)
        assert changed == (strength in needed([criterion])), strength


def test_an_unknown_criterion_is_refused_with_the_known_ones():
    with pytest.raises(ValueError, match="unknown failure criterion 'tear': use some of tension, "):
        chosen(["tension", "tear"])
    with pytest.raises(ValueError, match="no failure criterion"):
        chosen([])
    assert needed(chosen(["spalling", "compression", "tension"])) == ("sigma_spall", "sigma_c", "sigma_t")
