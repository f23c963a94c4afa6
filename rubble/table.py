"""All plates as arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rubble.arrays import Array, BoolArray, IntArray
from rubble.store import Store


def columns(store: Store, key_at: Callable[[Array], IntArray], window: float) -> dict[str, NDArray[Any]]:
    """All plates as arrays, in the order of their numbers.

    ``id``, ``section`` that holds its centre, ``sliding`` (else rotating), ``mass`` [kg], ``width`` [m],
    ``position`` (n, 3) [m], ``bearing`` (n, 3) as `contact_centres`, ``quaternion`` (n, 4), ``angle`` counter-
    clockwise in the x-z picture [rad], ``velocity`` (n, 3) [m/s], ``spin`` (n, 3) and ``omega``, its rate in the
    picture [rad/s], ``load`` (n, 3) mean force on the structure [N]; ``outline`` (v, 2) corners of its middle piece
    [m], of which plate i owns those from ``offset[i]`` to ``offset[i + 1]``.
    """
    plates, told, n = store.plates, store.tables.told, len(store.list)
    owner = np.repeat(np.arange(n), np.diff(told.offset))
    outlines = plates.position[owner] + np.einsum("vij,vj->vi", plates.rotation[owner], told.corners)
    return {
        "id": told.ids.copy(),
        "section": key_at(plates.position[:n, 1]),
        "sliding": sliding(store),
        "mass": store.tables.mass.copy(),
        "width": told.width.copy(),
        "position": plates.position[:n].copy(),
        "quaternion": plates.quaternion[:n].copy(),
        "angle": np.arctan2(plates.rotation[:n, 2, 0], plates.rotation[:n, 0, 0]),
        "velocity": plates.velocity[:n, :3].copy(),
        "spin": plates.velocity[:n, 3:].copy(),
        "omega": -plates.velocity[:n, 4],
        "load": loads(store, window),
        "bearing": contact_centres(store),
        "outline": np.ascontiguousarray(outlines[:, ::2]),
        "offset": told.offset.copy(),
    }


def sliding(store: Store) -> BoolArray:
    """Which plates slide, (n,)."""
    return np.array([p.sliding for p in store.list], np.bool_)


def loads(store: Store, window: float) -> Array:
    """Mean force of each plate on the structure over a window [s], (n, 3) [N]."""
    impulse = store.tables.sums[:, :3]
    return np.asarray(impulse / window if window else np.zeros_like(impulse))


def contact_centres(store: Store) -> Array:
    """Mean place of each plate's contacts with the structure (n, 3), nan without contact [m]."""
    push, at = store.tables.sums[:, 5:6], store.tables.sums[:, 6:9]
    centres: Array = np.divide(at, push, out=np.full(at.shape, np.nan), where=push > 0.0)
    return centres
