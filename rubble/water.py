"""Forces of water on plates: buoyancy, dry tops, form drag, skin drag; one kernel for all pieces.

* Buoyancy: the water all around lifts a piece by the weight of what it displaces, at the centre of that volume: the
  gradient of its potential energy, whatever way the plate is turned. Across its width a piece counts as it is in its
  middle plane.
* Dry tops: the top of a new plate carries a part of its head of water, 0 when dry, 1 when flooded. The part grows
  from the moment when water comes over the lowest edge of the top; a top that is out of the water drains.
* Form drag: where the body moves into the water (u.n > 0), ``-rho_w/2 C_d (u.n) u`` per area. For a translation this is
  C_d on the projected submerged extent; for a rotation it gives the moment with the same coefficient (three Gauss
  points per edge: 3 % too much for an edge that turns about its middle). The sides of a plate drag likewise.
* Skin drag: ``-rho_w/2 C_f |u_t| u_t`` per wetted area, u_t along the edge.
* Added mass stands in mass and inertia of the plate, see `piece`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray, Record, Records, record
from rubble.compiled import compiled
from rubble.physics import RubblePhysics
from rubble.plates import Plates, times, turn_back
from rubble.pressure import FAR, Wet, on_waterline, wet_part

#: what water has done to the plates since the start [J]: loss by drag, work of dry tops
WATER_WORK = record("drag_loss", "dry_work")
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
    level: float  #: height of the water on the tops, <= 0 [m]
    filling_rate: float  #: part of the head on a wet top that comes per second [1/s]
    current_x: float  #: velocity of the water along x and y [m/s]
    current_y: float
    far: float  #: see `pressure.FAR` [m]


class Hulls(NamedTuple):
    """The pieces as the water meets them."""

    plate: IntArray  #: (p,) row of the plate
    y: Array  #: (p,) of the middle, in the plate's axes [m]
    side: Array  #: (p,) part of its two sides that no other piece covers, 0-1, over its mean width [1/m]
    edges: Records  #: `pressure.EDGE` of all pieces
    offset: IntArray  #: (p + 1,) piece i owns edges[offset[i]:offset[i + 1]]
    weight: Array  #: (n, 3) constant force on each plate: weight and thrust [N]
    moment: Array  #: (n, 3) constant moment [N m]


class Pose(NamedTuple):
    """How a piece stands and moves while the water presses on it."""

    z: float  #: of the origin of its plate's x-z plane at its y [m]
    c: float  #: rise of the plate's z axis, and of its x axis
    s: float
    u_x: float  #: velocity through the water there, along the plate's axes [m/s]
    u_z: float
    omega: float  #: rate of turning from x towards z [rad/s]


class Plane(NamedTuple):
    """A force in the plate's x-z plane, with its moment from x towards z about the centre of mass [N, N, N m]."""

    x: float
    z: float
    moment: float


def water_of(physics: RubblePhysics) -> Water:
    """The water of a scenario."""
    return Water(
        rho_g=physics.rho_w * physics.g,
        half_rho=physics.rho_w / 2,
        form_drag=float(physics.form_drag),
        skin_drag=float(physics.skin_drag),
        level=float(physics.backfill_level),
        filling_rate=float(physics.filling_rate),
        current_x=float(physics.current[0]),
        current_y=float(physics.current[1]),
        far=FAR * physics.thickness,
    )


