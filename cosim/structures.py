"""Kinds of structure by name: which keys of [structure] each takes, and how it is built from them.

A kind from outside is one more line: ``KINDS["mine"] = Kind(build, needs=("slope", "waterline_radius"))``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from coupling.interface import Structure
from coupling.structure import DEEP, Profile, Revolved, cone, multi_sided_cone, plane_slope


class Measures(Protocol):
    """What [structure] of a scenario holds, see `cosim.scenario.structure`; None where a kind takes no such key."""

    slope: float
    breaking: str
    top: float
    toe_depth: float | None
    waterline_radius: float
    neck_radius: float | None
    sides: int
    orientation: float | None
    profile: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Kind:
    """A kind of structure. ``breaking``, ``top`` and ``toe_depth`` are there for all of them."""

    build: Callable[[Measures], Structure]
    needs: tuple[str, ...] = ()  #: further keys without which it cannot be built
    takes: tuple[str, ...] = ()  #: further keys that may be given


def _cone(s: Measures) -> Structure:
    return cone(s.slope, s.waterline_radius, s.neck_radius, top=s.top, toe_depth=s.toe_depth, breaking=s.breaking)


def _multi_sided(s: Measures) -> Structure:
    return multi_sided_cone(
        s.sides,
        s.slope,
        s.waterline_radius,
        s.neck_radius,
        orientation=s.orientation or 0.0,
        top=s.top,
        toe_depth=s.toe_depth,
        breaking=s.breaking,
    )


def _plane(s: Measures) -> Structure:
    toe_depth = DEEP if s.toe_depth is None else s.toe_depth
    return plane_slope(s.slope, top=s.top, toe_depth=toe_depth, breaking=s.breaking)


def _profile(s: Measures) -> Structure:
    return Revolved(Profile(s.profile))


KINDS: dict[str, Kind] = {
    "cone": Kind(_cone, needs=("slope", "waterline_radius"), takes=("neck_radius",)),
    "multi-sided-cone": Kind(
        _multi_sided, needs=("slope", "waterline_radius", "sides"), takes=("neck_radius", "orientation")
    ),
    "plane": Kind(_plane, needs=("slope",)),
    "profile": Kind(_profile, needs=("profile",)),
}
