"""Balances of a run, checked in every window: what was there is still there, under its name.

Mass: sheet + rubble + crushed + cleared = initial. Momentum: the blocks that a fragment has become and the ice that was
crushed off it carry what it carried in the sheet. Energy: see `coupling.energy`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from coupling.energy import EnergyBalance
from coupling.interface import NS, Array, HandOver, SimulationError

ENERGY_TOLERANCE = 1e-3  #: of the work done on the sheet
MASS_TOLERANCE = 1e-12  #: of the initial mass
#: momentum of ice that was crushed off what is handed over, its moment about the origin, and the angular momentum that
#: neighbours of a narrow plate hold
TAKEN = tuple(f"handover_{name}_{axis}" for name in ("crushed_momentum", "crushed_spin", "held_spin") for axis in "xyz")
NOTHING = 1e-5  #: work that counts as none, as share of the energy that the floe brings along


@dataclass
class Ledger:
    """Running balances; ``tolerance`` is the largest relative error of a hand-over's momentum that a run survives."""

    initial_mass: float  #: [kg]
    tolerance: float = 1e-9
    trimmed_mass: float = 0.0  #: crushed at hand-over, and off the blocks later [kg]
    handed_over_mass: float = 0.0  #: that has become blocks [kg]
    mass_error: float = 0.0  #: largest so far, relative to the initial mass
    momentum_error: float = 0.0  #: largest of all hand-overs, relative
    angular_momentum_error: float = 0.0  #: the same about the fragment's centre
    sheet_energy_residual: float = 0.0  #: of the sheet in its drifting frame, relative to the work done on it
    energy: EnergyBalance = field(default_factory=EnergyBalance)  #: of the whole system
    #: (9,) `TAKEN` of all hand-overs [N s], [N m s]
    taken: Array = field(default_factory=lambda: np.zeros(len(TAKEN)))
    _work: float = 0.0

    def hand_over(self, t_ns: int, moved: HandOver) -> None:
        """Books one fragment."""
        self.trimmed_mass += moved.trimmed
        self.handed_over_mass += moved.mass - moved.trimmed
        self.taken = self.taken + np.concatenate([moved.crushed, moved.held])
        self.momentum_error = max(self.momentum_error, moved.momentum_error)
        self.angular_momentum_error = max(self.angular_momentum_error, moved.angular_momentum_error)
        self._check("momentum of a hand-over", moved.momentum_error, t_ns)
        self._check("angular momentum of a hand-over", moved.angular_momentum_error, t_ns)

    def crush(self, mass: float) -> None:
        """Books ice that blocks have lost at overloaded contacts."""
        self.trimmed_mass += mass

    def close_window(
        self,
        t_ns: int,
        sheet: float,
        crushed: float,
        rubble: float,
        cleared: float,
        sheet_energy: Mapping[str, float],
        rubble_energy: Mapping[str, float],
    ) -> dict[str, float]:
        """Closes the books of a window; returns them by name [kg], [J]."""
        crushed += self.trimmed_mass
        error = abs(sheet + rubble + crushed + cleared - self.initial_mass) / self.initial_mass
        self.mass_error = max(self.mass_error, error)
        self._check("mass", error, t_ns, MASS_TOLERANCE)
        books = {
            "sheet_mass": sheet,
            "rubble_mass": rubble,
            "crushed_mass": crushed,
            "cleared_mass": cleared,
            "mass_error": error,
            **dict(zip(TAKEN, self.taken.tolist(), strict=True)),
        }
        if sheet_energy:
            self._check("energy of the sheet", self._sheet(sheet_energy), t_ns, ENERGY_TOLERANCE)
            books["sheet_energy_residual"] = sheet_energy["sheet_energy_residual"]
        return books | self.energy.close(t_ns, sheet_energy, rubble_energy)

    def _sheet(self, energy: Mapping[str, float]) -> float:
        """Residual of the sheet's energy relative to the largest work that was exchanged so far.

        In the frame that drifts, in which the sheet keeps its books, what it pushes along does no work, and ice that it
        runs into little: so the work of the drift counts too, and the kinetic energy that it has given or got.
        """
        own = abs(energy["contact_work"]), abs(energy["rubble_work"])
        moved = abs(energy.get("sheet_kinetic", self.energy.floor) - self.energy.floor)
        self._work = max(self._work, *own, self.energy.work, moved)
        self.sheet_energy_residual = abs(energy["sheet_energy_residual"]) / max(self._work, NOTHING * self.energy.floor)
        return self.sheet_energy_residual

    def _check(self, term: str, error: float, t_ns: int, tolerance: float | None = None) -> None:
        allowed = self.tolerance if tolerance is None else tolerance
        if not error <= allowed:
            raise SimulationError(
                f"t = {t_ns / NS:.3f} s: the balance of {term} is off by {error:.3g} (allowed "
                f"{allowed:g}); halve coupling.window, and if that does not help, please report the scenario"
            )
