"""What the whole contract is written in: arrays, time, errors, phases."""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

NS = 1_000_000_000  #: nanoseconds per second


class SimulationError(RuntimeError):
    """A run that cannot go on; the message says what, where, when and what to do."""


class Phase(IntEnum):
    """Phase of the interaction that a load belongs to (Lu and Loset 2010, after Kamarainen 2007; thesis 6.3.1)."""

    BREAKING = 0  #: contact of the sheet with the structure
    ROTATING = 1  #: contact of a block that has not yet aligned with the slope or still touches the sheet it came from
    SLIDING = 2  #: contact of all other blocks, including force that they pass on


PHASES = tuple(p.name.lower() for p in Phase)
