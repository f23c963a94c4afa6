"""Forces on single nodes as the compiled loops take them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.contact import EdgeContact, Faces, PressingContact, no_faces
from lattice.explicit.layout import W
from lattice.grid import Array, IntArray
from lattice.loads import NodeLoad


class PointForces(NamedTuple):
    """Constant forces on nodes, load after load."""

    row: IntArray  #: (k,)
    column: IntArray  #: (k,)
    force: Array  #: (k, 5) [N], [N m]
    first: IntArray  #: (loads + 1,) where each load begins; the last entry is k


class Touch(NamedTuple):
    """A contact that is linear in the displacement of its points."""

    row: IntArray  #: (m,)
    column: IntArray  #: (m,)
    height: Array  #: (m,) of the points above the middle of the sheet [m]
    lead: Array  #: (m,) of the points ahead of their nodes [m]
    at: Array  #: (m, 3) displacement of the points at which ``force`` holds [m]
    force: Array  #: (m, 3) [N]
    tangent: Array  #: (m, 3, 3) [N/m]
    faces: Faces  #: where there are any, the march goes by these

    def at_once(self) -> PointForces:
        """The force for the displacement ``at``, with its moments about the middle."""
        force = np.hstack((self.force, self.height[:, None] * self.force[:, :2]))
        if self.lead.any():
            force[:, 3] -= self.lead * self.force[:, 2]
        return PointForces(self.row, self.column, force, np.array([0, len(force)]))


class Sums(NamedTuple):
    """What a run of sub-steps adds up, and room for it."""

    now: Array  #: (m, 5) contact in the present sub-step [N], [N m]
    contact: Array  #: (m, 3) sum of the contact over the sub-steps [N]
    work: Array  #: (loads,) sum of the power of each load [W]


class Made(NamedTuple):
    """What the compiled loop gives back beside its `Sums`."""

    steps: int
    overloaded: int  #: faces of cells at or past their limit at the end of the last one
    contact_work: float  #: sum of the power of the contact [W]
    loss: float  #: work of damping in the sub-steps that were looked at [J]
    hold: float  #: sum of the force along x that held nodes take from all cells [N]


@dataclass(frozen=True)
class Marched:
    """Some sub-steps."""

    steps: int
    failed: bool  #: a cell is overloaded at the end of the last one
    contact: Array  #: mean force on the nodes of the contact, (m, 3) [N]
    contact_work: float  #: [J]
    work: Array  #: (loads,) of the other forces [J]
    loss: float  #: taken by hydrodynamic and material damping [J]
    hold: float  #: mean force along x that held nodes take from all cells [N]


NOTHING = PointForces(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros((0, 5)), np.zeros(1, np.int64))


def indenter(nodes: IntArray, columns: int, stiffness: Array | float) -> Touch:
    """Vertical springs of this stiffness, (m,) or all alike [N/m], on nodes (m,); their far ends are ``at``, now 0."""
    m, tangent = len(nodes), np.zeros((len(nodes), 3, 3))
    tangent[:, W, W] = -stiffness
    none = np.zeros(m), np.zeros(m), np.zeros((m, 3)), np.zeros((m, 3))
    return Touch(*np.divmod(nodes, columns), *none, tangent, no_faces(m))


Pressed = tuple[IntArray, Array]  #: nodes on which some force of a load is not zero (k,), and what acts on them (k, 5)


def point_forces(parts: Sequence[Pressed], columns: int) -> PointForces:
    """The forces of loads; ``columns`` nodes across."""
    if not parts:
        return NOTHING
    nodes, force = (np.concatenate(p) for p in zip(*parts, strict=True))
    return PointForces(*np.divmod(nodes, columns), force, np.cumsum([0, *(len(n) for n, _ in parts)]))


def pressed(load: NodeLoad) -> Pressed:
    """Where a load presses."""
    found: Pressed = _pressed(np.ascontiguousarray(load.force_u), np.ascontiguousarray(load.force_q))
    return found


@compiled(nogil=True)
def _pressed(force_u: Array, force_q: Array) -> Pressed:
    nodes, count = np.empty(force_u.shape[0], np.int64), 0
    for n in range(force_u.shape[0]):
        some = force_q[n, 2] != 0.0
        for c in range(2):
            some = some or force_u[n, c] != 0.0 or force_q[n, c] != 0.0
        if some:
            nodes[count] = n
            count += 1
    force = np.empty((count, 5))
    for k in range(count):
        force[k, :2], force[k, 2:] = force_u[nodes[k]], force_q[nodes[k]]
    return nodes[:count].copy(), force


def touch_at(t: float, contact: EdgeContact, at: Array, columns: int) -> Touch:
    """Force and tangent of a contact at time t for displacements ``at`` (m, 3) of its points [m]."""
    at = np.ascontiguousarray(at)
    force, tangent = contact.evaluate(t, at)
    faces = Faces(*contact.faces(t, at)) if isinstance(contact, PressingContact) else no_faces(len(at))
    return Touch(
        *np.divmod(contact.nodes, columns),
        np.ascontiguousarray(contact.height),
        np.ascontiguousarray(contact.lead),
        at,
        np.ascontiguousarray(force),
        np.ascontiguousarray(tangent),
        faces,
    )
