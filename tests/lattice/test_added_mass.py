"""Water that moves with the sheet: its weight in the heave of a floe and in waves of a plate on deep water."""

from dataclasses import replace

import numpy as np
import pytest

from lattice.contact import NoContact
from lattice.explicit.engine import ExplicitEngine
from lattice.explicit_sheet import ExplicitSheet
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.sheet import Sheet
from lattice.spectrum import Plate, eigenfrequencies
from lattice.state import State
from lattice.stiffness import hrennikoff

ICE = Ice(E=3e9, nu=1.0 / 3.0, h=0.2, rho_i=916.0, rho_w=1025.0)
SIDES = {"x-": "simple", "x+": "simple", "y-": "simple", "y+": "simple"}


@pytest.mark.parametrize("length", [2.0, 4.0])
def test_a_wave_on_deep_water_has_its_frequency(length):
    """omega^2 = (D k^4 + rho_w g) / (rho_i h + rho_w / k): half a wave each way in a square."""
    k = np.sqrt(2.0) * np.pi / length
    ice = replace(ICE, added_mass=ICE.rho_w / (ICE.rho_i * ICE.h * k))
    exact = np.sqrt((ice.D * k**4 + ice.k_f) / (ice.rho_i * ice.h + ice.rho_w / k)) / (2.0 * np.pi)

    def lattice(of):
        plate = Plate.build(Grid.rectangle(length, length, 41, 41), of, hrennikoff(of), SIDES)
        return eigenfrequencies(plate, 1)[0]

    assert lattice(ice) == pytest.approx(exact, rel=0.03)  # thick beside its length: shear takes 2 %
    assert lattice(ICE) > 1.3 * exact


def implicit(ice, grid, window, **options):
    return Sheet(Engine(grid, ice, hrennikoff(ice), **options), window)


def explicit(ice, grid, window, **options):
    return ExplicitSheet(ExplicitEngine(grid, ice, hrennikoff(ice), window, **options))


@pytest.mark.parametrize(("sheet", "rel"), [(explicit, 1e-4), (implicit, 5e-3)])
def test_heave_is_slower_by_what_moves_along(sheet, rel):
    """Rho_i h (1 + a) w'' = -rho_w g w, and the energy of the motion counts the water."""
    ice, grid = replace(ICE, added_mass=5.0, sigma_t=1e12, sigma_f=1e12, sigma_c=1e12), Grid(5, 5, 0.4)
    omega = np.sqrt(ice.k_f / (6.0 * ice.rho_i * ice.h))
    window = 0.5 * np.pi / omega / 400
    floe = sheet(ice, grid, window, held_in_plane=np.zeros(grid.nodes, bool))
    floe.state = State.rest(grid.nodes)
    floe.state.q[:, 0] = 0.01
    floe.energy.measure(floe.state, floe.live_cells, floe.present)
    start = floe.energy.stored
    for n in range(400):
        floe.advance(n * window, (), NoContact(), lambda nodes: None)
    assert np.abs(floe.state.q[:, 0]).max() < 0.01 * rel
    np.testing.assert_allclose(-floe.state.q_dot[:, 0], 0.01 * omega, rtol=rel)
    assert floe.energy.stored == pytest.approx(start, rel=2 * rel)


def test_less_than_none_is_refused():
    with pytest.raises(ValueError, match="added_mass = -1 must not be negative"):
        replace(ICE, added_mass=-1.0)
