"""`LANES` layered cells at a time, side by side in vectors: what their nodes do, how they lean, and their forces.

What a block needs of its nodes, and what it gives back, lies in the lines of one flat array at a constant distance:
only then can the compiler prove that they do not overlap. The cells' own lines of ``Cracks.linear`` are copied there.
"""

from __future__ import annotations

from lattice.compiled import compiled
from lattice.cracks.cells import (
    BLOCK,
    COUPLING,
    FACE,
    FAR,
    MEMBRANE,
    OFFSET,
    SEEN,
    SEEN_TURN,
    SKEW,
    SKEW_TURN,
    STIFF,
    edge_forces,
    forces,
    offsets,
    resultants,
    times,
)
from lattice.cracks.kinematics import Edges, Hourglass, Pose, Strain
from lattice.explicit.layout import LANES, PHI_X, PHI_Y, U_X, U_Y, W
from lattice.grid import Array, IntArray

L = LANES
#: lines of the room: displacement and velocity of nodes 0 to 3, component after component, forces on them alike;
#: strain from slopes before and now, its forces across the sheet, energy, what else a cell has to say, and its lines
Y, V, F, OLD, NEW, PULL, GAINED, SAYS, CELL = (LANES * line for line in (0, 20, 40, 60, 63, 66, 68, 69, 70))
LOOK = CELL + BLOCK  #: length of the room
GIVEN = 20 * LANES  #: forces of a block on nodes


