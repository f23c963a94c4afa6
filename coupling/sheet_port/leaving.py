"""Pieces that leave the lattice in a window, and when the rubble gets them."""

from __future__ import annotations

from dataclasses import replace

from coupling.interface import Fragment


class Leaving:
    """In lockstep the rubble takes pieces when it is met first in a window, and those that leave later at its end."""

    def __init__(self) -> None:
        self.pieces: list[tuple[Fragment, bool]] = []  #: whether at the structure
        self._times: list[float] = []
        self._given: int | None = None  #: how many the rubble has; None: it was not met in this window

    def begin(self) -> None:
        """A window begins."""
        self.pieces, self._times, self._given = [], [], None

    def add(self, piece: Fragment, t: float, *, touching: bool) -> None:
        """A piece leaves at time t [s]."""
        self.pieces.append((piece, touching))
        self._times.append(t)

    def come(self) -> list[Fragment]:
        """Pieces for the rubble at a meeting: none but at the first in a window."""
        if self._given is not None:
            return []
        self._given = len(self.pieces)
        return [piece for piece, _ in self.pieces]

    def late(self, end: float) -> list[Fragment]:
        """Pieces that the rubble does not have yet; in lockstep where their velocity brings them by ``end`` [s]."""
        if self._given is None:
            return [piece for piece, _ in self.pieces]
        left = zip(self.pieces[self._given :], self._times[self._given :], strict=True)
        return [replace(piece, position=piece.position + (end - t) * piece.velocity) for (piece, _), t in left]
