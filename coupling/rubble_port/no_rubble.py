"""Breaking only."""

from __future__ import annotations

from functools import partial

import numpy as np

from coupling.interface import Array, BlockTable, Event, ForcePairs, Fragment, HandOver, Restore, SheetEdge, SheetForces


class NoRubble:
    """A `RubbleParticipant` that takes fragments away and counts them as cleared."""

    def __init__(self) -> None:
        self.mass, self.cleared_mass, self.power = 0.0, 0.0, 0.0
        self.budget: ForcePairs = {}
        self.energy: dict[str, float] = {}
        self.momenta: dict[str, float] = {}
        self.on_structure = np.zeros(6)

    def add(self, fragment: Fragment) -> HandOver:
        """Nothing becomes of it."""
        mass = float(fragment.mass.sum())
        self.cleared_mass += mass
        return HandOver(0, mass, 0.0, 0.0)

    def set_structure(self, place: Array, velocity: Array) -> None:
        """Nothing is there to meet the structure."""

    def sections_in_use(self) -> dict[int, float]:
        """None."""
        return {}

    def set_sheet(self, edges: dict[int, SheetEdge], carried: SheetForces, compliance: Array) -> None:
        """Nothing is there to meet the sheet."""

    def begin(self, edges: dict[int, SheetEdge]) -> None:
        """Nothing is there to meet the sheet."""

    def meet(self, nodes: Array) -> Array:
        """It presses on nothing."""
        return np.zeros((len(nodes), 3))

    def end(self) -> None:
        """Nothing has moved."""

    def advance(self, window_ns: int) -> None:
        """Nothing moves."""

    def forces_on_sheet(self) -> SheetForces:
        """None."""
        return SheetForces.none()

    def events(self, t_ns: int, load: Array) -> list[Event]:  # noqa: ARG002  as every rubble
        """Nothing breaks."""
        return []

    def load(self) -> Array:
        """No force."""
        return np.zeros((3, 3))

    def blocks(self) -> BlockTable:
        """None."""
        return BlockTable.empty()

    def save(self) -> Restore:
        """All there is to remember: what has been taken away."""
        return partial(setattr, self, "cleared_mass", self.cleared_mass)
