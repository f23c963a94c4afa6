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

from lattice.compiled import compiled
from lattice.cracks.cells import M_G, M_N, M_T, N_G, N_N, N_T, TURNING, resultants, tangent_energy
from lattice.cracks.kinematics import Strain, gradients, leaned, strain_of, turned, turned_back
from lattice.cracks.motion import Layered, Nodes
from lattice.explicit.layout import U_X, U_Y, Motion, PerNode, W
from lattice.explicit.screen import Screen, membrane_sums, reached
from lattice.grid import Array

Membrane = tuple[float, float, float]  #: along x and y, and shear in engineering measure


@compiled(inline="always")
def membrane_force(e: Membrane, layered: Layered) -> Membrane:
    """N per width of an elastic cell of mean ice with this membrane strain, plane stress [N/m]."""
    E, nu, h = layered.law.E, layered.law.nu, layered.plate.h
    S = E * h / (1.0 - nu * nu)
    return S * (e[0] + nu * e[1]), S * (e[1] + nu * e[0]), 0.5 * E * h / (1.0 + nu) * e[2]


@compiled(inline="always")
def later(e: Strain, rate: Strain, t: float) -> Strain:
    """The strain after a time t [s] at this rate."""
    return Strain(
        e.n + t * rate.n,
        e.t + t * rate.t,
        e.g + t * rate.g,
        e.kn + t * rate.kn,
        e.kt + t * rate.kt,
        e.kg + t * rate.kg,
    )


@compiled(inline="always")
def slopes(b: int, q: float, nodes: Nodes) -> tuple[float, float]:
    """Of the cell at b, by x = y - alpha v."""
    s_x, s_y, _ = gradients(b, nodes.my, q, nodes.y[W])
    t_x, t_y, _ = gradients(b, nodes.my, q, nodes.v[W])
    return s_x - nodes.alpha * t_x, s_y - nodes.alpha * t_y


@compiled(nogil=True)
def lean_elastic(nodes: Nodes, intact: Array, layered: Layered) -> None:
    """New slopes of elastic cells; ``intact`` (places,) as `Intact.plane`.

    The energy that they gain is that of the strain half a sub-step ago, where leapfrog has a potential that is linear
    in the displacements.
    """
    my, q, lean = nodes.my, 0.5 / layered.plate.d, layered.lean
    ago = nodes.alpha + 0.5 * nodes.dt
    for b in range(intact.shape[0] - my - 1):
        on = intact[b + my + 1]
        s_x, s_y = slopes(b, q, nodes)
        y, _ = strain_of(b, my, q, nodes.y)
        v, _ = strain_of(b, my, q, nodes.v)
        o_x, o_y, o_s = lean.strain[0, b], lean.strain[1, b], lean.strain[2, b]
        g_x = 0.5 * s_x * s_x if on > 0.0 else o_x
        g_y = 0.5 * s_y * s_y if on > 0.0 else o_y
        g_s = s_x * s_y if on > 0.0 else o_s
        T = membrane_force((g_x, g_y, g_s), layered)
        flat = membrane_force((y.n - nodes.alpha * v.n, y.t - nodes.alpha * v.t, y.g - nodes.alpha * v.g), layered)
        m_x, m_y, m_s = 0.5 * (g_x + o_x), 0.5 * (g_y + o_y), 0.5 * (g_s + o_s)
        mean = membrane_force((y.n - ago * v.n + m_x, y.t - ago * v.t + m_y, y.g - ago * v.g + m_s), layered)
        lean.gained[b] = on * ((g_x - o_x) * mean[0] + (g_y - o_y) * mean[1] + (g_s - o_s) * mean[2])
        lean.strain[0, b], lean.strain[1, b], lean.strain[2, b] = g_x, g_y, g_s
        lean.stress[0, b], lean.stress[1, b], lean.stress[2, b] = on * T[0], on * T[1], on * T[2]
        N_x, N_y, N_s = on * (flat[0] + T[0]), on * (flat[1] + T[1]), on * (flat[2] + T[2])
        lean.pull[0, b], lean.pull[1, b] = N_x * s_x + N_s * s_y, N_s * s_x + N_y * s_y


@compiled(nogil=True)
def lean_layered(nodes: Nodes, layered: Layered) -> None:
    """The same for layered cells, by their tangents."""
    my, q, cracks, lean = nodes.my, 0.5 / layered.plate.d, layered.cells, layered.lean
    half = 0.5 * nodes.dt
    for k in range(layered.used):
        b, c, s = cracks.corner[k], cracks.axis[0, k], cracks.axis[1, k]
        s_x, s_y = slopes(b, q, nodes)
        y, _ = strain_of(b, my, q, nodes.y)
        v, _ = strain_of(b, my, q, nodes.v)
        x = later(y, v, -nodes.alpha)
        way, old = turned(v, c, s), turned(leaned(x, b, lean.strain, 1.0), c, s)
        lean.strain[0, b], lean.strain[1, b], lean.strain[2, b] = 0.5 * s_x * s_x, 0.5 * s_y * s_y, s_x * s_y
        new = turned(leaned(x, b, lean.strain, 1.0), c, s)
        was, N = resultants(k, old, 1.0, cracks), resultants(k, new, 1.0, cracks)
        gained = tangent_energy(k, new, cracks) - tangent_energy(k, old, cracks)
        gained -= half * ((N[N_N] - was[N_N]) * way.n + (N[N_T] - was[N_T]) * way.t + (N[N_G] - was[N_G]) * way.g)
        gained -= half * ((N[M_N] - was[M_N]) * way.kn + (N[M_T] - was[M_T]) * way.kt + (N[M_G] - was[M_G]) * way.kg)
        lean.gained[b] = gained
        N_x, N_y, N_s = turned_back(N[N_N], N[N_T], N[N_G], c, s)
        lean.pull[0, b], lean.pull[1, b] = N_x * s_x + N_s * s_y, N_s * s_x + N_y * s_y


