"""Rubble that is there before the run, under a sheet that lies still, or on top of it where the structure lifts it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from coupling.interface import SheetEdge, SimulationError
from coupling.rubble_port.failing import failing
from coupling.rubble_port.port import RubblePort
from rubble.arrays import Array
from rubble.heap import Place
from rubble.initial import Initial, rest, settle
from rubble.pile import Pile

__all__ = ["Initial", "all_sections", "fill", "rest_again", "sections_of"]

Edges = dict[int, SheetEdge]
OUTLINE = 0.1  #: greatest spacing of points along the structure's outline, in thicknesses


def all_sections(port: RubblePort) -> range:
    """Sections of the whole width of the sheet."""
    layer = port.layer
    half = layer.domain.y_max - layer.pitch
    return range(layer.key_at(-half), layer.key_at(half) + 1)


def sections_of(port: RubblePort, asked: Initial, edges: Edges) -> list[int]:
    """Of ``edges``, those in which the heap lies."""
    with failing():
        return sorted(asked.flanks(port.layer, _place(port, edges)))


def fill(port: RubblePort, asked: Initial, edges: Edges) -> Pile:
    """Settles new rubble in the sections of ``edges``."""
    _hold(port, edges)
    settled = _settled(port, lambda: settle(port.layer, _place(port, edges), asked))
    _lies_under_known_sheet(port, edges)
    return settled


def rest_again(port: RubblePort, edges: Edges) -> Pile:
    """The rubble comes to rest once more, under a sheet that has moved."""
    _hold(port, edges)
    return _settled(port, lambda: rest(port.layer, _place(port, edges)))


def _hold(port: RubblePort, edges: Edges) -> None:
    """The sheet lies still and yields to nothing."""
    still = {k: replace(e, velocity=np.zeros_like(e.velocity)) for k, e in edges.items()}
    port.set_sheet(still, port.forces_on_sheet(), np.zeros((2, len(still), len(still))))


def _lies_under_known_sheet(port: RubblePort, edges: Edges) -> None:
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


def _place(port: RubblePort, edges: Edges) -> Place:
    """Rubble lies at the side of the sheet to which it is pushed, from its front or the structure on."""
    above = not port.structure.faces_down
    half = (0.5 if above else -0.5) * port.physics.thickness
    at = {k: float(e.z[0]) + half for k, e in edges.items()}
    face = {k: float(port.structure.face_x(port.layer.centre(k), at[k])) for k in edges}
    fronts = {k: (e.front if np.isnan(face[k]) else min(face[k], e.front), at[k]) for k, e in edges.items()}
    return Place(fronts, _outline(port, float(np.median(list(at.values())))), above)


def _outline(port: RubblePort, z: float) -> Array:
    """(n, 2) x and y of the structure's face at a height [m]."""
    half = min(port.structure.half_width, port.layer.domain.y_max)
    y = np.linspace(-half, half, 1 + 2 * int(np.ceil(half / (OUTLINE * port.physics.thickness))))
    outline = np.column_stack([port.structure.face_x(y, z), y])
    return outline[np.isfinite(outline[:, 0])]
