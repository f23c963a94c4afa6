"""A block of broken ice: a prism with its body in pymunk, its wetted edges, and its state across the section."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, cos, sin

import numpy as np
import pymunk

from rubble.friction import ICE
from rubble.geometry import Array, clip, contiguous, is_convex, moments, place
from rubble.phases import ROTATING
from rubble.physics import RubblePhysics
from rubble.prism import inertia, strips, wetted_edges


@dataclass(frozen=True, slots=True)
class Prism:
    """What follows from a block's outline and its strips; body frame, about the centre of mass."""

    polygon: Array  #: (k, 2) outline, counter-clockwise
    edges: Array  #: (e, 8) wetted edges, see `water`
    mass: float  #: true mass [kg]
    inertia: float  #: true moment of inertia about the y axis [kg m^2]
    width: float  #: mean extent along y [m]
    area: float  #: of the outline [m^2]
    reach: float  #: of the farthest corner from the centre [m]
    long_axis: float  #: direction of the long axis [rad]
    slender: bool  #: long and short extent differ by more than 20 %; else both axes count as long
    parts: list[Array]  #: strips of the outline
    cuts: Array  #: (s + 1,) where the strips begin and end along body x [m]
    widths: Array  #: (s,) their widths along y [m]


@dataclass(slots=True, eq=False)
class Block:
    """One block: its prism, its body in pymunk, and its state across the section."""

    id: int  #: number of the block, never reused
    fragment: int  #: number of the fragment it came from
    body: pymunk.Body  #: carries mass + added mass
    shape: pymunk.Poly
    prism: Prism
    across: Array  #: (2,) y and v_y; of a block in a section a view of the section's table
    aligned: bool = False  #: its long axis has once aligned with the slope
    phase: int = ROTATING
    flooded: float = 1.0  #: share of its head of water that the top carries
    load: Array = field(default_factory=lambda: np.zeros(3))  #: mean force on the structure over the last window [N]
    #: force and moment of the water's pressure in the last sub-step, nan if unknown [N, N, N m]
    pressure: Array = field(default_factory=lambda: np.full(3, np.nan))
    thrust: tuple[float, float, float] = (0.0, 0.0, 0.0)  #: constant force and moment beside the weight [N, N, N m]

    @property
    def y(self) -> float:
        """Place across the sections [m]."""
        return float(self.across[0])

    @y.setter
    def y(self, value: float) -> None:
        self.across[0] = value

    @property
    def v_y(self) -> float:
        """Speed across the sections [m/s]."""
        return float(self.across[1])

    @v_y.setter
    def v_y(self, value: float) -> None:
        self.across[1] = value

    @property
    def mass(self) -> float:
        """True mass [kg]."""
        return self.prism.mass

    @property
    def outline(self) -> Array:
        """(k, 2) corners in world x, z [m]."""
        return place(self.prism.polygon, *self.body.position, self.body.angle, 0.0, 0.0)


def make_block(
    number: int,
    physics: RubblePhysics,
    polygon: Array,
    cuts: Array,
    widths: Array,
    density: float,
    velocity: tuple[float, float],
    omega: float,
    y: float,
    fragment: int,
    angle: float,
    flooded: float = 1.0,
) -> Block:
    """A block from its outline in world coordinates; ``cuts`` (s + 1,) are places along the axis at ``angle`` [m]."""
    prism, (cx, cz) = make_prism(place(_checked(polygon), 0.0, 0.0, -angle, 0.0, 0.0), cuts, widths, density)
    body = pymunk.Body(1.0, 1.0)
    _set_inertia(body, prism, physics, density)
    body.position = (cos(angle) * cx - sin(angle) * cz, sin(angle) * cx + cos(angle) * cz)
    body.angle, body.velocity, body.angular_velocity = angle, (float(velocity[0]), float(velocity[1])), float(omega)
    shape = pymunk.Poly(body, [(float(a), float(b)) for a, b in prism.polygon])
    shape.elasticity, shape.collision_type = physics.restitution**0.5, ICE
    return Block(number, fragment, body, shape, prism, np.array([y, 0.0]), flooded=flooded)


def make_prism(own: Array, cuts: Array, widths: Array, density: float) -> tuple[Prism, tuple[float, float]]:
    """The prism of an outline turned so that its axis lies along x, and where its centre of mass was."""
    cuts, widths = _checked_strips(own, cuts, widths)
    parts = strips(own, cuts, widths)
    volume, cx, cz, polar = inertia(parts, widths)
    shift = np.array([cx, cz])
    parts, own, area = [p - shift for p in parts], own - shift, float(moments(own)[0])
    edges = wetted_edges(parts, cuts - cx, widths)
    axis, slender = _long_axis(own)
    prism = Prism(
        own,
        edges,
        density * volume,
        density * polar,
        volume / area,
        area,
        float(np.hypot(*own.T).max()),
        axis,
        slender,
        parts,
        cuts - cx,
        widths,
    )
    return prism, (cx, cz)


def cut_block(block: Block, nx: float, nz: float, c: float) -> float:
    """Take off what lies on ``nx x + nz z > c`` in the body frame; returns its mass [kg], 0 if less than two corners.

    The rest moves on as the part of a rigid body that it is: same rotation, its own centre's velocity.
    """
    density = block.mass / (block.prism.area * block.prism.width)
    rest = clip(block.prism.polygon, nx, nz, c)
    if len(rest) < 3 or moments(rest)[0] < 1e-6 * block.prism.area:
        return 0.0
    old = block.prism
    block.prism, (cx, cz) = make_prism(_distinct(rest), block.prism.cuts, block.prism.widths, density)
    body, angle, om = block.body, block.body.angle, block.body.angular_velocity
    dx, dz = cos(angle) * cx - sin(angle) * cz, sin(angle) * cx + cos(angle) * cz
    (x, z), (vx, vz) = body.position, body.velocity
    body.position, body.velocity = (x + dx, z + dz), (vx - om * dz, vz + om * dx)
    body.mass *= block.prism.mass / old.mass
    body.moment *= block.prism.inertia / old.inertia
    block.shape.unsafe_set_vertices([(float(a), float(b)) for a, b in block.prism.polygon])
    return old.mass - block.mass


def _set_inertia(body: pymunk.Body, prism: Prism, physics: RubblePhysics, density: float) -> None:
    water = physics.rho_w / density
    body.mass = prism.mass * (1.0 + physics.added_mass * water)
    body.moment = prism.inertia * (1.0 + physics.added_inertia * water)


def _distinct(polygon: Array) -> Array:
    """Without corners that fall together."""
    gap = np.abs(polygon - np.roll(polygon, 1, axis=0)).max(axis=1)
    return np.ascontiguousarray(polygon[gap > 1e-6 * np.abs(polygon).max()])


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
        raise ValueError(
            f"strips from {cuts[0]:g} to {cuts[-1]:g} m miss the block from {lo:g} to {hi:g} m; "
            "cuts are places along the block's axis"
        )
    first, last = int(np.argmax(keep)), len(keep) - int(np.argmax(keep[::-1]))
    cuts, widths = cuts[first : last + 1].copy(), widths[first:last].copy()
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
