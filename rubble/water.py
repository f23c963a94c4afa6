"""Forces of still water on blocks: buoyancy, form drag, skin drag; one kernel for all blocks of a section.

A block is a prism (convex polygon in x-z) whose width along y is piecewise constant in strips along its long axis. It
is stored as its wetted **edges** in the body frame, each with a width: the outline, split at the strips, and the steps
between strips, whose width is the difference of the two.

* Buoyancy is the integral of the water pressure over the edges, exact for straight edges. By the divergence theorem
  it equals rho_w g times the submerged area (`geometry.submerged`); a test keeps the two together.
* Form drag: where the body moves into the water (u.n > 0), ``-rho_w/2 C_d (u.n) u`` per area. For a translation this is
  C_d on the projected submerged extent; for a rotation it gives the moment with the same coefficient (three Gauss
  points per edge: 3 % too much for an edge that turns about its middle).
* Skin drag: ``-rho_w/2 C_f |u_t| u_t`` per wetted area, u_t along the edge.
* Added mass stands in mass and moment of inertia of the body, see `block`.
* Backfill: the top of a new block carries a share of its head of water, 0 when dry, 1 when flooded. The share grows
  from the moment when water comes over the lowest edge of the top; a top that is out of the water drains.

The pose is taken one sub-step ahead, because pymunk moves bodies before it applies forces: with the force at the old
pose bobbing would gain energy by (omega dt)^2 per step.
"""

from __future__ import annotations

import numpy as np

from rubble.compiled import compiled
from rubble.geometry import Array
from rubble.pointers import IntArray, set_real

#: columns of an edge table: x0, z0, x1, z1 in the body frame [m], width [m], 1 for an edge of the block's top, x and z
#: of the direction 0 -> 1; water lies to the right of it
EDGE_COLUMNS = 8
#: columns of a state row: x, z, angle, v_x, v_z, omega
STATE_COLUMNS = 6
#: what water does to blocks, x and z of each: pressure as if all tops were flooded, what dry tops add to it, drag
SHARES = 6
#: what `block_force` finds: force x, z and moment, power of drag, power of the head that the top lacks, and moment of
#: the pressure as if all tops were flooded
FORCE_COLUMNS = 6
#: sums of `apply_water`: drag loss [J], impulse x, z [N s], work of dry tops [J], work that the pressure all around
#: does beyond its potential energy because it is taken at the end of a sub-step's way [J]
WATER_SUMS = 5

GAUSS_X, OUTER, MIDDLE = float(np.sqrt(0.15)), 5 / 18, 8 / 18  #: outer points on -1/2 ... 1/2, and weights


@compiled("UniTuple(float64, 4)(float64, float64, float64, float64, float64, float64)", nogil=True)
def _wetted(ax: float, az: float, bx: float, bz: float, da: float, db: float) -> tuple[float, float, float, float]:
    """The part of an edge below still water, its ends at heights da and db; nothing: both ends the same."""
    if da >= 0.0 and db >= 0.0:
        return ax, az, ax, az
    if da > 0.0:
        f = da / (da - db)
        ax, az = ax + f * (bx - ax), az + f * (bz - az)
    elif db > 0.0:
        f = da / (da - db)
        bx, bz = ax + f * (bx - ax), az + f * (bz - az)
    return ax, az, bx, bz


@compiled("UniTuple(float64, 3)(float64, float64, float64, float64, float64, float64, float64)", nogil=True)
def _pressure(
    ax: float,
    az: float,
    bx: float,
    bz: float,
    width: float,
    z: float,
    rho_g: float,
) -> tuple[float, float, float]:
    """Force and moment of the water pressure on an edge, exact for a straight edge."""
    ax, az, bx, bz = _wetted(ax, az, bx, bz, z + az, z + bz)
    lx, lz = bx - ax, bz - az
    mean, tilt = -rho_g * (z + (az + bz) / 2), -rho_g * lz / 12  # pressure: mean, and its first moment
    mx, mz = (ax + bx) / 2, (az + bz) / 2
    return -width * mean * lz, width * mean * lx, width * (mean * (mx * lx + mz * lz) + tilt * (lx * lx + lz * lz))


@compiled("float64(float64[:, ::1], int64, int64, float64, float64, float64)", nogil=True)
def water_energy(edges: Array, start: int, end: int, z: float, angle: float, rho_g: float) -> float:
    """rho_w g times the integral of depth over the submerged part of a block with water all around [J].

    By the divergence theorem a sum over the wet edges; the waterline at depth 0 adds nothing.
    """
    c, s, total = np.cos(angle), np.sin(angle), 0.0
    for e in range(start, end):
        ax, az = c * edges[e, 0] - s * edges[e, 1], s * edges[e, 0] + c * edges[e, 1]
        bx, bz = c * edges[e, 2] - s * edges[e, 3], s * edges[e, 2] + c * edges[e, 3]
        ax, az, bx, bz = _wetted(ax, az, bx, bz, z + az, z + bz)
        middle, rise = z + 0.5 * (az + bz), bz - az
        total += 0.5 * edges[e, 4] * (bx - ax) * (middle * middle + rise * rise / 12.0)
    return rho_g * total


