"""Rubble that is there before the run, under a sheet that lies still, or on top of it where the structure lifts it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from coupling.interface import SheetEdge, SimulationError
from coupling.rubble_port.failing import failing
from coupling.rubble_port.port import RubblePort
from rubble.initial import rest, settle
from rubble.pile import Pile


def front_sections(port: RubblePort) -> list[int]:
    """Sections in whose middle plane the structure stands in the ice's way at the waterline."""
    layer = port.layer
    half = min(port.structure.half_width, layer.domain.y_max)
    keys = range(layer.key_at(-half), layer.key_at(half) + 1)
    return [k for k in keys if abs(y := layer.centre(k)) < half and np.isfinite(port.structure.face_x(y, 0.0))]


@dataclass(frozen=True)
class Initial:
    """What is asked of initial rubble."""

    volume: float  #: of ice [m^3]
    porosity: float
    lengths: tuple[float, float]  #: of the blocks, least and greatest, in thicknesses
    seed: int


def fill(port: RubblePort, asked: Initial, edges: dict[int, SheetEdge]) -> Pile:
    """Settles new rubble in the sections of ``edges``."""
    _hold(port, edges)
    corners, above = _corners(port, edges), not port.structure.faces_down

    def pile() -> Pile:
        return settle(
            port.layer,
            corners,
            asked.volume,
            asked.seed,
            porosity=asked.porosity,
            lengths=asked.lengths,
            above=above,
        )

    settled = _settled(port, pile)
    _lies_under_known_sheet(port, edges)
    return settled


def rest_again(port: RubblePort, edges: dict[int, SheetEdge]) -> Pile:
    """The rubble comes to rest once more, under a sheet that has moved."""
    _hold(port, edges)
    return _settled(port, lambda: rest(port.layer, _corners(port, edges), above=not port.structure.faces_down))


def _hold(port: RubblePort, edges: dict[int, SheetEdge]) -> None:
    """The sheet lies still and yields to nothing."""
    still = {k: replace(e, velocity=np.zeros_like(e.velocity)) for k, e in edges.items()}
    port.set_sheet(still, port.forces_on_sheet(), np.zeros((2, len(still), len(still))))


def _lies_under_known_sheet(port: RubblePort, edges: dict[int, SheetEdge]) -> None:
    """The rubble knows the front of the sheet only; what has spread behind it rises, or falls, past it."""
    rear = {k: float(e.x[-1]) for k, e in edges.items()}
    layer = port.layer
    for b in layer.blocks:
        x, y, _ = b.position.tolist()
        if x < rear.get(layer.key_at(y), -np.inf):
            raise SimulationError(
                f"initial rubble reaches {-x:.3g} m before the structure's axis, beyond the front of the sheet that "
                "rubble meets; give less of it (rubble.initial_volume), or more water (water.depth)"
            )


def _settled(port: RubblePort, pile: Callable[[], Pile]) -> Pile:
    with failing():
        settled = pile()
    port.take_forces()
    return settled


def _corners(port: RubblePort, edges: dict[int, SheetEdge]) -> dict[int, tuple[float, float]]:
    """The corner that rubble fills: x of structure or front at the side of the sheet where it lies, and z [m]."""
    half = (-0.5 if port.structure.faces_down else 0.5) * port.physics.thickness
    at = {k: float(e.z[0]) + half for k, e in edges.items()}
    face = {k: float(port.structure.face_x(port.layer.centre(k), at[k])) for k in edges}
    return {k: (min(face[k], e.front), at[k]) for k, e in edges.items() if np.isfinite(face[k])}
