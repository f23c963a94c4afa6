"""A block of broken ice: a prism with its body in pymunk, its wetted edges, and its lateral state."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, sin

import numpy as np
import pymunk

from rubble.arrays import Array, Record
from rubble.bodies import FORCE, LATERAL, LOAD
from rubble.geometry import area_moments, clip, contiguous, is_convex, place
from rubble.handlers import ICE
from rubble.physics import RubblePhysics
from rubble.pressure import water_energy
from rubble.prism import Prism, make_prism


@dataclass(frozen=True)
class Slab:
    """Ice that is to become a block, where it lies in the section."""

    outline: Array  #: (k, 2) convex, in world x, z [m]
    cuts: Array  #: (s + 1,) places along its axis between which its width is constant: ``x cos + z sin`` [m]
    widths: Array  #: (s,) along y between the cuts [m]
    density: float  #: [kg/m^3]
    angle: float = 0.0  #: of its axis from x [rad]


def _unknown() -> Record:
    pressure = np.zeros(1, FORCE)[0]
    pressure["x"] = pressure["z"] = pressure["moment"] = np.nan
    return pressure


@dataclass(slots=True, eq=False)
class Block:
    """One block: its prism, its body in pymunk, and its lateral state."""

    id: int  #: number of the block, never reused
    fragment: int  #: number of the fragment it came from
    body: pymunk.Body  #: carries mass + added mass
    shape: pymunk.Poly
    prism: Prism
    lateral: Record  #: LATERAL; of a block in a section a row of the section's table
    aligned: bool = False  #: its long axis has once aligned with the slope
    sliding: bool = False  #: its phase: rotating before, sliding after it has aligned and left the sheet
    flooded: float = 1.0  #: part of its head of water that the top carries
    pressure: Record = field(default_factory=_unknown)  #: FORCE of the water's pressure in the last sub-step
    load: Record = field(default_factory=lambda: np.zeros(1, LOAD)[0])  #: LOAD on the structure in the last window [N]
    thrust: tuple[float, float, float] = (0.0, 0.0, 0.0)  #: constant force and moment beside the weight [N, N, N m]

    @property
    def y(self) -> float:
        """Lateral place [m]."""
        return float(self.lateral["y"])

    @y.setter
    def y(self, value: float) -> None:
        self.lateral["y"] = value

    @property
    def v_y(self) -> float:
        """Lateral speed [m/s]."""
        return float(self.lateral["v_y"])

    @v_y.setter
    def v_y(self, value: float) -> None:
        self.lateral["v_y"] = value

    @property
    def mass(self) -> float:
        """True mass [kg]."""
        return self.prism.mass

    @property
    def velocity(self) -> Array:
        """Of the centre of mass (3,) [m/s]."""
        return np.array([self.body.velocity.x, self.v_y, self.body.velocity.y])

    @property
    def momentum(self) -> Array:
        """True mass times velocity (3,) [N s]."""
        return self.mass * self.velocity

    @property
    def outline(self) -> Array:
        """(k, 2) corners in world x, z [m]."""
        out: Array = place(self.prism.polygon, *self.body.position, self.body.angle, 0.0, 0.0)
        return out


def make_block(
    number: int,
    fragment: int,
    physics: RubblePhysics,
    slab: Slab,
    velocity: tuple[float, float, float],
    omega: float,
    y: float,
    flooded: float = 1.0,
) -> Block:
    """A block from its outline in world coordinates; ``velocity`` (x, y, z) [m/s], ``omega`` [rad/s]."""
    angle = slab.angle
    own = place(_checked(slab.outline), 0.0, 0.0, -angle, 0.0, 0.0)
    prism, (cx, cz) = make_prism(own, slab.cuts, slab.widths, slab.density)
    body = pymunk.Body(1.0, 1.0)
    water = physics.rho_w / slab.density
    body.mass = prism.mass * (1.0 + physics.added_mass * water)
    body.moment = prism.inertia * (1.0 + physics.added_inertia * water)
    body.position = (cos(angle) * cx - sin(angle) * cz, sin(angle) * cx + cos(angle) * cz)
    body.angle, body.velocity, body.angular_velocity = angle, (float(velocity[0]), float(velocity[2])), float(omega)
    shape = pymunk.Poly(body, [(float(a), float(b)) for a, b in prism.polygon])
    shape.elasticity, shape.collision_type = physics.restitution**0.5, ICE
    lateral = np.zeros(1, LATERAL)[0]
    lateral["y"], lateral["v_y"] = y, velocity[1]
    return Block(number, fragment, body, shape, prism, lateral, flooded=flooded)


def energy_of(block: Block, physics: RubblePhysics) -> tuple[float, float]:
    """Kinetic energy of a block, and its energy of weight and water [J]; see `energy`."""
    body, edges = block.body, block.prism.edges
    turning = 0.5 * body.moment * body.angular_velocity**2 if np.isfinite(body.moment) else 0.0
    water = water_energy(edges, 0, len(edges), body.position.y, body.angle, physics.rho_w * physics.g)
    kinetic = 0.5 * body.mass * (float(body.velocity.length_squared) + block.v_y**2) + turning
    return float(kinetic), float(block.mass * (physics.g * body.position.y - physics.afloat) + water)


def cut_block(block: Block, nx: float, nz: float, c: float) -> float:
    """Take off what lies on ``nx x + nz z > c`` in the body frame; returns its mass [kg], 0 if less than two corners.

    The rest moves on as the part of a rigid body that it is: same rotation, its own centre's velocity.
    """
    density = block.mass / (block.prism.area * block.prism.width)
    rest = clip(block.prism.polygon, nx, nz, c)
    if len(rest) < 3 or area_moments(rest).area < 1e-6 * block.prism.area:
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


def _distinct(polygon: Array) -> Array:
    """Without corners that fall together."""
    gap = np.abs(polygon - np.roll(polygon, 1, axis=0)).max(axis=1)
    return np.ascontiguousarray(polygon[gap > 1e-6 * np.abs(polygon).max()])


def _checked(polygon: Array) -> Array:
    out = contiguous(polygon)
    if not is_convex(out) or area_moments(out).area <= 0:
        raise ValueError(f"a block's outline with {len(out)} corners is not convex; split it into convex parts")
    return out
