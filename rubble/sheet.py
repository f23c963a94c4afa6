"""The sheet as the rubble of one section meets it: a body on springs, because real sheets yield.

A kinematic sheet would jam blocks against the structure with unlimited force. Here the sheet's edge is a body
without rotation, tied by a spring in x and in z to a driver that moves as the lattice predicts. A block caught between
it and the structure is pressed with what it takes to move this oscillator, no more; what limits the force further
(crushing, failure) happens in the lattice, which receives the contact forces.

The spring acts implicitly (backward Euler). With u the offset from the driver, w its rate and J the contact impulse,
``(m + k dt^2) (w' - w) = dt [-k (u + dt w) - F_a] + J``: the solver's mass is ``M = m + k dt^2``, the bracket is an
ordinary force, and every stiffness is stable. M is one number for both directions: that of the lighter one; the other
moves with a smaller m, and if that is not enough with ``k = M / dt^2``, as much as a sub-step resolves.

``F_a`` is the rubble's force that the driver's motion already answers to: the spring answers only to the change since.
At the start of a window the edge stands where the lattice has it, and moves with it.
"""

from __future__ import annotations

import numpy as np
import pymunk

from rubble.compiled import compiled
from rubble.friction import SHEET
from rubble.geometry import Array
from rubble.physics import RubblePhysics

ICE_SHEET, STRUCTURE_CATEGORY = 0b10, 0b100  #: collision categories; the lattice does the contact between these two


@compiled("void(float64[::1], float64, float64[::1], float64[::1], float64[::1])", nogil=True)
def spring_force(spring: Array, dt: float, driver: Array, state: Array, force: Array) -> None:
    """Force on the sheet body, and one step of its driver.

    spring = (k_x, k_z, F_ax, F_az); driver = (x, z, v_x, v_z), moved by dt; state as in `water`.
    """
    for i in range(2):
        w = state[3 + i] - driver[2 + i]
        u = state[i] - driver[i] + dt * w
        force[i] = -spring[i] * (u + dt * w) - spring[2 + i]
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
        self.spring = np.zeros(4)
        self.nodes = np.zeros((len(x), 4))
        self.shapes: list[pymunk.Poly] = []
        self._corners = np.zeros((0, 4, 2))
        space.add(self.body)

    def follow(
        self,
        x: Array,
        z: Array,
        front: float,
        velocity: Array,
        thickness: float,
        stiffness: tuple[float, float],
        inertia: tuple[float, float],
        applied: tuple[float, float],
    ) -> None:
        """Take over the lattice's motion in a window, from its start.

        The edge moves with those nodes that met rubble in the last window, weighted with the force; without contact,
        with the foremost one.
        """
        force = np.abs(self.nodes[:, 2:]).sum(axis=1)
        total = float(force.sum())
        v = force @ velocity / total if len(force) == len(x) and total > 0.0 else velocity[0]
        self.driver[:] = x[0], z[0], v[0], v[1]
        self.body.position, self.body.velocity = (float(x[0]), float(z[0])), (float(v[0]), float(v[1]))
        self._set_spring(np.array(stiffness, dtype=np.float64), np.array(inertia, dtype=np.float64), applied)
        self.nodes = np.column_stack([x, z, np.zeros((len(x), 2))])
        self._set_shapes(sheet_polygons(x, z, front, thickness, self.physics.slop / 2) - self.driver[:2])
        self.space.reindex_shapes_for_body(self.body)

    def _set_spring(self, k: Array, m: Array, applied: tuple[float, float]) -> None:
        if not (np.isfinite([k, m]).all() and (k > 0).all() and (m > 0).all()):
            raise ValueError(f"sheet stiffness is {k} N/m, inertia {m} kg; all must be > 0 and finite")
        dt2 = self.physics.substep**2
        mass = float((m + k * dt2).min())
        self.body.mass = mass
        self.spring[:2], self.spring[2:] = np.minimum(k, mass / dt2), applied

    def _set_shapes(self, local: Array) -> None:
        """New corners (polygons, 4, 2) for the old shapes if their number is the same: contacts keep their history."""
        if local.shape == self._corners.shape:
            if np.abs(local - self._corners).max() < 1e-9:
                return  # it has only drifted
            for shape, corners in zip(self.shapes, local.tolist(), strict=True):
                shape.unsafe_set_vertices(corners)
        else:
            self._replace_shapes(local)
        self._corners = local

    def _replace_shapes(self, local: Array) -> None:
        self.space.remove(*self.shapes)
        self.shapes = [pymunk.Poly(self.body, corners) for corners in local.tolist()]
        for shape in self.shapes:
            shape.elasticity, shape.collision_type = self.physics.restitution**0.5, SHEET
            shape.filter = pymunk.ShapeFilter(
                categories=ICE_SHEET, mask=pymunk.ShapeFilter.ALL_MASKS() ^ STRUCTURE_CATEGORY
            )
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


@compiled("float64[:, :, ::1](float64[:, ::1], float64, float64)", nogil=True)
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
