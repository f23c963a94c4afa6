"""The lattice plate on water against the Mindlin-Reissner plate on a Kelvin foundation (2.18)-(2.20), (2.46)-(2.54)."""

from __future__ import annotations

import numpy as np
import pytest

from lattice import continuum, spectrum
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.spectrum import Plate, Stencil
from lattice.statics import all_around
from lattice.stiffness import STIFFNESS_SETS, equations_matching, hrennikoff

ICE = Ice(E=3e9, nu=0.3, h=1.5, rho_i=900.0, rho_w=1025.0)  # Table 2-1
SIDES = (60.0, 100.0)


def plate(nx: int, ny: int, ice: Ice = ICE, support: str = "simple", stiffness: str = "equations-matching") -> Plate:
    return Plate.build(Grid.rectangle(*SIDES, nx, ny), ice, STIFFNESS_SETS[stiffness](ice), all_around(support))


@pytest.mark.parametrize(("nu", "stiffness"), [(0.3, "equations-matching"), (1.0 / 3.0, "hrennikoff")])
def test_eigenfrequencies_converge_at_second_order(nu: float, stiffness: str) -> None:
    ice = Ice(E=3e9, nu=nu, h=1.5, rho_i=900.0, rho_w=1025.0)
    exact = continuum.eigenfrequencies(ice, *SIDES, 4)
    errors = [
        np.abs(spectrum.eigenfrequencies(plate(*n, ice=ice, stiffness=stiffness), 4) - exact)
        for n in ((25, 41), (49, 81))
    ]
    order = np.log2(errors[0] / errors[1])
    assert np.all((order > 1.8) & (order < 2.2))


def test_eigenfrequencies_are_bloch_waves_that_fit_the_plate() -> None:
    """w = sin sin is an exact mode of the lattice: edge springs at half stiffness mirror the sheet at its edge."""
    stencil = Stencil.of_assembled(ICE, equations_matching(ICE), 60.0 / 18.0)
    m, n = np.meshgrid(np.arange(1, 8), np.arange(1, 12), indexing="ij")
    waves = np.sort(stencil.dispersion(np.pi * m / 18.0, np.pi * n / 30.0)[..., 0].ravel())[:10] / (2.0 * np.pi)
    assert spectrum.eigenfrequencies(plate(19, 31), 10) == pytest.approx(waves, rel=1e-9)


def test_a_free_plate_heaves_and_tilts_on_the_water() -> None:
    """Three rigid modes at sqrt(rho_w g / (rho_i h)), the tilts a little slower for their rotary inertia."""
    found = spectrum.eigenfrequencies(plate(13, 21, support="free"), 3)
    heave = np.sqrt(ICE.k_f / (ICE.rho_i * ICE.h)) / (2.0 * np.pi)
    assert found.max() == pytest.approx(heave, rel=1e-9)
    assert found == pytest.approx(np.full(3, heave), rel=2e-3)


def test_clamped_is_stiffer_than_simple_is_stiffer_than_free() -> None:
    lowest = {s: spectrum.eigenfrequencies(plate(13, 21, support=s), 1)[0] for s in ("free", "simple", "clamped")}
    assert lowest["free"] < lowest["simple"] < lowest["clamped"]


@pytest.mark.parametrize(("c", "alpha"), [(0.0, 0.0), (7000.0, 0.0), (0.0, 1e-2)])
def test_forced_response_converges_to_navier_with_both_dampings(c: float, alpha: float) -> None:
    """The part that motion adds to the static response, which has no singularity under the load."""
    load, omega = (20.0, 50.0), 2.0 * np.pi * np.array([0.0, 0.8])
    exact = continuum.navier(ICE, SIDES, load, np.array([load]), omega, c, alpha)[:, 0, :2]
    errors = []
    for nx, ny in ((25, 41), (49, 81)):
        lattice = plate(nx, ny)
        node = lattice.grid.node(round(20.0 / lattice.grid.d), round(50.0 / lattice.grid.d))
        ours = spectrum.response(lattice, node, omega, c, alpha)[:, :2]
        errors.append(np.abs((ours[1] - ours[0]) / (exact[1] - exact[0]) - 1.0))
    order = np.log2(errors[0] / errors[1])
    assert errors[1].max() < 0.03
    assert np.all((order > 1.7) & (order < 2.4))


def typed_in(ice: Ice, d: float, Kx: float, Ky: float) -> np.ndarray:
    """Roots of (2.37)-(2.39) with K_s,dia = 0, typed from the thesis: the check of the assembled stencil [rad/s]."""
    s, D = equations_matching(ice), d * d
    cx, cy, sx, sy = np.cos(Kx), np.cos(Ky), np.sin(Kx), np.sin(Ky)
    diagonal, crossed = 2.0 - np.cos(Kx - Ky) - np.cos(Kx + Ky), np.cos(Kx - Ky) - np.cos(Kx + Ky)
    own_x = 2 * s.G_r_axi * (1 - cx) + 2 * s.G_t_axi * (1 - cy) + s.G_dia * diagonal + s.K_out * D * 0.5 * (1 + cx)
    own_y = 2 * s.G_r_axi * (1 - cy) + 2 * s.G_t_axi * (1 - cx) + s.G_dia * diagonal + s.K_out * D * 0.5 * (1 + cy)
    H = np.array(
        [
            [s.K_out * (4 - 2 * cx - 2 * cy) + ice.k_f * D, 1j * s.K_out * d * sx, 1j * s.K_out * d * sy],
            [-1j * s.K_out * d * sx, own_x, s.G_dia * crossed],
            [-1j * s.K_out * d * sy, s.G_dia * crossed, own_y],
        ]
    )
    m = ice.rho_i * ice.h * D * np.array([1.0, ice.h**2 / 12, ice.h**2 / 12])
    return np.sqrt(np.linalg.eigvalsh(H / np.sqrt(np.outer(m, m))))


@pytest.mark.parametrize(("Kx", "Ky"), [(0.05, 0.0), (0.7, 1.1), (np.pi, 0.0), (2.0, -2.5)])
def test_bloch_waves_of_the_assembled_equations_are_those_of_the_thesis(Kx: float, Ky: float) -> None:
    for d in (0.1, 1.0, 10.0):
        ours = Stencil.of_assembled(ICE, equations_matching(ICE), d).dispersion(Kx, Ky)
        assert ours == pytest.approx(typed_in(ICE, d, Kx, Ky), rel=1e-9)


def test_only_the_matched_set_has_the_rotational_waves_of_the_plate() -> None:
    """The wrong twin: below nu = 1/3 Hrennikoff's set bends right, but its rotational waves are others."""
    theta, d = np.linspace(0.0, 0.5 * np.pi, 13), 0.01
    Kx, Ky = 0.02 * np.cos(theta), 0.02 * np.sin(theta)
    exact = continuum.dispersion(ICE, Kx / d, Ky / d)
    error = {
        s.__name__: np.abs(Stencil.of_assembled(ICE, s(ICE), d).dispersion(Kx, Ky) / exact - 1.0).max()
        for s in (equations_matching, hrennikoff)
    }
    assert error["equations_matching"] < 1e-3
    assert error["hrennikoff"] > 1e-2
