"""Water that flows: it drags on the underside of the sheet.

Without a current the water is still in the structure's frame, as in the basin, where the ice was pushed against the
structure, and the sheet's friction on the water is left out: at 0.1 m/s it is 20 mN/m2, a floe of 165 m feels 0.5 kN.
With one, every node feels the skin friction rho_w C_f |v| v / 2 per area, v its motion through the water in the plan.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np

from coupling.interface import Array, SheetMotion


@dataclass(frozen=True)
class Current:
    """Water of one velocity everywhere."""

    velocity: tuple[float, float]  #: along x and y [m/s]
    density: float  #: of the water [kg/m3]
    skin_drag: float  #: C_f on the underside [-]
    name: str = "current"

    def __post_init__(self) -> None:
        if not all(isfinite(v) for v in self.velocity):
            raise ValueError(f"current is {self.velocity} m/s; give two finite velocities")

    def on_sheet(self, t: float, sheet: SheetMotion) -> Array:  # noqa: ARG002 - it is steady
        """Skin friction on the underside, (n, 3) [N]; nothing across."""
        force = np.zeros_like(sheet.velocity)
        through = np.array(self.velocity) - sheet.velocity[:, :2]
        speed = np.hypot(through[:, 0], through[:, 1])
        per_velocity = 0.5 * self.density * self.skin_drag * sheet.area * speed
        force[:, :2] = np.where(sheet.present, per_velocity, 0.0)[:, None] * through
        return force
