"""What the sheet's edge meets: the law that engines ask, and the points at which it acts."""

from __future__ import annotations

from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np

from lattice.grid import Array, IntArray
from lattice.state import State


class Lever(NamedTuple):
    """Where points of action are, seen from their nodes; constant within a window."""

    height: Array  #: above the middle of the sheet, (m,) [m]
    lead: Array  #: ahead of the node along x, (m,) [m]

    @property
    def none(self) -> bool:
        """The points are the nodes."""
        return not (self.height.any() or self.lead.any())


class EdgeContact(Protocol):
    """Contact law of edge nodes with something outside the lattice."""

    @property
    def nodes(self) -> IntArray:
        """Nodes that may touch, (m,)."""

    @property
    def height(self) -> Array:
        """Height of the points of action above the middle of the sheet, constant within a window, (m,) [m]."""

    @property
    def lead(self) -> Array:
        """How far these points are ahead of their nodes along x, constant likewise, (m,) [m]."""

    def evaluate(self, t: float, y: Array) -> tuple[Array, Array]:
        """Force at the point of action of each node and its derivative.

        ``y`` (m, 3) is the `point_displacement` [m]; returns the force (m, 3) [N] and the tangent (m, 3, 3) [N/m].
        """


class Faces(NamedTuple):
    """Points at which nodes press with what closes, linear in the displacement of their points of action.

    A pressure of ``stiffness`` times the overlap beyond ``crushed``, up to ``strength``, acts on an area that grows
    with the overlap up to ``whole``.
    """

    overlap: Array  #: (m, s) now, negative where the face is apart [m]
    crushed: Array  #: (m, s) [m]
    grows: Array  #: (m, s, 3) overlap by displacement [-]
    whole: Array  #: (m, s) overlap from which on the area is that of all of the ice [m]
    way: Array  #: (m, s, 3) force by pressure and overlap [m]
    stiffness: float  #: [Pa/m]
    strength: float  #: [Pa]


def no_faces(m: int) -> Faces:
    """Of m nodes, no point."""
    none, way = np.zeros((m, 0)), np.zeros((m, 0, 3))
    return Faces(none, none, way, none, way, 0.0, 0.0)


@runtime_checkable
class PressingContact(Protocol):
    """An `EdgeContact` that tells of its faces: whether they close within a sub-step does not show in a tangent."""

    def faces(self, t: float, y: Array) -> tuple[Array, Array, Array, Array, Array, float, float]:
        """Its points at time t about displacements y (m, 3) of the points of action, as `Faces` has them."""


class NoContact:
    """An edge that touches nothing."""

    nodes: IntArray = np.empty(0, np.int64)
    height: Array = np.empty(0)
    lead: Array = np.empty(0)

    def evaluate(self, t: float, y: Array) -> tuple[Array, Array]:  # noqa: ARG002  the protocol's arguments
        """No force, whatever the displacement."""
        return np.empty((0, 3)), np.empty((0, 3, 3))


def lever_of(contact: EdgeContact) -> Lever:
    """Where the points of action of a contact are now."""
    return Lever(contact.height, contact.lead)


def point_displacement(u: Array, q: Array, nodes: IntArray, lever: Lever) -> Array:
    """u_x + z phi_x, u_y + z phi_y, w - x phi_x of points at height z above and x ahead of nodes, (m, 3).

    Likewise for velocities. w grows along x with -phi_x. A force F at such a point does work on these, so it acts on
    the node as F with the moments z F_x - x F_z on phi_x and z F_y on phi_y.
    """
    y = np.column_stack((u[nodes], q[nodes, 0]))
    y[:, :2] += lever.height[:, None] * q[nodes, 1:]
    if lever.lead.any():
        y[:, 2] -= lever.lead * q[nodes, 1]
    return y


def edge_displacement(state: State, nodes: IntArray, lever: Lever) -> Array:
    """Displacement of the points of edge nodes, as an `EdgeContact` takes them, (m, 3) [m]."""
    return point_displacement(state.u, state.q, nodes, lever)
