"""A block of broken ice: a prism with its body in pymunk, its wetted edges, and its state across the section."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, sin

import numpy as np
import pymunk

from rubble.geometry import Array, contiguous, is_convex, moments, place
from rubble.physics import RubblePhysics
from rubble.water import inertia, strips, wetted_edges

ROTATING, SLIDING = 1, 2  #: phases of a block, the numbers of `coupling.interface.Phase`


@dataclass(slots=True, eq=False)
class Block:
    """One block. Masses in kg, lengths in m; body-frame quantities about the centre of mass."""

    id: int  #: number of the block, never reused
    fragment: int  #: number of the fragment it came from
    body: pymunk.Body  #: carries mass + added mass
    shape: pymunk.Poly
    polygon: Array  #: (k, 2) outline in the body frame, counter-clockwise
    edges: Array  #: (e, 5) wetted edges, see `water`
    mass: float  #: true mass
    inertia: float  #: true moment of inertia about the y axis [kg m^2]
    width: float  #: mean extent along y
    area: float  #: of the outline [m^2]
    long_axis: float  #: direction of the long axis in the body frame [rad]
    slender: bool  #: long and short extent differ by more than 20 %; else both axes count as long
    parts: list[Array]  #: strips of the outline in the body frame
    widths: Array  #: (s,) their widths along y
    y: float
    v_y: float = 0.0
    aligned: bool = False  #: its long axis has once aligned with the slope
    phase: int = ROTATING


def make_block(number: int, physics: RubblePhysics, polygon: Array, cuts: Array, widths: Array, density: float,
               velocity: tuple[float, float], omega: float, y: float, fragment: int, angle: float) -> Block:
    """A block from its outline in world coordinates; ``cuts`` (s + 1,) are places along the axis at ``angle`` [m]."""
    own = place(_checked(polygon), 0.0, 0.0, -angle, 0.0, 0.0)
    cuts, widths = _checked_strips(own, cuts, widths)
    parts = strips(own, cuts, widths)
    volume, cx, cz, polar = inertia(parts, widths)
    shift = np.array([cx, cz])
    parts = [p - shift for p in parts]
    edges = wetted_edges(parts, cuts - cx, widths)
    mass, moment, area = density * volume, density * polar, float(moments(own)[0])
    added = physics.rho_w * volume
    body = pymunk.Body(mass + physics.added_mass * added, moment + physics.added_inertia * physics.rho_w * polar)
    body.position = (cos(angle) * cx - sin(angle) * cz, sin(angle) * cx + cos(angle) * cz)
    body.angle, body.velocity, body.angular_velocity = angle, (float(velocity[0]), float(velocity[1])), float(omega)
    shape = pymunk.Poly(body, [(float(a), float(b)) for a, b in own - shift])
    shape.friction, shape.elasticity = physics.mu_ice_ice**0.5, physics.restitution**0.5
    axis, slender = _long_axis(own - shift)
    return Block(number, fragment, body, shape, own - shift, edges, mass, moment, volume / area, area, axis, slender,
                 parts, widths, y)


def _checked(polygon: Array) -> Array:
    out = contiguous(polygon)
    if not is_convex(out) or moments(out)[0] <= 0:
        raise ValueError(f"a block's outline with {len(out)} corners is not convex; split it into convex parts")
    return out


def _checked_strips(polygon: Array, cuts: Array, widths: Array) -> tuple[Array, Array]:
    """Strips as arrays, the outer cuts moved to the block's ends so that no ice is left out."""
    cuts, widths = np.array(cuts, dtype=np.float64), np.array(widths, dtype=np.float64)
    if len(cuts) != len(widths) + 1 or (np.diff(cuts) <= 0).any() or not (widths > 0).all():
        raise ValueError(f"strips with cuts {cuts} and widths {widths}; give ascending cuts, one more than widths > 0")
    lo, hi = polygon[:, 0].min(), polygon[:, 0].max()
    keep = (cuts[1:] > lo) & (cuts[:-1] < hi)
    if not keep.any():
        raise ValueError(f"strips from {cuts[0]:g} to {cuts[-1]:g} m miss the block from {lo:g} to {hi:g} m; "
                         "cuts are places along the block's axis")
    first, last = int(np.argmax(keep)), len(keep) - int(np.argmax(keep[::-1]))
    cuts, widths = cuts[first:last + 1].copy(), widths[first:last].copy()
    cuts[0], cuts[-1] = lo, hi
    return cuts, widths


def _long_axis(polygon: Array) -> tuple[float, bool]:
    """Direction of the outline's longer principal axis [rad], and whether it is clearly the longer one."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    length = np.hypot(*edge.T)
    middle = polygon + edge / 2
    middle = middle - (length @ middle) / length.sum()
    tensor = (middle * length[:, None]).T @ middle + (edge * length[:, None]).T @ edge / 12
    values, vectors = np.linalg.eigh(tensor)
    return atan2(float(vectors[1, 1]), float(vectors[0, 1])), bool(values[1] > 1.44 * values[0])
