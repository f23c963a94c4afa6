"""Steps in time and coupling scheme that a scenario leaves open, from the physics of the case. SI.

The motion of floating ice has the time (h / g)^(1/2), so that a model has the steps of its prototype by Froude's law;
the contact sees the drift, which must not pass a cell in a few windows. Steps are taken from the series 1, 2, 5, of
which whole seconds are multiples, and are never longer than those of thick ice.
"""

from __future__ import annotations

import math
from typing import Any

from cosim.scenario.lengths import approach

WINDOW, SUBSTEP = 0.05, 0.005  #: of ice of 1 m at 9.81 m/s2, and at most [s]
WAY = 0.1  #: largest part of a cell that the ice drifts in a window
LONG = 4  #: windows in the longest step of the sheet
LEAST = 4  #: sub-steps in a window
SERIES = tuple(digit * 10.0**power for power in range(-6, 0) for digit in (1, 2, 5))


def filled(m: Any) -> Any:
    """The model (`ScenarioModel`) with its window, sub-step, longest step and coupling scheme."""
    unit = math.sqrt(m.ice.thickness / m.water.gravity * 9.81)
    window, substep, longest = m.coupling.window, m.rubble.substep, m.fracture.longest_step
    if window is None:
        window = _below(min(_nearest(WINDOW * unit), WINDOW), WAY * m.sheet.spacing / max(approach(m), 1e-9))
        least = LEAST * (substep or 0.0)
        window = max(window, next((step for step in SERIES if step >= least), window))
    if substep is None:
        substep = min(_nearest(SUBSTEP * unit), SUBSTEP)
        if m.coupling.window is None:
            whole = [step for step in SERIES if step <= min(substep, window / LEAST) and _divides(step, window)]
            substep = whole[-1]
    return m.model_copy(
        update={
            "coupling": m.coupling.model_copy(update={"window": window, "scheme": m.coupling.scheme or _scheme(m)}),
            "rubble": m.rubble.model_copy(update={"substep": substep}),
            "fracture": m.fracture.model_copy(update={"longest_step": longest or LONG * window}),
        }
    )


def _scheme(m: Any) -> str:
    """Steps of the implicit engine are as long as windows."""
    return "lockstep" if m.fracture.marches else "serial-explicit"


def _nearest(step: float) -> float:
    """The step of the series that is nearest by ratio."""
    return min(SERIES, key=lambda s: abs(math.log(s / step)))


def _below(step: float, limit: float) -> float:
    """The largest step of the series up to ``step`` and ``limit``."""
    return max((s for s in SERIES if s <= step and s <= limit), default=SERIES[0])


def _divides(step: float, window: float) -> bool:
    return round(window * 1e9) % round(step * 1e9) == 0
