"""The sheet as a participant: joins the lattice to the structure, hands out fragments and its edge to the rubble."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from coupling import sheet_events
from coupling.compiled import compiled
from coupling.contact import ContactLaw, OverlapContact
from coupling.edge import CrushedEdge
from coupling.contact_friction import friction_part
from coupling.interface import (
    NS,
    Array,
    Event,
    Fragment,
    IntArray,
    Restore,
    SheetEdge,
    SheetForces,
    SheetReport,
    SheetView,
    SimulationError,
    Structure,
)
from coupling.yielding import oscillator
from lattice.engine import State, StepError
from lattice.memory import recall, remember
from lattice.sheet import Outcome, Sheet, edge_displacement

Motion = Callable[[IntArray], tuple[Array, Array]]  #: position (n, 3) and velocity (n, 2) of nodes

REACH = 30.0  #: length of sheet behind its edge that the rubble meets [m]


class SheetPort:
    """Lattice, edge contact and crushed edge of one floe that drifts along +x."""

    def __init__(
        self,
        sheet: Sheet,
        structure: Structure,
        law: ContactLaw,
        velocity: float,
        columns_per_section: int = 1,
        contact: type[OverlapContact] = OverlapContact,
    ):
        g, ice = sheet.grid, sheet.ice
        self.sheet, self.velocity, self.columns_per_section = sheet, velocity, columns_per_section
        self.contact = contact(structure, law, velocity, ice.h, ice.freeboard)
        self.z_mid = ice.freeboard - 0.5 * ice.h  #: middle of the floating sheet [m]
        y = np.asarray(g.y0 + np.arange(g.ny) * g.d, np.float64)
        self.ice_y = y.copy()  #: middle of each column's ice [m]
        self.ice_y[[0, -1]] += 0.25 * g.d * np.array([1.0, -1.0])
        normal = structure.normal(self.ice_y, np.full(g.ny, self.contact.touching_z))
        self.meets = np.isfinite(normal[:, 0]) & (normal[:, 0] < 0.0)  #: columns in whose way the structure stands
        with np.errstate(invalid="ignore", divide="ignore"):
            tan = np.where(self.meets, np.abs(normal[:, 0] / normal[:, 2]), 1.0)
        self.edge = CrushedEdge((g.nx, g.ny), g.d, ice.h, tan)
        self.initial_mass = ice.rho_i * ice.h * float(g.area.sum())
        self.crushed_mass = 0.0  #: crushed off the edge of nodes that have left or still stand [kg]
        #: mean power of the rubble's forces on the sheet over the last window, in the fixed frame [W]
        self.power = 0.0
        self.draft = ice.h - ice.freeboard  #: lift at which the floating sheet leaves the water [m]
        self._t, self._quiet, self._afloat = 0.0, True, True
        self._start = 0.0, sheet.state  #: time and state at the start of the last window
        self.setback = 0.0  #: distance by which the floe starts farther back than its grid [m]
        self._yielding_key: tuple[object, ...] = ()
        self._yields: list[tuple[tuple[float, float], tuple[float, float]]] = []
        self._fragments: list[Fragment] = []
        self._at_structure: list[bool] = []
        self._renew_edge()
        sheet.energy.friction_of = partial(
            friction_part, structure, law.friction, self.contact.face, self.contact.touching_z
        )

    # ---- one window -------------------------------------------------------------------------------------------

    def advance(self, t_ns: int, window_ns: int, rubble: SheetForces, rubble_load: Array) -> SheetReport:
        """Moves the sheet over a window under the rubble's mean forces; ``rubble_load`` (3,) is for the events only."""
        self._t, self._fragments, self._at_structure = t_ns / NS, [], []
        self._start = self._t, self.sheet.state
        self.sheet.set_window(window_ns / NS)
        force_u, force_q = self._forces(rubble)
        parts = self.sheet.parts
        try:
            out = self.sheet.advance(self._t, force_u, force_q, self.contact, self._release)
        except (StepError, FloatingPointError) as error:
            raise SimulationError(f"t = {self._t:.3f} s: {error}") from error
        load = -out.contact_mean.sum(axis=0)
        self._t = (t_ns + window_ns) / NS
        self.power = self._power(rubble)
        self._crush()
        events = self._events(out, parts, rubble_load) if out.failure else []
        events += self._lifted_out(rubble_load + load)
        self._quiet = not out.failed
        r = out.reaction
        budget = {
            "pressed_sheet": r.foundation,
            "drag": r.drag,
            "inertia": r.inertia,
            "held": r.held,
            "staggering": r.applied,
        }
        return SheetReport(load, self._fragments, events, budget)

    def save(self) -> Restore:
        """The sheet, its edge and its contact between two windows."""
        saved = [*remember(self), *remember(self.edge, "depth"), *remember(self.contact), *self.sheet.save()]
        return partial(recall, saved)

    def _power(self, rubble: SheetForces) -> float:
        """Power of the forces on the nodes that are still in the lattice, by their way in the window [W]."""
        on = self.sheet.present[rubble.nodes]
        _, way = self._way(rubble.nodes[on])
        return float((rubble.force[on] * way).sum()) / (self._t - self._start[0])

    def _forces(self, rubble: SheetForces) -> tuple[Array, Array]:
        """The rubble's forces on all nodes: in plane (n, 2), and w with its rotations (n, 3)."""
        n = self.sheet.grid.nodes
        force_u, force_q = np.zeros((n, 2)), np.zeros((n, 3))
        force_u[rubble.nodes, 0], force_q[rubble.nodes, 0] = rubble.force[:, 0], rubble.force[:, 2]
        return force_u, force_q

    def rest_under(self, rubble: SheetForces) -> None:
        """Starts the run in equilibrium with rubble that lies under the sheet, its edge just touching the structure."""
        try:
            self.sheet.rest_under(*self._forces(rubble))
        except StepError as error:
            raise SimulationError(f"{error}: give less initial rubble (rubble.initial_volume)") from error
        y = edge_displacement(self.sheet.state, self.contact.nodes, self.contact.height)
        overlap, _ = self.contact.overlap(0.0, y)
        self.setback += max(float(overlap.max(initial=0.0)), 0.0)
        self._start = 0.0, self.sheet.state
        self._renew_edge()

    def _release(self, nodes: IntArray) -> None:
        self._fragments.append(self._fragment(nodes))
        self._at_structure.append(bool(np.isin(nodes, self.contact.nodes).any()))
        self._renew_edge()

    def _renew_edge(self) -> None:
        """The nodes in front, after the lattice has lost some."""
        g, front = self.sheet.grid, self.sheet.front
        self.edge.set_front(front)
        column = np.flatnonzero(self.meets & (front >= 0))
        row = front[column]
        nodes = row * g.ny + column
        x_front = g.xy[nodes, 0] + self.edge.lead(row) - self.setback
        self.contact.set_edge(nodes, x_front, self.ice_y[column], self.edge.width[column])
        self.front_column = column

    def _crush(self) -> None:
        """Takes the overlapped ice off the edge, and rows of which nothing is left out of the lattice."""
        s = self.sheet.state
        n = self.contact.nodes
        if not len(n):
            return
        y = edge_displacement(s, n, self.contact.height)
        self.edge.crush(self.front_column, self.contact.settle(self._t, y))
        spent = self.edge.spent()
        if len(spent):
            nodes = self.edge.front[spent] * self.sheet.grid.ny + spent
            self.crushed_mass += float(self._ice_mass(nodes).sum())
            self.sheet.retire(nodes)
            self._renew_edge()

    # ---- ice --------------------------------------------------------------------------------------------------

    def _ice_mass(self, nodes: IntArray) -> Array:
        """Mass of nodes without crushing [kg]."""
        return self.sheet.ice.rho_i * self.sheet.ice.h * self.sheet.grid.area[nodes]

    def _crushed(self, nodes: IntArray) -> Array:
        """Mass crushed off nodes that are in the lattice [kg]."""
        row, column = np.divmod(nodes, self.sheet.grid.ny)
        return self.sheet.ice.rho_i * self.edge.width[column] * self.edge.crushed_area(row, column)

    @property
    def mass(self) -> float:
        """Ice in the lattice, without what was crushed off its edge [kg]."""
        whole = self.sheet.grid.area[self.sheet.present].sum() * self.sheet.ice.rho_i * self.sheet.ice.h
        return float(whole) - self._crushed_edge()

    @property
    def crushed(self) -> float:
        """All ice crushed off the edge so far [kg]."""
        return self.crushed_mass + self._crushed_edge()

    def _crushed_edge(self) -> float:
        """Mass crushed off the nodes that are in the lattice: those of the rows that the cuts reach [kg]."""
        column = np.flatnonzero((self.edge.depth > 0.0) & (self.edge.front >= 0))
        if not len(column):
            return 0.0
        reach = int(self.edge.depth.max() / self.sheet.grid.d) + 2
        row = self.edge.front[column, None] - np.arange(reach)
        nodes = (row * self.sheet.grid.ny + column[:, None])[row >= 0]
        return float(self._crushed(nodes[self.sheet.present[nodes]]).sum())

    def _fragment(self, nodes: IntArray) -> Fragment:
        g, s = self.sheet.grid, self.sheet.state
        row, column = np.divmod(nodes, g.ny)
        crushed = self._crushed(nodes)
        self.crushed_mass += float(crushed.sum())
        position, velocity = self._position(nodes), np.empty((len(nodes), 3))
        position[:, 1] += self.ice_y[column] - (g.y0 + column * g.d)
        velocity[:, :2], velocity[:, 2] = s.u_dot[nodes] + (self.velocity, 0.0), s.q_dot[nodes, 0]
        return Fragment(
            row=g.nx - 1 - row,
            column=column,
            mass=self._ice_mass(nodes) - crushed,
            length=self.edge.length(row),
            width=self.edge.width[column],
            lead=self.edge.lead(row),
            position=position,
            velocity=velocity,
            tilt=s.q[nodes, 1].copy(),
            tilt_rate=s.q_dot[nodes, 1].copy(),
            cut=self.edge.cut(row, column),
            cut_tan=self.edge.tan[column],
            cut_face=self.contact.face,
            thickness=self.sheet.ice.h,
        )

    def _position(self, nodes: IntArray) -> Array:
        return self._place(nodes, self.sheet.state, self._t)

    def _place(self, nodes: IntArray, s: State, t: float) -> Array:
        """Positions of nodes in a state at a time, (n, 3) [m]."""
        x, y = self.sheet.grid.xy[nodes].T
        return np.column_stack(
            (x - self.setback + self.velocity * t + s.u[nodes, 0], y + s.u[nodes, 1], self.z_mid + s.q[nodes, 0])
        )

    @property
    def energy(self) -> dict[str, float]:
        """Energy of the sheet by term, for an observer at rest [J]; see `lattice.energy` and `coupling.energy`."""
        e, v = self.sheet.energy, self.velocity
        friction, contact = e.rub.work + v * e.rub.push, e.touch.work + v * e.touch.push
        crushed = e.crushed.elastic + e.crushed.foundation + e.crushed.kinetic_at(v)
        return {
            "drift_work": v * e.hold,
            "received_work": e.others.work + v * e.others.push,
            "sheet_elastic": e.now.elastic,
            "sheet_foundation": e.now.foundation,
            "sheet_kinetic": e.now.kinetic_at(v),
            "contact_friction_loss": -friction,
            "contact_crushing_loss": friction - contact,
            "damping_loss": e.damping,
            "scheme_loss": e.scheme,
            "fracture_loss": e.fracture,
            "edge_crushed_loss": crushed,
            "left_elastic": e.pieces.elastic,
            "left_foundation": e.pieces.foundation,
            "left_kinetic": e.pieces.kinetic_at(v),
            "contact_work": e.contact,
            "rubble_work": e.rubble,
            "sheet_energy_residual": e.residual,
        }

    # ---- what others see --------------------------------------------------------------------------------------

    def edges(self, sections: Sequence[int]) -> dict[int, SheetEdge]:
        """The sheet's edge and underside in these sections, where they are and move now."""
        return self._edges(sections, self._motion)

    def path(self, sections: Sequence[int]) -> dict[int, SheetEdge]:
        """The same edges at the start of the last window, with their mean velocity over it: they end where they are.

        Without the nodes that have left in the window.
        """
        return self._edges(sections, self._mean_motion)

    def _edges(self, sections: Sequence[int], motion: Motion) -> dict[int, SheetEdge]:
        columns = {}
        for key in sections:
            first = key * self.columns_per_section
            if 0 <= first < self.sheet.grid.ny:
                front = self.edge.front[first : first + self.columns_per_section]
                if front.min() >= 0:  # the rearmost: ice beside a new block must not overlap it
                    columns[key] = first + int(np.argmin(front))
        yields = self._yielding(list(columns.values())) if columns else []
        return {key: self._edge(column, *y, motion) for (key, column), y in zip(columns.items(), yields, strict=True)}

    def _yielding(self, columns: list[int]) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """Stiffness and inertia in x and z with which the front nodes answer when all of them are pressed at once."""
        s = self.sheet
        nodes = self.edge.front[columns] * s.grid.ny + np.array(columns)
        key = s.dt, nodes.tobytes(), s.live_cells.tobytes()
        if key != self._yielding_key:
            k, m = oscillator(*s.answer(nodes), s.dt)
            self._yields = [(tuple(a), tuple(b)) for a, b in zip(k.tolist(), m.tolist(), strict=True)]
            self._yielding_key = key
        return self._yields

    def _edge(
        self, column: int, stiffness: tuple[float, float], inertia: tuple[float, float], motion: Motion
    ) -> SheetEdge:
        g, front = self.sheet.grid, int(self.edge.front[column])
        rows = np.arange(front, max(front - int(REACH / g.d) - 1, -1), -1)
        present = self.sheet.present[rows * g.ny + column]
        rows = rows[: int(np.argmin(present))] if not present.all() else rows
        nodes = rows * g.ny + column
        position, velocity = motion(nodes)
        self._check_apart(position)
        lead = float(self.edge.lead(rows[:1])[0])
        return SheetEdge(
            position[:, 0],
            position[:, 2],
            float(position[0, 0]) + lead,
            velocity,
            self.sheet.ice.h,
            nodes,
            stiffness,
            inertia,
        )

    def _motion(self, nodes: IntArray) -> tuple[Array, Array]:
        """Position (n, 3) [m] and velocity in x and z (n, 2) [m/s] of nodes now."""
        s = self.sheet.state
        return self._position(nodes), np.column_stack((s.u_dot[nodes, 0] + self.velocity, s.q_dot[nodes, 0]))

    def _mean_motion(self, nodes: IntArray) -> tuple[Array, Array]:
        """The same at the start of the last window, and on average over it."""
        begin, way = self._way(nodes)
        return begin, (way / (self._t - self._start[0]))[:, ::2]

    def _way(self, nodes: IntArray) -> tuple[Array, Array]:
        """Where nodes were at the start of the last window, and how far they have come in it, (n, 3) both [m]."""
        t, state = self._start
        begin = self._place(nodes, state, t)
        return begin, self._position(nodes) - begin

    def _check_apart(self, position: Array) -> None:
        """Refuses rows (m, 3), front first, of which one has passed the next."""
        passed = np.flatnonzero(np.diff(position[:, 0]) >= 0.0)
        if len(passed):
            x, y = position[passed[0], :2]
            raise SimulationError(
                f"t = {self._t:.3f} s: parts of the floe overlap by a cell at x = {x:.2f}, "
                f"y = {y:.2f} m, because cracks carry no pressure between parts that stay in the "
                "lattice; use a larger floe, so that a free part of it becomes rubble"
            )

    def view(self) -> SheetView:
        """Positions, damage and utilisation for observers."""
        g, live = self.sheet.grid, self.sheet.live_cells
        damage, utilisation = _at_nodes(g.cell_nodes, g.nodes, self.sheet.intact, live, self.sheet.utilisation)
        return SheetView(
            self._position(np.arange(g.nodes)),
            damage,
            utilisation,
            self.sheet.present.copy(),
            live,
            (g.nx, g.ny),
            (g.nx - 1, g.ny - 1),
        )

    # ---- events -----------------------------------------------------------------------------------------------

    def _events(self, out: Outcome, parts_before: int, rubble_load: Array) -> list[Event]:
        """Events of a window in which cells failed, with the time of the first failure and the load then."""
        assert out.failure is not None
        t_ns, load, cells = round(out.failure[0] * NS), rubble_load - out.failure[1].sum(axis=0), len(out.failed)
        events = []
        if cells:
            where = self._position(self.sheet.grid.cell_nodes[out.failed].ravel()).mean(axis=0)
            parts = out.parts if out.parts > parts_before else None
            events += sheet_events.failures(t_ns, load, cells, where, parts, self._quiet)
        for fragment, at_structure in zip(self._fragments, self._at_structure, strict=True):
            events += sheet_events.departure(t_ns, load, cells, fragment, at_structure)
        return events

    def _lifted_out(self, load: Array) -> list[Event]:
        """One event of a run, when the sheet first leaves the water."""
        w = np.where(self.sheet.present, self.sheet.state.q[:, 0], 0.0)
        highest = int(np.argmax(w))
        if not self._afloat or w[highest] <= self.draft:
            return []
        self._afloat = False
        where = self._position(np.array([highest]))[0]
        return [sheet_events.lifted_out(round(self._t * NS), load, where, float(w[highest]), self.draft)]


@compiled()
def _at_nodes(cell_nodes, nodes, intact, live, utilisation):
    """Share of failed cells and largest utilisation of live ones around each node, (nodes,) both."""
    every, failed, worst = np.zeros(nodes), np.zeros(nodes), np.zeros(nodes)
    for c in range(cell_nodes.shape[0]):
        for n in cell_nodes[c]:
            every[n] += 1.0
            if not intact[c]:
                failed[n] += 1.0
            if live[c] and utilisation[c] > worst[n]:
                worst[n] = utilisation[c]
    return failed / every, worst
