"""Rubble that is there before the run: a stated volume of blocks settled at the ice in front of the structure.

Before a structure that bends the ice down, blocks of the sheet's thickness and random length rise from below into the
corner between sheet and structure. Before one that lifts the ice they fall on top of the sheet: ice that has ridden up
and fallen back lies there against the slope (Croasdale, Cammaert and Metge 1994; ISO 19906, A.8.2.4.4.3), and lifted
ice leaves no room for it under the edge. Lengths, tilts and places follow from the seed alone. While they settle they
do not move laterally.

They are spread over the ice as a heap of the slope that is asked for (`heap`), which says how far from the structure
they lie. The slope that they keep is a result: of friction, and of how thick they are beside the heap.

In a plane rectangles pack to a porosity of `PACKED`. Blocks are narrower than a section, with gaps between their sides,
so that the pile has the porosity that is asked for, whatever the mesh.

In shallow water the heap is no thicker than the room over the sea bed, and what still comes to lie below the bed goes
to the outer end of the pile, until all has room: the pile spreads.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, radians, sqrt

import numpy as np

from rubble.domain import Domain
from rubble.geometry import place as placed
from rubble.heap import Flank, Place, heap
from rubble.layer import RubbleLayer
from rubble.piece import Plate, Slab
from rubble.pile import Pile, measure

PACKED = 0.12  #: porosity of settled rectangles in a plane: 0.09 to 0.15 for lengths of 0.5 to 1.5 thicknesses
CALM = 1e-6  #: kinetic over potential energy of a settled pile
GAP = 0.01  #: between blocks that are laid beside each other, in thicknesses
ROUNDS = 100  #: blocks of a section that go from below the sea bed to the outer end of the pile
THICK_AIR = 0.2  #: share of its speed that a block loses in half of sqrt(h / g): it falls with 2 sqrt(g h) at most


@dataclass(frozen=True)
class Initial:
    """What is asked of initial rubble."""

    volume: float  #: of ice [m^3]
    seed: int
    porosity: float = 0.3  #: of the pile
    lengths: tuple[float, float] = (0.5, 1.5)  #: of the blocks, least and greatest, in thicknesses
    slope: float = radians(35.0)  #: of the heap as which they are spread [rad]

    def __post_init__(self) -> None:
        if not self.volume > 0.0:
            raise ValueError(f"initial rubble of {self.volume:g} m3; give more than 0")
        if not PACKED <= self.porosity < 1.0:
            raise ValueError(
                f"initial rubble with a porosity of {self.porosity:g}; give {PACKED:g} to 1, blocks pack no closer"
            )

    @property
    def share(self) -> float:
        """Width of the blocks over that of a section."""
        return (1.0 - self.porosity) / (1.0 - PACKED)

    def blocks(self, flank: Flank, thickness: float) -> int:
        """How many a section holds."""
        return round((1.0 - PACKED) * flank.area / thickness**2 / (0.5 * sum(self.lengths)))

    def flanks(self, layer: RubbleLayer, place: Place) -> dict[int, Flank]:
        """The heap that it forms; sections that would hold less than half a block hold none."""
        bulk, h = self.volume / (1.0 - self.porosity) / layer.pitch, layer.physics.thickness
        room = inf if place.above else layer.physics.depth + min(z for _, z in place.fronts.values())
        found = heap(place, {k: layer.centre(k) for k in place.fronts}, bulk, self.slope, h, room)
        kept = {k: f for k, f in found.items() if self.blocks(f, h) > 0}
        if len(kept) in (0, len(found)):
            return found
        return self.flanks(layer, place.within(kept))


def settle(layer: RubbleLayer, place: Place, asked: Initial, longest: float = 300.0) -> Pile:
    """Lay a heap and let it come to rest; ``layer`` has its sheet already.

    RuntimeError if the pile has not settled after ``longest`` [s].
    """
    random, flanks = np.random.default_rng(asked.seed), asked.flanks(layer, place)
    area = sum(f.area for f in flanks.values())
    for key in sorted(flanks):
        volume = asked.volume * flanks[key].area / area
        _fill(layer, key, place, flanks[key], volume, asked, random)
    layer.runner.bed = -inf
    return rest(layer, place, longest)


def rest(layer: RubbleLayer, place: Place, longest: float = 300.0) -> Pile:
    """Let the blocks come to rest at the sheet as it is now; RuntimeError after ``longest`` [s]."""
    domain, layer.domain, layer.runner.planar = layer.domain, Domain(), True
    layer.table_of_sections.widen(len(layer.runner.body) > 0)
    yields, layer.runner.yields = layer.runner.yields, None  # the sheet lies still
    layer.set_water(20.0 * max(layer.physics.form_drag, 0.5), (0.0, 0.0))  # to rest sooner; the rest is the same
    calm = _come_to_rest(layer, place, longest)
    if layer.runner.bed < -layer.physics.depth:
        calm = _spread(layer, place, longest)
    time, layer.time, layer.runner.planar, layer.domain = layer.time, 0.0, False, domain
    layer.runner.yields = yields
    layer.set_water(layer.physics.form_drag, layer.physics.current)
    layer.table_of_sections.widen(False)
    if calm > CALM:
        raise RuntimeError(
            f"initial rubble has not settled after {longest:g} s: kinetic over potential energy is "
            f"{calm:.2g}; give another seed or more friction"
        )
    return measure(layer, place, time, calm)


def _come_to_rest(layer: RubbleLayer, place: Place, longest: float) -> float:
    """Advance until nothing moves at both ends of a window, whose forces are those at rest; how calm it is."""
    half = 0.5 * sqrt(layer.physics.thickness / layer.physics.g)
    end = layer.time + longest
    before, calm, steps = 1.0, 1.0, max(1, round((half if place.above else 0.5) / layer.physics.substep))
    while max(before, calm) > CALM and layer.time < end:
        layer.advance(steps)
        before, calm = calm, _calm(layer, place)
        if place.above:
            layer.store.plates.velocity[:-1] *= 1.0 - THICK_AIR
    return calm


def _spread(layer: RubbleLayer, place: Place, longest: float) -> float:
    """What lies below the sea bed goes to the outer end of the pile; how calm it is when nothing does any more."""
    for _ in range(ROUNDS):
        below = [b for b in layer.blocks if _low(b) < -layer.physics.depth]
        if not below:
            layer.runner.bed = -layer.physics.depth
            return _come_to_rest(layer, place, longest)
        for key in sorted({_key(layer, b) for b in below}):
            _lowest_goes_out(layer, key, place.fronts[key][1])
        _come_to_rest(layer, place, longest)
    raise RuntimeError(
        f"initial rubble finds no room over the sea bed, {len(below)} blocks of it are below; give less of it "
        "(rubble.initial_volume) or more water (water.depth)"
    )


def _lowest_goes_out(layer: RubbleLayer, key: int, top: float) -> None:
    """The lowest block of a section goes to the ice ahead of all others of the section."""
    own = [b for b in layer.blocks if _key(layer, b) == key]
    block, gap = min(own, key=_low), GAP * layer.physics.thickness
    outline, end = block.outline, min(float(b.outline[:, 0].min()) for b in own)
    block.position[0] += end - gap - float(outline[:, 0].max())
    block.position[2] += top - gap - float(outline[:, 1].max())
    block.velocity[:] = block.omega[:] = 0.0


def _key(layer: RubbleLayer, block: Plate) -> int:
    return layer.key_at(float(block.position[1]))


def _low(block: Plate) -> float:
    return float(block.outline[:, 1].min())


def _fill(
    layer: RubbleLayer,
    key: int,
    place: Place,
    flank: Flank,
    volume: float,
    asked: Initial,
    random: np.random.Generator,
) -> None:
    """Blocks of one section, one behind the other: they rise, or fall, and arrive in turn, each at its place."""
    front, top = place.fronts[key]
    h, width = layer.physics.thickness, layer.pitch * asked.share
    count, area = max(1, asked.blocks(flank, h)), volume / width
    length = random.uniform(*asked.lengths, count)
    length *= area / (h * length.sum())
    row = 1.05 * float(np.hypot(length.max(), h))
    for i, (size, x) in enumerate(zip(length, flank.places(count, random), strict=True)):
        x, z = min(x, front - 0.5 * size), top - place.side * (i + 0.6) * row
        angle = float(random.uniform(-0.5, 0.5) * np.pi)
        box = np.array([(-size, -h), (size, -h), (size, h), (-size, h)]) / 2.0
        middle = x * np.cos(angle) + z * np.sin(angle)
        slab = Slab(
            placed(box, x, z, angle, 0.0, 0.0),
            middle + np.array([-size, size]) / 2.0,
            np.array([width]),
            layer.physics.rho_i,
            angle,
        )
        y = layer.centre(key) + 0.5 * (layer.pitch - width) * random.uniform(-1.0, 1.0)
        layer.add_block(key, slab, fragment=-1, flooded=None if place.above else 1.0, y=float(y))


def _calm(layer: RubbleLayer, place: Place) -> float:
    (moving, _), t = layer.runner.energies(layer.store), layer.table()
    top = np.mean([z for _, z in place.fronts.values()])
    lift = layer.physics.g * (1.0 if place.above else layer.physics.rho_w / layer.physics.rho_i - 1.0)
    return moving / max(lift * float(t.mass @ np.abs(t.position[:, 2] - top)), 1.0)
