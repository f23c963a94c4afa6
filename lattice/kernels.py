"""Explicit leapfrog of the whole lattice, five degrees of freedom per node, in compiled loops.

    v(n+1/2) = v(n-1/2) + dt / M (F - K (x + alpha v) - foundation),   x(n+1) = x(n) + dt v(n+1/2)

Spring forces and material damping alpha K v (2.27) act on the same differences, so the loops carry the *effective*
displacement y = x + alpha v and never x itself: y(n+1) = y(n) + (dt + alpha) v(n+1/2) - alpha v(n-1/2).

Two passes over each row of nodes: first the force of every connection that starts there (each once), then every node
gathers its own. Both run along j without a branch. What one pass leaves for the other lies in ``rows``, one flat
array with lines at a constant distance: only then can the compiler prove that they do not overlap, and use its
widest vectors. Broken cells have the weight 0; an axial connection carries the mean weight of its two cells.

Arrays, all padded so that no node needs a special case, with every row at the start of a cache line: n_y below is
rounded up to whole `LANES`, m_y is n_y + `LANES`.

=========  ====================  ==========================================================================
``y, v``   (5, n_x+1, m_y)       u_x, u_y, w, phi_x, phi_y; zero on the padding and on nodes that have left
``intact`` (n_x+1, m_y)          1 or 0, cell (i, j) at [i+1, j+1]; zero all around
``kick``   (3, n_x, n_y)         dt / mass of in-plane motion, of w, of the rotations; zero where held
``limit``  (n_x, n_y)            threshold of `overloaded` for cell (i, j), infinite where there is none
``spring`` (8,)                  half the constants K_n, K_s, K_out, G_r, G_t, K_n_dia, G_dia, and d/2
``pace``   (4,)                  alpha, dt + alpha, dt k_f / (rho h), dt (c - alpha k_f) / (rho h)
``crack``  (2,)                  F_1 of (4.6), and the fibre h/2 sigma_t / sigma_f
=========  ====================  ==========================================================================
"""

from __future__ import annotations

import math

from lattice.compiled import compiled

LANES = 8  #: doubles in the widest vector
LINE = 1048  #: distance of the lines of ``rows``: an odd number of cache lines, so that they use all sets of a cache
LINES = 19  #: 14 connection forces, 5 sums that a row leaves for the next one; each begins after LANES zeros
NX, SX, QX, BX, TX, NY, SY, QY, BY, TY, D1, D2, G1, G2, C0, C1, C2, C3, C4 = (k * LINE + LANES for k in range(LINES))

A1, A2, A3 = "float64[::1]", "float64[:, ::1]", "float64[:, :, ::1]"
I1 = "int64[::1]"


@compiled(f"void(int64, int64, {A3}, {A2}, {A1}, {A1})", nogil=True)
def connections(i, ny, y, intact, spring, rows):
    """Forces of the connections from row i along x, along y and along both diagonals, (2.2)-(2.5) and chapter 3."""
    kn, ks, ko, gr, gt = spring[0], spring[1], spring[2], spring[3], spring[4]
    kd, gd, half = spring[5], spring[6], spring[7]
    for j in range(ny):
        cell = intact[i + 1, j + 1]
        x, z = cell + intact[i + 1, j], cell + intact[i, j + 1]
        a0, a1, a2, a3, a4 = y[0, i, j], y[1, i, j], y[2, i, j], y[3, i, j], y[4, i, j]
        b0, b1, b2, b3, b4 = y[0, i + 1, j], y[1, i + 1, j], y[2, i + 1, j], y[3, i + 1, j], y[4, i + 1, j]
        c0, c1, c2, c3, c4 = y[0, i, j + 1], y[1, i, j + 1], y[2, i, j + 1], y[3, i, j + 1], y[4, i, j + 1]
        e0, e1, e3, e4 = y[0, i + 1, j + 1], y[1, i + 1, j + 1], y[3, i + 1, j + 1], y[4, i + 1, j + 1]
        rows[NX + j] = kn * x * (b0 - a0)
        rows[SX + j] = ks * x * (b1 - a1)
        rows[QX + j] = ko * x * (b2 - a2 + half * (a3 + b3))
        rows[BX + j] = gr * x * (b3 - a3)
        rows[TX + j] = gt * x * (b4 - a4)
        rows[NY + j] = kn * z * (c1 - a1)
        rows[SY + j] = ks * z * (c0 - a0)
        rows[QY + j] = ko * z * (c2 - a2 + half * (a4 + c4))
        rows[BY + j] = gr * z * (c4 - a4)
        rows[TY + j] = gt * z * (c3 - a3)
        rows[D1 + j] = kd * cell * (e0 - a0 + e1 - a1)
        rows[D2 + j] = kd * cell * (b0 - c0 - b1 + c1)
        rows[G1 + j] = gd * cell * (e3 - a3 + e4 - a4)
        rows[G2 + j] = gd * cell * (b3 - c3 - b4 + c4)


