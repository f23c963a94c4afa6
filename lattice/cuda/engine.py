"""The explicit engine with its sub-steps on a graphics card."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import cuda

from lattice.contact import EdgeContact, lever_of
from lattice.cuda import readings
from lattice.cuda.card import Card, back, copied, over, over_nodes
from lattice.cuda.kernels import Contact, Entries, Held, Lattice, Order, dissipate, look, move, overloaded, push
from lattice.explicit.engine import ExplicitEngine
from lattice.explicit.forces import Made, PointForces, Sums, Touch
from lattice.explicit.layout import Motion
from lattice.explicit.readings import Path
from lattice.explicit.screen import Judge
from lattice.grid import Array, BoolArray


class CardPath(Path):
    """As `Path`, on the card, with the nodes in (3, n_x, n_y)."""

    def __init__(self, nx: int, ny: int):
        zeros = np.zeros((3, nx, ny))
        self.before, self.sum = copied(zeros), copied(zeros)

    def total(self) -> Array:
        """As `Path.total`."""
        return np.ascontiguousarray(back(self.sum).reshape(3, -1).T)


class CardEngine(ExplicitEngine):
    """`ExplicitEngine` whose motion is on the card while it marches.

    It comes to the host when somebody asks for `motion`, who may change it, and goes back before the next sub-step;
    what is read off between two marches is read on the card.
    """

    def __init__(self, *arguments: Any, **options: Any):
        self.card = Card()
        super().__init__(*arguments, **options)

    @property
    def motion(self) -> Motion:
        """On the host."""
        self.card.give(self._host)
        return self._host

    @motion.setter
    def motion(self, new: Motion) -> None:
        self._host = new
        self.card.drop()

    def watch(self, judge: Judge) -> None:
        """As `ExplicitEngine.watch`."""
        super().watch(judge)
        self.card.lattice = None

    def set_cells(self, live: BoolArray, limits: Array, present: BoolArray) -> None:
        """As `ExplicitEngine.set_cells`."""
        super().set_cells(live, limits, present)
        self.card.lattice = None

    # ---- what is read off between two marches -------------------------------------------------------------------

    def touching(self, contact: EdgeContact) -> Array:
        """As `ExplicitEngine.touching`."""
        height, lead = lever_of(contact)
        out = cuda.device_array((len(contact.nodes), 3))
        if len(contact.nodes):
            self._lattice()
            lists = (*np.divmod(contact.nodes, self.grid.ny), height, lead)
            at = (copied(a) for a in lists)
            readings.points[over(len(contact.nodes))](*at, self.card.motions()[0], self.alpha, out)
        return back(out)

    def path(self) -> Path:
        """As `ExplicitEngine.path`."""
        return CardPath(self.grid.nx, self.grid.ny)

    def look(self, path: Path) -> None:
        """As `ExplicitEngine.look`."""
        self._lattice()
        shape = over_nodes(self.grid.nx, self.grid.ny)
        readings.deflections[shape](self.card.motions()[0], self.alpha, path.before)

    def add_path(self, time: float, path: Path) -> None:
        """As `ExplicitEngine.add_path`."""
        self._lattice()
        shape = over_nodes(self.grid.nx, self.grid.ny)
        readings.add_path[shape](self.card.motions()[0], self.alpha, 0.5 * time, path.before, path.sum)

    # ---- sub-steps -----------------------------------------------------------------------------------------------

    def loop(self, steps: int, stride: int, load: PointForces, touch: Touch, sums: Sums) -> Made:
        """Launches all sub-steps; the card tells at the end which was the last."""
        card, lattice = self.card, self._lattice()
        entries, order = _entries(load, touch)
        held = _held(self.mesh.held[: self.grid.nx])
        contact = Contact(*(copied(getattr(touch, name)) for name in Contact._fields))
        faces, (now, after) = copied(np.zeros(steps + 1, np.int64)), card.motions()
        lists = over(entries.row.size + held.row.size), over(order.first.size - 1)
        for step in range(steps):
            book = step % stride == 0
            look[lists[0]](step, faces, now, lattice, contact, entries, held)
            move[card.grid](step, faces, now, after.y, card.before, int(book), lattice)
            now, after = after, now
            push[lists[1]](step, faces, now, lattice, entries, order)
            if book:
                dissipate[card.grid](step, faces, card.before, now.v, lattice, card.loss)
            overloaded[card.grid](step, faces, now, lattice)
        found = faces.copy_to_host()
        made = int(np.argmax(found > 0)) if found.any() else steps
        card.marched(made)
        return self._made(made, int(found[made]), load, entries, held, sums)

    def _made(self, steps: int, faces: int, load: PointForces, entries: Entries, held: Held, sums: Sums) -> Made:
        k, power = len(load.row), back(entries.power)
        sums.contact[:] += back(entries.contact)[: len(sums.contact)]
        for n in range(len(sums.work)):
            sums.work[n] += power[load.first[n] : load.first[n + 1]].sum()
        of_contact = float(power[k : k + len(sums.contact)].sum())
        return Made(steps, faces, of_contact, self.card.taken(), float(back(held.pull).sum()))

    def _lattice(self) -> Lattice:
        return self.card.take(self.mesh, self.screen, self._host)


def _entries(load: PointForces, touch: Touch) -> tuple[Entries, Order]:
    """Forces in the order of the host's loop, and by nodes."""
    row, column = np.concatenate((load.row, touch.row)), np.concatenate((load.column, touch.column))
    force = np.concatenate((load.force, np.zeros((len(touch.row), 5))))
    node = row << 32 | column
    entry = np.argsort(node, kind="stable")
    first = np.flatnonzero(np.diff(node[entry], prepend=-1, append=-1))
    zeros = np.zeros(len(row)), np.zeros((len(touch.row), 3))
    entries = Entries(*map(copied, (row, column, force, *zeros)))
    return entries, Order(copied(first), copied(entry))


def _held(on: Array) -> Held:
    row, column = np.nonzero(on)
    return Held(copied(row), copied(column), copied(np.zeros(len(row))))