@compiled(nogil=True, borrows=True)
def fetch_cells(first: int, linear: Array, room: Array) -> None:
    """The lines of the cells from ``first`` on into the room."""
    lines = linear[first * (BLOCK // LANES) :]
    for n in range(BLOCK):
        room[CELL + n] = lines[n]


@compiled(nogil=True, borrows=True)
def fetch(line: int, corner: IntArray, my: int, y: Array, room: Array) -> None:
    """Values y (5, nodes) of the nodes of up to `LANES` cells into the room, from ``line`` on."""
    for lane in range(len(corner)):
        b, at = corner[lane], line + lane
        for c in range(5):
            room[at + (4 * c) * L], room[at + (4 * c + 1) * L] = y[c, b], y[c, b + my]
            room[at + (4 * c + 2) * L], room[at + (4 * c + 3) * L] = y[c, b + 1], y[c, b + my + 1]


@compiled(nogil=True, borrows=True)
def halve(room: Array) -> None:
    """Values at Y become the means of those at V and Y."""
    for n in range(20 * LANES):
        room[Y + n] = 0.5 * (room[V + n] + room[Y + n])


@compiled(nogil=True, borrows=True)
def fetch_lean(corner: IntArray, strain: Array, room: Array) -> None:
    """Strains (3, nodes) from slopes of up to `LANES` cells, those before and, until they are known, those now."""
    for lane in range(len(corner)):
        b = corner[lane]
        for i in range(3):
            room[OLD + i * L + lane] = room[NEW + i * L + lane] = strain[i, b]


@compiled(nogil=True, borrows=True)
def put_lean(corner: IntArray, room: Array, strain: Array, pull: Array) -> float:
    """Slopes of up to `LANES` cells to their places; the energy that these have given, over d^2 [J/m2]."""
    gained = 0.0
    for lane in range(len(corner)):
        b = corner[lane]
        gained += room[GAINED + lane]
        for i in range(3):
            strain[i, b] = room[NEW + i * L + lane]
        for i in range(2):
            pull[i, b] = room[PULL + i * L + lane]
    return gained


@compiled(nogil=True, borrows=True)
def add_forces(corner: IntArray, my: int, room: Array, force: Array) -> None:
    """Adds the forces of up to `LANES` cells to those on the nodes, (5, nodes)."""
    for lane in range(len(corner)):
        b, at = corner[lane], F + lane
        for c in range(5):
            force[c, b] += room[at + (4 * c) * L]
            force[c, b + my] += room[at + (4 * c + 1) * L]
            force[c, b + 1] += room[at + (4 * c + 2) * L]
            force[c, b + my + 1] += room[at + (4 * c + 3) * L]


@compiled(nogil=True, borrows=True)
def put_forces(block: int, room: Array, given: Array) -> None:
    """Leaves the forces of a block to `add_given`."""
    kept = given[block * GIVEN : (block + 1) * GIVEN]
    for n in range(GIVEN):
        kept[n] = room[F + n]


@compiled(nogil=True, borrows=True)
def add_given(span: tuple[int, int], corner: IntArray, my: int, given: Array, force: Array) -> None:
    """As `add_forces` for all cells one after the other, from what blocks have left, on some places alone."""
    first, end = span
    for k in range(len(corner)):
        b, at = corner[k], k // LANES * GIVEN + k % LANES
        if first <= b < end:
            for c in range(5):
                force[c, b] += given[at + (4 * c) * L]
                force[c, b + 1] += given[at + (4 * c + 2) * L]
        if first <= b + my < end:
            for c in range(5):
                force[c, b + my] += given[at + (4 * c + 1) * L]
                force[c, b + my + 1] += given[at + (4 * c + 3) * L]


@compiled(inline="always")
def gradients_in(at: int, q: float, room: Array) -> tuple[float, float, float]:
    """As `kinematics.gradients`, of the component whose nodes begin at ``at``."""
    a, b, c, d = room[at], room[at + L], room[at + 2 * L], room[at + 3 * L]
    return (b - a + d - c) * q, (c - a + d - b) * q, (a - b - c + d) * q


@compiled(inline="always")
def strain_in(at: int, q: float, room: Array) -> tuple[Strain, Hourglass]:
    """As `kinematics.strain_of`, of the nodes at ``at``."""
    xx, xy, hx = gradients_in(at + 4 * U_X * L, q, room)
    yx, yy, hy = gradients_in(at + 4 * U_Y * L, q, room)
    px, py, tx = gradients_in(at + 4 * PHI_X * L, q, room)
    rx, ry, ty = gradients_in(at + 4 * PHI_Y * L, q, room)
    return Strain(xx, yy, xy + yx, px, ry, py + rx), Hourglass(hx, hy, tx, ty)


@compiled(inline="always")
def elongations_in(at: int, half: float, room: Array) -> Edges:
    """As `kinematics.elongations`, of the nodes at ``at``."""
    w, x, y = at + 4 * W * L, at + 4 * PHI_X * L, at + 4 * PHI_Y * L
    return (
        room[w + L] - room[w] + half * (room[x] + room[x + L]),
        room[w + 3 * L] - room[w + 2 * L] + half * (room[x + 2 * L] + room[x + 3 * L]),
        room[w + 2 * L] - room[w] + half * (room[y] + room[y + 2 * L]),
        room[w + 3 * L] - room[w + L] + half * (room[y + L] + room[y + 3 * L]),
    )


@compiled(inline="always")
def pose_in(at: int, d: float, room: Array) -> Pose:
    """As `kinematics.pose_of`, of the nodes at ``at``."""
    strain, _ = strain_in(at, 0.5 / d, room)
    return Pose(strain, elongations_in(at, 0.5 * d, room))


@compiled(nogil=True, borrows=True)
def lean_block(q: float, alpha: float, ago: float, room: Array) -> None:
    """New slopes at y - alpha v and what they do; the energy is that of ``ago`` [s], as in `lean.lean_row`."""
    for i in range(LANES):
        (y, _), (v, _) = strain_in(Y + i, q, room), strain_in(V + i, q, room)
        s_x, s_y, _ = gradients_in(Y + 4 * W * L + i, q, room)
        t_x, t_y, _ = gradients_in(V + 4 * W * L + i, q, room)
        s_x, s_y = s_x - alpha * t_x, s_y - alpha * t_y
        g_x, g_y, g_s = 0.5 * s_x * s_x, 0.5 * s_y * s_y, s_x * s_y
        d_x, d_y, d_s = g_x - room[OLD + i], g_y - room[OLD + L + i], g_s - room[OLD + 2 * L + i]
        o_x, o_y, o_s = offsets(OFFSET, CELL + i, room)
        a_x, a_y, a_s = times(MEMBRANE, CELL + i, y.n + g_x, y.t + g_y, y.g + g_s, room)
        b_x, b_y, b_s = times(COUPLING, CELL + i, y.kn, y.kt, y.kg, room)
        m_x, m_y, m_s = times(MEMBRANE, CELL + i, v.n, v.t, v.g, room)
        u_x, u_y, u_s = times(COUPLING, CELL + i, v.kn, v.kt, v.kg, room)
        c_x, c_y, c_s = times(MEMBRANE, CELL + i, d_x, d_y, d_s, room)
        N_x, N_y, N_s = o_x + a_x + b_x, o_y + a_y + b_y, o_s + a_s + b_s
        r_x, r_y, r_s = m_x + u_x, m_y + u_y, m_s + u_s
        gained = d_x * (N_x - ago * r_x - 0.5 * c_x) + d_y * (N_y - ago * r_y - 0.5 * c_y)
        room[GAINED + i] = gained + d_s * (N_s - ago * r_s - 0.5 * c_s)
        N_x, N_y, N_s = N_x - alpha * r_x, N_y - alpha * r_y, N_s - alpha * r_s
        room[NEW + i], room[NEW + L + i], room[NEW + 2 * L + i] = g_x, g_y, g_s
        room[PULL + i], room[PULL + L + i] = N_x * s_x + N_s * s_y, N_s * s_x + N_y * s_y


@compiled(nogil=True, borrows=True)
def moved(q: float, room: Array) -> int:
    """How many cells' faces have been strained so far since the last evaluation that the law must be asked anew.

    By how much more than that is left in the room.
    """
    count = 0
    for i in range(LANES):
        y, _ = strain_in(Y + i, q, room)
        s_x, s_y, s_s = offsets(SEEN, CELL + i, room)
        k_x, k_y, k_s = offsets(SEEN_TURN, CELL + i, room)
        half, far = room[CELL + FACE + i], room[CELL + FAR + i]
        a = abs(y.n + room[NEW + i] - s_x) + half * abs(y.kn - k_x)
        c = abs(y.t + room[NEW + L + i] - s_y) + half * abs(y.kt - k_y)
        g = abs(y.g + room[NEW + 2 * L + i] - s_s) + half * abs(y.kg - k_s)
        most = a if a > c else c
        most = most if most > g else g
        room[SAYS + i] = most - far
        count += 1 if most > far else 0
    return count


@compiled(nogil=True, borrows=True)
def force_block(d: float, room: Array) -> None:
    """Forces of the cells on their nodes at Y and the strains NEW from slopes."""
    q, f = 0.5 / d, 0.5 * d
    for i in range(LANES):
        e, h = strain_in(Y + i, q, room)
        e = Strain(e.n + room[NEW + i], e.t + room[NEW + L + i], e.g + room[NEW + 2 * L + i], e.kn, e.kt, e.kg)
        N1, N2, N3, M1, M2, M3 = resultants(CELL + i, e, room)
        Q0, Q1, Q2, Q3 = edge_forces(CELL + i, elongations_in(Y + i, f, room), room)
        H, R = room[CELL + SKEW + i], room[CELL + SKEW_TURN + i]
        hx, hy, tx, ty = H * h.x, H * h.y, R * h.tx, R * h.ty
        x, y, w = F + 4 * U_X * L + i, F + 4 * U_Y * L + i, F + 4 * W * L + i
        a, b = F + 4 * PHI_X * L + i, F + 4 * PHI_Y * L + i
        # nodes 0 (-, -), 1 (+, -), 2 (-, +), 3 (+, +)
        room[x], room[x + L] = f * (N1 + N3 - hx), f * (-N1 + N3 + hx)
        room[x + 2 * L], room[x + 3 * L] = f * (N1 - N3 + hx), f * (-N1 - N3 - hx)
        room[y], room[y + L] = f * (N2 + N3 - hy), f * (N2 - N3 + hy)
        room[y + 2 * L], room[y + 3 * L] = f * (-N2 + N3 + hy), f * (-N2 - N3 - hy)
        room[w], room[w + L], room[w + 2 * L], room[w + 3 * L] = Q0 + Q2, Q3 - Q0, Q1 - Q2, -Q1 - Q3
        room[a], room[a + L] = f * (M1 + M3 - tx - Q0), f * (-M1 + M3 + tx - Q0)
        room[a + 2 * L], room[a + 3 * L] = f * (M1 - M3 + tx - Q1), f * (-M1 - M3 - tx - Q1)
        room[b], room[b + L] = f * (M2 + M3 - ty - Q2), f * (M2 - M3 + ty - Q3)
        room[b + 2 * L], room[b + 3 * L] = f * (-M2 + M3 + ty - Q2), f * (-M2 - M3 - ty - Q3)


@compiled(nogil=True, borrows=True)
def power_block(d: float, room: Array) -> None:
    """What each cell's tangent does at V in the motion Y, over the same units of both: y . K v into the room."""
    q, half = 0.5 / d, 0.5 * d
    for i in range(LANES):
        (e, g), (r, h) = strain_in(Y + i, q, room), strain_in(V + i, q, room)
        N1, N2, N3, M1, M2, M3 = forces(CELL + i, r, room)
        area = N1 * e.n + N2 * e.t + N3 * e.g + M1 * e.kn + M2 * e.kt + M3 * e.kg
        area += room[CELL + SKEW + i] * (g.x * h.x + g.y * h.y) + room[CELL + SKEW_TURN + i] * (
            g.tx * h.tx + g.ty * h.ty
        )
        long, more = elongations_in(Y + i, half, room), elongations_in(V + i, half, room)
        edges = room[CELL + STIFF + i] * long[0] * more[0] + room[CELL + STIFF + L + i] * long[1] * more[1]
        edges += room[CELL + STIFF + 2 * L + i] * long[2] * more[2] + room[CELL + STIFF + 3 * L + i] * long[3] * more[3]
        room[SAYS + i] = d * d * area + edges
