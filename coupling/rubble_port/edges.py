"""The sheet's edges as the rubble takes them: those of all sections one after the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coupling.interface import Array, SheetEdge, SheetForces
from rubble.sheet import Sheets


def sheets(edges: Sequence[SheetEdge], carried: SheetForces, thickness: float) -> Sheets:
    """Edges of a sheet of this thickness [m]; each answers already to forces ``carried`` that are on its nodes."""
    applied = np.zeros((len(edges), 2))
    for k, e in enumerate(edges if len(carried.nodes) else ()):
        applied[k] = carried.force[np.isin(carried.nodes, e.nodes)].sum(axis=0)[::2]
    return Sheets(
        x=_joined([e.x for e in edges]),
        z=_joined([e.z for e in edges]),
        velocity=_joined([e.velocity.ravel() for e in edges]).reshape(-1, 2),
        offset=np.cumsum([0, *(len(e.nodes) for e in edges)], dtype=np.int64),
        front=np.array([e.front for e in edges]),
        applied=applied,
        thickness=thickness,
    )


def _joined(parts: Sequence[Array]) -> Array:
    return np.concatenate([np.zeros(0), *parts])
