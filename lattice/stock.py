"""Records of the sheet's energy books: work of a force, what some ice has, what was used of a step."""

from __future__ import annotations

from dataclasses import dataclass, field

from lattice.grid import Array


@dataclass
class Work:
    """Work of a force on the sheet [J] and its impulse along x [N s]; a fixed observer sees work + V push."""

    work: float = 0.0
    push: float = 0.0

    def at(self, drift: float) -> float:
        """Work that a fixed observer sees when the frame drifts [J]."""
        return self.work + drift * self.push

    def add(self, time: float, force: Array, v: Array) -> None:
        """``time`` [s] of forces (m, k) [N], the first along x, on points with velocities (m, k)."""
        self.work += time * float((force * v).sum())
        self.push += time * float(force[:, 0].sum())


@dataclass
class Stock:
    """What some ice has [J], with its momentum along x [N s] and its mass [kg]."""

    elastic: float = 0.0
    foundation: float = 0.0
    kinetic: float = 0.0
    momentum: float = 0.0
    mass: float = 0.0

    @property
    def energy(self) -> float:
        """For an observer who drifts with the ice [J]."""
        return self.elastic + self.kinetic + self.foundation

    def kinetic_at(self, drift: float) -> float:
        """Kinetic energy for a fixed observer when the frame drifts [J]."""
        return self.kinetic + drift * self.momentum + 0.5 * self.mass * drift**2

    def add(self, other: Stock) -> None:
        """Takes in what some more ice has."""
        for name in ("elastic", "foundation", "kinetic", "momentum", "mass"):
            setattr(self, name, getattr(self, name) + getattr(other, name))


@dataclass
class Served:
    """Sums over the windows that were used of a step."""

    touch: Work = field(default_factory=Work)
    rub: Work = field(default_factory=Work)
    damping: float = 0.0  #: [J]
    hold: float = 0.0  #: [N s]
