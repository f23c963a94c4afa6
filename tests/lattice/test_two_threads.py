"""A sheet with closing cracks on two threads: the bits of one, and threads that wait for each other."""

import numpy as np
import pytest

from lattice.contact import Faces
from lattice.cracks.make import Measured, cracking_sheet
from lattice.explicit.forces import NOTHING, indenter
from lattice.explicit.layout import W
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.state import State
from lattice.stiffness import hrennikoff
from lattice.team import CREW, TILES

ICE = Ice(E=5e9, nu=0.3, h=1.0, rho_i=900.0, rho_w=1025.0, sigma_t=5e5, sigma_f=5e5, sigma_c=5e6)


def faces(m, overlap):
    """One point at each of m nodes that presses down where the node overlaps by so much and as it moves up."""
    up, shape = np.zeros((m, 1, 3)), (m, 1)
    up[..., 2] = 1.0
    return Faces(np.full(shape, overlap), np.zeros(shape), up, np.full(shape, 1.0), -2.0 * up, 1e9, 2e6)


def pressed(threads, nx=21, ny=18, blocks=40, crushing=False):
    """A clamped floe that is pushed down in the middle until it is cracked all over; what is known of it then.

    By springs, or by a contact that is that at the end of a sub-step.
    """
    g = Grid(nx, ny, 2.0)
    edge = np.zeros(g.nodes, bool)
    edge[np.concatenate([g.edge_nodes(side) for side in ("x-", "x+", "y-", "y+")])] = True
    measured = Measured(15.0, 0.3, strength=5e5)
    options = {"held_in_plane": edge, "damping": 2e3, "alpha": 1e-4, "threads": threads}
    e = cracking_sheet(g, ICE, hrennikoff(ICE), 0.05, measured, **options).engine
    everything, live, seen = np.ones(g.nodes, bool), np.ones(g.cells, bool), []
    e.set_cells(live, np.full(g.cells, ICE.sigma_t), everything)
    e.start(State.rest(g.nodes), everything, ())
    middle = g.ny // 2
    touch = indenter(np.arange(2, g.nx - 2) * g.ny + middle, g.ny, 0.02 * float(e.inertia_q[2::3].min()) / e.dt**2)
    for k in range(blocks):
        touch.at[:, W] = -2e-3 * (k + 1)
        if crushing:
            touch = touch._replace(faces=faces(len(touch.row), 1e-3 * (k + 1)))
        made = e.march(10, NOTHING, touch, lively=k % 2 == 0)
        seen += [made.steps, made.contact, made.contact_work, made.loss, made.hold]
        if made.failed:
            e.crack(live)
    found = [*e.motion, e.lean_strain(), e.layered.damage, e.layered.thrust, *e.crack_losses.values()]
    return e.layered.count, e.layered.losses, b"".join(np.asarray(x).tobytes() for x in (*seen, *found))


def test_two_threads_have_the_bits_of_one():
    count, losses, bits = pressed(1)
    assert count > 100
    assert losses["cracking"] > 0.0
    assert losses["turning"] != 0.0
    assert pressed(2)[2] == bits


def test_so_they_have_where_the_contact_is_that_at_the_end_of_a_sub_step():
    count, _, bits = pressed(1, crushing=True)
    assert count > 10
    assert bits != pressed(1)[2]
    assert pressed(2, crushing=True)[2] == bits


@pytest.mark.parametrize("nx", [2, 3, 4])
def test_so_do_sheets_of_a_few_rows(nx):
    assert pressed(2, nx=nx + 4, blocks=10)[2] == pressed(1, nx=nx + 4, blocks=10)[2]


def test_the_order_of_halves_is_no_matter_of_luck():
    """Twenty times the same."""
    assert len({pressed(2, nx=9, ny=9, blocks=6)[2] for _ in range(20)}) == 1


@pytest.mark.parametrize("threads", [0, TILES + 1])
def test_there_are_no_other_numbers_of_threads(threads):
    with pytest.raises(ValueError, match="threads"):
        pressed(threads, blocks=0)


def test_each_thread_knows_its_place():
    teams = []
    assert CREW.run(lambda team: teams.append(team) or team.member, TILES, 24) == 0
    assert sorted(team.member for team in teams) == list(range(TILES))
    assert all(team.size == TILES and len(team.given) >= 24 for team in teams)
