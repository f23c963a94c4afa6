"""From a fragment of the sheet to rigid blocks, one per section and run of rows.

The block is the prism that the run of nodes makes: as long as their ice, as thick as the sheet, turned as the line
through the nodes, with the edge cut off where it was crushed. Its linear and angular momentum are those of the nodes.
What then still lies inside the structure is cut away by the rubble and counted as crushed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from coupling.interface import Array, Fragment, IntArray


@dataclass(frozen=True)
class BlockBirth:
    """A block before the structure trims it."""

    polygon: Array  #: (k, 2) outline in world x, z, counter-clockwise [m]
    cuts: Array  #: (s + 1,) places along the block's axis between which its width is constant [m]
    widths: Array  #: (s,) [m]
    angle: float  #: of the axis, from x towards z [rad]
    y: float  #: middle of its ice [m]
    mass: float  #: of its nodes, without what was crushed [kg]
    centre: Array  #: (2,) centre of mass of its nodes [m]
    velocity: Array  #: (3,) of the centre of mass [m/s]
    omega: float  #: from x towards z [rad/s]
    inertia: float  #: moment of inertia of its nodes about their centre [kg m2]
    flooded: float  #: part of the head of water that its top carries, 0-1

    def momenta(self, about: Array) -> Array:
        """Momentum x, y, z of its ice, and angular momentum about a point (2,) in the x-z plane, (4,)."""
        arm, p = self.centre - about, self.mass * self.velocity
        return np.array([*p, arm[0] * p[2] - arm[1] * p[0] + self.inertia * self.omega])


def centre_of(fragment: Fragment) -> Array:
    """Centre of mass of a fragment's nodes in the x-z plane (2,) [m]."""
    mass = np.maximum(fragment.mass, 0.0)
    return np.average(fragment.position[:, [0, 2]], axis=0, weights=mass if mass.any() else fragment.length)


def momenta_of(fragment: Fragment, thickness: float, about: Array) -> tuple[Array, Array]:
    """Momentum of a fragment's nodes x, y, z and angular momentum about a point in the x-z plane (4,), and their scale.

    The scale (4,) is what they would be if no parts cancelled. ``thickness`` of the ice [m].
    """
    mass, v = np.maximum(fragment.mass, 0.0)[:, None], fragment.velocity
    arm, own = fragment.position[:, [0, 2]] - about, mass[:, 0] * thickness**2 / 12.0
    parts = np.column_stack(
        (mass * v, mass[:, 0] * arm[:, 0] * v[:, 2], -mass[:, 0] * arm[:, 1] * v[:, 0], -own * fragment.tilt_rate)
    )
    total, scale = parts.sum(axis=0), np.abs(parts).sum(axis=0)
    return np.append(total[:3], total[3:].sum()), np.append(np.full(3, scale[:3].max()), scale[3:].sum())


def births(fragment: Fragment, thickness: float, columns_per_section: int) -> Iterator[BlockBirth]:
    """The blocks of a fragment: per section, then per gapless run of rows, front to rear."""
    section = fragment.column // columns_per_section
    for key in np.unique(section):
        rows = np.unique(fragment.row[section == key])
        for run in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
            yield _birth(fragment, thickness, np.flatnonzero((section == key) & np.isin(fragment.row, run)))


def _birth(f: Fragment, h: float, n: IntArray) -> BlockBirth:
    ice_x = f.position[n, 0] + f.lead[n] - 0.5 * f.length[n]
    ice_z = f.position[n, 2] - (ice_x - f.position[n, 0]) * np.tan(f.tilt[n])
    volume = f.length[n] * f.width[n]
    mass = np.maximum(f.mass[n], 0.0)
    m = mass if mass.sum() > 0.0 else volume
    middle = np.array([np.average(ice_x, weights=volume), np.average(ice_z, weights=volume)])
    angle = _angle(ice_x, ice_z, f.tilt[n], volume)
    node = f.position[n][:, [0, 2]]  # where the lattice has the mass
    centre = np.average(node, axis=0, weights=m)
    velocity = np.average(f.velocity[n], axis=0, weights=m)
    polygon, cuts, widths = _prism(f, h, n, ice_x, middle, angle)
    arm = node - centre
    spin = m * (arm[:, 0] * (f.velocity[n, 2] - velocity[2]) - arm[:, 1] * (f.velocity[n, 0] - velocity[0]))
    own = m * h**2 / 12.0  # rotary inertia of a node (2.22)
    inertia = float((m * (arm**2).sum(axis=1) + own).sum())
    omega = float((spin - own * f.tilt_rate[n]).sum() / inertia)
    return BlockBirth(
        polygon=polygon,
        cuts=cuts,
        widths=widths,
        angle=angle,
        y=float(np.average(f.position[n, 1], weights=m)),
        mass=float(mass.sum()),
        centre=centre,
        velocity=velocity,
        omega=omega,
        inertia=inertia,
        flooded=float(np.average(f.flooded[n], weights=volume)),
    )


def _angle(x: Array, z: Array, tilt: Array, weight: Array) -> float:
    """Slope of the line through the nodes, or of the single node, as an angle from x towards z."""
    dx, dz = x - np.average(x, weights=weight), z - np.average(z, weights=weight)
    spread = float((weight * dx * dx).sum())
    if spread < 1e-9 * weight.sum():
        return -float(np.average(tilt, weights=weight))
    return float(np.arctan((weight * dx * dz).sum() / spread))


def _prism(f: Fragment, h: float, n: IntArray, ice_x: Array, middle: Array, angle: float) -> tuple[Array, Array, Array]:
    """Outline with the crushed edge cut off, and its widths row by row."""
    rows, at = np.unique(f.row[n], return_inverse=True)  # front to rear
    length = np.array([f.length[n][at == k].max() for k in range(len(rows))])
    width = np.array([f.width[n][at == k].sum() for k in range(len(rows))])
    axis = np.array([np.cos(angle), np.sin(angle)])
    front = middle @ axis + float(((ice_x - middle[0]) / axis[0] + 0.5 * f.length[n]).max())
    edges = front - np.concatenate(([0.0], np.cumsum(length)))
    n0 = n[at == 0]
    outline = _bevelled(edges[-1], front, h, float(f.cut[n0].max()), float(f.cut_tan[n0].max()), f.cut_face)
    normal = np.array([-axis[1], axis[0]])
    polygon = outline[:, :1] * axis + (middle @ normal + outline[:, 1:]) * normal
    return polygon, edges[::-1].copy(), width[::-1].copy()


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
