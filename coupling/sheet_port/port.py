"""The sheet as a participant: one window of it, and what it gives to others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from coupling.contact import ContactLaw, OverlapContact
from coupling.contact_friction import friction_part
from coupling.interface import (
    NS,
    Answer,
    Array,
    ContactForces,
    Fragment,
    IntArray,
    Load,
    Path,
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
from coupling.sheet_port.leaving import Leaving
from coupling.sheet_port.meeting import Meeting
from coupling.sheet_port.motion import Motion
from coupling.sheet_port.moving import OnMoving
from coupling.sheet_port.underside import Underside
from coupling.sheet_port.view import view
from coupling.sheet_port.watch import Watch
from lattice.explicit_sheet import ExplicitSheet
from lattice.floe import Floe
from lattice.fragments import components
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
        path: Path | None = None,
    ):
        """``velocity`` of the drift [m/s]; ``contact`` makes the contact of the edge from the ``law``.

        ``loads`` act on the sheet beside structure and rubble, each under a name of its own; ``path`` is that of a
        structure that moves.
        """
        ice = sheet.ice
        self.sheet, self.loads = sheet, tuple(loads)
        self.contact = contact(structure, law, velocity, ice.h, ice.freeboard, path)
        self.motion = Motion(sheet, velocity)
        self.front = Front(sheet, self.motion, structure, self.contact)
        self.underside = Underside(sheet, self.motion, self.front.edge, columns_per_section)
        self.watch = Watch(sheet, self.motion)
        self.initial_mass = ice.rho_i * ice.h * float(sheet.grid.area.sum())
        #: mean power of the rubble's forces on the sheet over the last window, in the fixed frame [W]
        self.power = 0.0
        self.meeting: Meeting | None = None  #: in lockstep
        self._leaving = Leaving()
        self.moving = None if path is None else OnMoving(self.contact, path)
        if path is not None:
            sheet.window_by_window()
        rests = partial(friction_part, structure, law.friction, self.contact.face, self.contact.touching_z)
        sheet.energy.friction_of = rests if path is None else self.contact.friction_in

    # ---- one window -------------------------------------------------------------------------------------------

    def lockstep(self, every: float) -> None:
        """From now on windows are sub-steps of the rubble that both do together, ``every`` so many seconds.

        SimulationError where the sheet is not on the explicit engine.
        """
        if not isinstance(self.sheet, ExplicitSheet):
            raise SimulationError(
                "coupling.scheme = 'lockstep' needs the explicit engine: set fracture.cracks = 'closing' or "
                "fracture.propagation = 'dynamic', or another coupling.scheme"
            )
        self.meeting = Meeting(self.sheet, self.motion, every)
        self.sheet.join(self.meeting)

    def nodes(self, nodes: IntArray) -> Array:
        """As `SheetParticipant.nodes`."""
        return np.zeros((0, 11)) if self.meeting is None else self.meeting.nodes(nodes)

    def advance(
        self, t_ns: int, window_ns: int, rubble: SheetForces, rubble_load: Array, answer: Answer | None = None
    ) -> SheetReport:
        """Moves the sheet over a window under the rubble's mean forces; ``rubble_load`` (3,) is for the events only."""
        t = t_ns / NS
        self._leaving.begin()
        self.motion.begin(t)
        if self.moving is not None:
            self.front.stand(self.moving.path.at(t))
        self.sheet.set_window(window_ns / NS)
        parts = self.sheet.parts
        try:
            pressing = self._rubble(rubble) if self.meeting is None else self._meet(answer)
            out = self.sheet.advance(t, [pressing, *self._others(t)], self.contact, self._release)
        except (StepError, FloatingPointError) as error:
            raise SimulationError(f"t = {t:.3f} s: {error}") from error
        load = -out.contact_mean.sum(axis=0)
        self.motion.t = (t_ns + window_ns) / NS
        self.power = self._power(rubble, window_ns / NS)
        contact = self.front.forces(out)
        if self.moving is not None:
            self.moving.close(self.motion.t, window_ns / NS, contact, self.front.displacement())
        self.front.crush()
        hinges = self.sheet.hinges
        contact = replace(contact, hinged=hinges.hinged[contact.nodes])
        events = self.watch.window(out, parts, self._leaving.pieces, load, rubble_load)
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
        left, wrench = self._leaving.late(self.motion.t), None if self.moving is None else self.moving.wrench
        return SheetReport(load, left, events, budget, others, contact, _hinged(contact), wrench)

    def _release(self, nodes: IntArray) -> None:
        """A piece leaves the lattice, within the window."""
        touching = bool(np.isin(nodes, self.contact.nodes).any())
        self._leaving.add(fragment(self.sheet, self.motion, self.front, nodes), self.motion.t, touching=touching)
        self.front.renew()

    def remains(self) -> list[Fragment]:
        """What is left of the sheet as pieces, one for each part that hangs together; the sheet is used up."""
        label = np.where(self.sheet.present, components(self.sheet.grid, self.sheet.joins), -1)
        parts = [np.flatnonzero(label == k) for k in np.unique(label[label >= 0])]
        return [fragment(self.sheet, self.motion, self.front, nodes) for nodes in parts]

    def _meet(self, answer: Answer | None) -> NodeLoad:
        """The load of a window in lockstep."""
        assert self.meeting is not None
        if answer is not None:
            self.meeting.answer = lambda: answer(self._leaving.come())
        return self.meeting.load

    def _rubble(self, rubble: SheetForces) -> NodeLoad:
        """The rubble's forces on all nodes."""
        n = self.sheet.grid.nodes
        force_u, force_q = np.zeros((n, 2)), np.zeros((n, 3))
        force_u[rubble.nodes], force_q[rubble.nodes, 0] = rubble.force[:, :2], rubble.force[:, 2]
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

    def _power(self, rubble: SheetForces, window: float) -> float:
        """Power of the forces on the nodes that are still in the lattice, by their displacement in the window [W]."""
        if self.meeting is not None:
            return self.meeting.power(window)
        on = self.sheet.present[rubble.nodes]
        displacement = self.motion.displacement(rubble.nodes[on])
        return float((rubble.force[on] * displacement).sum()) / window

    def rest_under(self, rubble: SheetForces) -> None:
        """Starts the run in equilibrium with rubble that lies under the sheet, its edge just touching the structure."""
        try:
            self.sheet.rest_under([self._rubble(rubble)])
        except StepError as error:
            raise SimulationError(f"{error}: give less initial rubble (rubble.initial_volume)") from error
        self.front.set_back()
        self.motion.begin(0.0)
        if self.meeting is not None:
            self.meeting.take(rubble)

    def save(self) -> Restore:
        """All of the sheet between two windows."""
        things = (self, self.motion, self.underside, self.watch, self.moving, self._leaving)
        own = [m for thing in things if thing is not None for m in remember(thing)]
        back = partial(recall, [*own, *self.front.save(), *self.sheet.save()])
        return back if self.meeting is None else self.meeting.save(back)

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
        return energy_terms(self.sheet.energy, self.motion.velocity, self.moving)

    def edges(self, sections: Mapping[int, float]) -> dict[int, SheetEdge]:
        """The sheet's edge and underside in these sections, where they are and move now."""
        return self.underside.edges(sections, self.motion.now)

    def path(self, sections: Mapping[int, float]) -> dict[int, SheetEdge]:
        """The same edges at the start of the last window, with their mean velocity over it: they end where they are."""
        return self.underside.edges(sections, self.motion.mean)

    def compliance(self, sections: Sequence[int]) -> Array:
        """How the edges in these sections yield to each other, see `SheetParticipant.compliance`."""
        return self.underside.compliance(sections)

    def view(self) -> SheetView:
        """Positions, damage and utilisation for observers."""
        return view(self.sheet, self.motion)


def _hinged(contact: ContactForces) -> Array | None:
    """Load that hinged pieces give, (3,) [N]; None if there are none."""
    return -contact.force[contact.hinged].sum(axis=0) if contact.hinged.any() else None
