"""Forces of still water on blocks: buoyancy, form drag, skin drag; one kernel for all blocks of a section.

* Buoyancy is the pressure on the edges of the block, see `pressure`.
* Form drag: where the body moves into the water (u.n > 0), ``-rho_w/2 C_d (u.n) u`` per area. For a translation this is
  C_d on the projected submerged extent; for a rotation it gives the moment with the same coefficient (three Gauss
  points per edge: 3 % too much for an edge that turns about its middle).
* Skin drag: ``-rho_w/2 C_f |u_t| u_t`` per wetted area, u_t along the edge.
* Added mass stands in mass and moment of inertia of the body, see `block`.
* Backfill: the top of a new block carries a part of its head of water, 0 when dry, 1 when flooded. The part grows
  from the moment when water comes over the lowest edge of the top; a top that is out of the water drains.

The pose is taken one sub-step ahead, because pymunk moves bodies before it applies forces: with the force at the old
pose bobbing would gain energy by (omega dt)^2 per step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray, Record, Records, record
from rubble.bodies import Bodies, set_force
from rubble.compiled import compiled
from rubble.physics import RubblePhysics
from rubble.pressure import Ends, pressure_on, turned, wetted

#: what water has done to the blocks since the start: loss by drag [J], impulse x, z [N s], work of dry tops [J], work
#: that the pressure all around does beyond its potential energy because it is taken at the end of a sub-step [J]
WATER_WORK = record("drag_loss", "impulse_x", "impulse_z", "dry_work", "stepping")
#: impulses of the water over a window, x and z of each [N s]: pressure as if all tops were flooded, what dry tops add
#: to it, drag
WATER_IMPULSE = record("flooded_x", "flooded_z", "dry_x", "dry_z", "drag_x", "drag_z")

GAUSS_X, OUTER, MIDDLE = float(np.sqrt(0.15)), 5 / 18, 8 / 18  #: outer points on -1/2 ... 1/2, and weights


class Water(NamedTuple):
    """The water and what it does to ice."""

    rho_g: float  #: rho_w g [N/m^3]
    half_rho: float  #: rho_w / 2 [kg/m^3]
    form_drag: float  #: C_d
    skin_drag: float  #: C_f
    ahead: float  #: time by which the pose is advanced: the sub-step [s]
    level: float  #: height of the water on the tops, <= 0 [m]
    filling_rate: float  #: part of the head on a wet top that comes per second [1/s]
    current: float = 0.0  #: velocity of the water along x [m/s]


class Hulls(NamedTuple):
    """The blocks of a section as the water meets them."""

    edges: Records  #: EDGE of all blocks
    offset: IntArray  #: (n + 1,) block i owns edges[offset[i]:offset[i + 1]]
    weight: Records  #: (n,) FORCE: weight and any constant thrust
    flooded: Array  #: (n,) part of the head that the top carries
    pressure: Records  #: (n,) FORCE: pressure all around in the last sub-step, nan if unknown


class Pose(NamedTuple):
    """How a block stands and moves while the water presses on it."""

    z: float  #: of its centre [m]
    c: float  #: cosine and sine of its angle
    s: float
    v_x: float  #: velocity in the section [m/s]
    v_z: float
    u_x: float  #: the same in the body frame [m/s]
    u_z: float
    omega: float  #: [rad/s]


class EdgeForce(NamedTuple):
    """Pressure and drag on one edge in the body frame."""

    x: float  #: both together [N]
    z: float
    moment: float  #: about the centre of mass [N m]
    power: float  #: of drag [W]
    pressure: float  #: along the outward normal [N]
    braked: float  #: drag along the outward normal [N]
    along: float  #: drag along the edge [N]
    twist: float  #: moment of the pressure [N m]


class TopForce(NamedTuple):
    """What the head on an edge of the top does, in the section."""

    flooded_x: float  #: pressure if it were flooded [N]
    flooded_z: float
    flooded_moment: float  #: [N m]
    dry_x: float  #: what it gains because it carries less [N]
    dry_z: float
    power: float  #: of that [W]


class WaterForce(NamedTuple):
    """Water force on a block, moments about the centre of mass."""

    x: float  #: pressure and drag together [N]
    z: float
    moment: float  #: [N m]
    drag_power: float  #: [W]
    dry_power: float  #: of the head that the top lacks [W]
    lowest: float  #: height of the lowest point of its top [m]
    flooded_x: float  #: pressure as if the top were flooded [N]
    flooded_z: float
    flooded_moment: float  #: [N m]
    dry_x: float  #: what a dry top adds to it [N]
    dry_z: float
    drag_x: float  #: [N]
    drag_z: float


def water_of(physics: RubblePhysics) -> Water:
    """The water of a scenario."""
    return Water(
        rho_g=physics.rho_w * physics.g,
        half_rho=physics.rho_w / 2,
        form_drag=float(physics.form_drag),
        skin_drag=float(physics.skin_drag),
        ahead=float(physics.substep),
        level=float(physics.backfill_level),
        filling_rate=float(physics.filling_rate),
        current=float(physics.current[0]),
    )


@compiled(nogil=True)
def _on_top(edge: Record, pose: Pose, flooded: float, water: Water) -> TopForce:
    """An edge of the top that carries only a part of its head."""
    ends = turned(edge, pose.c, pose.s)
    full = pressure_on(ends, edge.width, pose.z, water.rho_g)
    now = pressure_on(ends, edge.width * flooded, pose.z - water.level, water.rho_g)
    power = (now.x - full.x) * pose.v_x + (now.z - full.z) * pose.v_z + (now.moment - full.moment) * pose.omega
    return TopForce(full.x, full.z, full.moment, now.x - full.x, now.z - full.z, power)


@compiled(nogil=True, error_model="numpy", inline="always")
def _on_edge(edge: Record, pose: Pose, width: float, z: float, water: Water) -> EdgeForce:
    """Pressure and drag on one edge; the water stands at height 0 when the centre stands at z.

    Along an edge of a rigid body u.t is constant and u.n linear, so the integrals are moments of u.n.
    """
    c, s, tx, tz, om = pose.c, pose.s, edge.t_x, edge.t_z, pose.omega
    ax, az, bx, bz = edge.x0, edge.z0, edge.x1, edge.z1
    da, db = z + s * ax + c * az, z + s * bx + c * bz
    if da >= 0.0 and db >= 0.0:
        return EdgeForce(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if da > 0.0 or db > 0.0:
        ax, az, bx, bz = wetted(Ends(ax, az, bx, bz), da, db)
    lx, lz = bx - ax, bz - az
    length, mx, mz = lx * tx + lz * tz, (ax + bx) / 2, (az + bz) / 2
    area, arm = width * length, mx * tx + mz * tz
    mean, tilt = -water.rho_g * (z + s * mx + c * mz), -water.rho_g * (s * lx + c * lz) / 12
    ux, uz = pose.u_x - om * mz, pose.u_z + om * mx
    ut, un = ux * tx + uz * tz, ux * tz - uz * tx
    normal, tangent = -area * mean, -area * water.half_rho * water.skin_drag * abs(ut) * ut
    couple = area * length * tilt
    power, half, pressure, braked = tangent * ut, om * length, normal, 0.0
    twist = couple - normal * arm
    if un > -0.5 * abs(half):  # some of the edge may move into the water
        u0, u1, u2 = max(un + GAUSS_X * half, 0.0), max(un, 0.0), max(un - GAUSS_X * half, 0.0)
        w0, w1, w2 = OUTER * u0, MIDDLE * u1, OUTER * u2  # Gauss-Legendre, exact to fifth order
        first, second, third = w0 + w1 + w2, w0 * u0 + w1 * u1 + w2 * u2, w0 * u0 * u0 + w1 * u1 * u1 + w2 * u2 * u2
        turn = GAUSS_X * (w2 * u2 - w0 * u0)
        k = area * water.half_rho * water.form_drag
        braked = -k * second
        normal += braked
        tangent -= k * first * ut
        couple += k * length * turn
        power -= k * (first * ut * ut + third)
    moment = couple - normal * arm + tangent * (mx * tz - mz * tx)
    return EdgeForce(
        normal * tz + tangent * tx, -normal * tx + tangent * tz, moment, power, pressure, braked, tangent, twist
    )


@compiled(nogil=True)
def block_force(edges: Records, start: int, end: int, water: Water, flooded: float, row: Record) -> WaterForce:
    """Water force on the block with the `STATE` row and the edges from ``start`` to ``end``.

    The top carries the part ``flooded`` of the head below the level of `Water`, every other edge the head below z = 0.
    """
    om = row.omega
    z, angle = row.z + water.ahead * row.v_z, row.angle + water.ahead * om
    c, s = np.cos(angle), np.sin(angle)
    v_x = row.v_x - water.current  # drag is that of the motion through the water
    pose = Pose(z, c, s, row.v_x, row.v_z, c * v_x + s * row.v_z, c * row.v_z - s * v_x, om)
    fx, fz, moment, power, lack, lowest = 0.0, 0.0, 0.0, 0.0, 0.0, np.inf
    wet_x = wet_z = drag_x = drag_z = turn = full_x = full_z = dry_x = dry_z = 0.0
    for e in range(start, end):
        edge = edges[e]
        width, level, dry, tx, tz = edge.width, z, False, edge.t_x, edge.t_z
        if edge.top > 0.0:
            lowest = min(lowest, z + s * edge.x0 + c * edge.z0, z + s * edge.x1 + c * edge.z1)
            if water.level < 0.0 or flooded < 1.0:
                top = _on_top(edge, pose, flooded, water)
                lack, turn = lack + top.power, turn + top.flooded_moment
                full_x, full_z = full_x + top.flooded_x, full_z + top.flooded_z
                dry_x, dry_z = dry_x + top.dry_x, dry_z + top.dry_z
                width, level, dry = width * flooded, z - water.level, True
        f = _on_edge(edge, pose, width, level, water)
        fx, fz, moment, power = fx + f.x, fz + f.z, moment + f.moment, power + f.power
        drag_x, drag_z = drag_x + f.braked * tz + f.along * tx, drag_z - f.braked * tx + f.along * tz
        if not dry:
            wet_x, wet_z, turn = wet_x + f.pressure * tz, wet_z - f.pressure * tx, turn + f.twist
    full_x, full_z = full_x + c * wet_x - s * wet_z, full_z + s * wet_x + c * wet_z
    drag_x, drag_z = c * drag_x - s * drag_z, s * drag_x + c * drag_z
    fx, fz = c * fx - s * fz, s * fx + c * fz
    power += drag_x * water.current
    return WaterForce(
        x=fx, z=fz, moment=moment, drag_power=power, dry_power=lack, lowest=lowest,
        flooded_x=full_x, flooded_z=full_z, flooded_moment=turn, dry_x=dry_x, dry_z=dry_z, drag_x=drag_x, drag_z=drag_z,
    )  # fmt: skip


@compiled(nogil=True)
def apply_water(hulls: Hulls, bodies: Bodies, water: Water, work: Record, impulse: Record) -> None:
    """Weight, thrust, buoyancy and drag of all blocks of a section, written into their pymunk bodies.

    The part of the head on each top grows here. ``work`` (WATER_WORK) and ``impulse`` (WATER_IMPULSE) are added to.
    """
    edges, offset, state, address, dt = hulls.edges, hulls.offset, bodies.state, bodies.address, water.ahead
    flooded, weight, pressure = hulls.flooded, hulls.weight, hulls.pressure
    for i in range(bodies.blocks):
        row, own, before = state[i], weight[i], pressure[i]
        f = block_force(edges, offset[i], offset[i + 1], water, flooded[i], row)
        fx, fz = f.x + own.x, f.z + own.z
        set_force(address[i], bodies.layout, fx, fz, f.moment + own.moment)
        work.drag_loss -= f.drag_power * dt
        work.impulse_x += fx * dt
        work.impulse_z += fz * dt
        work.dry_work += f.dry_power * dt
        impulse.flooded_x += f.flooded_x * dt
        impulse.flooded_z += f.flooded_z * dt
        impulse.dry_x += f.dry_x * dt
        impulse.dry_z += f.dry_z * dt
        impulse.drag_x += f.drag_x * dt
        impulse.drag_z += f.drag_z * dt
        late = 0.5 * (f.flooded_x - before.x) * row.v_x * dt
        late += 0.5 * (f.flooded_z - before.z) * row.v_z * dt
        late += 0.5 * (f.flooded_moment - before.moment) * row.omega * dt
        before.x, before.z, before.moment = f.flooded_x, f.flooded_z, f.flooded_moment
        work.stepping += late if late == late else 0.0  # nan: the pressure before is not known
        if f.lowest < 0.0:
            flooded[i] = min(1.0, flooded[i] + dt * water.filling_rate)
        elif water.filling_rate > 0.0:
            flooded[i] = 0.0
