"""Cells that lean: the middle plane of a sloping cell is longer than its plan, and the forces in it pull across.

The membrane strain of a cell with the slopes s_x, s_y of its deflection has, beside that of u, the part

    g = (s_x^2 / 2, s_y^2 / 2, s_x s_y)

(von Karman's strains, Timoshenko and Woinowsky-Krieger 1959, chapter 13), and its forces N per width act on the
deflection by N . s. With it blocks that turn shorten, and the arch of their thrust loses height as it goes down.

In a sub-step g is held and a strain like any other: elastic cells add its stress to what their springs carry, layered
cells ask their law for the sum. N . s is a force on nodes. What its work leaves of the energy by which the next slopes
differ is booked as ``turning``.
"""

from __future__ import annotations

from typing import NamedTuple

from lattice.compiled import compiled
from lattice.cracks.cells import TURNING
from lattice.cracks.motion import Layered, Nodes, dot
from lattice.explicit.kernels import Span
from lattice.explicit.layout import LANES, LINE, U_X, U_Y, Motion, W
from lattice.explicit.screen import Screen, membrane_sums, reached
from lattice.grid import Array, BoolArray
from lattice.varied import PLANE

Membrane = tuple[float, float, float]  #: along x and y, and shear in engineering measure
#: lines of ``OnNodes.rows``: strains, stresses, forces across the sheet and energy of a row of cells
G_X, G_Y, G_S, T_X, T_Y, T_S, P_X, P_Y, GAIN = (LINE * line for line in range(9))


@compiled(inline="always", error_model="numpy")
def membrane_stiffness(layered: Layered) -> Membrane:
    """Plane stress of an elastic cell of mean ice: of one strain, of the other one, and of shear [N/m]."""
    E, nu, h = layered.law.E, layered.law.nu, layered.plate.h
    S = E * h / (1.0 - nu * nu)
    return S, S * nu, 0.5 * E * h / (1.0 + nu)


@compiled(inline="always")
def membrane_force(x: float, y: float, s: float, S: Membrane) -> Membrane:
    """N per width with this membrane strain and `membrane_stiffness` [N/m]."""
    return S[0] * x + S[1] * y, S[0] * y + S[1] * x, S[2] * s


@compiled(inline="always")
def slopes(c: int, i: int, j: int, q: float, y: Array) -> tuple[float, float]:
    """Along x and y, of a component of y (5, rows, my) in cell (i, j)."""
    A, B, C, D = y[c, i, j], y[c, i + 1, j], y[c, i, j + 1], y[c, i + 1, j + 1]
    return (B - A + D - C) * q, (C - A + D - B) * q


@compiled(inline="always")
def slopes_in(n: int, ny: int, c: int, q: float, u: Array) -> tuple[float, float]:
    """As `slopes`, of the cell that begins at node n of u (nodes, components)."""
    A, B, C, D = u[n, c], u[n + ny, c], u[n + 1, c], u[n + ny + 1, c]
    return (B - A + D - C) * q, (C - A + D - B) * q


@compiled(inline="always")
def membrane_strain(i: int, j: int, q: float, y: Array) -> Membrane:
    """Of the displacements in the plane alone, in cell (i, j)."""
    (xx, xy), (yx, yy) = slopes(U_X, i, j, q, y), slopes(U_Y, i, j, q, y)
    return xx, yy, xy + yx


class Constants(NamedTuple):
    """What a row of elastic cells needs beside its nodes."""

    stiffness: Membrane
    alpha: float  #: material damping [s]
    ago: float  #: alpha and half a sub-step [s]
    q: float  #: 1 / 2 d [1/m]


