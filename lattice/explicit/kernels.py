"""Explicit leapfrog of the whole lattice, five degrees of freedom per node, in compiled loops.

    v(n+1/2) = v(n-1/2) + dt / M (F - K (x + alpha v) - foundation),   x(n+1) = x(n) + dt v(n+1/2)

Spring forces and material damping alpha K v (2.27) act on the same differences, so the loops carry the *effective*
displacement y = x + alpha v and never x itself: y(n+1) = y(n) + (dt + alpha) v(n+1/2) - alpha v(n-1/2).

Two passes over each row of nodes: first the force of every connection that starts there (each once), then every node
gathers its own. Both run along j without a branch. What one pass leaves for the other lies in ``rows``, one flat
array with lines at a constant distance: only then can the compiler prove that they do not overlap, and use its
widest vectors. Broken cells have the weight 0; an axial connection carries the mean weight of its two cells.

The arrays are those of `lattice.explicit.layout`.
"""

from __future__ import annotations

from lattice.compiled import compiled
from lattice.explicit.layout import (
    LANES,
    LINE,
    LINES,
    PHI_X,
    PHI_Y,
    U_X,
    U_Y,
    HalfSprings,
    Intact,
    Motion,
    Pace,
    PerNode,
    W,
)
from lattice.grid import Array, IntArray

NX, SX, QX, BX, TX, NY, SY, QY, BY, TY, D1, D2, G1, G2, C0, C1, C2, C3, C4 = (k * LINE + LANES for k in range(LINES))
CARRIED = 14 * LINE  #: where the sums begin in ``rows`` that a row leaves for the next one
Span = tuple[int, int]  #: rows from the first to before the last
Five = tuple[float, float, float, float, float]  #: a value of each degree of freedom, or of each spring along an axis


@compiled(inline="always")
def at_node(i: int, j: int, y: Array) -> Five:
    """Of one node."""
    return y[U_X, i, j], y[U_Y, i, j], y[W, i, j], y[PHI_X, i, j], y[PHI_Y, i, j]


@compiled(inline="always")
def halfway(i: int, j: int, y: Array, z: Array) -> Five:
    """Mean of two motions of one node."""
    (a, b, c, d, e), (f, g, h, k, m) = at_node(i, j, y), at_node(i, j, z)
    return 0.5 * (a + f), 0.5 * (b + g), 0.5 * (c + h), 0.5 * (d + k), 0.5 * (e + m)


@compiled(inline="always")
def stretches(a: Five, b: Five, c: Five, e: Five, half: float) -> tuple[Five, Five, tuple[float, float, float, float]]:
    """Elongations of the connections from node (i, j) along x, along y, and along both diagonals of its cell.

    From its four nodes. Along an axis: (2.2) to (2.5) lengthwise, sideways, across, in bending and in torsion.
    """
    (a0, a1, a2, a3, a4), (b0, b1, b2, b3, b4), (c0, c1, c2, c3, c4), (e0, e1, _, e3, e4) = a, b, c, e
    return (
        (b0 - a0, b1 - a1, b2 - a2 + half * (a3 + b3), b3 - a3, b4 - a4),
        (c1 - a1, c0 - a0, c2 - a2 + half * (a4 + c4), c4 - a4, c3 - a3),
        (e0 - a0 + e1 - a1, b0 - c0 - b1 + c1, e3 - a3 + e4 - a4, b3 - c3 - b4 + c4),
    )


@compiled(inline="always")
def weights(i: int, j: int, intact: Intact) -> tuple[tuple[float, float], tuple[float, float], tuple[float, float]]:
    """Shares of the connections of `stretches`, in the plane and in bending each."""
    plane, bend = intact.plane, intact.bend
    cell, bent = plane[i + 1, j + 1], bend[i + 1, j + 1]
    along, across = (cell + plane[i + 1, j], bent + bend[i + 1, j]), (cell + plane[i, j + 1], bent + bend[i, j + 1])
    return along, across, (cell, bent)


@compiled(nogil=True, borrows=True)
def connections(i: int, ny: int, y: Array, intact: Intact, springs: HalfSprings, rows: Array) -> None:
    """Forces of the connections from row i along x, along y and along both diagonals, (2.2)-(2.5) and chapter 3."""
    kn, ks, ko, gr, gt = springs.K_n, springs.K_s, springs.K_out, springs.G_r, springs.G_t
    kd, gd, half = springs.K_n_dia, springs.G_dia, springs.lever
    for j in range(ny):
        (x, bx), (z, bz), (cell, bent) = weights(i, j, intact)
        a, b = at_node(i, j, y), at_node(i + 1, j, y)
        u, v, c = stretches(a, b, at_node(i, j + 1, y), at_node(i + 1, j + 1, y), half)
        rows[NX + j] = kn * x * u[0]
        rows[SX + j] = ks * x * u[1]
        rows[QX + j] = ko * x * u[2]
        rows[BX + j] = gr * bx * u[3]
        rows[TX + j] = gt * bx * u[4]
        rows[NY + j] = kn * z * v[0]
        rows[SY + j] = ks * z * v[1]
        rows[QY + j] = ko * z * v[2]
        rows[BY + j] = gr * bz * v[3]
        rows[TY + j] = gt * bz * v[4]
        rows[D1 + j] = kd * cell * c[0]
        rows[D2 + j] = kd * cell * c[1]
        rows[G1 + j] = gd * bent * c[2]
        rows[G2 + j] = gd * bent * c[3]


