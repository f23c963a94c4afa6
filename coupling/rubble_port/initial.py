"""Rubble that is there before the run, under a sheet that lies still."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from coupling.interface import SheetEdge
from coupling.rubble_port.failing import failing
from coupling.rubble_port.port import RubblePort
from rubble.initial import Pile, rest, settle


def front_sections(port: RubblePort) -> list[int]:
    """Sections in whose middle plane the structure stands in the ice's way at the waterline."""
    layer = port.layer
    half = min(port.structure.half_width, layer.domain.y_max)
    keys = range(layer.key_at(-half), layer.key_at(half) + 1)
    return [k for k in keys if abs(y := layer.centre(k)) < half and np.isfinite(port.structure.face_x(y, 0.0))]


def fill(port: RubblePort, volume: float, porosity: float, seed: int, edges: dict[int, SheetEdge]) -> Pile:
    """Settles ``volume`` [m^3] of new rubble in the sections of ``edges``."""
    _hold(port, edges)
    return _settled(port, lambda: settle(port.layer, _corners(port, edges), volume, seed, porosity=porosity))


def rest_again(port: RubblePort, edges: dict[int, SheetEdge]) -> Pile:
    """The rubble comes to rest once more, under a sheet that has moved."""
    _hold(port, edges)
    return _settled(port, lambda: rest(port.layer, _corners(port, edges)))


def _hold(port: RubblePort, edges: dict[int, SheetEdge]) -> None:
    """The sheet lies still and yields to nothing."""
    still = {k: replace(e, velocity=np.zeros_like(e.velocity)) for k, e in edges.items()}
    port.set_sheet(still, port.forces_on_sheet(), np.zeros((2, len(still), len(still))))


def _settled(port: RubblePort, pile: Callable[[], Pile]) -> Pile:
    with failing():
        settled = pile()
    port.take_forces()
    return settled


def _corners(port: RubblePort, edges: dict[int, SheetEdge]) -> dict[int, tuple[float, float]]:
    """The corner that rubble fills: x of the structure's face, or of the front, at the sheet's underside, and z [m]."""
    under = {k: float(e.z[0]) - 0.5 * port.physics.thickness for k, e in edges.items()}
    face = {k: float(port.structure.face_x(port.layer.centre(k), under[k])) for k in edges}
    return {k: (min(face[k], e.front), under[k]) for k, e in edges.items() if np.isfinite(face[k])}
