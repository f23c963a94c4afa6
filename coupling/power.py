"""Power over the interface: what the rubble gives to the sheet's edge, and what arrives in the sheet.

The rubble presses with its forces of this window on an edge that moves as the rubble sees it; the sheet moves, as it
does, under the forces that it was given. The difference is energy that the coupling takes or, below zero, makes: the
error of the scheme in a quantity that has no unit of its own to choose (power bonds of Sadjina and others, Engineering
with Computers 33, 2017).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class PowerBooks:
    """Residual of the last window and sums over the run."""

    residual: float = 0.0  #: mean over the window, given by the rubble less taken by the sheet [W]
    error: float = 0.0  #: |residual| relative to the exchanged power, see `close_window`
    loss: float = 0.0  #: energy taken by the coupling so far [J]
    exchanged: float = 0.0  #: larger of the two powers, summed over all windows [J]
    time: float = 0.0  #: of all windows in which there was something to exchange [s]

    def close_window(self, given: float, taken: float, window: float) -> dict[str, float]:
        """Books the mean powers of a window of length ``window`` [s]; returns the terms by name [W], [J].

        The residual is set against the power that is exchanged in this window or against the mean over the run,
        whichever is larger: edges that just barely touch shall not count as much as those that press.
        """
        power = max(abs(given), abs(taken))
        self.residual = given - taken
        self.loss += self.residual * window
        self.exchanged += power * window
        self.time += window if power > 0.0 else 0.0
        self.error = abs(self.residual) / max(power, self.exchanged / self.time) if power > 0.0 else 0.0
        return {
            "power_from_rubble": given,
            "power_to_sheet": taken,
            "power_residual": self.residual,
            "power_error": self.error,
            "interface_lost": self.loss,
        }
