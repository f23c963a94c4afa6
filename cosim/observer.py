"""What watches a run: the recorder, the progress bar, tests. Observers read frames and change nothing.

A run calls ``on_start`` once, ``on_frame`` after every time window and ``on_close`` at the end, also after a failure.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from cosim.scenario.scenario import Scenario
from coupling.interface import Array, Frame, IntArray

if TYPE_CHECKING:
    from cosim.strained import Strained


@dataclass(frozen=True, slots=True)
class RunInfo:
    """What stays constant over a run."""

    scenario: Scenario
    structure_mesh: tuple[Array, IntArray]  #: points (p, 3) in the world frame [m], triangles (q, 3) counter-clockwise
    sheet_shape: tuple[int, int]  #: nodes along x and y
    d: float  #: distance of the nodes [m]
    duration_ns: int
    window_ns: int
    strained: Strained | None = None  #: stresses of the cells of the running sheet; None: they are not known

    @property
    def thickness(self) -> float:
        """Of the ice [m]."""
        return float(self.scenario.ice.thickness)


class Observer(Protocol):
    """Sees every window of a run, in order."""

    def on_start(self, run_info: RunInfo) -> None:
        """Once, before the first window."""

    def on_frame(self, frame: Frame) -> None:
        """After every window; the frame is kept by nobody else and must not be changed."""

    def on_close(self) -> None:
        """Once at the end, also after a failure."""