@compiled(nogil=True, borrows=True)
def power_of_springs(span: Span, one: Array, two: Array, intact: Intact, springs: HalfSprings, rows: Array) -> float:
    """Sum of one . K (one + two) / 2 over the springs of some rows, for two motions of the nodes."""
    kn, ks, ko, gr, gt = springs.K_n, springs.K_s, springs.K_out, springs.G_r, springs.G_t
    kd, gd, half, total = springs.K_n_dia, springs.G_dia, springs.lever, 0.0
    ny = intact.plane.shape[1] - LANES
    rows[NX : NX + ny] = 0.0
    for i in range(span[0], span[1]):
        for j in range(ny):
            (x, bx), (z, bz), (cell, bent) = weights(i, j, intact)
            n0, n1, n2 = at_node(i, j, one), at_node(i + 1, j, one), at_node(i, j + 1, one)
            m0, m1, m2 = halfway(i, j, one, two), halfway(i + 1, j, one, two), halfway(i, j + 1, one, two)
            a, b, c = stretches(n0, n1, n2, at_node(i + 1, j + 1, one), half)
            u, v, w = stretches(m0, m1, m2, halfway(i + 1, j + 1, one, two), half)
            power = kn * (x * a[0] * u[0] + z * b[0] * v[0]) + ks * (x * a[1] * u[1] + z * b[1] * v[1])
            power += ko * (x * a[2] * u[2] + z * b[2] * v[2]) + gr * (bx * a[3] * u[3] + bz * b[3] * v[3])
            power += gt * (bx * a[4] * u[4] + bz * b[4] * v[4])
            power += kd * cell * (c[0] * w[0] + c[1] * w[1]) + gd * bent * (c[2] * w[2] + c[3] * w[3])
            rows[NX + j] += power
    for j in range(ny):
        total += rows[NX + j]
    return total


@compiled(nogil=True, borrows=True)
def gather(i: int, ny: int, motion: Motion, kick: PerNode, lever: float, pace: Pace, rows: Array) -> None:
    """Every node of row i sums its connections and moves; what row i + 1 gets from them is left in C0 to C4."""
    y, v, half = motion.y, motion.v, lever
    alpha, go, buoy, drag = pace.alpha, pace.go, pace.buoy, pace.drag
    for j in range(ny):
        f = rows[C0 + j] + rows[NX + j] + rows[SY + j] - rows[SY + j - 1] + rows[D1 + j] + rows[D2 + j - 1]
        rows[C0 + j] = -rows[NX + j] - rows[D1 + j - 1] - rows[D2 + j]
        old = v[U_X, i, j]
        v[U_X, i, j] = old + kick.u[i, j] * f
        y[U_X, i, j] += go * v[U_X, i, j] - alpha * old
    for j in range(ny):
        f = rows[C1 + j] + rows[SX + j] + rows[NY + j] - rows[NY + j - 1] + rows[D1 + j] - rows[D2 + j - 1]
        rows[C1 + j] = -rows[SX + j] - rows[D1 + j - 1] + rows[D2 + j]
        old = v[U_Y, i, j]
        v[U_Y, i, j] = old + kick.u[i, j] * f
        y[U_Y, i, j] += go * v[U_Y, i, j] - alpha * old
    for j in range(ny):
        f = rows[C2 + j] + rows[QX + j] + rows[QY + j] - rows[QY + j - 1]
        rows[C2 + j] = -rows[QX + j]
        old = v[W, i, j]
        v[W, i, j] = old + kick.w[i, j] * f - buoy * y[W, i, j] - drag * old
        y[W, i, j] += go * v[W, i, j] - alpha * old
    for j in range(ny):
        f = rows[C3 + j] + rows[BX + j] + rows[TY + j] - rows[TY + j - 1] + rows[G1 + j] + rows[G2 + j - 1]
        f -= half * rows[QX + j]
        rows[C3 + j] = -rows[BX + j] - rows[G1 + j - 1] - rows[G2 + j] - half * rows[QX + j]
        old = v[PHI_X, i, j]
        v[PHI_X, i, j] = old + kick.phi[i, j] * f
        y[PHI_X, i, j] += go * v[PHI_X, i, j] - alpha * old
    for j in range(ny):
        f = rows[C4 + j] + rows[TX + j] + rows[BY + j] - rows[BY + j - 1] + rows[G1 + j] - rows[G2 + j - 1]
        f -= half * (rows[QY + j] + rows[QY + j - 1])
        rows[C4 + j] = -rows[TX + j] - rows[G1 + j - 1] + rows[G2 + j]
        old = v[PHI_Y, i, j]
        v[PHI_Y, i, j] = old + kick.phi[i, j] * f
        y[PHI_Y, i, j] += go * v[PHI_Y, i, j] - alpha * old


