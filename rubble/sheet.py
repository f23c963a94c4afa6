"""The sheet as the rubble of one section meets it: a body on springs, because real sheets yield.

A kinematic sheet would jam blocks against the structure with unlimited force. Here the sheet's edge is a body of mass
``M`` without rotation, tied by a spring-damper in x and in z to a driver that moves with the lattice. A block caught
between it and the structure is pressed with k times the yield of the edge, no more; what limits the force further
(crushing, failure) happens in the lattice, which receives the contact forces.

Spring and damper act implicitly (backward Euler). With u the offset from the driver, w its rate and J the contact
impulse, ``(m + c dt + k dt^2) (w' - w) = dt [-k (u + dt w) - c w - F_a] + J``: the solver's mass is
``M = m + c dt + k dt^2``, the bracket is an ordinary force, and every stiffness is stable. Damping is critical,
c = 2 sqrt(k m), which gives ``sqrt(M) = sqrt(m) + dt sqrt(k)``. M is one number: the stiffer direction has the mass m
that was asked for, the softer one a somewhat larger m, ``sqrt(m_i) = sqrt(M) - dt sqrt(k_i)``.

``F_a`` is the rubble's force that the lattice already carries in the position handed over. With it the spring answers
only to the change since, and compliance is not counted twice; without it (0) the edge yields by F / k on top.
Between windows the driver jumps to where the lattice is, the body stays where it was: no contact is torn or pressed
by a jump, and the spring keeps the body from drifting away.
"""

from __future__ import annotations

import numpy as np
import pymunk
from numba import njit

from rubble.geometry import Array, contiguous
from rubble.physics import RubblePhysics

ICE_SHEET, STRUCTURE_CATEGORY = 0b10, 0b100  #: collision categories; the lattice does the contact between these two


@njit("void(float64[::1], float64, float64[::1], float64[::1], float64[::1])", cache=True, nogil=True)
def spring_force(spring: Array, dt: float, driver: Array, state: Array, force: Array) -> None:
    """Force on the sheet body, and one step of its driver.

    spring = (k_x, k_z, c_x, c_z, F_ax, F_az); driver = (x, z, v_x, v_z), moved by dt; state as in `water`.
    """
    for i in range(2):
        w = state[3 + i] - driver[2 + i]
        u = state[i] - driver[i] + dt * w
        force[i] = -spring[i] * (u + dt * w) - spring[2 + i] * w - spring[4 + i]
        driver[i] += dt * driver[2 + i]
    force[2] = 0.0


class SheetBody:
    """Sheet edge of one section: its body, its shapes, its driver and the nodes to which forces return."""

    def __init__(self, space: pymunk.Space, physics: RubblePhysics, x: Array, z: Array, velocity: Array) -> None:
        self.space, self.physics = space, physics
        self.body = pymunk.Body(1.0, float("inf"))
        self.body.position = float(x[0]), float(z[0])
        self.body.velocity = tuple(velocity.mean(axis=0).tolist())
        self.driver = np.array([x[0], z[0], 0.0, 0.0])
        self.spring = np.zeros(6)
        self.nodes = np.zeros((len(x), 4))
        self.shapes: list[pymunk.Poly] = []
        space.add(self.body)

    def follow(self, x: Array, z: Array, front: float, velocity: Array, thickness: float,
               stiffness: tuple[float, float], applied: tuple[float, float]) -> None:
        """Take over the lattice's position for a window. The driver jumps to it, the body follows on its spring."""
        self.driver[:] = x[0], z[0], *velocity.mean(axis=0)
        self._set_spring(np.array(stiffness, dtype=np.float64), applied)
        self.nodes = np.column_stack([x, z, np.zeros((len(x), 2))])
        self._set_shapes(sheet_polygons(x, z, front, thickness, self.physics.slop / 2))

    def _set_spring(self, k: Array, applied: tuple[float, float]) -> None:
        if not (np.isfinite(k).all() and (k > 0).all()):
            raise ValueError(f"sheet stiffness is {k} N/m; both values must be > 0 and finite")
        dt = self.physics.substep
        root = np.sqrt(self.physics.sheet_mass) + dt * np.sqrt(k.max())
        self.body.mass = float(root**2)
        self.spring[:2], self.spring[2:4] = k, 2 * np.sqrt(k) * (root - dt * np.sqrt(k))
        self.spring[4:] = applied

    def _set_shapes(self, polygons: list[Array]) -> None:
        """New corners for the old shapes if their number is the same: contacts keep their history."""
        local = [[(float(a - self.driver[0]), float(b - self.driver[1])) for a, b in p] for p in polygons]
        if len(local) == len(self.shapes):
            for shape, corners in zip(self.shapes, local, strict=True):
                shape.unsafe_set_vertices(corners)
            self.space.reindex_shapes_for_body(self.body)
            return
        self.space.remove(*self.shapes)
        self.shapes = [pymunk.Poly(self.body, corners) for corners in local]
        for shape in self.shapes:
            shape.friction = self.physics.mu_ice_ice**0.5
            shape.elasticity = self.physics.restitution**0.5
            shape.filter = pymunk.ShapeFilter(categories=ICE_SHEET,
                                              mask=pymunk.ShapeFilter.ALL_MASKS() ^ STRUCTURE_CATEGORY)
        self.space.add(*self.shapes)

    def remove(self) -> None:
        """Take the sheet out of the section."""
        self.space.remove(*self.shapes, self.body)


def sheet_polygons(x: Array, z: Array, front: float, thickness: float, tolerance: float) -> list[Array]:
    """Convex polygons of the sheet: its nodes joined by straight pieces, as long as they stay within ``tolerance``.

    Few long pieces, because a block that slides along the underside catches on the joints. Ahead of the first node
    the sheet goes on straight to ``front``.
    """
    line = _middle_line(x, z, front)
    polygons, start = [], 0
    while start < len(line) - 1:
        end = start + 1
        while end + 1 < len(line) and _straight(line[start:end + 2], tolerance):
            end += 1
        a, b = line[start], line[end]
        half = np.array([0.0, thickness / 2])
        polygons.append(contiguous([b - half, a - half, a + half, b + half]))
        start = end
    return polygons


def _middle_line(x: Array, z: Array, front: float) -> Array:
    """Points of the mid-plane from the front backwards; a single node has half a cell on both sides."""
    points = [(float(a), float(b)) for a, b in zip(x, z, strict=True)]
    slope = (points[0][1] - points[1][1]) / (points[0][0] - points[1][0]) if len(points) > 1 else 0.0
    ahead = front - points[0][0]
    if len(points) == 1:
        points.append((points[0][0] - max(ahead, 1e-3), points[0][1]))
    if ahead > 1e-9:
        points[0] = (front, points[0][1] + slope * ahead)
    return np.array(points)


def _straight(line: Array, tolerance: float) -> bool:
    s = (line[:, 0] - line[0, 0]) / (line[-1, 0] - line[0, 0])
    return bool(np.abs(line[:, 1] - line[0, 1] - s * (line[-1, 1] - line[0, 1])).max() <= tolerance)
