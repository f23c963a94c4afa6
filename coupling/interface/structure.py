"""What a structure has to give, so that sheet and rubble can meet it: its cut, its normal, and the overlap of ice.

A structure is any surface whose front, the side from which the ice comes, is met once by a line along x: in the plane y
at height z it stands at `face_x`, with the outward normal n, n_x < 0. Solid is behind it. Nothing here knows time: this
is the structure where it rests, and one that moves is met in its own frame (`coupling.structure.moved`).

Sections of rubble see the plane cut (`section`) and press in the plane. The third dimension comes back by the ratio
n_y / n_x of the face (`bearing`): ice presses along -n, so a force Fx carries Fy = Fx n_y / n_x.
"""

from __future__ import annotations

from typing import Protocol

from numpy.typing import ArrayLike

from coupling.interface.units import Array, IntArray


class Structure(Protocol):
    """A surface that ice runs against; `coupling.structure` has some. All lengths in m, z = 0 still water."""

    @property
    def bottom(self) -> float:
        """Lowest point."""
        ...

    @property
    def top(self) -> float:
        """Highest point."""
        ...

    @property
    def faces_down(self) -> bool:
        """Whether the face at the waterline bends ice downwards (it meets the upper edge); the other way it lifts."""
        ...

    @property
    def half_width(self) -> float:
        """Greatest distance of its waterline from the plane y = 0; infinite for a slope that does not end."""
        ...

    @property
    def reach(self) -> float:
        """The x of its greatest width, or of its crest: ice behind has passed the structure."""
        ...

    def foremost_x(self, z: float) -> float:
        """Least x of the face at height z, in whichever plane y: where a straight edge of ice touches first."""
        ...

    def face_x(self, y: ArrayLike, z: ArrayLike) -> Array:
        """Place along x of the front face; nan where the line along x misses the structure. y and z broadcast."""
        ...

    def normal(self, y: ArrayLike, z: ArrayLike) -> Array:
        """Outward unit normal of the front face, (..., 3); nan where there is no face."""
        ...

    def normal_z(self, z: Array) -> Array:
        """n_z of the face at heights z, beyond its ends that of the end.

        One number for all y: a face whose steepness changes along y gives that in its middle. It parts the loss of the
        contact into friction and crushing; forces do not depend on it.
        """
        ...

    def overlap(self, x: Array, y: Array, z: Array) -> tuple[Array, Array]:
        """How far ice at x (m,) reaches behind the face at y (m, k) and z (m,): (m, k), and normals there (m, k, 3).

        Where there is no face: 0, and the normal (-1, 0, 0) of a wall, so that nobody divides by zero. Called for every
        trial of the contact's iteration: it should be quick.
        """
        ...

    def section(self, y: float, z_lo: float, z_hi: float, tolerance: float) -> tuple[Array, Array]:
        """Front and rear of the cut by the plane y between two heights: lines (n, 2), (m, 2) of (x, z), z ascending.

        No chord lies farther from the surface than ``tolerance``. (0, 2) both if the plane misses. Between two corners
        at which the front turns inwards the cut is convex.
        """
        ...

    def generator(self, z_lo: float, z_hi: float) -> Array | None:
        """Heights, ascending, and radii (k, 2) between two heights of a body of revolution; None: it is none [m]."""
        ...

    def bearing(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> tuple[Array, Array]:
        """(a, b) with n_y / n_x = a + b y / x of the face at points on it, front or rear.

        (0, 0) for a plane across the drift, (0, 1) where n points away from the z axis, (tan psi, 0) for a flat face of
        which n makes the angle psi with the x axis in the plan. The two hold near the point, for blocks that stand at
        another y.
        """
        ...

    def mesh(self, width: float) -> tuple[Array, IntArray]:
        """The surface to look at: points (p, 3) and triangles (t, 3). What does not end is drawn ``width`` wide."""
        ...
