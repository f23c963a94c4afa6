"""Load at the edge of a floating plate: which stress a finer lattice converges to, and which it cannot.

Westergaard's stress at the edge of a plate on water under P on a half-disk of radius a at the edge, in the form of
Ioannides, Thompson and Barenberg, Transp. Res. Rec. 1043 (1985):

    sigma h^2 / P = 3 (1 + nu) / (pi (3 + nu)) (ln(E h^3 / (100 k a^4)) + 3.84 - 4 nu / 3 + (1 + 2 nu) a / (2 l))

It grows without bound as the half-disk shrinks: under a force on one node every halving of the cell, which is what then
spreads the load, adds 12 (1 + nu) ln 2 / (pi (3 + nu)).
"""

import numpy as np
import pytest

from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.stiffness import hrennikoff
from lattice.strain import CellState

NU, LENGTH = 1.0 / 3.0, 120.0  #: more than seven characteristic lengths of 16.6 m
ICE = Ice(E=8e9, nu=NU, h=1.0, rho_i=916.2, rho_w=999.8, sigma_t=1.0, sigma_f=1.0, sigma_c=2.0)
CELLS = (48, 96, 192)  #: 2.5, 1.25 and 0.625 m
HALVING = 12.0 * (1.0 + NU) * np.log(2.0) / (np.pi * (3.0 + NU))


def westergaard(a):
    bracket = np.log(ICE.E * ICE.h**3 / (100.0 * ICE.k_f * a**4)) + 3.84 - 4.0 * NU / 3.0
    return 3.0 * (1.0 + NU) / (np.pi * (3.0 + NU)) * (bracket + (1.0 + 2.0 * NU) * a / (2.0 * ICE.l_c))


def stress(cells, x, y):
    """Largest principal bending stress times h^2 / P, P spread over points (x, y) seen from the middle of the edge."""
    n, d = cells + 1, LENGTH / cells
    grid = Grid.rectangle(LENGTH, LENGTH, n, n, -LENGTH, -0.5 * LENGTH)
    engine = Engine(grid, ICE, hrennikoff(ICE), held_in_plane=np.zeros(grid.nodes, bool))
    node = np.rint((x + LENGTH) / d).astype(int) * n + np.rint((y + 0.5 * LENGTH) / d).astype(int)
    force = np.zeros((grid.nodes, 3))
    force[:, 0] = -np.bincount(node, minlength=grid.nodes) / len(node)
    s = engine.equilibrium(np.zeros((grid.nodes, 2)), force)
    k = CellState.of(grid, s.u, s.q).strains
    mean, radius = 0.5 * (k.k11 + k.k22), np.hypot(0.5 * (k.k11 - k.k22), k.k12)
    largest = np.abs(mean) * (1.0 + NU) + radius * (1.0 - NU)
    return float(largest.max()) * 0.5 * ICE.E * ICE.h**3 / (1.0 - NU**2)


def half_disk(a):
    x, y = np.meshgrid(*(2 * [np.linspace(-a, a, 400)]))
    inside = (x <= 0.0) & (np.hypot(x, y) <= a)
    return x[inside], y[inside]


@pytest.fixture(scope="module")
def point():
    return [stress(n, np.zeros(1), np.zeros(1)) for n in CELLS]


@pytest.mark.parametrize(("a", "tolerance"), [(2.0, 0.06), (4.0, 0.04)])
def test_a_load_of_fixed_size_converges_to_westergaard(a, tolerance, point):
    found = [stress(n, *half_disk(a)) for n in CELLS]
    assert found[-1] == pytest.approx(westergaard(a), rel=tolerance)
    first, second = np.diff(found)
    assert 0.0 < second < 0.5 * first
    assert point[-1] > 1.3 * westergaard(a)  # a force on a node is another load


def test_a_force_on_one_node_converges_to_nothing(point):
    """Each halving of the cell adds what the logarithm says, less what shear takes where cells are thinner than ice."""
    assert np.all(np.diff(point) > 0.8 * HALVING)
    assert np.all(np.diff(point) < HALVING)


def test_a_contact_along_the_edge_needs_cells_below_its_half_width():
    """4 m wide, as a cone makes it: the stress gains a sixth from cells of 2.5 to 1.25 m, a twentieth from there on."""
    y = np.linspace(-2.0, 2.0, 4001)
    found = [stress(n, np.zeros_like(y), y) for n in CELLS]
    first, second = np.diff(found) / found[-1]
    assert first > 0.12
    assert second < 0.4 * first
