"""A contact with a physical strength and a damaged edge, and the table of contacts.

It acts where it bears: at the middle of the face of contact, and the overlap counts the way of that point, rotation
included.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from coupling.contact import SAMPLES, OverlapContact
from coupling.interface import Array, IntArray

NEAR = 0.02  #: distance from the structure that an edge may go in a sub-step, in thicknesses
STEEP = 1e-9  #: least sine and cosine of a face's angle


class CrushingContact(OverlapContact):
    """Presses with what closes, up to the strength of the ice.

    The pressure grows with the closure L - c of the intact ice behind the crushed depth c, elastically with E / d,
    to the crushing strength of the ice. Beyond it ice is crushed away and c follows: the edge takes the shape of the
    structure, as section 6.3.2 of the thesis recommends. An edge that has let go meets the structure again only where
    it still reaches it. What overlaps the structure already when it comes into the front, because the ice before it has
    left, counts as crushed: nothing has pressed it there, so it presses with what closes from then on.

    The face of contact reaches from the touching edge, h / 2 from the middle of the ice, down to the depth
    s = min(L tan a, h) below it, so the force acts h / 2 - s / 2 from the middle. Its moment bends a downward-breaking
    edge up, against the vertical force. c and the height are set at the end of a window in which ice was crushed; where
    the edge has turned, the overlap is another one at another height, and c moves with it: the closure is what it was.
    An edge that swings without being crushed keeps both: would its height follow the overlap, c would come back
    another one from each swing, and the contact would feed the swing.
    """

    def set_edge(self, nodes: IntArray, x: Array, y: Array, width: Array, lead: Array | None = None) -> None:
        """As `OverlapContact.set_edge`; nodes that stay in front keep their damage."""
        known: dict[int, Array] = getattr(self, "_known", {})
        super().set_edge(nodes, x, y, width, lead)
        new = np.append(np.zeros(SAMPLES), self.face * 0.5 * self._h)
        self._unseen = np.array([n not in known for n in nodes.tolist()], dtype=bool)
        kept = np.array([known.get(n, new) for n in nodes.tolist()]).reshape(-1, SAMPLES + 1)
        self._keep(kept[:, :-1], kept[:, -1])

    def find(self, t: float, displacement: Callable[[], Array]) -> None:
        """Nodes that were not in front before are crushed as far as they overlap the structure, where they bear now."""
        new = self._unseen
        if not new.any():
            return
        self._keep(self._crushed, np.where(new, self._bearing(*self.overlap(t, displacement())), self.height))
        crushed = np.maximum(self.overlap(t, displacement())[0], 0.0)
        self._keep(np.where(new[:, None], crushed, self._crushed), self.height)
        self._unseen = np.zeros_like(new)

    def _keep(self, crushed: Array, height: Array) -> None:
        self._crushed, self.height = crushed, height
        self._known = dict(zip(self.nodes.tolist(), np.column_stack((crushed, height)), strict=True))

    def pressure(self, L: Array, rows: IntArray) -> tuple[Array, Array]:
        """Elastic up to the strength, where the ice is not crushed yet."""
        elastic = self._law.stiffness * (L - self._crushed[rows])
        bearing = (elastic > 0.0) & (elastic < self._law.strength)
        return np.clip(elastic, 0.0, self._law.strength), np.where(bearing, self._law.stiffness, 0.0)

    def faces(self, t: float, y: Array) -> tuple[Array, Array, Array, Array, Array, float, float]:
        """The sample points of all nodes about displacements y (m, 3), also of those up to `NEAR` off the structure.

        Of each (m, SAMPLES): overlap, negative where it is apart, and overlap up to which it is crushed [m]; what the
        overlap grows by with the displacement (..., 3); overlap from which on all of the ice's face is in contact [m];
        force by pressure and overlap (..., 3) [m]. Then pressure by closure [Pa/m] and the greatest [Pa].
        """
        near = NEAR * self._h
        (L, _), (ahead, normal) = self.overlap(t, y), self.overlap(t, y, near)
        sin, cos = np.sqrt(1.0 - normal[..., 2] ** 2), np.abs(normal[..., 2])
        sin, cos = np.maximum(sin, STEEP), np.maximum(cos, STEEP)
        per_area = (self._width[:, None] / SAMPLES)[..., None] * self._direction(normal, sin, np.arange(len(y)))
        overlap, grows, law = np.where(L > 0.0, L, ahead - near), normal / normal[..., :1], self._law
        way = per_area / cos[..., None]
        return overlap, self._crushed, grows, self._h * cos / sin, way, law.stiffness, law.strength

    def close_window(self, t: float, displacement: Callable[[], Array]) -> Array:
        """The crushed depth follows the overlap, less the closure at full strength; so does the height."""
        L, normal = self.overlap(t, displacement())
        crushed = np.maximum(self._crushed, L - self._law.strength / self._law.stiffness)
        deeper = (crushed > self._crushed).any(axis=1)
        if not deeper.any():
            return crushed
        self._keep(crushed, np.where(deeper, self._bearing(L, normal), self.height))
        there = self.overlap(t, displacement())[0]
        moved_by = np.where((L > 0.0) & (there > 0.0), there - L, 0.0)
        self._keep(np.maximum(crushed + moved_by, 0.0), self.height)
        return crushed

    def _bearing(self, L: Array, normal: Array) -> Array:
        """Height of the middle of the face of contact, (m,) [m]; an edge that has let go keeps its last one."""
        sin, _, _, length = self._length(L, normal)
        total = length.sum(axis=1)
        depth = np.divide(
            (length**2 * sin).sum(axis=1), total, out=self._h - 2.0 * self.face * self.height, where=total > 0.0
        )
        return np.asarray(self.face * 0.5 * (self._h - depth))


CONTACTS: dict[str, type[OverlapContact]] = {"overlap": OverlapContact, "crushing": CrushingContact}
