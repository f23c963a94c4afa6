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

from rubble.friction import SHEET
from rubble.geometry import Array
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
        self.body.velocity = tuple(velocity[0].tolist())
        self.driver = np.array([x[0], z[0], 0.0, 0.0])
        self.spring = np.zeros(6)
        self.nodes = np.zeros((len(x), 4))
        self.shapes: list[pymunk.Poly] = []
        self._corners = np.zeros((0, 4, 2))
        space.add(self.body)

    def follow(self, x: Array, z: Array, front: float, velocity: Array, thickness: float,
               stiffness: tuple[float, float], applied: tuple[float, float]) -> None:
        """Take over the lattice's position for a window. The driver jumps to it, the body follows on its spring.

        Between two hand-overs the body moves with those nodes that met rubble in the last window, weighted with the
        force; without contact, with the foremost one.
        """
        force = np.abs(self.nodes[:, 2:]).sum(axis=1)
        total = float(force.sum())
        v = force @ velocity / total if len(force) == len(x) and total > 0.0 else velocity[0]
        self.driver[:] = x[0], z[0], v[0], v[1]
        self._set_spring(np.array(stiffness, dtype=np.float64), applied)
        self.nodes = np.column_stack([x, z, np.zeros((len(x), 2))])
        corners = sheet_polygons(x, z, front, thickness, self.physics.slop / 2)
        self._set_shapes(corners - self.driver[:2])

    def _set_spring(self, k: Array, applied: tuple[float, float]) -> None:
        if not (np.isfinite(k).all() and (k > 0).all()):
            raise ValueError(f"sheet stiffness is {k} N/m; both values must be > 0 and finite")
        dt = self.physics.substep
        root = np.sqrt(self.physics.sheet_mass) + dt * np.sqrt(k.max())
        self.body.mass = float(root**2)
        self.spring[:2], self.spring[2:4] = k, 2 * np.sqrt(k) * (root - dt * np.sqrt(k))
        self.spring[4:] = applied

    def _set_shapes(self, local: Array) -> None:
        """New corners (polygons, 4, 2) for the old shapes if their number is the same: contacts keep their history."""
        if local.shape == self._corners.shape:
            if np.abs(local - self._corners).max() < 1e-9:
                return  # it has only drifted
            for shape, corners in zip(self.shapes, local.tolist(), strict=True):
                shape.unsafe_set_vertices(corners)
            self.space.reindex_shapes_for_body(self.body)
        else:
            self._replace_shapes(local)
        self._corners = local

    def _replace_shapes(self, local: Array) -> None:
        self.space.remove(*self.shapes)
        self.shapes = [pymunk.Poly(self.body, corners) for corners in local.tolist()]
        for shape in self.shapes:
            shape.elasticity, shape.collision_type = self.physics.restitution**0.5, SHEET
            shape.filter = pymunk.ShapeFilter(categories=ICE_SHEET,
                                              mask=pymunk.ShapeFilter.ALL_MASKS() ^ STRUCTURE_CATEGORY)
        self.space.add(*self.shapes)

    def remove(self) -> None:
        """Take the sheet out of the section."""
        self.space.remove(*self.shapes, self.body)


def sheet_polygons(x: Array, z: Array, front: float, thickness: float, tolerance: float) -> Array:
    """Corners (p, 4, 2) of the sheet: its nodes joined by straight pieces, as long as they stay within ``tolerance``.

    Few long pieces, because a block that slides along the underside catches on the joints. Ahead of the first node
    the sheet goes on straight to ``front``.
    """
    points = np.column_stack([x, z])
    if len(x) == 1:  # half a cell on both sides
        points = np.array([points[0], points[0] - [max(front - x[0], 1e-3), 0.0]])
    if front - x[0] > 1e-9:
        slope = (points[0, 1] - points[1, 1]) / (points[0, 0] - points[1, 0])
        points[0] = front, points[0, 1] + slope * (front - x[0])
    return _pieces(points, thickness / 2, tolerance)


@njit("float64[:, :, ::1](float64[:, ::1], float64, float64)", cache=True, nogil=True)
def _pieces(line: Array, half: float, tolerance: float) -> Array:
    """The straight pieces of a line (n, 2) with x decreasing, as counter-clockwise quadrangles of thickness 2 half."""
    out = np.empty((line.shape[0] - 1, 4, 2))
    count = start = 0
    while start < line.shape[0] - 1:
        end, fits = start + 1, True
        while fits and end + 1 < line.shape[0]:
            slope = (line[end + 1, 1] - line[start, 1]) / (line[end + 1, 0] - line[start, 0])
            for k in range(start + 1, end + 1):
                off = line[k, 1] - line[start, 1] - slope * (line[k, 0] - line[start, 0])
                fits = fits and abs(off) <= tolerance
            if fits:
                end += 1
        for c in range(4):
            at, side = (end if c in (0, 3) else start), (-half if c < 2 else half)
            out[count, c, 0], out[count, c, 1] = line[at, 0], line[at, 1] + side
        count, start = count + 1, end
    return out[:count].copy()
