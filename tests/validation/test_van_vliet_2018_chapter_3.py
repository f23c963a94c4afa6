"""van Vliet (2018), chapter 3: Poisson effect of both stiffness sets."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.verify.cases import run
from cosim.verify.poisson import contraction
from lattice.assembly import assemble, in_plane_springs
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.stiffness import STIFFNESS_SETS


def ice(nu: float) -> Ice:
    return Ice(E=3e9, nu=nu, h=1.5, rho_i=900.0, rho_w=1025.0)


def test_section_3_4_and_figures_3_3_and_3_4() -> None:
    (result,) = run("poisson", quick=True)
    assert [(q.name, q.value) for q in result.quantities if q.passed is False] == []


@pytest.mark.parametrize("nu", [0.0, 0.15, 0.25, 1.0 / 3.0])
def test_hrennikoff_contracts_by_nu_and_the_matched_set_does_not(nu: float) -> None:
    assert contraction(ice(nu), "hrennikoff") == pytest.approx(nu, abs=1e-12)
    assert contraction(ice(nu), "equations-matching") == pytest.approx(0.25 * (1.0 + nu), rel=1e-12)


@pytest.mark.parametrize("name", sorted(STIFFNESS_SETS))
def test_uniform_strain_energy_of_the_sheet(name: str) -> None:
    """Hrennikoff: C_11 = E h / (1 - nu^2) and C_66 = E h / (2 (1 + nu)); the wrong twin is the other set's C_11."""
    grid, sheet = Grid(4, 4, 1.0), ice(0.25)
    K = assemble(grid, in_plane_springs(STIFFNESS_SETS[name](sheet)))
    stretch = np.column_stack((grid.xy[:, 0], 0.0 * grid.xy[:, 0])).ravel()
    shear = 0.5 * grid.xy[:, ::-1].ravel()
    C_11, C_66 = stretch @ (K @ stretch) / 9.0, shear @ (K @ shear) / 9.0
    if name == "hrennikoff":
        assert pytest.approx(sheet.E * sheet.h / (1.0 - 0.0625), rel=1e-12) == C_11
        assert pytest.approx(sheet.E * sheet.h / 2.5, rel=1e-12) == C_66
    else:
        assert (
            pytest.approx(sheet.E * sheet.h / (1.0 - 0.0625), rel=1e-3) != C_11
            or pytest.approx(sheet.E * sheet.h / 2.5, rel=1e-3) != C_66
        )
