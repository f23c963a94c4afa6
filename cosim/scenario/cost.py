"""What a run costs before it is tried: time on one core and memory, from its size. Rough: within a factor of three.

Measured with cracks that close and with open ones, on sheets of 41 x 41 to 321 x 321 nodes (x86, one core of 2024).
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import Any

SECONDS_PER_NODE = 3e-5  #: of one time window
SECONDS_PER_WINDOW = 2e-2  #: whatever the sheet; rubble
BYTES_CLOSING = 8e3  #: per node
BYTES_OPEN = 1.4e3  #: per node and power of two of the nodes: a factorised matrix
BYTES_BASE = 3e8  #: of the program itself
BYTES_RECORDED = 40.0  #: per node and recorded frame


@dataclass(frozen=True)
class Cost:
    """Of one run."""

    nodes: int
    windows: int
    seconds: float  #: on one core
    memory: float  #: [bytes]
    recording: float  #: [bytes]

    @property
    def text(self) -> str:
        """For people."""
        return (
            f"{self.nodes} nodes, {self.windows} windows: about {_time(self.seconds)} on one core, "
            f"{_bytes(self.memory)} of memory, {_bytes(self.recording)} of recording"
        )


def cost_of(model: Any) -> Cost:
    """Of a scenario; takes its model, or what stands for it."""
    nodes = model.sheet.nodes[0] * model.sheet.nodes[1]
    windows = round(model.scenario.duration / model.coupling.window)
    per_node = BYTES_CLOSING if model.fracture.cracks == "closing" else BYTES_OPEN * math.log2(max(nodes, 2))
    return Cost(
        nodes,
        windows,
        windows * (SECONDS_PER_WINDOW + SECONDS_PER_NODE * nodes),
        BYTES_BASE + per_node * nodes,
        1e6 + BYTES_RECORDED * nodes * model.scenario.duration / model.recording.every,
    )


def memory_of_this_machine() -> float | None:
    """[bytes]; None where the system does not tell."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return None


def too_large(cost: Cost) -> str | None:
    """Why a run is refused on this machine, and what to change; None if it fits."""
    there = memory_of_this_machine()
    if there is None or cost.memory <= there:
        return None
    return (
        f"sheet.nodes: {cost.nodes} nodes need about {_bytes(cost.memory)} of memory, this machine has "
        f"{_bytes(there)}; use fewer nodes"
    )


def _time(seconds: float) -> str:
    for size, name in ((86400.0, "days"), (3600.0, "hours"), (60.0, "minutes")):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.2g} {name}"
    return f"{seconds:.2g} s"


def _bytes(count: float) -> str:
    return f"{count / 1e9:.2g} GB" if count >= 1e9 else f"{count / 1e6:.0f} MB"