@compiled(inline="always")
def pulls(n: int, x: Array, y: Array, left: int, below: int, corner: int) -> float:
    """On node n of the four cells around it that pull with x on d/dx and with y on d/dy; the others' places."""
    along: float = x[n] - x[left] + x[below] - x[corner]
    across: float = y[n] + y[left] - y[below] - y[corner]
    return along + across


@compiled(nogil=True)
def gather_lean(my: int, layered: Layered) -> None:
    """Forces of cells that lean on their nodes. The last place holds no cell: nodes of the first row look there."""
    lean, f, force = layered.lean, 0.5 * layered.plate.d, layered.lean.force
    none = force.shape[1] - 1
    for c in range(3):
        x = lean.stress[0] if c == U_X else lean.stress[2] if c == U_Y else lean.pull[0]
        y = lean.stress[2] if c == U_X else lean.stress[1] if c == U_Y else lean.pull[1]
        for n in range(my + 1):
            force[c, n] = f * pulls(n, x, y, n - my if n >= my else none, n - 1 if n > 0 else none, none)
        for n in range(my + 1, x.shape[0]):
            force[c, n] = f * pulls(n, x, y, n - my, n - 1, n - my - 1)


@compiled(nogil=True)
def look_at_slopes(nodes: Nodes, intact: Array, layered: Layered) -> None:
    """New slopes of all cells, and the forces on nodes that come with them."""
    lean_elastic(nodes, intact, layered)
    lean_layered(nodes, layered)
    gather_lean(nodes.my, layered)
    gained = 0.0
    for each in layered.lean.gained:
        gained += each
    layered.cells.losses[TURNING] -= layered.plate.d**2 * gained


@compiled(nogil=True)
def book_pull(time: float, v: Array, layered: Layered) -> None:
    """Books the work of N . s on the deflection at velocities v (5, places) for a time [s]."""
    power, force = 0.0, layered.lean.force
    for n in range(force.shape[1]):
        power += force[W, n] * v[W, n]
    layered.cells.losses[TURNING] -= time * power


@compiled(nogil=True)
def lean_on(motion: Motion, kick: PerNode, go: float, force: Array) -> None:
    """Adds the forces of `gather_lean` to a sub-step that has been made."""
    y, v, f = motion.y, motion.v, force.reshape(3, motion.y.shape[1], motion.y.shape[2])
    nx, ny = kick.u.shape
    for c in range(3):
        mobility = kick.w if c == W else kick.u
        for i in range(nx):
            for j in range(ny):
                dv = mobility[i, j] * f[c, i, j]
                v[c, i, j] += dv
                y[c, i, j] += go * dv


@compiled(nogil=True)
def overloaded_leaning(motion: Motion, threshold: Array, screen: Screen, alpha: float, layered: Layered) -> int:
    """As `screen.overloaded`, with the strains of slopes."""
    count, d2 = 0, 2.0 * layered.plate.d
    g = layered.lean.strain.reshape(3, motion.y.shape[1], motion.y.shape[2])
    for i in range(threshold.shape[0]):
        for j in range(threshold.shape[1]):
            e11, e22, e12 = membrane_sums(i, j, motion.y, motion.v, alpha)
            e = e11 + d2 * g[0, i, j], e22 + d2 * g[1, i, j], e12 + d2 * g[2, i, j]
            count += reached(i, j, e, motion, screen, alpha, threshold[i, j])
    return count


@compiled(nogil=True)
def lean_energy(my: int, u: Array, live: Array, layered: Layered) -> float:
    """Energy by which slopes add to the springs of elastic cells at displacements u (2, places) [J].

    ``live`` (places,) is as `Intact.plane` at the cells that are counted, else 0.
    """
    q, g, total = 0.5 / layered.plate.d, layered.lean.strain, 0.0
    for b in range(live.shape[0]):
        if live[b] > 0.0:
            xx, xy, _ = gradients(b, my, q, u[0])
            yx, yy, _ = gradients(b, my, q, u[1])
            N = membrane_force((g[0, b], g[1, b], g[2, b]), layered)
            own = N[0] * (xx + 0.5 * g[0, b]) + N[1] * (yy + 0.5 * g[1, b]) + N[2] * (xy + yx + 0.5 * g[2, b])
            total += live[b] * own
    energy: float = layered.plate.d**2 * total
    return energy
