"""A window that is solved in parts, because no step over the whole of it comes to its end: what the parts add up to."""

from __future__ import annotations

import numpy as np

from lattice.grid import Array, IntArray
from lattice.implicit.step import Step
from lattice.reaction import Pair, Reaction

#: shortest step as a share of the window: beyond six halvings it is the law of the contact that has no solution [-]
SHORTEST = 1.0 / 64.0
#: energy that no term explains in a step, as a share of the largest there is: the scheme has its balance exactly, up to
#: rounding, so that more is a step that has gone wrong [-]
BALANCED = 1e-6
NOTHING = 1e-12  #: energy that counts as none, as a share of E h^3: rounding of a sheet that hardly moves [-]


class Parts:
    """Time integrals of contact and reaction over the steps of a window."""

    def __init__(self, nodes: int):
        """Of a sheet with so many nodes."""
        self._impulse = np.zeros((nodes, 3))
        self._reactions: list[tuple[float, Reaction]] = []

    def add(self, share: float, step: Step, nodes: IntArray, reaction: Reaction) -> None:
        """A step over a ``share`` of the window; its contact is on ``nodes`` (m,)."""
        self._impulse[nodes] += share * step.contact_mean
        self._reactions.append((share, reaction))

    def contact(self, nodes: IntArray) -> tuple[Array, IntArray]:
        """Mean contact force (k, 3) [N] and its nodes (k,): ``nodes``, then others that have had any."""
        left = np.setdiff1d(np.flatnonzero(self._impulse.any(axis=1)), nodes)
        touched = np.concatenate((nodes, left))
        return np.asarray(self._impulse[touched]), touched

    def reaction(self) -> Reaction:
        """Mean over the window."""
        (_, first), *more = self._reactions
        if not more:
            return first

        def mean(of: list[tuple[float, Pair]]) -> Pair:
            return sum(s * x for s, (x, _) in of), sum(s * z for s, (_, z) in of)

        parts = self._reactions
        names = dict.fromkeys(name for _, r in parts for name in r.applied)
        return Reaction(
            mean([(s, r.foundation) for s, r in parts]),
            mean([(s, r.drag) for s, r in parts]),
            mean([(s, r.inertia) for s, r in parts]),
            mean([(s, r.held) for s, r in parts]),
            {name: mean([(s, r.applied.get(name, (0.0, 0.0))) for s, r in parts]) for name in names},
        )
