"""The sheet as a participant: one window of it, and what it gives to others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from coupling.contact import ContactLaw, OverlapContact
from coupling.contact_friction import friction_part
from coupling.interface import (
    NS,
    Array,
    ContactForces,
    Fragment,
    IntArray,
    Load,
    Restore,
    SheetEdge,
    SheetForces,
    SheetMotion,
    SheetReport,
    SheetView,
    SimulationError,
    Structure,
)
from coupling.sheet_port.energy import RUBBLE, energy_terms
from coupling.sheet_port.fragments import fragment
from coupling.sheet_port.front import Front
from coupling.sheet_port.motion import Motion
from coupling.sheet_port.underside import Underside
from coupling.sheet_port.view import view
from coupling.sheet_port.watch import Watch
from lattice.floe import Floe
from lattice.loads import NodeLoad
from lattice.memory import recall, remember
from lattice.state import StepError


class SheetPort:
    """Lattice, front and underside of one floe that drifts along +x: a `SheetParticipant`."""

    def __init__(
        self,
        sheet: Floe,
        structure: Structure,
        law: ContactLaw,
        velocity: float,
        columns_per_section: int = 1,
        contact: type[OverlapContact] = OverlapContact,
        loads: Sequence[Load] = (),
    ):
        """``velocity`` of the drift [m/s]; ``contact`` makes the contact of the edge from the ``law``.

        ``loads`` act on the sheet beside structure and rubble, each under a name of its own.
        """
        ice = sheet.ice
        self.sheet, self.loads = sheet, tuple(loads)
        self.contact = contact(structure, law, velocity, ice.h, ice.freeboard)
        self.motion = Motion(sheet, velocity)
        self.front = Front(sheet, self.motion, structure, self.contact)
        self.underside = Underside(sheet, self.motion, self.front.edge, columns_per_section)
        self.watch = Watch(sheet, self.motion)
        self.initial_mass = ice.rho_i * ice.h * float(sheet.grid.area.sum())
        #: mean power of the rubble's forces on the sheet over the last window, in the fixed frame [W]
        self.power = 0.0
        self._left: list[tuple[Fragment, bool]] = []  #: in this window; whether at the structure
        sheet.energy.friction_of = partial(
            friction_part, structure, law.friction, self.contact.face, self.contact.touching_z
        )

    # ---- one window -------------------------------------------------------------------------------------------

    def advance(self, t_ns: int, window_ns: int, rubble: SheetForces, rubble_load: Array) -> SheetReport:
        """Moves the sheet over a window under the rubble's mean forces; ``rubble_load`` (3,) is for the events only."""
        t, self._left = t_ns / NS, []
        self.motion.begin(t)
        self.sheet.set_window(window_ns / NS)
        parts = self.sheet.parts
        try:
            out = self.sheet.advance(t, [self._rubble(rubble), *self._others(t)], self.contact, self._release)
        except (StepError, FloatingPointError) as error:
            raise SimulationError(f"t = {t:.3f} s: {error}") from error
        load = -out.contact_mean.sum(axis=0)
        self.motion.t = (t_ns + window_ns) / NS
        self.power = self._power(rubble)
        contact = self.front.forces(out)
        self.front.crush()
        hinges = self.sheet.hinges
        contact = replace(contact, hinged=hinges.hinged[contact.nodes])
        events = self.watch.window(out, parts, self._left, load, rubble_load)
        events += self.watch.cracks(hinges, load + rubble_load)
        r = out.reaction
        budget = {
            "pressed_sheet": r.foundation,
            "drag": r.drag,
            "inertia": r.inertia,
            "held": r.held,
            "staggering": r.applied.get(RUBBLE, (0.0, 0.0)),
        }
        others = {name: pair for name, pair in r.applied.items() if name != RUBBLE}
        return SheetReport(load, [f for f, _ in self._left], events, budget, others, contact, _hinged(contact))

    def _release(self, nodes: IntArray) -> None:
        """A piece leaves the lattice, within the window."""
        self._left.append(
            (
                fragment(self.sheet, self.motion, self.front, nodes),
                bool(np.isin(nodes, self.contact.nodes).any()),
            )
        )
        self.front.renew()

    def _rubble(self, rubble: SheetForces) -> NodeLoad:
        """The rubble's forces on all nodes."""
        n = self.sheet.grid.nodes
        force_u, force_q = np.zeros((n, 2)), np.zeros((n, 3))
        force_u[rubble.nodes, 0], force_q[rubble.nodes, 0] = rubble.force[:, 0], rubble.force[:, 2]
        return NodeLoad(RUBBLE, force_u, force_q)

    def _others(self, t: float) -> list[NodeLoad]:
        """The other loads in the coming window."""
        if not self.loads:
            return []
        nodes = np.arange(self.sheet.grid.nodes)
        where, velocity = self.motion.position(nodes), self.motion.velocities(nodes)
        sheet = SheetMotion(where, velocity, self.sheet.grid.area, self.sheet.present)
        out = []
        for load in self.loads:
            force = load.on_sheet(t, sheet)
            force_q = np.column_stack((force[:, 2], np.zeros((len(nodes), 2))))
            out.append(NodeLoad(load.name, force[:, :2].copy(), force_q))
        return out

    def _power(self, rubble: SheetForces) -> float:
        """Power of the forces on the nodes that are still in the lattice, by their displacement in the window [W]."""
        on = self.sheet.present[rubble.nodes]
        displacement = self.motion.displacement(rubble.nodes[on])
        return float((rubble.force[on] * displacement).sum()) / self.motion.window

    def rest_under(self, rubble: SheetForces) -> None:
        """Starts the run in equilibrium with rubble that lies under the sheet, its edge just touching the structure."""
        try:
            self.sheet.rest_under([self._rubble(rubble)])
        except StepError as error:
            raise SimulationError(f"{error}: give less initial rubble (rubble.initial_volume)") from error
        self.front.set_back()
        self.motion.begin(0.0)

    def save(self) -> Restore:
        """All of the sheet between two windows."""
        own = [m for thing in (self, self.motion, self.underside, self.watch) for m in remember(thing)]
        return partial(recall, [*own, *self.front.save(), *self.sheet.save()])

    # ---- what others see --------------------------------------------------------------------------------------

    @property
    def mass(self) -> float:
        """Ice in the lattice, without what was crushed off its edge [kg]."""
        return self.front.mass

    @property
    def crushed(self) -> float:
        """All ice crushed off the edge so far [kg]."""
        return self.front.crushed

    @property
    def energy(self) -> dict[str, float]:
        """Energy of the sheet by term [J]."""
        return energy_terms(self.sheet.energy, self.motion.velocity)

    def edges(self, sections: Sequence[int]) -> dict[int, SheetEdge]:
        """The sheet's edge and underside in these sections, where they are and move now."""
        return self.underside.edges(sections, self.motion.now)

    def path(self, sections: Sequence[int]) -> dict[int, SheetEdge]:
        """The same edges at the start of the last window, with their mean velocity over it: they end where they are."""
        return self.underside.edges(sections, self.motion.mean)

    def view(self) -> SheetView:
        """Positions, damage and utilisation for observers."""
        return view(self.sheet, self.motion)


def _hinged(contact: ContactForces) -> Array | None:
    """Load that hinged pieces give, (3,) [N]; None if there are none."""
    return -contact.force[contact.hinged].sum(axis=0) if contact.hinged.any() else None