@compiled(
    "UniTuple(float64, 6)(float64[:, ::1], int64, float64, float64, float64, float64, float64[::1], float64, "
    "float64, float64)",
    nogil=True,
)
def _lacking(
    edges: Array, e: int, z: float, c: float, s: float, share: float, water: Array, vx: float, vz: float, om: float
) -> tuple[float, float, float, float, float, float]:
    """Force in the section on an edge of the top if it were flooded; what it gains because it carries less (share,
    level); the power of that; and the moment if it were flooded.
    """
    ax, az = c * edges[e, 0] - s * edges[e, 1], s * edges[e, 0] + c * edges[e, 1]
    bx, bz = c * edges[e, 2] - s * edges[e, 3], s * edges[e, 2] + c * edges[e, 3]
    full_x, full_z, full_y = _pressure(ax, az, bx, bz, edges[e, 4], z, water[0])
    fx, fz, my = _pressure(ax, az, bx, bz, edges[e, 4] * share, z - water[5], water[0])
    power = (fx - full_x) * vx + (fz - full_z) * vz + (my - full_y) * om
    return full_x, full_z, fx - full_x, fz - full_z, power, full_y


@compiled(
    "UniTuple(float64, 8)(float64, float64, float64, float64, float64, float64, float64, float64, float64, float64, "
    "float64, float64, float64, float64[::1])",
    nogil=True,
    error_model="numpy",
    inline="always",
)
def _edge_force(
    ax: float,
    az: float,
    bx: float,
    bz: float,
    tx: float,
    tz: float,
    width: float,
    z: float,
    c: float,
    s: float,
    vx: float,
    vz: float,
    om: float,
    water: Array,
) -> tuple[float, float, float, float, float, float, float, float]:
    """Pressure and drag on one edge, all in the body frame, with cosine and sine of its angle: force, moment, power of
    drag; then pressure and drag along the outward normal, drag along the edge, and the moment of pressure. The water
    stands at height 0 when the centre stands at z.

    Along an edge of a rigid body u.t is constant and u.n linear, so the integrals are moments of u.n.
    """
    da, db = z + s * ax + c * az, z + s * bx + c * bz
    if da >= 0.0 and db >= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if da > 0.0 or db > 0.0:
        ax, az, bx, bz = _wetted(ax, az, bx, bz, da, db)
    lx, lz = bx - ax, bz - az
    length, mx, mz = lx * tx + lz * tz, (ax + bx) / 2, (az + bz) / 2
    area, along = width * length, mx * tx + mz * tz
    mean, tilt = -water[0] * (z + s * mx + c * mz), -water[0] * (s * lx + c * lz) / 12
    ux, uz = vx - om * mz, vz + om * mx
    ut, un = ux * tx + uz * tz, ux * tz - uz * tx
    normal, tangent, couple = -area * mean, -area * water[1] * water[3] * abs(ut) * ut, area * length * tilt
    power, half, pressure, braked = tangent * ut, om * length, normal, 0.0
    twist = couple - normal * along
    if un > -0.5 * abs(half):  # some of the edge may move into the water
        u0, u1, u2 = max(un + GAUSS_X * half, 0.0), max(un, 0.0), max(un - GAUSS_X * half, 0.0)
        w0, w1, w2 = OUTER * u0, MIDDLE * u1, OUTER * u2  # Gauss-Legendre, exact to fifth order
        first, second, third = w0 + w1 + w2, w0 * u0 + w1 * u1 + w2 * u2, w0 * u0 * u0 + w1 * u1 * u1 + w2 * u2 * u2
        turn = GAUSS_X * (w2 * u2 - w0 * u0)
        k = area * water[1] * water[2]
        braked = -k * second
        normal += braked
        tangent -= k * first * ut
        couple += k * length * turn
        power -= k * (first * ut * ut + third)
    return (
        normal * tz + tangent * tx,
        -normal * tx + tangent * tz,
        couple - normal * along + tangent * (mx * tz - mz * tx),
        power,
        pressure,
        braked,
        tangent,
        twist,
    )


