"""Linear elastic fracture mechanics of the edge-cracked square plate of Figure 4-11.

The stress intensity follows from the energy release rate, G = F d(delta/2)/da / t = K_I^2 / E, with the crack mouth
opening delta of a plane-stress plate of bilinear finite elements: no lattice, and a crack without width. One
factorisation serves all crack lengths, because only the reactions on the line of the crack change with the length.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from lattice.grid import Array, Grid

NU = 1.0 / 3.0  #: the normalised load does not depend on it beyond 1e-3: the crack line carries no shear


def _element(nu: float) -> Array:
    """Stiffness of a square bilinear element in plane stress, over E t, nodes ordered as in Grid, (8, 8)."""
    C = np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - nu)]]) / (1.0 - nu**2)
    K = np.zeros((8, 8))
    gauss = (0.5 - 0.5 / np.sqrt(3.0), 0.5 + 0.5 / np.sqrt(3.0))
    for x, y in ((x, y) for x in gauss for y in gauss):
        dx, dy = np.array([y - 1.0, 1.0 - y, -y, y]), np.array([x - 1.0, -x, 1.0 - x, x])
        B = np.zeros((3, 8))
        B[0, ::2], B[1, 1::2], B[2, ::2], B[2, 1::2] = dx, dy, dy, dx
        K += 0.25 * B.T @ C @ B
    return K


def stiffness(grid: Grid) -> sp.csc_matrix:
    """Of a plane-stress plate of bilinear elements, over E t, x and y node by node, (2 nodes, 2 nodes)."""
    dof = (grid.cell_nodes[:, :, None] * 2 + np.arange(2)).reshape(-1, 8)
    places = np.repeat(dof, 8, axis=1).ravel(), np.tile(dof, 8).ravel()
    return sp.coo_matrix((np.tile(_element(NU).ravel(), grid.cells), places)).tocsc()


def mouth_compliance(n: int) -> Array:
    """Half the mouth opening over F / (E t) for cracks of 1 ... n - 4 elements of a plate of n elements, (n - 4,)."""
    grid = Grid(n + 1, n // 2 + 1, 1.0 / n)
    K = stiffness(grid)
    line = 2 * grid.edge_nodes("y-") + 1
    free = np.setdiff1d(np.arange(2 * grid.nodes), (line[-1] - 1, line[-1], line[-2]))
    loads = np.zeros((2 * grid.nodes, n - 1))
    loads[line[:-2], np.arange(n - 1)] = 1.0
    S = np.zeros_like(loads)
    S[free] = splu(K[free][:, free]).solve(loads[free])
    S = S[line[:-2]]
    return np.array([S[0, 0] - S[0, a:] @ np.linalg.solve(S[a:, a:], S[a:, 0]) for a in range(1, n - 3)])


def _normalised_load(n: int, ratio: Array) -> Array:
    compliance = mouth_compliance(n)
    a = np.arange(2, n - 4) / n
    slope = 0.5 * n * (compliance[2:] - compliance[:-2])
    return np.interp(ratio, a, 1.0 / np.sqrt(slope))


@cache
def _curve(n: int, ratios: tuple[float, ...]) -> Array:
    coarse, fine = (_normalised_load(m, np.array(ratios)) for m in (n // 2, n))
    return 2.0 * fine - coarse


def normalised_load(ratio: Array, n: int = 120) -> Array:
    """F / (t K_I sqrt(L)) of (4.26) at crack lengths ``ratio`` = a / L, extrapolated from n/2 and n elements [-].

    The released node shifts the crack tip by a fixed part of an element, so the error is of first order and one
    Richardson step removes it.
    """
    ratio = np.atleast_1d(np.asarray(ratio, dtype=float))
    if ratio.min() < 0.05 or ratio.max() > 0.9:
        raise ValueError(
            f"crack lengths a/L = {ratio.min():g} to {ratio.max():g} leave the range 0.05 to 0.9 of the reference"
        )
    return _curve(n, tuple(ratio.tolist()))
