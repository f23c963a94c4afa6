"""Length of the next window: fixed, or steered by the power residual of the interface."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from coupling.power import PowerBooks

Steering = Callable[[int, PowerBooks, bool], int]  #: window [ns], its power, hand-over in it -> next window [ns]


def fixed(window_ns: int, _power: PowerBooks, _jump: bool) -> int:
    """The same again."""
    return window_ns


@dataclass(frozen=True)
class ByPower:
    """Half the window after one whose power residual is above the tolerance, twice as long below a quarter of it.

    The residual of a first-order scheme falls with the window, so a window twice as long stays below the tolerance.
    Windows are rungs of one ladder, start / 2, start, 2 start ..., in whole sub-steps: the sheet keeps a factorisation
    for every length. After a hand-over the start is taken again unless the window is shorter.
    """

    start_ns: int
    shortest_ns: int
    longest_ns: int
    substep_ns: int
    tolerance: float  #: of the power residual, relative to the exchanged power

    @property
    def ladder(self) -> list[int]:
        """All windows, ascending [ns]."""
        steps = self.start_ns // self.substep_ns
        down = [steps >> k for k in range(steps.bit_length()) if (steps >> k) * self.substep_ns >= self.shortest_ns]
        up = [steps << k for k in range(1, 64) if (steps << k) * self.substep_ns <= self.longest_ns]
        return [n * self.substep_ns for n in [*reversed(down), *up]]

    def __call__(self, window_ns: int, power: PowerBooks, jump: bool) -> int:
        """The next window [ns]."""
        ladder = self.ladder
        rung = max(k for k, w in enumerate(ladder) if w <= window_ns)
        if jump:
            return min(ladder[rung], self.start_ns)
        if power.error > self.tolerance:
            return ladder[max(rung - 1, 0)]
        return ladder[min(rung + 1, len(ladder) - 1)] if power.error < 0.25 * self.tolerance else ladder[rung]
