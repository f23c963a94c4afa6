"""Material of the ice sheet and the strengths that its failure criteria use.

"The thesis" is R. van Vliet, *A lattice model for prediction of ice failure in interaction with sloping structures*,
TU Delft, 2018; numbers in brackets are its equations.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class BeamTest:
    """In-situ cantilever beam without stress relief, from which the limit beside a crack follows (4.27)-(4.31)."""

    length: float  #: L_b [m]
    width: float  #: w [m]
    failure_load: float  #: F_c [N]
    factor: float  #: f of (4.30), found by simulating the beam [-]


POSITIVE = (
    *("E", "h", "rho_i", "rho_w", "g"),
    *("sigma_t", "sigma_f", "sigma_c", "sigma_f_upward", "sigma_f_downward", "sigma_shear", "K_IC"),
)


@dataclass(frozen=True)
class Ice:
    """Elastic sheet floating on water, in SI units. A strength is infinite unless a chosen criterion needs it."""

    E: float  #: Young's modulus [Pa]
    nu: float  #: Poisson's ratio, at most 1/3 [-]
    h: float  #: thickness [m]
    rho_i: float  #: density of the ice [kg/m3]
    rho_w: float  #: density of the water [kg/m3]
    sigma_t: float = np.inf  #: tensile strength [Pa]
    sigma_f: float = np.inf  #: flexural strength [Pa]
    sigma_c: float = np.inf  #: uniaxial compressive strength [Pa]
    beam_test: BeamTest | None = None
    g: float = 9.81  #: [m/s2]
    sigma_spall: float = -np.inf  #: sum of principal stresses at spalling, negative [Pa]
    sigma_f_upward: float = np.inf  #: flexural strength in upward bending, bottom in tension [Pa]
    sigma_f_downward: float = np.inf  #: flexural strength in downward bending, top in tension [Pa]
    sigma_shear: float = np.inf  #: out-of-plane shear strength [Pa]
    K_IC: float = np.inf  #: fracture toughness [Pa sqrt(m)]
    added_mass: float = 0.0  #: water that moves with a deflection of the sheet, over the water that it displaces [-]

    def __post_init__(self) -> None:
        if not 0.0 <= self.nu <= 1.0 / 3.0 + 1e-12:
            raise ValueError(f"Poisson's ratio {self.nu:g} gives negative spring stiffness (3.21): use 0 to 1/3")
        for name in POSITIVE:
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{name} = {getattr(self, name):g} must be greater than 0")
        if not self.added_mass >= 0.0:
            raise ValueError(f"added_mass = {self.added_mass:g} must not be negative")
        if not self.sigma_spall < 0.0:
            raise ValueError(
                f"sigma_spall = {self.sigma_spall:g} Pa must be negative: it is a compressive stress (4.9)"
            )

    @property
    def D(self) -> float:
        """Bending stiffness of the plate, E h^3 / (12 (1 - nu^2)) [N m]."""
        return self.E * self.h**3 / (12.0 * (1.0 - self.nu**2))

    @property
    def shear_stiffness(self) -> float:
        """k^2 G h with k^2 = 5 / (6 - nu), below (2.20) [N/m]."""
        return 5.0 / (6.0 - self.nu) * self.E / (2.0 * (1.0 + self.nu)) * self.h

    @property
    def k_f(self) -> float:
        """Kelvin foundation per unit area, rho_w g (2.3.2) [N/m3]."""
        return self.rho_w * self.g

    @property
    def heaving_mass(self) -> float:
        """Mass per area that moves with a deflection, water included [kg/m2].

        Deep water under a sheet that deflects in waves of number k adds rho_w / k (Lamb, Hydrodynamics, 6th ed., art.
        228): rho_w / (rho_i h k) times what is displaced.
        """
        return self.rho_i * self.h * (1.0 + self.added_mass)

    @property
    def l_c(self) -> float:
        """Characteristic length of the floating plate, (D / rho_w g)^(1/4) [m]."""
        return float((self.D / self.k_f) ** 0.25)

    @property
    def freeboard(self) -> float:
        """Height of the top of freely floating ice above the water, h (1 - rho_i / rho_w) [m]."""
        return self.h * (1.0 - self.rho_i / self.rho_w)

    def stress_beside_crack(self, d: float) -> float:
        """Bending stress that a cell of size d [m] bears beside a crack tip, right side of (4.31) times E [Pa].

        Without a beam test nothing is known of the concentration there, and the limit is sigma_f.
        """
        test = self.beam_test
        if test is None:
            return self.sigma_f
        if d >= 2.0 * test.width:
            raise ValueError(
                f"cell size {d:g} m is not below twice the width of the beam test ({test.width:g} m), "
                "where (4.31) ends: refine the mesh"
            )
        sigma_beam = 6.0 * test.failure_load * test.length / (test.width * self.h**2)  # (4.27)
        ratio = d / test.width
        return float(sigma_beam * 0.5 * (1.0 / np.sqrt(ratio) + 1.0 / np.sqrt(2.0 - ratio)) * test.factor)