@compiled(nogil=True, error_model="numpy", inline="always")
def _drag(edge: Record, wet: Wet, pose: Pose, width: float, water: Water) -> Plane:
    """Drag on the wet part of an edge.

    Along an edge of a rigid body u.t is constant and u.n linear, so the integrals are moments of u.n.
    """
    tx, tz, om = edge.t_x, edge.t_z, pose.omega
    length, mx, mz = wet.length, wet.x, wet.z
    area, arm = width * length, mx * tx + mz * tz
    ux, uz = pose.u_x - om * mz, pose.u_z + om * mx
    ut, un = ux * tx + uz * tz, ux * tz - uz * tx
    normal, tangent = 0.0, -area * water.half_rho * water.skin_drag * abs(ut) * ut
    couple, half = 0.0, om * length
    if un > -0.5 * abs(half):  # some of the edge may move into the water
        u0, u1, u2 = max(un + GAUSS_X * half, 0.0), max(un, 0.0), max(un - GAUSS_X * half, 0.0)
        w0, w1, w2 = OUTER * u0, MIDDLE * u1, OUTER * u2  # Gauss-Legendre, exact to fifth order
        first, second = w0 + w1 + w2, w0 * u0 + w1 * u1 + w2 * u2
        k = area * water.half_rho * water.form_drag
        normal -= k * second
        tangent -= k * first * ut
        couple += k * length * GAUSS_X * (w2 * u2 - w0 * u0)
    moment = couple - normal * arm + tangent * (mx * tz - mz * tx)
    return Plane(normal * tz + tangent * tx, -normal * tx + tangent * tz, moment)


@compiled(nogil=True, inline="always")
def _head(edge: Record, wet: Wet, push: float) -> Plane:
    """Pressure on the wet part of an edge, ``push`` = rho_w g times width for that of the water all around."""
    normal = -push * wet.length * wet.depth
    moment = push * wet.length * wet.length * wet.tilt - normal * (wet.x * edge.t_x + wet.z * edge.t_z)
    return Plane(normal * edge.t_z, -normal * edge.t_x, moment)


@compiled(nogil=True, borrows=True)
def _add(out: Array, r: Array, y: float, f: Plane) -> None:
    """Add a force in the plane y of a plate to ``out`` (6,), fixed axes."""
    x, y_, z = times(r, f.x, 0.0, f.z)
    a, b, c = times(r, y * f.z, -f.moment, -y * f.x)
    out[0], out[1], out[2] = out[0] + x, out[1] + y_, out[2] + z
    out[3], out[4], out[5] = out[3] + a, out[4] + b, out[5] + c


@compiled(nogil=True, borrows=True)
def _add_at(out: Array, r: Array, at: tuple[float, float, float], x: float, y: float, z: float) -> None:
    """Add a force (x, y, z) at a point, both in the plate's axes, to ``out`` (6,), fixed axes."""
    a, b, c = times(r, at[1] * z - at[2] * y, at[2] * x - at[0] * z, at[0] * y - at[1] * x)
    x, y, z = times(r, x, y, z)
    out[0], out[1], out[2] = out[0] + x, out[1] + y, out[2] + z
    out[3], out[4], out[5] = out[3] + a, out[4] + b, out[5] + c


