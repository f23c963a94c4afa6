"""A block as a prism: strips of constant width along its long axis, their inertia and their wetted edges."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2

import numpy as np

from rubble.arrays import Array, Records, filled
from rubble.geometry import area_moments, clip, second_moments
from rubble.pressure import EDGE

#: Cosine of the steepest edge that belongs to a block's top, 26 degrees: the sides of a piece stand at 90 degrees, what
#: a trim or crushing has cut at that of the slope (45 degrees and more); the top of a piece in the sheet lies flat.
TOP = 0.9


@dataclass(frozen=True, slots=True)
class Prism:
    """What follows from a block's outline and its strips; in the plate's axes, about its centre of mass."""

    polygon: Array  #: (k, 2) outline, counter-clockwise
    edges: Records  #: (e,) EDGE, see `pressure`
    mass: float  #: true mass [kg]
    tensor: Array  #: (3, 3) true inertia about the centre of mass [kg m^2]
    width: float  #: mean extent along y [m]
    area: float  #: of the outline [m^2]
    reach: float  #: of the farthest corner from the centre [m]
    long_axis: float  #: direction of the long axis [rad]
    slender: bool  #: long and short extent differ by more than 20 %; else both axes count as long
    parts: list[Array]  #: strips of the outline
    cuts: Array  #: (s + 1,) where the strips begin and end along body x [m]
    widths: Array  #: (s,) their widths along y [m]


def make_prism(own: Array, cuts: Array, widths: Array, density: float) -> tuple[Prism, tuple[float, float]]:
    """The prism of an outline turned so that its axis lies along x, and where its centre of mass was."""
    cuts, widths = _checked_strips(own, cuts, widths)
    parts = strips(own, cuts, widths)
    volume, cx, cz, tensor = inertia(parts, widths)
    shift = np.array([cx, cz])
    parts, own, area = [p - shift for p in parts], own - shift, float(area_moments(own).area)
    edges = wetted_edges(parts, cuts - cx, widths)
    axis, slender = _long_axis(own)
    prism = Prism(
        polygon=own,
        edges=edges,
        mass=density * volume,
        tensor=density * tensor,
        width=volume / area,
        area=area,
        reach=float(np.hypot(*own.T).max()),
        long_axis=axis,
        slender=slender,
        parts=parts,
        cuts=cuts - cx,
        widths=widths,
    )
    return prism, (cx, cz)


def strips(polygon: Array, cuts: Array, widths: Array) -> list[Array]:
    """Parts of a body-frame polygon between the cuts (s + 1,) along body x, one for each of the (s,) widths."""
    parts = []
    for k in range(len(widths)):
        part = polygon if k == 0 else clip(polygon, -1.0, 0.0, -float(cuts[k]))
        parts.append(part if k == len(widths) - 1 else clip(part, 1.0, 0.0, float(cuts[k + 1])))
    return parts


def inertia(parts: list[Array], widths: Array) -> tuple[float, float, float, Array]:
    """Volume [m^3], centre x and z [m], and inertia about the centre (3, 3) [m^5] of strips with widths."""
    area, at_x, at_z, _ = np.array([area_moments(p) for p in parts]).T
    xx, zz, xz = np.array([second_moments(p) for p in parts]).T
    volume = area * widths
    total = float(volume.sum())
    x, z = float(volume @ at_x) / total, float(volume @ at_z) / total
    sum_xx = float(xx @ widths + volume @ (at_x - x) ** 2)
    sum_zz = float(zz @ widths + volume @ (at_z - z) ** 2)
    sum_xz = float(xz @ widths + volume @ ((at_x - x) * (at_z - z)))
    sum_yy = float(volume @ widths**2) / 12.0
    tensor = np.diag([sum_yy + sum_zz, sum_xx + sum_zz, sum_xx + sum_yy])
    tensor[0, 2] = tensor[2, 0] = -sum_xz
    return total, x, z, tensor


def wetted_edges(parts: list[Array], cuts: Array, widths: Array) -> Records:
    """`EDGE` rows (e,) of a block of strips: outer edges with their strip's width, steps with the difference.

    A face at a cut appears in both strips with opposite directions; keeping it with both widths is the step.
    """
    rows = []
    for k, part in enumerate(parts):
        for a, b in zip(part, np.roll(part, -1, axis=0), strict=True):
            neighbour = _beyond_cut(a[0], b[0], cuts, k, len(parts))
            width = widths[k] - (0.0 if neighbour is None else min(widths[k], widths[neighbour]))
            if width > 0:
                top = neighbour is None and a[0] - b[0] > TOP * np.hypot(*(b - a))
                rows.append((a[0], a[1], b[0], b[1], width, float(top), *((b - a) / max(np.hypot(*(b - a)), 1e-300))))
    return filled(EDGE, rows)


def _beyond_cut(xa: float, xb: float, cuts: Array, k: int, count: int) -> int | None:
    """Number of the strip on the other side of an edge that lies on a cut; None for an outer edge."""
    same = 1e-12 * (cuts[-1] - cuts[0])
    for cut, other in ((k, k - 1), (k + 1, k + 1)):
        if 0 <= other < count and abs(xa - cuts[cut]) < same and abs(xb - cuts[cut]) < same:
            return other
    return None


def _checked_strips(polygon: Array, cuts: Array, widths: Array) -> tuple[Array, Array]:
    """Strips as arrays, the outer cuts moved to the block's ends so that no ice is left out."""
    cuts, widths = np.array(cuts, dtype=np.float64), np.array(widths, dtype=np.float64)
    if len(cuts) != len(widths) + 1 or (np.diff(cuts) <= 0).any() or not (widths > 0).all():
        raise ValueError(
            f"{len(widths)} strips with cuts {cuts.tolist()}; give ascending cuts, one more than widths, and widths > 0"
        )
    lo, hi = polygon[:, 0].min(), polygon[:, 0].max()
    keep = (cuts[1:] > lo) & (cuts[:-1] < hi)
    if not keep.any():
        raise ValueError(
            f"strips from {cuts[0]:g} to {cuts[-1]:g} m miss the block from {lo:g} to {hi:g} m; "
            "cuts are places along the block's axis"
        )
    first, last = int(np.argmax(keep)), len(keep) - int(np.argmax(keep[::-1]))
    cuts, widths = cuts[first : last + 1].copy(), widths[first:last].copy()
    cuts[0], cuts[-1] = lo, hi
    return cuts, widths


def _long_axis(polygon: Array) -> tuple[float, bool]:
    """Direction of the outline's longer principal axis [rad], and whether it is clearly the longer one."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    length = np.hypot(*edge.T)
    middle = polygon + edge / 2
    middle = middle - (length @ middle) / length.sum()
    tensor = (middle * length[:, None]).T @ middle + (edge * length[:, None]).T @ edge / 12
    values, vectors = np.linalg.eigh(tensor)
    return atan2(float(vectors[1, 1]), float(vectors[0, 1])), bool(values[1] > 1.44 * values[0])
