"""Aitken's dynamic relaxation of the interface forces (Kuettler and Wall, Comput. Mech. 43, 2008, section 3.2).

An iteration gives the sheet the forces F_k and gets the answer G(F_k) of the rubble. With the residual
r_k = G(F_k) - F_k the next forces are F_{k+1} = F_k + omega_k r_k, and

    omega_k = -omega_{k-1} r_{k-1} . (r_k - r_{k-1}) / |r_k - r_{k-1}|^2,

which is the secant method for one unknown: it converges at once where G is a straight line, however steep.
"""

from __future__ import annotations

import numpy as np

from coupling.interface import Array, IntArray, SheetForces


def on_common_nodes(*forces: SheetForces) -> tuple[IntArray, list[Array]]:
    """All nodes of some forces, ascending (k,), and each of the forces on all of them, (k, 3) [N]."""
    nodes = np.unique(np.concatenate([f.nodes for f in forces]))
    spread = [np.zeros((len(nodes), 3)) for _ in forces]
    for f, out in zip(forces, spread, strict=True):
        out[np.searchsorted(nodes, f.nodes)] = f.force
    return nodes, spread


def combined(a: float, f: SheetForces, b: float, g: SheetForces) -> SheetForces:
    """A f + b g, on the nodes of both."""
    nodes, (x, y) = on_common_nodes(f, g)
    return SheetForces(nodes, a * x + b * y)


def change(force: SheetForces, answer: SheetForces, floor: float) -> float:
    """|answer - force| relative to the larger of the two, and to ``floor`` [N] where both are smaller."""
    _, (x, y) = on_common_nodes(force, answer)
    return float(np.linalg.norm(y - x)) / max(float(np.linalg.norm(x)), float(np.linalg.norm(y)), floor)


class Aitken:
    """The factor omega, from residual to residual."""

    def __init__(self, initial: float):
        self.initial = self.omega = initial
        self._residual: SheetForces | None = None

    def begin(self) -> None:
        """A new window: no residual to compare with; omega goes on, at most `initial`, with its sign."""
        self.omega = float(np.copysign(min(abs(self.omega), self.initial), self.omega))
        self._residual = None

    def drop(self) -> None:
        """Forgets everything: the answer is not the function any more that it was."""
        self.omega, self._residual = self.initial, None

    def next(self, force: SheetForces, answer: SheetForces) -> SheetForces:
        """The forces of the next iteration."""
        residual = combined(1.0, answer, -1.0, force)
        if self._residual is not None:
            _, (old, new) = on_common_nodes(self._residual, residual)
            step = float(np.square(new - old).sum())
            if step > 0.0:
                self.omega *= -float(np.vdot(old, new - old)) / step
        self._residual = residual
        return combined(1.0, force, self.omega, residual)
