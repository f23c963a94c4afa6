"""The direct solver against SuperLU on the assembled matrix: any grid, broken cells, held dof, a few dof alone."""

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
def test_solution_is_that_of_superlu(shape, per_node):
    grid, rng = Grid(*shape, 2.0), np.random.default_rng(5)
    rows = in_plane_springs(hrennikoff(ICE)) if per_node == 2 else out_of_plane_springs(hrennikoff(ICE), grid.d)
    n = per_node * grid.nodes
    live, held = rng.random(grid.cells) > 0.2, rng.random(n) < 0.1
    diagonal = rng.uniform(1e6, 1e7, n)
    b, few = rng.normal(size=n), rng.choice(n, min(n, 9), replace=False)
    factors = Factors(grid, cell_stiffness(rows, np.ones((grid.cells, 2))), live, diagonal, held)
    free = np.flatnonzero(~held)
    A = (assemble(grid, rows, live) + sp.diags(diagonal)).tocsc()[free][:, free].tocsc()
    inverse = np.zeros((n, n))
    inverse[np.ix_(free, free)] = spsolve(A, np.eye(len(free)))
    close = {"rtol": 1e-8, "atol": 1e-12 * np.abs(inverse @ b).max()}
    half, way = factors.forward(b), factors.way(few)
    np.testing.assert_allclose(factors.at(few, way, half), (inverse @ b)[few], **close)
    np.testing.assert_allclose(factors.backward(half), inverse @ b, **close)
    columns = factors.columns(few, way, np.eye(len(few)))
    np.testing.assert_allclose(columns.inner(columns), inverse[np.ix_(few, few)], rtol=1e-8, atol=1e-20)


@pytest.mark.parametrize("shape", [(2, 2), (5, 4), (60, 60), (13, 61)])
def test_every_node_is_eliminated_once(shape):
    grid = Grid(*shape, 1.0)
    nodes = [n for own, _ in cut(grid) for n in own]
    assert sorted(nodes) == list(range(grid.nodes))
