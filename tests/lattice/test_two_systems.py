"""A sheet with open cracks on two threads, one for each of its systems: the bits of one."""

import numpy as np
import pytest

from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.state import State
from lattice.stiffness import hrennikoff
from lattice.team import TILES
from tests.lattice.pushes import Push, no_force

GRID = Grid(31, 26, 2.0)
ICE = Ice(E=5e9, nu=0.3, h=1.0, rho_i=900.0, rho_w=1025.0, sigma_t=5e5, sigma_f=5e5, sigma_c=5e6)


def marched(threads):
    """The states of a floe that is pushed at its front, loses cells on the way, and goes on."""
    held = np.zeros(GRID.nodes, bool)
    held[GRID.edge_nodes("x-")] = True
    e = Engine(GRID, ICE, hrennikoff(ICE), held_in_plane=held, damping=2e3, alpha=1e-3, threads=threads)
    nodes, state, seen = GRID.edge_nodes("x+"), State.rest(GRID.nodes), []
    force = np.random.default_rng(3).normal(scale=1e4, size=(len(nodes), 3))
    for k in range(12):
        push = Push(nodes, (k + 1) * force, 0.4, 0.0)
        state = e.step(0.05 * k, 0.05, state, *no_force(GRID), push).state
        e.remove(np.array([700 + k, 300 + 2 * k]))
        seen.append(b"".join(a.tobytes() for a in (state.u, state.q, state.u_dot, state.q_dot)))
    return seen


def test_two_threads_have_the_bits_of_one():
    one = marched(1)
    assert len(set(one)) == len(one)
    assert marched(2) == one


@pytest.mark.parametrize("threads", [0, TILES + 1])
def test_there_are_no_other_numbers_of_threads(threads):
    with pytest.raises(ValueError, match="threads"):
        marched(threads)
