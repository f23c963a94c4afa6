"""The structure as one section meets it: convex polygons in the plane, and which way their faces look out of it.

A section knows only the plane y. The outward unit normal of a face at a point (x, y, z) obeys

    n_y / n_x = constant + radial * y / x

with two numbers per face: (0, 1) on a body of revolution, whose normals pass through its axis; (0, 0) on a slope
without end; (tan psi, 0) on a plane facet whose horizontal bearing is psi from the x axis, as of a multi-sided cone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, Record, Records, filled, record
from rubble.compiled import compiled
from rubble.geometry import contiguous, holds

#: an outer edge of the structure from (x0, z0) to (x1, z1) [m], solid to its left; ``constant``, ``radial`` as above
FACE = record("x0", "z0", "x1", "z1", "constant", "radial")


class Bearing(NamedTuple):
    """Which way a face looks out of the plane, see above."""

    constant: float
    radial: float


IN_PLANE, RADIAL = Bearing(0.0, 0.0), Bearing(0.0, 1.0)


@dataclass(frozen=True)
class Cut:
    """The structure in one section."""

    polygons: tuple[Array, ...]  #: (k, 2) each, convex, counter-clockwise, not overlapping [m]
    faces: Records  #: (e,) FACE, the outer edges

    @property
    def slopes(self) -> Records:
        """The faces that meet the drift: their outward normal points against it, n_x < -0.1.

        A block aligns with these. What is steeper than 84 degrees against the drift's own direction, as the top and
        the bottom of the solid, carries no block that the drift brings.
        """
        dx, dz = self.faces["x1"] - self.faces["x0"], self.faces["z1"] - self.faces["z0"]
        meeting: Records = self.faces[dz < -0.1 * np.hypot(dx, dz)]
        return meeting

    @property
    def bearings(self) -> Records:
        """The faces among which a contact looks for its bearing: one is enough where all have the same."""
        kinds = {(float(f["constant"]), float(f["radial"])) for f in self.faces}
        return self.faces if len(kinds) > 1 else filled(FACE, [[0.0] * 4 + list(kinds.pop() if kinds else IN_PLANE)])


Solids = Callable[[float], Cut]  #: the structure in the plane y


def faceted(polygons: Sequence[Array], bearing: Callable[[float, float], Bearing]) -> Cut:
    """A cut whose faces look where ``bearing(x, z)`` says, asked at the middle of each."""
    own = tuple(contiguous(p) for p in polygons)
    faces = []
    for i, solid in enumerate(own):
        for a, b in zip(solid, np.roll(solid, -1, axis=0), strict=True):
            middle = (a + b) / 2
            if not any(holds(other, middle) for j, other in enumerate(own) if j != i):
                faces.append([*a, *b, *bearing(float(middle[0]), float(middle[1]))])
    return Cut(own, filled(FACE, faces))


def plane(polygons: Sequence[Array]) -> Cut:
    """A cut of a body that goes on along y without end."""
    return faceted(polygons, lambda _x, _z: IN_PLANE)


def revolved(polygons: Sequence[Array]) -> Cut:
    """A cut of a body of revolution about the z axis."""
    return faceted(polygons, lambda _x, _z: RADIAL)


def open_water(_y: float) -> Cut:
    """No structure."""
    return plane(())


@compiled(nogil=True, borrows=True)
def distance_to(face: Record, x: float, z: float) -> float:
    """From a point to a face [m]."""
    ex, ez = face.x1 - face.x0, face.z1 - face.z0
    s = ((x - face.x0) * ex + (z - face.z0) * ez) / (ex * ex + ez * ez)
    s = min(1.0, max(0.0, s))
    distance: float = np.hypot(x - face.x0 - s * ex, z - face.z0 - s * ez)
    return distance


@compiled(nogil=True, borrows=True)
def nearest(faces: Records, x: float, z: float) -> int:
    """Number of the face nearest to a point; the first of equals."""
    best, least = 0, np.inf
    for e in range(faces.shape[0] if faces.shape[0] > 1 else 0):
        d = distance_to(faces[e], x, z)
        if d < least:
            best, least = e, d
    return best
