"""Spring stiffnesses of a lattice cell, in the two sets of the thesis.

Out of plane (w, phi_x, phi_y) after (2.1)-(2.26); in plane (u_x, u_y) after chapter 3. Both sets are the same at
nu = 1/3. The spring constants do not depend on the cell size.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from lattice.ice import Ice


@dataclass(frozen=True)
class Springs:
    """Constants of the connections between neighbouring particles."""

    K_n_axi: float  #: in-plane, normal, axial connection [N/m]
    K_s_axi: float  #: in-plane, shear, axial connection [N/m]
    K_n_dia: float  #: in-plane, normal, diagonal connection [N/m]
    K_out: float  #: out-of-plane shear, axial connection; none on the diagonals, K_s,dia = 0 in (2.23) [N/m]
    G_r_axi: float  #: bending, axial connection [N m]
    G_t_axi: float  #: torsion, axial connection [N m]
    G_dia: float  #: bending plus torsion, diagonal connection, G_r,dia + G_t,dia [N m]


def equations_matching(ice: Ice) -> Springs:
    """Long-wave equivalence with Mindlin-Reissner and plane stress: (2.23)-(2.26), (3.8)-(3.11)."""
    Eh, nu, D = ice.E * ice.h, ice.nu, ice.D
    return Springs(
        K_n_axi=(3.0 - nu) * Eh / (4.0 * (1.0 - nu**2)),
        K_s_axi=(1.0 - 3.0 * nu) * Eh / (4.0 * (1.0 - nu**2)),
        K_n_dia=Eh / (4.0 * (1.0 - nu)),
        K_out=ice.shear_stiffness,
        G_r_axi=D * (3.0 - nu) / 4.0,
        G_t_axi=D * (1.0 - 3.0 * nu) / 4.0,
        G_dia=D * (1.0 + nu) / 4.0,
    )


def hrennikoff(ice: Ice) -> Springs:
    """Framework method after Hrennikoff (1940), right Poisson effect: (3.18)-(3.26)."""
    Eh, nu, D = ice.E * ice.h, ice.nu, ice.D
    return Springs(
        K_n_axi=Eh / (1.0 + nu),
        K_s_axi=Eh / (1.0 + nu) - 2.0 * nu * Eh / (1.0 - nu**2),
        K_n_dia=nu * Eh / (1.0 - nu**2),
        K_out=ice.shear_stiffness,
        G_r_axi=(1.0 - nu) * D,
        G_t_axi=(1.0 - 3.0 * nu) * D,
        G_dia=nu * D,
    )


STIFFNESS_SETS: dict[str, Callable[[Ice], Springs]] = {
    "hrennikoff": hrennikoff,
    "equations-matching": equations_matching,
}
