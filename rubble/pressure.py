"""The wet part of a piece, edge by edge, and what still water does there.

A piece is a prism: an outline in the x-z plane of its plate whose width along y is piecewise constant in strips along
x. It is stored as its **edges**, each with a width: the outline, split at the strips, and the steps between strips,
whose width is the difference of the two. A point (x, z) of the piece stands at the height z_0 + s x + c z, with c, s
the rise of the plate's axes. Sums over the wet edges, seen from a point on the waterline, are the displaced volume and
its moments (Green's theorem; what closes the outline along the waterline adds nothing).
"""

from __future__ import annotations

from typing import NamedTuple

from rubble.arrays import Record, record
from rubble.compiled import compiled

#: an edge from (x0, z0) to (x1, z1) in the plate's axes [m], its width [m], 1 for an edge of the top, and its
#: unit direction (t_x, t_z); water lies to the right of it
EDGE = record("x0", "z0", "x1", "z1", "width", "top", "t_x", "t_z")

#: in thicknesses; a waterline farther away than any piece is long: the piece is under water as a whole, or out of it
FAR = 1e3 / 3.0


class Wet(NamedTuple):
    """The wet part of an edge."""

    ax: float  #: its ends; both the same if nothing is wet [m]
    az: float
    bx: float
    bz: float
    length: float  #: [m]
    x: float  #: its middle [m]
    z: float
    depth: float  #: of its middle under still water [m]
    tilt: float  #: a twelfth of what the depth grows by from its first end to its last [m]


@compiled(nogil=True, inline="always")
def wet_part(edge: Record, z: float, s: float, c: float) -> Wet:
    """The part of an edge below still water."""
    ax, az, bx, bz = edge.x0, edge.z0, edge.x1, edge.z1
    da, db = z + s * ax + c * az, z + s * bx + c * bz
    if da >= 0.0 and db >= 0.0:
        return Wet(ax=ax, az=az, bx=ax, bz=az, length=0.0, x=ax, z=az, depth=0.0, tilt=0.0)
    if da > 0.0:
        f = da / (da - db)
        ax, az, da = ax + f * (bx - ax), az + f * (bz - az), 0.0
    elif db > 0.0:
        f = da / (da - db)
        bx, bz, db = ax + f * (bx - ax), az + f * (bz - az), 0.0
    length = (bx - ax) * edge.t_x + (bz - az) * edge.t_z
    x, z, depth = 0.5 * (ax + bx), 0.5 * (az + bz), -0.5 * (da + db)
    return Wet(ax=ax, az=az, bx=bx, bz=bz, length=length, x=x, z=z, depth=depth, tilt=(da - db) / 12.0)


@compiled(nogil=True, inline="always")
def on_waterline(z: float, s: float, c: float, far: float) -> tuple[float, float]:
    """The point of the waterline nearest to the origin of a piece; the origin if that is farther than ``far`` [m]."""
    rise = s * s + c * c
    if rise == 0.0 or z * z > far * far * rise:
        return 0.0, 0.0
    return -z * s / rise, -z * c / rise