@compiled(
    "float64(float64[:, ::1], int64, int64, float64[::1], float64, float64[:, ::1], int64, float64[::1], float64[::1])",
    nogil=True,
)
def block_force(
    edges: Array, start: int, end: int, water: Array, share: float, state: Array, i: int, out: Array, parts: Array
) -> float:
    """Water force on the block in row ``i`` of ``state`` with the edges from ``start`` to ``end``: out see
    FORCE_COLUMNS, moments about the centre of mass [N, N m, W]; returns the height of the lowest point of its top [m].

    ``water`` = (rho_w g, rho_w / 2, C_d, C_f, time by which the pose is advanced, level on the tops, filling rate);
    the top carries ``share`` of the head below that level, every other edge the head below z = 0. ``parts`` are the
    SHARES of the force [N], each summed on its own.
    """
    om = state[i, 5]
    z, angle = state[i, 1] + water[4] * state[i, 4], state[i, 2] + water[4] * om
    c, s = np.cos(angle), np.sin(angle)
    vx, vz = c * state[i, 3] + s * state[i, 4], c * state[i, 4] - s * state[i, 3]
    fx, fz, moment, power, lack, lowest = 0.0, 0.0, 0.0, 0.0, 0.0, np.inf
    wet_x, wet_z, drag_x, drag_z, turn = 0.0, 0.0, 0.0, 0.0, 0.0
    parts[:] = 0.0
    for e in range(start, end):
        width, level, dry, tx, tz = edges[e, 4], z, False, edges[e, 6], edges[e, 7]
        if edges[e, 5] > 0.0:
            lowest = min(lowest, z + s * edges[e, 0] + c * edges[e, 1], z + s * edges[e, 2] + c * edges[e, 3])
            if water[5] < 0.0 or share < 1.0:
                full_x, full_z, more_x, more_z, gain, full_y = _lacking(
                    edges, e, z, c, s, share, water, state[i, 3], state[i, 4], om
                )
                lack, turn = lack + gain, turn + full_y
                parts[0], parts[1] = parts[0] + full_x, parts[1] + full_z
                parts[2], parts[3] = parts[2] + more_x, parts[3] + more_z
                width, level, dry = width * share, z - water[5], True
        gx, gz, my, drag, pressure, braked, along, twist = _edge_force(
            edges[e, 0], edges[e, 1], edges[e, 2], edges[e, 3], tx, tz, width, level, c, s, vx, vz, om, water
        )
        fx, fz, moment, power = fx + gx, fz + gz, moment + my, power + drag
        drag_x, drag_z = drag_x + braked * tz + along * tx, drag_z - braked * tx + along * tz
        if not dry:
            wet_x, wet_z, turn = wet_x + pressure * tz, wet_z - pressure * tx, turn + twist
    parts[0], parts[1] = parts[0] + c * wet_x - s * wet_z, parts[1] + s * wet_x + c * wet_z
    parts[4], parts[5] = c * drag_x - s * drag_z, s * drag_x + c * drag_z
    out[0], out[1], out[2], out[3], out[4] = c * fx - s * fz, s * fx + c * fz, moment, power, lack
    out[5] = turn
    return lowest


@compiled(
    "void(float64[:, ::1], int64[::1], float64[:, ::1], float64[::1], float64[::1], float64[:, ::1], int64[::1], "
    "int64[::1], float64[:, ::1], float64[::1])",
    nogil=True,
)
def apply_water(
    edges: Array,
    offset: IntArray,
    dead: Array,
    water: Array,
    flooded: Array,
    state: Array,
    bodies: IntArray,
    layout: IntArray,
    pressure: Array,
    work: Array,
) -> None:
    """Dead load, buoyancy and drag of all blocks of a section, written into their pymunk bodies.

    Block i owns ``edges[offset[i]:offset[i + 1]]``, stands in row i of ``state`` and at the address ``bodies[i]`` with
    the fields of ``layout`` (`pointers.body_offsets`); ``dead`` (blocks, 3) is the weight and any constant thrust
    [N, N, N m]; ``water`` as in `block_force`, its time is the sub-step; ``flooded`` is the share of the head on each
    top, which grows here. ``pressure`` (blocks, 3) is the force of the pressure all around in the last sub-step, nan if
    unknown; ``work`` see WATER_SUMS, and in its last columns the impulses of the water's SHARES [N s].
    """
    out, parts, first = np.empty(FORCE_COLUMNS), np.empty(SHARES), work.shape[0] - SHARES
    for i in range(dead.shape[0]):
        lowest = block_force(edges, offset[i], offset[i + 1], water, flooded[i], state, i, out, parts)
        for k in range(3):
            out[k] += dead[i, k]
            set_real(bodies[i] + layout[6 + k], out[k])
        work[0] -= out[3] * water[4]
        work[1] += out[0] * water[4]
        work[2] += out[1] * water[4]
        work[3] += out[4] * water[4]
        for k in range(SHARES):
            work[first + k] += parts[k] * water[4]
        late = 0.0
        for k in range(3):
            now = out[5] if k == 2 else parts[k]
            late += 0.5 * (now - pressure[i, k]) * state[i, 3 + k] * water[4]
            pressure[i, k] = now
        work[4] += late if late == late else 0.0
        if lowest < 0.0:
            flooded[i] = min(1.0, flooded[i] + water[4] * water[6])
        elif water[6] > 0.0:
            flooded[i] = 0.0
