"""Energy of a floe in leapfrog, exactly as that has it.

Velocities lie half a sub-step before displacements. With E = H + dt v(n-1/2) . (F - C v) / 2 + dt^2 a . M a / 8 for
what leapfrog conserves, H, and elastic energy x(n) . K x(n-1) / 2 in it, books close to rounding whatever happens in a
window: where it begins and ends, where a cell fails, and where a piece leaves with the state of that instant.
"""

from __future__ import annotations

import numpy as np

from lattice.explicit.engine import ExplicitEngine
from lattice.explicit.forces import Marched, PointForces, Touch
from lattice.explicit.window import Window
from lattice.floe import Floe
from lattice.grid import BoolArray, IntArray


class BookedFloe(Floe):
    """`Floe` on the explicit engine: what its sub-steps put in and take."""

    engine: ExplicitEngine

    def _hold(self, w: Window, time: float, hold: float) -> None:
        """Books forces of held nodes along x [N] for a time [s]; what loads and contact bring to these is not held."""
        impulse = time * (hold - w.at_held)
        self.energy.hold += impulse
        w.hold += impulse

    def _book(self, w: Window, out: Marched, touch: Touch) -> None:
        """Books sub-steps that have begun with the points of the contact where ``touch`` is linear about."""
        books, time = self.energy, out.steps * self.engine.dt
        after = self.engine.touching(w.contact)
        books.touch.work += out.contact_work
        books.touch.push += time * float(out.contact[:, 0].sum())
        books.rub.add(time, books.friction_of(after, out.contact), (after - touch.at) / time)
        for load, work, push in zip(w.loads, out.work.tolist(), w.sums[:, 0].tolist(), strict=True):
            book = books.load(load.name)
            book.work += work
            book.push += time * push
        w.push += time * w.sums
        books.damping += out.loss

    def _book_half(self, part: float, w: Window, touch: Touch) -> None:
        """Work in the half sub-step by which the velocities of the march lie before the ends of a window.

        With the velocity at n a force that jumps between two windows would leave dt^2 a . F / 4.
        """
        time, f = part * self.engine.dt, touch.at_once()
        self._hold(w, time, self.engine.hold() - self.energy.on_held(f.row * w.columns + f.column, f.force))
        self._work_on(np.ones(self.grid.nodes, bool), time, w, f)

    def _work_on(self, nodes: BoolArray, time: float, w: Window, touch: PointForces) -> None:
        """Books work of contact and loads on ``nodes`` (n,) at the velocities of the march for a time [s]."""
        v, load = self.engine.get(self.engine.motion.v), w.load
        on = touch.row * w.columns + touch.column
        on, force = on[nodes[on]], touch.force[nodes[on]]
        self.energy.touch.add(time, force, v[on])
        at = load.row * w.columns + load.column
        for name, of in w.by_name():
            here = nodes[at[of]]
            self.energy.load(name).add(time, load.force[of][here], v[at[of][here]])

    def _book_left(self, left: BoolArray, w: Window, touch: Touch) -> None:
        """The half sub-step by which the march lies before the state that nodes ``left`` (n,) have taken along."""
        if not left.any():
            return
        self._work_on(left, 0.5 * self.engine.dt, w, touch.at_once())
        self.energy.scheme += self._lead(left)

    def _lead(self, nodes: BoolArray) -> float:
        """Damping in the half sub-step that the march lies before the state of ``nodes`` (n,), less `ripple` [J]."""
        cells = self.intact & nodes[self.grid.cell_nodes].all(axis=1)
        late = 0.5 * self.engine.dt * self.energy.loss_rate(self.state, cells, nodes)
        return late - self.engine.ripple(nodes)

    def _swing(self, cells: IntArray) -> float:
        """By what the springs of cells have more half a sub-step ago than x(n) . K x(n-1) / 2, leapfrog's own [J]."""
        way = 0.5 * self.engine.dt * self.engine.get(self.engine.motion.v)
        live = np.zeros(self.grid.cells, bool)
        live[cells] = True
        return self.energy.springs(np.ascontiguousarray(way[:, :2]), np.ascontiguousarray(way[:, 2:]), live)
