"""[coupling]: time windows and the exchange between sheet and rubble."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from cosim.scenario.limits import Limits
from cosim.scenario.names import Scheme
from cosim.scenario.section import Section
from cosim.scenario.units import (
    Force,
    Time,
)


class Coupling(Section):
    """[coupling] Time windows, and what sheet and rubble exchange in them."""

    #: time window (macro step); with steering the first one. Default 50 ms (h / 1 m)^0.5, at most that, and less where
    #: the ice drifts a tenth of a cell in it: see `cosim.scenario.chosen` [s]
    window: Annotated[Time, Limits("1 us", "10 s", "50 ms")] = None
    #: lockstep: both meet in every sub-step of the rubble, for closing cracks and dynamic propagation, where it is the
    #: default; serial-explicit: the sheet under the last forces, then the rubble, the default else; parallel-explicit:
    #: both with the last data; serial-implicit: windows are repeated until forces and motion agree
    scheme: Scheme | None = None
    tolerance: float = Field(1e-3, gt=0, lt=1)  #: implicit: change of the forces, relative, that ends the iteration
    max_iterations: int = Field(30, ge=2, le=10_000)  #: implicit: of one window
    relaxation: float = Field(1.0, gt=0, le=1)  #: implicit: share of the change that is taken over before Aitken's own
    #: implicit: smaller forces are set against this one [N]
    force_floor: Annotated[Force, Limits("1 nN", "1 GN", "10 kN")] = 1e4
    unconverged: Literal["stop", "count"] = "stop"  #: implicit: such a window ends the run, or is counted in the ledger
    #: fixed: all windows alike; power: by what the coupling makes or takes of the power that it exchanges
    steering: Literal["fixed", "power"] = "fixed"
    power_tolerance: float = Field(0.1, gt=0, le=10)  #: of the power residual, relative to the exchanged power
    #: with steering; default the sub-step of the rubble [s]
    shortest_window: Annotated[Time, Limits("1 us", "10 s", "5 ms")] = None
    #: with steering; default four times the first window [s]
    longest_window: Annotated[Time, Limits("1 us", "100 s", "200 ms")] = None

    def bounds(self, substep: float) -> tuple[float, float]:
        """Shortest and longest window with steering, defaults filled in [s]."""
        longest = 4.0 * self.window if self.longest_window is None else self.longest_window
        return substep if self.shortest_window is None else self.shortest_window, longest
