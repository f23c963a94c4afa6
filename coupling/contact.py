"""Contact of the sheet's edge with the structure (thesis 6.2, Figure 6-3).

The edge of the ice that touches first (the upper one at a downward-breaking structure) overlaps the face of the
structure by L, measured along the drift. The face then cuts the ice along the length L / cos(a), at most h / sin(a),
and the force is

    contact strength x contact length x width,  normal to the structure in three dimensions,

with friction mu along the slope against the ice that is pushed past it. The overlap is integrated over the width that
belongs to a node, at `SAMPLES` points: sampled at nodes alone, coarse meshes see too much of a round structure.

The thesis's force acts on the node, at middle thickness, and the overlap counts the deflection of the edge but not
its rotation. This reading reproduces the thesis: the 55 m floe splits at 3.18 MN and 19.8 s (thesis 3.2 MN). With the
rotation and with the moment of a force that acts at the upper edge it splits at 3.48 MN and 20.9 s.

Against a structure that moves the overlap is that in its frame, and friction acts against the motion of the ice
relative to it: of the drift and of the structure, as the deflection of the edge is left out against one that rests.

`crushing.CrushingContact` acts where it bears, and its overlap counts the way of that point, rotation included.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coupling.contact_friction import friction_at
from coupling.interface import Array, IntArray, Path, Structure
from coupling.structure import moved

#: points across the width of a node: on a cone of 15 m the mean overlap of nodes 1 m apart is within 1 % of the exact
#: one from L = 0.1 m on
SAMPLES = 8
#: friction turns round over this part of the speed along the slope: there is no sliding where it turns [-]
TURNS = 0.05


@dataclass(frozen=True)
class ContactLaw:
    """Parameters of the contact of ice and structure."""

    strength: float  #: contact parameter of the thesis (6.2), or strength of the ice in crushing [Pa]
    friction: float  #: ice on structure [-]
    stiffness: float = np.inf  #: pressure per closure of ice that is not crushing, E / d [Pa/m]


class OverlapContact:
    """The thesis's contact: the strength presses wherever the ice overlaps the structure.

    Displacements are relative to the drifting frame.
    """

    def __init__(
        self,
        structure: Structure,
        law: ContactLaw,
        velocity: float,
        thickness: float,
        freeboard: float,
        path: Path | None = None,
    ):
        """``velocity`` of the drift [m/s], ``thickness`` and ``freeboard`` of the floating sheet [m].

        ``path`` is that of a structure that moves.
        """
        self._s, self._law, self._v, self._h, self.path = structure, law, velocity, thickness, path
        self._t = 0.0  #: at which the contact was looked at last [s]
        #: +1 if the upper edge of the ice touches (downward-breaking structure), -1 if the lower one does
        self.face = 1.0 if structure.faces_down else -1.0
        self.touching_z = freeboard - 0.5 * thickness + self.face * 0.5 * thickness  #: of that edge afloat [m]
        self._dy = (np.arange(SAMPLES) + 0.5) / SAMPLES - 0.5
        self.set_edge(np.empty(0, np.int64), *np.zeros((3, 0)))

    def set_edge(self, nodes: IntArray, x: Array, y: Array, width: Array, lead: Array | None = None) -> None:
        """Nodes of the edge and, per node (m,) [m], the front of its ice at t = 0, its width, and how far it leads.

        ``y`` is the middle of the node's ice, which is not the node at the sides of the floe. The force acts at the
        front, ``lead`` (m,) ahead of the node (none in the floe's first row), and the overlap is that of the front.
        """
        self.nodes, self._x, self._width = nodes, x, width
        self.height = np.zeros(len(nodes))  #: of the points of action above the middle of the ice, (m,) [m]
        self.lead = np.zeros(len(nodes)) if lead is None else lead  #: of the front ahead of its node, (m,) [m]
        self._sample_y = y[:, None] + width[:, None] * self._dy

    def find(self, t: float, displacement: Callable[[], Array]) -> None:
        """Called where nodes have come into the front; ``displacement`` (m, 3) of the points of contact as they are."""

    def overlap(self, t: float, y: Array, ahead: float = 0.0) -> tuple[Array, Array]:
        """L at the sample points (m, SAMPLES) [m] and the outward normal of the structure there (m, SAMPLES, 3).

        Of ice that is ``ahead`` of where it is [m].
        """
        z = self.touching_z + y[:, 2]
        x = self._x + self._v * t + y[:, 0] + ahead
        across = self._sample_y + y[:, 1:2]
        if self.path is None:
            return self._s.overlap(x, across, z)
        self._t = t
        return moved.overlap(self._s, self.path.at(t), x, across, z)

    def evaluate(self, t: float, y: Array) -> tuple[Array, Array]:
        """Force on the ice (m, 3) [N] and tangent (m, 3, 3) [N/m] at displacements y (m, 3): an `EdgeContact`."""
        m = len(self.nodes)
        force, tangent = np.zeros((m, 3)), np.zeros((m, 3, 3))
        L, normal = self.overlap(t, y)
        on = np.flatnonzero(L.any(axis=1))
        if not len(on):
            return force, tangent
        L, normal = L[on], normal[on]
        sin, cos, growing, length = self._length(L, normal)
        pressure, stiffness = self.pressure(L, on)
        per_area = (self._width[on, None] / SAMPLES)[..., None] * self._direction(normal, sin, on)
        force[on] = (per_area * (pressure * length)[..., None]).sum(axis=1)
        slope = per_area * (stiffness * length + np.where(growing, pressure / np.maximum(cos, 1e-12), 0.0))[..., None]
        for k in range(3):  # dL/dy and dL/dw are -dx/dy and -dx/dz of the face
            tangent[on, :, k] = (slope * (normal[..., k] / normal[..., 0])[..., None]).sum(axis=1)
        return force, tangent

    def _length(self, L: Array, normal: Array) -> tuple[Array, Array, np.ndarray, Array]:
        """Sin a, cos a, where the contact is shorter than the face of the ice, and its length [m]; all as L."""
        sin, cos = np.sqrt(1.0 - normal[..., 2] ** 2), np.abs(normal[..., 2])
        whole = self._h / sin
        growing = (L > 0.0) & (whole * cos > L)
        return sin, cos, growing, np.where(growing, L / np.maximum(cos, 1e-12), np.where(L > 0.0, whole, 0.0))

    def pressure(self, L: Array, rows: IntArray) -> tuple[Array, Array]:  # noqa: ARG002 - other laws know their nodes
        """Pressure [Pa] at overlaps L (k, SAMPLES) of the nodes `rows`, and its derivative to L [Pa/m]."""
        return np.full(L.shape, self._law.strength), np.zeros(L.shape)

    def close_window(self, t: float, displacement: Callable[[], Array]) -> Array:
        """Called at the end of a window: depth to which the touching edge is crushed, (m, SAMPLES) [m]."""
        return self.overlap(t, displacement())[0]

    def _direction(self, normal: Array, sin: Array, rows: IntArray) -> Array:
        """Normal plus friction, (k, SAMPLES, 3): the ice slides the way it is pushed, friction holds it back."""
        up_slope = _up_slope(normal, sin)
        if self.path is None:
            return normal + self._law.friction * self.face * up_slope
        slides = self._slides(up_slope, rows)
        return normal + self._law.friction * self.face * slides[..., None] * up_slope

    def _slides(self, up_slope: Array, rows: IntArray) -> Array:
        """1 where ice slides over a structure that moves as it is pushed, -1 where the other way; (k, SAMPLES).

        By the drift it slides with u, by the motion of the structure with w more.
        """
        assert self.path is not None
        at = np.column_stack((self._x[rows] + self._v * self._t, self._sample_y[rows].mean(axis=1)))
        arm = np.column_stack((at, np.full(len(rows), self.touching_z))) - self.path.at(self._t)[:3]
        pushed = -self.face * up_slope
        u = self._v * pushed[..., 0]
        w = -(pushed * moved.speed(self.path.velocity, arm)[:, None, :]).sum(axis=-1)
        both = np.abs(u) + np.abs(w)
        return np.asarray(np.clip(np.divide(u + w, TURNS * both, out=np.ones_like(u), where=both > 0.0), -1.0, 1.0))

    def friction_in(self, y: Array, force: Array) -> Array:
        """Friction in forces (m, >= 3) on the nodes at displacements y (m, 3), of a structure that moves."""
        assert self.path is not None
        height = self.touching_z + y[:, 2] - self.path.at(self._t)[2]
        rows = np.flatnonzero(force[: len(self.nodes)].any(axis=1))
        mu = np.full(len(force), self._law.friction)
        _, normal = self.overlap(self._t, y[: len(self.nodes)])
        normal = normal[rows]
        up_slope = _up_slope(normal, np.sqrt(1.0 - normal[..., 2] ** 2))
        mu[rows] *= self._slides(up_slope, rows).mean(axis=1)
        return friction_at(self._s, mu, self.face, height, force)


def _up_slope(normal: Array, sin: Array) -> Array:
    """Direction up the face (k, SAMPLES, 3) that looks along ``normal`` and stands at an angle of this ``sin``."""
    return np.asarray((np.array([0.0, 0.0, 1.0]) - normal[..., 2:] * normal) / sin[..., None])
