"""What leaves the rubble: ice that is cleared or crushed, with what it takes along."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from rubble.arrays import Array


@dataclass
class Lost:
    """Sums of ice that has left."""

    mass: float = 0.0  #: true mass [kg]
    momentum: Array = field(default_factory=lambda: np.zeros(3))  #: true mass times velocity at leaving [N s]
    energy: float = 0.0  #: see `energy` [J]

    def take(self, mass: float, momentum: Array, energy: float) -> None:
        """Add some ice."""
        self.mass += mass
        self.momentum = self.momentum + momentum
        self.energy += energy
