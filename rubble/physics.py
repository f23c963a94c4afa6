"""Material and solver parameters of the rubble, in SI units."""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import isfinite


@dataclass(frozen=True)
class RubblePhysics:
    """What the blocks are made of, what they meet, and how finely their motion is resolved.

    Coefficients of friction belong to pairs; pymunk multiplies those of two shapes, so blocks and sheet carry
    sqrt(mu_ice_ice) and the structure mu_structure / sqrt(mu_ice_ice).
    """

    rho_i: float = 900.0  #: density of ice [kg/m^3]
    rho_w: float = 1025.0  #: density of water [kg/m^3]
    g: float = 9.81  #: [m/s^2]
    mu_ice_ice: float = 0.1  #: friction of block on block and block on sheet, > 0
    mu_structure: float = 0.1  #: friction of block on structure
    restitution: float = 0.0  #: of every pair
    form_drag: float = 1.0  #: C_d on the projected submerged extent
    skin_drag: float = 4e-3  #: C_f on the wetted edges
    added_mass: float = 0.0  #: share of the mass of displaced water that moves with a block
    added_inertia: float = 0.0  #: the same for rotation
    thickness: float = 1.0  #: ice thickness, the length scale of `slop_ratio` [m]
    slop_ratio: float = 0.005  #: allowed overlap of two shapes over ice thickness
    iterations: int = 30  #: of the impulse solver; at least the length of a chain of blocks
    substep: float = 0.005  #: constant [s]
    align_tolerance: float = 0.0873  #: a block is aligned within this angle of the slope [rad]
    sheet_mass: float = 5e4  #: mass of the sheet's edge that moves with a contact [kg]

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            if not isfinite(value) or value < 0:
                raise ValueError(f"rubble.{f.name} is {value}; it must be a number >= 0")
        for name in ("rho_i", "rho_w", "mu_ice_ice", "thickness", "slop_ratio", "iterations", "substep", "sheet_mass"):
            if getattr(self, name) == 0:
                raise ValueError(f"rubble.{name} is 0; it must be > 0" + _HINT.get(name, ""))

    @property
    def slop(self) -> float:
        """Overlap that the impulse solver leaves alone [m]."""
        return self.slop_ratio * self.thickness


_HINT = {"mu_ice_ice": " because pair coefficients are products; for smooth ice give 1e-6"}