@compiled(f"void(int64, int64, {A3}, {A3}, {A3}, {A1}, {A1}, {A1})", nogil=True)
def gather(i, ny, y, v, kick, spring, pace, rows):
    """Every node of row i sums its connections and moves; what row i + 1 gets from them is left in C0 to C4."""
    half, alpha, go, buoy, drag = spring[7], pace[0], pace[1], pace[2], pace[3]
    for j in range(ny):
        f = rows[C0 + j] + rows[NX + j] + rows[SY + j] - rows[SY + j - 1] + rows[D1 + j] + rows[D2 + j - 1]
        rows[C0 + j] = -rows[NX + j] - rows[D1 + j - 1] - rows[D2 + j]
        old = v[0, i, j]
        v[0, i, j] = old + kick[0, i, j] * f
        y[0, i, j] += go * v[0, i, j] - alpha * old
    for j in range(ny):
        f = rows[C1 + j] + rows[SX + j] + rows[NY + j] - rows[NY + j - 1] + rows[D1 + j] - rows[D2 + j - 1]
        rows[C1 + j] = -rows[SX + j] - rows[D1 + j - 1] + rows[D2 + j]
        old = v[1, i, j]
        v[1, i, j] = old + kick[0, i, j] * f
        y[1, i, j] += go * v[1, i, j] - alpha * old
    for j in range(ny):
        f = rows[C2 + j] + rows[QX + j] + rows[QY + j] - rows[QY + j - 1]
        rows[C2 + j] = -rows[QX + j]
        old = v[2, i, j]
        v[2, i, j] = old + kick[1, i, j] * f - buoy * y[2, i, j] - drag * old
        y[2, i, j] += go * v[2, i, j] - alpha * old
    for j in range(ny):
        f = rows[C3 + j] + rows[BX + j] + rows[TY + j] - rows[TY + j - 1] + rows[G1 + j] + rows[G2 + j - 1]
        f -= half * rows[QX + j]
        rows[C3 + j] = -rows[BX + j] - rows[G1 + j - 1] - rows[G2 + j] - half * rows[QX + j]
        old = v[3, i, j]
        v[3, i, j] = old + kick[2, i, j] * f
        y[3, i, j] += go * v[3, i, j] - alpha * old
    for j in range(ny):
        f = rows[C4 + j] + rows[TX + j] + rows[BY + j] - rows[BY + j - 1] + rows[G1 + j] - rows[G2 + j - 1]
        f -= half * (rows[QY + j] + rows[QY + j - 1])
        rows[C4 + j] = -rows[TX + j] - rows[G1 + j - 1] + rows[G2 + j]
        old = v[4, i, j]
        v[4, i, j] = old + kick[2, i, j] * f
        y[4, i, j] += go * v[4, i, j] - alpha * old


@compiled(f"void({A3}, {A3}, {A2}, {A3}, {A1}, {A1}, {A1})", nogil=True)
def sweep(y, v, intact, kick, spring, pace, rows):
    """One step of all nodes without external forces, in place."""
    nx, ny = kick.shape[1], kick.shape[2]
    rows[14 * LINE :] = 0.0
    for i in range(nx):
        connections(i, ny, y, intact, spring, rows)
        gather(i, ny, y, v, kick, spring, pace, rows)


@compiled(f"int64({A3}, {A3}, {A2}, {A1}, float64)", nogil=True)
def overloaded(y, v, limit, crack, alpha):
    """How many faces of cells reach F_1 mean + R >= limit, (4.6) with (4.17)-(4.20); what is not a number counts.

    Strains are left as sums of node differences, 4 d times those of `criteria.cell_strains`; so is ``limit``.
    """
    f, fibre, count = crack[0], crack[1], 0
    for i in range(limit.shape[0]):
        for j in range(limit.shape[1]):
            d0x = y[0, i + 1, j + 1] - y[0, i, j] - alpha * (v[0, i + 1, j + 1] - v[0, i, j])
            d0y = y[1, i + 1, j + 1] - y[1, i, j] - alpha * (v[1, i + 1, j + 1] - v[1, i, j])
            d1x = y[0, i + 1, j] - y[0, i, j + 1] - alpha * (v[0, i + 1, j] - v[0, i, j + 1])
            d1y = y[1, i + 1, j] - y[1, i, j + 1] - alpha * (v[1, i + 1, j] - v[1, i, j + 1])
            r0x = y[3, i + 1, j + 1] - y[3, i, j] - alpha * (v[3, i + 1, j + 1] - v[3, i, j])
            r0y = y[4, i + 1, j + 1] - y[4, i, j] - alpha * (v[4, i + 1, j + 1] - v[4, i, j])
            r1x = y[3, i + 1, j] - y[3, i, j + 1] - alpha * (v[3, i + 1, j] - v[3, i, j + 1])
            r1y = y[4, i + 1, j] - y[4, i, j + 1] - alpha * (v[4, i + 1, j] - v[4, i, j + 1])
            e11, e22, e12 = d0x + d1x, d0y - d1y, d0y + d1y + d0x - d1x
            k11, k22, k12 = fibre * (r0x + r1x), fibre * (r0y - r1y), fibre * (r0y + r1y + r0x - r1x)
            mean, bend = e11 + e22, k11 + k22
            top = f * (mean + bend) + math.sqrt((e11 - e22 + k11 - k22) ** 2 + (e12 + k12) ** 2)
            bottom = f * (mean - bend) + math.sqrt((e11 - e22 - k11 + k22) ** 2 + (e12 - k12) ** 2)
            count += int(not top < limit[i, j]) + int(not bottom < limit[i, j])
    return count


@compiled(f"void({I1}, {I1}, {A2}, {A3}, {A3}, {A3}, float64)", nogil=True)
def push(row, column, force, y, v, kick, go):
    """Adds forces (k, 5) on single nodes to the step that `sweep` has just made; go = dt + alpha."""
    for k in range(len(row)):
        i, j = row[k], column[k]
        for c in range(5):
            dv = kick[max(0, min(c - 1, 2)), i, j] * force[k, c]
            v[c, i, j] += dv
            y[c, i, j] += go * dv
