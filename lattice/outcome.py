"""What a window of the sheet gives back."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from lattice.grid import Array, IntArray
from lattice.reaction import Reaction

TURNED_TOO_FAR = "turned-too-far"  #: cause of cells that part a piece which has left the range of small rotations


@dataclass
class Outcome:
    """What happened in one window."""

    contact_mean: Array = field(default_factory=lambda: np.empty((0, 3)))  #: on the edge nodes, over the window [N]
    contact_nodes: IntArray = field(default_factory=lambda: np.empty(0, np.int64))  #: (m,) to which they belong
    contact_end: Array = field(default_factory=lambda: np.empty((0, 3)))  #: the same at its end
    failed: list[int] = field(default_factory=list)  #: cells in the order in which they failed
    causes: list[str] = field(default_factory=list)  #: of each: name of the criterion, or `TURNED_TOO_FAR`
    pieces: list[IntArray] = field(default_factory=list)  #: nodes of the pieces that left, in order
    parts: int = 1  #: parts of the sheet that stay in the lattice
    failure: tuple[float, Array] | None = None  #: time of the first failure [s] and contact force then (m, 3) [N]
    reaction: Reaction = field(default_factory=Reaction)  #: what carries the sheet beside its contact
