"""How the sheet yields while the rubble presses on it, in the two numbers that a section of rubble can carry along.

Within a window the rubble meets the edge of the sheet as an oscillator. Under a constant force F it has after a time T

    x = F / k (1 - cos(theta)),   v = F / k (theta / T) sin(theta),   theta = T sqrt(k / m),

and k, m are chosen so that x and v are those of the lattice after a window. The lattice is pressed in all sections at
once: what all sections do together is right, and what one does alone is softer than it is. That is the safe side. With
G the compliance of the edges and P = diag(G 1) what the rubble takes for it, an error of the force of one window
comes back in the next as (1 - P^-1 G) times itself, and the eigenvalues of P^-1 G lie between 0 and 1 (Gershgorin).
"""

from __future__ import annotations

import numpy as np

from coupling.interface import Array

SHORTEST = 1e-15  #: displacement that counts as none [m/N]


def oscillator(x: Array, v: Array, window: float) -> tuple[Array, Array]:
    """Stiffness k [N/m] and mass m [kg] for displacements x [m/N] and velocities v [m/(N s)] after a window [s].

    theta cot(theta / 2) = v T / x lies between 2 (a free mass) and 0 (a motion shorter than the window, which ends at
    rest); beyond these ends the end is taken.
    """
    x = np.maximum(x, SHORTEST)
    ratio = np.clip(v * window / x, 0.0, 2.0 - 1e-6)
    low, high = np.zeros_like(x), np.full_like(x, np.pi)
    for _ in range(50):
        middle = 0.5 * (low + high)
        above = middle / np.tan(0.5 * middle) > ratio
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    theta = 0.5 * (low + high)
    k = (1.0 - np.cos(theta)) / x
    return k, k * (window / theta) ** 2