@compiled(nogil=True, borrows=True)
def lean_row(i: int, motion: Motion, intact: Array, was: Array, constants: Constants, rows: Array) -> None:
    """New slopes of the elastic cells of row i, into ``rows``, with the strains ``was`` (3, rows, my) before.

    The energy that they gain is that of the strain half a sub-step ago, where leapfrog has a potential that is linear
    in the displacements. It is added to what the rows before have.
    """
    (y, v), (S, alpha, ago, q) = motion, constants
    for j in range(y.shape[2] - LANES):
        on = intact[i + 1, j + 1]
        (y_x, y_y, y_s), (v_x, v_y, v_s) = membrane_strain(i, j, q, y), membrane_strain(i, j, q, v)
        (s_x, s_y), (t_x, t_y) = slopes(W, i, j, q, y), slopes(W, i, j, q, v)
        s_x, s_y = s_x - alpha * t_x, s_y - alpha * t_y
        o_x, o_y, o_s = was[0, i, j], was[1, i, j], was[2, i, j]
        g_x = 0.5 * s_x * s_x if on > 0.0 else o_x
        g_y = 0.5 * s_y * s_y if on > 0.0 else o_y
        g_s = s_x * s_y if on > 0.0 else o_s
        T = membrane_force(on * g_x, on * g_y, on * g_s, S)
        N = membrane_force(on * (y_x - alpha * v_x), on * (y_y - alpha * v_y), on * (y_s - alpha * v_s), S)
        m_x, m_y, m_s = 0.5 * (g_x + o_x), 0.5 * (g_y + o_y), 0.5 * (g_s + o_s)
        mean = membrane_force(y_x - ago * v_x + m_x, y_y - ago * v_y + m_y, y_s - ago * v_s + m_s, S)
        rows[GAIN + j] += on * ((g_x - o_x) * mean[0] + (g_y - o_y) * mean[1] + (g_s - o_s) * mean[2])
        rows[G_X + j], rows[G_Y + j], rows[G_S + j] = g_x, g_y, g_s
        rows[T_X + j], rows[T_Y + j], rows[T_S + j] = T[0], T[1], T[2]
        N_x, N_y, N_s = N[0] + T[0], N[1] + T[1], N[2] + T[2]
        rows[P_X + j], rows[P_Y + j] = N_x * s_x + N_s * s_y, N_s * s_x + N_y * s_y


@compiled(nogil=True, borrows=True)
def keep_row(start: int, n: int, rows: Array, strain: Array, stress: Array, pull: Array) -> None:
    """What `lean_row` has found to the n places from ``start`` on."""
    for c in range(3):
        for j in range(n):
            strain[c, start + j] = rows[G_X + c * LINE + j]
        for j in range(n):
            stress[c, start + j] = rows[T_X + c * LINE + j]
    for c in range(2):
        for j in range(n):
            pull[c, start + j] = rows[P_X + c * LINE + j]


@compiled(nogil=True, borrows=True)
def lean_elastic(part: int, span: Span, nodes: Nodes, intact: Array, layered: Layered) -> float:
    """New slopes of the elastic cells of some rows, ``intact`` (places,) as `Intact.plane`.

    Returns the energy gained, over d^2 [J/m2].
    """
    my, lean, rows, gained = nodes.my, layered.lean, layered.nodes.rows[part], 0.0
    high, n = intact.shape[0] // my, my - LANES
    motion, plane = Motion(nodes.y.reshape(5, high, my), nodes.v.reshape(5, high, my)), intact.reshape(high, my)
    was, q = lean.strain.reshape(3, high, my), 0.5 / layered.plate.d
    constants = Constants(membrane_stiffness(layered), nodes.alpha, nodes.alpha + 0.5 * nodes.dt, q)
    rows[GAIN : GAIN + n] = 0.0
    for i in range(span[0], span[1]):
        lean_row(i, motion, plane, was, constants, rows)
        keep_row(i * my, n, rows, lean.strain, lean.stress, lean.pull)
    for j in range(n):
        gained += rows[GAIN + j]
    return gained