@compiled(nogil=True, borrows=True)
def _piece_force(i: int, plates: Plates, hulls: Hulls, water: Water, out: Array) -> float:
    """Adds the water's force on piece i to ``out``, see `plate_forces`; returns the lowest height of its top."""
    k, y = hulls.plate[i], hulls.y[i]
    r, v, share = plates.rotation[k], plates.motion[k], plates.flooded[k]
    ux, uy, uz = turn_back(r, v.x - water.current_x, v.y - water.current_y, v.z)
    wx, wy, wz = turn_back(r, v.a, v.b, v.c)
    s, c = r[2, 0], r[2, 2]
    pose = Pose(plates.position[k, 2] + r[2, 1] * y, c, s, ux - wz * y, uz + wx * y, -wy)
    volume = at_x = at_z = fx = fz = turn = dry_x = dry_z = dry_turn = 0.0
    lowest = np.inf
    ox, oz = on_waterline(pose.z, s, c, water.far)
    for e in range(hulls.offset[i], hulls.offset[i + 1]):
        edge = hulls.edges[e]
        wet, width = wet_part(edge, pose.z, s, c), edge.width
        cross = 0.5 * width * ((wet.ax - ox) * (wet.bz - oz) - (wet.bx - ox) * (wet.az - oz))
        volume += cross
        at_x, at_z = at_x + cross * (wet.ax + wet.bx + ox) / 3.0, at_z + cross * (wet.az + wet.bz + oz) / 3.0
        if edge.top > 0.0:
            lowest = min(lowest, pose.z + s * edge.x0 + c * edge.z0, pose.z + s * edge.x1 + c * edge.z1)
            if share < 1.0 or water.level < 0.0:
                full = _head(edge, wet, width * water.rho_g)
                wet, width = wet_part(edge, pose.z - water.level, s, c), width * share
                now = _head(edge, wet, width * water.rho_g)
                dry_x, dry_z = dry_x + now.x - full.x, dry_z + now.z - full.z
                dry_turn += now.moment - full.moment
        if wet.length > 0.0:
            drag = _drag(edge, wet, pose, width, water)
            fx, fz, turn = fx + drag.x, fz + drag.z, turn + drag.moment
    if volume > 0.0:
        lift, at = water.rho_g * volume, (at_x / volume, y, at_z / volume)
        _add_at(out[0], r, at, s * lift, r[2, 1] * lift, c * lift)
        u = uy + wz * at[0] - wx * at[2]
        _add_at(out[2], r, at, 0.0, -water.half_rho * water.form_drag * hulls.side[i] * volume * abs(u) * u, 0.0)
    _add(out[1], r, y, Plane(dry_x, dry_z, dry_turn))
    _add(out[2], r, y, Plane(fx, fz, turn))
    return lowest


@compiled(nogil=True, borrows=True)
def plate_forces(plates: Plates, hulls: Hulls, water: Water, forces: Array, lowest: Array) -> None:
    """Forces and moments of the water on all plates, fixed axes [N, N m], and the lowest point of each top (n,) [m].

    ``forces`` (n, 3, 6): pressure as if the top were flooded, what a dry top adds, drag.
    """
    forces[:] = 0.0
    lowest[:] = np.inf
    for i in range(hulls.plate.shape[0]):
        k = hulls.plate[i]
        lowest[k] = min(lowest[k], _piece_force(i, plates, hulls, water, forces[k]))


@compiled(nogil=True, borrows=True)
def fill_tops(plates: Plates, water: Water, lowest: Array, dt: float) -> None:
    """The part of the head on each top grows where water has come over its edge, and goes where it is dry."""
    for k in range(plates.moved.shape[0] - 1):
        if lowest[k] < 0.0:
            plates.flooded[k] = min(1.0, plates.flooded[k] + dt * water.filling_rate)
        elif water.filling_rate > 0.0:
            plates.flooded[k] = 0.0


@compiled(nogil=True, borrows=True)
def potential(plates: Plates, hulls: Hulls, mass: Array, water: Water, g: float, afloat: float, out: Array) -> None:
    """Energy of weight and of water all around of each plate (n,) [J], from ice that floats flat (`RubblePhysics`)."""
    for k in range(plates.moved.shape[0] - 1):
        out[k] = mass[k] * (g * plates.position[k, 2] - afloat)
    for i in range(hulls.plate.shape[0]):
        k = hulls.plate[i]
        r = plates.rotation[k]
        z, s, c = plates.position[k, 2] + r[2, 1] * hulls.y[i], r[2, 0], r[2, 2]
        ox, oz = on_waterline(z, s, c, water.far)
        for e in range(hulls.offset[i], hulls.offset[i + 1]):
            wet = wet_part(hulls.edges[e], z, s, c)
            cross = 0.5 * hulls.edges[e].width * ((wet.ax - ox) * (wet.bz - oz) - (wet.bx - ox) * (wet.az - oz))
            out[k] -= water.rho_g * cross * (z + (s * (wet.ax + wet.bx + ox) + c * (wet.az + wet.bz + oz)) / 3.0)
