"""Rubble that is there before the run: a stated volume of blocks settled under the ice in front of the structure.

Blocks of the sheet's thickness and random length rise from below into the corner between sheet and structure and come
to rest there. Their lengths, tilts and places follow from the seed alone. While they settle they do not move laterally.

In a plane rectangles pack to a porosity of `PACKED`. Blocks are narrower than a section, with gaps between their sides,
so that the pile has the porosity that is asked for, whatever the mesh. The slope is a result.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rubble.arrays import Array
from rubble.domain import Domain
from rubble.energy import mechanical_energy
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.piece import Slab

SLOPE = np.radians(35.0)  #: of the heap that the blocks are spread for; the result may differ
PACKED = 0.12  #: porosity of settled rectangles in a plane: 0.09 to 0.15 for lengths of 0.5 to 1.5 thicknesses
CALM = 1e-6  #: kinetic over potential energy of a settled pile


@dataclass(frozen=True)
class Heap:
    """What a section is filled with."""

    volume: float  #: of ice [m^3]
    share: float  #: width of the blocks over that of the section
    porosity: float  #: that the pile is to have
    lengths: tuple[float, float]  #: of the blocks, least and greatest, in thicknesses


@dataclass(frozen=True)
class Pile:
    """What a settled pile is like."""

    blocks: int
    volume: float  #: of ice [m^3]
    mass: float  #: [kg]
    porosity: float  #: pore share of the room between sheet, structure and the pile's lower side
    slope: float  #: of the flank away from the structure, mean of the sections [rad]
    depth: float  #: of the deepest point below the sheet [m]
    time: float  #: until it had settled [s]
    calm: float  #: kinetic over potential energy at the end
    force: float  #: upward on sheet and structure, mean of the last window [N]


def settle(
    layer: RubbleLayer,
    fronts: Mapping[int, tuple[float, float]],
    volume: float,
    seed: int,
    *,
    porosity: float = 0.3,
    lengths: tuple[float, float] = (0.5, 1.5),
    longest: float = 300.0,
    window: float = 0.5,
) -> Pile:
    """Fill the sections with ``volume`` [m^3] in equal shares and let it come to rest; ``layer`` has its sheet already.

    ``fronts`` holds for each section x of the structure's face at the sheet's underside and z of that underside [m];
    ``porosity`` of the pile, ``lengths`` of the blocks in thicknesses. RuntimeError if the pile has not settled after
    ``longest`` [s].
    """
    if not volume > 0.0 or not fronts:
        raise ValueError(f"initial rubble of {volume:g} m3 in {len(fronts)} sections; give more than 0 of both")
    if not PACKED <= porosity < 1.0:
        raise ValueError(f"initial rubble with a porosity of {porosity:g}; give {PACKED:g} to 1, blocks pack no closer")
    random = np.random.default_rng(seed)
    heap = Heap(volume / len(fronts), (1.0 - porosity) / (1.0 - PACKED), porosity, lengths)
    for key in sorted(fronts):
        _fill(layer, key, fronts[key], heap, random)
    return rest(layer, fronts, longest=longest, window=window)


def rest(
    layer: RubbleLayer, fronts: Mapping[int, tuple[float, float]], *, longest: float = 300.0, window: float = 0.5
) -> Pile:
    """Let the blocks come to rest under the sheet as it is now; arguments as in `settle`."""
    domain, layer.domain, layer.runner.planar = layer.domain, Domain(), True
    layer.set_form_drag(20.0 * max(layer.physics.form_drag, 0.5))  # to rest sooner; the rest is the same
    calm, steps = 1.0, round(window / layer.physics.substep)
    while calm > CALM and layer.time < longest:
        layer.advance(steps)
        calm = _calm(layer, fronts)
    time, layer.time, layer.runner.planar, layer.domain = layer.time, 0.0, False, domain
    layer.set_form_drag(layer.physics.form_drag)
    if calm > CALM:
        raise RuntimeError(
            f"initial rubble has not settled after {longest:g} s: kinetic over potential energy is "
            f"{calm:.2g}; give another seed or more friction"
        )
    return measure(layer, fronts, time, calm)


def _fill(layer: RubbleLayer, key: int, corner: tuple[float, float], heap: Heap, random: np.random.Generator) -> None:
    """Blocks of one section, one below the other: they rise and arrive in turn, as if poured."""
    h, width, (x_face, z_top) = layer.physics.thickness, layer.pitch * heap.share, corner
    area = heap.volume / width
    count = max(1, round(area / h**2 / (0.5 * sum(heap.lengths))))
    length = random.uniform(*heap.lengths, count)
    length *= area / (h * length.sum())
    base = np.sqrt(2.0 * heap.volume / layer.pitch / (1.0 - heap.porosity) / np.tan(SLOPE))
    row = 1.05 * float(np.hypot(length.max(), h))
    for i, size in enumerate(length):
        x, z = x_face - base * random.uniform(0.05, 0.65), z_top - (i + 0.6) * row
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
        layer.add_block(key, slab, fragment=-1, flooded=1.0, y=float(y))


def _calm(layer: RubbleLayer, fronts: Mapping[int, tuple[float, float]]) -> float:
    energy, t = mechanical_energy(layer), layer.table()
    top = np.mean([z for _, z in fronts.values()])
    lift = (layer.physics.rho_w / layer.physics.rho_i - 1.0) * layer.physics.g
    return (energy["kinetic"] + energy["added"]) / max(lift * float(t.mass @ np.abs(t.position[:, 2] - top)), 1.0)


def measure(
    layer: RubbleLayer, fronts: Mapping[int, tuple[float, float]], time: float = 0.0, calm: float = 0.0
) -> Pile:
    """Porosity, slope and upward force of the pile as it lies."""
    ice = pores = 0.0
    slopes, depths = [], []
    for key in fronts:
        found = _profile(layer, key, fronts[key][1])
        if found is not None:
            ice, pores = ice + found[0], pores + found[1]
            slopes.append(found[2])
            depths.append(found[3])
    on_sheet = sum(float(layer.sheet_forces(key)[:, 2].sum()) for key in layer.sections)
    lift = float(layer.load_on_structure[:, 2].sum()) + on_sheet
    return Pile(
        blocks=len(layer.blocks),
        volume=layer.mass / layer.physics.rho_i,
        mass=layer.mass,
        porosity=pores / (ice + pores) if ice > 0.0 else float("nan"),
        slope=float(np.mean(slopes)) if slopes else float("nan"),
        depth=float(max(depths, default=0.0)),
        time=time,
        calm=calm,
        force=lift,
    )


def _profile(layer: RubbleLayer, key: int, top: float, step: float = 0.1) -> tuple[float, float, float, float] | None:
    """Ice and pore area [m^2], slope of the rear flank [rad] and depth below the sheet [m] of one section."""
    section = layer.section(key)
    solids = section.cut.polygons
    blocks = [b for b in layer.blocks if layer.key_at(float(b.position[1])) == key]
    if not blocks:
        return None
    outlines = [b.outline for b in blocks]
    corners = np.concatenate(outlines)
    x = np.arange(corners[:, 0].min() + step / 2, corners[:, 0].max(), step)
    z = np.arange(corners[:, 1].min() + step / 2, top, step)
    gx, gz = np.meshgrid(x, z, indexing="ij")
    covered = np.any([_inside(o, gx, gz) for o in outlines], axis=0)
    if not covered.any():
        return None  # all that lies there has risen beside the sheet
    solid = np.any([_inside(s, gx, gz) for s in solids], axis=0) if solids else np.zeros_like(covered)
    low = np.where(covered.any(axis=1), z[np.argmax(covered, axis=1)], np.nan)
    pores = ~covered & ~solid & (gz >= low[:, None])
    deepest = int(np.nanargmin(low))
    flank, rear = low[: deepest + 1], x[: deepest + 1]
    on = np.isfinite(flank)
    slope = -np.polyfit(rear[on], flank[on], 1)[0] if on.sum() > 1 else 0.0
    ice, room = (
        sum(b.mass for b in blocks) / layer.physics.rho_i / layer.pitch,
        float((covered | pores).sum()) * step**2,
    )
    return ice, room - ice, float(np.arctan(slope)), top - low[deepest]


def _inside(polygon: Array, x: Array, z: Array) -> Array:
    """Which points lie in a convex counter-clockwise polygon."""
    out = np.ones(x.shape, dtype=bool)
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        out &= (b[0] - a[0]) * (z - a[1]) - (b[1] - a[1]) * (x - a[0]) >= 0.0
    return out