@compiled(nogil=True, borrows=True)
def carry_on(ny: int, half: float, rows: Array) -> None:
    """What `gather` of a row leaves for the next one, from its connections alone."""
    for j in range(ny):
        rows[C0 + j] = -rows[NX + j] - rows[D1 + j - 1] - rows[D2 + j]
        rows[C1 + j] = -rows[SX + j] - rows[D1 + j - 1] + rows[D2 + j]
        rows[C2 + j] = -rows[QX + j]
        rows[C3 + j] = -rows[BX + j] - rows[G1 + j - 1] - rows[G2 + j] - half * rows[QX + j]
        rows[C4 + j] = -rows[TX + j] - rows[G1 + j - 1] + rows[G2 + j]


@compiled(nogil=True, borrows=True)
def pull_of_springs(span: Span, motion: Motion, intact: Intact, held: Array, springs: HalfSprings) -> float:
    """Force along x that nodes with ``held`` (n_x+1, m_y) 1, else 0, need against the springs of some rows [N]."""
    y, kn, ks, kd, total = motion.y, springs.K_n, springs.K_s, springs.K_n_dia, 0.0
    plane = intact.plane
    for i in range(span[0], span[1]):
        row = 0.0
        for j in range(held.shape[1] - 1):
            a, b, c, e = held[i, j], held[i + 1, j], held[i, j + 1], held[i + 1, j + 1]
            if a != b or a != c or a != e:
                cell = plane[i + 1, j + 1]
                along, side = cell + plane[i + 1, j], cell + plane[i, j + 1]
                x_a, x_b, x_c, x_e = y[U_X, i, j], y[U_X, i + 1, j], y[U_X, i, j + 1], y[U_X, i + 1, j + 1]
                y_a, y_b, y_c, y_e = y[U_Y, i, j], y[U_Y, i + 1, j], y[U_Y, i, j + 1], y[U_Y, i + 1, j + 1]
                row += (a - b) * kn * along * (x_b - x_a) + (a - c) * ks * side * (x_c - x_a)
                row += kd * cell * ((a - e) * (x_e - x_a + y_e - y_a) + (c - b) * (x_b - x_c - y_b + y_c))
        total -= row
    return total


@compiled(nogil=True, borrows=True)
def sweep(motion: Motion, intact: Intact, kick: PerNode, springs: HalfSprings, pace: Pace, rows: Array) -> None:
    """One step of all nodes without external forces, in place."""
    nx, ny = kick.u.shape
    rows[CARRIED:] = 0.0
    for i in range(nx):
        connections(i, ny, motion.y, intact, springs, rows)
        gather(i, ny, motion, kick, springs.lever, pace, rows)


@compiled(nogil=True, borrows=True)
def push_within(
    span: Span, row: IntArray, column: IntArray, force: Array, motion: Motion, kick: PerNode, go: float
) -> None:
    """As `push`, on the nodes of some rows alone."""
    for k in range(len(row)):
        i, j = row[k], column[k]
        if i < span[0] or i >= span[1]:
            continue
        for c in range(5):
            share = kick.u[i, j] if c < W else kick.w[i, j] if c == W else kick.phi[i, j]
            dv = share * force[k, c]
            motion.v[c, i, j] += dv
            motion.y[c, i, j] += go * dv


@compiled(nogil=True, borrows=True)
def push(row: IntArray, column: IntArray, force: Array, motion: Motion, kick: PerNode, go: float) -> None:
    """Adds forces (k, 5) on single nodes to the step that `sweep` has just made; go = dt + alpha."""
    push_within((0, kick.u.shape[0]), row, column, force, motion, kick, go)


@compiled(nogil=True)
def unpack(motion: Motion, ago: float, ny: int, u: Array, q: Array) -> None:
    """Writes y - ago v of all nodes into u (n, 2) and q (n, 3)."""
    y, v = motion
    for n in range(len(u)):
        i, j = n // ny, n % ny
        for c in range(2):
            u[n, c] = y[c, i, j] - ago * v[c, i, j]
        for c in range(3):
            q[n, c] = y[c + 2, i, j] - ago * v[c + 2, i, j]
