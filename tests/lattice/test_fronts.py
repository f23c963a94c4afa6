"""The direct solver against SuperLU on the assembled matrix: any grid, broken cells, held dof, many right sides."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from lattice.assembly import assemble, cell_stiffness, in_plane_springs, out_of_plane_springs
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.dissection import cut
from lattice.implicit.factors import Factors
from lattice.stiffness import hrennikoff

ICE = Ice(E=8.7e9, nu=0.3, h=3.0, rho_i=846.0, rho_w=1006.0)


@pytest.mark.parametrize("shape", [(2, 2), (3, 9), (17, 16), (31, 12)])
@pytest.mark.parametrize("per_node", [2, 3])
@pytest.mark.parametrize("sides", [0, 3])
def test_solution_is_that_of_superlu(shape, per_node, sides):
    grid, rng = Grid(*shape, 2.0), np.random.default_rng(5)
    rows = in_plane_springs(hrennikoff(ICE)) if per_node == 2 else out_of_plane_springs(hrennikoff(ICE), grid.d)
    n = per_node * grid.nodes
    live, held = rng.random(grid.cells) > 0.2, rng.random(n) < 0.1
    diagonal = rng.uniform(1e6, 1e7, n)
    b = rng.normal(size=(n, sides) if sides else n)
    x = Factors(grid, cell_stiffness(rows, np.ones((grid.cells, 2))), live, diagonal, held).solve(b)
    free = np.flatnonzero(~held)
    A = (assemble(grid, rows, live) + sp.diags(diagonal)).tocsc()[free][:, free].tocsc()
    expected = np.zeros_like(b)
    expected[free] = spsolve(A, b[free])
    np.testing.assert_allclose(x, expected, rtol=1e-8, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("shape", [(2, 2), (5, 4), (60, 60), (13, 61)])
def test_every_node_is_eliminated_once(shape):
    grid = Grid(*shape, 1.0)
    nodes = [n for own, _ in cut(grid) for n in own]
    assert sorted(nodes) == list(range(grid.nodes))
