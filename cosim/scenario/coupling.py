"""[coupling]: time windows and the exchange between sheet and rubble."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field, model_validator

from cosim.scenario.names import Scheme
from cosim.scenario.section import Section, fault
from cosim.scenario.units import (
    Force,
    Time,
)


class Coupling(Section):
    """[coupling] Time windows, and what sheet and rubble exchange in them."""

    window: Time = 0.05  #: time window (macro step) [s]; with steering the first one
    #: serial-explicit: the sheet under the last forces, then the rubble; parallel-explicit: both with the last data;
    #: serial-implicit: windows are repeated until forces and motion agree
    scheme: Scheme = "serial-explicit"
    tolerance: float = Field(1e-3, gt=0, lt=1)  #: implicit: change of the forces, relative, that ends the iteration
    max_iterations: int = Field(30, ge=2)  #: implicit: of one window
    relaxation: float = Field(1.0, gt=0, le=1)  #: implicit: share of the change that is taken over before Aitken's own
    force_floor: Force = 1e4  #: implicit: smaller forces are set against this one [N]
    unconverged: Literal["stop", "count"] = "stop"  #: implicit: such a window ends the run, or is counted in the ledger
    #: fixed: all windows alike; power: by what the coupling makes or takes of the power that it exchanges
    steering: Literal["fixed", "power"] = "fixed"
    power_tolerance: float = Field(0.1, gt=0)  #: of the power residual, relative to the exchanged power
    shortest_window: Time = None  #: with steering; default the sub-step of the rubble [s]
    longest_window: Time = None  #: with steering; default four times the first window [s]

    def bounds(self, substep: float) -> tuple[float, float]:
        """Shortest and longest window with steering, defaults filled in [s]."""
        longest = 4.0 * self.window if self.longest_window is None else self.longest_window
        return substep if self.shortest_window is None else self.shortest_window, longest

    @model_validator(mode="after")
    def _bounds_enclose_the_window(self) -> Self:
        for key, value in (("shortest_window", self.shortest_window), ("longest_window", self.longest_window)):
            if value is not None and self.steering == "fixed":
                raise fault(key, 'has no meaning for windows that are all alike: remove it or set steering = "power"')
        if self.shortest_window is not None and self.shortest_window > self.window:
            raise fault("shortest_window", f"must be at most the first window of {self.window * 1e3:g} ms")
        if self.longest_window is not None and self.longest_window < self.window:
            raise fault("longest_window", f"must be at least the first window of {self.window * 1e3:g} ms")
        return self


def nearest_multiples(value: float, step: float) -> list[float]:
    """The whole multiples of ``step`` that enclose ``value``, without zero; empty if it is one already."""
    n_value, n_step = round(value * 1e9), round(step * 1e9)
    if n_step > 0 and n_value % n_step == 0 and n_value > 0:
        return []
    n_step = max(n_step, 1)
    below = n_value // n_step
    return [k * n_step / 1e9 for k in (below, below + 1) if k > 0]
