"""What a settled pile of initial rubble is like: porosity, slope of its flank, depth.

Rubble lies under the sheet, or on top of it: ``side`` is +1 or -1, and heights are then counted downwards or upwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan

import numpy as np

from rubble.arrays import Array
from rubble.heap import Place
from rubble.layer import RubbleLayer

STEP = 1 / 30  #: of the raster on which a pile is measured, in thicknesses
BIN = 1 / 4  #: of distances from the structure, in thicknesses


@dataclass(frozen=True)
class Pile:
    """What a settled pile is like."""

    blocks: int
    volume: float  #: of ice [m^3]
    mass: float  #: [kg]
    porosity: float  #: pore share of the room between sheet, structure and the pile's outer side
    slope: float  #: of the flank away from the structure, of all sections together, see `flank` [rad]
    depth: float  #: of the point farthest from the sheet [m]
    time: float  #: until it had settled [s]
    calm: float  #: kinetic over potential energy at the end
    force: float  #: on sheet and structure, towards the sheet, mean of the last window [N]


def measure(layer: RubbleLayer, place: Place, time: float = 0.0, calm: float = 0.0) -> Pile:
    """Porosity, slope and force of the pile as it lies."""
    step, found = STEP * layer.physics.thickness, {}
    for key, front in place.fronts.items():
        if (profile := _profile(layer, key, front, place.side, step)) is not None:
            found[key] = profile
    ice, pores = sum(p.ice for p in found.values()), sum(p.pores for p in found.values())
    on_sheet = sum(float(layer.sheet_forces(key)[:, 2].sum()) for key in layer.sections)
    distance = [place.distance(p.x, layer.centre(key)) for key, p in found.items()]
    return Pile(
        blocks=len(layer.blocks),
        volume=layer.mass / layer.physics.rho_i,
        mass=layer.mass,
        porosity=pores / (ice + pores) if ice > 0.0 else nan,
        slope=flank(distance, [p.flank for p in found.values()], layer.physics.thickness * BIN),
        depth=max((p.depth for p in found.values()), default=0.0),
        time=time,
        calm=calm,
        force=place.side * (float(layer.load_on_structure[:, 2].sum()) + on_sheet),
    )


def flank(distance: Sequence[Array], thickness: Sequence[Array], step: float) -> float:
    """Angle of a flank [rad] from thicknesses of the pile (n,) of each section and distances from the structure [m].

    A flank of slope s that ends at a distance L has A = s L^2 / 2 and B = s^2 L^3 / 3 as the integrals of its thickness
    d and of d^2, so L = 4 A^2 / (3 B) and s = 2 A / L^2: all of the flank counts and no single block. d is the mean of
    all sections at one distance, within ``step`` [m], which takes the roughness out of B. nan without a flank.
    """
    if not any(d.any() for d in thickness):
        return nan
    at, d = np.concatenate(distance), np.concatenate(thickness)
    number = ((at - at.min()) / step).astype(int)
    samples = np.bincount(number)
    mean = np.bincount(number, d)[samples > 0] / samples[samples > 0]
    area, square = float(mean.sum()) * step, float((mean**2).sum()) * step
    length = 4.0 * area**2 / (3.0 * square)
    return float(np.arctan(2.0 * area / length**2))


@dataclass(frozen=True)
class _Profile:
    """A section of the pile."""

    ice: float  #: area [m^2]
    pores: float
    x: Array  #: (n,) in front of the corner between sheet and structure, from there on [m]
    flank: Array  #: (n,) thickness there [m]
    depth: float  #: greatest thickness [m]


def _profile(layer: RubbleLayer, key: int, corner: tuple[float, float], side: float, step: float) -> _Profile | None:
    """One section, seen so that the sheet is above it; None if nothing lies under it."""
    blocks = [b for b in layer.blocks if layer.key_at(float(b.position[1])) == key]
    if not blocks:
        return None
    outlines = [_turned(b.outline, side) for b in blocks]
    solids = [_turned(s, side) for s in layer.section(key).cut.polygons]
    corners, (x_corner, top) = np.concatenate(outlines), (corner[0], side * corner[1])
    ahead = np.arange(x_corner + step / 2, corners[:, 0].max(), step)
    x = np.concatenate([np.arange(x_corner - step / 2, corners[:, 0].min(), -step)[::-1], ahead])
    z = np.arange(corners[:, 1].min() + step / 2, top, step)
    gx, gz = np.meshgrid(x, z, indexing="ij")
    covered = np.any([_inside(o, gx, gz) for o in outlines], axis=0)
    if not covered.any():
        return None  # all that lies there has risen beside the sheet
    solid = np.any([_inside(s, gx, gz) for s in solids], axis=0) if solids else np.zeros_like(covered)
    low = np.where(covered.any(axis=1), z[np.argmax(covered, axis=1)], np.nan)
    pores = ~covered & ~solid & (gz >= low[:, None])
    ice = sum(b.mass for b in blocks) / layer.physics.rho_i / layer.pitch
    thick = np.nan_to_num(top - low + step / 2)
    before = slice(len(x) - len(ahead))
    bulk = float((covered | pores).sum()) * step**2
    return _Profile(ice, bulk - ice, x[before], thick[before], float(thick.max()))


def _turned(polygon: Array, side: float) -> Array:
    """An outline, upside down for -1, counter-clockwise still."""
    return polygon if side > 0.0 else polygon[::-1] * np.array([1.0, -1.0])


def _inside(polygon: Array, x: Array, z: Array) -> Array:
    """Which points lie in a convex counter-clockwise polygon."""
    out = np.ones(x.shape, dtype=bool)
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        out &= (b[0] - a[0]) * (z - a[1]) - (b[1] - a[1]) * (x - a[0]) >= 0.0
    return out
