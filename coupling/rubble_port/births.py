"""From a fragment of the sheet to a rigid plate: its pieces, column by column, and the motion of its nodes.

The plate lies in the plane through the fragment's nodes. Each gapless run of a column is a piece, as long as its ice
and as thick as the sheet. The whole plate, with the ice that was crushed off its edge and that the lattice has moved
until now, has the linear and the angular momentum of the nodes, all six components: whatever ice does not move as a
rigid body does, that part of its energy is released. A node's mass stands in the middle of its ice, as everywhere but
at the rim of the floe it does in the lattice; there lies the plate's centre too, so that a hand-over is the same for
every observer who moves uniformly.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from coupling.interface import Array, Fragment, IntArray


@dataclass(frozen=True)
class PieceBirth:
    """A piece before the structure trims it, in the axes of its plate."""

    whole: Array  #: (4, 2) outline in x, z with what was crushed off its edge, counter-clockwise [m]
    polygon: Array  #: (k, 2) without that; of no area if nothing is left [m]
    width: float  #: [m]
    y: float  #: of its middle [m]


@dataclass(frozen=True)
class Momenta:
    """Of a fragment's nodes with their whole ice."""

    centre: Array  #: (3,) of their mass [m]
    linear: Array  #: (3,) [N s]
    spin: Array  #: (3,) about the centre, the same for every observer [N m s]
    #: (2,) what each would be if no parts cancelled, the second with the velocity of the centre and, for the ice of
    #: each node, with half a thickness as its arm
    scale: Array

    @classmethod
    def of(cls, f: Fragment, thickness: float, density: float) -> Momenta:
        """``density`` [kg/m^3]."""
        mass, at = density * thickness * f.length * f.width, _ice(f)
        centre = np.average(at, axis=0, weights=mass)
        p, mean = mass[:, None] * f.velocity, np.average(f.velocity, axis=0, weights=mass)
        spin = np.cross(at - centre, mass[:, None] * (f.velocity - mean))
        rotary = mass * thickness**2 / 12.0 * f.tilt_rate  # inertia of a node (2.22)
        total = np.abs(p).sum()
        turning = np.abs(np.cross(at - centre, p)).sum() + 0.5 * thickness * total + np.abs(rotary).sum()
        scale = np.array([total, turning])
        spin[:, 1] += rotary
        return cls(centre, p.sum(axis=0), spin.sum(axis=0), scale)


def frame_of(f: Fragment, thickness: float) -> tuple[Array, Array]:
    """A point (3,) of the plane through the middle of a fragment's ice, and its axes as columns (3, 3)."""
    volume = f.length * f.width
    at = _ice(f)
    centre = np.average(at, axis=0, weights=volume)
    d = at - centre
    xx, yy, xy = (float((volume * a).sum()) for a in (d[:, 0] ** 2, d[:, 1] ** 2, d[:, 0] * d[:, 1]))
    xz, yz = float((volume * d[:, 0] * d[:, 2]).sum()), float((volume * d[:, 1] * d[:, 2]).sum())
    least, own = 1e-9 * float(volume.sum()) * thickness**2, -float(np.average(np.tan(f.tilt), weights=volume))
    if xx * yy - xy**2 > least * max(xx, yy, least):
        rise, lean = (xz * yy - yz * xy) / (xx * yy - xy**2), (yz * xx - xz * xy) / (xx * yy - xy**2)
    elif xx > least:
        rise, lean = xz / xx, 0.0
    else:
        rise, lean = own, (yz / yy if yy > least else 0.0)
    up = np.array([-rise, -lean, 1.0]) / np.sqrt(1.0 + rise**2 + lean**2)
    ahead = np.array([1.0, 0.0, rise]) / np.sqrt(1.0 + rise**2)
    return centre, np.column_stack([ahead, np.cross(up, ahead), up])


def _ice(f: Fragment) -> Array:
    """Middles of the nodes' ice (n, 3) [m]."""
    at = f.position.copy()
    ahead = f.lead - 0.5 * f.length
    at[:, 0] += ahead
    at[:, 2] -= ahead * np.tan(f.tilt)
    return at


def births(f: Fragment, thickness: float, origin: Array, axes: Array) -> Iterator[PieceBirth]:
    """The pieces of a fragment in the axes of its plate: per column, then per gapless run of rows, front to rear."""
    for column in np.unique(f.column):
        rows = np.unique(f.row[f.column == column])
        for run in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
            n = np.flatnonzero((f.column == column) & np.isin(f.row, run))
            n = n[np.argsort(f.row[n])]
            yield _birth(f, thickness, n, (_ice(f)[n] - origin) @ axes)


def _birth(f: Fragment, h: float, n: IntArray, at: Array) -> PieceBirth:
    """``at`` (k, 3): middles of the ice of nodes ``n``, front first, in the axes of the plate."""
    length = f.length[n]
    front = float(np.average(at[:, 0] + np.cumsum(length) - 0.5 * length, weights=length))
    rear = front - float(length.sum())
    first = n[0]
    outline = _bevelled(rear, front, h, float(f.cut[first]), float(f.cut_tan[first]), f.cut_face)
    whole = _bevelled(rear, front, h, 0.0, 1.0, 1.0)
    return PieceBirth(whole, outline, float(f.width[n].mean()), float(np.average(at[:, 1], weights=length)))


def _bevelled(rear: float, front: float, h: float, cut: float, tan: float, face: float) -> Array:
    """Rectangle rear..front x -h/2..h/2 without the wedge that starts ``cut`` behind the front edge; see `Fragment`."""
    cut = min(cut, front - rear + h / tan)
    deep = cut - h / tan  # how far back the far face is cut as well
    if cut <= 0.0:
        shape = [(rear, -h / 2), (front, -h / 2), (front, h / 2), (rear, h / 2)]
    elif deep < 0.0:
        shape = [(rear, -h / 2), (front, -h / 2), (front, h / 2 - cut * tan), (front - cut, h / 2), (rear, h / 2)]
        if cut >= front - rear:
            shape[3:] = [(rear, h / 2 - (cut - (front - rear)) * tan)]
    else:
        shape = [(rear, -h / 2), (front - deep, -h / 2), (front - cut, h / 2), (rear, h / 2)]
        if cut >= front - rear:
            shape[2:] = [(rear, -h / 2 + (front - deep - rear) * tan)]
    out = np.array(shape)
    if face < 0.0:
        out = out[::-1] * np.array([1.0, -1.0])
    return out
