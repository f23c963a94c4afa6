"""A sub-step on the card: `explicit.march.march`, kernel after kernel.

Each kernel is one pass over all nodes or all points; the card makes them one after the other, and the host waits for
none. A sub-step at whose end a cell is overloaded is the last one: ``faces[s]`` tells how many faces had reached their
limit before sub-step s, and where it is not 0 a kernel does nothing.

A node is written by its own thread only and sums add up in a fixed order, so that a run repeats itself to the last bit.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from numba import cuda

from lattice.cuda.law import at_node, force, membrane_sums, point, power_of_springs, reached
from lattice.explicit.layout import PHI_X, U_X, HalfSprings, Intact, Motion, Pace, PerNode, W
from lattice.explicit.screen import Screen
from lattice.grid import Array, IntArray


class Lattice(NamedTuple):
    """What of `explicit.layout.Mesh` is on the card."""

    intact: Intact
    kick: PerNode
    mass: Array  #: (n_x, n_y) of the deflection [kg]
    threshold: Array  #: (n_x, n_y)
    screen: Screen
    springs: HalfSprings
    pace: Pace


class Entries(NamedTuple):
    """Forces on single nodes: those of the loads, load after load, then those of the contact."""

    row: IntArray  #: (k + m,)
    column: IntArray  #: (k + m,)
    force: Array  #: (k + m, 5) [N], [N m]; that of the contact changes in each sub-step
    power: Array  #: (k + m,) sum over the sub-steps [W]
    contact: Array  #: (m, 3) sum over the sub-steps [N]


class Contact(NamedTuple):
    """What of `explicit.forces.Touch` is on the card, (m, ...) each."""

    height: Array
    lead: Array
    at: Array
    force: Array
    tangent: Array


class Order(NamedTuple):
    """Which entries push a node, node after node."""

    first: IntArray  #: (nodes + 1,)
    entry: IntArray  #: (k + m,)


class Held(NamedTuple):
    """Nodes that are held along x."""

    row: IntArray  #: (h,)
    column: IntArray  #: (h,)
    pull: Array  #: (h,) sum over the sub-steps of what the springs need [N]


def kernel(function: Callable[..., Any]) -> Any:
    """A kernel of the card."""
    return cuda.jit(function)


@kernel
def look(
    step: int, faces: IntArray, motion: Motion, lattice: Lattice, touch: Contact, entries: Entries, held: Held
) -> None:
    """Before a sub-step, a thread for each entry and then each held node: contact, half the power, pull."""
    e, n = cuda.grid(1), entries.row.size
    if faces[step] > 0 or e >= n + held.row.size:
        return
    if e >= n:
        at = e - n
        held.pull[at] -= force(held.row[at], held.column[at], motion.y, lattice.intact, lattice.springs)[U_X]
        return
    i, j, k = entries.row[e], entries.column[e], e - (n - touch.height.size)
    if k >= 0:
        height, lead = touch.height[k], touch.lead[k]
        now = point(i, j, height, lead, motion, lattice.pace.alpha)
        for a in range(3):
            pressed = touch.force[k, a]
            for b in range(3):
                pressed += touch.tangent[k, a, b] * (now[b] - touch.at[k, b])
            entries.force[e, a] = pressed
            entries.contact[k, a] += pressed
        entries.force[e, PHI_X] = height * entries.force[e, 0] - lead * entries.force[e, W]
        entries.force[e, PHI_X + 1] = height * entries.force[e, 1]
    for c in range(5):
        entries.power[e] += 0.5 * entries.force[e, c] * motion.v[c, i, j]


@kernel
def move(step: int, faces: IntArray, motion: Motion, after: Array, before: Array, book: int, lattice: Lattice) -> None:
    """All nodes of a sub-step without forces from outside: v in place, y into ``after``; keeps v in ``before``."""
    j, i = cuda.grid(2)
    nx, ny = lattice.mass.shape
    if faces[step] > 0 or i >= nx or j >= ny:
        return
    pace, kick, y, v = lattice.pace, lattice.kick, motion.y, motion.v
    f, x = force(i, j, y, lattice.intact, lattice.springs), at_node(i, j, y)
    kicks = (kick.u[i, j], kick.u[i, j], kick.w[i, j], kick.phi[i, j], kick.phi[i, j])
    for c in range(5):
        old = v[c, i, j]
        new = old + kicks[c] * f[c]
        if c == W:
            new = new - pace.buoy * x[c] - pace.drag * old
        v[c, i, j] = new
        after[c, i, j] = x[c] + (pace.go * new - pace.alpha * old)
        if book:
            before[c, i, j] = old


@kernel
def push(step: int, faces: IntArray, motion: Motion, lattice: Lattice, entries: Entries, order: Order) -> None:
    """A thread for each node that is pushed: its entries one after the other, then half their power."""
    n = cuda.grid(1)
    if faces[step] > 0 or n >= order.first.size - 1:
        return
    kick, go, y, v = lattice.kick, lattice.pace.go, motion.y, motion.v
    for k in range(order.first[n], order.first[n + 1]):
        e = order.entry[k]
        i, j = entries.row[e], entries.column[e]
        kicks = (kick.u[i, j], kick.u[i, j], kick.w[i, j], kick.phi[i, j], kick.phi[i, j])
        for c in range(5):
            dv = kicks[c] * entries.force[e, c]
            v[c, i, j] += dv
            y[c, i, j] += go * dv
    for k in range(order.first[n], order.first[n + 1]):
        e = order.entry[k]
        for c in range(5):
            entries.power[e] += 0.5 * entries.force[e, c] * v[c, entries.row[e], entries.column[e]]


@kernel
def dissipate(step: int, faces: IntArray, before: Array, v: Array, lattice: Lattice, loss: Array) -> None:
    """Adds what damping took in a sub-step at each node, (n_x, n_y) [J]; as `explicit.march.dissipated`."""
    j, i = cuda.grid(2)
    nx, ny = lattice.mass.shape
    if faces[step] > 0 or i >= nx or j >= ny:
        return
    pace, old = lattice.pace, before[W, i, j]
    water = (pace.drag + pace.alpha * pace.buoy) * lattice.mass[i, j] * old * (0.5 * (old + v[W, i, j]))
    springs = power_of_springs(i, j, before, v, lattice.intact, lattice.springs)
    loss[i, j] += water + (pace.go - pace.alpha) * pace.alpha * springs


@kernel
def overloaded(step: int, faces: IntArray, motion: Motion, lattice: Lattice) -> None:
    """Counts faces at or past their limit at the end of a sub-step; as `explicit.screen.overloaded`."""
    j, i = cuda.grid(2)
    nx, ny = lattice.threshold.shape
    if i >= nx or j >= ny:
        return
    if faces[step] > 0:
        if i == 0 and j == 0:
            faces[step + 1] = faces[step]
        return
    alpha = lattice.pace.alpha
    e = membrane_sums(i, j, motion.y, motion.v, alpha)
    count = reached(i, j, e, motion, lattice.screen, alpha, lattice.threshold[i, j])
    if count > 0:
        cuda.atomic.add(faces, step + 1, count)


@kernel
def fold(loss: Array, sums: Array) -> None:
    """Sums of the columns of ``loss`` (n_x, n_y), which become 0, into (n_y,)."""
    j = cuda.grid(1)
    if j < sums.size:
        total = 0.0
        for i in range(loss.shape[0]):
            total += loss[i, j]
            loss[i, j] = 0.0
        sums[j] = total
