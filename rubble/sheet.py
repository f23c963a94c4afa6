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

from dataclasses import dataclass

import numpy as np
import pymunk

from rubble.arrays import Array, Record, filled, record, rows
from rubble.compiled import compiled
from rubble.contacts import NODE
from rubble.handlers import SHEET
from rubble.physics import RubblePhysics

ICE_SHEET, STRUCTURE_CATEGORY = 0b10, 0b100  #: collision categories; the lattice does the contact between these two


#: where the lattice has the edge, x, z [m], and how it moves [m/s]; stiffness of its spring [N/m]; force that the
#: driver's motion already answers to [N]
DRIVER = record("x", "z", "v_x", "v_z", "k_x", "k_z", "applied_x", "applied_z")


@dataclass(frozen=True)
class SheetMotion:
    """The sheet in one section in a window: its nodes, front first, and how they move and yield."""

    x: Array  #: (m,) of the nodes at the start, decreasing [m]
    z: Array  #: (m,) middle of the thickness [m]
    front: float  #: x of the sheet's foremost point [m]
    velocity: Array  #: (m, 2) of the nodes in x and z, mean over the window [m/s]
    thickness: float  #: [m]
    stiffness: tuple[float, float]  #: of the edge in x and z [N/m]
    inertia: tuple[float, float]  #: mass that moves with the edge in x and z [kg]
    applied: tuple[float, float] = (0.0, 0.0)  #: F_a above, x and z [N]

    def __post_init__(self) -> None:
        for name in ("x", "z"):
            object.__setattr__(self, name, np.array(getattr(self, name), dtype=np.float64).reshape(-1))
        x, m = self.x, len(self.x)
        if m == 0 or m != len(self.z) or (np.diff(x) >= 0).any() or self.front < x[0]:
            raise ValueError(f"sheet: node x must decrease, front {self.front:g} lie ahead; got {x}")
        object.__setattr__(self, "velocity", np.array(self.velocity, dtype=np.float64).reshape(m, 2))
        k, inertia = np.array(self.stiffness), np.array(self.inertia)
        if not (np.isfinite([k, inertia]).all() and (k > 0).all() and (inertia > 0).all()):
            raise ValueError(f"sheet stiffness is {k} N/m, inertia {inertia} kg; all must be > 0 and finite")


@compiled(nogil=True)
def spring_force(driver: Record, dt: float, state: Record) -> tuple[float, float]:
    """Force on the sheet body, x and z [N], and one step of its driver."""
    wx, wz = state.v_x - driver.v_x, state.v_z - driver.v_z
    ux, uz = state.x - driver.x + dt * wx, state.z - driver.z + dt * wz
    fx = -driver.k_x * (ux + dt * wx) - driver.applied_x
    fz = -driver.k_z * (uz + dt * wz) - driver.applied_z
    driver.x += dt * driver.v_x
    driver.z += dt * driver.v_z
    return fx, fz


class SheetBody:
    """Sheet edge of one section: its body, its shapes, its driver and the nodes to which forces return."""

    def __init__(self, space: pymunk.Space, physics: RubblePhysics, motion: SheetMotion) -> None:
        self.space, self.physics = space, physics
        self.body = pymunk.Body(1.0, float("inf"))
        self.body.position = float(motion.x[0]), float(motion.z[0])
        self.body.velocity = tuple(motion.velocity[0].tolist())
        self.driver = np.zeros(1, DRIVER)
        self.nodes = np.zeros(len(motion.x), NODE)
        self.shapes: list[pymunk.Poly] = []
        self._corners = np.zeros((0, 4, 2))
        space.add(self.body)

    @property
    def impulse(self) -> Array:
        """(m, 2) on the nodes over the window, x and z; a view [N s]."""
        return rows(self.nodes, "impulse_x", 2)

    def follow(self, motion: SheetMotion) -> None:
        """Take over the lattice's motion in a window, from its start.

        The edge moves with those nodes that met rubble in the last window, weighted with the force; without contact,
        with the foremost one.
        """
        x, z = motion.x, motion.z
        force = np.abs(self.impulse).sum(axis=1)
        total = float(force.sum())
        v = force @ motion.velocity / total if len(force) == len(x) and total > 0.0 else motion.velocity[0]
        self.body.position, self.body.velocity = (float(x[0]), float(z[0])), (float(v[0]), float(v[1]))
        k, applied = self._yielding(motion), motion.applied
        self.driver = filled(DRIVER, [x[0], z[0], v[0], v[1], *k, *applied])
        self.nodes = filled(NODE, np.column_stack([x, z, np.zeros((len(x), 2))]))
        corners = sheet_polygons(x, z, motion.front, motion.thickness, self.physics.slop / 2)
        self._set_shapes(corners - np.array([x[0], z[0]]))
        self.space.reindex_shapes_for_body(self.body)

    def _yielding(self, motion: SheetMotion) -> Array:
        """Stiffness in x and z that a sub-step resolves (2,) [N/m]; sets the mass of the body, see above."""
        k, m = np.array(motion.stiffness, dtype=np.float64), np.array(motion.inertia, dtype=np.float64)
        dt2 = self.physics.substep**2
        mass = float((m + k * dt2).min())
        self.body.mass = mass
        return np.minimum(k, mass / dt2)

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
    pieces: Array = _pieces(points, thickness / 2, tolerance)
    return pieces


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
            at, above = (end if c in (0, 3) else start), (-half if c < 2 else half)
            out[count, c, 0], out[count, c, 1] = line[at, 0], line[at, 1] + above
        count, start = count + 1, end
    return out[:count].copy()
