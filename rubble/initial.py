"""Rubble that is there before the run: a stated volume of blocks settled at the ice in front of the structure.

Before a structure that bends the ice down, blocks of the sheet's thickness and random length rise from below into the
corner between sheet and structure. Before one that lifts the ice they fall on top of the sheet: ice that has ridden up
and fallen back lies there against the slope (Croasdale, Cammaert and Metge 1994; ISO 19906, A.8.2.4.4.3), and lifted
ice leaves no room for it under the edge. Lengths, tilts and places follow from the seed alone. While they settle they
do not move laterally.

In a plane rectangles pack to a porosity of `PACKED`. Blocks are narrower than a section, with gaps between their sides,
so that the pile has the porosity that is asked for, whatever the mesh. The slope is a result.

In shallow water the pile first settles without the sea bed, which then comes up from below the lowest block to where it
is: what it meets grounds and spreads.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from rubble.domain import Domain
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.piece import Slab
from rubble.pile import Pile, measure

SLOPE = np.radians(35.0)  #: of the heap that the blocks are spread for; the result may differ
PACKED = 0.12  #: porosity of settled rectangles in a plane: 0.09 to 0.15 for lengths of 0.5 to 1.5 thicknesses
CALM = 1e-6  #: kinetic over potential energy of a settled pile
RISE = 0.1  #: speed with which the sea bed comes up, over sqrt(g h)
THICK_AIR = 0.2  #: share of its speed that a block loses in half of sqrt(h / g): it falls with 2 sqrt(g h) at most

Fronts = Mapping[int, tuple[float, float]]


@dataclass(frozen=True)
class Heap:
    """What a section is filled with."""

    volume: float  #: of ice [m^3]
    share: float  #: width of the blocks over that of the section
    porosity: float  #: that the pile is to have
    lengths: tuple[float, float]  #: of the blocks, least and greatest, in thicknesses
    side: float = 1.0  #: of the sheet on which it lies: 1 below, -1 above


def settle(
    layer: RubbleLayer,
    fronts: Fronts,
    volume: float,
    seed: int,
    *,
    porosity: float = 0.3,
    lengths: tuple[float, float] = (0.5, 1.5),
    above: bool = False,
    longest: float = 300.0,
) -> Pile:
    """Fill the sections with ``volume`` [m^3] in equal shares and let it come to rest; ``layer`` has its sheet already.

    ``fronts`` holds for each section x of the structure's face at the side of the sheet on which the rubble lies, its
    underside or, ``above``, its top, and z of that side [m]; ``porosity`` of the pile, ``lengths`` of the blocks in
    thicknesses. RuntimeError if the pile has not settled after ``longest`` [s].
    """
    if not volume > 0.0 or not fronts:
        raise ValueError(f"initial rubble of {volume:g} m3 in {len(fronts)} sections; give more than 0 of both")
    if not PACKED <= porosity < 1.0:
        raise ValueError(f"initial rubble with a porosity of {porosity:g}; give {PACKED:g} to 1, blocks pack no closer")
    random = np.random.default_rng(seed)
    share = (1.0 - porosity) / (1.0 - PACKED)
    heap = Heap(volume / len(fronts), share, porosity, lengths, -1.0 if above else 1.0)
    for key in sorted(fronts):
        _fill(layer, key, fronts[key], heap, random)
    layer.runner.bed = -inf
    return rest(layer, fronts, above=above, longest=longest)


def rest(layer: RubbleLayer, fronts: Fronts, *, above: bool = False, longest: float = 300.0) -> Pile:
    """Let the blocks come to rest at the sheet as it is now; arguments as in `settle`."""
    domain, layer.domain, layer.runner.planar = layer.domain, Domain(), True
    layer.table_of_sections.widen(len(layer.runner.body) > 0)
    yields, layer.runner.yields = layer.runner.yields, None  # the sheet lies still
    layer.set_form_drag(20.0 * max(layer.physics.form_drag, 0.5))  # to rest sooner; the rest is the same
    calm = _come_to_rest(layer, fronts, above, longest)
    if layer.runner.bed < -layer.physics.depth:
        _ground(layer)
        calm = _come_to_rest(layer, fronts, above, longest)
    time, layer.time, layer.runner.planar, layer.domain = layer.time, 0.0, False, domain
    layer.runner.yields = yields
    layer.set_form_drag(layer.physics.form_drag)
    layer.table_of_sections.widen(False)
    if calm > CALM:
        raise RuntimeError(
            f"initial rubble has not settled after {longest:g} s: kinetic over potential energy is "
            f"{calm:.2g}; give another seed or more friction"
        )
    return measure(layer, fronts, -1.0 if above else 1.0, time, calm)


def _come_to_rest(layer: RubbleLayer, fronts: Fronts, above: bool, longest: float) -> float:
    """Advance until nothing moves at both ends of a window, whose forces are those at rest; how calm it is."""
    half = 0.5 * sqrt(layer.physics.thickness / layer.physics.g)
    before, calm, steps = 1.0, 1.0, max(1, round((half if above else 0.5) / layer.physics.substep))
    while max(before, calm) > CALM and layer.time < longest:
        layer.advance(steps)
        before, calm = calm, _calm(layer, fronts, above)
        if above:
            layer.store.plates.velocity[:-1] *= 1.0 - THICK_AIR
    return calm


def _ground(layer: RubbleLayer) -> None:
    """The sea bed comes up from below the lowest block to where it is."""
    p, at = layer.physics, min(float(b.outline[:, 1].min()) for b in layer.blocks)
    steps = max(1, round(0.1 * sqrt(p.thickness / p.g) / p.substep))
    way = RISE * sqrt(p.thickness * p.g) * steps * p.substep
    while at < -p.depth:
        layer.runner.bed = at
        layer.advance(steps)
        at += way
    layer.runner.bed = -p.depth


def _fill(layer: RubbleLayer, key: int, corner: tuple[float, float], heap: Heap, random: np.random.Generator) -> None:
    """Blocks of one section, one behind the other: they rise, or fall, and arrive in turn, as if poured."""
    h, width, (x_face, z_top) = layer.physics.thickness, layer.pitch * heap.share, corner
    area = heap.volume / width
    count = max(1, round(area / h**2 / (0.5 * sum(heap.lengths))))
    length = random.uniform(*heap.lengths, count)
    length *= area / (h * length.sum())
    base = np.sqrt(2.0 * heap.volume / layer.pitch / (1.0 - heap.porosity) / np.tan(SLOPE))
    row = 1.05 * float(np.hypot(length.max(), h))
    for i, size in enumerate(length):
        x, z = x_face - base * random.uniform(0.05, 0.65), z_top - heap.side * (i + 0.6) * row
        angle = float(random.uniform(-0.5, 0.5) * np.pi)
        box = np.array([(-size, -h), (size, -h), (size, h), (-size, h)]) / 2.0
        middle = x * np.cos(angle) + z * np.sin(angle)
        slab = Slab(
            place(box, x, z, angle, 0.0, 0.0),
            middle + np.array([-size, size]) / 2.0,
            np.array([width]),
            layer.physics.rho_i,
            angle,
        )
        y = layer.centre(key) + 0.5 * (layer.pitch - width) * random.uniform(-1.0, 1.0)
        layer.add_block(key, slab, fragment=-1, flooded=1.0 if heap.side > 0.0 else None, y=float(y))


def _calm(layer: RubbleLayer, fronts: Fronts, above: bool) -> float:
    (moving, _), t = layer.runner.energies(layer.store), layer.table()
    top = np.mean([z for _, z in fronts.values()])
    lift = layer.physics.g * (1.0 if above else layer.physics.rho_w / layer.physics.rho_i - 1.0)
    return moving / max(lift * float(t.mass @ np.abs(t.position[:, 2] - top)), 1.0)