@compiled(nogil=True, borrows=True)
def pulls(span: Span, x: Array, y: Array, my: int, f: float, out: Array) -> None:
    """On the nodes at some places f times what the four cells around each pull with x on d/dx and with y on d/dy.

    The last place holds no cell: nodes of the first row look there.
    """
    none = len(out) - 1
    for n in range(span[0], min(span[1], my + 1)):
        left, below = n - my if n >= my else none, n - 1 if n > 0 else none
        out[n] = f * ((x[n] - x[left] + x[below] - x[none]) + (y[n] + y[left] - y[below] - y[none]))
    a = max(span[0], my + 1)
    x_here, x_left, x_below, x_far = x[a:], x[a - my :], x[a - 1 :], x[a - my - 1 :]
    y_here, y_left, y_below, y_far = y[a:], y[a - my :], y[a - 1 :], y[a - my - 1 :]
    force = out[a : span[1]]
    for n in range(len(force)):
        along, across = x_here[n] - x_left[n] + x_below[n] - x_far[n], y_here[n] + y_left[n] - y_below[n] - y_far[n]
        force[n] = f * (along + across)


@compiled(nogil=True, borrows=True)
def gather_lean(span: Span, my: int, layered: Layered) -> None:
    """Forces of cells that lean on the nodes at some places."""
    lean, f = layered.lean, 0.5 * layered.plate.d
    pulls(span, lean.stress[0], lean.stress[2], my, f, lean.force[U_X])
    pulls(span, lean.stress[2], lean.stress[1], my, f, lean.force[U_Y])
    pulls(span, lean.pull[0], lean.pull[1], my, f, lean.force[W])


@compiled(nogil=True, borrows=True)
def book_pull(part: int, span: Span, time: float, v: Array, layered: Layered) -> None:
    """Books the work of N . s on the deflection at velocities v (5, places), at some places for a time [s]."""
    a, b = span
    layered.cells.losses[part, TURNING] -= time * dot(layered.lean.force[W, a:b], v[W, a:b])


@compiled(nogil=True, borrows=True)
def overloaded_leaning(
    span: Span, motion: Motion, threshold: Array, screen: Screen, alpha: float, layered: Layered
) -> int:
    """As `screen.overloaded`, with the strains of slopes, in some rows."""
    count, d2 = 0, 2.0 * layered.plate.d
    g = layered.lean.strain.reshape(3, motion.y.shape[1], motion.y.shape[2])
    for i in range(span[0], span[1]):
        for j in range(threshold.shape[1]):
            e11, e22, e12 = membrane_sums(i, j, motion.y, motion.v, alpha)
            e = e11 + d2 * g[0, i, j], e22 + d2 * g[1, i, j], e12 + d2 * g[2, i, j]
            count += reached(i, j, e, motion, screen, alpha, threshold[i, j])
    return count


@compiled(nogil=True)
def lean_energy(ny: int, my: int, u: Array, live: BoolArray, share: Array, layered: Layered) -> float:
    """Energy by which slopes add to the springs of ``live`` (cells,) elastic cells at displacements u (nodes, 2) [J].

    Their springs in the plane are ``share`` (cells, 2) as stiff as those of mean ice, see `lattice.varied`.
    """
    q, g, total, S = 0.5 / layered.plate.d, layered.lean.strain, 0.0, membrane_stiffness(layered)
    for cell in range(live.shape[0]):
        if live[cell]:
            i, j = cell // (ny - 1), cell % (ny - 1)
            n, b = i * ny + j, i * my + j
            xx, xy = slopes_in(n, ny, 0, q, u)
            yx, yy = slopes_in(n, ny, 1, q, u)
            N = membrane_force(g[0, b], g[1, b], g[2, b], S)
            own = N[0] * (xx + 0.5 * g[0, b]) + N[1] * (yy + 0.5 * g[1, b]) + N[2] * (xy + yx + 0.5 * g[2, b])
            total += share[cell, PLANE] * own
    energy: float = layered.plate.d**2 * total
    return energy
